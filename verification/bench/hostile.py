"""Time of the executive's own work in a tick beside a hostile app, and beside an honest one, in one run.

The executive has its real-time rights and a core for itself; apps come and go in turns of TURN_S, honest
and hostile. The honest one keeps the ring full of good requests, so that the work is the same; what the
hostile one does is in tests/integration/hostile_app.py. The time is that from the end of a tick's transaction
to the end of the tick: the ring is read, the kernel steps, the snapshot is written. Half of the honest turns
are set against the other half: what differs there is noise.
"""

import json
import os
import random
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2] / "tests/integration"))

import bare_kernel
import numpy as np
import wakeups
from hostile_app import attach_after_worst, do_worst
from link_client import RING, LinkClient

TURN_S = 1.0
SHARE = 0.9999
TURNS = ("honest", "hostile", "honest_again", "hostile")


def honest_turn(path: Path, until_ns: int) -> int:
    client = LinkClient(path)
    begun_ns = time.monotonic_ns()
    while time.monotonic_ns() < until_ns:
        for _ in range(RING):
            client.request("HEARTBEAT", holder=1)
    client.close()
    return begun_ns


def hostile_turn(path: Path, until_ns: int) -> int:
    dice = random.Random(until_ns)
    begun_ns = time.monotonic_ns()
    client = attach_after_worst(path)
    while time.monotonic_ns() < until_ns:
        do_worst(client, dice)
    client.close()
    return begun_ns


def take_turns(path: Path, seconds: int) -> list[tuple[str, int, int]]:
    """Who was attached from when to when."""
    turns = []
    for n in range(max(len(TURNS), round(seconds / TURN_S))):
        kind = TURNS[n % len(TURNS)]
        turn: Callable[[Path, int], int] = hostile_turn if kind == "hostile" else honest_turn
        begun_ns = turn(path, time.monotonic_ns() + round(TURN_S * 1e9))
        turns.append((kind, begun_ns, time.monotonic_ns()))
    return turns


def of_turns(notes: np.ndarray, turns: list[tuple[str, int, int]]) -> dict[str, float]:
    """Time of the work beside each app in us; the ratio of both; and that of the two halves of the honest
    turns, the slower to the faster."""
    work_us: dict[str, np.ndarray] = {}
    for kind in TURNS:
        seen = [wakeups.within(notes, begun, ended) for name, begun, ended in turns if name == kind]
        work_us[kind] = np.concatenate(seen)["work_ns"] / 1e3
    halves = [float(np.quantile(work_us[kind], SHARE)) for kind in ("honest", "honest_again")]
    honest = np.concatenate([work_us["honest"], work_us["honest_again"]])
    figures = {}
    for kind, times in (("honest", honest), ("hostile", work_us["hostile"])):
        figures |= {
            f"work_us_median_{kind}": round(float(np.median(times)), 2),
            f"work_us_p9999_{kind}": round(float(np.quantile(times, SHARE)), 2),
            f"work_ticks_{kind}": len(times),
        }
    return figures | {
        "work_p9999_hostile_to_honest": round(
            figures["work_us_p9999_hostile"] / figures["work_us_p9999_honest"], 2
        ),
        "work_p9999_honest_to_honest": round(max(halves) / min(halves), 2),
    }


def measure(binaries: Path, seconds: int) -> dict[str, float]:
    cores = os.sched_getaffinity(0)
    core = wakeups.core()
    with tempfile.TemporaryDirectory(prefix="interlock-bench-") as name:
        folder = Path(name)
        wakeups.programs(binaries, folder / "bin", "shipped")
        os.environ |= wakeups.notes_environment("shipped", seconds, folder / "notes")
        bare_kernel.BIN = folder / "bin"
        kernel = bare_kernel.BareKernel(folder, "real", "--core", str(core))
        try:
            os.sched_setaffinity(0, cores - {core} or cores)
            turns = take_turns(kernel.link_path, seconds)
        finally:
            os.sched_setaffinity(0, cores)
            kernel.close()
        return of_turns(np.fromfile(folder / "notes.main", wakeups.NOTE), turns)


if __name__ == "__main__":
    print(json.dumps(measure(Path(sys.argv[1]), int(sys.argv[2])), indent=2))
