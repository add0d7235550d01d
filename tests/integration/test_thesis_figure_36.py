"""The sixteen tests of the thesis' figure 36 by their own names, on real processes (docs/thesis-tests.md)."""

import json
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest
from bare_kernel import BIN
from motion import enable, motor, press, propose, set_home, unlock, wait_until
from stack import Stack

# An axis of each robot that is homed where it stands, and a setpoint for it.
JOGGED = {"neuro": "probe_rotation", "prostate": "rotation"}
SETPOINT_COUNTS = 400
AXES = {
    "neuro": ["yaw", "probe_rotation", "pitch", "insertion", "lateral", "head", "feet"],
    "prostate": ["rotation", "insertion", "back_left", "front_left", "back_right", "front_right"],
}


def start(robot: str, directory: Path) -> Stack:
    started = Stack(directory, "--robot", robot, "--speed", "20", "--sockets", directory / "sockets")
    started.connect_control()
    return started


def running(robot: str) -> Iterator[Stack]:
    with tempfile.TemporaryDirectory(prefix="interlock-test-") as directory:
        started = start(robot, Path(directory))
        try:
            yield started
        finally:
            started.close()


@pytest.fixture(scope="module")
def neuro() -> Iterator[Stack]:
    yield from running("neuro")


@pytest.fixture(scope="module")
def prostate() -> Iterator[Stack]:
    yield from running("prostate")


def slot_of(robot: Stack, axis: str) -> int:
    return robot.api.get(f"/api/motors/{axis}").raise_for_status().json()["slot"]


def check_stalls(robot: Stack, axis: str) -> None:
    """A jammed axis that is driven towards a setpoint faults, and is cleared by hand."""
    slot = slot_of(robot, axis)
    unlock(robot)
    set_home(robot, axis)
    assert motor(robot, slot)["fault"] == "NONE"
    enable(robot, slot)
    robot.control("jam", slot=slot, jammed=True)
    press(robot)
    propose(robot, SETPOINT_COUNTS, slot)
    wait_until("stalled", lambda: motor(robot, slot)["fault"] == "STALL")
    assert motor(robot, slot)["drive"] == 0
    robot.control("jam", slot=slot, jammed=False)
    robot.control("pedal", pressed=False)
    wait_until("cleared", lambda: robot.api.post(f"/api/motors/{axis}/clear-fault").status_code == 200)
    assert motor(robot, slot)["fault"] == "NONE"


def check_footpedal(robot: Stack) -> None:
    for pressed, name in ((True, "PRESSED"), (False, "RELEASED")):
        robot.control("pedal", pressed=pressed)
        robot.status_when(lambda status, name=name: status["pedal"] == name)


def is_ready(robot: Stack) -> bool:
    return robot.status()["mode"] == "READY"


def listed_axes(robot: Stack) -> list[str]:
    return [each["name"] for each in robot.api.get("/api/motors").raise_for_status().json()]


def check_get_motor(robot: Stack) -> None:
    for each in robot.api.get("/api/motors").raise_for_status().json():
        for name in (each["name"], each["slot"]):
            found = robot.api.get(f"/api/motors/{name}").raise_for_status().json()
            assert (found["name"], found["slot"]) == (each["name"], each["slot"])
    assert robot.api.get("/api/motors/elbow").status_code == 404


def kinematics(command: str, robot: str, line: dict, *changes: str) -> dict:
    arguments = [BIN / "interlock", "kinematics", command, "--robot", robot]
    arguments += ["--set", *changes] if changes else []
    answer = subprocess.run(arguments, input=json.dumps(line), capture_output=True, text=True, check=True)
    return json.loads(answer.stdout)


# The thesis-era prostate robot: needle parallel to z, with its lengths.
THESIS_PROSTATE = (
    "needle_tip_mm=259.075",
    "front_pivot_offset_mm=0",
    "max_angulation_rad=0",
    "base_to_zframe_mm=0,0,0",
)


def test_NeuroRobot_CheckForStalls(neuro: Stack) -> None:
    check_stalls(neuro, JOGGED["neuro"])


def test_NeuroRobot_ValidateForwardKinematics() -> None:
    joints = {
        "head": -20, "feet": 10, "lateral": -15, "insertion": 12,
        "probe_rotation": 0.3, "pitch": 0.2, "yaw": -0.7,
    }  # fmt: skip
    pose = kinematics("fk", "neuro", {"joints": joints})["pose"]
    expected = [
        -0.936293, 0.289629, -0.198669, 7.194052,
        0.335543, 0.570540, -0.749596, 216.147319,
        -0.103756, -0.768504, -0.631376, 80.221836,
        0, 0, 0, 1,
    ]  # fmt: skip
    assert pose == pytest.approx(expected, abs=1e-6)


def test_NeuroRobot_RunInverseKinematics() -> None:
    joints = kinematics("ik", "neuro", {"entry": [8, 250, 70], "target": [5, 200, 60]})["joints"]
    expected = {
        "head": -18.420966, "feet": -13.829007, "lateral": -14.284496, "insertion": 15.078371,
        "probe_rotation": 0, "pitch": 0.058767, "yaw": -0.197396,
    }  # fmt: skip
    assert joints == pytest.approx(expected, abs=1e-6)


