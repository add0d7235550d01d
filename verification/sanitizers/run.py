#!/usr/bin/env python3
"""Runs tests under sanitizers. Usage: run.py address | threads | threads-quick

address        all unit tests under the address and undefined-behaviour sanitizers
threads        unit tests of what has threads, and integration tests, under the thread sanitizer
threads-quick  unit tests of a few of those folders, for each commit

Builds a preset, several files at once as the release does, then runs the tests. Whatever a sanitizer finds
fails the run, and is shown. The thread sanitizer sees one process: memory that processes share is out of its
sight. Writes build/evidence/sanitizers.json or thread_sanitizer.json: PASSED says that all tests ran, none
failed and nothing was reported; FAILED is the rest, and the tests are named. The quick run writes none.
"""

import os
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "evidence"))

import evidence
from evidence import ROOT

WITH_THREADS = ("app", "cli", "history", "host", "igtl", "log", "recorder", "store")
QUICK = ("history", "host", "log", "store")
ON_PROGRAMS = ("test_access", "test_faults", "test_recorder", "test_store_busy")
"""Of tests/integration: sessions, faults, recordings and the store."""
LEFT_OUT = "ThereIsNoMemory|NeverTorn"
"""Tests that leave their process no memory, of which the thread sanitizer needs much; and those of the
kernel's sequence locks, whose fences it does not know: it would only make them slow."""


@dataclass(frozen=True)
class Run:
    name: str
    preset: str
    folders: tuple[str, ...] = ()
    """Of tests/unit; none: all."""
    on_programs: tuple[str, ...] = ()
    left_out: str = "^$"


RUNS = {
    "address": Run("sanitizers", "sanitizers"),
    "threads": Run("thread_sanitizer", "thread-sanitizer", WITH_THREADS, ON_PROGRAMS, LEFT_OUT),
    "threads-quick": Run("thread_sanitizer_quick", "thread-sanitizer", QUICK, left_out=LEFT_OUT),
}


def build(run: Run, log: Path) -> Path:
    """The folder of the build. Raises SystemExit with the end of the log when it does not build."""
    folder = ROOT / "build" / run.preset
    configure = ["cmake", "--preset", run.preset, "-DCMAKE_UNITY_BUILD=ON"]
    targets = [f"tests/unit/{each}/all" for each in run.folders] + ["programs"] * bool(run.on_programs)
    with log.open("w") as output:
        done = subprocess.run(configure, cwd=ROOT, stdout=output, stderr=output, check=False)
    if done.returncode or subprocess.run(["ninja", "-C", folder, *targets], cwd=ROOT, check=False).returncode:
        raise SystemExit(f"{run.name}: no build; see {log.relative_to(ROOT)} and the lines above")
    return folder


def run_tests(run: Run, built: Path, log: Path) -> list[Path]:
    """Runs all tests; the JUnit reports of them."""
    reports = []
    for each in run.folders or (".",):
        reports.append(log / f"tests-{each.strip('.') or 'all'}.xml")
        command = ["ctest", "--test-dir", built / "tests/unit" / each, "--progress", "--no-tests=error"]
        command += ["--exclude-regex", run.left_out, "--parallel", "2", "--output-junit", reports[-1]]
        subprocess.run(command, cwd=ROOT, check=False)
    if run.on_programs:
        reports.append(log / "tests-programs.xml")
        files = [f"tests/integration/{each}.py" for each in run.on_programs]
        command = ["pytest", "-m", "not network", *files, f"--junitxml={reports[-1]}"]
        subprocess.run(command, cwd=ROOT, check=False, env=os.environ | {"INTERLOCK_BIN": str(built / "bin")})
    return reports


def outcomes(report: Path) -> dict[str, bool]:
    """Whether each test passed, by its name. CTest says `run` of one that ran, pytest nothing."""
    return {
        f"{case.get('classname')} {case.get('name')}": case.get("status", "run") == "run"
        and case.find("failure") is None
        and case.find("error") is None
        for case in ElementTree.parse(report).iter("testcase")
    }


def main() -> int:
    if len(sys.argv) != 2 or sys.argv[1] not in RUNS:
        print(f"run: expected one of {', '.join(RUNS)}", file=sys.stderr)
        return 2
    run = RUNS[sys.argv[1]]
    started = time.monotonic()
    log = evidence.log_directory(run.name)
    for old in (*log.glob("*.xml"), *log.glob("report.*")):
        old.unlink()
    built = build(run, log / "configure.log")
    # Tests of what may not be written expect SIGSEGV itself.
    os.environ["TSAN_OPTIONS"] = f"handle_segv=0 log_path={log / 'report'}"
    passed = {name: so for report in run_tests(run, built, log) for name, so in outcomes(report).items()}
    failed = sorted(name for name, so in passed.items() if not so)
    found = sorted(log.glob("report.*"))
    for report in found:
        print(report.read_text(errors="replace"))
    for name in failed:
        print(f"FAILED {name}")
    figures = {"tests": len(passed), "failed": len(failed), "reports": len(found)}
    verdict = "PASSED" if passed and not failed and not found else "FAILED"
    print(f"{run.name}: {verdict}, {len(passed)} tests, {len(found)} reports; {log.relative_to(ROOT)}")
    if run.name.endswith("_quick"):
        return int(verdict != "PASSED")
    version = subprocess.run(["g++", "-dumpfullversion"], capture_output=True, text=True, check=True).stdout
    return evidence.write(run.name, verdict, {"gcc": version.strip()}, figures, [], started)


if __name__ == "__main__":
    sys.exit(main())
