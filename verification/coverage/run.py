#!/usr/bin/env python3
"""The test rung: statement, branch and MC/DC coverage of the core by the tests of its requirements alone.

PASSED: every statement, branch and condition is shown, for frames of 32 and of 64 words, and every logical
operator of the core belongs to a decision that was measured. VACUOUS: a run of a few tests shows just as
much, or a decision was not measured. There is no list of exceptions: what could not be covered was taken
out of the core.
"""

import re
import sys
import time
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "evidence"))

import evidence
from measure import Coverage, operators, read

from build import RANDOM_TESTS, ROOT, BuildError, build, export, run

FRAME_WORDS = (32, 64)
A_FEW_TESTS = "P12_no_leap.*"
PROPERTIES = [f"P{number}" for number in range(1, 17)]


def measure(words: int) -> tuple[Coverage, Coverage]:
    """Coverage by the tests of the requirements, and, for comparison, by a few of them."""
    started = time.monotonic()
    program = build(words, ROOT / "build" / "coverage" / str(words))
    exported = export(program, f"-{RANDOM_TESTS}")
    (evidence.log_directory("coverage") / f"{words}.json").write_text(exported, "utf-8")
    coverage, few = read(exported), read(export(program, A_FEW_TESTS))
    counts = "  ".join(f"{name} {shown}/{all_}" for name, (shown, all_) in coverage.counts().items())
    print(f"frames of {words} words: {counts}  {time.monotonic() - started:.1f} s", flush=True)
    return coverage, few


def percent(shown: int, all_: int) -> float:
    return round(100 * shown / all_, 2) if all_ else 0.0


def main() -> int:
    started = time.monotonic()
    tools = {"clang": re.search(r"version (\S+)", run(["clang-19", "--version"]))[1]}
    try:
        measured = [measure(words) for words in FRAME_WORDS]
    except BuildError as error:
        evidence.Failures("coverage").tell(f"coverage: {error}")
        return evidence.write("coverage", "UNKNOWN", tools, {}, PROPERTIES, started)
    sources = [path for path in (ROOT / "kernel/src").glob("*.[ch]")]
    wanted = operators(sources)
    faults, vacuous, figures = [], [], {}
    for words, (coverage, few) in zip(FRAME_WORDS, measured, strict=True):
        faults += [f"frames of {words} words: {text}" for text in coverage.missing()]
        seen = sum(len(conditions) - 1 for conditions in coverage.decisions.values())
        if seen != wanted:
            vacuous.append(f"{seen} logical operators were measured, but the core has {wanted}")
        if not any(True for _ in few.missing()):
            vacuous.append(f"{A_FEW_TESTS} alone seems to cover everything")
    for name in ("statement", "branch", "mcdc"):
        counts = [coverage.counts()[name] for coverage, _ in measured]
        figures[f"{name}_pct"] = min(percent(*count) for count in counts)
        figures[f"{name}s" if name != "branch" else "branches"] = counts[0][1]
    figures["mcdc_conditions"] = figures.pop("mcdcs")
    failures = evidence.Failures("coverage")
    for failure in (*faults, *vacuous):
        failures.tell(failure)
    status = "FAILED" if faults else "VACUOUS" if vacuous else "PASSED"
    return evidence.write("coverage", status, tools, figures, PROPERTIES, started)


if __name__ == "__main__":
    sys.exit(main())
