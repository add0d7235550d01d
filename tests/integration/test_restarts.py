"""The app is killed in each step of both workflows and started anew: nothing moves on what ended with it."""

import contextlib
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import httpx
import numpy as np
import pytest
from bare_kernel import ROOT
from conftest import StackFactory
from controllers import connections, make_controller
from interface import judge
from motion import (
    PRESS_TICKS,
    call,
    last_drive,
    plant_tick,
    press_for_a_while,
    proposal,
    register,
    release,
    restart_app,
    wait_until,
)
from navigation_phases import Phases, pose_from, to_targeting
from navigator import OK, Insistent, Navigator, text, transform
from pyigtl import messages as wire
from stack import Stack
from workflow import ENDED, Workflow, begin, straight

NEURO = {
    "case": "after_the_case_is_opened",
    "home": "while_it_homes",
    "register": "after_the_registration",
    "image": "after_the_image",
    "target": "after_entry_and_target",
    "review": "while_the_motion_is_reviewed",
    "align": "while_it_aligns",
    "confirm": "after_the_confirmation",
    "insert": "while_it_inserts",
    "treat": "while_it_ablates",
    "retract": "while_it_retracts",
    "end": "with_the_next_target_approved",
}
"""When the app is killed, by the step of the console's page Workflow."""
PROSTATE = NEURO | {
    "confirm": "with_the_biopsy_approved",
    "insert": "while_a_hand_inserts",
    "treat": "while_the_sample_is_taken",
}
WHEN = {"neuro": NEURO, "prostate": PROSTATE}
APP_TIMEOUT_TICKS = 100
WIRE_TICKS = 2


def at(robot: str, step: str, *more: str) -> object:
    """A parameter set whose name says when the app is killed."""
    return pytest.param(robot, step, *more, id="-".join([robot, WHEN[robot][step], *more]))


POINTS = [at(robot, step) for robot, steps in WHEN.items() for step in steps]


def code(answer: httpx.Response) -> str:
    """With which it was refused."""
    assert answer.is_client_error, answer.text
    return judge(answer).json()["code"]


@dataclass
class Killed:
    """A workflow whose app was killed in a step, and what held until then."""

    workflow: Workflow
    step: str
    targeting: dict
    proposals: list[dict]
    died_tick: int

    @property
    def robot(self) -> Stack:
        return self.workflow.robot

    @property
    def was_registered(self) -> bool:
        return self.targeting["registration"] is not None

    @property
    def registration_state(self) -> str:
        """That nobody may find `valid` before it was set anew."""
        return "expired" if self.was_registered else "not_set"


def kill(workflow: Workflow, step: str, meanwhile: Callable[[], object] = lambda: None) -> Killed:
    """Kills the app in that step. From when it is dead the pedal is held, if it was not held before."""
    robot = workflow.robot
    steps = workflow.steps()
    while next(steps) != step:
        pass
    proposals = judge(robot.api.get("/api/proposals")).json()
    targeting = judge(robot.api.get("/api/targeting")).json()

    def press_the_pedal() -> None:
        robot.control("pedal", pressed=True)
        meanwhile()

    died_tick = restart_app(robot, press_the_pedal)
    return Killed(workflow, step, targeting, proposals, died_tick)


def expect_no_drive(killed: Killed) -> None:
    """Neither by the pedal that is held since the app died, nor by another press."""
    robot = killed.robot
    stopped_tick = killed.died_tick + APP_TIMEOUT_TICKS + WIRE_TICKS
    wait_until("it would have moved", lambda: plant_tick(robot) > stopped_tick + PRESS_TICKS)
    assert last_drive(robot) <= stopped_tick
    release(robot)
    assert not press_for_a_while(robot)


def expect_nothing_in_force(killed: Killed) -> None:
    robot = killed.robot
    assert judge(robot.api.get("/api/control")).json()["holder"] is None
    [case] = judge(robot.api.get("/api/cases")).json()
    assert case["state"] == "suspended"
    targeting = judge(robot.api.get("/api/targeting")).json()
    assert targeting["registration_state"] == killed.registration_state
    if killed.was_registered:
        assert targeting["registration_problem"].endswith("has expired: The app was started since.")
    assert all(each["state"] in ENDED for each in judge(robot.api.get("/api/proposals")).json())


def expect_old_proposals_ended(killed: Killed, client: httpx.Client, refusal: str) -> None:
    for each in killed.proposals:
        for answer in ("approve", "confirm"):
            assert code(call(client, "POST", f"proposals/{each['id']}/{answer}")) == refusal


def expect_no_pose(killed: Killed) -> None:
    """What rests on the registration is refused, and a press moves nothing."""
    for draft in killed.workflow.rest_on_registration:
        assert code(call(killed.robot.api, "POST", "proposals", draft)) == "NO_REGISTRATION"
    assert not press_for_a_while(killed.robot)


def take_control(killed: Killed) -> None:
    assert judge(call(killed.robot.api, "POST", "control/request")).is_success


def resume(killed: Killed) -> None:
    """By a person who has taken control: entry and target are in force again, the registration is not."""
    robot = killed.robot
    expect_old_proposals_ended(killed, robot.api, "NOT_FOUND")
    expect_no_pose(killed)
    assert code(call(robot.api, "PUT", "targeting/target", killed.workflow.targets[1])) == "NO_CASE"
    [case] = judge(robot.api.get("/api/cases")).json()
    resumed = judge(call(robot.api, "POST", f"cases/{case['number']}/resume")).json()
    assert resumed["state"] == "open"
    targeting = judge(robot.api.get("/api/targeting")).json()
    for name in ("entry_point", "target_point"):
        assert targeting[name] == killed.targeting[name]
    assert targeting["registration_state"] == killed.registration_state
    expect_no_pose(killed)


