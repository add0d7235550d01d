"""A host that is late: simulated time waits for the simulator and for the app, and no fault comes of it.

An app that is frozen is waited for no longer than 2 s: then the kernel goes on without it, as P10 says.
"""

import contextlib
import os
import re
import signal
import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from bare_kernel import BareKernel, bare_kernel, mode, stop
from bare_kernel import to_motion as to_motion_by_link
from conftest import StackFactory
from link_client import TICKS_AHEAD, LinkClient
from link_layout import name_of
from motion import (
    LATERAL,
    enable,
    is_driven,
    press,
    propose,
    record,
    to_motion,
    wait_for_proposal,
    wait_until,
)
from stack import Stack

APP_TIMEOUT_TICKS = 100
WIRE_TICKS = 2
FAR = -1500
NEAR = -150
SHARE = 0.05
PERIOD_S = 0.1
"""Of the processor's time: a share of each period, and nothing of the rest."""
STARVED_S = 120.0
"""Ends a run that hangs, at a share of a loaded machine."""
CGROUP = Path("/sys/fs/cgroup")
SIMULATED = pytest.mark.parametrize("speed", [0, 1], ids=["sim", "paced"])


@contextlib.contextmanager
def limited(pid: int) -> Iterator[None]:
    """Gives the process a share of one core, by a control group where this user may make one."""
    legacy = (CGROUP / "cpu/cgroup.procs").exists()
    own = re.search(r"^\d+:(?:cpu|cpu,cpuacct)?:(.*)$", Path(f"/proc/{pid}/cgroup").read_text(), re.MULTILINE)
    home = (CGROUP / "cpu" if legacy else CGROUP) / (own[1].lstrip("/") if own else "")
    group = home / f"interlock-test-{pid}"
    period, quota = int(PERIOD_S * 1e6), int(SHARE * PERIOD_S * 1e6)
    try:
        group.mkdir()
        if legacy:
            (group / "cpu.cfs_period_us").write_text(str(period))
            (group / "cpu.cfs_quota_us").write_text(str(quota))
        else:
            (group / "cpu.max").write_text(f"{quota} {period}")
        (group / "cgroup.procs").write_text(str(pid))
    except OSError:
        with contextlib.suppress(OSError):
            group.rmdir()
        with stopped_now_and_then(pid):
            yield
        return
    try:
        yield
    finally:
        (home / "cgroup.procs").write_text(str(pid))
        group.rmdir()


@contextlib.contextmanager
def stopped_now_and_then(pid: int) -> Iterator[None]:
    ended = threading.Event()

    def starve() -> None:
        while not ended.is_set():
            os.kill(pid, signal.SIGSTOP)
            ended.wait((1 - SHARE) * PERIOD_S)
            os.kill(pid, signal.SIGCONT)
            ended.wait(SHARE * PERIOD_S)

    starver = threading.Thread(target=starve)
    starver.start()
    try:
        yield
    finally:
        ended.set()
        starver.join()


Starve = Callable[[int], contextlib.AbstractContextManager[None]]


@contextlib.contextmanager
def frozen(process: int) -> Iterator[None]:
    os.kill(process, signal.SIGSTOP)
    try:
        yield
    finally:
        os.kill(process, signal.SIGCONT)


def moving(robot: Stack, target_counts: int) -> int:
    to_motion(robot)
    number = propose(robot, target_counts)
    wait_until("driven", lambda: is_driven(robot))
    return number


def assert_no_fault(robot: Stack) -> None:
    status = robot.status()
    assert status["mode"] in ("READY", "MOTION"), (status["mode"], status["cause"])
    assert status["overruns"] == 0
    assert {axis["fault"] for axis in robot.api.get("/api/motors").raise_for_status().json()} == {"NONE"}
    assert all(card["detected"] for card in status["cards"] if card["card"] != "NONE")


