"""Three users call anything in any order while threads and processes stand still or die: the app answers as
spec/openapi.yaml says, lives on, and moves nothing once it was stopped."""

import os
import random
import signal
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field

import httpx
import jsonschema
import pytest
from conftest import StackFactory
from frozen import frozen
from interface import judge, paths, resolved
from motion import LATERAL, enable, unlock, wait_until
from stack import Stack

CALLS = int(os.environ.get("INTERLOCK_RANDOM_CALLS", "1500"))
"""Of each user. The rest of the run is as long as they take."""
SEEDS = [1, 2]
FROZEN_S = (0.05, 0.3, 1.2)
QUIET_TICKS = 500
LEFT_OUT = {
    "stream",
    "logout",
    "endSession",
    "login",
    "changePassword",
    "changeUser",
    "addUser",
    "setLogLevel",
}
BEGIN = {"createProposal", "beginJog"}
OFTEN = BEGIN | {"approveProposal", "abortProposal", "rejectProposal", "renewJog", "actOnMotor"}
FIRST_IDS = 40
READY: list[tuple[str, str, dict | None]] = [
    ("POST", "control/request", None),
    ("POST", "control/take-over", None),
    ("POST", "cases", {"label": "of the test"}),
    ("PUT", "holds/scan", {"active": False}),
    ("POST", "reset", None),
    ("POST", f"motors/{LATERAL}/set-home", {"override_switch": True}),
    ("POST", f"motors/{LATERAL}/enable", None),
]
"""What a person does before a motion."""


def make_ready(client: httpx.Client) -> None:
    for method, step, settings in READY:
        client.request(method, f"/api/{step}", json=settings)


@contextmanager
def living_app(client: httpx.Client) -> Iterator[None]:
    """The calls within may fail because the app was killed or stands still; the next ones find it again."""

    def answers() -> bool:
        with suppress(httpx.TransportError):
            return client.get("/api/session").status_code < 600
        return False

    try:
        yield
    except httpx.TransportError:
        wait_until("the app answers again", answers)


@dataclass
class Caller:
    """One user with a session, who draws calls from the interface."""

    client: httpx.Client
    draw: random.Random
    answers: dict[int, int] = field(default_factory=dict)

    def value(self, schema: dict, depth: int = 0) -> object:
        """Something that fits the schema in most cases; bounds and odd values more often than others."""
        schema = resolved(schema)
        if self.draw.random() < 0.03:
            return self.draw.choice([None, -1, 1e308, "", "x" * 300, [], {}, True])
        for several in ("oneOf", "anyOf"):
            if several in schema:
                return self.value(self.draw.choice(schema[several]), depth)
        if "allOf" in schema:
            merged: dict = {}
            for part in schema["allOf"]:
                one = self.value(part, depth)
                merged |= one if isinstance(one, dict) else {}
            return merged
        if "enum" in schema:
            return self.draw.choice(schema["enum"])
        if "const" in schema:
            return schema["const"]
        kind = schema.get("type", "object")
        kind = self.draw.choice(kind) if isinstance(kind, list) else kind
        if kind == "object":
            required = schema.get("required", [])
            return {
                name: self.value(each, depth + 1)
                for name, each in schema.get("properties", {}).items()
                if name in required or self.draw.random() < 0.4
            }
        if kind == "array":
            count = self.draw.randint(schema.get("minItems", 0), min(schema.get("maxItems", 4), 16))
            return [self.value(schema.get("items", {}), depth + 1) for _ in range(count)]
        if kind == "boolean":
            return self.draw.random() < 0.5
        if kind in ("integer", "number"):
            low, high = schema.get("minimum", -2000), schema.get("maximum", 2000)
            some = self.draw.choice([low, high, self.draw.uniform(low, high), 0])
            return int(some) if kind == "integer" else some
        return "".join(self.draw.choices("ab0:_-é", k=self.draw.randint(0, 12)))

    def target(self, path: str, parameters: list[dict]) -> str:
        for parameter in map(resolved, parameters):
            if parameter["in"] == "path":
                known = [str(self.draw.randint(1, FIRST_IDS)), str(LATERAL), "lateral", "enable", "disable"]
                schema = resolved(parameter["schema"])
                named = self.draw.choice(schema.get("enum", known))
                path = path.replace("{" + parameter["name"] + "}", named)
        return path

    def call(self, path: str, method: str, operation: dict) -> None:
        body = operation.get("requestBody")
        if body is None:
            content = {}
        else:
            [(kind, described)] = list(resolved(body)["content"].items())[:1]
            some = self.value(described["schema"])
            content = {"json": some} if kind == "application/json" else {"content": str(some)}
        target = self.target(path, operation.get("parameters", []))
        if operation["operationId"] == "createProposal" and self.draw.random() < 0.7:
            content = {"json": {"slot": LATERAL, "target_counts": self.draw.randint(-3000, -10)}}
        with living_app(self.client):
            if operation["operationId"] in BEGIN and self.draw.random() < 0.3:
                make_ready(self.client)
            answer = self.client.request(method, target, **content)
            assert answer.status_code != 500, answer.text
            try:
                judge(answer)
            except jsonschema.ValidationError as error:
                raise AssertionError(f"{method} {target} {content}: {answer.text}") from error
            self.answers[answer.status_code] = self.answers.get(answer.status_code, 0) + 1

    def go_on(self) -> None:
        operations = [
            (path, method, operation)
            for path, item in paths().items()
            for method, operation in item.items()
            if operation["operationId"] not in LEFT_OUT
        ]
        often = [each for each in operations if each[2]["operationId"] in OFTEN]
        for _ in range(CALLS):
            self.call(*self.draw.choice(often if self.draw.random() < 0.5 else operations))


