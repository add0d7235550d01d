"""A registration ends with what it rests on, on real processes: nothing goes to a pose without one."""

import os
import signal

from conftest import StackFactory
from interface import judge
from motion import act, enable, home_all, motor, register, set_home, unlock, wait_until
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
    os.kill(robot.pid("app"), signal.SIGKILL)
    robot.output.wait_for(r"^ready http", count=2)
    wait_until("served again", lambda: robot.status()["app_alive"])
    robot.take_control()
    expect_no_pose(robot, "The app was started since.")
    register(robot)
    assert registration(robot) == ("valid", None)
    wait_until("a pose again", lambda: robot.api.post("/api/proposals", json=POSE).status_code == 201)


def test_another_home_of_an_axis_expires_it_and_ends_the_pose_that_rests_on_it(stack: StackFactory) -> None:
    robot = aimed(stack)
    yaw = motor(robot, 0)["slot"]
    act(robot, "disable", yaw)
    robot.control("push", slot=yaw, counts=-40)
    enable(robot, yaw)
    assert registration(robot) == ("valid", None), "it moved"
    made = robot.api.post("/api/proposals", json=POSE).raise_for_status().json()
    set_home(robot, yaw)
    wait_until("expired", lambda: registration(robot)[0] == "expired")
    expect_no_pose(robot, "Yaw was given another home.")
    ended = robot.api.get(f"/api/proposals/{made['id']}").raise_for_status().json()
    assert ended["state"] == "aborted"


def test_the_table_moved_is_said_by_any_engineer_and_outlives_a_start(stack: StackFactory) -> None:
    robot = aimed(stack)
    other = robot.client_of_new("erin", "engineer")
    judge(other.post("/api/targeting/registration/expire", json={})).raise_for_status()
    expect_no_pose(robot, "The table moved.")
    viewer = robot.client_of_new("vera", "viewer")
    assert judge(viewer.post("/api/targeting/registration/expire", json={})).status_code == 403
    os.kill(robot.pid("app"), signal.SIGKILL)
    robot.output.wait_for(r"^ready http", count=2)
    wait_until("served again", lambda: robot.status()["app_alive"])
    assert registration(robot) == ("expired", "The registration has expired: The table moved.")
    newest = robot.api.get("/api/targeting/history").raise_for_status().json()["changes"][0]
    assert (newest["user"], newest["new"]["registration_state"]) == ("erin", "expired")
