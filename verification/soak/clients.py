"""Navigation programs as a soak needs them: four that talk at 60 Hz, and a crowd that comes and goes."""

import collections
import contextlib
import itertools
import select
import socket
import struct
import sys
import threading
import time
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "bench"))

from igtl_reply import HEADER, crc64

RATE_HZ = 60
STORM_SIZE = 40
STORM_PERIOD_S = 5.0
PATIENCE_S = 5.0
MOST_FRAME_BYTES = 1 << 20

POSE = struct.pack(">12f", 1, 0, 0, 0, 1, 0, 0, 0, 1, 5, 200, 60)
STATUS = struct.Struct(">Hq20s")


def message(kind: str, name: str, body: bytes = b"") -> bytes:
    return HEADER.pack(1, kind.encode(), name.encode(), 0, len(body), crc64(body)) + body


TIP_POSE = message("TRANSFORM", "TIP_POSE", POSE)
START_TRACKING = message("STT_TDATA", "", struct.pack(">I32s", 16, b""))


class Client(threading.Thread):
    """Sends the pose of a tip 60 times a second, and hears all that the robot tells of itself."""

    def __init__(self, port: int) -> None:
        super().__init__(daemon=True)
        self.sent = 0
        self.answered = 0
        self.heard = 0
        self.answers_ms: list[float] = []
        self.trouble: list[str] = []
        self._waiting: collections.deque[float] = collections.deque()
        self._buffer = b""
        self._ending = threading.Event()
        self._connection = socket.create_connection(("127.0.0.1", port))
        self._connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._connection.settimeout(PATIENCE_S)

    @property
    def address(self) -> str:
        host, port = self._connection.getsockname()
        return f"{host}:{port}"

    def end(self) -> None:
        self._ending.set()
        self.join()

    def run(self) -> None:
        try:
            with self._connection:
                self._connection.sendall(START_TRACKING)
                self._talk()
        except OSError as error:
            self.trouble.append(f"connection lost: {error}")

    def _talk(self) -> None:
        due = time.monotonic()
        while not self._ending.is_set():
            self._send()
            due = max(due + 1 / RATE_HZ, time.monotonic() - 1 / RATE_HZ)
            self._hear_until(due)
        self._hear_until(time.monotonic() + PATIENCE_S, all_answered=True)
        if self._waiting:
            self.trouble.append(f"{len(self._waiting)} messages were not answered")

    def _send(self) -> None:
        self._waiting.append(time.perf_counter())
        self._connection.sendall(TIP_POSE)
        self.sent += 1

    def _hear_until(self, deadline: float, all_answered: bool = False) -> None:
        while (left := deadline - time.monotonic()) > 0 and not (all_answered and not self._waiting):
            if not select.select([self._connection], [], [], left)[0]:
                return
            part = self._connection.recv(1 << 16)
            if not part:
                raise ConnectionResetError("the robot closed the connection")
            self._buffer += part
            self._take_messages()

    def _take_messages(self) -> None:
        while len(self._buffer) >= HEADER.size:
            _, kind, name, _, size, _ = HEADER.unpack_from(self._buffer)
            if size > MOST_FRAME_BYTES:
                raise ConnectionResetError(f"a message of {size} bytes")
            if len(self._buffer) < HEADER.size + size:
                return
            body = self._buffer[HEADER.size : HEADER.size + size]
            self._buffer = self._buffer[HEADER.size + size :]
            self.heard += 1
            if (kind.rstrip(b"\0"), name.rstrip(b"\0")) == (b"STATUS", b"TIP_POSE"):
                self._take_answer(STATUS.unpack_from(body)[0])

    def _take_answer(self, code: int) -> None:
        self.answered += 1
        self.answers_ms.append((time.perf_counter() - self._waiting.popleft()) * 1e3)
        if code != 1:
            self.trouble.append(f"a pose was answered by STATUS {code}")


class Storm(threading.Thread):
    """Programs that come, do what programs do that crash or are wrong, and go: forty every five seconds."""

    def __init__(self, port: int) -> None:
        super().__init__(daemon=True)
        self.connections = 0
        self._port = port
        self._ending = threading.Event()
        self._kinds = itertools.cycle((self._leave, self._reset, self._break_off, self._babble, self._ask))

    def end(self) -> None:
        self._ending.set()
        self.join()

    def run(self) -> None:
        while not self._ending.wait(STORM_PERIOD_S):
            for _ in range(STORM_SIZE):
                # To be turned away is what happens to most of a crowd.
                with contextlib.suppress(OSError):
                    self._come_and_go()

    def _come_and_go(self) -> None:
        with socket.create_connection(("127.0.0.1", self._port), PATIENCE_S) as connection:
            self.connections += 1
            next(self._kinds)(connection)

    @staticmethod
    def _leave(_: socket.socket) -> None:
        """Says nothing."""

    @staticmethod
    def _reset(connection: socket.socket) -> None:
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))

    @staticmethod
    def _break_off(connection: socket.socket) -> None:
        connection.sendall(TIP_POSE[:70])

    @staticmethod
    def _babble(connection: socket.socket) -> None:
        connection.sendall(bytes(range(256)))

    @staticmethod
    def _ask(connection: socket.socket) -> None:
        connection.sendall(message("GET_STATUS", ""))
        connection.recv(1 << 12)
