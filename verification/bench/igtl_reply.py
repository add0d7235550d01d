"""How long a navigation program waits for the first answer to a request over OpenIGTLink.

The same client asks the app, once in each dialect, and an echo server on Debian's libopenigtlink
(`igtl_echo`; its package brings no example server). It asks every 2 ms: more than 100 messages of one
connection in 100 ms are read later.
"""

import contextlib
import json
import re
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

REQUESTS = 2000
PERIOD_S = 0.002
DIALECTS = ("thesis", "brp2013", "wpi2024")
# What is asked, and the name of the first answer.
ASKED = {
    "thesis": ("IMAGER_STATUS", "scanning", "IMAGER_STATUS"),
    "brp2013": ("CMD_1", "PLANNING", "ACK_1"),
    "wpi2024": ("CMD_1", "PLANNING", "ACK_1"),
    "library": ("CMD_1", "PLANNING", "CMD_1"),
}
HEADER = struct.Struct(">H12s20sQQQ")
ECMA_182 = 0x42F0E1EBA9EA3693


def crc64(data: bytes) -> int:
    crc = 0
    for byte in data:
        crc ^= byte << 56
        for _ in range(8):
            crc = (crc << 1 ^ (ECMA_182 if crc >> 63 else 0)) & 0xFFFFFFFFFFFFFFFF
    return crc


def string(name: str, content: str) -> bytes:
    body = struct.pack(">HH", 3, len(content)) + content.encode()
    return HEADER.pack(1, b"STRING", name.encode(), 0, len(body), crc64(body)) + body


def exactly(connection: socket.socket, count: int) -> bytes:
    data = b""
    while len(data) < count:
        part = connection.recv(count - len(data))
        if not part:
            raise SystemExit("the server closed the connection")
        data += part
    return data


def wait_for(connection: socket.socket, name: bytes) -> None:
    """Reads messages until one of that name."""
    while True:
        _, _, device, _, size, _ = HEADER.unpack(exactly(connection, HEADER.size))
        exactly(connection, size)
        if device.rstrip(b"\0") == name:
            return


def times_us(port: int, server: str) -> list[float]:
    name, content, answer = ASKED[server]
    request = string(name, content)
    times = []
    with socket.create_connection(("127.0.0.1", port)) as connection:
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        for _ in range(REQUESTS):
            begun = time.perf_counter()
            connection.sendall(request)
            wait_for(connection, answer.encode())
            answered = time.perf_counter()
            times.append((answered - begun) * 1e6)
            time.sleep(max(0.0, begun + PERIOD_S - answered))
    return sorted(times)


@contextlib.contextmanager
def started(command: list[str], says_port: str, says_ready: str) -> Iterator[int]:
    """A server's port, as it prints it, once it is ready."""
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as process:
        try:
            assert process.stdout is not None
            port = None
            for line in process.stdout:
                match = re.search(says_port, line)
                port = int(match[1]) if match else port
                if re.search(says_ready, line):
                    break
            if port is None:
                raise SystemExit(f"{command[0]} did not start")
            yield port
        finally:
            process.send_signal(signal.SIGINT)
            process.stdout.read()


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as server:
        return server.getsockname()[1]


def measure(binaries: Path) -> dict[str, dict[str, float]]:
    """Microseconds by dialect, and those of the library."""
    result = {}
    for dialect in DIALECTS:
        with tempfile.TemporaryDirectory(prefix="interlock-bench-") as folder:
            command = [str(binaries / "interlock"), "run", "--robot", "neuro", "--port", "0"]
            command += ["--state", f"{folder}/state"]
            command += ["--sockets", f"{folder}/sockets", "--igtl-port", "0", "--igtl-dialect", dialect]
            with started(command, r"OpenIGTLink 127\.0\.0\.1:(\d+)$", "^ready") as port:
                result[dialect] = summary(times_us(port, dialect))
    with started([str(binaries / "igtl_echo"), str(free_port())], r"^ready (\d+)", "^ready") as port:
        result["library"] = summary(times_us(port, "library"))
    return result


def summary(times: list[float]) -> dict[str, float]:
    return {
        "median": round(times[len(times) // 2], 1),
        "p99": round(times[int(len(times) * 0.99)], 1),
        "worst": round(times[-1], 1),
    }


if __name__ == "__main__":
    print(json.dumps(measure(Path(sys.argv[1])), indent=2))
