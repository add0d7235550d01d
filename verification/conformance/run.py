#!/usr/bin/env python3
"""Rung 2 of the ladder: the kernel and the model agree on every state and every input, phase by phase.

TLC prints each phase's whole transition relation; CBMC proves that the C of the phase computes the same for
all concrete inputs, and the compiled kernel runs over all rows. `--update` writes manifest.toml anew, for a
commit that changes the model; `--only PHASE` looks at one phase (and updates that one alone) and leaves no
evidence. whole.py shows that the phases are the whole tick. See docs/conformance.md.
"""

import argparse
import os
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import phases
import planted
import traces
import whole
from table import TableError
from tools import ROOT, ToolError, cbmc_version

sys.path.insert(0, str(ROOT / "verification" / "evidence"))
import evidence

SUPPORTS = [f"P{number}" for number in range(1, 13)]


def figures_of(reports: list[phases.Report], found: int, steps: int) -> dict[str, float]:
    """The rung's numbers."""
    return {
        "phases": len(reports),
        "states": sum(report.states for report in reports),
        "pairs": sum(report.rows for report in reports),
        "rows_proved": sum(report.proved_rows for report in reports),
        "assertions_proved": sum(report.proved for report in reports),
        "answers_reached": sum(report.reached for report in reports),
        "page_rows": sum(report.page_rows for report in reports),
        "mismatches": sum(len(report.faults) for report in reports),
        "planted_found": found,
        "trace_steps": steps,
    }


def check_all(pool: ThreadPoolExecutor, names: list[str], failures: evidence.Failures) -> list[phases.Report]:
    """Looks at every phase and prints a line for each, and what differs."""
    reports = []
    for report in pool.map(phases.check, names):
        print(report.line(), flush=True)
        for fault in report.faults:
            failures.tell(f"  {fault}")
        reports.append(report)
    return reports


def rung(arguments: argparse.Namespace) -> int:
    """Runs the rung and writes its evidence."""
    started = time.monotonic()
    failures = evidence.Failures("conformance")
    with ThreadPoolExecutor(int(os.environ.get("JOBS", "1"))) as pool:
        if arguments.only:
            reports = check_all(pool, arguments.only, failures)
            if arguments.update:
                phases.write_manifest(reports)
            return 1 if any(report.faults for report in reports) else 0
        # Each a chain of its own, begun first so that the phases fill the other cores until the end.
        seeded = pool.submit(planted.check_all)
        traced = pool.submit(traces.check_all)
        reports = check_all(pool, phases.names(), failures)
        found, unfound = seeded.result()
        steps, rejected = traced.result()
    if arguments.update:
        phases.write_manifest(reports)
    stale = phases.against_manifest(reports)
    missed = whole.uncovered()
    faults = [*stale, *missed, *unfound, *rejected]
    for fault in faults:
        failures.tell(fault)
    figures = figures_of(reports, found, steps)
    print(", ".join(f"{name} {value}" for name, value in figures.items()))
    passed = not faults and figures["mismatches"] == 0
    tools = {"TLC": "2.18", "CBMC": cbmc_version()}
    return evidence.write("conformance", "PASSED" if passed else "FAILED", tools, figures, SUPPORTS, started)


def main() -> int:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--update", action="store_true", help="write manifest.toml from what the model says now"
    )
    parser.add_argument("--only", action="append", metavar="PHASE", help="look at this phase alone")
    try:
        return rung(parser.parse_args())
    except (TableError, ToolError) as error:
        print(f"conformance: {error}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    raise SystemExit(main())
