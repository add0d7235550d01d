"""Straight lines of the treatment point on real processes, judged by every tick of the black box."""

import tomllib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from bare_kernel import ROOT
from conftest import StackFactory
from interface import judge
from motion import approve, home_all, motor, press, register, unlock, wait_for_proposal
from stack import Stack
from test_kinematics_cli import neuro_pose
from test_robots_by_file import GANTRY, JOINTS, Start, gantry_pose, home_all_by_file, start

NEURO = ROOT / "models/robots/neuro.toml"
NEURO_START = {"yaw": -0.6, "pitch": 0.15, "insertion": 12.0, "lateral": -19.0, "head": -25.0, "feet": -5.0}
GANTRY_START = {"across": 30.0, "up": 30.0, "yaw": 0.1, "pitch": -0.15, "insertion": 0.5}
STATED_MM = 0.25
"""Largest distance from the line while an axis moves at 2 mm/s: docs/paths.md."""

Pose = Callable[[dict[str, float]], np.ndarray]

__all__ = ["start"]


def pose_of_neuro(joints: dict[str, float]) -> np.ndarray:
    return np.array(neuro_pose({"probe_rotation": 0.0, **joints})).reshape(4, 4)


def carry_out(robot: Stack, **body: object) -> dict:
    """Proposes, approves and presses until it is done; gives the proposal."""
    answer = judge(robot.api.post("/api/proposals", json=body))
    assert answer.status_code == 201, answer.text
    number = approve(robot, answer.json()["id"])
    press(robot)
    wait_for_proposal(robot, number, "done")
    return answer.json()


def positions(robot: Stack, file: Path) -> dict[str, float]:
    axes = tomllib.loads(file.read_text())["axis"]
    return {
        axis["name"]: motor(robot, axis["slot"])["position_counts"] / axis["counts_per_unit"] for axis in axes
    }


def way(robot: Stack, file: Path, pose: Pose, seconds: int) -> list[np.ndarray]:
    """The pose in every tick of the last seconds that the black box holds of all axes."""
    until = robot.status()["tick"]
    by_tick: dict[int, dict[str, float]] = {}
    axes = tomllib.loads(file.read_text())["axis"]
    for axis in axes:
        asked = {"slot": axis["slot"], "seconds": seconds, "until": until}
        taken = judge(robot.api.get("/api/capture", params=asked)).raise_for_status().json()
        for tick, counts in zip(taken["tick"], taken["position_counts"], strict=True):
            if counts is not None:
                by_tick.setdefault(tick, {})[axis["name"]] = counts / axis["counts_per_unit"]
    whole = [joints for joints in by_tick.values() if len(joints) == len(axes)]
    assert len(whole) > 500 * seconds
    return [pose(joints) for joints in whole]


def off_line(begin: np.ndarray, end: np.ndarray, pose: np.ndarray) -> float:
    along = (end - begin) / np.linalg.norm(end - begin)
    return float(np.linalg.norm(np.cross(along, pose[:3, 3] - begin)))


def off_axis(point: np.ndarray, pose: np.ndarray) -> float:
    return float(np.linalg.norm(np.cross(pose[:3, 2], point - pose[:3, 3])))


@pytest.fixture
def neuro(stack: StackFactory) -> Stack:
    """Aligned somewhere with its probe inserted, registered with the identity."""
    robot = stack()
    unlock(robot)
    home_all(robot)
    register(robot)
    carry_out(robot, kind="coordinated", targets=NEURO_START)
    return robot


def test_the_neuro_keeps_its_entry_on_a_line_across_and_its_axis_on_one_ahead(neuro: Stack) -> None:
    begin = pose_of_neuro(positions(neuro, NEURO))
    entry = begin[:3, 3] - (12.0 + 41.0 - 5.0) * begin[:3, 2]
    target = begin[:3, 3] + 5.0 * begin[:3, 0] - 3.0 * begin[:3, 1]
    made = carry_out(
        neuro, kind="line", target_point=target.tolist(), keep="entry", deviation_mm=0.02, speed_mm_s=2
    )
    assert made["line"]["planned_mm"] <= made["line"]["allowed_mm"] == 0.02
    assert made["line"]["length_mm"] == pytest.approx(34**0.5, abs=1e-6)
    assert made["aim"]["error_budget"] is not None
    poses = way(neuro, NEURO, pose_of_neuro, 6)
    assert np.linalg.norm(poses[0][:3, 3] - poses[-1][:3, 3]) > 3.0, "the line is not in the capture"
    assert np.linalg.norm(poses[-1][:3, 3] - target) < STATED_MM
    assert max(off_line(begin[:3, 3], target, pose) for pose in poses) < STATED_MM
    assert max(off_axis(entry, pose) for pose in poses) < STATED_MM

    begin = poses[-1]
    made = carry_out(neuro, kind="line", along_mm=6.0, speed_mm_s=2)
    assert made["axes"] == ["insertion"]
    assert made["aim"] is None
    poses = way(neuro, NEURO, pose_of_neuro, 4)
    ahead = begin[:3, 3] + 6.0 * begin[:3, 2]
    assert np.linalg.norm(poses[-1][:3, 3] - ahead) < STATED_MM
    assert max(off_line(begin[:3, 3], ahead, pose) for pose in poses) < STATED_MM


