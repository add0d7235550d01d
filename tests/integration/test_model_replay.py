"""The model asked about recordings: `interlock replay --model`."""

import re
import struct
import subprocess
import sys
from pathlib import Path

import pytest
from bare_kernel import BIN, ROOT
from motion import wait_until
from test_recorder import RecordedKernel, RecordedKernelFactory, interlock, recorded, unlock

__all__ = ["recorded"]

sys.path.append(str(ROOT / "verification/conformance"))

import traces
from recorded import told

TICKS = 300
YAW, PITCH, LATERAL = 0, 2, 4
"""Slots of the NeuroRobot."""
MOTION = 3
"""ilk_mode_t"""


@pytest.fixture
def recording(recorded: RecordedKernelFactory) -> Path:
    """An unlocked robot whose E-stop is pulled, from the kernel's first tick on."""
    kernel = recorded("--continuous")
    unlock(kernel)
    kernel.app.ask("ENABLE", axis=0)
    kernel.lock_by_estop()
    return ended(kernel)


@pytest.fixture
def moving(recorded: RecordedKernelFactory) -> Path:
    """One axis moves and another homes until the pedal is released; then a third one jumps."""
    kernel = recorded("--continuous")
    unlock(kernel)
    assert kernel.app.ask("SET_HOME", axis=LATERAL) == "ACCEPTED"
    for axis in (LATERAL, YAW, PITCH):
        assert kernel.app.ask("ENABLE", axis=axis) == "ACCEPTED"
    kernel.app.run(30)
    kernel.plant("pedal", pressed=True)
    wait_until("MOTION", lambda: kernel.app.run(5).state.mode == MOTION)
    assert kernel.app.ask("HOME", axis=YAW) == "ACCEPTED"
    move = {"axis": LATERAL, "target_counts": -200, "drive": 20_000, "lease_ticks": 100}
    assert kernel.app.ask("MOVE", **move) == "ACCEPTED"
    kernel.app.run(60)
    kernel.plant("pedal", pressed=False)
    kernel.app.run(10)
    kernel.plant("jump", slot=PITCH, counts=5000)
    kernel.app.run(10)
    return ended(kernel)


def ended(kernel: RecordedKernel) -> Path:
    """The recording of a kernel that goes on for some ticks and ends."""
    kernel.app.run(20)
    # A kernel that ends takes its black box along; a recorder that is late would find nothing.
    wait_until("the recorder has begun", lambda: any(kernel.recordings.glob("*")))
    kernel.kernel.terminate()
    kernel.kernel.wait()
    # Named for the lock, or as continuous: the recorder may come to see both at once.
    wait_until("a recording", lambda: any(kernel.recordings.glob("*.ilkr")))
    [file] = kernel.recordings.glob("*.ilkr")
    return file


def test_a_recording_is_told_in_parts_that_continue_each_other(recording: Path, tmp_path: Path) -> None:
    parts = told(BIN / "model_trace", recording, tmp_path, 50)
    assert [part.first_tick for part in parts] == [1 + 50 * number for number in range(len(parts))]
    assert len(parts) >= 2
    texts = [(part.folder / "TraceData.tla").read_text() for part in parts]
    assert "FromBoot == TRUE" in texts[0]
    assert "FromBoot == FALSE" in texts[1]
    last = texts[0].split("Trace == <<\n")[1].splitlines()[49]
    start = re.search(r"^Start == <<(.*)>>$", texts[1], re.MULTILINE)
    assert start is not None
    assert start[1] in last, "a part begins with the state that the one before ended with"


@pytest.mark.provers
def test_the_model_accepts_a_recorded_run_and_rejects_a_doctored_one(recording: Path, tmp_path: Path) -> None:
    [part, *_] = told(BIN / "model_trace", recording, tmp_path, TICKS)
    data = part.folder / "TraceData.tla"
    ticks = data.read_text().count("\n<<<<")
    assert traces.judge_in(part.folder) == (ticks, 0, "")
    lines = data.read_text().splitlines()
    first = next(number for number, line in enumerate(lines) if line.startswith("<<<<"))
    lines[first + 19] = re.sub(r'"LOCKED","BOOT"', '"READY","NONE"', lines[first + 19], count=1)
    data.write_text("\n".join(lines))
    assert traces.judge_in(part.folder)[1] == 20


@pytest.mark.provers
def test_the_model_accepts_a_move_a_homing_and_a_fault(moving: Path) -> None:
    done = interlock("replay", moving, "--model")
    assert done.returncode == 0, done.stdout + done.stderr
    assert re.search(r"identical\nthe model accepts all \d+ ticks\n$", done.stdout)


@pytest.mark.provers
def test_replay_asks_the_model_after_the_kernel(recording: Path) -> None:
    done = interlock("replay", recording, "--model")
    assert done.returncode == 0, done.stdout + done.stderr
    ticks = re.search(r"^(\d+) ticks \(1 to \1\)", done.stdout, re.MULTILINE)
    assert ticks is not None
    assert done.stdout.endswith(f"identical\nthe model accepts all {ticks[1]} ticks\n")


def test_a_file_that_is_no_recording_is_not_told(tmp_path: Path) -> None:
    file = tmp_path / "no.ilkr"
    file.write_bytes(struct.pack("<64I", *range(64)))
    done = subprocess.run([BIN / "model_trace", file, tmp_path, "10"], capture_output=True, text=True)
    assert done.returncode == 1
    assert "is no recording of this release" in done.stderr
