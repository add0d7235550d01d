"""Robots that no code knows: five axes whose kinematics their file describes, and one axis without any."""

import contextlib
import random
import tomllib
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import jsonschema
import numpy as np
import pytest
from bare_kernel import ROOT
from motion import (
    enable,
    motor,
    press,
    propose,
    propose_home,
    register,
    unlock,
    wait_for_proposal,
    wait_until,
)
from stack import Stack
from test_kinematics_cli import kinematics
from test_robot_files import SCHEMA
from test_run import DONE, REFUSED, interlock

FILES = ROOT / "tests/integration/robots"
GANTRY = FILES / "gantry.toml"
BENCH = FILES / "bench.toml"
JOINTS = ("across", "up", "yaw", "pitch", "insertion")
RANGES = dict(zip(JOINTS, [(0, 60), (0, 60), (-0.6, 0.6), (-0.6, 0.6), (0, 60)], strict=True))
TARGETS = {"across": 1500, "up": 1300, "yaw": 400, "pitch": -500, "insertion": 900}

Start = Callable[[str], Stack]


@pytest.fixture
def start(short_tmp_path: Path) -> Iterator[Start]:
    """Starts a robot of the tests by its file and its plant's."""
    with contextlib.ExitStack() as running:

        def begin(name: str) -> Stack:
            files = ("--robot", FILES / f"{name}.toml", "--plant", FILES / f"{name}.plant.toml")
            arguments = (*files, "--clock", "sim", "--sockets", short_tmp_path / "sockets")
            stack = running.enter_context(contextlib.closing(Stack(short_tmp_path, *arguments)))
            stack.connect_control()
            return stack

        yield begin


def moved(offset: tuple[float, float, float]) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, 3] = offset
    return matrix


def turned(axis: int, angle: float) -> np.ndarray:
    matrix = np.eye(4)
    one, other = (axis + 1) % 3, (axis + 2) % 3
    matrix[one, one] = matrix[other, other] = np.cos(angle)
    matrix[other, one] = np.sin(angle)
    matrix[one, other] = -np.sin(angle)
    return matrix


def gantry_pose(joints: dict[str, float]) -> np.ndarray:
    """Forward kinematics of the gantry as the drawing has it, by matrices alone."""
    return (
        moved((30 + joints["across"], 40 + joints["up"], 10))
        @ turned(1, joints["yaw"])
        @ moved((0, 0, 25))
        @ turned(0, joints["pitch"])
        @ moved((0, -15, joints["insertion"] + 100))
    )


def matrix(numbers: list[float]) -> np.ndarray:
    return np.array(numbers).reshape(4, 4)


def home_all_by_file(stack: Stack, slots: range) -> None:
    unlock(stack)
    for slot in slots:
        enable(stack, slot)
    number = propose_home(stack)
    press(stack)
    wait_for_proposal(stack, number, "done")
    assert all(motor(stack, slot)["homed"] for slot in slots)


@pytest.mark.parametrize("file", [GANTRY, BENCH], ids=lambda path: path.stem)
def test_robot_by_file_satisfies_schema_and_check(file: Path) -> None:
    jsonschema.validate(tomllib.loads(file.read_text()), SCHEMA, cls=jsonschema.Draft202012Validator)
    checked = interlock("model", "check", file)
    assert checked.returncode == DONE, checked.stderr
    family = "serial_chain" if file == GANTRY else "none"
    assert f"kinematics {family}," in checked.stdout


def test_five_axes_described_by_a_file_home_and_move_to_the_pose_of_forward_kinematics(start: Start) -> None:
    gantry = start("gantry")
    home_all_by_file(gantry, range(len(JOINTS)))
    for slot, counts in enumerate(TARGETS.values()):
        wait_for_proposal(gantry, propose(gantry, counts, slot), "done")
        assert motor(gantry, slot)["position_counts"] == pytest.approx(counts, abs=3)
    register(gantry)
    described = {axis["name"]: axis for axis in tomllib.loads(GANTRY.read_text())["axis"]}

    def pose_is_that_of_the_counts() -> bool:
        view = gantry.api.get("/api/targeting/alignment").raise_for_status().json()
        counts = {name: motor(gantry, slot)["position_counts"] for slot, name in enumerate(JOINTS)}
        joints = {name: counts[name] / described[name]["counts_per_unit"] for name in JOINTS}
        return view["current"] is not None and np.allclose(
            matrix(view["current"]), gantry_pose(joints), rtol=0, atol=1e-6
        )

    wait_until("the pose of these counts", pose_is_that_of_the_counts)
    body = gantry.api.get("/api/targeting/alignment").json()["current_body"]
    assert body[-1]["name"] == "probe"


