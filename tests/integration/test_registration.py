"""A registration ends with what it rests on, on real processes: nothing goes to a pose without one."""

from collections.abc import Iterator

import numpy as np
from conftest import StackFactory
from interface import judge
from motion import act, enable, home_all, motor, register, restart_app, set_home, unlock, wait_until
from stack import Stack

TARGET = {"entry_point": [8, 250, 70], "target_point": [5, 200, 60]}
POSE = {"kind": "pose"}


def aimed(stack: StackFactory) -> Stack:
    """A homed robot that is registered and has a target."""
    robot = stack()
    unlock(robot)
    home_all(robot)
    register(robot)
    robot.api.put("/api/targeting/target", json=TARGET).raise_for_status()
    return robot


def registration(robot: Stack) -> tuple[str, str | None]:
    told = judge(robot.api.get("/api/targeting")).raise_for_status().json()
    return told["registration_state"], told["registration_problem"]


def expect_no_pose(robot: Stack, reason: str) -> None:
    assert registration(robot) == ("expired", f"The registration has expired: {reason}")
    view = judge(robot.api.get("/api/targeting/alignment")).raise_for_status().json()
    assert (view["frame"], view["alignment"], view["current"]) == ("robot", None, None)
    refused = judge(robot.api.post("/api/proposals", json=POSE))
    assert (refused.status_code, refused.json()["code"]) == (409, "NO_REGISTRATION")
    assert reason in refused.json()["detail"]


def test_another_start_of_the_app_expires_it_and_a_person_who_sets_it_again_makes_it_valid(
    stack: StackFactory,
) -> None:
    robot = aimed(stack)
    assert robot.api.post("/api/proposals", json=POSE).status_code == 201
    restart_app(robot)
    robot.take_control()
    expect_no_pose(robot, "The app was started since.")
    register(robot)
    assert registration(robot) == ("valid", None)
    wait_until("a pose again", lambda: robot.api.post("/api/proposals", json=POSE).status_code == 201)


def test_another_home_of_an_axis_expires_it_and_ends_the_pose_that_rests_on_it(stack: StackFactory) -> None:
    robot = aimed(stack)
    yaw = motor(robot, 0)["slot"]
    act(robot, "disable", yaw)
    before = motor(robot, yaw)["position_counts"]
    robot.control("push", slot=yaw, counts=-40)
    wait_until("it moved", lambda: motor(robot, yaw)["position_counts"] < before - 30)
    enable(robot, yaw)
    assert registration(robot) == ("valid", None), "it moved"
    made = robot.api.post("/api/proposals", json=POSE)
    assert made.status_code == 201, made.text
    made = made.json()
    set_home(robot, yaw)
    expect_no_pose(robot, "Yaw was given another home.")
    ended = robot.api.get(f"/api/proposals/{made['id']}").raise_for_status().json()
    assert ended["state"] == "aborted"


def test_a_home_that_is_lost_and_given_again_at_once_expires_it_before_anybody_is_answered(
    stack: StackFactory,
) -> None:
    robot = aimed(stack)
    for _ in range(10):
        set_home(robot, 0)
        register(robot)
        assert registration(robot) == ("valid", None), "what was declared before is past"
        undone = judge(robot.api.post("/api/positions/undo")).raise_for_status().json()
        if undone[0]["verdict"] != "ACCEPTED":
            continue  # the axis does not rest just then
        set_home(robot, 0)
        expect_no_pose(robot, "Yaw lost its home.")


def test_the_table_moved_is_said_by_any_engineer_and_outlives_a_start(stack: StackFactory) -> None:
    robot = aimed(stack)
    other = robot.client_of_new("erin", "engineer")
    judge(other.post("/api/targeting/registration/expire", json={})).raise_for_status()
    expect_no_pose(robot, "The table moved.")
    viewer = robot.client_of_new("vera", "viewer")
    assert judge(viewer.post("/api/targeting/registration/expire", json={})).status_code == 403
    restart_app(robot)
    robot.take_control()
    assert registration(robot) == ("expired", "The registration has expired: The table moved.")
    newest = robot.api.get("/api/targeting/history").raise_for_status().json()["changes"][0]
    assert (newest["user"], newest["new"]["registration_state"]) == ("erin", "expired")


