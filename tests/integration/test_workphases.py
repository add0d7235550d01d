"""The workphases of a needle placement over OpenIGTLink, from START_UP to the target, on a whole robot."""

from collections.abc import Callable, Iterator

import numpy as np
import pytest
from conftest import StackFactory
from interface import judge
from motion import (
    approve,
    confirm,
    enable,
    home_all,
    press,
    set_home,
    unlock,
    wait_for_mode,
    wait_until,
)
from navigation_phases import Phases, aimed, short, to_targeting
from navigator import Navigator, Query, text, transform
from stack import Stack

CONNECTIONS = "/api/communications/connections"


@pytest.fixture(params=["brp2013", "wpi2024"])
def dialect(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture
def robot(stack: StackFactory, dialect: str) -> Stack:
    started = stack(speed=1, igtl=True, dialect=dialect)
    unlock(started)
    return started


@pytest.fixture
def version() -> int:
    """Of the header; a test that takes several has it as a parameter."""
    return 1


@pytest.fixture
def connect(robot: Stack, version: int) -> Iterator[Callable[[], Phases]]:
    open_ones: list[Phases] = []

    def controller() -> Phases:
        open_ones.append(Phases(Navigator(robot.igtl_port, version)))
        wait_until("listed", lambda: len(robot.api.get(CONNECTIONS).json()) == len(open_ones))
        number = robot.api.get(CONNECTIONS).json()[-1]["id"]
        answer = robot.api.put(f"{CONNECTIONS}/{number}/role", json={"role": "controller"})
        assert judge(answer).status_code == 200, answer.text
        return open_ones[-1]

    yield controller
    for each in open_ones:
        each.stop()


@pytest.mark.parametrize("version", [1, 2])
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
    confirm(robot)
    wait_until("there", lambda: robot.api.get("/api/proposals").json()[0]["state"] == "done")
    navigator.await_answers("ACK_0001 STRING", "CURRENT_STATUS 1 MOVE_TO_TARGET", "MOVE_TO_TARGET 1")
    wait_until("last one", lambda: short(navigator.heard.all[-1]) == "CURRENT_POSITION TRANSFORM")
    reached = navigator.heard.all[-1].matrix[:3, 3]
    assert np.linalg.norm(reached - np.array(aimed()).reshape(4, 4)[:3, 3]) < 0.5


def moving_to_target(robot: Stack, connect: Callable[[], Phases], dialect: str) -> Phases:
    """A controller for which the robot moves to its target."""
    home_all(robot)
    navigator = connect()
    to_targeting(navigator, dialect)
    navigator.phase("MOVE_TO_TARGET")
    approve(robot)
    press(robot)
    wait_until("it moves", lambda: robot.api.get("/api/proposals").json()[0]["state"] == "executing")
    return navigator


def test_stop_and_emergency_act_while_it_moves(
    robot: Stack, connect: Callable[[], Phases], dialect: str
) -> None:
    navigator = moving_to_target(robot, connect, dialect)
    navigator.phase("STOP", "STOP 1")
    assert robot.api.get("/api/proposals").json()[0]["state"] == "aborted"
    wait_for_mode(robot, "READY")
    navigator.phase("EMERGENCY", "EMERGENCY 1")
    assert all(axis["state"] == "DISABLED" for axis in robot.api.get("/api/motors").json())


def test_homing_waits_for_somebody_to_approve_it_and_for_the_pedal(
    robot: Stack, connect: Callable[[], Phases]
) -> None:
    set_home(robot, "feet")
    for axis in robot.api.get("/api/motors").json():
        enable(robot, axis["slot"])
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
    far = aimed()
    far[3] += 5000
    [_, status] = navigator.expect(transform("TGT_0009", far), "ACK_0009 TRANSFORM", "TARGET 10")
    assert status.text
    assert robot.api.get("/api/targeting").json()["target_point"] is None, "the one before would pass for it"
    navigator.phase("MOVE_TO_TARGET", "MOVE_TO_TARGET 13")


@pytest.mark.parametrize("dialect", ["wpi2024"], indirect=True)
def test_a_target_that_the_axes_miss_is_refused_with_what_they_reach_and_leaves_none(
    robot: Stack, connect: Callable[[], Phases], dialect: str
) -> None:
    home_all(robot)
    navigator = connect()
    to_targeting(navigator, dialect)
    beside = aimed()
    beside[3] += 60
    [_, status, reachable] = navigator.expect(
        transform("TGT_0009", beside), "ACK_0009 TRANSFORM", "TARGET 10", "REACHABLE_TARGET TRANSFORM"
    )
    assert status.sub_code == 3
    assert "misses the desired one by" in status.text
    assert abs(reachable.matrix[0, 3] - beside[3]) > 1.0
    assert robot.api.get("/api/targeting").json()["target_point"] is None, "the one before would pass for it"
    navigator.phase("MOVE_TO_TARGET", "MOVE_TO_TARGET 13")
    assert robot.api.get("/api/proposals").json() == []


@pytest.mark.parametrize("dialect", ["wpi2024"], indirect=True)
def test_a_target_that_the_links_cannot_reach_has_a_sub_code_of_its_own_and_leaves_none(
    robot: Stack, connect: Callable[[], Phases], dialect: str
) -> None:
    home_all(robot)
    navigator = connect()
    to_targeting(navigator, dialect)
    far = aimed()
    far[7] += 5000
    [_, status] = navigator.expect(transform("TGT_0009", far), "ACK_0009 TRANSFORM", "TARGET 10")
    assert status.sub_code == 2
    assert "out of reach" in status.text
    assert robot.api.get("/api/targeting").json()["target_point"] is None, "the one before would pass for it"


def test_an_observer_is_answered_and_moves_nothing_but_stops(robot: Stack) -> None:
    observer = Phases(Navigator(robot.igtl_port))
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


@pytest.mark.parametrize("dialect", ["wpi2024"], indirect=True)
def test_a_needle_is_followed_to_the_target_and_retracted(
    robot: Stack, connect: Callable[[], Phases], dialect: str
) -> None:
    home_all(robot)
    navigator = connect()
    to_targeting(navigator, dialect)
    assert is_out_and_there(navigator) == ["1", "0"]
    navigator.expect(text("RETRACT_NEEDLE", ""), "ACK_RETRACT_NEEDLE 13")
    navigator.phase("MOVE_TO_TARGET")
    approve(robot)
    press(robot)
    confirm(robot)
    navigator.await_answers("ACK_0001 STRING", "CURRENT_STATUS 1 MOVE_TO_TARGET", "MOVE_TO_TARGET 1")
    navigator.expect(transform("NPOS_0004", aimed()), "ACK_0004 TRANSFORM", "MOVE_TO_TARGET 1")
    assert is_out_and_there(navigator) == ["0", "1"]
    navigator.expect(text("RETRACT_NEEDLE", ""), "ACK_RETRACT_NEEDLE 1")
    run(robot)
    navigator.await_answers("ACK_RETRACT_NEEDLE 1", "RETRACT_NEEDLE 1")
    assert is_out_and_there(navigator) == ["1", "0"]


def is_out_and_there(navigator: Phases) -> list[str]:
    """Whether the needle is out, and whether it has reached the target."""
    navigator.expect(text("CURRENT_POSITION", ""), "IS_IN_TARGETING_POS STRING", "HAS_REACHED_TARGET STRING")
    return [each.string for each in navigator.answers()]


def run(robot: Stack) -> None:
    """Approves the newest proposal and holds the pedal until it is done."""
    approve(robot)
    press(robot)
    wait_until("done", lambda: robot.api.get("/api/proposals").json()[0]["state"] == "done")


@pytest.mark.parametrize("dialect", ["wpi2024"], indirect=True)
def test_a_target_that_moves_during_the_motion_asks_for_approval_anew(
    robot: Stack, connect: Callable[[], Phases], dialect: str
) -> None:
    navigator = moving_to_target(robot, connect, dialect)
    beside = aimed()
    beside[11] += 2
    navigator.expect(
        transform("TGT_0005", beside),
        *("ACK_0005 TRANSFORM", "TARGET 1", "TARGET TRANSFORM", "REACHABLE_TARGET TRANSFORM"),
    )
    wait_until("proposed anew", lambda: len(robot.api.get("/api/proposals").json()) == 2)
    newest, before = robot.api.get("/api/proposals").json()
    assert (newest["state"], before["state"]) == ("checked", "aborted")


@pytest.mark.parametrize("dialect", ["wpi2024"], indirect=True)
def test_words_of_the_robots_program_are_answered(
    robot: Stack, connect: Callable[[], Phases], dialect: str
) -> None:
    home_all(robot)
    navigator = connect()
    navigator.expect(text("NEEDLE_LENGTH", "150"), "ACK_NEEDLE_LENGTH 13")
    navigator.phase("START_UP", "START_UP 1")
    [echo] = navigator.expect(text("NEEDLE_LENGTH", "150"), "ACK_NEEDLE_LENGTH STRING")
    assert echo.string == "150"
    navigator.expect(text("NEEDLE_LENGTH", "long"), "ACK_NEEDLE_LENGTH 10")
    navigator.expect(text("CURV_METHOD", "bidirectional"), "ACK_CURV_METHOD 12")
    navigator.expect(text("ALPHA", "0.5"), "ACK_ALPHA 12")
    navigator.expect(text("HELLO", "robot"), "ACK_HELLO 0")
    assert robot.api.get("/api/proposals").json() == []
