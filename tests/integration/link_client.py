"""An app made of a few lines: attaches to the kernel's link and writes whatever a test wants, good or bad."""

import array
import ctypes
import mmap
import os
import socket
import time
import zlib
from collections import Counter
from pathlib import Path

from link_layout import CONSTANTS, STRUCTURES, name_of

Request = STRUCTURES["ilk_request_t"]
Snapshot = STRUCTURES["ilk_snapshot_t"]
Hello = STRUCTURES["ilk_link_hello_t"]
KernelRegion = STRUCTURES["ilk_link_kernel_region_t"]
AppRegion = STRUCTURES["ilk_link_app_region_t"]
Event = STRUCTURES["ilk_event_t"]

RING = CONSTANTS["ILK_LINK_REQUESTS"]
EVENTS = CONSTANTS["ILK_LINK_EVENTS"]
TICKS_AHEAD = CONSTANTS["ILK_LINK_TICKS_AHEAD"]
DEADLINE_S = 300.0
"""Ends a run that hangs. What is waited for is an event, on a machine however busy."""
WORD = 2**32


def request_record(kind: str, sequence: int, **fields: int) -> ctypes.Structure:
    """A record with a correct CRC; `kind` is a name of the catalog."""
    record = Request(sequence=sequence, kind=CONSTANTS[f"ILK_REQUEST_{kind}"], **fields)
    record.crc = zlib.crc32(bytes(record)[: Request.crc.offset])
    return record


class LinkClient:
    """One attachment. With a kernel on the simulated clock, `run` decides how far simulated time goes.

    Unless `mapped`, the kernel does not serve it before `say_mapped`.
    """

    def __init__(self, path: Path, mapped: bool = True) -> None:
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self.socket.settimeout(DEADLINE_S)
        self.socket.connect(str(path))
        descriptors = array.array("i", [0, 0])
        data, ancillary, _, _ = self.socket.recvmsg(
            ctypes.sizeof(Hello), socket.CMSG_SPACE(len(descriptors) * descriptors.itemsize)
        )
        self.hello = Hello.from_buffer_copy(data)
        descriptors = array.array("i")
        descriptors.frombytes(ancillary[0][2])
        self.kernel_fd, self.app_fd = descriptors
        assert self.hello.kernel_region_bytes == ctypes.sizeof(KernelRegion)
        assert self.hello.app_region_bytes == ctypes.sizeof(AppRegion)
        self.kernel_map = mmap.mmap(self.kernel_fd, self.hello.kernel_region_bytes, prot=mmap.PROT_READ)
        self.app_map = mmap.mmap(self.app_fd, self.hello.app_region_bytes)
        self.app = AppRegion.from_buffer(self.app_map)
        self.sequence = 0
        self.events_read = 0
        self.verdicts: dict[int, str] = {}
        self.verdict_counts: Counter[str] = Counter()
        self.verdicts_of: Counter[int] = Counter()
        if mapped:
            self.say_mapped()
            self.app.seen_tick = self.snapshot().state.system.tick

    def say_mapped(self) -> None:
        """After this the kernel seals the app's region and begins to serve."""
        self.socket.send(CONSTANTS["ILK_LINK_MAGIC"].to_bytes(4, "little"))

    def close(self) -> None:
        del self.app
        self.app_map.close()
        self.kernel_map.close()
        self.socket.close()
        os.close(self.kernel_fd)
        os.close(self.app_fd)

    def _word(self, field: str) -> int:
        offset = getattr(KernelRegion, field).offset
        return int.from_bytes(self.kernel_map[offset : offset + 4], "little")

    def snapshot(self) -> ctypes.Structure:
        """The newest whole snapshot."""
        offset = KernelRegion.snapshot.offset
        deadline = time.monotonic() + DEADLINE_S
        while time.monotonic() < deadline:
            before = self._word("snapshot_lock")
            data = self.kernel_map[offset : offset + ctypes.sizeof(Snapshot)]
            if before % 2 == 0 and before != 0 and before == self._word("snapshot_lock"):
                return Snapshot.from_buffer_copy(data)
        raise TimeoutError("no whole snapshot: is the kernel running?")

    def write(self, *records: ctypes.Structure) -> None:
        """Puts records into the ring as they are, waiting for room."""
        for record in records:
            deadline = time.monotonic() + DEADLINE_S
            while (self.app.request_head - self._word("request_tail")) % WORD >= RING:
                if time.monotonic() > deadline:
                    raise TimeoutError("the kernel does not take requests")
            self.app.request[self.app.request_head % RING] = record
            self.app.request_head = (self.app.request_head + 1) % WORD

    def request(self, kind: str, **fields: int) -> int:
        """Writes a good record, MOVE and HOME for this press of the pedal; returns its sequence number."""
        self.sequence += 1
        if kind in ("MOVE", "HOME"):
            fields.setdefault("consent", self.snapshot().state.system.consent)
        self.write(request_record(kind, self.sequence, **fields))
        return self.sequence

    def run(self, ticks: int, heartbeat: bool = True) -> ctypes.Structure:
        """Lets the simulated clock go on by at least `ticks`, alive in between; returns the last snapshot."""
        end = self.snapshot().state.system.tick + ticks
        deadline = time.monotonic() + DEADLINE_S
        while True:
            snapshot = self.snapshot()
            self.read_events()
            if snapshot.state.system.tick >= end:
                return snapshot
            if time.monotonic() > deadline:
                raise TimeoutError(f"tick {snapshot.state.system.tick}, waiting for {end}")
            if heartbeat and snapshot.state.system.app_age_ticks > 20:
                self.request("HEARTBEAT", holder=1)
            self.app.seen_tick = min(snapshot.state.system.tick, max(0, end - TICKS_AHEAD))

    def ask(self, kind: str, **fields: int) -> str:
        """Writes a good record and runs until its verdict is there."""
        sequence = self.request(kind, **fields)
        deadline = time.monotonic() + DEADLINE_S
        while sequence not in self.verdicts:
            self.run(1)
            if time.monotonic() > deadline:
                raise TimeoutError(f"no verdict for {kind}")
        return self.verdicts[sequence]

    def ask_at_rest(self, kind: str, **fields: int) -> None:
        """Asks until the axis is at rest and its power up, as ENABLE and SET_HOME want it."""
        deadline = time.monotonic() + DEADLINE_S
        while (verdict := self.ask(kind, **fields)) != "ACCEPTED":
            assert verdict == "BUSY", f"{kind}: {verdict}"
            if time.monotonic() > deadline:
                raise TimeoutError(f"{kind}: the axis does not come to rest")

    def read_events(self) -> list[ctypes.Structure]:
        """Events since the last call; verdicts are also kept by sequence number, and counted."""
        head = self._word("event_head")
        events = []
        for number in range(max(self.events_read, head - EVENTS) + 1, head + 1):
            offset = KernelRegion.event.offset + ((number - 1) % EVENTS) * ctypes.sizeof(Event)
            event = Event.from_buffer_copy(self.kernel_map[offset : offset + ctypes.sizeof(Event)])
            if event.number == number:
                events.append(event)
                if event.kind == CONSTANTS["ILK_EVENT_VERDICT"]:
                    verdict = name_of("ILK_VERDICT", event.value[3])
                    self.verdicts[event.value[0]] = verdict
                    self.verdict_counts[verdict] += 1
                    self.verdicts_of[event.value[0]] += 1
        self.events_read = head
        return events
