"""The twelve steps of the console's page Workflow, taken by the HTTP interface."""

from abc import ABC, abstractmethod
from collections.abc import Iterator
from pathlib import Path
from typing import ClassVar

from bare_kernel import ROOT
from conftest import StackFactory
from motion import (
    approve,
    call,
    enable,
    home_all,
    last_drive,
    plant_tick,
    press,
    proposal,
    register,
    release,
    unlock,
    wait_until,
)
from stack import Stack

RETRACTION = {"kind": "retraction"}
BIOPSY = {"kind": "biopsy"}
PART_OF_RETRACTION_TICKS = 500
"""It takes 2,500 or more, and is still under way when the foot is lifted, however slow the machine."""
ENDED = ("done", "refused", "aborted", "expired")


def straight(x: float, y: float, z: float) -> list[float]:
    """A pose with the axes of the scanner, and its origin there."""
    return [1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z, 0, 0, 0, 1]


class Workflow(ABC):
    """One robot on its way through the steps. Points and poses are in the scanner, in mm."""

    homing: ClassVar[dict]
    registration: list[float]
    """Puts the robot about where its file expects it."""
    targets: tuple[dict, dict]
    rest_on_registration: ClassVar[list[dict]] = [{"kind": "pose"}]
    """Proposals that are refused unless a registration is valid."""

    def __init__(self, robot: Stack) -> None:
        self.robot = robot

    def steps(self) -> Iterator[str]:
        """Takes one step after the other, and gives its name when it is done or while its motion goes on."""
        unlock(self.robot)
        for axis in self.robot.api.get("/api/motors").raise_for_status().json():
            enable(self.robot, axis["slot"])
        yield "case"
        self.run(self.propose(self.homing))
        yield "home"
        self.home()
        register(self.robot, self.registration)
        yield "register"
        self.report_image()
        yield "image"
        self.aim(0)
        yield "target"
        alignment = self.propose(self.alignment())
        yield "review"
        self.run(alignment)
        yield "align"
        yield from self.treat(alignment)
        number = self.propose(RETRACTION)
        self.run(number)
        paused_tick = self.robot.control("pedal", pressed=False, after=PART_OF_RETRACTION_TICKS)["tick"]
        yield "retract"
        wait_until("it pauses", lambda: plant_tick(self.robot) > paused_tick)
        press(self.robot)
        self.finish(number)
        self.aim(1)
        approve(self.robot, self.propose(self.alignment()))
        yield "end"

    def next_motion(self, step: str) -> dict:
        """What is proposed after a restart in that step, home, registration and target in force again."""
        if step in ("case", "home"):
            return self.homing
        return RETRACTION if step == "retract" else self.alignment()

    def go_on(self, step: str, number: int) -> None:
        """Approves what was proposed after a restart in that step, and presses the pedal."""
        self.run(number)

    @abstractmethod
    def alignment(self) -> dict:
        """The proposal of a motion that aligns the robot with its target."""

    @abstractmethod
    def treat(self, alignment: int) -> Iterator[str]:
        """From an alignment that goes on to the end of the treatment, which leaves the probe in."""

    def home(self) -> None:
        """By hand: the switches take minutes of the robot's time, and other tests wait for them."""
        self.set("PUT", "mode", {"mode": "manual"})
        release(self.robot)
        home_all(self.robot)

    def report_image(self) -> None:
        """What an imager says of the probe: nothing moves by it."""
        self.set("PUT", "targeting/current", {"current_position": self.registration})

    def aim(self, place: int) -> None:
        self.set("PUT", "targeting/target", self.targets[place])

    def set(self, method: str, path: str, body: dict | None = None) -> None:
        call(self.robot.api, method, path, body).raise_for_status()

    def propose(self, draft: dict) -> int:
        answer = call(self.robot.api, "POST", "proposals", draft)
        assert answer.status_code == 201, answer.text
        assert answer.json()["state"] == "checked"
        return answer.json()["id"]

    def run(self, number: int) -> None:
        """Approves it and presses the pedal; it goes on from there."""
        approve(self.robot, number)
        self.press(number)

    def press(self, number: int, hand_newtons: float | None = None) -> None:
        """Presses the pedal, then the hand, until an axis is driven; a short motion may be over by then."""
        before = last_drive(self.robot)
        press(self.robot)
        if hand_newtons is not None:
            self.robot.control("hand", newtons=hand_newtons)
        failed = [state for state in ENDED if state != "done"]
        wait_until(
            "it moves",
            lambda: last_drive(self.robot) > before or proposal(self.robot, number)["state"] in failed,
        )
        assert proposal(self.robot, number)["state"] not in failed, proposal(self.robot, number)["detail"]

    def finish(self, number: int) -> None:
        wait_until("it ends", lambda: proposal(self.robot, number)["state"] in ENDED)
        assert proposal(self.robot, number)["state"] == "done", proposal(self.robot, number)["detail"]
        release(self.robot)


