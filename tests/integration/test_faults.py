"""The table of faults on the real processes.

An axis is jogged, and the jog is held throughout; then comes the fault, then a STOP. In each row motion ends
in time, nothing that was asked before comes into force afterwards, the STOP is recorded, and the robot moves
again.
"""

import contextlib
import http.client
import os
import re
import resource
import signal
import socket
import subprocess
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import httpx
import pytest
from bare_kernel import BIN, DEADLINE_S, ROOT
from conftest import StackFactory
from frozen import frozen
from interface import judge
from motion import (
    LATERAL,
    enable,
    last_drive,
    plant_tick,
    press,
    to_motion,
    wait_for_ticks,
    wait_until,
    wait_until_driven,
)
from stack import Stack
from test_store_busy import busy_store

# Of the wall, which ticks of the paced clock never outrun.
ENDS_WITHIN_TICKS = 200
# As long as the door lets a STOP take; how fast it is, `make bench` measures.
STOPS_WITHIN_TICKS = 2000
LONG_AFTER_TICKS = 600
# After that the door takes what it finds for older than what it finds later.
SEEN_WITHIN_S = 0.3
# Too slow to arrive before the STOP.
MOVE = {"slot": LATERAL, "target_counts": -2000, "drive": 4752}
SPARE_DESCRIPTORS = 12
# More than the log's queue holds, and a pipe besides.
UNREAD_LINES = 4096 + 2000


class Crowd(threading.Thread):
    """Connections that send a request, or a piece of one, again and again, and take what comes. Whoever is
    turned away comes back."""

    def __init__(self, robot: Stack, size: int, first: str, more: str = "", pause_s: float = 0.0) -> None:
        super().__init__()
        self._port, self._pause_s = robot.port, pause_s
        self._first, self._more = first.encode(), more.encode()
        self._connections: list[socket.socket | None] = [None] * size
        self._left = threading.Event()
        self.connected: set[int] = set()
        self.served: set[int] = set()

    def run(self) -> None:
        with contextlib.ExitStack() as opened:
            while not self._left.wait(self._pause_s):
                for number in range(len(self._connections)):
                    try:
                        self._turn(number, opened)
                    except OSError:
                        self._connections[number] = None

    def _turn(self, number: int, opened: contextlib.ExitStack) -> None:
        connection = self._connections[number]
        if connection is None:
            connection = socket.create_connection(("127.0.0.1", self._port), DEADLINE_S)
            opened.enter_context(connection)
            connection.sendall(self._first)
            connection.setblocking(False)
            self._connections[number] = connection
            self.connected.add(number)
            return
        with contextlib.suppress(BlockingIOError):
            if not connection.recv(1 << 20):
                connection.close()
                raise ConnectionResetError
            self.served.add(number)
        with contextlib.suppress(BlockingIOError):
            connection.send(self._more)

    def leave(self) -> None:
        self._left.set()
        self.join()


@contextlib.contextmanager
def present(crowd: Crowd, is_there: Callable[[], bool]) -> Iterator[None]:
    crowd.start()
    try:
        wait_until("the crowd is there", is_there)
        yield
    finally:
        crowd.leave()


def request(robot: Stack, line: str, length: int = 0) -> str:
    return f"{line} HTTP/1.1\r\nHost: 127.0.0.1:{robot.port}\r\nContent-Length: {length}\r\n\r\n"


# --- what is thrown at the robot: a context each, in which the fault lasts ---


def thread_stands(name: str) -> Callable[[Stack], contextlib.AbstractContextManager[None]]:
    return lambda robot: frozen(robot.pid("app"), name)


@contextlib.contextmanager
def kernel_stands_for_5_s(robot: Stack) -> Iterator[None]:
    robot.signal("kernel", signal.SIGSTOP)
    begun = time.monotonic()
    try:
        yield
        wait_until("5 s have passed", lambda: time.monotonic() > begun + 5)
    finally:
        robot.signal("kernel", signal.SIGCONT)


@contextlib.contextmanager
def store_is_held_for_10_s(robot: Stack) -> Iterator[None]:
    with busy_store(robot):
        begun = time.monotonic()
        yield
        wait_until("10 s have passed", lambda: time.monotonic() > begun + 10)


