"""Programs that get so many seconds, and leave nothing behind when these are over."""

import contextlib
import os
import signal
import subprocess
from collections.abc import Sequence
from pathlib import Path


def output_of(command: Sequence[str], seconds: float, cwd: Path | None = None) -> str | None:
    """What the command writes to its standard output; nothing when it does not end in time.

    Then all that it started dies with it: a prover asked by another program goes on without it.
    """
    process = subprocess.Popen(
        command,
        cwd=cwd,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        start_new_session=True,
    )
    try:
        return process.communicate(timeout=seconds)[0]
    except subprocess.TimeoutExpired:
        return None
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
