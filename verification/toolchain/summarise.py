#!/usr/bin/env python3
"""Closes a CI run: counts the tests of the JUnit reports and the steps that failed beside them.

Usage: summarise.py REPORTS SUITE... -- [FAILED_STEP...]. Each SUITE is a report REPORTS/SUITE.xml that must
hold at least one test that ran. A step that failed although its report shows no failure (the build broke, the
runner died) counts as one failure. A failed test is named, with the first lines of what it said. The last
line is `N passed, N failed`; exits 1 unless all passed.
"""

import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

MOST_LINES, MOST_COLUMNS = 16, 160
"""So much is shown of what a failed test said; its report has the rest."""


def cases_of(report: Path) -> list[ElementTree.Element]:
    """The tests of a report; none when there is no report that can be read."""
    try:
        return list(ElementTree.parse(report).getroot().iter("testcase"))
    except (OSError, ElementTree.ParseError):
        return []


def failure_of(case: ElementTree.Element) -> str | None:
    """What a failed test said; None for one that did not fail."""
    for kind in ("failure", "error"):
        found = case.find(kind)
        if found is not None:
            return found.text or found.get("message", "")
    return None


def excerpt(text: str) -> str:
    lines = [line[:MOST_COLUMNS] for line in text.splitlines() if line.strip()]
    return "\n".join(f"    {line}" for line in lines[:MOST_LINES])


def main() -> int:
    reports = Path(sys.argv[1])
    divider = sys.argv.index("--")
    suites, broken = sys.argv[2:divider], set(sys.argv[divider + 1 :])
    total_passed = total_failed = 0
    for suite in suites:
        cases = cases_of(reports / f"{suite}.xml")
        failures = [(case.get("name"), said) for case in cases if (said := failure_of(case)) is not None]
        failed = len(failures)
        passed = len(cases) - failed - sum(case.find("skipped") is not None for case in cases)
        for name, said in failures:
            print(f"{suite}: FAILED {name}\n{excerpt(said)}")
        if passed + failed == 0:
            print(f"{suite}: no test ran")
            failed = 1
        if failed:
            broken.discard(suite)
        total_passed += passed
        total_failed += failed
        print(f"{suite}: {passed} passed, {failed} failed")
    for step in sorted(broken):
        print(f"{step}: failed as a whole")
    total_failed += len(broken)
    print(f"{total_passed} passed, {total_failed} failed")
    return 1 if total_failed else 0


if __name__ == "__main__":
    sys.exit(main())
