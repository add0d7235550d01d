"""The rung of the targets: what differs between two machines is told by the kernel's own names."""

import os
import subprocess
import sys
from pathlib import Path

TARGET = Path(__file__).resolve().parents[2] / "verification/target"
COMPARE = """
from dataclasses import replace
import told
from build import CORE, NATIVE, core_with
changed = replace(NATIVE, name="changed")
print(told.trace(2000, (NATIVE, changed), (CORE, core_with("P5_stall_cleared_by_move"))))
"""


def test_the_first_tick_that_differs_is_told_by_word_and_request() -> None:
    environment = os.environ | {"PYTHONPATH": str(TARGET)}
    command = [sys.executable, "-c", COMPARE]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    first, word = done.stdout.splitlines()[:2]
    assert first.startswith("the trace, tick ")
    assert ".stall_driven_ticks is " in word
    assert " on x86-64, " in word
    assert "(MOVE)" in done.stdout
