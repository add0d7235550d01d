"""What a scenario does to the robot, as a context: the fault begins, and is ended and mended at its end."""

import contextlib
import ctypes
import os
import random
import re
import resource
import signal
import socket
import subprocess
import threading
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from bare_kernel import BIN, DEADLINE_S
from motion import open_stream
from plan import PROCESSES, Plan
from robots import Services, Supervised, environment_is

NS_PER_S = 1_000_000_000
DISK_BYTES = 48 << 20
MEMORY_LEFT_BYTES = 4 << 20
CROWD = 24
WRITES = 400
BROKEN_CONNECTION = (OSError, EOFError)

Fault = Callable[[Supervised, Plan, Path], contextlib.AbstractContextManager[None]]


def is_root() -> bool:
    """Of the machine, not only of a namespace."""
    return Path("/proc/self/uid_map").read_text().split() == ["0", "0", "4294967295"] and os.geteuid() == 0


class FaultError(Exception):
    """The fault did not come about, so that nothing is learnt from surviving it."""


def expect_all(done: Counter, kinds: Iterable[str], what: str) -> None:
    """Raises FaultError for a kind that was not done even once."""
    for kind in kinds:
        if not done[kind]:
            raise FaultError(f"no {what}: {kind}")


def run(*command: str | Path) -> None:
    subprocess.run([str(part) for part in command], check=True, capture_output=True)


# --- the disk ---


def mount_disk(state: Path, plan: Plan) -> None:
    """Gives the state directory a disk of its own, before the robot starts."""
    if plan.fault == "full_disk":
        state.mkdir(mode=0o700, parents=True)
        run("mount", "-t", "tmpfs", "-o", f"size={DISK_BYTES},mode=700", "tmpfs", state)
    elif plan.fault == "read_only_disk":
        image = state.with_suffix(".ext4")
        with image.open("wb") as file:
            file.truncate(DISK_BYTES)
        run("mkfs.ext4", "-q", "-E", "nodiscard,lazy_itable_init=1", image)
        attach_disk(state)


def attach_disk(state: Path) -> None:
    state.mkdir(mode=0o700, parents=True, exist_ok=True)
    run("mount", "-o", "loop", state.with_suffix(".ext4"), state)
    state.chmod(0o700)


@contextlib.contextmanager
def full_disk(robot: Supervised, plan: Plan, folder: Path) -> Iterator[None]:
    """Not one byte is left where the store, the logs and the recordings go."""
    filler = robot.state / "filler"
    with filler.open("wb", buffering=0) as file:
        with contextlib.suppress(OSError):
            while file.write(bytes(1 << 16)):
                pass
        yield
    filler.unlink()


@contextlib.contextmanager
def read_only_disk(robot: Supervised, plan: Plan, folder: Path) -> Iterator[None]:
    """As a file system does that finds its disk broken: it refuses to write from now on, under open files."""
    run("mount", "-o", "remount,abort", robot.state)
    yield


# --- processes ---


def kill(name: str) -> Fault:
    @contextlib.contextmanager
    def fault(robot: Supervised, plan: Plan, folder: Path) -> Iterator[None]:
        robot.signal(name, signal.SIGKILL)
        yield

    return fault


def freeze(name: str) -> Fault:
    @contextlib.contextmanager
    def fault(robot: Supervised, plan: Plan, folder: Path) -> Iterator[None]:
        robot.signal(name, signal.SIGSTOP)
        try:
            yield
        finally:
            robot.signal(name, signal.SIGCONT)

    return fault


def take_out(name: str) -> Fault:
    """Kills a service, and starts it again only at the end of the fault."""

    @contextlib.contextmanager
    def fault(robot: Services, plan: Plan, folder: Path) -> Iterator[None]:
        robot.kill(name)
        yield
        robot.start(name)

    return fault


