"""Freezes one thread of a program and leaves the others running, as a lock, a disk or a bug may."""

import contextlib
import ctypes
import os
from collections.abc import Iterator
from pathlib import Path

SEIZE, INTERRUPT, DETACH = 0x4206, 0x4207, 17
ALL_THREADS = 0x40000000

libc = ctypes.CDLL(None, use_errno=True)
libc.ptrace.argtypes = [ctypes.c_long, ctypes.c_long, ctypes.c_void_p, ctypes.c_void_p]
libc.ptrace.restype = ctypes.c_long


def ptrace(request: int, thread: int) -> None:
    if libc.ptrace(request, thread, None, None) != 0:
        error = ctypes.get_errno()
        raise OSError(error, f"ptrace {request:#x} of thread {thread}: {os.strerror(error)}")


def thread_of(process: int, name: str) -> int:
    """The thread of that name; the app's "network" is its first, which bears the name of the program."""
    if name == "network":
        return process
    for task in Path(f"/proc/{process}/task").iterdir():
        if (task / "comm").read_text().strip() == name:
            return int(task.name)
    raise AssertionError(f"process {process} has no thread {name}")


@contextlib.contextmanager
def frozen(process: int, name: str) -> Iterator[None]:
    """That thread stands still meanwhile. It may die with its process."""
    thread = thread_of(process, name)
    ptrace(SEIZE, thread)
    ptrace(INTERRUPT, thread)
    os.waitpid(thread, ALL_THREADS)
    try:
        yield
    finally:
        try:
            ptrace(DETACH, thread)
        except ProcessLookupError:
            # Of a thread that died whoever froze it is told first; until then its parent waits.
            os.waitpid(thread, ALL_THREADS)
