"""`interlock kinematics`: JSON lines in, JSON lines out, checked against equations written down anew."""

import json
import math
import random
import re
import subprocess
from pathlib import Path
from typing import Any

import pytest
from bare_kernel import BIN, DEADLINE_S, ROOT
from test_run import DONE, REFUSED, USAGE

LINES = 1000
EXACT = 1e-9
Matrix = list[list[float]]

NEURO_RANGES = {
    "head": (-60.0, 0.0),
    "feet": (0.0, 5.0),
    "lateral": (-49.47, 0.0),
    "insertion": (0.0, 34.9),
    "probe_rotation": (-3.14, 3.14),
    "pitch": (-0.465, 0.648),
    "yaw": (-1.536, 0.010),
}
THESIS_PROSTATE = (
    "--set",
    "needle_tip_mm=259.075",
    "front_pivot_offset_mm=0",
    "max_angulation_rad=0",
    "base_to_zframe_mm=0,0,0",
)


def kinematics(*arguments: str | Path, lines: list[Any]) -> tuple[int, list[dict[str, Any]], str]:
    """Exit code, answers and message of one run; a line that is text goes in as it is."""
    text = "".join((line if isinstance(line, str) else json.dumps(line)) + "\n" for line in lines)
    command = [str(part) for part in (BIN / "interlock", "kinematics", *arguments)]
    run = subprocess.run(command, input=text, capture_output=True, text=True, timeout=DEADLINE_S)
    return run.returncode, [json.loads(line) for line in run.stdout.splitlines()], run.stderr


def product(left: Matrix, right: Matrix) -> Matrix:
    return [
        [sum(a * b for a, b in zip(row, column, strict=True)) for column in zip(*right, strict=True)]
        for row in left
    ]


def neuro_pose(joints: dict[str, float]) -> list[float]:
    """Forward kinematics of the NeuroRobot with the thesis' calibration, by plain arithmetic."""
    rise = [
        math.sqrt(60.0**2 - ((s - 30.0) / 2) ** 2) for s in (143.0 + joints["head"] - joints["feet"], 143.0)
    ]
    rcm = (
        18.32 + joints["lateral"],
        178.39 + rise[0] - rise[1],
        72.91 + (joints["head"] + joints["feet"]) / 2,
    )
    (cx, sx), (cy, sy), (cz, sz) = (
        (math.cos(joints[name]), math.sin(joints[name])) for name in ("yaw", "pitch", "probe_rotation")
    )
    rotation: Matrix = [[-1, 0, 0], [0, 0, -1], [0, -1, 0]]
    for turn in (
        [[1, 0, 0], [0, cx, -sx], [0, sx, cx]],
        [[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]],
        [[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]],
    ):
        rotation = product(rotation, turn)
    offset = joints["insertion"] + 41.0 - 72.5
    rows = [[*row, centre + row[2] * offset] for row, centre in zip(rotation, rcm, strict=True)]
    return [number for row in [*rows, [0, 0, 0, 1]] for number in row]


def assert_near(actual: list[float], expected: list[float]) -> None:
    assert len(actual) == len(expected)
    assert max(abs(a - b) for a, b in zip(actual, expected, strict=True)) <= EXACT


def test_forward_agrees_with_another_implementation_and_inverse_leads_back() -> None:
    generator = random.Random(1)
    lines = [
        {"joints": {name: generator.uniform(*ends) for name, ends in NEURO_RANGES.items()}}
        for _ in range(LINES)
    ]
    code, answers, _ = kinematics("fk", "--robot", "neuro", lines=lines)
    assert code == DONE
    assert len(answers) == LINES
    for line, answer in zip(lines, answers, strict=True):
        assert_near(answer["pose"], neuro_pose(line["joints"]))
        assert answer["joints"] == line["joints"]

    def entry(answer: dict[str, Any]) -> list[float]:
        """Where the probe goes in: the insertion, D less B behind the treatment point."""
        pose, depth = answer["pose"], answer["joints"]["insertion"] + 41.0 - 5.0
        return [pose[row + 3] - depth * pose[row + 2] for row in (0, 4, 8)]

    wanted = [{"pose": answer["pose"], "entry": entry(answer)} for answer in answers]
    code, found, _ = kinematics("ik", "--robot", "neuro", lines=wanted)
    assert code == DONE
    for answer, back in zip(answers, found, strict=True):
        assert_near(
            [back["joints"][name] for name in NEURO_RANGES], [answer["joints"][name] for name in NEURO_RANGES]
        )


def test_neuro_reaches_entry_and_target() -> None:
    code, [answer], _ = kinematics(
        "ik", "--robot", "neuro", lines=[{"entry": [8, 250, 70], "target": [5, 200, 60]}]
    )
    assert code == DONE
    assert answer["joints"]["head"] == pytest.approx(-18.420966, abs=1e-6)
    assert_near([answer["pose"][index] for index in (3, 7, 11)], [5, 200, 60])


