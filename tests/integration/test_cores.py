"""The kernel's core is the kernel's alone (design: the app's threads keep off it)."""

import os
import re
import subprocess
from pathlib import Path

from bare_kernel import BIN
from stack import Stack


def cores_of(status: Path) -> set[int]:
    """The cores on which a thread may run."""
    listed = re.search(r"^Cpus_allowed_list:\s*(\S+)", status.read_text(), re.MULTILINE)
    assert listed
    cores: set[int] = set()
    for part in listed[1].split(","):
        first, _, last = part.partition("-")
        cores |= set(range(int(first), int(last or first) + 1))
    return cores


def test_no_thread_of_app_or_simulator_runs_on_the_kernels_core(short_tmp_path: Path) -> None:
    core = max(os.sched_getaffinity(0))
    started = Stack(short_tmp_path, "--realtime", "--core", str(core))
    try:
        assert cores_of(Path(f"/proc/{started.pid('kernel')}/status")) == {core}
        for name in ("app", "simulator"):
            threads = list(Path(f"/proc/{started.pid(name)}/task").glob("*/status"))
            assert threads
            assert all(core not in cores_of(thread) for thread in threads), name
    finally:
        started.close()


def test_a_core_that_is_not_there_is_refused_and_nothing_starts(short_tmp_path: Path) -> None:
    answer = subprocess.run(
        [BIN / "interlock", "run", "--core", "4095", "--port", "0", "--state", short_tmp_path / "state"],
        capture_output=True,
        text=True,
    )
    assert answer.returncode != 0
    assert "--core 4095" in answer.stderr
    assert "expected" in answer.stderr
    assert not (short_tmp_path / "state").exists()
