"""How far a pose may be off is stated with its alignment and kept with its motion, on real processes."""

import math

import pytest
from conftest import StackFactory
from interface import judge
from motion import home_all, register, unlock, wait_until
from stack import Stack

AIM = {"entry_point": [8, 250, 70], "target_point": [5, 200, 60]}
FIDUCIALS = [[-40, 0, 0], [40, 0, 10], [-30, 60, 0], [35, 50, 40], [0, 20, 60]]
FIT = {"residual_mm": 0.4, "fiducial_points": FIDUCIALS}
COVARIANCE = [0.04, 0, 0, 0, 0.04, 0, 0, 0, 0.09]


def budget(robot: Stack) -> dict:
    view = judge(robot.api.get("/api/targeting/alignment")).raise_for_status().json()
    assert view["alignment"]["error_budget_problem"] is None
    return view["alignment"]["error_budget"]


def not_stated(found: dict) -> list[str]:
    return [each["source"] for each in found["contributions"] if each["not_stated"] is not None]


def set_target(robot: Stack, **more: object) -> None:
    judge(robot.api.put("/api/targeting/target", json={**AIM, **more})).raise_for_status()


def test_the_budget_grows_by_what_is_stated_and_is_kept_with_the_motion(
    stack: StackFactory,
) -> None:
    robot = stack()
    unlock(robot)
    home_all(robot)
    register(robot)
    set_target(robot)
    of_joints = budget(robot)
    assert not_stated(of_joints) == ["registration", "play", "calibration", "image"]
    register(robot, **FIT)
    registered = budget(robot)
    assert not_stated(registered) == ["play", "calibration", "image"]
    set_target(robot, target_covariance_mm2=COVARIANCE)
    found = budget(robot)
    assert not_stated(found) == ["play", "calibration"]
    longest = [each["treatment"]["half_axes_mm"][0] for each in (of_joints, registered, found)]
    assert longest == sorted(longest)
    for point in ("treatment", "tip"):
        shares = [each[f"{point}_mm"] for each in found["contributions"]]
        assert math.hypot(*shares) == pytest.approx(found[point]["half_axes_mm"][0])

    proposed = judge(robot.api.post("/api/proposals", json={"kind": "pose"})).raise_for_status().json()
    assert proposed["aim"]["error_budget"] == found

    def on_record() -> bool:
        kept = [record["detail"] for record in robot.api.get("/api/audit").json()]
        return any(
            detail.get("id") == proposed["id"] and detail["aim"]["error_budget"] == found for detail in kept
        )

    wait_until("the motion is on record with its budget", on_record)


def test_a_new_target_point_has_no_covariance_of_the_one_before(stack: StackFactory) -> None:
    robot = stack()
    register(robot)
    set_target(robot, target_covariance_mm2=COVARIANCE)
    assert "image" not in not_stated(budget(robot))
    set_target(robot)
    assert "image" in not_stated(budget(robot))


def test_fiducials_on_a_line_are_named_in_the_place_of_a_number(stack: StackFactory) -> None:
    robot = stack()
    register(robot, residual_mm=0.4, fiducial_points=[[0, 0, 0], [10, 0, 0], [50, 0, 0]])
    set_target(robot)
    alignment = judge(robot.api.get("/api/targeting/alignment")).raise_for_status().json()["alignment"]
    assert alignment["error_budget"] is None
    assert alignment["error_budget_problem"]["code"] == "SINGULAR"
    assert alignment["error_budget_problem"]["quantity"] == "fiducial_spread_mm"


def test_points_that_are_not_as_many_as_the_fiducials_are_refused(stack: StackFactory) -> None:
    robot = stack()
    body = {"registration": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], **FIT, "fiducials": 4}
    refused = judge(robot.api.put("/api/targeting/registration", json=body))
    assert (refused.status_code, refused.json()["field"]) == (422, "fiducial_points")