LPS = np.diag([-1.0, -1.0, 1.0, 1.0])
MIDDLE_MM = np.array([-18.0, -185.0, -73.0])
"""Where models/robots/neuro.toml expects the robot."""


def turned(axis: str, degrees: float, origin: np.ndarray) -> np.ndarray:
    c, s = np.cos(np.deg2rad(degrees)), np.sin(np.deg2rad(degrees))
    pose = np.eye(4)
    one, other = {"R": (1, 2), "A": (2, 0), "S": (0, 1)}[axis]
    pose[one, one], pose[one, other], pose[other, one], pose[other, other] = c, -s, s, c
    pose[:3, 3] = origin
    return pose


def right_registrations(count: int) -> list[np.ndarray]:
    draw = np.random.default_rng(29)
    return [
        turned(draw.choice(["R", "A", "S"]), draw.uniform(-29, 29), MIDDLE_MM + draw.uniform(-99, 99, 3))
        for _ in range(count)
    ]


def scaled(pose: np.ndarray, factor: float) -> np.ndarray:
    return np.block([[pose[:3, :3], factor * pose[:3, 3:]], [pose[3:]]])


def wrong_registrations() -> Iterator[tuple[str, np.ndarray]]:
    """Each with a part of the words in which it is refused."""
    good = [turned(axis, degrees, MIDDLE_MM) for axis in "RAS" for degrees in (-14, 9)]
    for pose in good[:5]:
        yield "It looks like LPS on both sides", LPS @ pose @ LPS
    for pose in good[:4]:
        yield "It looks like LPS in the scanner", LPS @ pose
        yield "It looks like LPS on the robot", pose @ LPS
        yield "It looks like metres", scaled(pose, 1e-3)
        yield "It looks like the inverse", np.linalg.inv(pose)
        yield "transposed", pose.T
        yield "mirrors", pose @ np.diag([-1.0, 1.0, 1.0, 1.0])
    for pose in good[:3]:
        yield "It looks like centimetres", scaled(pose, 0.1)
    for degrees in (-5, 0, 5):
        yield "another robot", turned("S", degrees, np.array([4.0, -11.0, -90.0]))
    yield "metres and LPS on both sides", scaled(LPS @ good[0] @ LPS, 1e-3)
    yield "another robot", turned("R", 90, MIDDLE_MM)
    yield "another robot", turned("S", 60, MIDDLE_MM)
    yield "another robot", turned("S", 0, MIDDLE_MM + np.array([400.0, 0.0, 0.0]))
    yield "the identity", np.eye(4)


def test_no_right_registration_is_refused_and_what_looks_wrong_says_how(stack: StackFactory) -> None:
    robot = stack()
    robot.take_control()

    def put(pose: np.ndarray, **more: str) -> dict:
        body = {"registration": pose.ravel().tolist(), **more}
        return judge(robot.api.put("/api/targeting/registration", json=body)).json()

    for pose in right_registrations(40):
        assert put(pose).get("registration_state") == "valid", pose
    wrong = list(wrong_registrations())
    assert len(wrong) == 40
    kept = robot.api.get("/api/targeting").json()
    for words, pose in wrong:
        refused = put(pose)
        assert refused["code"] in ("IMPLAUSIBLE", "INVALID"), (words, refused)
        assert words in refused["detail"], refused
    assert robot.api.get("/api/targeting").json() == kept


def test_a_person_overrides_a_doubt_with_a_reason_that_is_shown_and_audited(stack: StackFactory) -> None:
    robot = stack()
    robot.take_control()
    register(robot)
    told = judge(robot.api.get("/api/targeting")).json()
    assert (told["registration_state"], told["override_reason"]) == ("valid", "There is no scanner.")
    assert told["registration_doubt"].startswith("It is the identity")
    newest = robot.api.get("/api/audit", params={"records": 100}).json()[-1]["detail"]["new"]
    assert newest["override_reason"] == "There is no scanner."
    register(robot, turned("S", 3, MIDDLE_MM).ravel().tolist())
    told = robot.api.get("/api/targeting").json()
    assert (told["registration_doubt"], told["override_reason"]) == (None, None), "nothing to override"
