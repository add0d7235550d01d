"""`interlock calibrate`: a table of measured poses to a robot's file, over the command line."""

import json
import random
import subprocess
from pathlib import Path
from typing import Any

import pytest
from bare_kernel import BIN, DEADLINE_S, ROOT
from test_kinematics_cli import NEURO_RANGES, kinematics
from test_run import DONE, PRECONDITION, REFUSED, USAGE

HIDDEN = ("--set", "driver_to_rcm_mm=73.1", "--set", "home_separation_mm=142.6")
UNITS = {"probe_rotation": "rad", "pitch": "rad", "yaw": "rad"}
NOISE_MM = 0.05


def calibrate(*arguments: str | Path, robot: str | Path = "neuro") -> tuple[int, dict[str, Any] | None, str]:
    """Exit code, answer and message of one run."""
    command = [str(part) for part in (BIN / "interlock", "calibrate", "--robot", robot, *arguments)]
    run = subprocess.run(command, capture_output=True, text=True, timeout=DEADLINE_S)
    return run.returncode, json.loads(run.stdout) if run.stdout else None, run.stderr


def random_joints(dice: random.Random) -> dict[str, float]:
    """Within the ranges of the axes, away from the ends of the linkage."""
    joints = {name: dice.uniform(low * 0.95, high * 0.95) for name, (low, high) in NEURO_RANGES.items()}
    joints["feet"] = dice.uniform(0.0, 4.0)
    joints["head"] = dice.uniform(-58.0, -3.0)
    return joints


@pytest.fixture
def table(tmp_path: Path) -> Path:
    """What a tracker sees of a NeuroRobot that differs from its file, in the zFrame."""
    dice = random.Random(1)
    drawn = [random_joints(dice) for _ in range(40)]
    code, answers, message = kinematics(
        "fk", "--robot", "neuro", *HIDDEN, lines=[{"joints": joints} for joints in drawn]
    )
    assert code == DONE, message
    names = list(drawn[0])
    rows = [
        ",".join([f"{name} [{UNITS.get(name, 'mm')}]" for name in names] + [f"tool_{c} [mm]" for c in "xyz"])
    ]
    for joints, answer in zip(drawn, answers, strict=True):
        point = [answer["pose"][place] + dice.gauss(0.0, NOISE_MM) for place in (3, 7, 11)]
        rows.append(",".join(repr(number) for number in [*joints.values(), *point]))
    file = tmp_path / "poses.csv"
    file.write_text("\n".join(rows) + "\n")
    return file


def test_hidden_lengths_are_found_and_the_file_that_comes_out_is_a_sound_robot(
    table: Path, tmp_path: Path
) -> None:
    written = tmp_path / "calibrated.toml"
    code, answer, message = calibrate(
        "--poses", table, "--in-zframe", "--sd-mm", str(NOISE_MM), "--write", written
    )
    assert (code, message) == (DONE, "")
    assert answer is not None
    fitted = {number["key"]: number for number in answer["fitted"]}
    for key, true, widest in (("driver_to_rcm_mm", 73.1, 0.05), ("home_separation_mm", 142.6, 1.0)):
        number = fitted[f"kinematics.{key}"]
        assert number["interval_95"] < widest
        assert abs(number["is"] - true) <= 2 * number["interval_95"]
    assert all(held["why"] for held in answer["held"])
    assert answer["residual_rms"]["is_mm"] < 3 * NOISE_MM < answer["residual_rms"]["was_mm"]
    assert answer["outliers"] == []
    assert ["feet" in gap for gap in answer["gaps"]] == [True], "the table leaves it where it is"

    was = (ROOT / "models/robots/neuro.toml").read_text().splitlines()
    now = written.read_text().splitlines()
    added = [line for line in now if line not in was]
    assert f"calibration_mm = {answer['calibration_mm']}" in added
    assert len(now) == len(was) + 1
    check = subprocess.run(
        [BIN / "interlock", "model", "check", written], capture_output=True, text=True, timeout=DEADLINE_S
    )
    assert check.returncode == DONE, check.stderr
    again = calibrate("--poses", table, "--in-zframe", "--sd-mm", str(NOISE_MM), robot=written)[1]
    assert again is not None
    assert again["residual_rms"]["was_mm"] == pytest.approx(answer["residual_rms"]["is_mm"], rel=0.1)


def test_with_a_wrong_pose_nothing_is_written_until_its_line_is_left_out(table: Path, tmp_path: Path) -> None:
    lines = table.read_text().splitlines()
    lines[7] = ",".join([*lines[7].split(",")[:-1], "99.0"])
    table.write_text("\n".join(lines))
    written = tmp_path / "calibrated.toml"
    code, answer, message = calibrate("--poses", table, "--in-zframe", "--write", written)
    assert code == REFUSED
    assert "line 8" in message
    assert not written.exists()
    assert answer is not None
    assert answer["outliers"] == [8]
    assert answer["worst"][0]["line"] == 8
    code = calibrate("--poses", table, "--in-zframe", "--leave-out", "8", "--write", written)[0]
    assert code == DONE
    assert written.exists()


@pytest.mark.parametrize(
    ("robot", "arguments", "code", "reason"),
    [
        ("neuro", ("--hold", "kinematics.length"), REFUSED, "is not fitted"),
        ("neuro", ("--leave-out", "77"), USAGE, "no pose stands in that line"),
        ("neuro", ("--sd-mm", "0"), USAGE, "--sd-mm"),
        ("neuro", ("--poses", "/nowhere.csv"), PRECONDITION, "a file with measured poses"),
        ("neuro", ("--in-zframe", "--write", "/proc/nowhere/a.toml"), PRECONDITION, "cannot be written"),
        ("prostate", (), REFUSED, "poses.csv:1: head [mm]: no such column"),
        ("absent", (), PRECONDITION, "absent"),
    ],
)
def test_what_cannot_be_calibrated_is_refused_with_its_reason(
    table: Path, robot: str, arguments: tuple[str, ...], code: int, reason: str
) -> None:
    given = arguments if "--poses" in arguments else ("--poses", table, *arguments)
    answer = calibrate(*given, robot=robot)
    assert answer[0] == code
    assert reason in answer[2]
