#!/usr/bin/env python3
"""Runs one scenario and prints its outcome as one line of JSON. Usage: scenario.py SEED NUMBER FOLDER

To be started by `unshare` as the first process of namespaces of its own (run.py does): whatever it mounts,
and every process that it leaves, ends with it.
"""

import contextlib
import dataclasses
import json
import logging
import os
import signal
import sqlite3
import subprocess
import sys
import threading
import time
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2] / "tests/integration"))

import faults
import judge
from bare_kernel import BIN
from plan import AS_SERVICES, Plan, plan
from robots import (
    BROKEN,
    Clerk,
    Mover,
    Services,
    Supervised,
    await_motion,
    bring_up,
    eventually,
    wait_until_driven,
)

SETTLED_TICKS = 250
LONGEST_REST_S = 2.0
"""Between two moves, on a machine that does much else."""
NOTHING_ON_THE_WIRE = ("kill_simulator", "kill_supervisor", "restart_in_order")
"""The plant itself has gone: what a new one records is judged."""


class Scenario:
    """One robot, one fault, and what was found."""

    def __init__(self, drawn: Plan, folder: Path) -> None:
        self.plan = drawn
        self.folder = folder
        self.findings: list[str] = []
        self.figures: dict[str, float] = {}
        self.acknowledged: list[list[int]] = []

    def start(self) -> Supervised | Services:
        kind = Services if self.plan.fault in AS_SERVICES else Supervised
        return kind(self.folder)

    def prepare(self) -> None:
        faults.mount_disk(self.folder / "state", self.plan)
        if self.plan.fault == "clock_step":
            faults.prepare_clock(self.folder)

    # --- the fault and the stop ---

    def run(self) -> None:
        self.prepare()
        robot = self.start()
        try:
            bring_up(robot)
            clerk, mover = Clerk(robot, 1), Mover(robot)
            clerk.start()
            mover.start()
            wait_until_driven(robot, mover)
            pause = threading.Event()
            pause.wait(self.plan.instant_s)
            living = self.living(robot)
            await_motion(robot, LONGEST_REST_S)
            with contextlib.ExitStack() as lasting:
                # While ext4 is aborted it confirms writes that it then loses (docs/reliability.md).
                with (
                    clerk.between_writes if self.plan.fault == "read_only_disk" else contextlib.nullcontext()
                ):
                    lasting.enter_context(faults.FAULTS[self.plan.fault](robot, self.plan, self.folder))
                fault_tick = self.tick_of(robot)
                pause.wait(self.plan.lasts_s)
                self.meet(robot, fault_tick)
                clerk.end()
                mover.end()
            self.acknowledged = clerk.acknowledged
            self.look_at_processes(robot, living)
            robot = self.bring_up_again(robot)
            self.end(robot)
        finally:
            with contextlib.suppress(*BROKEN, subprocess.TimeoutExpired):
                robot.close()
        self.look_at_what_is_left()
        self.look_at_audit()

    def tick_of(self, robot: Supervised | Services) -> int:
        """Of the plant, right after the fault; 0 when it cannot say."""
        frozen = self.plan.fault in (*NOTHING_ON_THE_WIRE, "freeze_simulator")
        return 0 if frozen else robot.control("status")["tick"]

    def meet(self, robot: Supervised | Services, fault_tick: int) -> None:
        """The stop that follows the fault by itself, or that somebody demands while it lasts."""
        match self.plan.fault:
            case "kill_simulator" | "kill_supervisor" | "restart_in_order" | "freeze_simulator":
                return
            case "kill_kernel" | "freeze_kernel":
                self.meet_silence(robot)
            case "kill_app" | "freeze_app":
                record = self.record_until(robot, fault_tick + 2 * judge.APP_TIMEOUT_TICKS)
                self.figures["moving"] = judge.was_moving(record, fault_tick)
                self.figures["stop_ticks"] = judge.stop_ticks(record, fault_tick)
                limit = judge.APP_TIMEOUT_TICKS + judge.WIRE_TICKS
                self.findings += judge.driven_later_than(record, fault_tick, limit)
                self.findings += judge.driven_without_consent(record)
            case _:
                self.demand_stop(robot)

    def meet_silence(self, robot: Supervised | Services) -> None:
        """Without the kernel the cards are off by themselves."""

        def amplifiers_off() -> int | None:
            return robot.control("record_event", kind="amplifiers_off")["event_tick"]

        def last_exchange() -> dict:
            now = robot.control("status")["tick"]
            return robot.control("record", **{"from": max(0, now - 5000), "to": now})["entries"][-1]

        self.figures["moving"] = any(last_exchange()["amplifier"])
        if self.figures["moving"]:
            eventually("amplifiers off", lambda: (amplifiers_off() or 0) >= last_exchange()["tick"])
            last = last_exchange()["tick"]
            self.figures["stop_ticks"] = (amplifiers_off() or 0) - last
            self.findings += judge.amplifier_outlives_silence(last, amplifiers_off())
        self.ask_for_stop(robot)

    def ask_for_stop(self, robot: Supervised | Services) -> None:
        match self.plan.stop:
            case "pedal":
                robot.control("pedal", pressed=False)
            case "estop":
                robot.control("estop", pulled=True)
            case "request":
                visitor = robot.visitor()
                begun = time.monotonic()
                eventually("STOP is answered", lambda: visitor.post("/api/stop").status_code == 200)
                self.figures["stop_request_ms"] = round(1e3 * (time.monotonic() - begun), 1)

    def demand_stop(self, robot: Supervised | Services) -> None:
        """Pedal and E-stop act on the wire within their two ticks, a request once it is answered."""
        await_motion(robot, LONGEST_REST_S)
        before = robot.control("status")["tick"]
        self.ask_for_stop(robot)
        asked = robot.control("status")["tick"]
        record = self.record_until(robot, asked + SETTLED_TICKS)
        self.figures["moving"] = judge.was_moving(record, before)
        self.findings += judge.driven_without_consent(record)
        if self.plan.stop == "request":
            self.figures["stop_ticks"] = judge.stop_ticks(record, asked)
            self.findings += judge.driven_later_than(record, asked, judge.WIRE_TICKS)
        else:
            self.findings += self.later_than_edge(record)

    def later_than_edge(self, record: list[dict]) -> list[str]:
        """From the last exchange that consented."""
        edges = [one["tick"] for one in record if judge.consents(one)]
        if not edges:
            return ["the record has no exchange with the pedal pressed"]
        self.figures["stop_ticks"] = judge.stop_ticks(record, edges[-1])
        return judge.driven_later_than(record, edges[-1], judge.WIRE_TICKS)

    def record_until(self, robot: Supervised | Services, tick: int) -> list[dict]:
        """All that the plant has recorded since the robot began to move."""
        eventually(f"the plant is past tick {tick}", lambda: robot.control("status")["tick"] > tick)
        entries: list[dict] = []
        begin = 0
        while begin <= tick:
            answer = robot.control("record", **{"from": begin, "to": tick})
            entries += answer["entries"]
            if "next" not in answer:
                break
            begin = answer["next"]
        return entries

    # --- what is left ---

    def living(self, robot: Supervised | Services) -> dict[str, int]:
        return {name: robot.pid(name) for name in ("simulator", "recorder", "kernel", "app")}

    def look_at_processes(self, robot: Supervised | Services, before: dict[str, int]) -> None:
        """Only the process that was killed may be another one now, and the app that got no memory."""
        if self.plan.fault in ("kill_supervisor", "restart_in_order"):
            return
        killed = self.plan.fault.removeprefix("kill_")
        spared = "app" if self.plan.fault == "memory_limit" else killed
        for name, pid in before.items():
            if name != spared and robot.pid(name) != pid:
                self.findings.append(f"{name} ended by itself")
        eventually("no process is a zombie", lambda: not zombies())

    def bring_up_again(self, robot: Supervised | Services) -> Supervised | Services:
        begun = time.monotonic()
        if self.plan.fault == "kill_supervisor":
            if (code := robot.wait()) != -signal.SIGKILL:
                self.findings.append(f"interlock run ended with {code}; expected {-signal.SIGKILL}")
            robot.close()
            eventually("all processes have ended", lambda: not others())
            robot = self.start()
        elif self.plan.fault == "read_only_disk":
            self.expect_orderly_end(robot)
            faults.run("umount", robot.state)
            faults.attach_disk(robot.state)
            robot = self.start()
        elif self.plan.fault in NOTHING_ON_THE_WIRE:
            robot.connect_control_again()
        self.look_at_undemanded_drive(robot)
        bring_up(robot)
        mover = Mover(robot)
        mover.start()
        wait_until_driven(robot, mover)
        mover.end()
        self.figures["bring_up_s"] = round(time.monotonic() - begun, 2)
        clerk = Clerk(robot, 2)
        eventually("a change is acknowledged", lambda: clerk.write(robot))
        self.acknowledged += clerk.acknowledged
        return robot

    def look_at_undemanded_drive(self, robot: Supervised | Services) -> None:
        """Nothing moves by itself when a plant, a kernel or an app is there again without fresh consent."""
        now = robot.control("status")["tick"]
        record = self.record_until(robot, now)
        self.findings += judge.driven_without_consent(record)
        if self.plan.fault in NOTHING_ON_THE_WIRE:
            driven = judge.last_driven(record, -1)
            if driven is not None:
                self.findings.append(f"driven at tick {driven['tick']} before anybody asked for it")
        elif self.plan.fault == "freeze_simulator":
            gaps = judge.silences(record)
            longest = max(gaps, key=lambda gap: gap[1] - gap[0])
            self.figures["stop_ticks"] = judge.stop_ticks(record, longest[0])
            self.findings += judge.driven_later_than(record, longest[0], judge.WIRE_TICKS)

    def expect_orderly_end(self, robot: Supervised | Services) -> None:
        robot.control("pedal", pressed=False)
        if isinstance(robot, Services):
            robot.close()
            return
        robot.run.send_signal(signal.SIGINT)
        code = robot.wait()
        if code != 0:
            self.findings.append(f"interlock run ended with {code} when it was asked to; expected 0")
        robot.close()

    def end(self, robot: Supervised | Services) -> None:
        self.expect_orderly_end(robot)
        eventually("all processes have ended", lambda: not others())

    def look_at_what_is_left(self) -> None:
        self.findings += [f"process left: {name}" for name in others()]
        run = self.folder / "run"
        sockets = [path for path in run.rglob("*") if path.is_socket()]
        self.findings += [f"socket left: {path.relative_to(run)}" for path in sockets]

    def look_at_audit(self) -> None:
        state = self.folder / "state"
        with contextlib.closing(sqlite3.connect(f"file:{state / 'interlock.db'}?mode=ro", uri=True)) as store:
            rows = store.execute("SELECT detail FROM audit ORDER BY number").fetchall()
        details = [json.loads(row[0]) for row in rows]
        kept = [
            detail["new"]["target_point"] for detail in details if "target_point" in detail.get("new", {})
        ]
        self.findings += judge.lost_records(self.acknowledged, kept)
        self.figures["acknowledged"] = len(self.acknowledged)
        done = subprocess.run(
            [BIN / "interlock", "audit", "verify", "--state", state], capture_output=True, text=True
        )
        if done.returncode != 0:
            self.findings.append(f"the audit does not verify: {done.stderr.strip()}")


