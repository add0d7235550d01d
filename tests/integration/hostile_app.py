"""The worst that an app can do with what the link hands it: two descriptors, a mapping, a ring, a socket."""

import contextlib
import ctypes
import fcntl
import mmap
import os
import random
from collections.abc import Callable
from pathlib import Path

from link_client import RING, AppRegion, LinkClient, Request

PUNCH_HOLE_KEEP_SIZE = 0x03
MADV_REMOVE = 9
SIZE = ctypes.sizeof(AppRegion)
LIBC = ctypes.CDLL(None, use_errno=True)


def punch_hole(descriptor: int) -> None:
    """Takes every page out of the app's region."""
    if LIBC.fallocate(descriptor, PUNCH_HOLE_KEEP_SIZE, ctypes.c_long(0), ctypes.c_long(SIZE)) != 0:
        raise OSError(ctypes.get_errno(), "fallocate")


def map_reopened(descriptor: int, size: int) -> None:
    """Opens the same memory anew for writing and maps it; either step may be refused."""
    reopened = os.open(f"/proc/self/fd/{descriptor}", os.O_RDWR)
    try:
        mmap.mmap(reopened, size, prot=mmap.PROT_READ | mmap.PROT_WRITE)
    finally:
        os.close(reopened)


def must_be_refused(act: Callable[[], object]) -> None:
    try:
        act()
    except PermissionError:
        return
    raise AssertionError("an act on the app's region was not refused")


def attach_after_worst(path: Path) -> LinkClient:
    """Seals its region before the kernel can, for which it is turned away; then takes the pages out of the
    next one before it says that it mapped it. Returns when that one is served, and so sealed."""
    with contextlib.closing(LinkClient(path, mapped=False)) as sealed:
        fcntl.fcntl(sealed.app_fd, fcntl.F_ADD_SEALS, fcntl.F_SEAL_SEAL)
        sealed.say_mapped()
        assert sealed.socket.recv(1) == b"", "the kernel serves a region that it could not seal"
    client = LinkClient(path, mapped=False)
    punch_hole(client.app_fd)
    client.say_mapped()
    client.snapshot()
    return client


def do_worst(client: LinkClient, dice: random.Random) -> None:
    """Tries to take memory away, holds a lock, lies about both counters and floods the ring with noise."""
    for act in (
        lambda: punch_hole(client.app_fd),
        lambda: os.ftruncate(client.app_fd, 0),
        lambda: os.pwrite(client.app_fd, b"\0", 0),
        lambda: client.app_map.madvise(MADV_REMOVE),
        lambda: fcntl.fcntl(client.app_fd, fcntl.F_ADD_SEALS, fcntl.F_SEAL_WRITE),
        lambda: map_reopened(client.app_fd, SIZE),
    ):
        must_be_refused(act)
    fcntl.flock(client.app_fd, fcntl.LOCK_EX)
    client.app.seen_tick = dice.getrandbits(32)
    client.app.request_head = dice.getrandbits(32)
    for _ in range(RING):
        client.write(Request.from_buffer_copy(dice.randbytes(ctypes.sizeof(Request))))
