#!/usr/bin/env python3
"""Asks the model whether it accepts a recording of the black box: recorded.py PROGRAM RECORDING [--ticks N].

PROGRAM is model_trace, which tells the recording in parts of N ticks (1000). TLC lets the model take the
inputs and requests of each part, from the state that the kernel had before it, and compares verdicts, state
and outputs in every tick. Prints `the model accepts all N ticks`, or the first tick that it rejects and how
the two differ; ends with 1 then. JOBS says how many parts are checked side by side (1).
"""

import argparse
import os
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import traces
from tools import ToolError


@dataclass(frozen=True)
class Part:
    """One module, and the kernel's counter after its first tick."""

    folder: Path
    first_tick: int


def told(program: Path, recording: Path, folder: Path, ticks: int) -> list[Part]:
    """The recording as modules. Raises ToolError."""
    command = [program, recording, folder, str(ticks)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise ToolError(done.stderr.strip())
    firsts = map(int, done.stdout.split())
    return [Part(folder / f"{number:05}", first) for number, first in enumerate(firsts, 1)]


def check(parts: list[Part], jobs: int) -> int:
    """Prints what the model says of each part until it rejects one; the exit code."""
    accepted = 0
    with ThreadPoolExecutor(jobs) as pool:
        for part, (ticks, rejected, difference) in zip(
            parts, pool.map(lambda part: traces.judge_in(part.folder), parts), strict=True
        ):
            accepted += ticks
            if rejected:
                pool.shutdown(wait=False, cancel_futures=True)
                print(f"tick {part.first_tick + rejected - 1}: the model rejects it: {difference}")
                return 1
            print(f"model: {accepted} ticks accepted", file=sys.stderr, flush=True)
    print(f"the model accepts all {accepted} ticks")
    return 0 if accepted else 1


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=Path)
    parser.add_argument("recording", type=Path)
    parser.add_argument("--ticks", type=int, default=1000, help="of each part (1000)")
    arguments = parser.parse_args()
    try:
        with tempfile.TemporaryDirectory(prefix="interlock-model-") as folder:
            parts = told(arguments.program, arguments.recording, Path(folder), arguments.ticks)
            return check(parts, int(os.environ.get("JOBS", "1")))
    except ToolError as error:
        print(f"model: {error}", file=sys.stderr)
        return 3


if __name__ == "__main__":
    raise SystemExit(main())
