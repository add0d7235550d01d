"""Builds the kernel's unit tests around an instrumented core, with clang alone, and runs them."""

import os
import subprocess
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
JOBS = int(os.environ.get("JOBS", "1"))
INCLUDES = [f"-I{ROOT / 'kernel/include'}", f"-I{ROOT / 'kernel/src'}"]
INSTRUMENTED = ["-std=c11", "-ffreestanding", "-O0", "-g", "-Wall", "-Wextra", "-Werror"]
INSTRUMENTED += ["-fprofile-instr-generate", "-fcoverage-mapping", "-fcoverage-mcdc"]
TESTS = ["-std=c++20", "-O0"]
RANDOM_TESTS = "Seed/Hostile_world.*"
"""Tests that try what comes. What counts here is what the tests of the requirements cover by themselves."""


class BuildError(Exception):
    """The instrumented tests could not be built or did not pass; the text holds the output."""


def run(command: Sequence[str], environment: dict[str, str] | None = None) -> str:
    """Standard output of the command. Raises BuildError when it fails."""
    done = subprocess.run(
        command,
        cwd=ROOT,
        env=os.environ | (environment or {}),
        capture_output=True,
        text=True,
        errors="replace",
    )
    if done.returncode:
        raise BuildError(f"{' '.join(command)}\n{done.stdout[-4000:]}{done.stderr[-4000:]}")
    return done.stdout


def build(words: int, directory: Path) -> Path:
    """The test program for frames of that many words. A decision that clang cannot instrument is an error."""
    directory.mkdir(parents=True, exist_ok=True)
    define = f"-DILK_FRAME_WORDS={words}"
    header = directory / "gtest.pch"
    run(["clang++-19", *TESTS, define, "-x", "c++-header", "/usr/include/gtest/gtest.h", "-o", str(header)])
    jobs, objects = [], []
    for source in sorted((ROOT / "kernel/src").glob("*.c")):
        objects.append(directory / f"core_{source.stem}.o")
        jobs.append(["clang-19", *INSTRUMENTED, define, *INCLUDES, "-c", str(source), "-o", str(objects[-1])])
    for source in sorted((ROOT / "tests/unit/kernel").glob("*.cpp")):
        objects.append(directory / f"{source.stem}.o")
        command = ["clang++-19", *TESTS, define, *INCLUDES, "-include-pch", str(header)]
        jobs.append([*command, "-c", str(source), "-o", str(objects[-1])])
    with ThreadPoolExecutor(JOBS) as pool:
        list(pool.map(run, jobs))
    program = directory / "kernel_tests"
    run(
        [
            "clang++-19",
            "-fprofile-instr-generate",
            *map(str, objects),
            "-lgtest_main",
            "-lgtest",
            "-o",
            str(program),
        ]
    )
    return program


def export(program: Path, tests: str) -> str:
    """What a run of these tests covers, as llvm-cov's JSON. Raises BuildError when a test fails."""
    raw, merged = program.with_suffix(".profraw"), program.with_suffix(".profdata")
    raw.unlink(missing_ok=True)
    run([str(program), f"--gtest_filter={tests}", "--gtest_brief=1"], {"LLVM_PROFILE_FILE": str(raw)})
    run(["llvm-profdata-19", "merge", "-o", str(merged), str(raw)])
    return run(["llvm-cov-19", "export", f"-instr-profile={merged}", str(program), str(ROOT / "kernel")])
