"""Simulator, kernel and app as real processes on the simulated clock: a move, and every way to stop it."""

import random

import pytest
from conftest import StackFactory
from motion import (
    LATERAL,
    enable,
    is_driven,
    motor,
    press,
    proposal,
    propose,
    record,
    to_motion,
    unlock,
    wait_for_mode,
    wait_for_proposal,
    wait_until,
)
from stack import Stack

PHASES = 100
# Slow enough that the long way between NEAR and FAR still lasts when the test gets to ask for its end.
SPEED = 4
NEAR, FAR = -100, -1900
LONG_WAY = 300
STOP_TICKS = 2
WATCHED_TICKS = 60
STALL_EFFORT_TICKS = 68
"""Of the lateral axis, as the robot file says."""


def test_a_move_arrives_within_the_deadband(stack: StackFactory) -> None:
    robot = stack()
    to_motion(robot)
    wait_for_proposal(robot, propose(robot, -400), "done")
    axis = motor(robot)
    assert abs(axis["position_counts"] + 400) <= axis["deadband_counts"]
    assert axis["position"] == pytest.approx(axis["position_counts"] / axis["counts_per_unit"])


def watch_edge(robot: Stack, tick: int, is_edge: dict) -> None:
    """The wire is driven before the edge at plant tick `tick`, and silent from STOP_TICKS after it on."""
    entries = record(robot, tick - 5, tick + WATCHED_TICKS)
    edge = next(entry["tick"] for entry in entries if all(entry[key] == is_edge[key] for key in is_edge))
    assert any(entry["drive"][LATERAL] for entry in entries if entry["tick"] < edge)
    late = [
        entry["tick"] - edge for entry in entries if entry["tick"] > edge + STOP_TICKS and any(entry["drive"])
    ]
    assert not late, f"driven {late} ticks after the edge at plant tick {edge}"


def start_move(robot: Stack) -> None:
    """Moves to and fro, so that every phase begins with a long way to go.

    A press lets the move before go on, which may come to its end until a slow disk has recorded the new one.
    """

    def begin() -> int:
        return propose(robot, FAR if motor(robot)["position_counts"] > (NEAR + FAR) / 2 else NEAR)

    def has_far_to_go() -> bool:
        nonlocal number
        if proposal(robot, number)["state"] == "done":
            number = begin()
        axis = motor(robot)
        return axis["gate"] == "OPEN" and abs(axis["setpoint_counts"] - axis["position_counts"]) > LONG_WAY

    number = begin()
    wait_until("driven, far from its target", has_far_to_go)


def test_P2_a_released_pedal_stops_within_two_ticks_at_every_phase_of_a_move(stack: StackFactory) -> None:
    dice = random.Random(2018)
    robot = stack(speed=SPEED)
    to_motion(robot)
    for _ in range(PHASES):
        start_move(robot)
        at = robot.control("pedal", pressed=False, after=dice.randint(20, 120))["tick"]
        watch_edge(robot, at, {"pedal_no": 0})
        wait_for_mode(robot, "READY")
        press(robot)


def test_P2_P8_an_estop_stops_within_two_ticks_and_stays_locked_until_reset(stack: StackFactory) -> None:
    dice = random.Random(2019)
    robot = stack(speed=SPEED)
    to_motion(robot)
    for _ in range(PHASES):
        start_move(robot)
        at = robot.control("estop", pulled=True, after=dice.randint(20, 120))["tick"]
        watch_edge(robot, at, {"estop_loop": 0})
        status = robot.status()
        assert (status["mode"], status["cause"]) == ("LOCKED", "ESTOP")
        robot.control("estop", pulled=False)
        unlock(robot)
        enable(robot)
        press(robot)


def test_P12_after_an_estop_nothing_moves_by_reset_or_by_pressing_again(stack: StackFactory) -> None:
    robot = stack()
    to_motion(robot)
    number = propose(robot, -900)
    wait_until("driven", lambda: is_driven(robot))
    robot.control("estop", pulled=True)
    wait_for_mode(robot, "LOCKED")
    stopped = robot.control("status")["tick"]
    robot.control("estop", pulled=False)
    record(robot, stopped, stopped + 100)
    assert robot.status()["mode"] == "LOCKED"
    assert proposal(robot, number)["state"] == "aborted"
    unlock(robot)
    enable(robot)
    press(robot)
    pressed = robot.control("status")["tick"]
    entries = record(robot, stopped + 5, pressed + 500)
    assert len(entries) > 500
    assert not any(any(entry["drive"]) for entry in entries)


def test_P9_a_pedal_held_during_reset_is_refused_and_moves_nothing(stack: StackFactory) -> None:
    robot = stack()
    unlock(robot)
    robot.control("estop", pulled=True)
    wait_for_mode(robot, "LOCKED")
    robot.control("estop", pulled=False)
    robot.control("pedal", pressed=True)
    wait_until("pedal pressed", lambda: robot.status()["pedal"] == "PRESSED")
    refusal = robot.api.post("/api/reset")
    assert refusal.status_code == 409
    assert refusal.json()["code"] == "PEDAL_DOWN"
    assert refusal.json()["next_step"]
    assert robot.status()["mode"] == "LOCKED"


def test_P4_a_move_beyond_the_range_is_refused_with_the_range(stack: StackFactory) -> None:
    robot = stack()
    to_motion(robot)
    axis = motor(robot)
    refusal = robot.api.post(
        "/api/proposals", json={"slot": LATERAL, "target_counts": axis["max_counts"] + 1}
    )
    assert refusal.status_code in (409, 422)
    assert str(axis["max_counts"]) in refusal.text
    assert not is_driven(robot)


def test_P5_a_blocked_axis_stalls_by_its_effort_within_68_ticks_of_full_drive(stack: StackFactory) -> None:
    robot = stack()
    to_motion(robot)
    robot.control("jam", slot=LATERAL, jammed=True)
    start = robot.control("status")["tick"]
    number = propose(robot, -900)
    wait_until("faulted", lambda: motor(robot)["state"] == "FAULTED")
    assert motor(robot)["fault"] == "STALL"
    wait_for_proposal(robot, number, "aborted")
    end = robot.control("status")["tick"]
    driven = sum(entry["drive"][LATERAL] != 0 for entry in record(robot, start, end))
    assert driven == STALL_EFFORT_TICKS
