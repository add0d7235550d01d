"""What an app can do at worst: real processes, the app's side of the link in the test's hands."""

import ctypes
import mmap
import os
import random
from collections.abc import Iterator
from pathlib import Path

import pytest
from bare_kernel import BareKernel, bare_kernel, mode, to_motion
from hostile_app import attach_after_worst, do_worst, map_reopened
from link_client import AppRegion, KernelRegion, Request, request_record
from link_layout import CONSTANTS, name_of

LATERAL = 4
FULL_DRIVE = 131_071
STALL_BOUNDS = pytest.mark.parametrize(("drive", "stall_ticks"), [(FULL_DRIVE, 68), (10_000, 500)])
"""By effort at full drive, by driven time at a low one, as the robot's file says."""


@pytest.fixture
def kernel() -> Iterator[BareKernel]:
    with bare_kernel() as running:
        yield running


@STALL_BOUNDS
def test_P5_dropping_the_drive_before_each_stall_still_stalls_at_as_many_driven_ticks(
    kernel: BareKernel, drive: int, stall_ticks: int
) -> None:
    client = kernel.attach()
    to_motion(kernel, client, LATERAL)
    kernel.plant("jam", slot=LATERAL, jammed=True)
    client.run(50)
    driven = 0
    while client.snapshot().state.axis[LATERAL].state != CONSTANTS["ILK_AXIS_FAULTED"]:
        assert driven < 2 * stall_ticks, "driven twice as long as a stall may take"
        if driven % (stall_ticks - 1) == stall_ticks - 2:
            assert client.ask("DISABLE", axis=LATERAL) == "ACCEPTED"
            client.ask_at_rest("ENABLE", axis=LATERAL)
        client.request("MOVE", axis=LATERAL, target_counts=-1000, drive=drive, lease_ticks=1)
        driven += client.run(1).gate[LATERAL] == CONSTANTS["ILK_GATE_OPEN"]
    axis = client.snapshot().state.axis[LATERAL]
    assert name_of("ILK_FAULT", axis.fault) == "STALL"
    record = kernel.plant("record", **{"from": 0, "to": client.snapshot().state.system.tick})["entries"]
    driven_on_the_wire = sum(entry["drive"][LATERAL] != 0 for entry in record)
    assert driven_on_the_wire == stall_ticks
    client.close()


def test_P11_ten_thousand_random_and_malformed_records_are_each_refused(kernel: BareKernel) -> None:
    """Random words, and good records spoiled in one word: none is accepted, nothing crashes."""
    seed = 20_181
    dice = random.Random(seed)
    client = kernel.attach()
    before = client.run(5, heartbeat=False).state.system
    sent = 0
    while sent < 10_000:
        batch = []
        for _ in range(dice.randint(1, 40)):
            if dice.random() < 0.5:
                record = Request.from_buffer_copy(dice.randbytes(ctypes.sizeof(Request)))
            else:
                record = request_record("MOVE", dice.getrandbits(32), axis=dice.getrandbits(4))
                spoiled = dice.choice([name for name, _ in Request._fields_])
                setattr(record, spoiled, getattr(record, spoiled) ^ (1 << dice.randrange(31)))
            batch.append(record)
        for record in batch:
            client.write(record)
        client.run(4, heartbeat=False)
        sent += len(batch)
    after = client.run(5, heartbeat=False).state.system
    assert after.requests_accepted == before.requests_accepted
    assert after.requests_refused - before.requests_refused == sent
    assert client.verdict_counts.total() == sent
    assert client.verdict_counts["ACCEPTED"] == 0
    assert mode(client) == "LOCKED"
    assert kernel.kernel.poll() is None
    client.close()


def test_a_ring_head_from_nowhere_loses_requests_but_nothing_else(kernel: BareKernel) -> None:
    client = kernel.attach()
    to_motion(kernel, client, LATERAL)
    client.app.request_head = 0x7FFF_0000
    snapshot = client.run(300, heartbeat=False)
    assert snapshot.requests_dropped > 0
    assert mode(client) == "READY"
    assert all(command.drive == 0 for command in snapshot.command)
    client.close()


def test_the_app_cannot_map_the_snapshot_for_writing(kernel: BareKernel) -> None:
    client = kernel.attach()
    size = ctypes.sizeof(KernelRegion)
    with pytest.raises(PermissionError):
        mmap.mmap(client.kernel_fd, size, prot=mmap.PROT_READ | mmap.PROT_WRITE)
    with pytest.raises(PermissionError):
        os.pwrite(client.kernel_fd, b"\0", 0)
    with pytest.raises(OSError, match="not permitted"):
        os.ftruncate(client.kernel_fd, 0)
    with pytest.raises(PermissionError):
        map_reopened(client.kernel_fd, size)
    client.close()


def page_faults(pid: int) -> int:
    """Of the first thread of a process, which runs the loop: minor and major ones since its start."""
    fields = Path(f"/proc/{pid}/task/{pid}/stat").read_text("ascii").rpartition(")")[2].split()
    return int(fields[7]) + int(fields[9])


@pytest.mark.network
def test_nothing_that_the_app_does_costs_a_real_time_loop_a_page_fault() -> None:
    """From the kernel's `ready` to the end of the run. Needs CAP_SYS_NICE and CAP_IPC_LOCK."""
    dice = random.Random(20_181)
    with bare_kernel("real", priority=True) as kernel:
        before = page_faults(kernel.kernel.pid)
        for _ in range(5):
            client = attach_after_worst(kernel.link_path)
            granted = client.run(5).granted
            assert granted & (1 << CONSTANTS["ILK_RT_FIFO"]), "SCHED_FIFO was refused"
            assert granted & (1 << CONSTANTS["ILK_RT_MLOCK"]), "locked memory was refused"
            for _ in range(50):
                do_worst(client, dice)
            assert client.run(20).requests_dropped > 0
            client.close()
        assert page_faults(kernel.kernel.pid) == before
        assert kernel.kernel.poll() is None


def test_P10_an_app_that_only_renews_its_lease_without_heartbeat_is_silent(kernel: BareKernel) -> None:
    client = kernel.attach()
    to_motion(kernel, client, LATERAL)
    start = client.snapshot().state.system.tick
    while mode(client) == "MOTION":
        client.request("MOVE", axis=LATERAL, target_counts=-1000, drive=20_000, lease_ticks=50)
        snapshot = client.run(1, heartbeat=False)
        assert snapshot.state.system.tick - start < 200
    assert snapshot.state.system.app_age_ticks >= 100
    client.close()


def test_each_attachment_starts_a_generation_of_its_own(kernel: BareKernel) -> None:
    first = kernel.attach()
    first.run(5)
    generation = first.hello.generation
    first.close()
    second = kernel.attach()
    second.run(5)
    assert second.hello.generation == generation + 1
    assert second.snapshot().state.system.link_generation == generation + 1
    assert second.ask("HEARTBEAT", holder=1) == "ACCEPTED"
    assert ctypes.sizeof(AppRegion) == second.hello.app_region_bytes
    second.close()
