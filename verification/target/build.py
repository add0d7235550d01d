"""Builds and runs the test images: for this machine, for a Cortex-A9 under Linux, for a bare Cortex-M4."""

import os
import shutil
import subprocess
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HERE = Path(__file__).resolve().parent
BUILD = ROOT / "build" / "target"
JOBS = int(os.environ.get("JOBS", "1"))
GTEST = Path("/usr/src/googletest/googletest")
CORE = sorted((ROOT / "kernel/src").glob("*.c"))
INCLUDES = [f"-I{ROOT / 'kernel/include'}", f"-I{ROOT / 'kernel/src'}", f"-I{HERE}", "-DILK_FRAME_WORDS=32"]
FLAGS = ["-std=c11", "-Wall", "-Wextra", "-Wshadow", "-Wconversion", "-Werror", *INCLUDES]
TIMEOUT_S = 900


class TargetError(Exception):
    """An image could not be built, or did not come to its end; the text holds the output."""


@dataclass(frozen=True)
class Machine:
    name: str
    compiler: tuple[str, ...]
    platform: str
    runner: tuple[str, ...]


NATIVE = Machine("x86-64", ("gcc", "-O2"), "linux.c", ())
CORTEX_A9 = Machine(
    "Cortex-A9", ("arm-linux-gnueabihf-gcc", "-mcpu=cortex-a9", "-O2", "-static"), "linux.c", ("qemu-arm",)
)
CORTEX_M4 = Machine(
    "Cortex-M4",
    (
        "arm-none-eabi-gcc",
        "-mcpu=cortex-m4",
        "-mthumb",
        "-Os",
        "-nostartfiles",
        "-T",
        str(HERE / "cortex_m.ld"),
    ),
    "cortex_m.c",
    tuple(
        [
            "qemu-system-arm",
            "-M",
            "mps2-an386",
            "-nographic",
            "-semihosting-config",
            "enable=on,target=native",
            "-kernel",
        ]
    ),
)


def run(command: Sequence[str], accepted: tuple[int, ...] = (0,)) -> str:
    """Output and error of the command. Raises TargetError for another exit status than the accepted ones."""
    try:
        done = subprocess.run(
            command,
            cwd=ROOT,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=TIMEOUT_S,
        )
    except subprocess.TimeoutExpired as error:
        raise TargetError(f"{' '.join(command)}\nno end after {TIMEOUT_S} s") from error
    if done.returncode not in accepted:
        raise TargetError(f"{' '.join(command)}\nexit status {done.returncode}\n{done.stdout[-4000:]}")
    return done.stdout


def image(
    machine: Machine, program: str, name: str, defines: Sequence[str], core: Sequence[Path] = CORE
) -> list[str]:
    """Builds trace.c, vectors.c or replay.c around the core; returns the command that runs it."""
    BUILD.mkdir(parents=True, exist_ok=True)
    output = BUILD / f"{machine.name}-{name}"
    parts = [HERE / f"{part}.c" for part in (program, "world", "counts", "told", "platform")]
    sources = [*core, *parts, HERE / machine.platform]
    if program in ("record", "replay"):
        sources += sorted((ROOT / "kernel/recording").glob("*.c"))
        defines = [*defines, *recording_flags()]
    if program == "record":
        sources += [ROOT / f"kernel/host/{part}.c" for part in ("black_box", "clock", "error")]
        defines = [*defines, "-D_GNU_SOURCE", f"-I{ROOT / 'kernel/host'}"]
    run([*machine.compiler, *FLAGS, *defines, *map(str, sources), "-o", str(output)])
    return [*machine.runner, str(output)]


def recording_flags() -> list[str]:
    """Include paths of the recording library, its generated table written."""
    recording, tables = ROOT / "kernel/recording", BUILD / "recorded_field_tables.h"
    headers = [ROOT / "kernel/include/interlock/types.h", recording / "include/interlock/recording.h"]
    run(["/usr/bin/python3", *map(str, (recording / "generate_recorded_fields.py", tables, *headers))])
    return [f"-I{recording / 'include'}", f"-I{BUILD}"]


def core_with(patch: str) -> list[Path]:
    """The core's sources with a seeded fault of tests/failure in them."""
    folder = BUILD / patch
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(ROOT / "kernel/src", folder / "kernel/src")
    run(["patch", "-p1", "-s", "-d", str(folder), "-i", str(ROOT / f"tests/failure/{patch}.patch")])
    return sorted((folder / "kernel/src").glob("*.c"))


def unit_tests() -> list[str]:
    """Builds the kernel's unit tests and GoogleTest, from Debian's sources of it, for the Cortex-A9."""
    directory = BUILD / "unit"
    directory.mkdir(parents=True, exist_ok=True)
    header = directory / "precompiled.hpp"
    header.write_text("#include <gtest/gtest.h>\n", "ascii")
    compiler = ["arm-linux-gnueabihf-g++", "-mcpu=cortex-a9", "-std=c++20", "-O1", "-Wno-psabi", *INCLUDES]
    compiler += [f"-I{GTEST / 'include'}", f"-I{GTEST}"]
    run([*compiler, "-x", "c++-header", str(header), "-o", f"{header}.gch"])
    compiler += ["-include", str(header)]
    sources = sorted((ROOT / "tests/unit/kernel").glob("*.cpp"))
    sources += [GTEST / "src/gtest-all.cc", GTEST / "src/gtest_main.cc"]
    objects = [str(directory / f"{source.stem}.o") for source in sources]
    jobs = [[*compiler, "-c", str(source), "-o", obj] for source, obj in zip(sources, objects, strict=True)]
    for source in CORE:
        objects.append(str(directory / f"core_{source.stem}.o"))
        jobs.append([*CORTEX_A9.compiler, *FLAGS, "-c", str(source), "-o", objects[-1]])
    with ThreadPoolExecutor(JOBS) as pool:
        list(pool.map(run, jobs))
    program = str(directory / "kernel_tests")
    run(["arm-linux-gnueabihf-g++", "-static", *objects, "-o", program])
    return [*CORTEX_A9.runner, program, "--gtest_brief=1"]