def test_prostate_of_the_thesis_is_a_matter_of_settings() -> None:
    code, [answer], _ = kinematics(
        "ik",
        "--robot",
        "prostate",
        *THESIS_PROSTATE,
        lines=[{"entry": [5, 150, 200], "target": [5, 150, 300]}],
    )
    assert code == DONE
    expected = {"front_left": 149.008578, "front_right": -139.008578, "insertion": 40.925, "rotation": 0}
    assert {name: answer["joints"][name] for name in expected} == pytest.approx(expected, abs=1e-6)


def test_prostate_pose_leads_to_joints_and_back() -> None:
    joints = {
        "front_left": 140,
        "front_right": -120,
        "back_left": 150,
        "back_right": -130,
        "insertion": 80,
        "rotation": 0.5,
    }
    code, [reached], _ = kinematics("fk", "--robot", "prostate", lines=[{"joints": joints}])
    assert code == DONE
    code, [back], _ = kinematics("ik", "--robot", "prostate", lines=[{"pose": reached["pose"]}])
    assert code == DONE
    assert back["joints"] == pytest.approx(joints, abs=EXACT)


QUARTER_TURN = [0, -1, 0, 10.5, 1, 0, 0, -20, 0, 0, 1, 30, 0, 0, 0, 1]


def through(matrix: list[float], point: list[float]) -> list[float]:
    rows = [matrix[start : start + 4] for start in (0, 4, 8)]
    return [sum(a * b for a, b in zip(row, [*point, 1], strict=True)) for row in rows]


def test_a_target_in_the_scanner_becomes_setpoints_whatever_the_registration() -> None:
    aim = {"entry": [8, 250, 70], "target": [5, 200, 60]}
    registered = {name: through(QUARTER_TURN, point) for name, point in aim.items()}
    lines = [aim, {**registered, "registration": QUARTER_TURN}]
    code, [here, there], _ = kinematics("align", "--robot", "neuro", lines=lines)
    assert code == DONE
    assert here["setpoints"] == there["setpoints"]
    assert here["setpoints"]["head"]["position"] == pytest.approx(-18.420966, abs=0.51 / 78.74)
    assert here["clamped"] == there["clamped"] == []
    assert_near([there["desired"][index] for index in (3, 7, 11)], registered["target"])
    tip = [there["reachable"][index] for index in (3, 7, 11)]
    offset = [a - b for a, b in zip(tip, registered["target"], strict=True)]
    assert_near(there["deviation"]["offset_mm"], offset)
    assert there["deviation"]["distance_mm"] == pytest.approx(math.hypot(*offset))
    assert 0 < there["deviation"]["distance_mm"] < 0.1

    half_axes = [each["error_budget"]["treatment"]["half_axes_mm"] for each in (here, there)]
    assert half_axes[0] == pytest.approx(half_axes[1])
    assert half_axes[0][2] > 0

    joints = {name: each["position"] for name, each in here["setpoints"].items()}
    code, [reached], _ = kinematics("fk", "--robot", "neuro", lines=[{"joints": joints}])
    assert code == DONE
    assert_near(reached["pose"], here["reachable"])


def test_a_target_beyond_an_axis_names_it_and_how_far_the_robot_falls_short() -> None:
    code, [answer], _ = kinematics(
        "align", "--robot", "neuro", lines=[{"entry": [8, 250, 70], "target": [5, 160, 50]}]
    )
    assert code == DONE
    assert answer["clamped"] == ["insertion"]
    assert answer["deviation"]["distance_mm"] > 20


def test_an_alignment_that_cannot_be_is_refused_with_its_reason() -> None:
    good = {"entry": [8, 250, 70], "target": [5, 200, 60]}
    bad = [
        ({**good, "registration": [2, *QUARTER_TURN[1:]]}, "NOT_RIGID"),
        ({**good, "registration": QUARTER_TURN[:15]}, "BAD_FIELD"),
        ({**good, "ignore_registration_rotation": 1}, "BAD_FIELD"),
        ({"entry": [8, 250, 70]}, "BAD_FIELD"),
        ({**good, "probe_rotation": 1}, "BAD_FIELD"),
        ({**good, "target": [8, 250, 70]}, "DEGENERATE"),
        ({"entry": [8, 350, 70], "target": [5, 300, 60]}, "OUT_OF_REACH"),
    ]
    code, answers, _ = kinematics("align", "--robot", "neuro", lines=[line for line, _ in bad])
    assert code == REFUSED
    assert [answer["error"]["code"] for answer in answers] == [expected for _, expected in bad]


