#!/usr/bin/env python3
"""The coding rung: MISRA C:2012 by cppcheck's addon, gcc's warnings and analyser, clang-tidy.

PASSED: in core and executive, no finding that deviations.toml does not accept; no record that accepts
nothing; every guideline in enforcement.md, with a check that is run. VACUOUS: a checker did not see what was
seeded for it.
"""

import re
import subprocess
import sys
import time
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "evidence"))

import evidence
from plan import faults_of_plan
from records import read_records, settle
from tools import ROOT, Finding, ToolError, clang_tidy, cppcheck, gcc, generate_layout, scan

SEEDED = Path(__file__).resolve().parent / "seeded"
LOGS = evidence.log_directory("misra")


def files(*patterns: str) -> list[str]:
    """The matching files, from the top of the tree."""
    return sorted(str(path.relative_to(ROOT)) for pattern in patterns for path in ROOT.glob(pattern))


def log(name: str) -> Path:
    """An empty log of that name."""
    path = LOGS / f"{name}.log"
    path.write_text("", "utf-8")
    return path


def timed(name: str, started: float, found: set[Finding]) -> set[Finding]:
    print(f"{name:<28} {len(found):>4} findings {time.monotonic() - started:6.1f} s", flush=True)
    return found


def seeds() -> set[Finding]:
    """Every seeded violation: the check that must see it, and where."""
    found = set()
    for file in files("verification/misra/seeded/*/*.[ch]"):
        for number, line in enumerate((ROOT / file).read_text("utf-8").splitlines(), 1):
            match = re.search(r"seed: ((?:scan )?[\w.=-]+)", line)
            if match:
                found.add(Finding(match[1], file, number))
    return found


def find_seeds() -> set[Finding]:
    """What the checkers find in the seeded files, without the texts."""
    directory = "verification/misra/seeded"
    started = time.monotonic()
    found = cppcheck(files(f"{directory}/cppcheck/*.c"), log("seeded-cppcheck"))
    found |= gcc(files(f"{directory}/gcc/*.c"), log("seeded-gcc"))
    found |= clang_tidy(files(f"{directory}/clang-tidy/*.c"), log("seeded-clang-tidy"))
    found |= scan(files(f"{directory}/scan/*.[ch]"), core=True)
    timed("seeded violations", started, found)
    return {Finding(finding.check, finding.file, finding.line) for finding in found}


def find_all() -> set[Finding]:
    """What the checkers find in core and executive."""
    core = files("kernel/src/*.c", "kernel/src/*.h")
    host = files("kernel/host/*.c", "kernel/host/*.h", "kernel/host/include/**/*.h", "kernel/include/**/*.h")
    units = [file for file in core + host if file.endswith(".c")]
    checkers = {
        "cppcheck, MISRA C:2012": lambda: cppcheck(core + host, log("cppcheck")),
        "gcc warnings and analyser": lambda: gcc(units, log("gcc")),
        "clang-tidy": lambda: clang_tidy(units, log("clang-tidy")),
        "text scan": lambda: scan(core, core=True) | scan(host, core=False),
    }
    found: set[Finding] = set()
    for name, check in checkers.items():
        found |= timed(name, time.monotonic(), check())
    return found


def versions() -> dict[str, str]:
    def first(command: list[str], pattern: str) -> str:
        output = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        return re.search(pattern, output)[1]

    return {
        "cppcheck": first(["cppcheck", "--version"], r"(\d[\d.]+)"),
        "gcc": first(["gcc", "-dumpfullversion"], r"(\S+)"),
        "clang-tidy": first(["clang-tidy-19", "--version"], r"version (\S+)"),
    }


def main() -> int:
    started = time.monotonic()
    figures = {"findings": 0, "deviations": 0}
    try:
        generate_layout()
        wanted = seeds()
        unseen = sorted(wanted - find_seeds())
        records, faults = read_records()
        findings, more = settle(find_all(), records)
    except ToolError as error:
        evidence.Failures("misra").tell(f"misra: {error}")
        return evidence.write("misra", "UNKNOWN", versions(), figures, ["P15"], started)
    deviations = [record.rule for record in records if record.kind == "deviation"]
    disapplied = [record.rule for record in records if record.kind == "disapplied"]
    seen = {seed.check for seed in wanted if seed not in unseen}
    faults += more + faults_of_plan(seen, set(deviations), set(disapplied))
    failures = evidence.Failures("misra")
    for finding in findings:
        failures.tell(f"{finding.file}:{finding.line}: {finding.check}: {finding.text}")
    for seed in unseen:
        failures.tell(f"{seed.file}:{seed.line}: seeded violation of {seed.check} was not seen")
    for fault in faults:
        failures.tell(fault)
    figures = {
        "findings": len(findings),
        "faults_of_records": len(faults),
        "deviations": len(deviations),
        "disapplied": len(disapplied),
        "seeded": len(wanted),
        "seeded_found": len(wanted) - len(unseen),
    }
    status = "FAILED" if findings or faults else "VACUOUS" if unseen or not wanted else "PASSED"
    return evidence.write("misra", status, versions(), figures, ["P15"], started)


if __name__ == "__main__":
    sys.exit(main())
