"""Cooperative Biopsy on real processes: a hand pushes a needle through membranes to its target."""

import math

import pytest
from conftest import StackFactory
from motion import (
    approve,
    enable,
    motor,
    press,
    proposal,
    record,
    set_home,
    unlock,
    wait_for_proposal,
    wait_until,
)
from stack import Stack

ROTATION, INSERTION, FORCE_CARD = 0, 1, 3
TARGET = [3.0, -2.0, 70.0]
COUNTS_PER_MM = 1666.67
# A simulated kernel runs so far ahead of the app at most; a real one does not.
TICKS_AHEAD = 10


def ready(stack: StackFactory) -> Stack:
    """The needle is homed, and its rotation stands at 0."""
    robot = stack(robot="prostate")
    unlock(robot)
    set_home(robot, ROTATION)
    for axis in (ROTATION, INSERTION):
        enable(robot, axis)
    number = robot.api.post("/api/proposals", json={"kind": "home", "slot": INSERTION}).json()["id"]
    press(robot)
    wait_for_proposal(robot, number, "done")
    return robot


def biopsy(robot: Stack) -> dict:
    return robot.api.get("/api/biopsy").raise_for_status().json()


def propose(robot: Stack) -> int:
    answer = robot.api.post("/api/proposals", json={"kind": "biopsy", "target_mm": TARGET})
    assert answer.status_code == 201, answer.text
    number = approve(robot, answer.json()["id"])
    press(robot)
    return number


def pass_image(robot: Stack) -> None:
    """Hands on the newest image of the scanner."""
    image = robot.control("image")["image"]
    if image is not None:
        body = {"tip_mm": image["tip_mm"], "target_mm": image["target_mm"], "age_ms": image["age_s"] * 1000}
        robot.api.post("/api/biopsy/images", json=body)


def test_a_hand_pushes_the_needle_through_two_membranes_to_its_target(stack: StackFactory) -> None:
    robot = ready(stack)
    robot.api.post("/api/biopsy/zero").raise_for_status()
    number = propose(robot)
    assert robot.status()["app_mode"] == "cooperative_biopsy"
    wait_for_proposal(robot, number, "executing")
    robot.control("target", by_mm=[-2.0, 2.0, 0.0])
    robot.control("hand", newtons=5.0)
    wait_until("a hand that is felt", lambda: biopsy(robot)["hand"]["force_n"] > 4.5)

    def is_over() -> bool:
        pass_image(robot)
        # A target that moved, or an image that came late, makes the needle wait: a surgeon lets go meanwhile.
        waits = (biopsy(robot)["now"] or {}).get("images_disagree", False)
        robot.control("hand", newtons=0.0 if waits else 5.0)
        return proposal(robot, number)["state"] not in ("executing", "approved")

    wait_until("the end", is_over)
    assert proposal(robot, number)["state"] == "done", proposal(robot, number)["detail"]
    truth = robot.control("status")["needle"]
    assert math.dist(truth["tip_mm"], truth["target_mm"]) < 6.0
    assert len(truth["punctures_mm"]) == 2
    shown = biopsy(robot)
    assert (shown["open"], shown["left"]) == (False, 0)
    for membrane, torn_mm in zip(shown["membranes"], truth["punctures_mm"], strict=True):
        assert membrane["state"] == "passed"
        assert membrane["found_mm"] == pytest.approx(torn_mm, abs=1.0)
    assert robot.status()["app_mode"] == "manual"
    again = robot.api.post("/api/proposals", json={"kind": "biopsy", "target_mm": TARGET})
    assert (again.status_code, again.json()["code"]) == (409, "IN_TISSUE")


def test_a_silent_force_sensor_stops_the_needle_and_says_so(stack: StackFactory) -> None:
    robot = ready(stack)
    number = propose(robot)
    robot.control("hand", newtons=5.0)
    wait_until("motion", lambda: motor(robot, INSERTION)["position_counts"] > 5 * COUNTS_PER_MM)
    cut = robot.control("card_power", slot=FORCE_CARD, on=False)["tick"]
    wait_for_proposal(robot, number, "aborted")
    assert "force sensor" in proposal(robot, number)["detail"]
    late = record(robot, cut + 20 + TICKS_AHEAD, cut + 100)
    assert len(late) > 50
    assert all(entry["drive"][INSERTION] == 0 for entry in late)
    assert robot.status()["app_mode"] == "manual"
    refused = robot.api.post("/api/proposals", json={"kind": "biopsy", "target_mm": TARGET})
    assert (refused.status_code, refused.json()["code"]) == (409, "FORCE_STALE")


def test_release_pauses_and_manual_ends_it(stack: StackFactory) -> None:
    robot = ready(stack)
    number = propose(robot)
    wait_for_proposal(robot, number, "executing")
    robot.control("pedal", pressed=False)
    wait_for_proposal(robot, number, "paused")
    robot.api.put("/api/mode", json={"mode": "manual"}).raise_for_status()
    wait_for_proposal(robot, number, "aborted")


def test_membranes_are_set_and_reset_but_not_under_an_open_biopsy(stack: StackFactory) -> None:
    robot = ready(stack)
    assert [each["depth_mm"] for each in biopsy(robot)["membranes"]] == [25.0, 50.0]
    changed = robot.api.put("/api/biopsy/membranes", json={"depths_mm": [20, 30, 40], "next": 1})
    states = [each["state"] for each in changed.raise_for_status().json()["membranes"]]
    assert states == ["passed", "next", "expected"]
    wrong = robot.api.put("/api/biopsy/membranes", json={"depths_mm": [20, 20]})
    assert (wrong.status_code, wrong.json()["field"]) == (422, "depths_mm[1]")
    assert robot.api.post("/api/biopsy/membranes/reset").json()["next"] == 0
    propose(robot)
    open_one = robot.api.post("/api/biopsy/membranes/reset")
    assert (open_one.status_code, open_one.json()["code"]) == (409, "BIOPSY_OPEN")


def test_a_pressed_sensor_is_not_zeroed(stack: StackFactory) -> None:
    robot = ready(stack)
    before = biopsy(robot)["hand"]["zero_counts"]
    robot.control("hand", newtons=9.0)
    wait_until("a hand that is felt", lambda: biopsy(robot)["hand"]["force_n"] > 8.0)
    refused = robot.api.post("/api/biopsy/zero")
    assert (refused.status_code, refused.json()["code"]) == (409, "ZEROING")
    assert biopsy(robot)["hand"]["zero_counts"] == before