def test_a_line_that_cannot_be_is_refused_with_its_place_and_reason(neuro: Stack) -> None:
    begin = pose_of_neuro(positions(neuro, NEURO))
    beside = (begin[:3, 3] + 4.0 * begin[:3, 0]).tolist()
    for body, code, said in (
        ({"along_mm": 40.0}, "RANGE", "of the line's 40 mm: Probe insertion would be at"),
        ({"target_point": beside, "keep": "direction"}, "INSERTED", "across its axis"),
        ({"along_mm": 0.01}, "OUT_OF_RANGE", "0.01 mm long"),
    ):
        answer = judge(neuro.api.post("/api/proposals", json={"kind": "line", **body}))
        assert (answer.status_code, answer.json()["code"]) == (409, code), answer.text
        assert said in answer.json()["detail"]
    for body, field in (
        ({}, "along_mm"),
        ({"along_mm": 1, "target_point": beside, "keep": "entry"}, "along_mm"),
        ({"target_point": beside}, "keep"),
        ({"target_point": beside[:2], "keep": "entry"}, "target_point"),
        ({"along_mm": 1, "deviation_mm": 0}, "deviation_mm"),
    ):
        answer = neuro.api.post("/api/proposals", json={"kind": "line", **body})
        assert answer.status_code == 422, answer.text
        assert answer.json()["field"] == field


def test_a_line_is_none_from_where_the_robot_does_not_stand(neuro: Stack) -> None:
    waiting = neuro.api.post("/api/proposals", json={"kind": "line", "along_mm": 5.0}).json()["id"]
    carry_out(neuro, kind="line", along_mm=2.0)
    answer = neuro.api.post(f"/api/proposals/{waiting}/approve")
    assert answer.status_code == 409, answer.text
    assert answer.json()["code"] == "STALE"


def test_a_chain_of_joints_keeps_its_direction_and_then_an_entry_point(start: Start) -> None:
    gantry = start("gantry")
    home_all_by_file(gantry, range(len(JOINTS)))
    register(gantry)
    carry_out(gantry, kind="coordinated", targets=GANTRY_START)
    begin = gantry_pose(positions(gantry, GANTRY))
    across = begin[:3, 3] - 6.0 * begin[:3, 0] - 4.0 * begin[:3, 1]
    carry_out(gantry, kind="line", target_point=across.tolist(), keep="direction", speed_mm_s=2)
    poses = way(gantry, GANTRY, gantry_pose, 6)
    assert np.linalg.norm(poses[-1][:3, 3] - across) < STATED_MM
    assert max(off_line(begin[:3, 3], across, pose) for pose in poses) < STATED_MM
    assert max(100.0 * off_axis(pose[:3, 3] + begin[:3, 2], pose) for pose in poses) < 2 * STATED_MM

    begin = poses[-1]
    entry = begin[:3, 3] - 50.0 * begin[:3, 2]
    target = begin[:3, 3] - 5.0 * begin[:3, 0]
    line = {"kind": "line", "target_point": target.tolist(), "keep": "entry", "speed_mm_s": 2}
    assert gantry.api.post("/api/proposals", json=line).json()["code"] == "NO_TARGET"
    aim = {"entry_point": entry.tolist(), "target_point": (entry + 80.0 * begin[:3, 2]).tolist()}
    gantry.api.put("/api/targeting/target", json=aim).raise_for_status()
    carry_out(gantry, **line)
    poses = way(gantry, GANTRY, gantry_pose, 5)
    assert np.linalg.norm(poses[-1][:3, 3] - target) < STATED_MM
    assert max(off_line(begin[:3, 3], target, pose) for pose in poses) < STATED_MM
    assert max(off_axis(entry, pose) for pose in poses) < STATED_MM
