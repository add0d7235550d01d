"""Several axes together on real processes: coordinated motion, a trajectory, a pose, and what ends them."""

from typing import Any

import pytest
from bad_trajectories import BAD_TRAJECTORIES
from conftest import StackFactory
from motion import (
    approve,
    home_all,
    motor,
    press,
    proposal,
    unlock,
    wait_for_proposal,
    wait_until,
)
from stack import Stack

YAW, ROTATION, PITCH, INSERTION, LATERAL, FEET, HEAD = 0, 1, 2, 3, 4, 6, 7
AXES = (YAW, ROTATION, PITCH, INSERTION, LATERAL, FEET, HEAD)


def ready(stack: StackFactory, **options: int) -> Stack:
    """Every axis referenced where it stands and enabled."""
    robot = stack(**options)
    unlock(robot)
    home_all(robot)
    return robot


def propose(robot: Stack, **body: object) -> int:
    answer = robot.api.post("/api/proposals", json=body)
    assert answer.status_code == 201, answer.text
    return answer.json()["id"]


def assert_at(robot: Stack, slot: int, position: float) -> None:
    axis = motor(robot, slot)
    tolerance = (axis["deadband_counts"] + 0.5) / axis["counts_per_unit"]
    assert axis["position"] == pytest.approx(position, abs=tolerance), axis["name"]


def test_seven_axes_arrive_together_and_the_pedal_pauses_them(stack: StackFactory) -> None:
    robot = ready(stack)
    targets = {"yaw": -0.5, "probe_rotation": 1.0, "pitch": -0.3, "insertion": 15.0, "lateral": -20.0}
    targets |= {"feet": -10.0, "head": -25.0}
    number = approve(robot, propose(robot, kind="coordinated", targets=targets))
    press(robot)
    wait_for_proposal(robot, number, "executing")
    robot.control("pedal", pressed=False)
    wait_for_proposal(robot, number, "paused")
    press(robot)
    wait_for_proposal(robot, number, "done")
    for name, position in targets.items():
        assert_at(robot, robot.api.get(f"/api/motors/{name}").json()["slot"], position)
    assert robot.status()["app_mode"] == "manual"


def test_what_is_approved_under_a_held_pedal_waits_for_a_new_press(stack: StackFactory) -> None:
    robot = ready(stack)
    press(robot)
    targets = {"lateral": -20.0, "head": -25.0}
    for asked in ({"kind": "coordinated", "targets": targets}, {"kind": "home"}):
        number = propose(robot, **asked)
        approve(robot, number)
        wait_until(
            "it says so",
            lambda number=number: proposal(robot, number)["detail"].startswith(
                "Release the pedal and press it again"
            ),
        )
        begun = robot.status()["tick"]
        wait_until("time passes", lambda begun=begun: robot.status()["tick"] > begun + 500)
        assert proposal(robot, number)["state"] == "approved"
        assert all(motor(robot, slot)["drive"] == 0 for slot in AXES)
        press(robot)
        wait_for_proposal(robot, number, "executing")


def test_a_trajectory_from_a_file_waits_for_approval_and_is_followed(stack: StackFactory) -> None:
    robot = ready(stack)
    rows = "time [s],yaw [rad],insertion [mm]\n0,-0.1,1\n1,-0.4,4\n2.5,-0.2,8\n"
    loaded = robot.api.put("/api/trajectory", content=rows, headers={"Content-Type": "text/csv"})
    assert loaded.status_code == 200, loaded.text
    number = propose(robot, kind="trajectory")
    assert proposal(robot, number)["state"] == "checked"
    approve(robot, number)
    press(robot)
    wait_for_proposal(robot, number, "done")
    assert_at(robot, YAW, -0.2)
    assert_at(robot, INSERTION, 8.0)
    assert robot.api.get("/api/trajectory").json()["rows"] == 0


def test_a_trajectory_that_is_too_fast_is_loaded_slowed_down_when_its_author_asks(
    stack: StackFactory,
) -> None:
    robot = ready(stack)
    rows = "time [s],yaw [rad]\n" + "".join(f"{n / 10},{-0.3 - 0.05 * (n % 2)}\n" for n in range(10))
    sent: dict[str, Any] = {"content": rows, "headers": {"Content-Type": "text/csv"}}
    refused = robot.api.put("/api/trajectory", **sent)
    assert (refused.status_code, refused.json()["code"]) == (422, "TOO_MUCH_ACCELERATION"), refused.text
    unknown = robot.api.put("/api/trajectory", params={"timing": "faster"}, **sent)
    assert (unknown.status_code, unknown.json()["field"]) == (422, "timing"), unknown.text
    loaded = robot.api.put("/api/trajectory", params={"timing": "slowed_to_fit"}, **sent)
    assert loaded.status_code == 200, loaded.text
    assert loaded.json()["slowed_by"] > 1.0
    assert loaded.json()["duration_s"] == pytest.approx(0.9 * loaded.json()["slowed_by"])
    number = approve(robot, propose(robot, kind="trajectory"))
    press(robot)
    wait_for_proposal(robot, number, "done")
    assert_at(robot, YAW, -0.35)


def test_a_jammed_axis_ends_the_path_of_all(stack: StackFactory) -> None:
    robot = ready(stack)
    number = approve(robot, propose(robot, kind="coordinated", targets={"lateral": -20.0, "head": -25.0}))
    press(robot)
    wait_for_proposal(robot, number, "executing")
    robot.control("jam", slot=HEAD, jammed=True)
    wait_for_proposal(robot, number, "aborted")
    assert "head" in proposal(robot, number)["detail"].lower()
    wait_until("zero drive", lambda: all(motor(robot, slot)["gate"] != "OPEN" for slot in AXES))


def test_stop_ends_a_path(stack: StackFactory) -> None:
    robot = ready(stack)
    number = approve(robot, propose(robot, kind="coordinated", targets={"lateral": -20.0, "head": -25.0}))
    press(robot)
    wait_for_proposal(robot, number, "executing")
    robot.api.post("/api/stop").raise_for_status()
    wait_for_proposal(robot, number, "aborted")


def test_bad_trajectories_are_refused_whole_with_row_column_and_reason_and_nothing_moves(
    stack: StackFactory,
) -> None:
    robot = ready(stack)
    press(robot)
    before = [motor(robot, slot)["position_counts"] for slot in AXES]
    proposed = robot.api.get("/api/proposals").json()
    for name, bad in BAD_TRAJECTORIES.items():
        refused = robot.api.put("/api/trajectory", content=bad.text, headers={"Content-Type": "text/csv"})
        problem = refused.json()
        assert (refused.status_code, problem["code"]) == (422, bad.code), (name, problem)
        assert problem["detail"].startswith(bad.place), (name, problem)
        assert (problem.get("line"), problem.get("field")) == (bad.line, bad.column), (name, problem)
        assert robot.api.get("/api/trajectory").json()["rows"] == 0, name
        mode = robot.api.put("/api/mode", json={"mode": "trajectory"})
        assert (mode.status_code, mode.json()["code"]) == (409, "EMPTY"), name
    after = [motor(robot, slot)["position_counts"] for slot in AXES]
    assert all(abs(now - then) <= 1 for now, then in zip(after, before, strict=True))
    assert robot.api.get("/api/proposals").json() == proposed