@contextlib.contextmanager
def restart_in_order(robot: Services, plan: Plan, folder: Path) -> Iterator[None]:
    """All four die one after the other and come back one after the other, in two orders."""
    pause = threading.Event()
    gaps = iter(plan.gaps_s)
    for name in plan.end_order:
        pause.wait(next(gaps))
        robot.kill(name)
    yield
    for name in plan.start_order:
        pause.wait(next(gaps))
        robot.start(name)


# --- the machine ---


def prepare_clock(folder: Path) -> None:
    """Every program that is started from now on has a wall clock that can be stepped."""
    shift = folder / "clock_shift"
    shift.write_bytes(bytes(8))
    environment_is(LD_PRELOAD=str(BIN / "clock_shift.so"), INTERLOCK_CLOCK_SHIFT=str(shift))


@contextlib.contextmanager
def clock_step(robot: Supervised, plan: Plan, folder: Path) -> Iterator[None]:
    """To that time at once; it stays there."""
    with (folder / "clock_shift").open("r+b") as file:
        file.write(ctypes.c_int64(plan.clock_step_s * NS_PER_S))
    yield


@contextlib.contextmanager
def processor_load(robot: Supervised, plan: Plan, folder: Path) -> Iterator[None]:
    """Twice as many programs that only count as there are cores."""
    busy = ["sh", "-c", "while :; do :; done"]
    hogs = [subprocess.Popen(busy) for _ in range(2 * (os.cpu_count() or 1))]
    try:
        yield
    finally:
        for hog in hogs:
            hog.kill()
            hog.wait()


@contextlib.contextmanager
def memory_limit(robot: Supervised, plan: Plan, folder: Path) -> Iterator[None]:
    """The app gets a little more memory and then none, while a crowd asks it for much."""
    app = robot.pid("app")
    size = int(re.search(r"VmSize:\s+(\d+)", Path(f"/proc/{app}/status").read_text())[1]) << 10
    resource.prlimit(app, resource.RLIMIT_AS, (size + MEMORY_LEFT_BYTES, resource.RLIM_INFINITY))
    with stream_flood(robot, plan, folder):
        yield
    with contextlib.suppress(ProcessLookupError):
        unlimited = (resource.RLIM_INFINITY, resource.RLIM_INFINITY)
        resource.prlimit(app, resource.RLIMIT_AS, unlimited)


# --- the network ---


@contextlib.contextmanager
def flood(pour: Callable[[random.Random, threading.Event], None], plan: Plan) -> Iterator[None]:
    """A crowd that pours at the same time, until the fault ends."""
    ended = threading.Event()
    crowd = [
        threading.Thread(target=pour, args=(random.Random(f"{plan.noise}/{number}"), ended), daemon=True)
        for number in range(CROWD)
    ]
    for one in crowd:
        one.start()
    try:
        yield
    finally:
        ended.set()
        for one in crowd:
            one.join(DEADLINE_S)


@contextlib.contextmanager
def stream_flood(robot: Supervised, plan: Plan, folder: Path) -> Iterator[None]:
    """Consoles that open the stream and write into it without reading, ask much, or talk nonsense."""
    sent = Counter()

    def pour(dice: random.Random, ended: threading.Event) -> None:
        while not ended.is_set():
            with contextlib.suppress(*BROKEN_CONNECTION, Exception):
                if dice.random() < 0.5:
                    write_into_stream(dice, ended)
                else:
                    write_nonsense(dice, ended)

    def write_into_stream(dice: random.Random, ended: threading.Event) -> None:
        with open_stream(robot) as stream:
            for _ in range(WRITES):
                if ended.is_set():
                    return
                stream.send(dice.randbytes(dice.randint(1, 1 << 14)))
                sent["stream"] += 1

    def write_nonsense(dice: random.Random, ended: threading.Event) -> None:
        with socket.create_connection(("127.0.0.1", robot.port), DEADLINE_S) as connection:
            connection.setblocking(False)
            for _ in range(WRITES):
                if ended.wait(0.001):
                    return
                connection.send(b"GET /api/status HTTP/1.1\r\nHost: x\r\n\r\n" * dice.randint(1, 50))
                sent["HTTP"] += 1

    with flood(pour, plan):
        yield
    expect_all(sent, ("stream", "HTTP"), "message of the flood was sent")


