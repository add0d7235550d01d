#!/usr/bin/env python3
"""Shows that tests notice faults: applies each seeded fault to a copy of the tree and wants its test to fail.

A fault is a file tests/failure/NAME.patch. Before the diff it says, one `# key: value` a line,

  target  what to build and run: the CMake target of a GoogleTest program, or `pytest`
  test    the test that must fail: a --gtest_filter, or a pytest node id
  expect  a regular expression that the failing output must contain
  why     which promise the fault breaks

A fault counts as noticed when the test passes without the patch, and with it still builds, fails, and
says what `expect` wants. Everything else, a patch that no longer applies included, is a failure.
"""

import argparse
import hashlib
import os
import re
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
KEYS = {"target", "test", "expect", "why"}
COPIED = ("CMakeLists.txt", "CMakePresets.json", "pyproject.toml", "app", "docs", "kernel", "models", "spec")
COPIED += ("tests", "verification", "web/src")
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
    found = dict(re.findall(r"^# (\w+): (.+)$", head, re.MULTILINE))
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


def git(directory: Path, *arguments: str) -> str:
    command = ["git", *arguments]
    return subprocess.run(command, cwd=directory, check=True, capture_output=True, text=True).stdout


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


class Tree:
    """A copy of the source tree under `work` in which faults are seeded, built and tested."""

    def __init__(self, source: Path, work: Path) -> None:
        self.source = source
        self.path = work / "tree"
        self.build = work / "build"
        self.restore()

    def command(self, *arguments: str | Path) -> subprocess.CompletedProcess[str]:
        # Without the ceiling git would find the enclosing repository and skip a patch for ignored files.
        environment = os.environ | {
            "GIT_CEILING_DIRECTORIES": str(self.path.parent),
            "PYTHONDONTWRITEBYTECODE": "1",
        }
        try:
            return subprocess.run(
                arguments,
                cwd=self.path,
                env=environment,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                errors="replace",
                timeout=TIMEOUT_S,
            )
        except subprocess.TimeoutExpired as error:
            raise UnusableError(f"no end within {TIMEOUT_S} s: {' '.join(map(str, arguments))}") from error

    def restore(self) -> None:
        """Makes the copy equal to the source, writing only what differs: builds stay incremental."""
        options = ("-z", "--cached", "--others", "--exclude-standard", "--", *COPIED)
        listed = git(self.source, "ls-files", *options).split("\0")
        wanted = {name for name in listed if name and (self.source / name).is_file()}
        for file in self.path.rglob("*"):
            if file.is_file() and str(file.relative_to(self.path)) not in wanted:
                file.unlink()
        for name in wanted:
            source, copy = self.source / name, self.path / name
            if not copy.is_file() or copy.read_bytes() != source.read_bytes():
                copy.parent.mkdir(parents=True, exist_ok=True)
                copy.write_bytes(source.read_bytes())
                copy.chmod(source.stat().st_mode)

    def apply(self, fault: Fault) -> None:
        done = self.command("git", "apply", fault.path.resolve())
        if done.returncode:
            raise UnusableError(f"the patch no longer applies; renew it: {done.stdout.strip()}")

    def run(self, fault: Fault) -> subprocess.CompletedProcess[str]:
        """Builds what the fault's test needs and runs it."""
        if fault.target == "pytest":
            return self.command(sys.executable, "-m", "pytest", "-q", fault.test)
        if not (self.build / "build.ninja").is_file():
            ruckig = f"-DINTERLOCK_RUCKIG={self.source / 'build/libraries/ruckig'}"
            self.must("cmake", "--preset", "release", "-B", self.build, ruckig)
        self.must("ninja", "-C", self.build, fault.target)
        return self.command(self.build / "bin" / fault.target, f"--gtest_filter={fault.test}")

    def must(self, *arguments: str | Path) -> None:
        done = self.command(*arguments)
        if done.returncode:
            raise UnusableError("does not build: " + "\n".join(done.stdout.splitlines()[-15:]))


def passes(done: subprocess.CompletedProcess[str]) -> bool:
    """Whether a test ran and none failed: GoogleTest also exits 0 when its filter selects nothing."""
    return done.returncode == 0 and "Running 0 tests" not in done.stdout


def tail(text: str) -> str:
    return "\n".join(text.splitlines()[-15:])


def check_healthy(tree: Tree, fault: Fault) -> None:
    """Raises UnusableError unless the fault's test passes on the unpatched tree."""
    healthy = tree.run(fault)
    if not passes(healthy):
        raise UnusableError(f"the test does not pass without the patch:\n{tail(healthy.stdout)}")


def complaint(tree: Tree, fault: Fault) -> str:
    """What is wrong with the fault's detection; empty when it was noticed as expected."""
    tree.restore()
    tree.apply(fault)
    seeded = tree.run(fault)
    if seeded.returncode == 0:
        return f"unnoticed: {fault.test} passes although {fault.why}"
    if not re.search(fault.expect, seeded.stdout):
        return f"noticed for another reason; no match of /{fault.expect}/ in:\n{tail(seeded.stdout)}"
    return ""


def judge(tree: Tree, paths: list[Path]) -> Iterator[tuple[Path, str, str, float]]:
    """Yields for each patch the test that it names, the complaint and the seconds taken.

    All tests run on the unpatched tree first: one build then serves them all.
    """
    faults: dict[Path, Fault] = {}
    complaints: dict[Path, str] = {}
    for path in paths:
        try:
            faults[path] = read_fault(path)
            check_healthy(tree, faults[path])
        except UnusableError as error:
            complaints[path] = str(error)
    for path in paths:
        start = time.monotonic()
        if path not in complaints:
            try:
                complaints[path] = complaint(tree, faults[path])
            except UnusableError as error:
                complaints[path] = str(error)
        test = faults[path].test if path in faults else ""
        yield path, test, complaints[path], time.monotonic() - start


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
    if arguments.names:
        unknown = set(arguments.names) - {path.stem for path in paths}
        if unknown:
            parser.error(f"no fault tests/failure/{', '.join(sorted(unknown))}.patch")
        chosen = [path for path in paths if path.stem in arguments.names]
    elif arguments.all:
        chosen = paths
    else:
        seed = arguments.seed or git(root, "rev-parse", "HEAD").strip()
        chosen = choose(paths, seed)
        print(f"selftest: {len(chosen)} of {len(paths)} seeded faults, chosen by seed {seed}")
    if not chosen:
        print("selftest: no fault was seeded; expected patches in tests/failure/", file=sys.stderr)
        return 1

    tree = Tree(root, root / "build/selftest")
    suite = ElementTree.Element("testsuite", name="selftest", tests=str(len(chosen)))
    failures = 0
    for path, test, result, seconds in judge(tree, chosen):
        attributes = {"classname": "selftest", "name": path.stem, "time": f"{seconds:.3f}"}
        case = ElementTree.SubElement(suite, "testcase", attributes)
        if result:
            failures += 1
            ElementTree.SubElement(case, "failure", message=result.splitlines()[0]).text = result
        state = "FAILED " if result else "noticed"
        print(f"{state}  {path.stem:<32} {seconds:6.1f} s  {result or test}", flush=True)
    tree.restore()
    suite.set("failures", str(failures))
    report = root / "build/reports/selftest.xml"
    report.parent.mkdir(parents=True, exist_ok=True)
    ElementTree.ElementTree(suite).write(report, encoding="utf-8", xml_declaration=True)
    print(f"selftest: {len(chosen) - failures} noticed, {failures} failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
