"""A robot that moves all the time, and the navigation programs that talk to it."""

import sys
import threading
import time
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2] / "tests/integration"))

import httpx
from clients import Client
from motion import act, press, set_home
from stack import Stack

BROKEN = (AssertionError, OSError, httpx.HTTPError)
"""What a robot that does not answer, or answers otherwise than it should, raises."""

CLIENTS = 4
ENDS = (
    {"yaw": -0.2, "insertion": 4.0, "lateral": -3.0, "head": -3.0},
    {"yaw": -0.5, "insertion": 9.0, "lateral": -9.0, "head": -9.0},
)


class MoveAbortedError(AssertionError):
    """A move was given up; the text says why."""


class Mover(threading.Thread):
    """Keeps the robot moving between two places; unlocks it and begins anew when the kernel has locked."""

    def __init__(self, robot: Stack) -> None:
        super().__init__(daemon=True)
        self.done = 0
        self.locks: list[str] = []
        self.aborted: list[str] = []
        self.trouble: list[str] = []
        self._robot = robot
        self._ending = threading.Event()

    def end(self) -> None:
        self._ending.set()
        self.join()

    def run(self) -> None:
        while not self._ending.is_set():
            try:
                self._move()
            except BROKEN as error:
                self._recover(error)

    def _recover(self, error: Exception) -> None:
        """A kernel that locked for missed deadlines is no trouble of the app's, nor an axis that strayed on a
        machine that runs nobody in time, if it is seldom; whatever else is."""
        try:
            status = self._robot.status()
            if status["mode"] == "LOCKED" and status["cause"] == "OVERRUN":
                self.locks.append(status["cause"])
            elif isinstance(error, MoveAbortedError):
                self.aborted.append(str(error))
            else:
                self.trouble.append(f"{type(error).__name__}: {error}")
            make_ready(self._robot)
        except BROKEN as again:
            self.trouble.append(f"{type(again).__name__}: {again}")
            self._ending.wait(1.0)

    def _move(self) -> None:
        proposed = self._robot.api.post(
            "/api/proposals", json={"kind": "coordinated", "targets": ENDS[self.done % 2]}
        ).raise_for_status()
        path = f"/api/proposals/{proposed.json()['id']}"
        self._robot.api.post(f"{path}/approve").raise_for_status()
        press(self._robot)
        while (proposal := self._robot.api.get(path).raise_for_status().json())["state"] != "done":
            if proposal["state"] not in ("approved", "executing"):
                raise MoveAbortedError(f"{proposal['state']}: {proposal['detail']}")
            if self._ending.wait(0.1):
                return
        self.done += 1


def make_ready(robot: Stack) -> None:
    """Unlocked, every axis referenced where it stands and enabled, and the pedal held."""
    robot.control("pedal", pressed=False)
    for _ in range(600):
        if robot.status()["mode"] != "LOCKED" or robot.api.post("/api/reset").status_code == 200:
            break
        time.sleep(0.1)
    for axis in robot.api.get("/api/motors").raise_for_status().json():
        set_home(robot, axis["slot"])
        act(robot, "enable", axis["slot"])
    press(robot)


def give_role(robot: Stack, client: Client, role: str) -> None:
    """Once the robot lists the client."""
    listed: dict[str, int] = {}
    deadline = time.monotonic() + 10
    while client.address not in listed and time.monotonic() < deadline:
        answer = robot.api.get("/api/communications/connections").raise_for_status()
        listed = {each["client"]: each["id"] for each in answer.json()}
    assert client.address in listed, "a client was not admitted"
    path = f"/api/communications/connections/{listed[client.address]}/role"
    robot.api.put(path, json={"role": role}).raise_for_status()


def connect(robot: Stack) -> list[Client]:
    """Four programs, of which the first is the controller."""
    clients = [Client(robot.igtl_port) for _ in range(CLIENTS)]
    give_role(robot, clients[0], "controller")
    for client in clients:
        client.start()
    return clients
