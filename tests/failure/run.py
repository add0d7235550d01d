#!/usr/bin/env python3
"""Shows that tests notice faults: applies each seeded fault to a copy of the tree and wants its test to fail.

A fault is a file tests/failure/NAME.patch. Before the diff it says, one `# key: value` a line,

  target  what to build and run: the CMake target of a GoogleTest program, or `pytest`, after which may stand
          the CMake target that its test needs, such as `pytest programs`
  test    the test that must fail: a --gtest_filter, or a pytest node id
  expect  a regular expression that the failing output must contain
  why     which promise the fault breaks
  proof   optional: `RUNG PART: MESSAGE`, what a proof must say of it (verification/mutation/faults.py)

A fault counts as noticed when the test passes without the patch, and with it still builds, fails, and
says what `expect` wants. Everything else, a patch that no longer applies included, is a failure.

A fault that was noticed is not seeded again while its patch, the sources of its test program and the compiler
are the same: verification/evidence/kept/noticed-faults has their keys, build/release/noticed-faults those of
all that were noticed here. Of the other faults a third is seeded, chosen by the commit, and one of those that
are kept; with --all or FRESH=1 all are.
"""

import argparse
import contextlib
import hashlib
import os
import re
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2] / "verification/toolchain"))

from built import Build, keys_in, output_of

ROOT = Path(__file__).resolve().parents[2]
KEPT = "verification/evidence/kept/noticed-faults"
KEYS = {"target", "test", "expect", "why"}
OPTIONAL = {"proof"}
IN_COPY = Path(__file__).with_name("in_copy.sh")
NO_COMMAND = {
    101: "no copy of the tree: an overlay needs root or user namespaces",
    102: "the patch no longer applies; renew it",
    103: "does not build",
}
"""What in_copy.sh says when it did not come to its command."""
TIMEOUT_S = 900


class UnusableError(Exception):
    """The fault could not be judged; the text says what to correct."""


@dataclass(frozen=True)
class Fault:
    path: Path
    target: str
    test: str
    expect: str
    why: str

    @property
    def name(self) -> str:
        return self.path.stem


def read_fault(path: Path) -> Fault:
    """Reads the header of a patch; raises UnusableError naming the file and the key that is wrong."""
    head = path.read_text("utf-8").partition("\n--- ")[0]
    told = dict(re.findall(r"^# (\w+): (.+)$", head, re.MULTILINE))
    found = {key: text for key, text in told.items() if key not in OPTIONAL}
    if set(found) != KEYS:
        wrong = ", ".join(sorted(set(found) ^ KEYS))
        raise UnusableError(f"{path.name}: header keys missing or unknown: {wrong}; see tests/failure/run.py")
    try:
        re.compile(found["expect"])
    except re.error as error:
        raise UnusableError(f"{path.name}: 'expect' is no regular expression: {error}") from error
    return Fault(path, **found)


