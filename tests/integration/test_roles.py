"""Who may do what: each operation of spec/openapi.yaml by each kind of caller."""

import re
import tempfile
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest
from interface import judge, paths
from stack import Stack

RANKS = ["public", "viewer", "engineer", "admin"]
# `holder` is an engineer who is in control, which `engineer` and `admin` are not.
CALLERS = {
    "nobody": "public",
    "viewer": "viewer",
    "engineer": "engineer",
    "admin": "admin",
    "holder": "engineer",
}
IN_PATH = {
    "axis": "lateral",
    "action": "enable",
    "id": "1",
    "number": "1",
    "user": "nosuchuser",
    "command": "estop",
    "session": "999999",
}
REFUSALS = {401: "LOGIN", 403: "ROLE", 409: "CONTROL"}

OPERATIONS = [
    pytest.param(method, path, operation["x-role"], operation.get("x-control", False), id=f"{method} {path}")
    for path, methods in paths().items()
    for method, operation in methods.items()
]


class Callers:
    """A robot, and one logged-in client for each kind of caller."""

    def __init__(self, robot: Stack) -> None:
        self.robot = robot
        self.clients = {
            "nobody": robot.visitor(),
            "admin": robot.client("admin", robot.password),
            **{name: robot.client_of_new(name, CALLERS[name]) for name in ("viewer", "engineer", "holder")},
        }
        self.give_control_to_holder()

    def fresh(self, caller: str) -> httpx.Client:
        """A session of its own, to be ended."""
        return {
            "nobody": self.robot.visitor,
            "admin": lambda: self.robot.client("admin", self.robot.password),
        }.get(caller, lambda: self.robot.client(caller, f"password of {caller}"))()

    def give_control_to_holder(self) -> None:
        for name in ("admin", "engineer"):
            self.clients[name].post("/api/control/release").raise_for_status()
        self.robot.api.post("/api/control/release").raise_for_status()
        answer = self.clients["holder"].post("/api/control/request").raise_for_status()
        assert answer.json()["mine"]

    def state(self) -> dict:
        """Everything that a request could change."""
        read = self.clients["admin"].get
        found = {
            path: judge(read(path)).json()
            for path in ("/api/users", "/api/control", "/api/mode", "/api/targeting", "/api/proposals")
        }
        logs = read("/api/logs", params={"lines": 1}).raise_for_status().json()
        motors = read("/api/motors").raise_for_status().json()
        found["log level"] = logs["level"]
        found["motors"] = [(motor["state"], motor["homed"], motor["setpoint_counts"]) for motor in motors]
        found["system"] = {key: self.robot.status()[key] for key in ("mode", "holder", "pedal", "estop")}
        return found


@pytest.fixture(scope="module")
def callers() -> Iterator[Callers]:
    with tempfile.TemporaryDirectory(prefix="interlock-test-") as directory:
        robot = Stack(Path(directory))
        try:
            yield Callers(robot)
        finally:
            robot.close()


def expected_refusal(caller: str, role: str, control: bool) -> int | None:
    if RANKS.index(CALLERS[caller]) < RANKS.index(role):
        return 401 if caller == "nobody" else 403
    return 409 if control and caller != "holder" else None


@pytest.mark.parametrize(("method", "path", "role", "control"), OPERATIONS)
@pytest.mark.parametrize("caller", CALLERS)
def test_only_who_may_use_an_operation_is_let_in(
    callers: Callers, caller: str, method: str, path: str, role: str, control: bool
) -> None:
    target = re.sub(r"\{(\w+)\}", lambda name: IN_PATH[name[1]], path)
    client = callers.fresh(caller) if path == "/api/logout" else callers.clients[caller]
    body = {} if method in ("post", "put") else None
    refusal = expected_refusal(caller, role, control)
    callers.clients["holder"].post("/api/control/request")  # Who asks for nothing for a minute loses it.
    before = callers.state() if refusal else None

    answer = judge(client.request(method, target, json=body))

    if refusal:
        assert answer.status_code == refusal, answer.text
        assert answer.json()["code"] == REFUSALS[refusal]
        assert callers.state() == before
    else:
        code = answer.json()["code"] if answer.is_error else None
        assert code not in REFUSALS.values(), answer.text
        callers.give_control_to_holder()


def test_every_operation_says_who_may_use_it() -> None:
    for path, methods in paths().items():
        for method, operation in methods.items():
            assert operation.get("x-role") in RANKS, f"{method} {path}"
