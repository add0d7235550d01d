"""The workphases of a needle placement over OpenIGTLink, from START_UP to the target, on a whole robot."""

import time
from collections.abc import Callable, Iterator

import numpy as np
import pytest
from bare_kernel import DEADLINE_S
from conftest import StackFactory
from interface import judge
from motion import act, press, set_home, unlock, wait_for_mode, wait_until
from navigator import Navigator, Query, Status, text, transform
from pyigtl import messages as wire
from stack import Stack

CONNECTIONS = "/api/communications/connections"
LIMIT_S = 0.1
CALIBRATION = [1, 0, 0, 0.125, 0, 1, 0, -0.25, 0, 0, 1, 0.5, 0, 0, 0, 1]
ENTRY, TARGET = np.array([8.0, 250.0, 70.0]), np.array([5.0, 200.0, 60.0])


def aimed() -> list[float]:
    """The pose of a probe that comes from ENTRY and whose treatment point is at TARGET, in the scanner."""
    ahead = (TARGET - ENTRY) / np.linalg.norm(TARGET - ENTRY)
    side = np.cross([0, 0, 1], ahead)
    side /= np.linalg.norm(side)
    pose = np.eye(4)
    pose[:3, 0], pose[:3, 1], pose[:3, 2] = side, np.cross(ahead, side), ahead
    pose[:3, 3] = TARGET + np.array([0.125, -0.25, 0.5])
    return pose.astype(np.float32).astype(float).ravel().tolist()


def short(message: wire.MessageBase) -> str:
    """How a message begins: "CURRENT_STATUS 1 PLANNING", "START_UP 1", "ACK_7 STRING"."""
    if not isinstance(message, Status):
        return f"{message.device_name} {message.message_type}"
    name = f" {message.name}" if message.device_name == "CURRENT_STATUS" else ""
    return f"{message.device_name} {message.code}{name}"


class Phases(Navigator):
    """A navigation program that knows what it heard since it last asked."""

    since = 0

    def messages(self) -> list[wire.MessageBase]:
        """What was heard since then."""
        return [message for _, message in self.heard.all[self.since :]]

    def answers(self) -> list[wire.MessageBase]:
        """The same, the stream of positions apart."""
        return [each for each in self.messages() if each.device_name != "CURRENT_POSITION"]

    def shorts(self) -> list[str]:
        return [short(each) for each in self.answers()]

    def expect(self, message: wire.MessageBase, *answers: str) -> list[wire.MessageBase]:
        """Exactly these answers come, in this order; ACK and CURRENT_STATUS within their limit."""
        self.since = len(self.heard.all)
        sent = time.monotonic()
        self.send(message)
        self.await_answers(*answers)
        messages = self.heard.all[self.since :]
        for at, each in messages:
            if each.device_name.startswith("ACK_") or each.device_name == "CURRENT_STATUS":
                assert at - sent < LIMIT_S, f"{short(each)} after {at - sent:.3f} s"
        return self.answers()

    def await_answers(self, *answers: str) -> None:
        deadline = time.monotonic() + DEADLINE_S
        while len(self.shorts()) < len(answers) and time.monotonic() < deadline:
            with self.client.lock_incoming_messages:
                pass
        assert self.shorts() == list(answers)

    def phase(self, name: str, *status: str, number: str = "0001") -> None:
        """Asks for a phase: the ACK bears the same ID and text, CURRENT_STATUS the phase."""
        messages = self.expect(
            text(f"CMD_{number}", name), f"ACK_{number} STRING", f"CURRENT_STATUS 1 {name}", *status
        )
        assert messages[0].string == name