@contextlib.contextmanager
def navigation_flood(robot: Supervised, plan: Plan, folder: Path) -> Iterator[None]:
    """OpenIGTLink programs that send as fast as they can, poses as well as noise, and do not read."""
    corpus = (Path(__file__).resolve().parents[2] / "tests/fuzz/corpus").rglob("*")
    seeds = [file.read_bytes() for file in sorted(corpus) if file.is_file()]
    sent = Counter()

    def pour(dice: random.Random, ended: threading.Event) -> None:
        while not ended.is_set():
            with (
                contextlib.suppress(OSError),
                socket.create_connection(("127.0.0.1", robot.igtl_port), DEADLINE_S) as connection,
            ):
                connection.setblocking(False)
                for _ in range(WRITES):
                    if ended.wait(0.001):
                        return
                    connection.send(dice.choice([dice.choice(seeds), dice.randbytes(dice.randint(1, 4096))]))
                    sent["OpenIGTLink"] += 1

    with flood(pour, plan):
        yield
    expect_all(sent, ["OpenIGTLink"], "message of the flood was sent")


# --- the link's memory ---


REGION_WRITERS = ("kernel", "app")
COUNTS_BYTES = 32
"""At the head of a region: what it is, and how far either side has written and read."""


def own_region(pid: int, process: str) -> tuple[int, int] | None:
    """Address and length of the region that this process alone may write; nothing while it has none."""
    maps = Path(f"/proc/{pid}/maps").read_text()
    mapping = rf"^([0-9a-f]+)-([0-9a-f]+) rw-s \S+ \S+ \d+ +/memfd:interlock-{process}-region"
    found = re.search(mapping, maps, re.MULTILINE)
    return found and (int(found[1], 16), int(found[2], 16) - int(found[1], 16))


@contextlib.contextmanager
def link_damage(robot: Supervised, plan: Plan, folder: Path) -> Iterator[None]:
    """Random bytes in both regions, or among their counts alone, each from the side that may write there."""
    ended = threading.Event()
    spoilt = Counter()
    dice = random.Random(plan.noise)
    only_counts = dice.random() < 0.5

    def spoil(process: str) -> None:
        pid = robot.pid(process)
        # A link that is found damaged is given up, its memory with it: then there is a new one.
        if region := own_region(pid, process):
            address, length = region
            with (
                contextlib.suppress(OSError),
                Path(f"/proc/{pid}/mem").open("r+b", buffering=0) as memory,
            ):
                memory.seek(address + dice.randrange((COUNTS_BYTES if only_counts else length) - 8))
                spoilt[process] += memory.write(dice.randbytes(dice.randint(1, 8)))

    def spoil_all() -> None:
        while not ended.wait(0.0005):
            spoil(dice.choice(REGION_WRITERS))

    spoiler = threading.Thread(target=spoil_all, daemon=True)
    spoiler.start()
    try:
        yield
    finally:
        ended.set()
        spoiler.join(DEADLINE_S)
    expect_all(spoilt, REGION_WRITERS, "byte was spoilt in the region")


FAULTS: dict[str, Fault] = {
    **{f"kill_{name}": kill(name) for name in ("app", "recorder", "supervisor")},
    **{f"kill_{name}": take_out(name) for name in ("kernel", "simulator")},
    **{f"freeze_{name}": freeze(name) for name in (*PROCESSES, "supervisor")},
    "full_disk": full_disk,
    "read_only_disk": read_only_disk,
    "clock_step": clock_step,
    "processor_load": processor_load,
    "memory_limit": memory_limit,
    "stream_flood": stream_flood,
    "navigation_flood": navigation_flood,
    "link_damage": link_damage,
    "restart_in_order": restart_in_order,
}
