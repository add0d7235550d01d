"""Wake-ups and loop times of a whole robot, with cyclictest on the same core at the same time.

`interlock run` starts everything; only its kernel is `loop_bench`, which is the executive with a note of each
tick. cyclictest has the executive's priority and period, and wakes up half a period after it, so that
neither finds the core taken by the other. Both are judged over the same seconds.

Cards answer in their own time, however busy the machine: the simulator that stands for them has a priority
above the loop's and another core. A tick that still waits for it at the next deadline does not wake up: such
ticks count as `held_up`, and their times are in the loop times alone.

`before` is the arrangement that the thesis began with (loop_bench.cpp); there the app runs SCHED_RR, too.
"""

import contextlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2] / "tests/integration"))
sys.path.append(str(Path(__file__).resolve().parents[1] / "soak"))

import numpy as np
import stack
from motion import open_stream
from mover import BROKEN, Mover, connect, give_role, make_ready
from websockets.exceptions import ConnectionClosed

PRIORITY = 80
CARDS_PRIORITY = 90
PERIOD_US = 1000
BUS_PERIOD_US = 700
SETTLE_S = 2.0
MOST_LATE_US = 20_000
"""cyclictest counts wake-ups up to here one by one."""
SHARES = {"median": 0.5, "p99": 0.99, "p999": 0.999, "p9999": 0.9999}
NOTE = np.dtype([("begun_ns", "=u8"), ("late_ns", "=u8"), ("busy_until_ns", "=u8"), ("work_ns", "=u8")])


@dataclass(frozen=True)
class Arrangement:
    """One of the set-ups that are compared."""

    setup: str
    loaded: bool

    @property
    def name(self) -> str:
        return f"{self.setup}_{'loaded' if self.loaded else 'idle'}"


ARRANGEMENTS = tuple(
    Arrangement(setup, loaded) for setup in ("before", "shipped") for loaded in (False, True)
)


def core() -> int:
    """The core that the loop has: the last that this process may use."""
    return max(os.sched_getaffinity(0))


class Cyclictest:
    """cyclictest for some seconds, half a period after whole periods of CLOCK_MONOTONIC."""

    def __init__(self, seconds: int, period_us: int, log: Path) -> None:
        self._log = log
        self._process = subprocess.Popen(
            [
                "cyclictest",
                "--quiet",
                "--mlockall",
                "--threads=1",
                f"--affinity={core()}",
                f"--mainaffinity={min(os.sched_getaffinity(0))}",
                f"--priority={PRIORITY}",
                f"--interval={period_us}",
                f"--secaligned={period_us // 2}",
                f"--duration={seconds}",
                f"--histogram={MOST_LATE_US}",
                f"--json={log}",
            ],
            stdout=subprocess.DEVNULL,
        )

    def counts(self) -> np.ndarray:
        """Wake-ups by whole microseconds, once it has ended; the last place holds those beyond."""
        if self._process.wait():
            raise SystemExit("bench: cyclictest failed; it needs CAP_SYS_NICE and CAP_IPC_LOCK")
        return histogram_of(json.loads(self._log.read_text("utf-8")))


def histogram_of(report: dict) -> np.ndarray:
    """The wake-ups of cyclictest's one thread by microsecond, and at last those beyond its histogram."""
    thread = report["thread"]["0"]
    counts = np.zeros(MOST_LATE_US + 1, dtype=np.int64)
    for micros, count in thread["histogram"].items():
        counts[int(micros)] = count
    counts[MOST_LATE_US] += thread["cycles"] - counts.sum()
    return counts


def of_counts(counts: np.ndarray, period_us: int) -> dict[str, float]:
    """Median and tail of wake-ups that were counted by whole microseconds, and deadlines missed in sleep."""
    reached = np.cumsum(counts)
    return {
        "wakeups": int(reached[-1]),
        **{
            f"{name}_us": int(np.searchsorted(reached, share * reached[-1])) for name, share in SHARES.items()
        },
        "max_us": int(np.flatnonzero(counts)[-1]),
        "missed_deadlines": int(counts[period_us + 1 :].sum()),
    }


def of_notes(notes: np.ndarray, period_us: int) -> dict[str, dict[str, float]]:
    """Wake-up latency and loop time of the ticks that were noted, in us, and deadlines missed in sleep."""
    slept = notes["busy_until_ns"] < notes["begun_ns"] - notes["late_ns"]
    late_us = notes["late_ns"][slept] / 1e3
    loop_us = np.diff(notes["begun_ns"].astype(np.int64)) / 1e3
    return {
        "wake": {
            "wakeups": len(late_us),
            **{f"{name}_us": round(float(np.quantile(late_us, share)), 1) for name, share in SHARES.items()},
            "max_us": round(float(late_us.max()), 1),
        },
        "loop": {
            **{
                f"{name}_us": round(float(np.quantile(loop_us, share)), 1)
                for name, share in {"p001": 0.001, **SHARES}.items()
            },
            "min_us": round(float(loop_us.min()), 1),
            "max_us": round(float(loop_us.max()), 1),
        },
        "missed_deadlines": int((late_us > period_us).sum()),
        "held_up": int((~slept).sum()),
    }


def within(notes: np.ndarray, begun_ns: int, ended_ns: int) -> np.ndarray:
    return notes[(notes["begun_ns"] >= begun_ns) & (notes["begun_ns"] < ended_ns)]


