"""`interlock demo`: the thesis' targeting experiments on the simulated hardware, unattended."""

import csv
import json
import math
import subprocess
from pathlib import Path

import pytest
from bare_kernel import BIN
from test_run import DONE, USAGE

DEMO_DEADLINE_S = 120
MECHANICAL_ERROR_MM = 0.1
PRINTED = {  # desired and actual of the first trial, as the thesis prints them
    "neuro": ((-3.523, 61.989, 11.74), (-5.618, 61.989, 12.378)),
    "prostate": ((141.0, 0.0, 132.5), (141.113, 0.012, 133.221)),
}


def demo(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    command = [str(part) for part in (BIN / "interlock", "demo", *arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=DEMO_DEADLINE_S)


@pytest.mark.parametrize("robot", ["neuro", "prostate"])
def test_every_target_of_the_thesis_is_reached_within_a_tenth_of_a_millimetre(
    robot: str, tmp_path: Path
) -> None:
    table = tmp_path / "trials.csv"
    done = demo(robot, "--json", "--seed", "7", "--random-targets", "500", "--csv", table)
    assert done.returncode == DONE, done.stderr
    answer = json.loads(done.stdout)
    assert len(answer["trials"]) == 7
    for trial in answer["trials"]:
        assert trial["refused"] is None
        errors = [
            reached - desired
            for reached, desired in zip(trial["reached_mm"], trial["desired_mm"], strict=True)
        ]
        assert errors == pytest.approx(trial["error_mm"], abs=1e-9)
        assert all(abs(error) <= MECHANICAL_ERROR_MM for error in errors)
    desired, actual = PRINTED[robot]
    printed = [after - before for before, after in zip(desired, actual, strict=True)]
    assert answer["trials"][0]["thesis_error_mm"] == pytest.approx(printed)
    assert answer["random"]["tried"] == 500
    assert answer["random"]["worst_mm"] <= MECHANICAL_ERROR_MM
    with table.open() as file:
        assert len(list(csv.DictReader(file))) == 7


def test_a_scan_that_shows_the_target_missed_leads_there_once_more() -> None:
    trials = json.loads(demo("neuro", "--json", "--random-targets", "0", "--tolerance", "0.05").stdout)[
        "trials"
    ]
    again = [trial for trial in trials if trial["insertions"] > 1]
    assert again
    for trial in again:
        assert math.hypot(*trial["first_error_mm"]) > 0.05
        assert trial["insertions"] == 3 or math.hypot(*trial["error_mm"]) <= 0.05
    once = json.loads(demo("neuro", "--json", "--random-targets", "0", "--tolerance", "1").stdout)["trials"]
    assert {trial["insertions"] for trial in once} == {1}


@pytest.mark.parametrize("robot", ["neuro", "prostate"])
def test_injected_mechanical_errors_are_distributed_as_the_thesis_errors(robot: str) -> None:
    arguments = ("--json", "--random-targets", "0", "--rounds", "30", "--mechanical-error")
    answer = json.loads(demo(robot, *arguments, "--tolerance", "100").stdout)
    shown, printed = answer["distributions"]["first_scan"], answer["distributions"]["thesis"]
    assert shown == answer["distributions"]["last_scan"]
    assert (shown["insertions"], printed["insertions"]) == (210, 7)
    assert shown["mean_mm"] == pytest.approx(printed["mean_mm"], rel=0.25)
    without = json.loads(demo(robot, "--json", "--random-targets", "0").stdout)
    assert without["injected_error"] == {"mean_mm": [0, 0, 0], "deviation_mm": [0, 0, 0]}


def test_the_same_seed_gives_the_same_demonstration_and_another_one_another(tmp_path: Path) -> None:
    arguments = ("neuro", "--json", "--random-targets", "10", "--seed")
    first, again, other = (demo(*arguments, seed).stdout for seed in ("1", "1", "2"))
    assert first == again
    assert first != other


def test_what_cannot_be_shown_is_refused_by_name() -> None:
    unknown = demo("elbow")
    assert unknown.returncode != DONE
    assert "elbow" in unknown.stderr
    assert demo().returncode == USAGE
