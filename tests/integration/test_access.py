"""Sessions, control and what is recorded of them, on a whole robot (rights by route: test_roles.py)."""

import signal
import subprocess

import httpx
import pytest
from bare_kernel import BIN, DEADLINE_S
from conftest import StackFactory
from interface import judge
from motion import LATERAL, open_stream, proposal, propose, to_motion, wait_for_mode, wait_until
from stack import Stack
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection

SESSION_ENDED = 4401
# A hold that is not renewed lapses after 500 ms, of which closing the contacts takes 10.
LAPSE_TICKS = 490


@pytest.fixture
def robot(stack: StackFactory) -> Stack:
    return stack()


def problem(answer: httpx.Response, status: int, code: str) -> dict:
    judge(answer)
    assert (answer.status_code, answer.json()["code"]) == (status, code), answer.text
    return answer.json()


def read_to_the_end(stream: ClientConnection) -> None:
    while True:
        stream.recv()


def test_status_session_and_stop_need_no_login(robot: Stack) -> None:
    visitor = robot.visitor()
    assert judge(visitor.get("/api/status")).status_code == 200
    assert judge(visitor.get("/api/session")).json()["user"] is None
    assert judge(visitor.post("/api/stop")).json()["verdict"] == "ACCEPTED"


def test_a_hand_over_ends_motion_and_aborts_every_proposal(stack: StackFactory) -> None:
    robot = stack(speed=1)
    edna = robot.client_of_new("edna", "engineer")
    to_motion(robot)
    number = propose(robot, -1900)
    before = robot.status()["holder"]
    asked = judge(edna.post("/api/control/request"))
    assert asked.status_code == 202
    [wish] = asked.json()["requests"]
    handed = judge(robot.api.post("/api/control/hand-over", json={"session": wish["session"]}))
    assert handed.json()["holder"]["user"] == "edna"
    assert proposal(robot, number)["state"] == "aborted"
    wait_for_mode(robot, "READY")
    wait_until("the kernel knows", lambda: robot.status()["holder"] not in {0, before})
    problem(robot.api.post(f"/api/motors/{LATERAL}/enable"), 409, "CONTROL")
    assert judge(edna.post(f"/api/motors/{LATERAL}/disable")).status_code == 200


def test_control_that_is_released_is_nobodys_in_the_kernel_too(robot: Stack) -> None:
    wait_until("held", lambda: robot.status()["holder"] != 0)
    assert judge(robot.api.post("/api/control/release")).json()["holder"] is None
    wait_until("nobody", lambda: robot.status()["holder"] == 0)


def test_a_session_that_ends_closes_its_stream_and_gives_up_control(robot: Stack) -> None:
    vic = robot.client_of_new("vic", "viewer")
    with open_stream(robot) as stream:
        judge(robot.api.post("/api/logout"))
        with pytest.raises(ConnectionClosed) as closed:
            read_to_the_end(stream)
    assert closed.value.rcvd is not None
    assert closed.value.rcvd.code == SESSION_ENDED
    assert judge(vic.get("/api/control")).json()["holder"] is None


def test_a_pedal_of_a_session_that_ends_comes_up_before_its_hold_lapses(stack: StackFactory) -> None:
    robot = stack(speed=0.1)

    def tick_of(kind: str) -> int:
        return robot.control("record_event", kind=kind)["event_tick"] or 0

    robot.api.post("/api/bench/pedal", json={"pressed": True}).raise_for_status()
    wait_until("pressed", lambda: tick_of("pedal_pressed") != 0)
    judge(robot.api.post("/api/logout"))
    wait_until("released", lambda: tick_of("pedal_released") > tick_of("pedal_pressed"))
    assert tick_of("pedal_released") - tick_of("pedal_pressed") < LAPSE_TICKS


def test_sessions_outlive_the_app_and_control_does_not(robot: Stack) -> None:
    robot.signal("app", signal.SIGKILL)
    robot.output.wait_for(r"^ready ", count=2)
    assert judge(robot.api.get("/api/session")).json()["user"]["name"] == "admin"
    assert judge(robot.api.get("/api/control")).json()["holder"] is None
    robot.take_control()


def test_the_first_login_is_shown_once_and_in_no_file(robot: Stack) -> None:
    robot.signal("app", signal.SIGKILL)
    robot.output.wait_for(r"^ready ", count=2)
    offers = [line for line in robot.output.lines if line.startswith("first login: ")]
    assert offers == [f"first login: admin {robot.password}"]
    for file in robot.state.rglob("*"):
        assert not file.is_file() or robot.password.encode() not in file.read_bytes(), file


def test_the_audit_tells_what_was_done_and_its_chain_is_sound(robot: Stack) -> None:
    edna = robot.client_of_new("edna", "engineer")
    visitor = robot.visitor()
    visitor.post("/api/login", json={"name": "edna", "password": "wrong password"})
    to_motion(robot)
    propose(robot, -200)
    robot.api.post("/api/stop")
    edna.post("/api/logout")
    wanted = {"start", "login", "login_refused", "logout", "user", "control", "proposal", "request"}

    def kinds() -> set[str]:
        records = robot.api.get("/api/audit", params={"records": 1000}).raise_for_status().json()
        assert "wrong password" not in str(records)
        return {record["kind"] for record in records}

    wait_until("recorded", lambda: kinds() >= wanted | {"verdict", "stop"})
    verified = subprocess.run(
        [BIN / "interlock", "audit", "verify", "--state", robot.state],
        capture_output=True,
        text=True,
        timeout=DEADLINE_S,
        check=False,
    )
    assert verified.returncode == 0, verified.stderr
