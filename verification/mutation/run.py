#!/usr/bin/env python3
"""Mutants of the core against rungs 1 to 4: what the proofs would not notice, nobody has proved.

Usage: run.py [--count N] [--seed TEXT] [--matrix]. Draws N mutants (100) by the seed (the commit), drops
those that do not compile, takes those that the compiler turns into the same code, or that equivalent.toml
names with a reason, as equivalent, and shows each other one to the probes of probes.py until one catches it;
with --matrix to all of them.

Prints a line for each mutant, the survivors at the end, and writes build/evidence/mutation.json.
"""

import argparse
import hashlib
import subprocess
import sys
import time
import tomllib
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "evidence"))

import evidence
from operators import Mutant, draw, mutants_of
from probes import probes_for
from rows import all_phases, print_missing
from tree import ROOT, on_trees, seeded

HERE = Path(__file__).resolve().parent
FLAGS = ["-std=c11", "-O2", "-ffreestanding", "-S", "-Ikernel/include", "-Ikernel/src", "-o", "-"]
GOAL_PCT = 90


@dataclass(frozen=True)
class Verdict:
    """What became of a mutant: `caught`, `equivalent` or `survived`, by which probes or why."""

    mutant: Mutant
    fate: str
    reasons: tuple[str, ...]
    seconds: float


def core_files() -> list[str]:
    """The files of the core that hold decisions; the CRC's table is data, proved entry by entry."""
    files = sorted(path for path in (ROOT / "kernel/src").iterdir() if path.name != "crc32_table.c")
    return [str(path.relative_to(ROOT)) for path in files]


def object_code(tree: Path) -> str:
    """A hash over the object code of the core; empty when it does not compile."""
    digest = hashlib.sha256()
    for source in sorted((tree / "kernel/src").glob("*.c")):
        done = subprocess.run(
            ["gcc", *FLAGS, str(source.relative_to(tree))],
            cwd=tree,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )
        if done.returncode:
            return ""
        digest.update(done.stdout)
    return digest.hexdigest()


def recorded_equivalents() -> dict[tuple[str, str, str], str]:
    """The mutants that a person found to be no fault, by file and both lines, with the reason."""
    entries = tomllib.loads((HERE / "equivalent.toml").read_text("utf-8")).get("equivalent", [])
    return {(entry["file"], entry["before"], entry["after"]): entry["reason"] for entry in entries}


def catches(tree: Path, mutant: Mutant, every: bool) -> list[str]:
    """What catches the mutant that is in the tree: the first probe, or every one."""
    found = []
    for probe in probes_for(tree, Path(mutant.file)):
        told = probe.catch(tree)
        if told:
            found.append(f"{probe.rung} {probe.part}: {told}")
            if not every:
                break
    return found


def judge(tree: Path, mutant: Mutant, sound_code: str, every: bool) -> Verdict | None:
    """What becomes of one mutant; nothing when it does not compile."""
    started = time.monotonic()
    with seeded(tree, mutant.file, mutant.line, mutant.before, mutant.after):
        code = object_code(tree)
        if not code:
            return None
        reason = recorded_equivalents().get((mutant.file, mutant.before.strip(), mutant.after.strip()))
        if code == sound_code or reason:
            why = reason or "the compiler makes the same code of it"
            return Verdict(mutant, "equivalent", (why,), time.monotonic() - started)
        found = catches(tree, mutant, every)
        return Verdict(mutant, "caught" if found else "survived", tuple(found), time.monotonic() - started)


def show(verdict: Verdict) -> None:
    mutant = verdict.mutant
    reasons = "\n".join(f"    {reason}" for reason in verdict.reasons)
    print(f"{verdict.fate:<10} {mutant.name:<36} {verdict.seconds:6.1f} s\n{reasons}", flush=True)
    if verdict.fate == "survived":
        print(f"    {mutant.file}:{mutant.line}\n    - {mutant.before.strip()}\n    + {mutant.after.strip()}")


def judge_all(mutants: list[Mutant], every: bool) -> list[Verdict]:
    """Judges the mutants, printing each as it is done."""
    sound_code = object_code(ROOT)

    def one(tree: Path, mutant: Mutant) -> Verdict | None:
        verdict = judge(tree, mutant, sound_code, every)
        if verdict:
            show(verdict)
        return verdict

    return [verdict for verdict in on_trees("mutant-tree", mutants, one) if verdict]


def report(verdicts: list[Verdict], drawn: int, started: float) -> int:
    """Prints the score and writes the evidence."""
    fates = Counter(verdict.fate for verdict in verdicts)
    by_rung = Counter(reason.split()[0] for v in verdicts if v.fate == "caught" for reason in v.reasons)
    faults = fates["caught"] + fates["survived"]
    figures = {
        "drawn": drawn,
        "mutants": len(verdicts),
        "killed": fates["caught"],
        "equivalent": fates["equivalent"],
        "survived": fates["survived"],
        **{f"killed_by_{rung}": count for rung, count in sorted(by_rung.items())},
    }
    enough = faults > 0 and 100 * fates["caught"] >= GOAL_PCT * faults
    print(", ".join(f"{name} {value}" for name, value in figures.items()))
    return evidence.write("mutation", "PASSED" if enough else "FAILED", {"gcc": "12"}, figures, [], started)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=100, help="mutants to draw (100)")
    parser.add_argument("--seed", default=evidence.commit(), help="chooses them (the commit)")
    parser.add_argument("--matrix", action="store_true", help="show each mutant to every probe")
    arguments = parser.parse_args()
    started = time.monotonic()
    print_missing(all_phases())
    mutants = draw(mutants_of(ROOT, core_files()), arguments.count, arguments.seed)
    print(f"mutation: {len(mutants)} mutants, drawn by {arguments.seed}")
    return report(judge_all(mutants, arguments.matrix), len(mutants), started)


if __name__ == "__main__":
    sys.exit(main())
