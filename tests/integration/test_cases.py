"""Nothing moves on the strength of yesterday: cases, registrations, targets, homes and approvals."""

import os
import random
from collections import Counter
from dataclasses import dataclass, field

import pytest
from conftest import StackFactory
from interface import judge
from motion import (
    IDENTITY,
    home_all,
    motor,
    open_stream,
    press_for_a_while,
    restart_app,
    unlock,
    wait_for_ticks,
    wait_until,
)
from stack import Stack

STEPS = int(os.environ.get("INTERLOCK_CASE_STEPS", "800"))
"""Of the random walk; with 10000 it takes some minutes."""
REGISTRATION = {"registration": IDENTITY, "override_reason": "There is no scanner."}
TARGETS = [
    {"entry_point": [8, 250, 70], "target_point": [5, 200, 60]},
    {"entry_point": [9, 251, 71], "target_point": [6, 201, 62]},
]
POSE = {"kind": "pose"}
# A plan holds for axes that stand where they stood by up to three deadbands, of one count each; encoders
# and what they lag behind by.
STANDS_COUNTS = 1.5
ELSEWHERE_COUNTS = 6.0
TOGETHER = {"kind": "coordinated", "targets": {"yaw": -0.2, "pitch": -0.1}}


def await_beats(robot: Stack) -> None:
    """After the app has looked at the axes, as it does before each state that it streams."""
    with open_stream(robot) as stream:
        for _ in range(3):
            while isinstance(stream.recv(), str):
                pass


def wait_for_answer(robot: Stack, path: str, **body: object) -> None:
    """Asked until it is accepted: it wants the axis at rest."""
    wait_until(path, lambda: robot.api.post(f"/api/{path}", json=body or None).is_success, 20)


def true_counts(robot: Stack) -> float:
    """Where the axis in slot 0 stands, whatever its encoder and its home say."""
    [axis] = [each for each in robot.control("status")["axes"] if each["slot"] == 0]
    return axis["position_counts"]


def places(robot: Stack) -> dict[int, float]:
    """Where every axis stands in truth, by its slot."""
    return {each["slot"]: each["position_counts"] for each in robot.control("status")["axes"]}


@dataclass
class Believed:
    """What holds by the rules of cases, and nothing that the app says of itself."""

    case: int | None = None
    is_open: bool = False
    registration: int | None = None
    target: int | None = None
    version: int = 0
    motions: dict[int, tuple] = field(default_factory=dict)
    """Of each proposal that may still become motion, what it rests on."""
    approved: int | None = None

    def new(self) -> int:
        self.version += 1
        return self.version

    def basis(self, kind: str) -> tuple:
        rests_on = (self.case if self.is_open else None,)
        return rests_on if kind == "coordinated" else (*rests_on, self.registration, self.target)

    def holds(self, number: int) -> bool:
        kind, rests_on = self.motions[number]
        return rests_on[0] in (None, self.basis(kind)[0]) and rests_on[1:] == self.basis(kind)[1:]

    def leave_case(self, closes: bool) -> None:
        self.is_open = False
        if closes:
            self.case = self.registration = self.target = None

    def forget_ended(self) -> None:
        self.motions = {each: rest for each, rest in self.motions.items() if self.holds(each)}
        self.approved = self.approved if self.approved in self.motions else None


