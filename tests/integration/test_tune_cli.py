"""`interlock tune` and `identify`: an axis on the simulated hardware, as figures, plots and robot files."""

import csv
import json
import subprocess
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import pytest
from bare_kernel import BIN, DEADLINE_S, ROOT
from test_run import DONE, PRECONDITION, REFUSED, USAGE

THESIS_MOVE = ("--axis", "yaw", "--move", "-600", "--cruise", "833")


def tune(
    *arguments: str | Path, robot: str | Path = "neuro", word: str = "tune"
) -> tuple[int, dict[str, Any] | None, str]:
    """Exit code, answer and message of one run."""
    command = [str(part) for part in (BIN / "interlock", word, "--robot", robot, *arguments)]
    run = subprocess.run(command, capture_output=True, text=True, timeout=DEADLINE_S)
    return run.returncode, json.loads(run.stdout) if run.stdout else None, run.stderr


def test_the_move_of_the_thesis_is_told_in_figures_that_its_table_confirms(tmp_path: Path) -> None:
    table = tmp_path / "step.csv"
    code, answer, message = tune(*THESIS_MOVE, "--csv", table)
    assert (code, message) == (DONE, "")
    assert answer is not None
    assert (answer["robot"], answer["axis"]) == ("neuro", "yaw")
    assert answer["target_counts"] - answer["from_counts"] == -600
    assert answer["rms_velocity_error_percent"] <= 5.0
    assert abs(answer["final_error_counts"]) <= 1
    assert answer["settle_ms"] is not None

    with table.open() as file:
        rows = [{name: float(value or "nan") for name, value in row.items()} for row in csv.DictReader(file)]
    profile = [row for row in rows if row["time_s"] <= answer["duration_s"]]
    squares = [(row["velocity_counts_per_s"] - row["setpoint_velocity_counts_per_s"]) ** 2 for row in profile]
    rms_percent = (sum(squares) / len(squares)) ** 0.5 / answer["peak_counts_per_s"] * 100
    assert rms_percent == pytest.approx(answer["rms_velocity_error_percent"], rel=1e-3)
    assert rows[-1]["position_counts"] == answer["target_counts"] + answer["final_error_counts"]
    assert rows[0]["setpoint_counts"] == answer["from_counts"]
    assert max(row["drive"] for row in rows) <= 0xEFFF
    assert rows[-1]["drive"] == 0


def test_the_plot_is_a_drawing_of_position_velocity_and_output(tmp_path: Path) -> None:
    plot = tmp_path / "step.svg"
    assert tune("--axis", "rotation", "--svg", plot, robot="prostate")[0] == DONE
    drawing = ElementTree.parse(plot).getroot()
    space = {"svg": "http://www.w3.org/2000/svg"}
    assert len(drawing.findall(".//svg:rect[@stroke]", space)) == 3
    assert len(drawing.findall(".//svg:polyline", space)) == 6
    labels = {label.text for label in drawing.iterfind(".//svg:text", space)}
    assert {"position [counts]", "velocity [counts/s]", "control output [drive]", "time [s]"} <= labels
    assert any("Needle rotation" in (label or "") for label in labels)


def test_gains_make_a_difference_and_the_same_command_gives_the_same_answer() -> None:
    open_loop = (
        "--position-gain",
        "0",
        "--velocity-gain",
        "0",
        "--integral-gain",
        "0",
        "--full-speed",
        "1300",
    )
    first = tune(*THESIS_MOVE, *open_loop)[1]
    assert first == tune(*THESIS_MOVE, *open_loop)[1]
    regulated = tune(*THESIS_MOVE, "--full-speed", "1300")[1]
    assert first is not None
    assert regulated is not None
    assert regulated["rms_velocity_error_percent"] < first["rms_velocity_error_percent"] / 2


