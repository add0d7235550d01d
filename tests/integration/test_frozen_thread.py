"""A thread of the app, or the kernel, stands still: what test_faults.py does not show."""

import signal
import time
from pathlib import Path

import pytest
from conftest import StackFactory
from frozen import frozen, thread_of
from interface import judge
from motion import LATERAL, press, proposal, propose, to_motion, wait_for_proposal, wait_until
from stack import Stack, has_ended, watched

# Of the wall, which ticks of the paced clock never outrun.
MOTION_ENDS_WITHIN_TICKS = 200
LONG_AFTER_TICKS = 600
APPROVED_FOR_S = 1.0


@pytest.fixture
def robot(stack: StackFactory) -> Stack:
    started = stack(speed=1)
    to_motion(started)
    return started


def plant_tick(robot: Stack) -> int:
    return robot.control("status")["tick"]


def last_drive(robot: Stack) -> int:
    return robot.control("record_event", kind="last_nonzero_drive")["event_tick"]


def wait_until_driven(robot: Stack) -> None:
    begin = last_drive(robot) or 0
    wait_until("the axis is driven", lambda: (last_drive(robot) or 0) > begin)


def assert_motion_ends(robot: Stack, frozen_at: int) -> None:
    wait_until("the plant is long past", lambda: plant_tick(robot) > frozen_at + LONG_AFTER_TICKS)
    assert last_drive(robot) <= frozen_at + MOTION_ENDS_WITHIN_TICKS


@pytest.mark.parametrize("thread", ["network", "door"])
def test_a_move_ends_says_why_and_does_not_go_on_by_itself(robot: Stack, thread: str) -> None:
    number = propose(robot, -1000)
    wait_until_driven(robot)
    with frozen(robot.pid("app"), thread):
        assert_motion_ends(robot, plant_tick(robot))
    wait_for_proposal(robot, number, "aborted")
    assert "stopped answering people" in proposal(robot, number)["detail"]
    ended = last_drive(robot)
    press(robot)
    assert last_drive(robot) == ended
    again = {"slot": LATERAL, "target_counts": -1000}
    # For a moment after its pause the door cannot tell what was sent before.
    wait_until("it goes on", lambda: robot.api.post("/api/proposals", json=again).status_code == 201)
    wait_until_driven(robot)


def test_STOP_on_a_connection_that_had_an_answer_is_answered_while_the_network_stands_still(
    robot: Stack,
) -> None:
    propose(robot, -1000)
    wait_until_driven(robot)
    client = robot.visitor()
    judge(client.get("/api/status")).raise_for_status()
    with frozen(robot.pid("app"), "network"):
        stopped = judge(client.post("/api/stop"))
        assert stopped.json()["verdict"] == "ACCEPTED"
        at = plant_tick(robot)
        wait_until("the plant is past", lambda: plant_tick(robot) > at + 100)
        assert last_drive(robot) <= at
    wait_until(
        "it is recorded",
        lambda: any(each["kind"] == "stop" for each in robot.api.get("/api/audit").json()),
    )


def test_what_was_approved_of_a_frozen_kernel_never_comes_into_force(robot: Stack) -> None:
    body = {"slot": LATERAL, "target_counts": -1000}
    before, answers = last_drive(robot), []

    def is_refused() -> bool:
        answers.append(judge(robot.api.post("/api/proposals", json=body)))
        return answers[-1].status_code == 503

    robot.signal("kernel", signal.SIGSTOP)
    try:
        wait_until("its state is old", is_refused)
        refused_at = time.monotonic()
        wait_until("every deadline has passed", lambda: time.monotonic() > refused_at + APPROVED_FOR_S)
    finally:
        robot.signal("kernel", signal.SIGCONT)
    *approved, refused = [answer.json() for answer in answers]
    assert refused["code"] == "NO_KERNEL"
    assert "ms old" in refused["detail"]
    assert approved
    wait_for_proposal(robot, approved[-1]["id"], "aborted")
    assert "ms late" in proposal(robot, approved[-1]["id"])["detail"]
    press(robot)
    assert last_drive(robot) == before


def test_threads_that_people_wait_for_run_before_the_rest(robot: Stack) -> None:
    app = robot.pid("app")
    nice = {
        int(task.name): int((task / "stat").read_text().rpartition(")")[2].split()[16])
        for task in Path(f"/proc/{app}/task").iterdir()
    }
    assert {nice[thread_of(app, name)] for name in ("network", "door", "control")} == {-10}
    assert 0 in nice.values(), "whoever hashes passwords takes turns with the rest of the machine"


def test_a_signal_ends_an_app_whose_network_stands_still(robot: Stack) -> None:
    propose(robot, -1000)
    wait_until_driven(robot)
    app = robot.pid("app")
    with watched(app) as [end], frozen(app, "network"):
        robot.signal("app", signal.SIGTERM)
        at = plant_tick(robot)
        assert has_ended(end)
        assert last_drive(robot) <= at + MOTION_ENDS_WITHIN_TICKS
