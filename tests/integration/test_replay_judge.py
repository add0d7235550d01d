"""`interlock replay --judge`: every monitor judges what was recorded, a whole run or one from its middle."""

import ctypes
import re
from collections.abc import Callable
from pathlib import Path

from bare_kernel import mode, stop
from link_layout import CONSTANTS
from motion import wait_until
from test_recorder import RecordedKernel, RecordedKernelFactory, interlock, recorded

__all__ = ["recorded"]

INSERTION = 3
"""Its switch is at the lower end."""
UNHOMED_DRIVE, FULL_DRIVE = 13_107, 0x1FFFF


def accepted_ticks(file: Path) -> tuple[int, int]:
    """First and last tick of a recording that every monitor has to accept."""
    done = interlock("replay", file, "--judge")
    assert done.returncode == 0, done.stdout + done.stderr
    span = re.search(r"^(\d+) ticks \((\d+) to (\d+)\)", done.stdout, re.MULTILINE)
    assert span is not None, done.stdout
    assert int(span[1]) == int(span[3]) - int(span[2]) + 1
    assert done.stdout.endswith(f"identical\n18 monitors accept {span[1]} ticks\n")
    return int(span[2]), int(span[3])


class Run:
    """A normal run, step by step, as an app and a hand at the pedal make it."""

    def __init__(self, kernel: RecordedKernel) -> None:
        self.kernel = kernel
        self.app = kernel.app

    def axis(self) -> ctypes.Structure:
        return self.app.snapshot().state.axis[INSERTION]

    def until(self, what: str, condition: Callable[[], bool]) -> None:
        def is_met() -> bool:
            self.app.run(5)
            return condition()

        wait_until(what, is_met)

    def accepted(self, kind: str) -> None:
        """Asks until nothing stands against it: the axis rests, its power is up, a contact is settled."""
        self.until(kind, lambda: self.app.ask(kind, axis=INSERTION) == "ACCEPTED")

    def press(self) -> None:
        self.kernel.plant("pedal", pressed=False)
        self.until("armed", lambda: self.app.snapshot().state.system.pedal_armed == 1)
        self.kernel.plant("pedal", pressed=True)
        self.until("MOTION", lambda: mode(self.app) == "MOTION")

    def home(self) -> None:
        assert self.app.ask("HOME", axis=INSERTION) == "ACCEPTED"
        self.until("homed", lambda: self.axis().homed == CONSTANTS["ILK_HOMED_BY_SWITCH"])

    def order(self, target: int, drive: int) -> bool:
        """A MOVE; whether the axis is there."""
        fields = {"axis": INSERTION, "target_counts": target, "drive": drive, "lease_ticks": 100}
        assert self.app.ask("MOVE", **fields) == "ACCEPTED"
        return abs(self.axis().position_counts - target) <= 1

    def move(self, target: int) -> None:
        self.until("there", lambda: self.order(target, FULL_DRIVE))

    def push_at_the_switch(self) -> None:
        """While it moves towards its switch, that closes: drive must end."""
        self.order(self.axis().position_counts - 30, UNHOMED_DRIVE)
        self.until("driven", lambda: self.axis().driven_direction != 0)
        self.kernel.plant("switch", slot=INSERTION, state="triggered")
        self.until("at the switch", lambda: self.axis().switch_triggered == 1)
        self.app.run(20)
        self.kernel.plant("switch", slot=INSERTION, state="normal")

    def fault(self) -> None:
        """The encoder jumps; the fault is cleared once the axis rests."""
        self.kernel.plant("jump", slot=INSERTION, counts=500)
        self.until("faulted", lambda: self.axis().fault == CONSTANTS["ILK_FAULT_JUMP"])
        self.kernel.plant("pedal", pressed=False)
        self.accepted("CLEAR_FAULT")

    def estop(self) -> None:
        self.kernel.lock_by_estop()
        self.kernel.plant("pedal", pressed=False)
        self.kernel.plant("estop", pulled=False)
        self.accepted("RESET")

    def begin(self) -> None:
        self.accepted("RESET")
        self.accepted("ENABLE")
        self.press()


def test_a_run_with_moves_homing_faults_and_estop_is_accepted_tick_by_tick(
    recorded: RecordedKernelFactory,
) -> None:
    kernel = recorded("--continuous")
    run = Run(kernel)
    run.begin()
    run.home()
    run.move(400)
    run.move(150)
    run.fault()
    run.accepted("ENABLE")
    run.press()
    run.order(run.axis().position_counts + 30, UNHOMED_DRIVE)
    run.estop()
    run.app.run(2100)
    last = run.app.snapshot().state.system.tick
    assert stop(kernel.kernel) == 0
    file = kernel.wait_for_file("continuous")
    first, end = accepted_ticks(file)
    assert first == 1
    assert end >= last


def test_a_recording_that_begins_in_the_middle_of_homing_is_accepted(
    recorded: RecordedKernelFactory,
) -> None:
    kernel = recorded()
    run = Run(kernel)
    run.begin()
    begun = run.app.snapshot().state.system.tick
    run.home()
    homed = run.app.snapshot().state.system.tick
    file = kernel.folder / "now.ilkr"
    done = interlock("record", "--black-box", kernel.black_box, "--seconds", "1", "-o", file)
    assert done.returncode == 0, done.stderr
    first, last = accepted_ticks(file)
    assert begun < first < homed - 100
    assert last >= homed


def test_drive_into_a_closing_switch_ends_as_the_monitors_demand(recorded: RecordedKernelFactory) -> None:
    """The seeded fault replay_judges_a_patched_kernel lets the gate drive on."""
    kernel = recorded("--continuous")
    run = Run(kernel)
    run.begin()
    run.push_at_the_switch()
    assert stop(kernel.kernel) == 0
    accepted_ticks(kernel.wait_for_file("continuous"))
