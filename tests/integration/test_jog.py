"""Jogging on a whole robot: an axis moves while pedal and renewals hold, and no longer."""

import pytest
from conftest import StackFactory
from interface import judge
from motion import LATERAL, motor, proposal, to_motion, wait_for_mode, wait_for_proposal, wait_until
from stack import Stack


@pytest.fixture
def robot(stack: StackFactory) -> Stack:
    # A lease of 200 ms of this clock is four seconds for whoever renews it.
    started = stack(speed=0.05)
    to_motion(started)
    return started


def begin(robot: Stack, direction: str = "decreasing") -> int:
    """Begins a jog of the lateral axis; its number."""
    body = {"slot": LATERAL, "direction": direction}
    answer = judge(robot.api.post("/api/jog", json=body))
    assert answer.status_code == 201, answer.text
    return answer.json()["id"]


def position(robot: Stack) -> int:
    return motor(robot, LATERAL)["position_counts"]


def test_a_jog_goes_on_while_it_is_renewed_and_ends_when_it_is_aborted(robot: Stack) -> None:
    start, number = position(robot), begin(robot)

    def has_moved() -> bool:
        assert judge(robot.api.put(f"/api/jog/{number}")).status_code == 200, str(proposal(robot, number))
        return position(robot) < start - 20

    wait_until("the axis has jogged", has_moved)
    assert judge(robot.api.post(f"/api/proposals/{number}/abort")).status_code == 200
    wait_until("the axis is let go", lambda: motor(robot, LATERAL)["drive"] == 0)
    assert judge(robot.api.put(f"/api/jog/{number}")).json()["code"] == "JOG_LAPSED"


def test_a_jog_that_nobody_renews_ends_by_itself_far_from_the_end_of_its_range(robot: Stack) -> None:
    number = begin(robot)
    target = proposal(robot, number)["target_counts"]
    wait_for_proposal(robot, number, "aborted")
    wait_until("the axis is let go", lambda: motor(robot, LATERAL)["drive"] == 0)
    assert abs(position(robot) - target) > abs(target) / 4
    assert judge(robot.api.put(f"/api/jog/{number}")).json()["code"] == "JOG_LAPSED"


def test_without_the_pedal_a_renewed_jog_drives_nothing(robot: Stack) -> None:
    robot.control("pedal", pressed=False)
    wait_for_mode(robot, "READY")
    number = begin(robot)
    for _ in range(20):
        judge(robot.api.put(f"/api/jog/{number}"))
        assert motor(robot, LATERAL)["drive"] == 0
    wait_for_proposal(robot, number, "aborted")
