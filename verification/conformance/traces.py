"""Runs of the real kernel, which the model must accept, and a doctored one, which it must reject."""

import re
from pathlib import Path

from tools import HERE, ROOT, ToolError, kernel_sources, run, tlc

FOLDER = ROOT / "build" / "evidence" / "conformance" / "traces"
SEEDS = (1, 2)
TICKS = 1000
DOCTORED = 400


def driver() -> Path:
    """Compiles the program that runs the kernel and prints what it did. Raises ToolError."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    program, kernel = FOLDER / "driver", ROOT / "kernel"
    flags = [
        "-std=c11",
        "-O2",
        "-Wall",
        "-Wextra",
        f"-I{kernel}/include",
        f"-I{kernel}/src",
        "-DILK_FRAME_WORDS=32",
    ]
    sources = [*map(str, sorted((HERE / "trace").glob("*.c"))), *kernel_sources(kernel, [])]
    status, _ = run(["gcc", *flags, *sources, "-o", str(program)], FOLDER / "gcc.log")
    if status != 0:
        raise ToolError(f"the driver of the traces does not compile; log {FOLDER / 'gcc.log'}")
    return program


def doctored(trace: str, tick: int) -> str:
    """The trace with another position than the kernel's in one tick."""
    lines = trace.split("\n")
    first = next(number for number, line in enumerate(lines) if line.startswith("<<<<"))
    parts = lines[first + tick - 1].rsplit(",<<", 2)
    words = parts[1].split(",")
    words[8] = str(int(words[8]) + 1)
    lines[first + tick - 1] = ",<<".join([parts[0], ",".join(words), parts[2]])
    return "\n".join(lines)


def judge(name: str, trace: str) -> tuple[int, int, str]:
    """What the model says of a trace; see `judge_in`."""
    folder = FOLDER / name
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "TraceData.tla").write_text(trace, "utf-8")
    return judge_in(folder)


def judge_in(folder: Path) -> tuple[int, int, str]:
    """What the model says of FOLDER/TraceData.tla: ticks accepted, the tick rejected or 0, the difference.

    Raises ToolError.
    """
    checks = {"SPECIFICATION": "Spec", "VIEW": "View", "INVARIANT": "Accepted", "CHECK_DEADLOCK": "FALSE"}
    status, text = tlc(HERE / "trace" / "Trace.tla", folder, {}, checks=checks)
    rejected = re.search(r'<<\s*"REJECTED",\s*(\d+),(.*?)^\S', text, re.DOTALL | re.MULTILINE)
    if rejected is not None:
        return int(rejected[1]) - 1, int(rejected[1]), " ".join(rejected[2].split())
    accepted = re.search(r'<<"ACCEPTED", (\d+)>>', text)
    if status != 0 or accepted is None:
        raise ToolError(f"TLC came to no end with the trace {folder.name} (status {status}):\n{text[-2000:]}")
    return int(accepted[1]), 0, ""


def check_all() -> tuple[int, list[str]]:
    """How many ticks the model accepted in all, and what is wrong."""
    program, steps, faults = driver(), 0, []
    for seed in SEEDS:
        _, trace = run([str(program), str(seed), str(TICKS)], FOLDER / f"seed-{seed}.log")
        accepted, rejected, difference = judge(f"seed-{seed}", trace)
        steps += accepted
        print(f"trace of seed {seed}: {accepted} ticks accepted", flush=True)
        if rejected:
            faults.append(
                f"trace of seed {seed}: the model rejects the kernel at tick {rejected}: {difference}"
            )
    _, rejected, _ = judge("doctored", doctored(trace, DOCTORED))
    print(f"doctored trace: rejected at tick {rejected}", flush=True)
    if rejected != DOCTORED:
        faults.append(f"the doctored trace is rejected at tick {rejected}, expected {DOCTORED}")
    return steps, faults
