"""How long a STOP takes over HTTP, until the kernel's verdict is read, while others attack the app.

On a fresh connection each time, and on one that had an answer before, as a page keeps it. The robot is that
of `interlock run` in its default clock; attackers are processes of their own. Run by itself it prints a
table.
"""

import contextlib
import http.client
import json
import multiprocessing
import selectors
import socket
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2] / "tests/integration"))

import numpy as np
from frozen import frozen
from stack import Stack

COUNT = 300
"""STOPs of each kind beside each attack."""
READERS = 250
SLOW_BODIES = 400
STOPPERS = 32
CHUNK = 1 << 16
LIMITS = {"fresh": 50_000, "kept": 10_000}
"""Of the 99th percentile, in us."""


def largest_asset(robot: Stack) -> str:
    folder = Path(__file__).resolve().parents[2] / "web/dist"
    plain = (file for file in folder.rglob("*") if file.is_file() and file.suffix not in (".br", ".gz"))
    largest = max(plain, key=lambda file: file.stat().st_size)
    path = f"/{largest.relative_to(folder)}"
    robot.visitor().get(path).raise_for_status()
    return path


def crowd(
    port: int, count: int, say: Callable[[int], bytes], pause_s: float, ready: "multiprocessing.Event"
) -> None:
    """So many connections that say something, read what comes and say it again; a closed one comes anew."""
    chosen = selectors.DefaultSelector()
    places: list[socket.socket] = []

    def come(number: int) -> None:
        place = socket.create_connection(("127.0.0.1", port))
        place.setblocking(False)
        places[number : number + 1] = [place]
        chosen.register(place, selectors.EVENT_READ, number)
        with contextlib.suppress(OSError):
            place.send(say(number))

    for number in range(count):
        come(number)
    ready.set()
    said = time.monotonic()
    while True:
        for key, _ in chosen.select(timeout=pause_s or 1.0):
            place, number = key.fileobj, key.data
            try:
                got = place.recv(CHUNK)
            except BlockingIOError:
                continue
            except OSError:
                got = b""
            if not got:
                chosen.unregister(place)
                place.close()
                with contextlib.suppress(OSError):
                    come(number)
        if time.monotonic() - said >= pause_s:
            said = time.monotonic()
            for number, place in enumerate(places):
                with contextlib.suppress(OSError):
                    place.send(say(number))


@contextlib.contextmanager
def crowded(robot: Stack, count: int, say: Callable[[int], bytes], pause_s: float) -> Iterator[None]:
    ready = multiprocessing.Event()
    arguments = (robot.port, count, say, pause_s, ready)
    attacker = multiprocessing.Process(target=crowd, args=arguments, daemon=True)
    attacker.start()
    try:
        ready.wait()
        yield
    finally:
        attacker.kill()
        attacker.join()


def get(robot: Stack, path: str) -> bytes:
    return f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{robot.port}\r\n\r\n".encode()


def post(robot: Stack, path: str, length: int) -> bytes:
    head = f"POST {path} HTTP/1.1\r\nHost: 127.0.0.1:{robot.port}\r\nContent-Length: {length}\r\n\r\n"
    return head.encode()


@contextlib.contextmanager
def idle(_robot: Stack) -> Iterator[None]:
    yield


@contextlib.contextmanager
def readers(robot: Stack) -> Iterator[None]:
    """Each asks for the largest file of the console, uncompressed, again and again."""
    request = get(robot, largest_asset(robot))
    with crowded(robot, READERS, lambda _number: request, 0.2):
        yield


@contextlib.contextmanager
def slow_bodies(robot: Stack) -> Iterator[None]:
    """Each sends a body of 60 kB at some bytes a second."""
    head = (
        f"POST /api/login HTTP/1.1\r\nHost: 127.0.0.1:{robot.port}\r\nContent-Length: 60000\r\n\r\n".encode()
    )
    begun: set[int] = set()

    def say(number: int) -> bytes:
        return b" " if number in begun else (begun.add(number), head)[1]

    with crowded(robot, SLOW_BODIES, say, 0.2):
        yield


@contextlib.contextmanager
def stops(robot: Stack) -> Iterator[None]:
    """Others send STOP as fast as they can."""
    request = post(robot, "/api/stop", 0)
    with crowded(robot, STOPPERS, lambda _number: request, 0.001):
        yield


@contextlib.contextmanager
def network_frozen(robot: Stack) -> Iterator[None]:
    with frozen(robot.pid("app"), "network"):
        yield


ATTACKS = {
    "idle": idle,
    "readers": readers,
    "slow_bodies": slow_bodies,
    "stops": stops,
    "network_frozen": network_frozen,
}


def stop(connection: http.client.HTTPConnection) -> float:
    """Seconds until the kernel's verdict is read."""
    begun = time.monotonic()
    connection.request("POST", "/api/stop")
    answer = connection.getresponse()
    verdict = json.loads(answer.read())["verdict"]
    passed = time.monotonic() - begun
    assert verdict == "ACCEPTED", verdict
    return passed


def times_us(robot: Stack, kind: str) -> list[float]:
    times = []
    connection = http.client.HTTPConnection("127.0.0.1", robot.port, timeout=60)
    stop(connection)
    for _ in range(COUNT):
        if kind == "fresh":
            connection.close()
            connection = http.client.HTTPConnection("127.0.0.1", robot.port, timeout=60)
        times.append(stop(connection) * 1e6)
    connection.close()
    return times


def measure() -> dict[str, float]:
    """Median and 99th percentile of each kind beside each attack."""
    figures: dict[str, float] = {}
    for name, attack in ATTACKS.items():
        print(f"STOP: {name}", file=sys.stderr, flush=True)
        with tempfile.TemporaryDirectory(prefix="interlock-bench-") as folder:
            robot = Stack(Path(folder))
            try:
                with attack(robot):
                    for kind in LIMITS:
                        times = times_us(robot, kind)
                        figures[f"stop_us_median_{kind}_{name}"] = round(float(np.median(times)))
                        figures[f"stop_us_p99_{kind}_{name}"] = round(float(np.quantile(times, 0.99)))
            finally:
                robot.close()
    return figures


def limits() -> dict[str, float]:
    return {f"stop_us_p99_{kind}_{name}": limit for kind, limit in LIMITS.items() for name in ATTACKS}


if __name__ == "__main__":
    for figure, value in measure().items():
        limit = limits().get(figure)
        print(f"{figure:44} {value:>10}{'' if limit is None else f'   limit {limit}'}")