def write_program(path: Path, command: str) -> None:
    """A program at that path which becomes the command, with its own arguments after it."""
    path.write_text(f'#!/bin/sh\nexec {command} "$@"\n', "utf-8")
    path.chmod(0o755)


def programs(binaries: Path, folder: Path, setup: str) -> None:
    """A folder of programs for `interlock run`: with the noted kernel, and the app as the set-up has it."""
    folder.mkdir()
    # Looked for beside the file that runs: a link would lead back to the kernel that is shipped.
    shutil.copy(binaries / "interlock", folder / "interlock")
    others = ",".join(map(str, sorted(os.sched_getaffinity(0) - {core()}))) or str(core())
    cards = f"taskset --cpu-list {others} chrt --fifo {CARDS_PRIORITY}"
    write_program(folder / "interlock-sim", f"{cards} {binaries / 'interlock-sim'}")
    as_thesis = f"chrt --rr {PRIORITY} " if setup == "before" else ""
    write_program(folder / "interlock-app", f"{as_thesis}{binaries / 'interlock-app'}")
    write_program(folder / "interlock-recorder", str(binaries / "interlock-recorder"))
    write_program(folder / "interlock-kernel", str(binaries / "loop_bench"))


def notes_environment(setup: str, seconds: int, notes: Path) -> dict[str, str]:
    """What loop_bench reads besides its command line; there is room for the time around the seconds, too."""
    return {
        "INTERLOCK_BENCH_SETUP": setup,
        "INTERLOCK_BENCH_SECONDS": str(seconds + 120),
        "INTERLOCK_BENCH_NOTES": str(notes),
    }


class Listener(threading.Thread):
    """What an open console hears: the whole stream."""

    def __init__(self, robot: stack.Stack) -> None:
        super().__init__(daemon=True)
        self.heard = 0
        self._stream = open_stream(robot)

    def run(self) -> None:
        with contextlib.suppress(ConnectionClosed):
            for _ in self._stream:
                self.heard += 1

    def end(self) -> None:
        self._stream.close()
        self.join()


HOG = "while True: pass"
DISK = (
    "import os,sys\n"
    "file = os.open(sys.argv[1], os.O_CREAT | os.O_WRONLY)\n"
    "while True:\n"
    "    os.pwrite(file, os.urandom(1 << 20), 0)\n"
    "    os.fsync(file)\n"
)


@contextlib.contextmanager
def hogs(folder: Path) -> Iterator[None]:
    """As many programs that only count as there are cores, and one that writes to the disk."""
    commands = [["-c", HOG]] * len(os.sched_getaffinity(0)) + [["-c", DISK, str(folder / "disk")]]
    running = [subprocess.Popen([sys.executable, *command]) for command in commands]
    try:
        yield
    finally:
        for process in running:
            process.kill()
            process.wait()


@contextlib.contextmanager
def load(robot: stack.Stack, folder: Path) -> Iterator[dict[str, int]]:
    """An open console, four OpenIGTLink programs and a robot that moves, beside disk and processor load."""
    done: dict[str, int] = {}
    robot.connect_control()
    mover = Mover(robot)
    with contextlib.suppress(*BROKEN):
        make_ready(robot)
    console = Listener(robot)
    console.start()
    clients = connect(robot)
    mover.start()
    try:
        with hogs(folder):
            yield done
    finally:
        mover.end()
        with contextlib.suppress(*BROKEN):
            give_role(robot, clients[0], "observer")
        for client in clients:
            client.end()
        console.end()
        done |= {
            "moves": mover.done,
            "console_messages": console.heard,
            "igtl_messages": sum(client.heard for client in clients),
        }


def measure(arrangement: Arrangement, seconds: int, binaries: Path, log: Path) -> dict:
    """One set-up for some seconds; the figures, and the notes themselves under `notes`."""
    with tempfile.TemporaryDirectory(prefix="interlock-bench-") as name:
        folder = Path(name)
        programs(binaries, folder / "bin", arrangement.setup)
        os.environ |= notes_environment(arrangement.setup, seconds, folder / "notes")
        stack.BIN = folder / "bin"
        own_core = ["--core", str(core())] if arrangement.setup == "shipped" else []
        options = ["--realtime", "--sockets", folder / "sockets", "--igtl-port", "0", *own_core]
        robot = stack.Stack(folder, "--robot", "neuro", *options)
        try:
            done: dict[str, int] = {}
            with load(robot, folder) if arrangement.loaded else contextlib.nullcontext(done) as done:
                time.sleep(SETTLE_S)
                beside = Cyclictest(seconds, PERIOD_US, log / f"cyclictest.{arrangement.name}.json")
                begun_ns = time.monotonic_ns()
                counts = beside.counts()
                ended_ns = time.monotonic_ns()
        finally:
            robot.close()
        notes = {
            loop: within(np.fromfile(folder / f"notes.{loop}", NOTE), begun_ns, ended_ns)
            for loop in (("main", "bus") if arrangement.setup == "before" else ("main",))
        }
    periods = {"main": PERIOD_US, "bus": BUS_PERIOD_US}
    figures = {loop: of_notes(each, periods[loop]) for loop, each in notes.items()}
    cyclictest = of_counts(counts, PERIOD_US)
    ratios = {
        name: round(figures["main"]["wake"][f"{name}_us"] / max(cyclictest[f"{name}_us"], 1), 2)
        for name in SHARES
    }
    return {
        "seconds": seconds,
        "loops": figures,
        "cyclictest": cyclictest,
        "wake_to_cyclictest": ratios,
        "load": done,
        "notes": notes,
    }
