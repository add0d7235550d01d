"""The workphases of a needle placement, as a navigation program asks for them, and each answer's order."""

import time

import numpy as np
from bare_kernel import DEADLINE_S
from navigator import Program, Status, text, transform
from pyigtl import messages as wire

CALIBRATION = [1, 0, 0, -17.875, 0, 1, 0, -185.25, 0, 0, 1, -72.5, 0, 0, 0, 1]
ENTRY, TARGET = np.array([8.0, 250.0, 70.0]), np.array([5.0, 200.0, 60.0])


def pose_from(entry: np.ndarray, target: np.ndarray) -> list[float]:
    """A pose of a probe that comes from the entry and whose treatment point is at the target."""
    ahead = (target - entry) / np.linalg.norm(target - entry)
    side = np.cross([0, 0, 1], ahead)
    side = side / np.linalg.norm(side) if side.any() else np.array([1.0, 0.0, 0.0])
    pose = np.eye(4)
    pose[:3, 0], pose[:3, 1], pose[:3, 2] = side, np.cross(ahead, side), ahead
    pose[:3, 3] = target
    return pose.astype(np.float32).astype(float).ravel().tolist()


def aimed() -> list[float]:
    """The pose of a probe that comes from ENTRY and whose treatment point is at TARGET, in the scanner."""
    offset = np.reshape(CALIBRATION, (4, 4))[:3, 3]
    return pose_from(ENTRY + offset, TARGET + offset)


def short(message: wire.MessageBase) -> str:
    """How a message begins: "CURRENT_STATUS 1 PLANNING", "START_UP 1", "ACK_7 STRING"."""
    if not isinstance(message, Status):
        return f"{message.device_name} {message.message_type}"
    name = f" {message.name}" if message.device_name == "CURRENT_STATUS" else ""
    return f"{message.device_name} {message.code}{name}"


class Phases:
    """A navigation program that asks for workphases, and knows what it heard since it last asked."""

    def __init__(self, program: Program) -> None:
        self.program = program
        self.heard = program.heard
        self.since = 0

    def ask(self, message: wire.MessageBase) -> Status:
        return self.program.ask(message)

    def stop(self) -> None:
        self.program.stop()

    def messages(self) -> list[wire.MessageBase]:
        """What was heard since then."""
        return self.heard.all[self.since :]

    def answers(self) -> list[wire.MessageBase]:
        """The same, the stream of positions apart, and what is repeated while a motion is approved."""
        told: list[wire.MessageBase] = []
        for each in self.messages():
            repeats = each.device_name == "CURRENT_STATUS" and short(each) in map(short, told)
            if each.device_name != "CURRENT_POSITION" and not repeats:
                told.append(each)
        return told

    def shorts(self) -> list[str]:
        return [short(each) for each in self.answers()]

    def expect(self, message: wire.MessageBase, *answers: str) -> list[wire.MessageBase]:
        """Exactly these answers come, in this order; `make bench` measures how soon."""
        self.since = len(self.heard.all)
        self.program.send(message)
        self.await_answers(*answers)
        return self.answers()

    def await_answers(self, *answers: str) -> None:
        """In that order; that a phase takes longer (6) counts only where it is asked for."""
        waits = any(each.endswith(" 6") for each in answers)

        def answered() -> list[str]:
            return [each for each in self.shorts() if waits or not each.endswith(" 6")]

        deadline = time.monotonic() + DEADLINE_S
        while len(answered()) < len(answers) and time.monotonic() < deadline:
            time.sleep(0.001)
        assert answered() == list(answers)

    def phase(self, name: str, *status: str, number: str = "0001") -> None:
        """Asks for a phase: the ACK bears the same ID and text, CURRENT_STATUS the phase."""
        messages = self.expect(
            text(f"CMD_{number}", name), f"ACK_{number} STRING", f"CURRENT_STATUS 1 {name}", *status
        )
        assert messages[0].string == name


def to_targeting(
    navigator: Phases, dialect: str, calibration: list[float] = CALIBRATION, pose: list[float] | None = None
) -> None:
    """From START_UP to a target that is set: that pose, or the aimed one."""
    entered = dialect == "wpi2024"
    navigator.phase("START_UP", "START_UP 1")
    navigator.phase("CALIBRATION", *(["CALIBRATION 1"] if entered else []))
    [echo, *_] = navigator.expect(transform("CLB_0002", calibration), "ACK_0002 TRANSFORM", "CALIBRATION 1")
    assert echo.matrix.ravel().tolist() == calibration
    navigator.phase("PLANNING", *(["PLANNING 1"] if entered else []))
    navigator.phase("TARGETING", "TARGETING 1")
    reachable = ["REACHABLE_TARGET TRANSFORM"] if entered else []
    pose = pose or aimed()
    echo, status, told, *_ = navigator.expect(
        transform("TGT_0003", pose), "ACK_0003 TRANSFORM", "TARGET 1", "TARGET TRANSFORM", *reachable
    )
    assert echo.matrix.ravel().tolist() == pose
    assert np.allclose(told.matrix[:3, 3], np.array(pose).reshape(4, 4)[:3, 3], atol=1e-3), status.text