@contextlib.contextmanager
def disk_of_its_own(state: Path) -> Iterator[None]:
    image = state.with_suffix(".ext4")
    state.mkdir(mode=0o700, parents=True)
    with image.open("wb") as file:
        file.truncate(64 << 20)
    subprocess.run(["mkfs.ext4", "-q", image], check=True)
    subprocess.run(["mount", "-o", "loop", image, state], check=True)
    state.chmod(0o700)
    try:
        yield
    finally:
        subprocess.run(["umount", state], check=True)


@contextlib.contextmanager
def disk_of_the_state_stands(robot: Stack) -> Iterator[None]:
    subprocess.run(["fsfreeze", "-f", robot.state], check=True)
    try:
        yield
    finally:
        subprocess.run(["fsfreeze", "-u", robot.state], check=True)


@contextlib.contextmanager
def pipe_in_the_place_of_the_log(state: Path) -> Iterator[None]:
    log = state / "log/interlock-app.log"
    log.parent.mkdir(parents=True, mode=0o700)
    os.mkfifo(log)
    descriptor = os.open(log, os.O_RDONLY | os.O_NONBLOCK)
    yield
    os.close(descriptor)


def lines_lost(robot: Stack) -> int:
    metrics = robot.visitor().get("/api/metrics").text
    [line] = [line for line in metrics.splitlines() if line.startswith("interlock_log_lines_lost_total")]
    return int(float(line.split()[-1]))


def fill_the_log(robot: Stack) -> None:
    robot.api.put("/api/logs", json={"level": "debug"}).raise_for_status()
    for number in range(UNREAD_LINES):
        assert robot.api.get(f"/api/motors/none{number}").status_code == 404
    assert lines_lost(robot) > 0


@contextlib.contextmanager
def nobody_reads_the_log(robot: Stack) -> Iterator[None]:
    yield
    with (robot.state / "log/interlock-app.log").open(errors="replace") as log:
        told = next(line for line in log if "lines of the log were lost" in line)
    assert int(re.findall(r"(\d+) lines of the log", told)[0]) >= lines_lost(robot)


@contextlib.contextmanager
def readers_250_of_the_largest_asset(robot: Stack) -> Iterator[None]:
    largest = max((ROOT / "web/dist/assets").iterdir(), key=lambda file: file.stat().st_size)
    get = request(robot, f"GET /assets/{largest.name}")
    crowd = Crowd(robot, 250, get, get)
    with present(crowd, lambda: len(crowd.served) == 250):
        yield


@contextlib.contextmanager
def slow_bodies_400(robot: Stack) -> Iterator[None]:
    crowd = Crowd(robot, 400, request(robot, "POST /api/login", 1000), "x", pause_s=0.05)
    with present(crowd, lambda: len(crowd.connected) == 400):
        yield


@contextlib.contextmanager
def flood_of_stops(robot: Stack) -> Iterator[None]:
    ended, counted = threading.Event(), []

    def flood() -> None:
        while not ended.is_set():
            counted.append(stop(robot))

    with ThreadPoolExecutor(8) as flooding:
        floods = [flooding.submit(flood) for _ in range(8)]
        try:
            yield
        finally:
            ended.set()
        for each in floods:
            each.result()
    wait_until("each STOP is counted", lambda: stops_recorded(robot) == len(counted) + 1)


@contextlib.contextmanager
def no_descriptor_is_left(robot: Stack) -> Iterator[None]:
    app = robot.pid("app")
    in_use = len(list(Path(f"/proc/{app}/fd").iterdir()))
    limits = resource.prlimit(app, resource.RLIMIT_NOFILE)
    resource.prlimit(app, resource.RLIMIT_NOFILE, (in_use + SPARE_DESCRIPTORS, limits[1]))
    log = robot.state / "log/interlock-app.log"
    crowd = Crowd(robot, 60, "")
    try:
        with present(crowd, lambda: "cannot accept a connection" in log.read_text()):
            yield
    finally:
        resource.prlimit(app, resource.RLIMIT_NOFILE, limits)


# --- the table ---


