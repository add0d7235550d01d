"""`interlock trajectory check`: a file in, one JSON object out."""

import json
import re
import subprocess
from pathlib import Path
from typing import Any

import pytest
from bad_trajectories import BAD_TRAJECTORIES
from bare_kernel import BIN, DEADLINE_S
from test_run import DONE, PRECONDITION, REFUSED

GOOD = "time [s],yaw [rad],insertion [mm],insertion [mm/s]\n0,-0.5,10,0\n2,-0.7,14,0\n"
ZIGZAG = "time [s],yaw [rad]\n" + "".join(f"{n / 10},{-0.7 - 0.05 * (n % 2)}\n" for n in range(10))


def check(*arguments: str | Path, robot: str = "neuro") -> tuple[int, dict[str, Any] | None, str]:
    """Exit code, answer and message of one run."""
    command = [str(part) for part in (BIN / "interlock", "trajectory", "check", "--robot", robot, *arguments)]
    run = subprocess.run(command, capture_output=True, text=True, timeout=DEADLINE_S)
    return run.returncode, json.loads(run.stdout) if run.stdout else None, run.stderr


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "trajectory.csv"
    path.write_text(GOOD)
    return path


def test_a_good_trajectory_is_shown_with_its_reach_and_rates(file: Path) -> None:
    code, answer, message = check(file)
    assert (code, message) == (DONE, "")
    assert answer is not None
    assert (answer["rows"], answer["duration_s"]) == (2, 2.0)
    assert answer["axes"]["yaw"] == {
        "unit": "rad",
        "lowest": -0.7,
        "highest": -0.5,
        "top_speed": pytest.approx(0.1),
        "top_acceleration": pytest.approx(0.0, abs=1e-9),
        "top_jerk": pytest.approx(0.0, abs=1e-9),
    }
    assert answer["slowed_by"] == 1.0
    assert answer["axes"]["insertion"]["top_speed"] == pytest.approx(3.75)


def test_a_bad_row_is_refused_by_line_and_column(file: Path) -> None:
    file.write_text(GOOD + "3,-0.7,nan,0\n")
    code, answer, message = check(file)
    assert code == REFUSED
    assert answer is not None
    error = answer["error"]
    assert (error["code"], error["line"], error["column"]) == ("NOT_FINITE", 4, "insertion [mm]")
    assert error["text"] in message


def test_an_axis_of_another_robot_is_refused(file: Path) -> None:
    code, answer, _ = check(file, robot="prostate")
    assert code == REFUSED
    assert answer is not None
    assert (answer["error"]["code"], answer["error"]["column"]) == ("UNKNOWN_AXIS", "yaw [rad]")


def test_a_trajectory_that_is_too_fast_is_refused_or_slowed_down_as_its_author_chooses(file: Path) -> None:
    file.write_text(ZIGZAG)
    code, answer, message = check(file)
    assert code == REFUSED
    assert answer is not None
    assert (answer["error"]["code"], answer["error"]["column"]) == ("TOO_MUCH_ACCELERATION", "yaw [rad]")
    asked = re.search(r"slowed down to fit, it would take ([0-9.]+) times as long", message)
    assert asked is not None, message
    code, answer, _ = check("--slow-to-fit", file)
    assert code == DONE
    assert answer is not None
    assert answer["slowed_by"] == pytest.approx(float(asked[1]), abs=0.01)
    assert answer["duration_s"] == pytest.approx(0.9 * answer["slowed_by"])


@pytest.mark.parametrize("name", BAD_TRAJECTORIES)
def test_a_bad_file_is_refused_with_row_column_and_reason(file: Path, name: str) -> None:
    bad = BAD_TRAJECTORIES[name]
    file.write_text(bad.text)
    code, answer, message = check(file)
    assert code == REFUSED
    assert answer is not None
    error = answer["error"]
    assert (error["code"], error["line"], error["column"]) == (bad.code, bad.line, bad.column)
    assert error["text"].startswith(bad.place)
    assert error["text"] in message


def test_a_file_that_is_not_there_stands_in_the_way(tmp_path: Path) -> None:
    for path in (tmp_path / "none.csv", tmp_path):
        code, answer, message = check(path)
        assert (code, answer) == (PRECONDITION, None)
        assert "cannot be read" in message
