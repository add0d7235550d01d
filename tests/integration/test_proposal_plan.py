"""What people look at before they approve a proposal, on real processes: checks, profile, ghost, reject."""

import math

import pytest
from conftest import StackFactory
from motion import (
    approve,
    enable,
    press,
    proposal,
    register,
    set_home,
    unlock,
    wait_for_proposal,
)
from stack import Stack
from test_paths import HEAD, LATERAL, propose, ready


def plan(robot: Stack, number: int) -> dict:
    answer = robot.api.get(f"/api/proposals/{number}/plan")
    assert answer.status_code == 200, answer.text
    return answer.json()


def outcomes(found: dict) -> dict[str, str]:
    return {check["name"]: check["outcome"] for check in found["checks"]}


def test_the_plan_is_the_way_that_the_axes_then_go(stack: StackFactory) -> None:
    robot = ready(stack)
    register(robot)
    number = propose(robot, kind="coordinated", targets={"lateral": -20.0, "head": -25.0})
    assert set(outcomes(plan(robot, number)).values()) == {"passed"}
    approve(robot, number)
    found = plan(robot, number)
    assert set(outcomes(found).values()) == {"passed"}
    profile = found["profile"]
    assert profile["basis"] == "time"
    assert profile["times_s"][-1] == pytest.approx(proposal(robot, number)["duration_s"], abs=1e-3)
    assert len(profile["times_s"]) <= 302
    for axis in profile["axes"]:
        assert len(axis["positions_counts"]) == len(profile["times_s"])
        assert axis["fastest_counts_per_s"] <= axis["velocity_limit_counts_per_s"] + 0.01
    ghost = found["ghost"]
    press(robot)
    wait_for_proposal(robot, number, "done")
    reached = robot.api.get("/api/targeting/alignment").json()
    # One count of the deadband of either axis is 0.02 mm or less, two are settled within.
    assert math.dist(ghost["treatment"][3::4][:3], reached["current"][3::4][:3]) < 0.1
    now = {axis["slot"]: axis for axis in robot.api.get("/api/motors").json()}
    for axis in profile["axes"]:
        assert abs(axis["positions_counts"][-1] - now[axis["slot"]]["position_counts"]) <= 2
    for planned, stands in zip(ghost["body"], reached["current_body"], strict=True):
        assert planned["name"] == stands["name"]
        assert math.dist(planned["to"], stands["to"]) < 0.1
    assert plan(robot, number) == found, "the plan of what was done stays what it was"


def test_a_refused_move_names_the_check_that_failed_and_is_seen_beyond_its_limit(stack: StackFactory) -> None:
    robot = ready(stack)
    refused = robot.api.post("/api/proposals", json={"slot": LATERAL, "target": 12.0})
    assert refused.status_code == 409
    newest = robot.api.get("/api/proposals").json()[0]
    found = plan(robot, newest["id"])
    assert outcomes(found)["axes"] == "passed"
    assert [check["code"] for check in found["checks"] if check["outcome"] == "failed"] == ["RANGE"]
    [axis] = found["profile"]["axes"]
    assert found["profile"]["basis"] == "way"
    assert axis["positions_counts"][-1] > axis["highest_setpoint_counts"]


def test_homing_has_checks_but_nothing_to_plot(stack: StackFactory) -> None:
    robot = stack()
    unlock(robot)
    enable(robot, LATERAL)
    found = plan(robot, propose(robot, kind="home", slot=LATERAL))
    assert outcomes(found)["switches"] == "passed"
    assert (found["profile"]["basis"], found["ghost"]) == ("none", None)
    assert found["ghost_problem"]["code"] == "NO_PLAN"


def test_a_ghost_needs_homed_axes_and_says_which_are_not(stack: StackFactory) -> None:
    robot = stack()
    unlock(robot)
    set_home(robot, "feet")
    set_home(robot, HEAD)
    enable(robot, HEAD)
    found = plan(robot, propose(robot, slot=HEAD, target=-5.0))
    assert found["profile"]["basis"] == "way"
    assert found["ghost_problem"]["code"] == "NOT_HOMED"
    assert "Lateral" in found["ghost_problem"]["text"]


def test_a_waiting_proposal_is_rejected_by_name_and_on_record(stack: StackFactory) -> None:
    robot = ready(stack)
    rows = "time [s],yaw [rad]\n0,-0.1\n1,-0.4\n"
    robot.api.put("/api/trajectory", content=rows, headers={"Content-Type": "text/csv"}).raise_for_status()
    number = propose(robot, kind="trajectory")
    rejected = robot.api.post(f"/api/proposals/{number}/reject")
    assert rejected.status_code == 200, rejected.text
    assert (rejected.json()["state"], rejected.json()["detail"]) == (
        "aborted",
        "Rejected by admin before it was approved.",
    )
    for again in ("approve", "reject"):
        late = robot.api.post(f"/api/proposals/{number}/{again}")
        assert (late.status_code, late.json()["code"]) == (409, "NOT_WAITING")
    audit = robot.api.get("/api/audit").json()
    assert any(record["detail"].get("rejected") == number for record in audit)


def test_the_reach_holds_where_the_robot_stands(stack: StackFactory) -> None:
    robot = ready(stack)
    number = propose(robot, kind="coordinated", targets={"lateral": -25.0, "head": -40.0, "feet": -20.0})
    approve(robot, number)
    press(robot)
    wait_for_proposal(robot, number, "done")
    reach = robot.api.get("/api/targeting/reach").json()
    assert reach["problem"] is None
    # zFrame and scanner are the same.
    register(robot)
    x, y, z = robot.api.get("/api/targeting/alignment").json()["current"][3::4][:3]
    for axis, value in enumerate((x, y, z)):
        ends = [centre[axis] for centre in reach["centres"]]
        assert min(ends) - reach["cell_mm"] / 2 <= value <= max(ends) + reach["cell_mm"] / 2