class Ablation(Workflow):
    """By the NeuroRobot: it inserts its probe in the motion that aligns it."""

    homing: ClassVar = {"kind": "home", "step": "angles"}
    registration = straight(-17.875, -185.25, -72.5)
    targets = (
        {"entry_point": [-9.875, 64.75, -2.5], "target_point": [-13.835, -1.25, -15.7]},
        {"entry_point": [-8.875, 65.75, -1.5], "target_point": [-11.875, 15.75, -10.5]},
    )
    ablation: ClassVar = {
        "kind": "ablation",
        "steps": [
            {"probe_rotation": 1.0, "insertion": 20.0, "dwell_s": 1},
            {"probe_rotation": 2.0, "insertion": 30.0, "dwell_s": 1},
        ],
    }

    def alignment(self) -> dict:
        return {"kind": "pose", "insert": True}

    def treat(self, alignment: int) -> Iterator[str]:
        self.confirm(alignment)
        yield "confirm"
        self.press(alignment)
        yield "insert"
        self.finish(alignment)
        ablation = self.propose(self.ablation)
        self.run(ablation)
        yield "treat"
        self.finish(ablation)

    def confirm(self, alignment: int) -> None:
        wait_until("aligned", lambda: proposal(self.robot, alignment)["wants_confirmation"])
        release(self.robot)
        self.set("POST", f"proposals/{alignment}/confirm")

    def next_motion(self, step: str) -> dict:
        return self.ablation if step == "treat" else super().next_motion(step)

    def go_on(self, step: str, number: int) -> None:
        """Where it is aligned already, its first motion is the insertion."""
        if step != "confirm":
            self.run(number)
            return
        approve(self.robot, number)
        press(self.robot)
        self.confirm(number)
        self.press(number)


class Biopsy(Workflow):
    """By the prostate robot: a hand pushes the needle once the robot is aligned, and images show its tip."""

    homing: ClassVar = {"kind": "home"}
    registration = straight(0, -11, -90)
    targets = (
        {"entry_point": [2, 7, -136], "target_point": [2, 7, -86]},
        {"entry_point": [-3, 11, -138], "target_point": [-3, 11, -88]},
    )
    rest_on_registration: ClassVar = [{"kind": "pose"}, BIOPSY]
    sliders = ("back_left", "front_left", "back_right", "front_right")

    def alignment(self) -> dict:
        return {"kind": "pose"}

    def home(self) -> None:
        """Set Home says 0, where the sliders of a pair would touch: they part before anything else."""
        super().home()
        targets = {name: 80.0 if name.endswith("left") else -80.0 for name in self.sliders}
        number = self.propose({"kind": "coordinated", "targets": targets})
        self.run(number)
        self.finish(number)

    def treat(self, alignment: int) -> Iterator[str]:
        self.finish(alignment)
        self.report_image()
        self.set("POST", "biopsy/zero")
        biopsy = self.propose(BIOPSY)
        approve(self.robot, biopsy)
        yield "confirm"
        self.press(biopsy, hand_newtons=5.0)
        yield "insert"
        self.finish(biopsy)
        self.robot.control("hand", newtons=0.0)
        yield "treat"

    def next_motion(self, step: str) -> dict:
        return {"confirm": BIOPSY, "treat": RETRACTION}.get(step) or super().next_motion(step)

    def go_on(self, step: str, number: int) -> None:
        if step != "confirm":
            self.run(number)
            return
        approve(self.robot, number)
        self.press(number, hand_newtons=5.0)


def begin(name: str, stack: StackFactory, directory: Path, **options: bool | str) -> Workflow:
    """The workflow of that robot, in which nothing is done but that a case is open.

    The sliders of the prostate robot start at their inner ends, so that they part without reaching a switch.
    """
    if name == "neuro":
        return Ablation(stack(robot=name, **options))
    plant = directory / "plant.toml"
    inner = (ROOT / "models/plant/prostate.toml").read_text()
    for side in ("", "-"):
        inner = inner.replace(f"start_counts = {side}375000", f"start_counts = {side}101000")
    plant.write_text(inner)
    return Biopsy(stack(robot=name, plant=plant, **options))
