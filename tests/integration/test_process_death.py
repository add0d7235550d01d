"""Processes that die or freeze in the middle of a move, on the wall clock."""

import os
import signal
from pathlib import Path

import pytest
from bare_kernel import PlantControl, bare_kernel
from bare_kernel import to_motion as to_motion_by_link
from conftest import StackFactory
from motion import LATERAL, is_driven, propose, record, to_motion, wait_until
from stack import Stack

APP_TIMEOUT_TICKS = 100
WIRE_TICKS = 2
CARD_WATCHDOG_TICKS = 5


def moving(stack: StackFactory) -> Stack:
    robot = stack(realtime=True)
    to_motion(robot)
    propose(robot, -900)
    wait_until("driven", lambda: is_driven(robot))
    return robot


def last_driven_tick(control: PlantControl) -> int | None:
    return control("record_event", kind="last_nonzero_drive")["event_tick"]


def amplifiers_off_tick(control: PlantControl) -> int | None:
    return control("record_event", kind="amplifiers_off")["event_tick"]


def stands(process: int) -> bool:
    """A signal takes effect thread by thread."""
    stats = Path(f"/proc/{process}/task").glob("*/stat")
    try:
        return all(each.read_text().rpartition(")")[2].split()[0] in "TZX" for each in stats)
    except (FileNotFoundError, ProcessLookupError):
        return False


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGSTOP])
def test_P10_without_its_app_the_kernel_zeroes_the_drives_within_the_app_timeout(
    stack: StackFactory, number: signal.Signals
) -> None:
    robot = moving(stack)
    kernel, app = robot.pid("kernel"), robot.pid("app")
    before = robot.control("status")["tick"]
    os.kill(app, number)
    wait_until("no thread of it runs", lambda: stands(app))
    after = robot.control("status")["tick"]
    record(robot, after, after + 3 * APP_TIMEOUT_TICKS)
    assert before <= (last_driven_tick(robot.control) or 0) <= after + APP_TIMEOUT_TICKS + WIRE_TICKS
    if number == signal.SIGSTOP:
        os.kill(app, signal.SIGCONT)
    else:
        robot.output.wait_for(r"^ready http", count=2)
    wait_until("served again", lambda: robot.status()["app_alive"])
    # What an app tells first that goes on may be what it knew when it was stopped.
    told = robot.status()["tick"]
    wait_until("heard anew", lambda: robot.status()["tick"] > told)
    assert robot.pid("kernel") == kernel
    assert robot.status()["mode"] == "READY"


def test_a_dead_kernel_leaves_the_cards_off_within_their_watchdog() -> None:
    with bare_kernel(clock="real") as robot:
        client = robot.attach()
        to_motion_by_link(robot, client, LATERAL)
        client.request("MOVE", axis=LATERAL, target_counts=-1000, drive=131_071, lease_ticks=100)
        wait_until("driven on the wire", lambda: last_driven_tick(robot.plant) is not None)
        robot.kernel.kill()
        wait_until("amplifiers off", lambda: amplifiers_off_tick(robot.plant) is not None)
        last_driven, off = last_driven_tick(robot.plant), amplifiers_off_tick(robot.plant)
        assert last_driven is not None
        assert off is not None
        assert 0 <= off - last_driven <= CARD_WATCHDOG_TICKS
        client.close()