def state_of(process: Path) -> tuple[str, str, int]:
    """Name, state and parent of a process."""
    name, _, rest = (process / "stat").read_text().partition(" (")[2].rpartition(") ")
    fields = rest.split()
    return name, fields[0], int(fields[1])


def processes() -> dict[int, tuple[str, str, int]]:
    found = {}
    for process in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            found[int(process.name)] = state_of(process)
    return found


def zombies() -> list[str]:
    """Those whose parent has not asked for them. This process asks for what lost its own, as an init does."""
    for pid, (_, state, parent) in processes().items():
        if state == "Z" and parent == os.getpid():
            with contextlib.suppress(ChildProcessError):
                os.waitpid(pid, os.WNOHANG)
    return [name for name, state, _ in processes().values() if state == "Z"]


def others() -> list[str]:
    """Every process of this namespace but this one."""
    zombies()
    return [name for pid, (name, _, _) in processes().items() if pid != os.getpid()]


def outcome(seed: int, number: int, folder: Path) -> dict:
    drawn = plan(seed, number)
    begun = time.monotonic()
    scenario = Scenario(drawn, folder)
    skipped = drawn.fault == "read_only_disk" and not faults.is_root()
    if not skipped:
        try:
            scenario.run()
        except (*BROKEN, faults.FaultError, subprocess.SubprocessError) as error:
            scenario.findings.append(f"{type(error).__name__}: {error}")
    return {
        "number": number,
        "fault": drawn.fault,
        "skipped": skipped,
        "findings": scenario.findings,
        "figures": scenario.figures,
        "plan": dataclasses.asdict(drawn),
        "duration_s": round(time.monotonic() - begun, 2),
    }


if __name__ == "__main__":
    # Connections that break are what is looked for; nobody reads what the libraries say of them.
    logging.disable(logging.CRITICAL)
    print(json.dumps(outcome(int(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3]))), flush=True)