@dataclass(frozen=True)
class Row:
    fault: Callable[[Stack], contextlib.AbstractContextManager[None]]
    ends_by_itself: bool = False
    """The jog ends although nobody stops it."""
    stop: str = "at once"
    """When a STOP is answered: at once by the kernel, at once without it, or once the fault is over."""
    prepare: Callable[[Path], contextlib.AbstractContextManager[None]] = contextlib.nullcontext
    """Done with the state directory before the robot starts."""
    before: Callable[[Stack], None] = lambda robot: None
    """Done with the robot before it moves."""
    may_hang_up: bool = False
    """The app may close a connection before it reads the request on it."""


TABLE = {
    "network thread frozen": Row(thread_stands("network")),
    "network thread frozen, nobody stops": Row(thread_stands("network"), ends_by_itself=True),
    "door's thread frozen": Row(thread_stands("door"), ends_by_itself=True, stop="afterwards"),
    "kernel frozen for 5 s": Row(kernel_stands_for_5_s, stop="without the kernel"),
    "store held for 10 s": Row(store_is_held_for_10_s),
    "state disk frozen": Row(disk_of_the_state_stands, prepare=disk_of_its_own),
    "log pipe full": Row(nobody_reads_the_log, prepare=pipe_in_the_place_of_the_log, before=fill_the_log),
    "250 readers of the largest asset": Row(readers_250_of_the_largest_asset),
    "400 slow bodies": Row(slow_bodies_400),
    "flood of STOPs": Row(flood_of_stops),
    "no descriptor left": Row(no_descriptor_is_left, may_hang_up=True),
}
NEEDS_ROOT = {"state disk frozen"}


@pytest.fixture(
    params=[
        pytest.param(row, id=name, marks=pytest.mark.network if name in NEEDS_ROOT else ())
        for name, row in TABLE.items()
    ]
)
def row(request: pytest.FixtureRequest, short_tmp_path: Path) -> Iterator[Row]:
    with request.param.prepare(short_tmp_path / "0/state"):
        yield request.param


@pytest.fixture
def robot(row: Row, stack: StackFactory) -> Stack:
    started = stack(speed=1)
    row.before(started)
    to_motion(started)
    return started


@contextlib.contextmanager
def held_jog(robot: Stack) -> Iterator[None]:
    """Somebody holds it, whether or not the app takes the renewals."""
    answer = judge(robot.api.post("/api/jog", json={"slot": LATERAL, "direction": "decreasing"}))
    assert answer.status_code == 201, answer.text
    number, let_go = answer.json()["id"], threading.Event()

    def renew() -> None:
        with httpx.Client(base_url=robot.url, cookies=robot.api.cookies, timeout=0.1) as client:
            while not let_go.is_set():
                with contextlib.suppress(httpx.HTTPError):
                    client.put(f"/api/jog/{number}")

    renewing = threading.Thread(target=renew)
    renewing.start()
    try:
        wait_until_driven(robot)
        yield
    finally:
        let_go.set()
        renewing.join()


def stop(robot: Stack, may_hang_up: bool = False) -> dict:
    """Of somebody who is not logged in, on a fresh connection, and on another one when the app hangs up."""
    while True:
        try:
            with httpx.Client(base_url=robot.url, timeout=DEADLINE_S) as client:
                return judge(client.post("/api/stop")).raise_for_status().json()
        except (httpx.RemoteProtocolError, httpx.ReadError, httpx.WriteError):
            if not may_hang_up:
                raise


def stops_recorded(robot: Stack) -> int:
    records = robot.api.get("/api/audit", params={"records": 1000}).raise_for_status().json()
    return sum(1 + each["detail"].get("unrecorded", 0) for each in records if each["kind"] == "stop")


def ask_for_a_move(robot: Stack) -> http.client.HTTPResponse:
    """The request is on its way when this returns; the answer is there to be read."""
    request = robot.api.build_request("POST", "/api/proposals", json=MOVE)
    head = "".join(f"{name}: {value}\r\n" for name, value in request.headers.items())
    with socket.create_connection(("127.0.0.1", robot.port), timeout=DEADLINE_S) as connection:
        connection.sendall(f"POST /api/proposals HTTP/1.1\r\n{head}\r\n".encode() + request.content)
        return http.client.HTTPResponse(connection)