def go_on(killed: Killed, other: httpx.Client) -> None:
    """The workflow goes on where it was interrupted, by a new registration, proposal, approval and press."""
    robot, workflow = killed.robot, killed.workflow
    if killed.was_registered:
        register(robot, workflow.registration)
    if killed.targeting["target_point"] is None and killed.was_registered:
        workflow.aim(0)
    number = workflow.propose(workflow.next_motion(killed.step))
    assert all(number > each["id"] for each in killed.proposals), "no number is given twice"
    expect_old_proposals_ended(killed, robot.api, "NOT_FOUND")
    assert not press_for_a_while(robot), "nobody has approved it"
    assert code(call(other, "POST", f"proposals/{number}/approve")) == "CONTROL"
    assert not press_for_a_while(robot)
    workflow.go_on(killed.step, number)


@pytest.mark.parametrize(("name", "step"), POINTS)
def test_no_motion_starts_after_a_restart_that_rests_on_what_ended_with_it(
    stack: StackFactory, tmp_path: Path, name: str, step: str
) -> None:
    workflow = begin(name, stack, tmp_path)
    other = workflow.robot.client_of_new("erin", "engineer")
    killed = kill(workflow, step)
    expect_nothing_in_force(killed)
    expect_no_drive(killed)
    for client in (workflow.robot.api, other):
        expect_old_proposals_ended(killed, client, "CONTROL")
    take_control(killed)
    resume(killed)
    go_on(killed, other)


def test_the_app_is_killed_in_every_step_of_the_page_workflow() -> None:
    page = (ROOT / "web/src/panels/workflow/workflow.ts").read_text()
    [titles] = re.findall(r"stepTitles = {(.*?)}", page, re.DOTALL)
    assert re.findall(r"^  (\w+):", titles, re.MULTILINE) == list(NEURO) == list(PROSTATE)


class Requests:
    """What a navigation program sends to have the robot go to its target, in a dialect."""

    def __init__(self, workflow: Workflow, dialect: str) -> None:
        self.dialect = dialect
        self.registration = workflow.registration
        points = (workflow.targets[0][name] for name in ("entry_point", "target_point"))
        self.entry, self.target = (np.array(each, dtype=float) for each in points)

    def __call__(self, number: int) -> list[wire.MessageBase]:
        if self.dialect == "thesis":
            return [
                transform("REGISTRATION", self.registration),
                transform("ENTRY_POINT", straight(*self.entry)),
                transform("TARGET_POINT", straight(*self.target)),
                text("MODE", "targeting"),
            ]
        return [
            text(f"CMD_{number}s", "START_UP"),
            text(f"CMD_{number}c", "CALIBRATION"),
            transform(f"CLB_{number}", self.registration),
            text(f"CMD_{number}p", "PLANNING"),
            text(f"CMD_{number}t", "TARGETING"),
            transform(f"TGT_{number}", pose_from(self.entry, self.target)),
            text(f"CMD_{number}m", "MOVE_TO_TARGET"),
        ]

    def answered(self, program: Navigator) -> None:
        """Sends them one after the other, each of which has to be carried out."""
        if self.dialect == "thesis":
            assert [program.ask(each).code for each in self(1)] == [OK] * 4
            return
        phases = Phases(program)
        to_targeting(phases, self.dialect, self.registration, pose_from(self.entry, self.target))
        phases.phase("MOVE_TO_TARGET", number="0004")


def wait_for_rounds(robot: Stack) -> None:
    """The navigation program has sent everything twice, and in each round was refused."""

    def refused() -> int:
        return sum(each["refused"] for each in connections(robot))

    ends = refused() + 14
    wait_until("it insists", lambda: refused() >= ends)


@pytest.mark.parametrize(
    ("name", "step", "dialect"),
    [
        at("neuro", "target", "brp2013"),
        at("neuro", "align", "wpi2024"),
        at("prostate", "review", "thesis"),
        at("prostate", "insert", "brp2013"),
    ],
)
def test_a_navigation_program_that_insists_moves_nothing_after_a_restart_until_it_calibrates_anew(
    stack: StackFactory, tmp_path: Path, name: str, step: str, dialect: str
) -> None:
    workflow = begin(name, stack, tmp_path, igtl=True, dialect=dialect)
    robot, requests = workflow.robot, Requests(workflow, dialect)
    with contextlib.ExitStack() as beside:
        program = Insistent(lambda: robot.igtl_port, requests)
        killed = kill(workflow, step, lambda: beside.enter_context(program))
        wait_for_rounds(robot)
        expect_nothing_in_force(killed)
        expect_no_drive(killed)
        take_control(killed)
        make_controller(robot)
        wait_for_rounds(robot)
        resume(killed)
        wait_for_rounds(robot)
        expect_no_pose(killed)
    assert all(each["state"] in ENDED for each in judge(robot.api.get("/api/proposals")).json())
    wait_until("it has gone", lambda: not connections(robot))
    calibrated = Navigator(robot.igtl_port)
    wait_until("it is back", lambda: len(connections(robot)) == 1)
    make_controller(robot)
    x, y, z = np.reshape(workflow.registration, (4, 4))[:3, 3]
    requests.registration = straight(x + 3, y, z)
    requests.answered(calibrated)

    def proposed() -> list[int]:
        found = judge(robot.api.get("/api/proposals")).json()
        return [each["id"] for each in found if each["state"] not in ENDED]

    wait_until("proposed", lambda: len(proposed()) == 1)
    [number] = proposed()
    assert proposal(robot, number)["source"] == "openigtlink"
    assert not press_for_a_while(robot), "nobody has approved it"
    workflow.run(number)
    calibrated.stop()