def choose(paths: list[Path], seed: str) -> list[Path]:
    """A third of the faults, rounded up, spread evenly over all of them as the seed changes."""
    ranked = sorted(paths, key=lambda path: hashlib.sha256(f"{seed} {path.stem}".encode()).digest())
    return sorted(ranked[: -(-len(paths) // 3)])


def keys_of(root: Path, paths: Sequence[Path]) -> dict[Path, str]:
    """What decides whether each fault is noticed; left out where no build says it."""
    build, compiler = Build(root / "build/release", root), output_of("g++", "--version", cwd=root)
    keys = {}
    for path in paths if (build.folder / "build.ninja").is_file() else ():
        with contextlib.suppress(UnusableError):
            keys[path] = build.program_key(
                read_fault(path).target.split()[-1], compiler, path.read_text("utf-8")
            )
    return {path: key for path, key in keys.items() if key}


def choose_changed(paths: list[Path], keys: Mapping[Path, str], known: set[str], seed: str) -> list[Path]:
    """A third of the faults that are not known to be noticed, and one of those that are."""
    old = [path for path in paths if keys.get(path) in known]
    changed = [path for path in paths if path not in old]
    again = sorted(old, key=lambda path: hashlib.sha256(f"{seed} {path.stem}".encode()).digest())[:1]
    chosen = choose(changed, seed)
    print(
        f"selftest: {len(chosen)} of {len(changed)} seeded faults, {len(again)} of {len(old)} noticed before"
    )
    return sorted([*chosen, *again])


def check_applies(root: Path, fault: Fault) -> None:
    """Raises UnusableError unless the fault can be seeded into the tree under `root`."""
    done = subprocess.run(
        ["git", "apply", "--check", fault.path], cwd=root, capture_output=True, text=True, check=False
    )
    if done.returncode:
        raise UnusableError(f"{fault.path.name} no longer applies; renew it: {done.stderr.strip()}")


def check(root: Path, paths: list[Path]) -> int:
    """Names the faults that cannot be seeded any more; 1 when there is one."""
    wrong = 0
    for path in paths:
        try:
            check_applies(root, read_fault(path))
        except UnusableError as error:
            wrong = 1
            print(error)
    return wrong


def run_in_copy(
    root: Path, patch: Path | None, target: str, command: Sequence[str]
) -> subprocess.CompletedProcess[str]:
    """Runs a command in a copy of the tree under `root`, build included; what changes there does not last.

    The patch is seeded before, and the CMake target built; without a name each is left out. Raises
    UnusableError when it does not come to the command, or the command to no end.
    """
    user = [] if os.geteuid() == 0 else ["--user", "--map-root-user"]
    try:
        done = subprocess.run(
            ["unshare", "--mount", *user, IN_COPY, root, patch or "", target, *command],
            env=os.environ | {"PYTHONDONTWRITEBYTECODE": "1"},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=TIMEOUT_S,
            check=False,
        )
    except subprocess.TimeoutExpired as error:
        raise UnusableError(f"no end within {TIMEOUT_S} s: {' '.join(command)}") from error
    if done.returncode in NO_COMMAND:
        raise UnusableError(f"{NO_COMMAND[done.returncode]}: {tail(done.stdout + done.stderr)}")
    return done


def run_test(root: Path, fault: Fault, patch: Path | None) -> subprocess.CompletedProcess[str]:
    """Runs the test that the fault names, with the patch or without one."""
    runner, _, needed = fault.target.partition(" ")
    if runner == "pytest":
        return run_in_copy(root, patch, needed, [sys.executable, "-m", "pytest", "-q", fault.test])
    program = f"build/release/bin/{fault.target}"
    return run_in_copy(root, patch, fault.target, [program, f"--gtest_filter={fault.test}"])


def passes(done: subprocess.CompletedProcess[str]) -> bool:
    """Whether a test ran and none failed: GoogleTest also exits 0 when its filter selects nothing."""
    return done.returncode == 0 and "Running 0 tests" not in done.stdout


def tail(text: str) -> str:
    return "\n".join(text.splitlines()[-15:])


def complaint(root: Path, path: Path) -> tuple[str, str]:
    """The test that a fault names, and what is wrong with its detection: nothing when noticed as expected."""
    test = ""
    try:
        fault = read_fault(path)
        test = fault.test
        healthy = run_test(root, fault, None)
        if not passes(healthy):
            return test, f"the test does not pass without the patch:\n{tail(healthy.stdout + healthy.stderr)}"
        seeded = run_test(root, fault, path)
    except UnusableError as error:
        return test, str(error)
    if seeded.returncode == 0:
        return test, f"unnoticed: {test} passes although {fault.why}"
    said = seeded.stdout + seeded.stderr
    if not re.search(fault.expect, said):
        return test, f"noticed for another reason; no match of /{fault.expect}/ in:\n{tail(said)}"
    return test, ""


def judge(root: Path, path: Path) -> ElementTree.Element:
    """The fault as a test case, which is printed: failed unless the fault was noticed as expected."""
    start = time.monotonic()
    test, wrong = complaint(root, path)
    seconds = time.monotonic() - start
    case = ElementTree.Element("testcase", classname="selftest", name=path.stem, time=f"{seconds:.3f}")
    if wrong:
        ElementTree.SubElement(case, "failure", message=wrong.splitlines()[0]).text = wrong
    state = "FAILED " if wrong else "noticed"
    print(f"{state}  {path.stem:<32} {seconds:6.1f} s  {wrong or test}", flush=True)
    return case


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", help="faults to seed (default: a third, by the seed)")
    parser.add_argument("--all", action="store_true", help="seed every fault")
    parser.add_argument("--check", action="store_true", help="only show that each can still be seeded")
    parser.add_argument("--seed", help="chooses the third (default: the commit)")
    parser.add_argument("--root", type=Path, default=ROOT, help="source tree (default: this one)")
    arguments = parser.parse_args()
    root: Path = arguments.root.resolve()

    paths = sorted((root / "tests/failure").glob("*.patch"))
    if arguments.check:
        return check(root, paths)
    keys, here = keys_of(root, paths), root / "build/release/noticed-faults"
    known = keys_in(root / KEPT) | keys_in(here)
    if arguments.names:
        unknown = set(arguments.names) - {path.stem for path in paths}
        if unknown:
            parser.error(f"no fault tests/failure/{', '.join(sorted(unknown))}.patch")
        chosen = [path for path in paths if path.stem in arguments.names]
    elif arguments.all or os.environ.get("FRESH") == "1":
        chosen = paths
    else:
        seed = arguments.seed or output_of("git", "rev-parse", "HEAD", cwd=root).strip()
        chosen = choose_changed(paths, keys, known, seed)
    if not chosen:
        print("selftest: no fault was seeded; expected patches in tests/failure/", file=sys.stderr)
        return 1

    with ThreadPoolExecutor(os.cpu_count()) as workers:
        cases = list(workers.map(partial(judge, root), chosen))
    failures = sum(len(case) for case in cases)
    noticed = {case.get("name") for case in cases if not len(case)}
    seeded = {path.stem for path in chosen}
    lines = [
        f"{key} {path.stem}\n"
        for path, key in keys.items()
        if path.stem in noticed or (key in known and path.stem not in seeded)
    ]
    if lines:
        here.write_text("".join(sorted(lines)), "utf-8")
    suite = ElementTree.Element("testsuite", name="selftest", tests=str(len(cases)), failures=str(failures))
    suite.extend(cases)
    report = root / "build/reports/selftest.xml"
    report.parent.mkdir(parents=True, exist_ok=True)
    ElementTree.ElementTree(suite).write(report, encoding="utf-8", xml_declaration=True)
    print(f"selftest: {len(chosen) - failures} noticed, {failures} failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