def test_motion_goes_on_while_several_people_ask_for_a_pose_that_takes_long_to_refuse(start: Start) -> None:
    gantry = start("gantry")
    home_all_by_file(gantry, range(len(JOINTS)))
    register(gantry)
    beyond = {"entry_point": [30, 100, -100], "target_point": [150, -10, -30]}
    gantry.api.put("/api/targeting/target", json=beyond).raise_for_status()

    def ask() -> set[str]:
        answers = (gantry.api.get("/api/targeting/alignment").json() for _ in range(10))
        return {answer["alignment_problem"]["code"] for answer in answers}

    with ThreadPoolExecutor() as pool:
        asking = [pool.submit(ask) for _ in range(6)]
        moves = 0
        while moves == 0 or not all(each.done() for each in asking):
            wait_for_proposal(gantry, propose(gantry, 1000 + 200 * (moves % 2), 0), "done")
            moves += 1
    assert all(each.result() <= {"OUT_OF_REACH", "NOT_CONVERGED"} for each in asking)


def test_one_axis_without_kinematics_homes_and_moves_and_has_no_pose(start: Start) -> None:
    bench = start("bench")
    home_all_by_file(bench, range(1))
    wait_for_proposal(bench, propose(bench, 1200, 0), "done")
    assert motor(bench, 0)["position_counts"] == pytest.approx(1200, abs=3)
    view = bench.api.get("/api/targeting/alignment").raise_for_status().json()
    assert view["current"] is None
    assert view["current_problem"]["code"] == "NO_KINEMATICS"
    reach = bench.api.get("/api/targeting/reach").raise_for_status().json()
    assert reach["problem"]["code"] == "NO_KINEMATICS"
    [robot] = bench.api.get("/api/robots").raise_for_status().json()
    assert robot["kinematics"] == "none"
    code, answers, message = kinematics("fk", "--robot", BENCH, lines=[{}])
    assert (code, answers) == (REFUSED, [])
    assert "The robot has no kinematics" in message


def test_chain_of_a_file_agrees_with_matrices_forwards_and_leads_back() -> None:
    generator = random.Random(1)
    joints = [{name: generator.uniform(*ends) for name, ends in RANGES.items()} for _ in range(200)]
    code, answers, _ = kinematics("fk", "--robot", GANTRY, lines=[{"joints": one} for one in joints])
    assert code == DONE
    poses = [gantry_pose(one) for one in joints]
    for answer, pose in zip(answers, poses, strict=True):
        assert np.allclose(matrix(answer["pose"]), pose, rtol=0, atol=1e-9)

    paths = [{"entry": list(pose[:3, 3] - 40 * pose[:3, 2]), "target": list(pose[:3, 3])} for pose in poses]
    code, answers, _ = kinematics("ik", "--robot", GANTRY, lines=paths)
    assert code == DONE
    for answer, one in zip(answers, joints, strict=True):
        # Yaw, pitch and insertion follow from the direction, so there is one solution.
        assert answer["joints"] == pytest.approx(one, abs=1e-5)


def test_path_that_the_chain_cannot_follow_is_refused_with_its_reason() -> None:
    lines = [
        ({"entry": [60, 60, 100], "target": [60, 60, 300]}, "OUT_OF_REACH"),
        ({"entry": [60, 60, 100], "target": [60, 60, 5000]}, "OUT_OF_REACH"),
        ({"entry": [60, 60, 150], "target": [60, 60, 150]}, "DEGENERATE"),
        ({"entry": [60, 60, 100], "target": [60, 60, 150], "rotation": 1}, "OUT_OF_RANGE"),
    ]
    code, answers, _ = kinematics("ik", "--robot", GANTRY, lines=[line for line, _ in lines])
    assert code == REFUSED
    assert [answer["error"]["code"] for answer in answers] == [expected for _, expected in lines]
    assert answers[0]["error"]["quantity"] == "insertion_mm"
    assert answers[0]["error"]["highest"] == 60