def disturb(robot: Stack, holder: httpx.Client, draw: random.Random) -> None:
    """Something that happens to a program, a hand or a foot."""
    what = draw.choice(["pedal", "pedal", "pedal", "stop", "unlock", "freeze", "freeze", "kernel", "kill"])
    if what == "pedal":
        robot.control("pedal", pressed=draw.random() < 0.7)
    elif what == "stop":
        robot.visitor().post("/api/stop")
    elif what == "unlock":
        robot.control("pedal", pressed=False)
        make_ready(holder)
        robot.control("pedal", pressed=True)
    elif what == "freeze":
        with frozen(robot.pid("app"), draw.choice(["network", "door", "control"])):
            time.sleep(draw.choice(FROZEN_S))
    elif what == "kernel":
        robot.signal("kernel", signal.SIGSTOP)
        time.sleep(draw.choice(FROZEN_S))
        robot.signal("kernel", signal.SIGCONT)
    elif draw.random() < 0.1:
        robot.signal("app", signal.SIGKILL)


def assert_stopped_for_good(robot: Stack) -> None:
    """Whatever was open, late or on its way: after a STOP the pedal moves nothing."""
    with living_app(robot.visitor()):
        robot.visitor().get("/api/session")
    wait_until("it is stopped", lambda: robot.visitor().post("/api/stop").json().get("verdict") == "ACCEPTED")
    robot.control("pedal", pressed=False)
    driven = robot.control("record_event", kind="last_nonzero_drive")["event_tick"]
    begun = robot.control("status")["tick"]
    robot.control("pedal", pressed=True)
    wait_until("time passes", lambda: robot.control("status")["tick"] > begun + QUIET_TICKS)
    assert robot.control("record_event", kind="last_nonzero_drive")["event_tick"] == driven


@pytest.mark.parametrize("seed", SEEDS)
def test_any_order_of_calls_and_failures_leaves_a_robot_that_stops(stack: StackFactory, seed: int) -> None:
    robot = stack(speed=1, seed=seed)
    unlock(robot)
    enable(robot)
    engineer, viewer = (robot.client_of_new(name, name) for name in ("engineer", "viewer"))
    callers = [
        Caller(client, random.Random(f"{seed} {place}"))
        for place, client in enumerate((robot.client("admin", robot.password), engineer, viewer))
    ]
    draw = random.Random(seed)
    with ThreadPoolExecutor() as pool:
        calling = [pool.submit(caller.go_on) for caller in callers]
        while not all(each.done() for each in calling):
            with suppress(httpx.TransportError, OSError, AssertionError):  # there may be no app now
                disturb(robot, callers[draw.randrange(2)].client, draw)
    for each in calling:
        each.result()
    assert_stopped_for_good(robot)
    assert sum(sum(caller.answers.values()) for caller in callers) > CALLS
    assert any(caller.answers.get(201) for caller in callers), "nothing was ever approved"
    ends = [line for line in robot.output.lines if " ended: " in line]
    assert all("signal 9" in line for line in ends), ends
