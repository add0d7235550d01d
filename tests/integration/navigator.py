"""A navigation program: pyigtl, with what it lacks."""

import contextlib
import socket
import struct
import threading
from abc import ABC, abstractmethod
from collections.abc import Callable

import numpy as np
import pyigtl
from bare_kernel import DEADLINE_S
from motion import wait_until
from pyigtl import messages as wire

OK = 1
PAUSE_S = 0.01
"""After which a program that hears nothing sends what is next."""


class Status(wire.MessageBase):
    """STATUS, which pyigtl lacks."""

    def __init__(self, device_name: str | None = None, code: int = OK, text: str = "") -> None:
        super().__init__(device_name=device_name)
        self._message_type = "STATUS"
        self._valid_message = True
        self.code, self.sub_code, self.name, self.text = code, 0, "", text

    def _pack_content(self) -> bytes:
        return (
            struct.pack(">Hq20s", self.code, self.sub_code, self.name.encode()) + self.text.encode() + b"\0"
        )

    def _unpack_content(self, content: bytes) -> None:
        self.code, self.sub_code, name = struct.unpack(">Hq20s", content[:30])
        self.name = name.rstrip(b"\0").decode()
        self.text = content[30:].rstrip(b"\0").decode()


class Query(wire.MessageBase):
    """GET_ of a type, which has no body."""

    def __init__(self, kind: str, device_name: str = "") -> None:
        super().__init__(device_name=device_name)
        self._message_type = "GET_" + kind
        self._valid_message = True


class Rows(wire.MessageBase):
    """NDARRAY of float64 in two dimensions, which pyigtl lacks."""

    def __init__(self, rows: list[list[float]], device_name: str) -> None:
        super().__init__(device_name=device_name)
        self._message_type = "NDARRAY"
        self._valid_message = True
        self.rows = rows

    def _pack_content(self) -> bytes:
        values = [value for row in self.rows for value in row]
        head = struct.pack(">BBHH", 11, 2, len(self.rows), len(self.rows[0]))
        return head + struct.pack(f">{len(values)}d", *values)


class Poses(wire.MessageBase):
    """TDATA, which pyigtl lacks: 4x4 matrices by name."""

    def __init__(self, poses: list[tuple[str, np.ndarray]], device_name: str) -> None:
        super().__init__(device_name=device_name)
        self._message_type = "TDATA"
        self._valid_message = True
        self.poses = poses

    def _pack_content(self) -> bytes:
        return b"".join(
            struct.pack(">20sBx12f", name.encode(), 2, *matrix[:3].T.ravel()) for name, matrix in self.poses
        )


wire.message_type_to_class_constructor["STATUS"] = Status


class Heard(dict):
    """The messages that pyigtl keeps, the newest of each name, and besides all of them in their order."""

    def __init__(self) -> None:
        super().__init__()
        self.all: list[wire.MessageBase] = []

    def __setitem__(self, name: str, message: wire.MessageBase) -> None:
        self.all.append(message)
        super().__setitem__(name, message)


class Program(ABC):
    """A navigation program, whatever it is built on."""

    version: int
    heard: Heard

    @abstractmethod
    def send(self, message: wire.MessageBase) -> None:
        """Sends it in the program's header version."""

    @abstractmethod
    def receive(self, name: str) -> wire.MessageBase:
        """The newest message of that name, once there is one; each is had once."""

    @abstractmethod
    def stop(self) -> None:
        """Ends the connection."""

    def ask(self, message: wire.MessageBase) -> Status:
        """The STATUS that answers a message."""
        self.send(message)
        answer = self.receive(message.device_name)
        assert isinstance(answer, Status)
        return answer


class Navigator(Program):
    """A navigation program: pyigtl, with one header version."""

    def __init__(self, port: int, version: int = 1) -> None:
        self.version = version
        self.client = pyigtl.OpenIGTLinkClient("127.0.0.1", port, start_now=False)
        self.heard = self.client.incoming_messages = Heard()
        self.client.start()
        wait_until("connected", self.client.is_connected)

    def send(self, message: wire.MessageBase) -> None:
        message.header_version = self.version
        if self.version == 2:
            message.metadata = {"dummy": "dummy"}
        assert self.client.send_message(message)

    def receive(self, name: str) -> wire.MessageBase:
        message = self.client.wait_for_message(name, timeout=DEADLINE_S)
        assert message is not None, f"no message {name}"
        return message

    def stop(self) -> None:
        self.client.stop()


def transform(name: str, matrix: list[float]) -> pyigtl.TransformMessage:
    return pyigtl.TransformMessage(np.array(matrix, dtype=float).reshape(4, 4), device_name=name)


def text(name: str, content: str) -> pyigtl.StringMessage:
    return pyigtl.StringMessage(content, device_name=name)


class Insistent:
    """A navigation program that sends the same again and again, whatever is answered, and connects again when
    the app is gone; for as long as the context lasts."""

    def __init__(self, port: Callable[[], int], messages: Callable[[int], list[wire.MessageBase]]) -> None:
        """@param messages: those of a round, of which the number is given."""
        self._port, self._messages = port, messages
        self._ends = threading.Event()
        self._thread = threading.Thread(target=self._run)

    def __enter__(self) -> "Insistent":
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ends.set()
        self._thread.join()

    def _run(self) -> None:
        sent = 0
        while not self._ends.is_set():
            with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", self._port())) as peer:
                peer.settimeout(PAUSE_S)
                while not self._ends.is_set():
                    sent += 1
                    self._send(peer, self._messages(sent))

    def _send(self, peer: socket.socket, messages: list[wire.MessageBase]) -> None:
        for each in messages:
            peer.sendall(each.pack())
            with contextlib.suppress(TimeoutError):
                while not self._ends.is_set():
                    if not peer.recv(65536):
                        raise ConnectionResetError
