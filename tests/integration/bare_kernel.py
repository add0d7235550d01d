"""Plant and kernel as real processes, without an app: the test is the app."""

import contextlib
import json
import os
import signal
import socket
import subprocess
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

from link_client import DEADLINE_S, LinkClient
from link_layout import name_of

ROOT = Path(__file__).resolve().parents[2]
BIN = Path(os.environ.get("INTERLOCK_BIN", ROOT / "build/release/bin"))


class PlantControl:
    """The plant's control socket (models/plant/README.md)."""

    def __init__(self, path: Path) -> None:
        self.socket = socket.socket(socket.AF_UNIX)
        self.socket.settimeout(DEADLINE_S)
        self.socket.connect(str(path))
        self.lines = self.socket.makefile("rwb")

    def __call__(self, command: str, **fields: object) -> dict:
        self.lines.write(json.dumps({"command": command, **fields}).encode() + b"\n")
        self.lines.flush()
        answer = json.loads(self.lines.readline())
        assert answer["ok"], f"{command} {fields}: {answer}"
        return answer

    def close(self) -> None:
        self.lines.close()
        self.socket.close()


def options(**values: object) -> list[str]:
    """`--name value` for each keyword."""
    return [part for name, value in values.items() for part in (f"--{name}", str(value))]


def without_priority(command: Sequence[str | Path]) -> list[str]:
    """The command, without the right to a real-time priority: the kernel counts then how late the machine of
    the tests is, and does not lock for it."""
    setpriv = ["setpriv", "--bounding-set", "-sys_nice"] if os.geteuid() == 0 else []
    return setpriv + [str(part) for part in command]


def start(command: Sequence[str | Path]) -> subprocess.Popen:
    """Starts a process and waits for its `ready` line."""
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    for line in process.stdout:
        if line.startswith("ready"):
            return process
    raise RuntimeError(f"{command[0]} ended with {process.wait()} before it was ready")


def stop(process: subprocess.Popen) -> int:
    if process.poll() is None:
        process.send_signal(signal.SIGTERM)
    try:
        return process.wait(timeout=DEADLINE_S)
    except subprocess.TimeoutExpired:
        process.kill()
        raise


class BareKernel:
    def __init__(self, directory: Path, clock: str, *more: str, priority: bool = False) -> None:
        self.directory = directory
        self.link_path = directory / "link.sock"
        config = directory / "neuro.ilkc"
        robot = ROOT / "models/robots/neuro.toml"
        subprocess.run([str(BIN / "interlock"), "model", "compile", robot, "-o", config], check=True)
        bus, control = directory / "bus.sock", directory / "control.sock"
        plant = ROOT / "models/plant/neuro.toml"
        sim_options = options(plant=plant, robot=config, bus=bus, control=control, seed=1)
        self.sim = start([BIN / "interlock-sim", *sim_options])
        kernel_options = options(config=config, bus=f"sim:{bus}", link=self.link_path, clock=clock)
        command = [BIN / "interlock-kernel", *kernel_options, *more]
        self.kernel = start(command if priority else without_priority(command))
        self.plant = PlantControl(directory / "control.sock")

    def attach(self) -> LinkClient:
        return LinkClient(self.link_path)

    def close(self) -> None:
        self.plant.close()
        stop(self.kernel)
        stop(self.sim)


@contextlib.contextmanager
def bare_kernel(clock: str = "sim", *, priority: bool = False) -> Iterator[BareKernel]:
    with tempfile.TemporaryDirectory(prefix="interlock-test-") as directory:
        kernel = BareKernel(Path(directory), clock, priority=priority)
        try:
            yield kernel
        finally:
            kernel.close()


def to_motion(kernel: BareKernel, client: LinkClient, slot: int) -> None:
    """Unlocks, references and enables the axis, presses the pedal and waits for MOTION."""
    client.run(30)
    assert client.ask("RESET") == "ACCEPTED"
    client.ask_at_rest("SET_HOME", axis=slot)
    client.ask_at_rest("ENABLE", axis=slot)
    client.run(30)
    kernel.plant("pedal", pressed=True)
    deadline = time.monotonic() + DEADLINE_S
    while mode(client) != "MOTION":
        client.run(5)
        assert time.monotonic() < deadline, mode(client)


def mode(client: LinkClient) -> str:
    return name_of("ILK_MODE", client.snapshot().state.system.mode)
