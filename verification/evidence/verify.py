#!/usr/bin/env python3
"""Runs checks, above all the rungs of the verification ladder, and compares them with what they must show.

Usage: verify.py [--fresh] [--report NAME] [CHECK...]. Without names, those of verification/expected.toml that
`make verify` makes. Evidence that was made here or kept with the sources stands for a run while its inputs
and tools are the same. One kept check, drawn by the commit, is repeated all the same; --fresh (or FRESH=1)
repeats all. Each runs in a folder with copies of its inputs and of nothing else: what is not among them
cannot decide its result. Checks run side by side where cores (JOBS, all by default) and memory allow.

What a check prints goes to build/evidence/NAME/run.log, what it found wrong to failures.txt beside it. On
standard output comes a line for each check as it ends; then, for each that failed, its failures in the
project's terms; then the table of all. build/reports/verify.xml, or what --report names, is JUnit. Exits 1
unless every check has its expected status and its exact expected figures.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import textwrap
import threading
import time
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path

from evidence import ROOT, commit, failures_file, log_directory
from expected import KEPT, Check, UnusableError, drawn, read_checks
from keep import restore
from measure import measure

SHARED = ("evidence", "provers", "venv")
"""What a check finds of build/: where it writes, and what set-up installs by its pins."""
DRAWN_LIMIT_S = 480
"""A check that takes longer on its cores is not drawn."""
MOST_LINES = 500
"""So many lines of a check's failures are shown; the file has all of them."""
END_OF_LOG = 60
CONTROL = re.compile(r"[^\t\n\x20-\ud7ff\ue000-\ufffd]")
"""What a document in XML cannot hold."""
COUNTS_WIDTH, TOOLS_WIDTH = 66, 30


@dataclass(frozen=True)
class Result:
    check: Check
    evidence: dict[str, object]
    faults: tuple[str, ...]
    """What is not as expected, a sentence each; none when all is."""
    made: str = ""
    """`kept` for evidence of an earlier run; `drawn` where the commit asked for another one."""


def select(checks: Sequence[Check], names: Sequence[str]) -> list[Check]:
    """The checks of these names, or those of `make verify`. Raises UnusableError for an unknown name."""
    able = {check.name: check for check in checks if check.command}
    unknown = sorted(set(names) - set(able))
    if unknown:
        raise UnusableError(f"no check '{unknown[0]}'; expected one of {', '.join(able)}")
    return [one for one in able.values() if one.name in names or (not names and one.target == "make verify")]


@contextmanager
def copy_of_inputs(check: Check) -> Iterator[Path]:
    """A folder with the inputs of a check, and what set-up installs, alone."""
    with tempfile.TemporaryDirectory(prefix=f"interlock-{check.name}-") as folder:
        tree = Path(folder).resolve()
        for file in check.files():
            copy = tree / file.relative_to(ROOT)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(file, copy)
        (tree / "build").mkdir()
        for name in SHARED:
            (tree / "build" / name).symlink_to(ROOT / "build" / name)
        yield tree


def run(check: Check, drawn: bool) -> Result:
    """Runs one check. The exit status alone never makes it good."""
    failures_file(check.name).unlink(missing_ok=True)
    environment = {"JOBS": str(check.cores), "PYTHONDONTWRITEBYTECODE": "1", "SOURCE_COMMIT": commit()}
    with (log_directory(check.name) / "run.log").open("wb") as log, copy_of_inputs(check) as tree:
        exit_status = measure(
            check,
            check.command.split(),
            tree,
            env=os.environ | environment,
            stdin=subprocess.DEVNULL,
            stdout=log,
            stderr=log,
        )
    evidence = check.evidence()
    faults = check.faults(evidence) if evidence else [f"left no evidence; exit status {exit_status}"]
    if exit_status and not faults:
        faults.append(f"exit status {exit_status}")
    if drawn and faults:
        kept = check.evidence(KEPT)
        faults.append(f"differs from what is kept, made of {str(kept['commit'])[:12]} on {kept['date']}")
    return Result(check, evidence, tuple(faults), "drawn" if drawn else "")


def kept(check: Check) -> Result | None:
    """The result of an earlier run over the same inputs, here or as kept, if it is as it must be."""
    restore(check)
    evidence = check.evidence()
    return Result(check, evidence, (), "kept") if check.holds() and not check.faults(evidence) else None


def repeated_here(check: Check) -> bool:
    """Whether build/evidence has the check of these inputs from another run than the one that is kept."""
    return check.holds() and check.evidence() != check.evidence(KEPT)


class Machine:
    """Cores and memory for checks while they run. A check that wants more than there is gets all of it."""

    def __init__(self, cores: int, memory_gb: float) -> None:
        self.changed = threading.Condition()
        self.whole = (cores, memory_gb)
        self.free = [float(cores), memory_gb]

    def run(self, check: Check, drawn: bool) -> Result:
        wants = [min(check.cores, self.whole[0]), min(check.memory_gb, self.whole[1])]
        with self.changed:
            self.changed.wait_for(
                lambda: all(want <= free for want, free in zip(wants, self.free, strict=True))
            )
            self.free = [free - want for want, free in zip(wants, self.free, strict=True)]
        try:
            return run(check, drawn)
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
    return f"{result.evidence.get('duration_s', '-')}{f' ({result.made})' if result.made else ''}"