def status_of(late: http.client.HTTPResponse) -> int | None:
    """None when the app closed the connection."""
    with contextlib.closing(late), contextlib.suppress(http.client.RemoteDisconnected, ConnectionError):
        late.begin()
        return late.status
    return None


def test_a_held_jog_ends_nothing_late_comes_into_force_and_the_robot_moves_again(
    row: Row, robot: Stack
) -> None:
    with held_jog(robot), ThreadPoolExecutor() as asking:
        with row.fault(robot):
            begun = plant_tick(robot)
            if row.ends_by_itself:
                wait_for_ticks(robot, LONG_AFTER_TICKS)
                assert last_drive(robot) <= begun + ENDS_WITHIN_TICKS
            late, sent = ask_for_a_move(robot), time.monotonic()
            wait_until("the move was seen", lambda: time.monotonic() > sent + SEEN_WITHIN_S)
            asked_at = plant_tick(robot)
            stopping = asking.submit(stop, robot, row.may_hang_up)
            ends_at = begun + ENDS_WITHIN_TICKS
            if row.stop != "afterwards":
                verdict = stopping.result()["verdict"]
                assert plant_tick(robot) <= asked_at + STOPS_WITHIN_TICKS
                assert verdict == ("ACCEPTED" if row.stop == "at once" else None)
            if row.stop == "at once":
                ends_at = plant_tick(robot)
                assert last_drive(robot) <= ends_at
        stopping.result()
        assert status_of(late) in ({201, 409, 503, None} if row.may_hang_up else {201, 409, 503})
        wait_for_ticks(robot, LONG_AFTER_TICKS)
        assert last_drive(robot) <= ends_at
        wait_until("served again", lambda: robot.status()["app_alive"])
        ended = last_drive(robot)
        press(robot)
        wait_for_ticks(robot, LONG_AFTER_TICKS)
        assert last_drive(robot) == ended
    states = {each["state"] for each in robot.api.get("/api/proposals").raise_for_status().json()}
    assert states <= {"aborted", "refused"}
    enable(robot)
    wait_until("a move is approved", lambda: robot.api.post("/api/proposals", json=MOVE).status_code == 201)
    wait_until_driven(robot)
    wait_until("the STOP is recorded", lambda: stops_recorded(robot) > 0)


@pytest.mark.parametrize("thread", ["main", "door"])
def test_an_exception_that_nobody_expected_ends_the_app_with_its_cause_and_motion(
    stack: StackFactory, short_tmp_path: Path, monkeypatch: pytest.MonkeyPatch, thread: str
) -> None:
    """In a coroutine of the network's thread, and in one of the door's. The control thread allocates nothing
    that could fail, and what fails in the store's is a failure of the store."""
    chosen = short_tmp_path / "thread"
    chosen.write_bytes(bytes(16))
    monkeypatch.setenv("LD_PRELOAD", str(BIN / "thrown_exception.so"))
    monkeypatch.setenv("INTERLOCK_THROW_IN", str(chosen))
    robot = stack(speed=1)
    to_motion(robot)
    with held_jog(robot):
        begun = plant_tick(robot)
        with chosen.open("r+b") as file:
            file.write(thread.encode())
        robot.output.wait_for(r"app ended: .*restarting it \(1 of 5")
        assert "uncaught exception: std::bad_alloc" in (robot.state / "log/interlock-app.log").read_text()
        wait_for_ticks(robot, LONG_AFTER_TICKS)
    robot.output.wait_for(r"^ready http\S+", 2)
    ended = last_drive(robot)
    assert begun < ended <= begun + ENDS_WITHIN_TICKS
    robot.take_control()
    robot.status_when(lambda status: status["connected"])
    press(robot)
    wait_for_ticks(robot, LONG_AFTER_TICKS)
    assert last_drive(robot) == ended, "nothing of before comes into force"
    wait_until("a move is approved", lambda: robot.api.post("/api/proposals", json=MOVE).status_code == 201)
    wait_until_driven(robot)
