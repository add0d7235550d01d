#!/usr/bin/env python3
"""Runs the rungs of the verification ladder and holds what they show against what they must show.

Usage: verify.py [--fresh] [RUNG...]. Without names, every rung of verification/expected.toml. A rung whose
inputs have not changed since it last showed what it must is not run again, unless --fresh (or FRESH=1) forces
it. Rungs run side by side where cores (JOBS, all by default) and memory allow.

What a rung prints goes to build/evidence/ID/run.log, what it found wrong to build/evidence/ID/failures.txt.
Results on standard output: a line for each rung as it ends; then, for each that failed, its failures in the
project's terms; at the end the table of all rungs, whole. build/evidence/summary.json is for machines,
build/reports/verify.xml is JUnit. Exits 1 unless every rung has its expected status and its exact expected
figures.
"""

import argparse
import json
import os
import re
import subprocess
import sys
import textwrap
import threading
import time
import xml.etree.ElementTree as ElementTree
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path

from evidence import EVIDENCE, ROOT, commit, failures_file, log_directory
from ladder import EXPECTED, Rung, UnusableError, content_key, read_expected, select

MOST_LINES = 500
"""So many lines of a rung's failures are shown; the file has all of them."""
END_OF_LOG = 60
CONTROL = re.compile(r"[^\t\n\x20-\ud7ff\ue000-\ufffd]")
"""What a document in XML cannot hold."""
COUNTS_WIDTH, TOOLS_WIDTH = 66, 30


@dataclass(frozen=True)
class Result:
    rung: Rung
    evidence: dict[str, object]
    faults: tuple[str, ...]
    """What is not as expected, a sentence each; none when all is."""
    cached: bool


def read_evidence(rung: Rung) -> dict[str, object]:
    """What the rung left behind, or an empty dictionary."""
    try:
        return json.loads((EVIDENCE / f"{rung.name}.json").read_text("utf-8"))
    except (OSError, json.JSONDecodeError):
        return {}


def faults_of(rung: Rung, evidence: dict[str, object], exit_status: int) -> tuple[str, ...]:
    """Where the evidence differs from what is expected. The exit status alone never makes a rung good."""
    if not evidence:
        return (f"left no evidence; exit status {exit_status}",)
    faults = []
    if evidence["status"] != rung.status:
        faults.append(f"status {evidence['status']}, expected {rung.status}")
    figures = evidence["figures"]
    for name, expected in rung.figures.items():
        found = figures.get(name)
        if found != expected:
            faults.append(f"{name} {'missing' if found is None else found}, expected {expected}")
    if exit_status and not faults:
        faults.append(f"exit status {exit_status}")
    return tuple(faults)


def run(rung: Rung) -> Result:
    """Runs one rung. Evidence of an earlier run is removed first, so that none can stand in for this one."""
    (EVIDENCE / f"{rung.name}.json").unlink(missing_ok=True)
    failures_file(rung.name).unlink(missing_ok=True)
    key_file = EVIDENCE / f"{rung.name}.key"
    key_file.unlink(missing_ok=True)
    key = content_key(rung)
    environment = os.environ | {"JOBS": str(rung.cores), "PYTHONDONTWRITEBYTECODE": "1"}
    with (log_directory(rung.name) / "run.log").open("wb") as log:
        done = subprocess.run(
            rung.command.split(), cwd=ROOT, env=environment, stdin=subprocess.DEVNULL, stdout=log, stderr=log
        )
    evidence = read_evidence(rung)
    faults = faults_of(rung, evidence, done.returncode)
    if not faults:
        key_file.write_text(key, "utf-8")
    return Result(rung, evidence, faults, cached=False)


def cached(rung: Rung) -> Result | None:
    """The result of an earlier run over the same inputs, if that run showed what it must."""
    try:
        same = (EVIDENCE / f"{rung.name}.key").read_text("utf-8") == content_key(rung)
    except OSError:
        return None
    evidence = read_evidence(rung)
    return Result(rung, evidence, (), cached=True) if same and evidence else None


class Machine:
    """Cores and memory, lent to rungs while they run. A rung that wants more than there is gets all of it."""

    def __init__(self, cores: int, memory_gb: float) -> None:
        self.changed = threading.Condition()
        self.whole = (cores, memory_gb)
        self.free = [float(cores), memory_gb]

    def run(self, rung: Rung) -> Result:
        wants = [min(rung.cores, self.whole[0]), min(rung.memory_gb, self.whole[1])]
        with self.changed:
            self.changed.wait_for(
                lambda: all(want <= free for want, free in zip(wants, self.free, strict=True))
            )
            self.free = [free - want for want, free in zip(wants, self.free, strict=True)]
        try:
            return run(rung)
        finally:
            with self.changed:
                self.free = [free + want for want, free in zip(wants, self.free, strict=True)]
                self.changed.notify_all()


def free_memory_gb() -> float:
    text = Path("/proc/meminfo").read_text("ascii")
    kibibytes = next(line.split()[1] for line in text.splitlines() if line.startswith("MemAvailable"))
    return int(kibibytes) / 2**20


def verdict_of(result: Result) -> str:
    return "FAILED" if result.faults else str(result.evidence["status"])


def seconds_of(result: Result) -> str:
    return f"{result.evidence.get('duration_s', '-')}{' (kept)' if result.cached else ''}"


def progress(result: Result) -> str:
    """What is said of a rung when it ends: rung, status, seconds, and what is not as expected."""
    row = f"{result.rung.name:<12} {verdict_of(result):<8} {seconds_of(result):>13} s"
    return "\n".join([row, *(f"{'':<12} {fault}" for fault in result.faults)])


