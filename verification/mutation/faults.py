#!/usr/bin/env python3
"""Shows that the proofs notice faults: seeds those of tests/failure that name a proof, and wants it to fail.

Usage: faults.py [NAME ...]; all when none is named. A patch of tests/failure says in its head, a line each,

  proof   RUNG PART: MESSAGE

which part of which rung must fail, and with which words (a regular expression): `cbmc gate: P3` or
`tick P5: P5`. A fault counts as caught when each proof that its patch names says so, and only then.

Prints a line for each fault; writes build/evidence/faults.json.
"""

import argparse
import re
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "evidence"))

import evidence
from probes import probe_named
from tree import ROOT, on_trees

PATCHES = ROOT / "tests/failure"
PROOF = re.compile(r"^# proof: (\w+ \w+): (.+)$", re.MULTILINE)


@dataclass(frozen=True)
class Fault:
    """A patch of the kernel, and what each proof that it names must say."""

    path: Path
    proofs: tuple[tuple[str, str], ...]
    """`RUNG PART` and a regular expression."""

    @property
    def name(self) -> str:
        return self.path.stem


def read_faults() -> list[Fault]:
    """The patches that name a proof."""
    heads = {path: path.read_text("utf-8").partition("\n--- ")[0] for path in sorted(PATCHES.glob("*.patch"))}
    return [Fault(path, tuple(found)) for path, head in heads.items() if (found := PROOF.findall(head))]


def patch(tree: Path, fault: Fault, *options: str) -> bool:
    """Seeds the fault, or takes it out again with `-R`; whether it applies."""
    command = ["patch", "-p1", "-s", "-f", *options, "-d", str(tree), "-i", str(fault.path)]
    return subprocess.run(command, capture_output=True, check=False).returncode == 0


def complaints(tree: Path, fault: Fault) -> list[str]:
    """What is wrong: the patch does not apply, or a proof does not say what it must."""
    if not patch(tree, fault):
        return ["the patch no longer applies; renew it"]
    try:
        said = {part: probe_named(part).catch_all(tree) for part, _ in fault.proofs}
    finally:
        patch(tree, fault, "-R")
    return [
        f"{part} does not say '{message}' but: {'; '.join(said[part]) or 'nothing'}"
        for part, message in fault.proofs
        if not any(re.search(message, line) for line in said[part])
    ]


def judge_all(faults: Sequence[Fault]) -> list[list[str]]:
    """What is wrong with each, printed as it is done."""

    def one(tree: Path, fault: Fault) -> list[str]:
        started = time.monotonic()
        wrong = complaints(tree, fault)
        verdict = "FAILED" if wrong else "caught"
        print(
            f"{verdict}  {fault.name:<44} {time.monotonic() - started:6.1f} s  {'; '.join(wrong)}", flush=True
        )
        return wrong

    return on_trees("fault-tree", faults, one)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", help="faults to seed; all when none is named")
    names = parser.parse_args().names
    started = time.monotonic()
    faults = [fault for fault in read_faults() if not names or fault.name in names]
    if unknown := set(names) - {fault.name for fault in faults}:
        parser.error(f"no patch of that name that names a proof: {', '.join(sorted(unknown))}")
    wrong = judge_all(faults)
    figures = {"faults": len(faults), "caught": sum(not each for each in wrong)}
    passed = figures["faults"] == figures["caught"] > 0
    if names:
        return 0 if passed else 1
    return evidence.write("faults", "PASSED" if passed else "FAILED", {"gcc": "12"}, figures, [], started)


if __name__ == "__main__":
    sys.exit(main())
