#!/usr/bin/env python3
"""Runs the kernel's unit tests on a changed kernel: unit_tests.py TREE short|long.

The tests' objects are those of build/release, the kernel's come from TREE. Prints `FAILED TEST` for the first
test that fails; a program that crashes or does not end fails, too.
"""

import hashlib
import re
import resource
import signal
import subprocess
import sys
from pathlib import Path

from tree import ROOT

OBJECTS = ROOT / "build/release/tests/unit/kernel/CMakeFiles/kernel_tests.dir"
LONG = "*Hostile_world.*:P15_total.*:P4_soft_limit.a_coasting_axis_never_leaves_its_range"
"""Tests that take four fifths of the time; few mutants pass the others and not these."""
LIMIT_S = 60
"""Of processor time; the sound kernel's tests take 13. A mutant that loops for ever is met by it."""


def test_objects() -> list[Path]:
    """The compiled tests. Raises SystemExit when there are none."""
    found = sorted(OBJECTS.glob("*.o"))
    if not found:
        raise SystemExit("the unit tests are not built: make build")
    return found


def compile_kernel(kernel: Path, folder: Path) -> None:
    """Compiles what changed of the kernel since the last time in this folder."""
    folder.mkdir(parents=True, exist_ok=True)
    flags = ["-std=c11", "-O1", "-w", f"-I{kernel}/include", f"-I{kernel}/src", "-DILK_FRAME_WORDS=32"]
    headers = b"".join(path.read_bytes() for path in sorted(kernel.rglob("*.h")))
    changed = []
    for source in sorted((kernel / "src").glob("*.c")):
        key = hashlib.sha256(headers + source.read_bytes()).hexdigest()
        kept = folder / f"{source.stem}.key"
        if not kept.is_file() or kept.read_text("utf-8") != key:
            changed.append((source, kept, key))
    if changed:
        sources = [str(source) for source, _, _ in changed]
        subprocess.run(["gcc", *flags, "-c", *sources], cwd=folder, check=True, capture_output=True)
    for _, kept, key in changed:
        kept.write_text(key, "utf-8")


def limit_time() -> None:
    resource.setrlimit(resource.RLIMIT_CPU, (LIMIT_S, LIMIT_S + 1))


def verdict(program: Path, part: str) -> str:
    """What the short or the long tests say; empty when all pass."""
    chosen = LONG if part == "long" else f"-{LONG}"
    command = [str(program), "--gtest_fail_fast", "--gtest_brief=1", f"--gtest_filter={chosen}"]
    done = subprocess.run(
        command, capture_output=True, text=True, errors="replace", preexec_fn=limit_time, check=False
    )
    if done.returncode == -signal.SIGXCPU:
        return f"FAILED: no end within {LIMIT_S} s of processor time"
    failed = re.search(r"^\[  FAILED  \] (\S+?),? ", done.stdout, re.MULTILINE)
    if failed:
        return f"FAILED {failed[1]}"
    return "" if done.returncode == 0 else f"FAILED: ended with {done.returncode}"


def main() -> int:
    tree = Path(sys.argv[1]).resolve()
    folder = tree / "build/unit"
    compile_kernel(tree / "kernel", folder)
    program = folder / "kernel_tests"
    kernel = sorted(folder.glob("*.o"))
    subprocess.run(["g++", *test_objects(), *kernel, "-lgtest_main", "-lgtest", "-o", program], check=True)
    said = verdict(program, sys.argv[2])
    if said:
        print(said)
    return 0


if __name__ == "__main__":
    sys.exit(main())