@SIMULATED
def test_P10_an_app_that_is_frozen_for_5_s_loses_its_motion_and_nothing_else(
    stack: StackFactory, speed: float
) -> None:
    robot = stack(speed=speed)
    number = moving(robot, FAR)
    app = robot.pid("app")
    with frozen(app):
        stopped = robot.control("status")["tick"]
        # The kernel waits two seconds, then goes on at real pace: five in all; its watchdog waits ten.
        entries = record(robot, stopped, stopped + 3000)
    limit = stopped + TICKS_AHEAD + APP_TIMEOUT_TICKS + WIRE_TICKS
    assert not [entry["tick"] for entry in entries if entry["tick"] > limit and any(entry["drive"])]
    received = robot.control("status")["tick"]
    wait_until("app received", lambda: robot.status()["app_alive"] and robot.status()["tick"] > received)
    assert robot.status()["mode"] == "READY"
    assert robot.pid("app") == app
    assert_no_fault(robot)
    press(robot)
    wait_for_proposal(robot, number, "done")


@SIMULATED
@pytest.mark.parametrize("starve", [limited, stopped_now_and_then])
def test_an_app_with_a_twentieth_of_a_core_is_waited_for(
    stack: StackFactory, speed: float, starve: Starve
) -> None:
    robot = stack(speed=speed)
    to_motion(robot)
    with starve(robot.pid("app")):
        number = propose(robot, NEAR)
        enable(robot)
        wait_for_proposal(robot, number, "done", STARVED_S)
        assert robot.status()["mode"] == "MOTION"
        robot.control("pedal", pressed=False)
        wait_until("pedal seen", lambda: robot.status()["mode"] == "READY", STARVED_S)
    assert_no_fault(robot)


def test_a_simulator_that_is_frozen_for_5_s_is_waited_for_and_the_host_is_said_to_be_late(
    stack: StackFactory,
) -> None:
    robot = stack(speed=1)
    number = moving(robot, FAR)
    with frozen(robot.pid("simulator")):
        wait_until("late", lambda: robot.status()["host_late"]["now_ms"] > 5000)
        tick = robot.status()["tick"]
        assert robot.status()["tick"] == tick
    wait_for_proposal(robot, number, "done")
    late = robot.status()["host_late"]
    assert late["worst_ms"] >= 5000
    assert late["total_ms"] >= late["worst_ms"] - 1
    assert robot.status()["mode"] == "MOTION"
    assert_no_fault(robot)


@pytest.mark.parametrize("clock", ["sim", "paced"])
def test_each_request_has_one_verdict_when_its_app_was_not_scheduled(clock: str) -> None:
    with bare_kernel(clock) as kernel:
        client = kernel.attach()
        to_motion_by_link(kernel, client, LATERAL)
        kinds = ("HEARTBEAT", "ENABLE", "MOVE", "STOP", "ENABLE", "HEARTBEAT", "MOVE", "DISABLE")
        requests = [client.request(kind, axis=LATERAL, target_counts=-900, lease_ticks=50) for kind in kinds]
        begun = client.snapshot().state.system.tick
        wait_until("given up", lambda: client.snapshot().state.system.tick > begun + 5 * APP_TIMEOUT_TICKS)
        client.read_events()
        assert [client.verdicts_of[request] for request in requests] == [1] * len(requests)
        assert mode(client) == "READY"
        client.close()


def waits(kernel: BareKernel, client: LinkClient) -> None:
    """Until the kernel waits for what was just frozen."""
    seen = -1
    while seen != (seen := client.snapshot().state.system.tick):
        client.app.seen_tick = seen
        threading.Event().wait(0.1)


def test_a_simulator_that_dies_while_it_is_waited_for_is_a_lost_bus_at_once() -> None:
    with bare_kernel("paced") as kernel:
        client = kernel.attach()
        to_motion_by_link(kernel, client, LATERAL)
        kernel.sim.send_signal(signal.SIGSTOP)
        waits(kernel, client)
        assert mode(client) == "MOTION"
        kernel.sim.kill()
        client.run(20)
        assert mode(client) == "LOCKED"
        assert name_of("ILK_CAUSE", client.snapshot().state.system.cause) == "BUS"
        client.close()


@pytest.mark.parametrize("clock", ["sim", "paced"])
def test_a_kernel_that_waits_for_a_frozen_simulator_ends_when_it_is_told_to(clock: str) -> None:
    with bare_kernel(clock) as kernel:
        client = kernel.attach()
        client.run(30)
        with frozen(kernel.sim.pid):
            waits(kernel, client)
            assert stop(kernel.kernel) == 0
        client.close()
