"""Identification on real processes: an axis of a running robot, measured under the pedal."""

import json
import subprocess
from pathlib import Path

import pytest
from bare_kernel import BIN, DEADLINE_S, ROOT
from conftest import StackFactory
from motion import (
    act,
    approve,
    enable,
    motor,
    press,
    proposal,
    propose_home,
    release,
    set_home,
    unlock,
    wait_for_proposal,
    wait_for_ticks,
    wait_until,
    wait_until_driven,
)
from stack import Stack

YAW, INSERTION = 0, 3
LONGEST_S = 5 * DEADLINE_S
MAX_DRIVE = 0xEFFF
HIDDEN = {"full_speed_counts_per_s": 800, "dead_zone_fraction": 0.02, "lag_ms": 8.0, "backlash_counts": 3}
MEASURE = {"kind": "identify", "axis": "yaw", "cleared": True}


@pytest.fixture
def hidden(tmp_path: Path) -> Path:
    """Simulated hardware of which the robot's file knows nothing."""
    lines = (ROOT / "models/plant/neuro.toml").read_text().splitlines()
    defaults = lines.index("[defaults]")
    for key, value in HIDDEN.items():
        place = next(n for n, line in enumerate(lines) if n > defaults and line.startswith(f"{key} ="))
        lines[place] = f"{key} = {value}"
    file = tmp_path / "hidden.toml"
    file.write_text("\n".join(lines) + "\n")
    return file


def in_process(plant: Path, robot: str | Path = "neuro", axis: str = "yaw") -> dict:
    command = [
        str(BIN / "interlock"),
        "identify",
        "--robot",
        str(robot),
        "--axis",
        axis,
        "--plant",
        str(plant),
    ]
    run = subprocess.run(command, capture_output=True, text=True, timeout=DEADLINE_S, check=True)
    return json.loads(run.stdout)


def cleared(stack: StackFactory, **options: object) -> Stack:
    """Yaw and insertion homed, the probe out, and no case open."""
    robot = stack(**options)
    unlock(robot)
    for slot in (INSERTION, YAW):
        enable(robot, slot)
        number = propose_home(robot, slot=slot)
        press(robot)
        wait_for_proposal(robot, number, "done")
        release(robot)
    return robot


def close_case(robot: Stack) -> None:
    case = robot.api.get("/api/cases").json()[0]["number"]
    robot.api.post(f"/api/cases/{case}/close").raise_for_status()


def begun(robot: Stack, axis: str = "yaw") -> int:
    answer = robot.api.post("/api/proposals", json={**MEASURE, "axis": axis})
    assert answer.status_code == 201, answer.text
    assert answer.json()["state"] == "checked"
    return approve(robot, answer.json()["id"])


def test_a_running_robot_is_measured_as_well_as_a_simulated_axis_of_ones_own(
    stack: StackFactory, hidden: Path, tmp_path: Path
) -> None:
    robot = cleared(stack, plant=hidden)
    refused = robot.api.post("/api/proposals", json=MEASURE)
    assert (refused.status_code, refused.json()["code"]) == (409, "CASE")
    close_case(robot)
    number = begun(robot)
    press(robot)
    assert robot.status()["app_mode"] == "identification"
    for ticks in (7000, 1234):
        wait_for_ticks(robot, ticks)
        release(robot)
        wait_for_proposal(robot, number, "paused")
        assert motor(robot, YAW)["drive"] == 0
        press(robot)
    wait_for_proposal(robot, number, "done", LONGEST_S)
    found = proposal(robot, number)["measured"]

    assert found["full_speed_counts_per_s"] == pytest.approx(800, rel=0.006)
    assert found["dead_zone_drive"] == pytest.approx(0.02 * MAX_DRIVE, abs=0.003 * MAX_DRIVE)
    assert found["lag_ms"] == pytest.approx(8, abs=2)
    assert found["backlash_counts"] == pytest.approx(3, abs=0.75)
    assert found["hysteresis_counts"] is None
    compared(found, in_process(hidden))

    # What comes out is a difference to a file that nobody has touched, and a file with which the robot homes.
    change = robot.api.get(f"/api/proposals/{number}/robot-file").raise_for_status().json()
    assert change["problem"] is None
    shipped = ROOT / "models/robots/neuro.toml"
    was, now = shipped.read_text().splitlines(), change["text"].splitlines()
    assert len(was) == len(now)
    minus = [line[1:] for line in change["diff"].splitlines()[2:] if line.startswith("-")]
    plus = [line[1:] for line in change["diff"].splitlines()[2:] if line.startswith("+")]
    different = [pair for pair in zip(was, now, strict=True) if pair[0] != pair[1]]
    assert list(zip(minus, plus, strict=True)) == different
    assert {each["key"] for each in change["changes"]} >= {"mechanics.full_speed_counts_per_s"}
    file = tmp_path / "measured.toml"
    file.write_text(change["text"])
    assert in_process(hidden, file)["homing_error"] is None


