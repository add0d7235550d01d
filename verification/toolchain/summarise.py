#!/usr/bin/env python3
"""Closes a CI run: counts the tests of the JUnit reports and the steps that failed beside them.

Usage: summarise.py REPORTS SUITE... -- [FAILED_STEP...]. Each SUITE is a report REPORTS/SUITE.xml that must
hold at least one test that ran. A step that failed although its report shows no failure (the build broke, the
runner died) counts as one failure. The last line is `N passed, N failed`; exits 1 unless all passed.
"""

import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path


def count(report: Path) -> tuple[int, int]:
    """Passed and failed tests of a report; (0, 0) when there is none. Skipped ones do not count."""
    try:
        cases = list(ElementTree.parse(report).getroot().iter("testcase"))
    except (OSError, ElementTree.ParseError):
        return 0, 0
    failed = sum(case.find("failure") is not None or case.find("error") is not None for case in cases)
    skipped = sum(case.find("skipped") is not None for case in cases)
    return len(cases) - failed - skipped, failed


def main() -> int:
    reports = Path(sys.argv[1])
    divider = sys.argv.index("--")
    suites, broken = sys.argv[2:divider], set(sys.argv[divider + 1 :])
    total_passed = total_failed = 0
    for suite in suites:
        passed, failed = count(reports / f"{suite}.xml")
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
