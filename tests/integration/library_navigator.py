"""A navigation program on Debian's OpenIGTLink library, in the place of the one on pyigtl."""

import json
import subprocess
import threading
import time
from collections.abc import Callable

import numpy as np
import pyigtl
from bare_kernel import BIN, DEADLINE_S
from navigator import Heard, Poses, Program, Query, Rows, Status
from pyigtl import messages as wire


class Library(Program):
    """`igtl_peer`, which packs and unpacks by the library. Messages are told as pyigtl's."""

    def __init__(self, version: int, port: int | None = None) -> None:
        """Connects to the robot's port; without one it listens, on `port`."""
        self.version = version
        self.is_server = port is None
        self.heard = Heard()
        mode = ["server"] if port is None else ["client", str(port)]
        self._process = subprocess.Popen(
            [str(BIN / "igtl_peer"), *mode, str(version)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        assert self._process.stdout is not None
        self.port = port or json.loads(self._process.stdout.readline())["listening"]
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        assert self._process.stdout is not None
        for line in self._process.stdout:
            told = json.loads(line)
            message = READ[told["type"]](told)
            message.header_version = told["version"]
            self.heard[told["name"]] = message

    def send(self, message: wire.MessageBase) -> None:
        line = {"type": message.message_type, "name": message.device_name} | body_of(message)
        assert self._process.stdin is not None
        self._process.stdin.write(json.dumps(line) + "\n")
        self._process.stdin.flush()

    def receive(self, name: str) -> wire.MessageBase:
        deadline = time.monotonic() + DEADLINE_S
        while name not in self.heard:
            assert time.monotonic() < deadline, f"no message {name}"
            assert self._process.poll() is None, "the program has ended"
            time.sleep(0.001)
        return self.heard.pop(name)

    def stop(self) -> None:
        assert self._process.stdin is not None
        self._process.stdin.close()
        self._reader.join(timeout=DEADLINE_S)
        self._process.kill()
        self._process.wait()


def body_of(message: wire.MessageBase) -> dict:
    if isinstance(message, pyigtl.TransformMessage):
        return {"matrix": message.matrix.ravel().tolist()}
    if isinstance(message, pyigtl.StringMessage):
        return {"text": message.string}
    if isinstance(message, pyigtl.PointMessage):
        return {"positions": [list(map(float, each)) for each in message.positions]}
    if isinstance(message, Rows):
        return {"rows": message.rows}
    if isinstance(message, Poses):
        return {"poses": [{"name": name, "matrix": pose.ravel().tolist()} for name, pose in message.poses]}
    if isinstance(message, Status):
        return {"code": message.code, "text": message.text}
    assert isinstance(message, Query | Tracking)
    return message.body if isinstance(message, Tracking) else {}


class Tracking(wire.MessageBase):
    """STT_TDATA with its interval, or STP_TDATA."""

    def __init__(self, interval_ms: int | None, device_name: str = "") -> None:
        super().__init__(device_name=device_name)
        self._message_type = "STP_TDATA" if interval_ms is None else "STT_TDATA"
        self.body = {} if interval_ms is None else {"interval_ms": interval_ms}


class Told(wire.MessageBase):
    """What pyigtl has no class for: `content` is what the library unpacked."""

    def __init__(self, told: dict, content: object) -> None:
        super().__init__(device_name=told["name"])
        self._message_type = told["type"]
        self.content = content


def read_status(told: dict) -> Status:
    message = Status(told["name"], told["code"], told["text"])
    message.sub_code, message.name = told["sub_code"], told["error"]
    return message


READ: dict[str, Callable[[dict], wire.MessageBase]] = {
    "TRANSFORM": lambda told: pyigtl.TransformMessage(
        np.array(told["matrix"]).reshape(4, 4), device_name=told["name"]
    ),
    "STRING": lambda told: pyigtl.StringMessage(told["text"], device_name=told["name"]),
    "STATUS": read_status,
    "POINT": lambda told: pyigtl.PointMessage(told["positions"], device_name=told["name"]),
    "NDARRAY": lambda told: Told(told, told["rows"]),
    "SENSOR": lambda told: Told(told, told["values"]),
    "TDATA": lambda told: Told(told, {each["name"]: each["matrix"] for each in told["poses"]}),
    "RTS_TDATA": lambda told: Told(told, told["accepted"]),
    "CAPABILITY": lambda told: Told(told, told["types"]),
}
