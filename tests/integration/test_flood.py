"""Connections: how many there are, what is said and recorded of them."""

import contextlib
import resource
import socket

import pytest
from conftest import StackFactory
from interface import judge
from stack import Stack

CROWD = 60


@pytest.fixture
def robot(stack: StackFactory) -> Stack:
    return stack()


def test_an_app_that_may_have_few_descriptors_grants_fewer_connections(
    stack: StackFactory,
) -> None:
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (110, hard))
    try:
        robot = stack()
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))
    with contextlib.ExitStack() as connections:
        for _ in range(CROWD):
            connections.enter_context(socket.create_connection(("127.0.0.1", robot.port)))
        assert judge(robot.visitor().post("/api/stop")).status_code == 200
    assert "cannot accept" not in (robot.state / "log/interlock-app.log").read_text()


def test_what_is_done_at_the_bench_and_to_connections_is_recorded(robot: Stack) -> None:
    robot.api.post("/api/bench/jam", json={"slot": 4, "jammed": True}).raise_for_status()
    for renew in (False, True, True):
        held = robot.api.post("/api/bench/pedal", json={"pressed": True, "renew": renew})
        assert held.status_code in {200, 409}
    robot.api.post("/api/bench/pedal", json={"pressed": False}).raise_for_status()
    robot.api.post("/api/bench/status", json={}).raise_for_status()
    records = judge(robot.api.get("/api/audit")).json()
    asked = [record["detail"] for record in records if record["kind"] == "bench"]
    assert asked == [
        {"command": "jam", "fields": {"slot": 4, "jammed": True}},
        {"command": "pedal", "fields": {"pressed": True, "renew": False}},
        {"command": "pedal", "fields": {"pressed": False}},
    ]


def test_connections_say_since_when_they_stand(robot: Stack) -> None:
    kernel, bench = judge(robot.api.get("/api/communications")).json()[:2]
    assert (kernel["type"], kernel["connected"]) == ("kernel", True)
    assert (bench["type"], bench["connected"]) == ("bench", True)
    assert kernel["since"] <= bench["since"]
    again = judge(robot.api.get("/api/communications")).json()[:2]
    assert [each["since"] for each in again] == [kernel["since"], bench["since"]]
