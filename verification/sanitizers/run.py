#!/usr/bin/env python3
"""Runs the unit tests under the address and undefined-behaviour sanitizers.

Builds the preset `sanitizers`, several files at once as the release does, then runs all its tests. Whatever a
sanitizer finds ends the test in which it does. Writes build/evidence/sanitizers.json: PASSED says that all
tests ran and none failed; FAILED is the rest, and the tests are named.
"""

import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "evidence"))

import evidence
from evidence import ROOT

PRESET = "sanitizers"
BUILD = ROOT / "build" / PRESET


def build(log: Path) -> None:
    """Raises SystemExit with the end of the log when it does not build."""
    configure = ["cmake", "--preset", PRESET, "-DCMAKE_UNITY_BUILD=ON"]
    with log.open("w") as output:
        done = subprocess.run(configure, cwd=ROOT, stdout=output, stderr=output, check=False)
    if done.returncode or subprocess.run(["ninja", "-C", str(BUILD)], cwd=ROOT, check=False).returncode:
        raise SystemExit(f"sanitizers: no build; see {log.relative_to(ROOT)} and the lines above")


def run_tests(report: Path) -> None:
    report.unlink(missing_ok=True)
    command = ["ctest", "--preset", PRESET, "--progress", "--no-tests=error", "--output-junit", str(report)]
    subprocess.run([*command, "--parallel", "2"], cwd=ROOT, check=False)


def outcomes(report: Path) -> dict[str, bool]:
    """Whether each test passed, by its name."""
    return {
        str(case.get("name")): case.get("status") == "run" and case.find("failure") is None
        for case in ElementTree.parse(report).getroot().iter("testcase")
    }


def main() -> int:
    started = time.monotonic()
    log = evidence.log_directory("sanitizers")
    build(log / "configure.log")
    run_tests(log / "tests.xml")
    passed = outcomes(log / "tests.xml")
    failed = sorted(name for name, so in passed.items() if not so)
    for name in failed:
        print(f"FAILED {name}")
    figures = {"tests": len(passed), "failed": len(failed)}
    verdict = "PASSED" if passed and not failed else "FAILED"
    print(f"sanitizers: {verdict}, {len(passed)} tests; build/evidence/sanitizers.json")
    version = subprocess.run(["g++", "-dumpfullversion"], capture_output=True, text=True, check=True).stdout
    return evidence.write("sanitizers", verdict, {"gcc": version.strip()}, figures, [], started)


if __name__ == "__main__":
    sys.exit(main())