@pytest.fixture(params=["brp2013", "wpi2024"])
def dialect(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture
def robot(stack: StackFactory, dialect: str) -> Stack:
    started = stack(speed=1, igtl=True, dialect=dialect)
    unlock(started)
    return started


@pytest.fixture
def connect(robot: Stack) -> Iterator[Callable[[], Phases]]:
    open_ones: list[Phases] = []

    def controller() -> Phases:
        open_ones.append(Phases(robot.igtl_port))
        wait_until("listed", lambda: len(robot.api.get(CONNECTIONS).json()) == len(open_ones))
        number = robot.api.get(CONNECTIONS).json()[-1]["id"]
        answer = robot.api.put(f"{CONNECTIONS}/{number}/role", json={"role": "controller"})
        assert judge(answer).status_code == 200, answer.text
        return open_ones[-1]

    yield controller
    for each in open_ones:
        each.stop()


def home_all(robot: Stack) -> None:
    for axis in robot.api.get("/api/motors").json():
        set_home(robot, axis["slot"])
        act(robot, "enable", axis["slot"])


def approve(robot: Stack) -> None:
    def newest() -> dict:
        return robot.api.get("/api/proposals").json()[0]

    wait_until("proposed", lambda: robot.api.get("/api/proposals").json() != [])
    wait_until("it waits", lambda: newest()["state"] == "checked")
    number = newest()["id"]
    judge(robot.api.post(f"/api/proposals/{number}/approve")).raise_for_status()


def to_targeting(navigator: Phases, dialect: str) -> None:
    entered = dialect == "wpi2024"
    navigator.phase("START_UP", "START_UP 1")
    navigator.phase("CALIBRATION", *(["CALIBRATION 1"] if entered else []))
    [echo, *_] = navigator.expect(transform("CLB_0002", CALIBRATION), "ACK_0002 TRANSFORM", "CALIBRATION 1")
    assert echo.matrix.ravel().tolist() == CALIBRATION
    navigator.phase("PLANNING", *(["PLANNING 1"] if entered else []))
    navigator.phase("TARGETING", "TARGETING 1")
    reachable = ["REACHABLE_TARGET TRANSFORM"] if entered else []
    pose = aimed()
    echo, status, told, *_ = navigator.expect(
        transform("TGT_0003", pose), "ACK_0003 TRANSFORM", "TARGET 1", "TARGET TRANSFORM", *reachable
    )
    assert echo.matrix.ravel().tolist() == pose
    assert np.allclose(told.matrix[:3, 3], np.array(pose).reshape(4, 4)[:3, 3], atol=1e-3), status.text


def test_the_whole_way_to_the_target_with_every_answer_in_its_order(
    robot: Stack, connect: Callable[[], Phases], dialect: str
) -> None:
    home_all(robot)
    navigator = connect()
    to_targeting(navigator, dialect)
    navigator.phase("MOVE_TO_TARGET")
    assert robot.api.get("/api/mode").json()["mode"] == "manual", "somebody has to approve it"
    approve(robot)
    press(robot)
    wait_until("it moves", lambda: robot.api.get("/api/proposals").json()[0]["state"] == "executing")
    wait_until("streamed", lambda: "CURRENT_POSITION TRANSFORM" in map(short, navigator.messages()))
    wait_until("there", lambda: robot.api.get("/api/proposals").json()[0]["state"] == "done")
    navigator.await_answers("ACK_0001 STRING", "CURRENT_STATUS 1 MOVE_TO_TARGET", "MOVE_TO_TARGET 1")
    wait_until("last one", lambda: short(navigator.heard.all[-1][1]) == "CURRENT_POSITION TRANSFORM")
    reached = navigator.heard.all[-1][1].matrix[:3, 3]
    assert np.linalg.norm(reached - np.array(aimed()).reshape(4, 4)[:3, 3]) < 0.5


def test_stop_and_emergency_act_while_it_moves(
    robot: Stack, connect: Callable[[], Phases], dialect: str
) -> None:
    home_all(robot)
    navigator = connect()
    to_targeting(navigator, dialect)
    navigator.phase("MOVE_TO_TARGET")
    approve(robot)
    press(robot)
    wait_until("it moves", lambda: robot.api.get("/api/proposals").json()[0]["state"] == "executing")
    navigator.phase("STOP", "STOP 1")
    assert robot.api.get("/api/proposals").json()[0]["state"] == "aborted"
    wait_for_mode(robot, "READY")
    navigator.phase("EMERGENCY", "EMERGENCY 1")
    assert all(axis["state"] == "DISABLED" for axis in robot.api.get("/api/motors").json())


def test_homing_waits_for_somebody_to_approve_it_and_for_the_pedal(
    robot: Stack, connect: Callable[[], Phases]
) -> None:
    for axis in robot.api.get("/api/motors").json():
        act(robot, "enable", axis["slot"])
    navigator = connect()
    navigator.phase("START_UP")
    wait_until("proposed", lambda: len(robot.api.get("/api/proposals").json()) == 1)
    [proposal] = judge(robot.api.get("/api/proposals")).json()
    assert (proposal["kind"], proposal["source"], proposal["state"]) == ("home", "openigtlink", "checked")
    navigator.await_answers("ACK_0001 STRING", "CURRENT_STATUS 1 START_UP", "START_UP 6")
    approve(robot)
    wait_until("approved", lambda: robot.api.get("/api/mode").json()["mode"] == "home")
    judge(robot.api.put("/api/mode", json={"mode": "manual"})).raise_for_status()
    navigator.await_answers("ACK_0001 STRING", "CURRENT_STATUS 1 START_UP", "START_UP 6", "START_UP 13")


def test_manual_cuts_the_power(robot: Stack, connect: Callable[[], Phases]) -> None:
    home_all(robot)
    navigator = connect()
    navigator.phase("START_UP", "START_UP 1")
    navigator.phase("MANUAL", "MANUAL 1")
    assert all(axis["state"] == "DISABLED" for axis in robot.api.get("/api/motors").json())


def test_a_matrix_that_is_no_rotation_is_echoed_and_refused(
    robot: Stack, connect: Callable[[], Phases], dialect: str
) -> None:
    home_all(robot)
    navigator = connect()
    navigator.phase("START_UP", "START_UP 1")
    navigator.phase("CALIBRATION", *(["CALIBRATION 1"] if dialect == "wpi2024" else []))
    ones = [1.0] * 12 + [0, 0, 0, 1]
    [echo, status] = navigator.expect(transform("CLB_0002", ones), "ACK_0002 TRANSFORM", "CALIBRATION 10")
    assert echo.matrix.ravel().tolist() == ones
    assert status.text
    assert connections_refused(robot) == 1


def connections_refused(robot: Stack) -> int:
    return judge(robot.api.get(CONNECTIONS)).json()[0]["refused"]


@pytest.mark.parametrize("dialect", ["brp2013"], indirect=True)
def test_a_target_out_of_reach_is_refused_and_leaves_none(
    robot: Stack, connect: Callable[[], Phases], dialect: str
) -> None:
    home_all(robot)
    navigator = connect()
    to_targeting(navigator, dialect)
    kept = robot.api.get("/api/targeting").json()
    far = aimed()
    far[3] += 5000
    [_, status] = navigator.expect(transform("TGT_0009", far), "ACK_0009 TRANSFORM", "TARGET 10")
    assert status.text
    assert robot.api.get("/api/targeting").json() == kept
    navigator.phase("MOVE_TO_TARGET", "MOVE_TO_TARGET 13")


@pytest.mark.parametrize("dialect", ["wpi2024"], indirect=True)
def test_a_target_out_of_reach_is_moved_to_what_can_be_reached(
    robot: Stack, connect: Callable[[], Phases], dialect: str
) -> None:
    home_all(robot)
    navigator = connect()
    to_targeting(navigator, dialect)
    beside = aimed()
    beside[3] += 60
    [_, status, told, reachable] = navigator.expect(
        transform("TGT_0009", beside),
        "ACK_0009 TRANSFORM",
        "TARGET 10",
        "TARGET TRANSFORM",
        "REACHABLE_TARGET TRANSFORM",
    )
    assert status.sub_code == 3
    assert np.array_equal(told.matrix, reachable.matrix)
    assert abs(told.matrix[0, 3] - beside[3]) > 0.1
    navigator.phase("MOVE_TO_TARGET")
    approve(robot)


def test_an_observer_is_answered_and_moves_nothing_but_stops(robot: Stack) -> None:
    observer = Phases(robot.igtl_port)
    observer.expect(text("CMD_1", "START_UP"), "ACK_1 STRING", "CURRENT_STATUS 5 UNDEFINED", "START_UP 5")
    observer.phase("STOP", "STOP 1")
    assert robot.api.get("/api/proposals").json() == []
    observer.stop()


def test_the_phase_can_be_asked_for_and_a_disconnect_forgets_it(
    robot: Stack, connect: Callable[[], Phases]
) -> None:
    home_all(robot)
    navigator = connect()
    assert navigator.ask(Query("STATUS", "CURRENT_STATUS")).name == "UNDEFINED"
    navigator.phase("START_UP", "START_UP 1")
    assert navigator.ask(Query("STATUS", "CURRENT_STATUS")).name == "START_UP"
    again = connect()
    answer = again.ask(Query("STATUS", "CURRENT_STATUS"))
    assert (answer.name, answer.code) == ("UNDEFINED", 10)


@pytest.mark.parametrize("dialect", ["wpi2024"], indirect=True)
def test_a_phase_out_of_order_is_answered(robot: Stack, connect: Callable[[], Phases]) -> None:
    navigator = connect()
    navigator.expect(text("CMD_1", "PLANNING"), "ACK_1 STRING", "CURRENT_STATUS 13 UNDEFINED", "PLANNING 13")
