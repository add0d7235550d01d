"""Frequency Sweep on real processes: within the band of the axis, and never beyond it."""

import subprocess
from pathlib import Path

import pytest
from bare_kernel import BIN, ROOT
from conftest import StackFactory
from motion import (
    approve,
    enable,
    motor,
    press,
    proposal,
    set_home,
    unlock,
    wait_for_proposal,
    wait_until,
)
from stack import Stack

ROTATION = 0
BAND = {"from_hz": 53000, "to_hz": 51000, "step_hz": 500, "dwell_s": 0.3}


def ready(stack: StackFactory, **options: float) -> Stack:
    robot = stack(robot="prostate", **options)
    unlock(robot)
    set_home(robot, ROTATION)
    enable(robot, ROTATION)
    return robot


def sweep(robot: Stack, **body: float) -> dict:
    answer = robot.api.post("/api/proposals", json={"kind": "sweep", "axis": "rotation", **body})
    return {"status": answer.status_code, **answer.json()}


def test_a_sweep_pauses_with_the_pedal_and_measures_each_frequency(stack: StackFactory) -> None:
    # Slowly enough for somebody to lift the foot while it lasts.
    robot = ready(stack, speed=4)
    made = sweep(robot, **{**BAND, "dwell_s": 3})
    assert made["status"] == 201, made
    approve(robot, made["id"])
    assert robot.status()["app_mode"] == "frequency_sweep"
    press(robot)
    wait_for_proposal(robot, made["id"], "executing")
    robot.control("pedal", pressed=False)
    wait_for_proposal(robot, made["id"], "paused")
    press(robot)
    wait_for_proposal(robot, made["id"], "done")
    speeds = [row["counts_per_s"] for row in proposal(robot, made["id"])["frequencies"]]
    assert len(speeds) == 5
    assert speeds == sorted(speeds)
    assert robot.status()["app_mode"] == "manual"
    wait_until("rest", lambda: motor(robot, ROTATION)["drive"] == 0)


def test_the_published_range_is_refused_and_nothing_turns(stack: StackFactory) -> None:
    robot = ready(stack)
    ends = {"from_hz": 0x48000000 / 22009, "to_hz": 0x40000000 / 22009}
    refused = sweep(robot, **ends, step_hz=1e6 / 22009, dwell_s=1)
    assert (refused["status"], refused["code"]) == (409, "DRIVE"), refused
    assert "50861.5 to 53076.9 Hz" in refused["expected"]
    press(robot)
    assert motor(robot, ROTATION)["drive"] == 0
    assert robot.status()["app_mode"] == "manual"


def test_the_mode_sweeps_the_whole_band_until_manual_ends_it(stack: StackFactory) -> None:
    robot = ready(stack)
    robot.api.put("/api/mode", json={"mode": "frequency_sweep"}).raise_for_status()
    approve(robot)
    assert robot.api.get("/api/mode").json()["mode"] == "frequency_sweep"
    press(robot)
    wait_until("drive", lambda: motor(robot, ROTATION)["drive"] > 0)
    robot.api.put("/api/mode", json={"mode": "manual"}).raise_for_status()
    wait_until("rest", lambda: motor(robot, ROTATION)["drive"] == 0)
    assert robot.api.get("/api/proposals").json()[0]["state"] == "aborted"


@pytest.mark.parametrize("field", ["from_hz", "dwell_s"])
def test_a_sweep_without_all_its_fields_is_none(stack: StackFactory, field: str) -> None:
    robot = ready(stack)
    answer = sweep(robot, **{name: value for name, value in BAND.items() if name != field})
    assert (answer["status"], answer["field"]) == (422, field)


def test_a_robot_without_a_high_frequency_card_lists_no_sweep(tmp_path: Path) -> None:
    listed = (
        (ROOT / "models/robots/neuro.toml")
        .read_text()
        .replace('"ablation"]', '"ablation", "frequency_sweep"]')
    )
    file = tmp_path / "neuro.toml"
    file.write_text(listed)
    checked = subprocess.run([BIN / "interlock", "model", "check", file], capture_output=True, text=True)
    assert checked.returncode == 1
    assert "no axis has a high-frequency card" in checked.stderr
