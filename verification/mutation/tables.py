"""What a run of mutants leaves in build/evidence: mutants, kill matrix, survivors, as JSON and to be read."""

import json
from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from functions import Function, function_at
from operators import Mutant
from verdicts import RUNGS, Verdict

COLUMNS = (*RUNGS, "equivalent", "survived")


def killers_of(verdict: Verdict) -> set[str]:
    """The rungs that noticed the mutant."""
    return {reason.split()[0] for reason in verdict.reasons} if verdict.fate == "killed" else set()


def name_at(functions: Sequence[Function], mutant: Mutant) -> str:
    function = function_at(functions, mutant.file, mutant.line)
    return f"{Path(mutant.file).stem}.{function.name if function else ''}"


def by_function(
    mutants: Sequence[Mutant], verdicts: Sequence[Verdict], functions: Sequence[Function]
) -> dict[str, Counter[str]]:
    """Of each function how many of its mutants each rung noticed, and what was left."""
    table: dict[str, Counter[str]] = {}
    for mutant, verdict in zip(mutants, verdicts, strict=True):
        row = table.setdefault(name_at(functions, mutant), Counter())
        row.update(killers_of(verdict) or {verdict.fate})
    return dict(sorted(table.items()))


def by_rung(verdicts: Sequence[Verdict]) -> dict[str, dict[str, int]]:
    """Of each rung how many mutants it was shown, noticed, and noticed as the only one that was asked."""
    return {
        rung: {
            "shown": sum(rung in verdict.told_by for verdict in verdicts),
            "killed": sum(rung in killers_of(verdict) for verdict in verdicts),
            "killed_alone": sum(killers_of(verdict) == {rung} for verdict in verdicts),
        }
        for rung in RUNGS
    }


def matrix_text(table: dict[str, Counter[str]]) -> str:
    lines = [f"{'function':<44}" + "".join(f"{column:>12}" for column in COLUMNS)]
    lines += [
        f"{name:<44}" + "".join(f"{row[column]:>12}" for column in COLUMNS) for name, row in table.items()
    ]
    return "\n".join(lines)


def survivors_text(mutants: Sequence[Mutant], verdicts: Sequence[Verdict]) -> str:
    """The change that nobody noticed, of each survivor; empty when there is none."""
    return "\n".join(
        f"survived: {mutant.name}, {mutant.file}:{mutant.line}\n"
        f"    - {mutant.before.strip()}\n    + {mutant.after.strip()}"
        for mutant, verdict in zip(mutants, verdicts, strict=True)
        if verdict.fate == "survived"
    )


def write(
    folder: Path,
    mutants: Sequence[Mutant],
    verdicts: Sequence[Verdict],
    functions: Sequence[Function],
    every: bool,
) -> None:
    """Writes mutants.json, matrix.json, matrix.txt, survivors.json and survivors.txt.

    `every` says that each mutant that may be a fault was shown to every rung; otherwise a rung saw what those
    before it had let pass, and `killed_alone` says no more than `killed`.
    """
    records = [
        asdict(mutant) | {"name": mutant.name, "function": name_at(functions, mutant)} | asdict(verdict)
        for mutant, verdict in zip(mutants, verdicts, strict=True)
    ]
    table = by_function(mutants, verdicts, functions)
    matrix = {"every_rung_asked": every, "rungs": by_rung(verdicts), "functions": table}
    survivors = [record for record in records if record["fate"] == "survived"]
    for name, content in (("mutants", records), ("matrix", matrix), ("survivors", survivors)):
        (folder / f"{name}.json").write_text(json.dumps(content, indent=1) + "\n", "utf-8")
    (folder / "matrix.txt").write_text(matrix_text(table) + "\n", "utf-8")
    (folder / "survivors.txt").write_text((survivors_text(mutants, verdicts) or "none") + "\n", "utf-8")