def tools_of(result: Result) -> list[str]:
    """Each tool with its version."""
    tool = dict(result.evidence.get("tool", {"name": "-", "version": ""}))
    names, versions = tool["name"].split(", "), tool["version"].split(", ")
    return [f"{name} {version}".strip() for name, version in zip_longest(names, versions, fillvalue="?")]


def wrapped(items: Sequence[str], width: int) -> list[str]:
    """The items in lines of at most `width` characters; an item is never divided."""
    text = " ".join(item.replace(" ", "\xa0") for item in items)
    lines = textwrap.wrap(text, width, break_long_words=False, break_on_hyphens=False)
    return [line.replace("\xa0", " ") for line in lines] or ["-"]


def table(results: Sequence[Result]) -> str:
    """All rungs: status, seconds, counts, tools with their versions, and what is not as expected."""
    lines = [f"{'rung':<12} {'status':<8} {'seconds':>13}  {'counts':<{COUNTS_WIDTH}}  tools"]
    for result in results:
        figures = dict(result.evidence.get("figures", {}))
        counts = wrapped([f"{name}={value:,}" for name, value in figures.items()], COUNTS_WIDTH)
        tools = wrapped([f"{tool}," for tool in tools_of(result)], TOOLS_WIDTH)
        head = f"{result.rung.name:<12} {verdict_of(result):<8} {seconds_of(result):>13}"
        for left, middle, right in zip_longest([head], counts, tools, fillvalue=""):
            lines.append(f"{left:<35}  {middle:<{COUNTS_WIDTH}}  {right}".rstrip(" ,"))
        lines += [f"{'':<12} {fault}" for fault in result.faults]
    return "\n".join(lines)


def failures_of(result: Result) -> str:
    """What the rung found wrong, within a bound; the end of its log when it told nothing."""
    told, log = failures_file(result.rung.name), log_directory(result.rung.name) / "run.log"
    source, most = (told, MOST_LINES) if told.is_file() else (log, END_OF_LOG)
    lines = source.read_text("utf-8", "replace").splitlines() if source.is_file() else []
    name = source.relative_to(ROOT)
    if source == log:
        return "\n".join([f"--- {result.rung.name}: the end of {name}:", *lines[-most:]])
    left_out = [f"... {len(lines) - most} more lines in {name}"] if len(lines) > most else []
    return "\n".join([f"--- {result.rung.name}: what it found wrong ({name}):", *lines[:most], *left_out])


def climb(rungs: Sequence[Rung], fresh: bool, cores: int) -> list[Result]:
    """Runs what must be run, and says of each how it ended at once. The results keep the rungs' order."""
    results: dict[str, Result] = {}
    printing = threading.Lock()
    machine = Machine(cores, free_memory_gb())

    def note(result: Result) -> None:
        with printing:
            results[result.rung.name] = result
            print(progress(result), flush=True)

    threads: dict[str, threading.Thread] = {}

    def run_in_turn(rung: Rung) -> None:
        for name in rung.after:
            if name in threads:
                threads[name].join()
        note(machine.run(rung))

    for rung in rungs:
        kept = None if fresh else cached(rung)
        if kept:
            note(kept)
        else:
            threads[rung.name] = threading.Thread(target=run_in_turn, args=(rung,))
    for thread in threads.values():
        thread.start()
    for thread in threads.values():
        thread.join()
    return [results[rung.name] for rung in rungs]


def write_summary(results: Sequence[Result], seconds: float) -> None:
    document = {
        "commit": commit(),
        "duration_s": round(seconds, 1),
        "passed": not any(result.faults for result in results),
        "rungs": [
            {
                "expected_status": result.rung.status,
                "faults": result.faults,
                "kept": result.cached,
                **result.evidence,
            }
            for result in results
        ],
    }
    (EVIDENCE / "summary.json").write_text(json.dumps(document, indent=2) + "\n", "utf-8")


def write_junit(results: Sequence[Result], path: Path) -> None:
    suite = ElementTree.Element("testsuite", name="verify", tests=str(len(results)))
    for result in results:
        case = ElementTree.SubElement(suite, "testcase", classname="verify", name=result.rung.name)
        case.set("time", str(result.evidence.get("duration_s", 0)))
        if result.faults:
            failure = ElementTree.SubElement(case, "failure", message="; ".join(result.faults))
            failure.text = CONTROL.sub("?", failures_of(result))
    path.parent.mkdir(parents=True, exist_ok=True)
    ElementTree.ElementTree(suite).write(path, encoding="utf-8", xml_declaration=True)


def main() -> int:
    parser = argparse.ArgumentParser(description="Run the verification ladder.")
    parser.add_argument("rungs", nargs="*", metavar="RUNG")
    parser.add_argument("--fresh", action="store_true", default=os.environ.get("FRESH") == "1")
    arguments = parser.parse_args()
    started = time.monotonic()
    try:
        rungs = select(read_expected(EXPECTED), arguments.rungs)
        for rung in rungs:
            content_key(rung)
        results = climb(rungs, arguments.fresh, int(os.environ.get("JOBS", os.cpu_count() or 1)))
    except UnusableError as error:
        print(f"verify: {error}", file=sys.stderr)
        return 2
    write_summary(results, time.monotonic() - started)
    write_junit(results, ROOT / "build" / "reports" / "verify.xml")
    failed = [result for result in results if result.faults]
    for result in failed:
        print(failures_of(result))
    print("\n" + table(results))
    seconds = time.monotonic() - started
    print(f"{len(results) - len(failed)} of {len(results)} rungs as expected in {seconds:.0f} s")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
