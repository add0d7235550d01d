"""A whole robot for a scenario: under `interlock run`, or as four services that are started one by one."""

import contextlib
import json
import os
import signal
import socket
import subprocess
import threading
import time
from collections.abc import Callable
from pathlib import Path

import httpx
from bare_kernel import BIN, DEADLINE_S, ROOT, options
from motion import LATERAL, propose
from plan import PROCESSES
from stack import PROGRAMS, Stack

BROKEN = (AssertionError, OSError, httpx.HTTPError, json.JSONDecodeError)
"""What a robot that does not answer, or answers otherwise than it should, raises."""

ENDS_COUNTS = (-900, -100)
LONGEST_PRESS_S = 2.0
START_PAUSE_S = 0.05
JUST_NOW_TICKS = 10
PROGRAM_OF = PROGRAMS | {"recorder": "interlock-recorder"}


def eventually(what: str, attempt: Callable[[], object]) -> None:
    """Tries until it is true, through whatever breaks meanwhile."""
    deadline = time.monotonic() + DEADLINE_S
    broken = ""
    while True:
        try:
            if attempt():
                return
        except BROKEN as error:
            broken = f"; last: {type(error).__name__}: {error}"
        assert time.monotonic() < deadline, f"not within {DEADLINE_S} s: {what}{broken}"
        time.sleep(START_PAUSE_S)


def child_named(parent: int, program: str) -> int:
    """The child of that process that runs the program."""
    for child in Path(f"/proc/{parent}/task/{parent}/children").read_text().split():
        with contextlib.suppress(OSError):
            if Path(f"/proc/{child}/cmdline").read_bytes().split(b"\0")[0].endswith(program.encode()):
                return int(child)
    raise AssertionError(f"process {parent} has no {program}")


class Supervised(Stack):
    """With the deadlines of the wall clock: sockets in a private directory, and OpenIGTLink."""

    def __init__(self, folder: Path) -> None:
        super().__init__(
            folder,
            *options(robot="neuro", seed=1),
            *("--realtime", "--igtl-port", "0"),
        )
        self.sockets = next(self.runtime.glob("interlock-*"))
        self.connect_control()

    def pid(self, name: str) -> int:
        return self.run.pid if name == "supervisor" else child_named(self.run.pid, PROGRAM_OF[name])


class Services(Stack):
    """Each process by itself, started anew whenever it ends, as a service manager does."""

    def __init__(self, folder: Path) -> None:
        self.state, self.runtime, self.sockets = folder / "state", folder / "run", folder / "run"
        self.runtime.mkdir(parents=True, exist_ok=True)
        self._connections = contextlib.ExitStack()
        self._wanted: set[str] = set()
        self._running: dict[str, subprocess.Popen] = {}
        self._lock = threading.Lock()
        self._ended = threading.Event()
        self._commands = self._commands_in(self.runtime)
        self._log = self._connections.enter_context((folder / "services.log").open("w+"))
        for name in PROCESSES:
            self.start(name)
        self._keeper = threading.Thread(target=self._keep, daemon=True)
        self._keeper.start()
        eventually("the app is ready", lambda: f"\nready {self.url}" in self.output_text)
        self.password = self.output_text.partition("first login: admin ")[2].split()[0]
        self.api = self.client("admin", self.password)
        self.take_control()
        self.connect_control()

    def _commands_in(self, folder: Path) -> dict[str, list[str]]:
        config, bus, control, link = (folder / name for name in ("c.ilkc", "bus", "control.sock", "link"))
        robot = ROOT / "models/robots/neuro.toml"
        subprocess.run([BIN / "interlock", "model", "compile", robot, "-o", config], check=True)
        with socket.create_server(("127.0.0.1", 0)) as listener:
            port = listener.getsockname()[1]
        self.url = f"http://127.0.0.1:{port}/"
        box = ["--black-box", str(folder / "black-box")]
        plant = ROOT / "models/plant/neuro.toml"
        given = {
            "simulator": options(plant=plant, robot=config, bus=bus, control=control, seed=1),
            "recorder": [*box, "--folder", str(self.state / "recordings")],
            "kernel": [
                *options(config=config, bus=f"sim:{bus}", link=link),
                *box,
            ],
            "app": options(robot=robot, config=config, link=link, bench=control, port=port, state=self.state),
        }
        return {name: [str(BIN / PROGRAM_OF[name]), *arguments] for name, arguments in given.items()}

    @property
    def output_text(self) -> str:
        return "\n" + Path(self._log.name).read_text("utf-8", "replace")

    def start(self, name: str) -> None:
        with self._lock:
            self._wanted.add(name)
            self._spawn(name)

    def _spawn(self, name: str) -> None:
        self._running[name] = subprocess.Popen(
            self._commands[name], stdin=subprocess.DEVNULL, stdout=self._log, stderr=subprocess.STDOUT
        )

    def _keep(self) -> None:
        while not self._ended.wait(START_PAUSE_S):
            with self._lock:
                for name in self._wanted:
                    if self._running[name].poll() is not None:
                        self._spawn(name)

    def kill(self, name: str) -> None:
        """Ends it for good, until it is started again."""
        with self._lock:
            self._wanted.discard(name)
            self._running[name].kill()
            self._running[name].wait()

    def pid(self, name: str) -> int:
        return self._running[name].pid

    def connect_control_again(self) -> None:
        """To the simulator that took the place of the one that was killed."""
        eventually("the simulator listens", self._is_connected)

    def _is_connected(self) -> bool:
        self.connect_control()
        return bool(self.control("status")["ok"])

    def close(self) -> None:
        self._connections.close()
        self._ended.set()
        self._keeper.join()
        for name in reversed(PROCESSES):
            self._running[name].send_signal(signal.SIGTERM)
            self._running[name].wait(DEADLINE_S)


