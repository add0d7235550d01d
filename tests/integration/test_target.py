"""The rung of the targets: what differs between two machines is told by the kernel's own names."""

import sys
from dataclasses import replace
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "verification/target"))

import told

from build import CORE, NATIVE, core_with

CHANGED = replace(NATIVE, name="changed")


def test_the_first_tick_that_differs_is_told_by_word_and_request() -> None:
    changed = core_with("P5_stall_cleared_by_move")
    text = told.trace(2000, (NATIVE, CHANGED), (CORE, changed))
    assert text.startswith("the trace, tick ")
    assert ".stall_driven_ticks is " in text.splitlines()[1]
    assert "(MOVE)" in text
    assert "on x86-64, " in text.splitlines()[1]