def progress(result: Result) -> str:
    """What is said of a check when it ends: name, status, seconds, and what is not as expected."""
    row = f"{result.check.name:<12} {verdict_of(result):<8} {seconds_of(result):>13} s"
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
    """All checks: status, seconds, counts, tools with their versions, and what is not as expected."""
    lines = [f"{'check':<12} {'status':<8} {'seconds':>13}  {'counts':<{COUNTS_WIDTH}}  tools"]
    for result in results:
        figures = dict(result.evidence.get("figures", {}))
        counts = wrapped([f"{name}={value:,}" for name, value in figures.items()], COUNTS_WIDTH)
        tools = wrapped([f"{tool}," for tool in tools_of(result)], TOOLS_WIDTH)
        head = f"{result.check.name:<12} {verdict_of(result):<8} {seconds_of(result):>13}"
        for left, middle, right in zip_longest([head], counts, tools, fillvalue=""):
            lines.append(f"{left:<35}  {middle:<{COUNTS_WIDTH}}  {right}".rstrip(" ,"))
        lines += [f"{'':<12} {fault}" for fault in result.faults]
    return "\n".join(lines)


def failures_of(result: Result) -> str:
    """What the check found wrong, within a bound; the end of its log when it told nothing."""
    told, log = failures_file(result.check.name), log_directory(result.check.name) / "run.log"
    source, most = (told, MOST_LINES) if told.is_file() else (log, END_OF_LOG)
    lines = source.read_text("utf-8", "replace").splitlines() if source.is_file() else []
    name = source.relative_to(ROOT)
    if source == log:
        return "\n".join([f"--- {result.check.name}: the end of {name}:", *lines[-most:]])
    left_out = [f"... {len(lines) - most} more lines in {name}"] if len(lines) > most else []
    return "\n".join([f"--- {result.check.name}: what it found wrong ({name}):", *lines[:most], *left_out])


def climb(checks: Sequence[Check], again: Check | None, fresh: bool, cores: int) -> list[Result]:
    """Runs what must be run, the drawn check `again` too, and says of each how it ended at once.

    The results keep the order of the checks.
    """
    results: dict[str, Result] = {}
    printing = threading.Lock()
    machine = Machine(cores, free_memory_gb())

    def note(result: Result) -> None:
        with printing:
            results[result.check.name] = result
            print(progress(result), flush=True)

    threads: dict[str, threading.Thread] = {}

    def run_in_turn(check: Check) -> None:
        for name in check.after:
            if name in threads:
                threads[name].join()
        note(machine.run(check, check == again))

    for check in checks:
        found = None if fresh or check == again else kept(check)
        missing = check.missing_tools()
        if found:
            note(found)
        elif missing:
            fault = (
                f"cannot run: this machine has no {', '.join(missing)}, and set-up knows none for its Debian"
            )
            note(Result(check, {}, (fault,)))
        else:
            threads[check.name] = threading.Thread(target=run_in_turn, args=(check,))
    for thread in threads.values():
        thread.start()
    for thread in threads.values():
        thread.join()
    return [results[check.name] for check in checks]


def write_junit(results: Sequence[Result], name: str, path: Path) -> None:
    suite = ElementTree.Element("testsuite", name=name, tests=str(len(results)))
    for result in results:
        case = ElementTree.SubElement(suite, "testcase", classname=name, name=result.check.name)
        case.set("time", str(result.evidence.get("duration_s", 0)))
        if result.faults:
            failure = ElementTree.SubElement(case, "failure", message="; ".join(result.faults))
            failure.text = CONTROL.sub("?", failures_of(result))
    path.parent.mkdir(parents=True, exist_ok=True)
    ElementTree.ElementTree(suite).write(path, encoding="utf-8", xml_declaration=True)


def main() -> int:
    parser = argparse.ArgumentParser(description="Run checks, without names the verification ladder.")
    parser.add_argument("checks", nargs="*", metavar="CHECK")
    parser.add_argument("--fresh", action="store_true", default=os.environ.get("FRESH") == "1")
    parser.add_argument("--report", default="verify", help="name of the JUnit report")
    arguments = parser.parse_args()
    started = time.monotonic()
    try:
        checks = read_checks()
        chosen = select(checks, arguments.checks)
        for check in chosen:
            check.key()
        again = None if arguments.fresh else drawn(checks, DRAWN_LIMIT_S)
        again = None if again and repeated_here(again) else again
        results = climb(chosen, again, arguments.fresh, int(os.environ.get("JOBS", os.cpu_count() or 1)))
    except UnusableError as error:
        print(f"verify: {error}", file=sys.stderr)
        return 2
    report = ROOT / "build" / "reports" / f"{arguments.report}.xml"
    write_junit(results, arguments.report, report)
    failed = [result for result in results if result.faults]
    for result in failed:
        print(failures_of(result))
    print("\n" + table(results))
    seconds = time.monotonic() - started
    print(f"{len(results) - len(failed)} of {len(results)} checks as expected in {seconds:.0f} s")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