class Mover(threading.Thread):
    """Keeps one axis moving to and fro for as long as the robot lets it."""

    def __init__(self, robot: Stack) -> None:
        super().__init__(daemon=True)
        self._robot = robot
        self._ending = threading.Event()
        self._turn = 0
        self.last = "no move was proposed"

    def end(self) -> None:
        self._ending.set()
        self.join(DEADLINE_S)

    def run(self) -> None:
        while not self._ending.wait(START_PAUSE_S / 5):
            # What breaks is the scenario's business: the robot stops, and is brought up again by its hands.
            try:
                self._move()
            except BROKEN as error:
                self.last = f"{type(error).__name__}: {error}"

    def _move(self) -> None:
        self._turn += 1
        path = f"/api/proposals/{propose(self._robot, ENDS_COUNTS[self._turn % 2])}"
        while not self._ending.wait(START_PAUSE_S / 5):
            proposal = self._robot.api.get(path).raise_for_status().json()
            self.last = f"{proposal['state']}: {proposal['detail']}"
            if proposal["state"] not in ("approved", "executing"):
                return


class Clerk(threading.Thread):
    """Sets the target again and again, each time to another point, and remembers what was acknowledged."""

    def __init__(self, robot: Stack, number: int) -> None:
        super().__init__(daemon=True)
        self.acknowledged: list[list[int]] = []
        self._robot = robot
        self._ending = threading.Event()
        self._count = 0
        self._number = number
        self.between_writes = threading.Lock()
        """Held by who must not be in the way of a write; it waits for one that is under way."""

    def end(self) -> None:
        self._ending.set()
        self.join(DEADLINE_S)

    def write(self, robot: Stack) -> bool:
        """Whether the next point was acknowledged."""
        self._count += 1
        point = [self._count, self._number, 0]
        answer = robot.api.put("/api/targeting/target", json={"target_point": point})
        if answer.status_code == 200:
            self.acknowledged.append(point)
        return answer.status_code == 200

    def run(self) -> None:
        while not self._ending.wait(START_PAUSE_S / 5):
            with self.between_writes, contextlib.suppress(*BROKEN):
                self.write(self._robot)


def regain_control(robot: Stack) -> bool:
    """Logs in anew where what was done to the robot ended the session; takes control, with a case open."""
    taken = robot.api.post("/api/control/take-over")
    if taken.status_code == 401:
        robot.api = robot.client("admin", robot.password)
    if taken.status_code == 200:
        robot.open_case()
    return taken.status_code == 200


def make_ready(robot: Stack) -> bool:
    """One step towards READY with the axis enabled, the one that is due: unlock, clear the fault, declare the
    axis to be at home where it stands, enable it."""
    path = f"/api/motors/{LATERAL}"
    status = robot.status()
    motor = robot.api.get(path).raise_for_status().json()
    if status["mode"] == "LOCKED":
        robot.api.post("/api/reset")
    elif motor["state"] == "FAULTED":
        robot.api.post(f"{path}/clear-fault")
    elif not motor["homed"]:
        robot.api.post(f"{path}/set-home", json={"override_switch": True})
    elif motor["state"] == "DISABLED":
        robot.api.post(f"{path}/enable")
    return status["mode"] == "READY" and motor["homed"] and motor["state"] == "ENABLED"


def press_when_ready(robot: Stack) -> bool:
    """Whether a press led to MOTION. On a busy machine a fault or a lock may come in between."""
    robot.control("pedal", pressed=False)
    eventually("ready", lambda: make_ready(robot) and robot.status()["pedal_armed"])
    robot.control("pedal", pressed=True)
    deadline = time.monotonic() + LONGEST_PRESS_S
    while time.monotonic() < deadline:
        if robot.status()["mode"] == "MOTION":
            return True
    return False


def bring_up(robot: Stack) -> None:
    """From whatever state to MOTION with the axis enabled, as an operator does it."""
    robot.control("pedal", pressed=False)
    robot.control("estop", pulled=False)
    eventually("logged in and in control", lambda: regain_control(robot))
    eventually("in MOTION", lambda: press_when_ready(robot))


def wait_until_driven(robot: Stack, mover: Mover) -> None:
    """As the plant sees it on the wire."""
    begun = robot.control("status")["tick"]

    def is_driven() -> bool:
        last = robot.control("record_event", kind="last_nonzero_drive")["event_tick"]
        assert (last or 0) > begun, f"the last move: {mover.last}"
        return True

    eventually("driven", is_driven)


def await_motion(robot: Stack, timeout_s: float) -> None:
    """Until something is driven at this moment, or timeout ends: a fault may have stopped it already."""
    deadline = time.monotonic() + timeout_s
    while time.monotonic() < deadline:
        driven = robot.control("record_event", kind="last_nonzero_drive")
        if robot.control("status")["tick"] - (driven["event_tick"] or 0) <= JUST_NOW_TICKS:
            return


def environment_is(**values: str) -> None:
    """For every program that is started from now on."""
    os.environ.update(values)