def test_bad_lines_are_answered_in_their_place_and_the_rest_goes_on() -> None:
    good = {"entry": [8, 250, 70], "target": [5, 200, 60]}
    bad = {
        2: ("no JSON", "BAD_JSON"),
        3: ("", "BAD_JSON"),
        4: ([1, 2], "BAD_JSON"),
        5: ('{"entry": [8, 1e999, 70], "target": [5, 200, 60]}', "BAD_JSON"),
        6: ({"entry": [8, 250], "target": [5, 200, 60]}, "BAD_FIELD"),
        7: ({"entry": [8, 250, "70"], "target": [5, 200, 60]}, "BAD_FIELD"),
        8: ({**good, "insertion": 3}, "BAD_FIELD"),
        9: ({"target": [5, 200, 60]}, "BAD_FIELD"),
        10: ({"entry": [8, 250, 70], "target": [8, 250, 70]}, "DEGENERATE"),
        11: ({"entry": [8, 350, 70], "target": [5, 300, 60]}, "OUT_OF_REACH"),
        12: ({"entry": [8, 250, 70], "pose": [0] * 16}, "NOT_RIGID"),
    }
    lines = [good, *(line for line, _ in bad.values()), good]
    code, answers, message = kinematics("ik", "--robot", "neuro", lines=lines)
    assert code == REFUSED
    assert "11 of 13 lines have no answer, the first is line 2" in message
    assert len(answers) == len(lines)
    assert "joints" in answers[0]
    assert answers[-1] == answers[0]
    for number, (_, expected) in bad.items():
        answer = answers[number - 1]
        assert answer["line"] == number
        assert answer["error"]["code"] == expected
        assert answer["error"]["text"]


def test_domain_error_names_quantity_value_and_allowed_range() -> None:
    joints = dict.fromkeys(NEURO_RANGES, 0) | {"head": 8}
    code, [answer], _ = kinematics("fk", "--robot", "neuro", lines=[{"joints": joints}])
    assert code == REFUSED
    error = answer["error"]
    assert (error["code"], error["quantity"], error["value"]) == ("SEPARATION", "separation_mm", 151)
    assert (error["lowest"], error["highest"]) == (75, 146)


@pytest.mark.parametrize(
    ("joints", "named"),
    [({}, "joints.yaw"), (dict.fromkeys(NEURO_RANGES, 0) | {"elbow": 1}, "elbow"), (None, "joints")],
)
def test_joints_that_are_not_those_of_the_robot_are_refused(
    joints: dict[str, int] | None, named: str
) -> None:
    code, [answer], _ = kinematics("fk", "--robot", "neuro", lines=[{"joints": joints}])
    assert code == REFUSED
    assert answer["error"]["text"].startswith(named + ":")


def test_setting_replaces_a_point_of_the_robot_file() -> None:
    lines = [{"joints": dict.fromkeys(NEURO_RANGES, 0)}]
    code, [answer], _ = kinematics(
        "fk",
        "--robot",
        ROOT / "models/robots/neuro.toml",
        "--set",
        "home_rcm_mm=-32.41,154.38,84.198",
        lines=lines,
    )
    assert code == DONE
    assert_near([answer["pose"][index] for index in (3, 7, 11)], [-32.41, 154.38 + 31.5, 84.198])


@pytest.mark.parametrize(
    "setting", ["side_link_mm", "side_link_mm=", "=1", "home_rcm_mm=1,x,3", "home_rcm_mm=1,"]
)
def test_setting_that_is_not_understood_is_a_usage_error(setting: str) -> None:
    code, answers, message = kinematics("fk", "--robot", "neuro", "--set", setting, lines=[])
    assert (code, answers) == (USAGE, [])
    assert setting in message


@pytest.mark.parametrize(
    "setting",
    [
        "elbow=1",
        "side_link_mm=1,2",
        "home_rcm_mm=1,2",
        "side_link_mm=nan",
        "home_separation_mm=200",
        "min_separation_mm=1",
        "min_separation_mm=30",
    ],
)
def test_setting_is_refused_like_a_robot_file_that_says_so(setting: str) -> None:
    code, answers, message = kinematics("fk", "--robot", "neuro", "--set", setting, lines=["{}"])
    assert (code, answers) == (REFUSED, [])
    assert f"kinematics.{setting.split('=')[0]}: " in message
    assert "expected" in message


def test_no_lines_need_no_answer() -> None:
    assert kinematics("ik", "--robot", "prostate", lines=[]) == (DONE, [], "")


def test_the_page_for_a_new_robot_says_what_its_own_file_gives() -> None:
    page = (ROOT / "docs/integration.md").read_text("utf-8")
    joints = json.loads(re.search(r"echo '(.*)' ", page)[1])
    said = [float(number) for number in re.search(r"the tip is at \(([-., 0-9]+)\) mm", page)[1].split(",")]
    code, [answer], _ = kinematics("fk", "--robot", ROOT / "models/robots/desk.toml", lines=[joints])
    assert code == DONE
    assert [round(answer["pose"][row], 2) for row in (3, 7, 11)] == said
    checked = [str(BIN / "interlock"), "model", "check", str(ROOT / "models/robots/desk.toml")]
    shown = subprocess.run(checked, capture_output=True, text=True, timeout=DEADLINE_S).stdout
    printed = re.search(r"```\n(desk: .*?)\.\.\.\n```", page, re.DOTALL)[1]
    assert shown.startswith(printed)