class Walker:
    """Draws what people and failures do, and compares each answer and each motion with what holds."""

    def __init__(self, robot: Stack, seed: int) -> None:
        self.robot = robot
        self.draw = random.Random(seed)
        self.believed = Believed()
        self.seen: Counter[str] = Counter()
        self.other = robot.client_of_new("erin", "engineer")
        self.start = true_counts(robot)
        self.home_at = self.start
        self.planned_at: dict[int, dict[int, float]] = {}

    def ask(self, method: str, path: str, expected: bool, what: str, **content: object) -> dict:
        """An answer that has to be one of success where it is expected, and a refusal where not."""
        answer = judge(self.robot.api.request(method, f"/api/{path}", **content))
        while answer.status_code == 503:  # it waited for too long on a busy machine, and nothing was done
            answer = judge(self.robot.api.request(method, f"/api/{path}", **content))
        assert answer.is_success == expected, (what, expected, self.believed, answer.text, self.faults())
        self.seen[f"{what} {'done' if expected else 'refused'}"] += 1
        return answer.json()

    def slots_of(self, names: list[str]) -> list[int]:
        motors = judge(self.robot.api.get("/api/motors")).json()
        return [each["slot"] for each in motors if each["name"] in names]

    def faults(self) -> list[str]:
        return [each["fault"] for each in judge(self.robot.api.get("/api/motors")).json()]

    def recover(self) -> None:
        """An axis that was pushed back and is driven the way it had come before makes no progress: STALL. It
        loses its home by that."""
        for slot, fault in enumerate(self.faults()):
            if fault != "NONE":
                assert fault == "STALL"
                self.seen["stalled"] += 1
                wait_for_answer(self.robot, f"motors/{slot}/clear-fault")
                wait_for_answer(self.robot, f"motors/{slot}/set-home", override_switch=True)
                self.home_at = true_counts(self.robot) if slot == 0 else self.home_at
                wait_for_answer(self.robot, f"motors/{slot}/enable")
                await_beats(self.robot)
                self.believed.registration = None
                self.believed.motions.clear()

    def case_step(self, step: str) -> None:
        known = self.believed
        number = known.case or self.draw.randint(1, 3)
        allowed = {
            "suspend": known.is_open,
            "resume": known.case is not None and not known.is_open,
            "close": known.case is not None,
        }
        if known.case is None:
            number = 9999
        self.ask("POST", f"cases/{number}/{step}", allowed[step], step)
        if allowed[step] and step == "resume":
            known.is_open = True
        elif allowed[step]:
            known.leave_case(step == "close")

    def open(self) -> None:
        allowed = self.believed.case is None
        made = self.ask("POST", "cases", allowed, "open", json={"label": "walk"})
        if allowed:
            self.believed.case, self.believed.is_open = made["number"], True

    def register(self) -> None:
        self.ask("PUT", "targeting/registration", self.believed.is_open, "register", json=REGISTRATION)
        if self.believed.is_open and self.believed.registration is None:
            self.believed.registration = self.believed.new()

    def aim(self) -> None:
        place = self.draw.randrange(len(TARGETS))
        self.ask("PUT", "targeting/target", self.believed.is_open, "aim", json=TARGETS[place])
        if self.believed.is_open:
            self.believed.target = place

    def move_table(self) -> None:
        """And the patient with it."""
        self.ask("POST", "targeting/registration/expire", True, "table", json={})
        self.believed.registration = self.believed.target = None

    def set_home(self) -> None:
        """Elsewhere: the axis is pushed before, to near where it stood at first."""
        self.ask("POST", "motors/0/disable", True, "disable")
        goal = self.start - self.draw.randint(10, 200)
        while abs(goal - self.home_at) < 10:
            goal = self.start - self.draw.randint(10, 200)
        while abs(left := goal - true_counts(self.robot)) > 1:
            self.robot.control("push", slot=0, counts=round(max(-40, min(40, left))))
            wait_for_ticks(self.robot, 50)
        wait_for_answer(self.robot, "motors/0/set-home", override_switch=True)
        self.home_at = true_counts(self.robot)
        await_beats(self.robot)
        wait_for_answer(self.robot, "motors/0/enable")
        self.believed.registration = None
        self.believed.motions.clear()

    def propose(self, draft: dict) -> None:
        known = self.believed
        whole = known.is_open and None not in (known.registration, known.target)
        made = self.ask(
            "POST", "proposals", draft is TOGETHER or whole, f"propose {draft['kind']}", json=draft
        )
        if "id" in made:
            assert made["case"] == (known.case if known.is_open else None)
            there = places(self.robot)
            self.planned_at[made["id"]] = {slot: there[slot] for slot in self.slots_of(made["axes"])}
            known.motions[made["id"]] = (draft["kind"], known.basis(draft["kind"]))

    def approve(self) -> None:
        """Any number; those that have ended too."""
        known = self.believed
        newest = max(known.motions, default=1)
        number = self.draw.choice([*known.motions, newest, max(1, newest - 1)])
        waits = number in known.motions and known.holds(number) and number != known.approved
        waits = waits and self.look_again(number)
        self.ask("POST", f"proposals/{number}/approve", waits, "approve")
        if waits:
            known.motions.pop(known.approved or 0, None)
            known.approved = number

    def look_again(self, number: int) -> bool:
        """What begins elsewhere than where it was planned is planned anew, and not approved as it was.
        False: it was rejected, as nobody can tell to a count."""
        then, now = self.planned_at[number], places(self.robot)
        way = max(abs(now[slot] - then[slot]) for slot in then)
        if way > ELSEWHERE_COUNTS:
            refused = self.ask("POST", f"proposals/{number}/approve", False, "approve from elsewhere")
            assert refused["code"] == "MOVED"
            self.planned_at[number] = {slot: now[slot] for slot in then}
        elif way > STANDS_COUNTS:
            self.ask("POST", f"proposals/{number}/reject", True, "reject")
            del self.believed.motions[number]
            return False
        return True

    def approve_as_another(self) -> None:
        number = max(self.believed.motions, default=1)
        assert self.other.post(f"/api/proposals/{number}/approve").status_code == 409

    def restart(self) -> None:
        restart_app(self.robot)
        assert self.robot.api.post("/api/control/request").status_code == 200
        self.believed.leave_case(closes=False)
        self.believed.registration = None
        self.believed.motions.clear()

    def stop(self) -> None:
        self.robot.api.post("/api/stop").raise_for_status()
        self.believed.motions.clear()
        wait_until("READY", lambda: self.robot.status()["mode"] == "READY")

    def press(self) -> None:
        may_move = self.believed.approved is not None
        moved = press_for_a_while(self.robot)
        assert may_move or not moved, self.believed
        self.seen["moved"] += moved
        if moved:
            state = self.robot.api.get(f"/api/proposals/{self.believed.approved}").json()["state"]
            if state not in ("approved", "executing", "paused"):
                self.believed.motions.pop(self.believed.approved)

    def go_on(self, steps: int) -> None:
        weighed = {
            self.open: 6,
            self.register: 8,
            self.aim: 8,
            self.move_table: 2,
            self.set_home: 1,
            self.approve: 16,
            self.approve_as_another: 2,
            self.press: 8,
            self.stop: 1,
            (lambda: self.propose(POSE)): 14,
            (lambda: self.propose(TOGETHER)): 5,
            (lambda: self.case_step("suspend")): 3,
            (lambda: self.case_step("resume")): 6,
            (lambda: self.case_step("close")): 1,
        }
        every = max(250, steps // 6)  # an app that ends five times a minute is not started anew
        for step in range(steps):
            self.draw.choices(list(weighed), list(weighed.values()))[0]()
            if step % every == every - 1:
                self.restart()
            self.recover()
            self.believed.forget_ended()
            told = self.robot.api.get("/api/targeting").json()
            valid = self.believed.is_open and self.believed.registration is not None
            assert (told["registration_state"] == "valid") == valid, (
                self.believed,
                told["registration_problem"],
                self.faults(),
            )


def ready(stack: StackFactory) -> Stack:
    robot = stack()
    unlock(robot)
    home_all(robot)
    await_beats(robot)
    return robot


@pytest.mark.parametrize("seed", [29, 30])
def test_whatever_people_programs_and_failures_do_nothing_moves_on_what_has_ended(
    stack: StackFactory, seed: int
) -> None:
    robot = ready(stack)
    robot.api.post("/api/cases/1/close").raise_for_status()
    walker = Walker(robot, seed)
    walker.go_on(STEPS)
    print(walker.seen)
    for what in ("moved", "approve done", "approve refused", "propose pose done", "propose pose refused"):
        assert walker.seen[what], f"never {what}: {walker.seen}"


def test_a_start_of_the_app_suspends_the_case_until_somebody_resumes_it(stack: StackFactory) -> None:
    robot = ready(stack)
    robot.api.put("/api/targeting/registration", json=REGISTRATION).raise_for_status()
    robot.api.put("/api/targeting/target", json=TARGETS[0]).raise_for_status()
    restart_app(robot)
    [case] = judge(robot.api.get("/api/cases")).json()
    assert case["state"] == "suspended"
    assert case["problem"].startswith("The case is suspended")
    assert case["targeting"]["target_point"] == TARGETS[0]["target_point"], "to be looked at"
    assert case["targeting"]["registration_state"] == "expired"
    assert case["last_set"]["target_point"]["user"] == "admin"
    refused = judge(robot.api.post(f"/api/cases/{case['number']}/resume"))
    assert refused.json()["code"] == "CONTROL", "by somebody who has control"
    assert robot.api.post("/api/control/request").status_code == 200
    refused = judge(robot.api.put("/api/targeting/target", json=TARGETS[1]))
    assert (refused.status_code, refused.json()["code"]) == (409, "NO_CASE")
    resumed = judge(robot.api.post(f"/api/cases/{case['number']}/resume")).raise_for_status().json()
    assert (resumed["state"], resumed["problem"]) == ("open", None)
    assert resumed["targeting"]["target_point"] == TARGETS[0]["target_point"]
    assert motor(robot, 0)["homed"], "the robot is where it was"


def test_the_export_of_a_case_names_what_the_black_box_recorded_meanwhile(stack: StackFactory) -> None:
    robot = ready(stack)
    robot.control("estop", pulled=True)
    wait_until("it is recorded", lambda: list((robot.state / "recordings").glob("*-lock-*.ilkr")) != [])
    robot.api.post("/api/cases/1/close").raise_for_status()
    exported = judge(robot.api.get("/api/cases/1")).raise_for_status().json()
    [recording] = (robot.state / "recordings").glob("*.ilkr")
    assert exported["recordings"] == [recording.name]