def compared(found: dict, alone: dict) -> None:
    """Both within the bounds of docs/tuning.md."""
    full, lag = alone["full_speed_counts_per_s"], alone["lag_ms"]
    assert found["full_speed_counts_per_s"] == pytest.approx(full, rel=0.006)
    assert found["lag_ms"] == pytest.approx(lag, abs=2)
    assert found["backlash_counts"] == pytest.approx(alone["backlash_counts"], abs=0.75)
    assert found["noise_counts"] == alone["noise_counts"]
    largest = found["speeds"][0]["drive"]
    assert largest == alone["speeds"][0]["drive"]
    assert found["dead_zone_drive"] == pytest.approx(alone["dead_zone_drive"], abs=0.003 * largest)
    assert found["coast_counts"] is None or found["coast_counts"] == pytest.approx(
        alone["coast_counts"], rel=0.05, abs=1
    )


@pytest.mark.parametrize(("axis", "slot"), [("rotation", 0), ("insertion", 1)])
def test_a_high_frequency_axis_and_what_inserts_are_measured_too(
    stack: StackFactory, axis: str, slot: int
) -> None:
    robot = stack(robot="prostate")
    unlock(robot)
    insertion = 1
    enable(robot, insertion)
    number = propose_home(robot, slot=insertion)
    press(robot)
    wait_for_proposal(robot, number, "done")
    release(robot)
    if slot != insertion:
        set_home(robot, slot)
        enable(robot, slot)
    close_case(robot)
    number = begun(robot, axis)
    press(robot)
    wait_for_proposal(robot, number, "done", LONGEST_S)
    alone = in_process(ROOT / "models/plant/prostate.toml", "prostate", axis)
    compared(proposal(robot, number)["measured"], alone)
    assert robot.api.get(f"/api/proposals/{number}/robot-file").json()["diff"] == ""


def test_stop_ends_a_measurement_and_nothing_of_it_is_a_file(stack: StackFactory) -> None:
    robot = cleared(stack)
    close_case(robot)
    number = begun(robot)
    press(robot)
    wait_until_driven(robot)
    robot.api.post("/api/stop").raise_for_status()
    wait_for_proposal(robot, number, "aborted")
    wait_until("rest", lambda: motor(robot, YAW)["drive"] == 0)
    answer = robot.api.get(f"/api/proposals/{number}/robot-file")
    assert (answer.status_code, answer.json()["code"]) == (409, "NOT_MEASURED")


def test_an_axis_that_is_moved_beside_the_measurement_ends_it(stack: StackFactory) -> None:
    robot = cleared(stack)
    close_case(robot)
    number = begun(robot)
    press(robot)
    wait_until_driven(robot)
    robot.control("push", slot=INSERTION, counts=40)
    wait_for_proposal(robot, number, "aborted")
    assert "was moved" in proposal(robot, number)["detail"]


def test_an_engineer_may_measure_and_a_viewer_may_not(stack: StackFactory) -> None:
    robot = cleared(stack)
    close_case(robot)
    viewer = robot.client_of_new("vera", "viewer")
    assert viewer.post("/api/proposals", json=MEASURE).status_code == 403
    act(robot, "disable", YAW)
    refused = robot.api.post("/api/proposals", json=MEASURE)
    assert (refused.status_code, refused.json()["code"]) == (409, "DISABLED")
