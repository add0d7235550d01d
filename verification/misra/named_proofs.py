"""Holds the proofs that enforcement.md names against those that the rungs run: for each file of the core, and
for each guideline that says `proof`.
"""

import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
ENFORCEMENT = Path(__file__).resolve().parent / "enforcement.md"
CBMC = ROOT / "verification/cbmc"
EVERY_FILE = "every file"
OPTION = re.compile(r"(?<![\w`])--?[a-z][a-z-]+")
OPTIONS_OF = {"cbmc": CBMC / "prover.py"}
FIGURES = ("coverage", "target")
"""Rungs whose figures decide, not single proofs."""


@dataclass(frozen=True)
class FileRow:
    """A file of the core, or of the executive, with what is proved of it."""

    file: str
    cbmc: tuple[str, ...]


@dataclass(frozen=True)
class RuleRow:
    """What decides one guideline in one rung."""

    guideline: str
    rung: str
    proofs: tuple[str, ...]
    decided_by: str


def rows(columns: int) -> Iterator[list[str]]:
    """The rows of the tables of that many columns, cells without the blanks around them."""
    for line in ENFORCEMENT.read_text("utf-8").splitlines():
        cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
        if len(cells) == columns and not cells[0].startswith("-"):
            yield cells


def file_rows() -> list[FileRow]:
    return [FileRow(file, tuple(cbmc.split(", "))) for file, cbmc in rows(2) if file.endswith(".c")]


def rule_rows() -> list[RuleRow]:
    rungs = (*OPTIONS_OF, *FIGURES)
    return [
        RuleRow(guideline, rung, tuple(proofs.split(", ")), decided_by)
        for guideline, rung, proofs, decided_by in rows(4)
        if rung in rungs
    ]


def proofs_by_file() -> dict[str, set[str]]:
    """The CBMC proofs that link a file or take it in whole, by the file's name."""
    found: dict[str, set[str]] = {}
    for path in CBMC.glob("*/proof.toml"):
        linked = tomllib.loads(path.read_text("utf-8"))["sources"]
        taken_in = re.findall(r'#include "(\S+\.c)"', path.with_name("harness.c").read_text("utf-8"))
        for file in (*linked, *taken_in):
            found.setdefault(Path(file).name, set()).add(path.parent.name)
    return found


def faults_of_files() -> Iterator[str]:
    """Files without a row, and rows that do not name exactly the proofs that there are."""
    proofs = proofs_by_file()
    told = {row.file: row for row in file_rows()}
    for path in sorted((ROOT / "kernel/src").glob("*.c")):
        if path.name not in told:
            yield f"{path.name}: enforcement.md names no proofs of it"
    for file, row in told.items():
        for name in sorted(set(row.cbmc) ^ proofs.get(file, set())):
            there = (
                "takes it in, but is not named" if name in proofs.get(file, set()) else "does not take it in"
            )
            yield f"{file}: the proof {name} {there}"


def unknown_proofs(row: RuleRow, figures: Mapping[str, Mapping[str, object]]) -> Iterator[str]:
    """Proofs or figures of a row that there are not."""
    if row.rung in FIGURES:
        yield from (name for name in row.proofs if name not in figures[row.rung])
    elif row.proofs != (EVERY_FILE,):
        yield from (name for name in row.proofs if not (CBMC / name / "proof.toml").is_file())


def faults_of_rules(said: Mapping[str, Sequence[str]]) -> Iterator[str]:
    """Guidelines whose proofs are not named, and names of nothing.

    `said` gives the rungs that each guideline says to be proved by.
    """
    expected = tomllib.loads((ROOT / "verification/expected.toml").read_text("utf-8"))
    # A rung's table may leave out figures that the machine decides; those have their limits in the rung.
    figures = {rung: {**expected[rung]["figures"], "stack_bytes": None} for rung in FIGURES}
    told = {(row.guideline, row.rung) for row in rule_rows()}
    wanted = {(guideline, rung) for guideline, rungs in said.items() for rung in rungs}
    for guideline, rung in sorted(wanted - told):
        yield f"{guideline}: no proof of rung {rung} is named for it"
    for guideline, rung in sorted(told - wanted):
        yield f"{guideline}: proofs of rung {rung} are named, but its row does not say `proof {rung}`"
    for row in rule_rows():
        for name in unknown_proofs(row, figures):
            yield f"{row.guideline}: rung {row.rung} has no proof or figure '{name}'"
        run = OPTIONS_OF[row.rung].read_text("utf-8") if row.rung in OPTIONS_OF else ""
        for option in OPTION.findall(row.decided_by):
            if f'"{option}"' not in run:
                yield f"{row.guideline}: rung {row.rung} does not run with '{option}'"


def faults_of_named_proofs(said: Mapping[str, Sequence[str]]) -> list[str]:
    """What is wrong with the last two tables of enforcement.md, a sentence each."""
    return [*faults_of_files(), *faults_of_rules(said)]