@pytest.mark.parametrize(
    ("arguments", "code", "reason"),
    [
        (("--axis", "elbow"), REFUSED, 'no axis "elbow"'),
        (("--axis", "yaw", "--move", "600"), REFUSED, "yaw reaches -1210 to -7"),
        (("--axis", "yaw", "--position-gain", "-1"), REFUSED, "position gain is out of range"),
        (("--axis", "yaw", "--cruise", "nan"), REFUSED, "cruise_velocity"),
        (("--axis", "yaw", "--move", "far"), USAGE, "--move"),
        (("--axis", "yaw", "--csv", "/proc/nowhere/step.csv"), PRECONDITION, "cannot be written"),
    ],
)
def test_what_cannot_be_run_is_refused_with_its_reason(
    arguments: tuple[str, ...], code: int, reason: str
) -> None:
    answer = tune(*arguments)
    assert answer[:2] == (code, None)
    assert reason in answer[2]


def hidden_motors(tmp_path: Path) -> Path:
    """Simulated hardware of which the robot's file knows nothing."""
    plant = (ROOT / "models/plant/neuro.toml").read_text()
    for was, now in (("dead_zone_fraction = 0.015", "dead_zone_fraction = 0.12"), ("= 1000", "= 700")):
        assert was in plant
        plant = plant.replace(was, now)
    file = tmp_path / "hidden.toml"
    file.write_text(plant)
    return file


def test_an_axis_that_did_not_home_is_measured_and_homes_with_the_file_that_comes_out(tmp_path: Path) -> None:
    measured, tuned = tmp_path / "measured.toml", tmp_path / "tuned.toml"
    arguments = ("--axis", "yaw", "--plant", hidden_motors(tmp_path))
    code, answer, message = tune(*arguments, "--write", measured, word="identify")
    assert (code, message) == (DONE, "")
    assert answer is not None
    assert answer["homing_error"] == "the axis faulted: STALL"
    assert answer["full_speed_counts_per_s"] == pytest.approx(700, rel=0.005)
    assert answer["dead_zone_drive"] == pytest.approx(0.12 * 0xEFFF, abs=0.003 * 0xEFFF)

    was = (ROOT / "models/robots/neuro.toml").read_text().splitlines()
    now = measured.read_text().splitlines()
    assert len(now) == len(was)
    different = [new for old, new in zip(was, now, strict=True) if old != new]
    assert any(f"dead_zone = {answer['changes'][1]['is']:.0f}" in line for line in different)
    assert len(different) <= len(answer["changes"])

    code, answer, message = tune(*arguments, "--write", tuned, robot=measured)
    assert (code, message) == (DONE, "")
    assert answer is not None
    assert answer["worst_step_percent"]["is"] <= answer["worst_step_percent"]["was"]
    code, answer, _ = tune(*arguments, robot=tuned, word="identify")
    assert code == DONE
    assert answer is not None
    assert answer["homing_error"] is None


def test_a_file_that_the_kernel_would_refuse_is_not_written(tmp_path: Path) -> None:
    plant = hidden_motors(tmp_path)
    plant.write_text(plant.read_text().replace("dead_zone_fraction = 0.12", "dead_zone_fraction = 0.3"))
    measured = tmp_path / "measured.toml"
    code, _, message = tune("--axis", "feet", "--plant", plant, "--write", measured, word="identify")
    assert code == REFUSED
    assert "drive.dead_zone" in message
    assert "at most a fifth of drive.max" in message
    assert not measured.exists()


@pytest.mark.parametrize("options", [("--svg", "R"), ("--write", "P"), ("--svg", "W", "--write", "W")])
def test_no_file_that_is_read_is_overwritten_by_another(tmp_path: Path, options: tuple[str, ...]) -> None:
    files = {"R": tmp_path / "robot.toml", "P": hidden_motors(tmp_path), "W": tmp_path / "out"}
    files["R"].write_text((ROOT / "models/robots/neuro.toml").read_text())
    was = files["R"].read_bytes(), files["P"].read_bytes()
    arguments = [files.get(option, option) for option in options]
    code, _, message = tune(
        "--axis", "feet", "--plant", files["P"], *arguments, robot=files["R"], word="identify"
    )
    assert code == USAGE
    assert "would be overwritten" in message
    assert (files["R"].read_bytes(), files["P"].read_bytes()) == was
    assert not files["W"].exists()