def test_NeuroRobot_IsFootPedalPressed(neuro: Stack) -> None:
    check_footpedal(neuro)


def test_NeuroRobot_ListMotors(neuro: Stack) -> None:
    assert listed_axes(neuro) == AXES["neuro"]


def test_NeuroRobot_GetMotor(neuro: Stack) -> None:
    check_get_motor(neuro)


def test_ProstateRobot_CheckForStalls(prostate: Stack) -> None:
    check_stalls(prostate, JOGGED["prostate"])


def test_ProstateRobot_ValidateForwardKinematics() -> None:
    joints = {
        "front_left": 149.008578, "front_right": -139.008578, "back_left": 149.008578,
        "back_right": -139.008578, "insertion": 40.925, "rotation": 0,
    }  # fmt: skip
    pose = kinematics("fk", "prostate", {"joints": joints}, *THESIS_PROSTATE)["pose"]
    assert pose == pytest.approx([1, 0, 0, 5, 0, 1, 0, 150, 0, 0, 1, 300, 0, 0, 0, 1], abs=1e-5)


def test_ProstateRobot_RunInverseKinematics() -> None:
    path = {"entry": [5, 150, 200], "target": [5, 150, 300]}
    joints = kinematics("ik", "prostate", path, *THESIS_PROSTATE)["joints"]
    expected = {
        "front_left": 149.008578, "front_right": -139.008578, "back_left": 149.008578,
        "back_right": -139.008578, "insertion": 40.925, "rotation": 0,
    }  # fmt: skip
    assert joints == pytest.approx(expected, abs=1e-6)


def test_ProstateRobot_IsFootPedalPressed(prostate: Stack) -> None:
    check_footpedal(prostate)


def test_ProstateRobot_ListMotors(prostate: Stack) -> None:
    assert listed_axes(prostate) == AXES["prostate"]


def test_ProstateRobot_GetMotor(prostate: Stack) -> None:
    check_get_motor(prostate)


def test_Motor_GetMinTicksGetMaxTicks(neuro: Stack) -> None:
    """A homed axis has its soft limits less the coasting distance, another its travel of one press."""
    feet = slot_of(neuro, "feet")
    neuro.control("pedal", pressed=False)
    wait_until("unlocked", lambda: neuro.api.post("/api/reset").status_code == 200 or is_ready(neuro))
    before = motor(neuro, feet)
    assert not before["homed"]
    assert before["max_counts"] - before["min_counts"] < before["soft_max_counts"] - before["soft_min_counts"]
    set_home(neuro, "feet")
    wait_until("homed", lambda: motor(neuro, feet)["homed"])
    after = motor(neuro, feet)
    assert (after["soft_min_counts"], after["soft_max_counts"]) == (-5512, 5906)
    assert (after["min_counts"], after["max_counts"]) == (-5512 + 12, 5906 - 12)


def test_Encoder_SetPosition(neuro: Stack) -> None:
    """A saved position is set again; what the motor does from then on is counted from there."""
    neuro.control("pedal", pressed=False)
    file = neuro.api.get("/api/positions").raise_for_status().json()
    for axis in file["axes"]:
        if axis["axis"] == "feet":
            axis["position_counts"] = 1234

    def restored() -> bool:
        answer = neuro.api.put("/api/motors/restore", json={"file": file, "axes": ["feet"]})
        return answer.raise_for_status().json()[0]["verdict"] == "ACCEPTED"

    wait_until("restored", restored)
    wait_until("set", lambda: motor(neuro, slot_of(neuro, "feet"))["position_counts"] == 1234)


def test_Logger_SetLogLevel(neuro: Stack) -> None:
    """What is below the level is not logged, what is at it reaches the live log."""
    for level, logged in (("debug", True), ("info", False)):
        assert neuro.api.put("/api/logs", json={"level": level}).raise_for_status().json()["level"] == level
        mark = f"/api/motors/nothing-of-{level}"
        neuro.api.get(mark)
        lines = neuro.api.get("/api/logs", params={"lines": 50}).raise_for_status().json()["lines"]
        assert any(mark in line["text"] for line in lines) == logged


def test_Packets_Connection(neuro: Stack) -> None:
    """The cards of the robot are connected, and a spoiled packet is counted and not used."""
    feet = slot_of(neuro, "feet")
    connected = {card["slot"] for card in neuro.status()["cards"] if card["detected"]}
    assert connected == {slot_of(neuro, axis) for axis in AXES["neuro"]}
    before = neuro.status()["cards"][feet]["checksum_failures"]
    neuro.control("frame", slot=feet, fault="corrupt", count=1)
    neuro.status_when(lambda status: status["cards"][feet]["checksum_failures"] == before + 1)
    assert neuro.status()["cards"][feet]["detected"]
