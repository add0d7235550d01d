"""Measures the kernel step against the limits of its specification and writes build/evidence/bench.json.

Time comes from `step_bench`, instructions from callgrind, text size and stack from the compiler's own report.
Times depend on the machine and its load, so no test asserts them: the evidence says FAILED when a figure is
above its limit, and the table marks it.
"""

import argparse
import datetime
import json
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
EVIDENCE = ROOT / "build/evidence"
CORE = ROOT / "kernel/src"
INCLUDES = ["-I", str(ROOT / "kernel/include"), "-I", str(CORE)]
CORTEX_M = ["arm-none-eabi-gcc", "-mcpu=cortex-m4", "-mthumb", "-Os"]
HOST = ["gcc", "-O3"]
CALLGRIND_STEPS = 500

LIMITS = {
    "step_ns_median": 1000,
    "step_ns_worst_path": 2000,
    "cortex_m_text_bytes": 16384,
    "stack_bytes": 1024,
}


def run(command: list[str]) -> str:
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def instructions_per_step(binary: Path, scenario: str) -> int:
    """Instructions of one measured step, averaged over a run in which callgrind counts nothing else."""
    out = EVIDENCE / f"callgrind.{scenario}.out"
    subprocess.run(
        [
            "valgrind",
            "--tool=callgrind",
            f"--callgrind-out-file={out}",
            "--toggle-collect=*measured_step*",
            str(binary),
            scenario,
            str(CALLGRIND_STEPS),
        ],
        check=True,
        capture_output=True,
    )
    summary = re.search(r"^(?:summary|totals): (\d+)", out.read_text(), re.MULTILINE)
    if summary is None:
        raise SystemExit(f"{out}: no totals; did measured_step run?")
    return int(summary.group(1)) // CALLGRIND_STEPS


def compile_core(compiler: list[str], directory: Path) -> list[Path]:
    """Compiles every file of the core; the compiler leaves its stack report beside each object."""
    shutil.rmtree(directory, ignore_errors=True)
    directory.mkdir(parents=True)
    objects = []
    for source in sorted(CORE.glob("*.c")):
        obj = directory / f"{source.stem}.o"
        run(
            [
                *compiler,
                "-std=c11",
                "-ffreestanding",
                "-DILK_FRAME_WORDS=32",
                "-fcallgraph-info=su",
                *INCLUDES,
                "-c",
                str(source),
                "-o",
                str(obj),
            ]
        )
        objects.append(obj)
    return objects


def text_bytes(objects: list[Path], size_tool: str) -> int:
    rows = run([size_tool, *map(str, objects)]).splitlines()[1:]
    return sum(int(row.split()[0]) for row in rows)


def stack_bytes(directory: Path, entry: str) -> int:
    """Deepest chain of calls from `entry`, by the compiler's frame sizes and call graph.

    The core has no recursion and no function pointer; a cycle or a frame of unbounded size is an error.
    """
    frames: dict[str, int] = {}
    calls: dict[str, set[str]] = {}
    for report in directory.glob("*.ci"):
        text = report.read_text()
        for title, label in re.findall(r'node: \{ title: "([^"]+)" label: "([^"]+)"', text):
            frame = re.search(r"(\d+) bytes \((\w+)", label)
            if frame is None:
                frames.setdefault(title, 0)
            elif frame.group(2) != "static":
                raise SystemExit(f"{title}: stack use is {frame.group(2)}, expected static")
            else:
                frames[title] = int(frame.group(1))
        for source, target in re.findall(r'edge: \{ sourcename: "([^"]+)" targetname: "([^"]+)"', text):
            calls.setdefault(source, set()).add(target)

    def deepest(name: str, path: tuple[str, ...]) -> int:
        if name in path:
            raise SystemExit(f"recursion: {' -> '.join((*path, name))}")
        below = [deepest(callee, (*path, name)) for callee in sorted(calls.get(name, ()))]
        return frames.get(name, 0) + max(below, default=0)

    if entry not in frames:
        raise SystemExit(f"{entry}: not in the compiler's call graph")
    return deepest(entry, ())


def evidence(figures: dict[str, float], started: float, detail: dict) -> dict:
    commit = run(["git", "-C", str(ROOT), "rev-parse", "HEAD"]).strip()
    return {
        "id": "bench",
        "status": "PASSED" if all(figures[name] <= limit for name, limit in LIMITS.items()) else "FAILED",
        "tool": {"name": "step_bench, callgrind, gcc", "version": run(["gcc", "-dumpfullversion"]).strip()},
        "commit": commit,
        "date": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
        "duration_s": round(time.monotonic() - started, 1),
        "figures": figures,
        "supports": [],
        "log": "build/evidence/bench.log.json",
        "detail": detail,
    }


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bin", type=Path, default=ROOT / "build/release/bin")
    arguments = parser.parse_args()
    started = time.monotonic()
    EVIDENCE.mkdir(parents=True, exist_ok=True)

    binaries = {32: "step_bench", 64: "step_bench_64"}
    timed = {words: json.loads(run([str(arguments.bin / name)])) for words, name in binaries.items()}
    scenarios = timed[32]["scenarios"]
    counted = {name: instructions_per_step(arguments.bin / "step_bench", name) for name in scenarios}
    cortex = compile_core(CORTEX_M, ROOT / "build/bench/cortex-m")
    compile_core(HOST, ROOT / "build/bench/host")

    figures = {
        "step_ns_median": scenarios["moving"]["median_ns"],
        "step_ns_p999": scenarios["moving"]["p999_ns"],
        "step_ns_worst_path": max(scenario["median_ns"] for scenario in scenarios.values()),
        "step_ns_idle": scenarios["idle"]["median_ns"],
        "step_ns_median_64_words": timed[64]["scenarios"]["moving"]["median_ns"],
        "step_instructions_median": counted["moving"],
        "step_instructions_worst_path": max(counted.values()),
        "reference_ns": timed[32]["reference_ns"],
        "cortex_m_text_bytes": text_bytes(cortex, "arm-none-eabi-size"),
        "stack_bytes": max(
            stack_bytes(ROOT / "build/bench/cortex-m", "ilk_step"),
            stack_bytes(ROOT / "build/bench/host", "ilk_step"),
        ),
    }
    detail = {"timed": timed, "instructions": counted, "limits": LIMITS}
    record = evidence(figures, started, detail)
    (EVIDENCE / "bench.json").write_text(json.dumps(record, indent=2) + "\n")
    (EVIDENCE / "bench.log.json").write_text(json.dumps(detail, indent=2) + "\n")
    for name, value in figures.items():
        limit = LIMITS.get(name)
        beside = "" if limit is None else f"   limit {limit}{'' if value <= limit else '   ABOVE'}"
        print(f"{name:32} {value:>10}{beside}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
