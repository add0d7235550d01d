"""The black box with real processes: what each kill leaves, and what a replay says of it."""

import os
import re
import signal
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from bare_kernel import BIN, DEADLINE_S, ROOT, PlantControl, options, start, stop
from conftest import StackFactory
from link_client import LinkClient
from motion import wait_until
from stack import Stack, has_ended, watched

INTERLOCK = BIN / "interlock"


def interlock(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    command = [str(INTERLOCK), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=DEADLINE_S)


def replayed_ticks(file: Path) -> tuple[int, int]:
    """First and last tick of a recording that has to be identical."""
    done = interlock("replay", file)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.endswith("identical\n")
    span = re.search(r"ticks \((\d+) to (\d+)\)", done.stdout)
    assert span is not None, done.stdout
    return int(span[1]), int(span[2])


class RecordedKernel:
    """Plant, recorder and kernel as real processes, with a short black box; the test is the app."""

    def __init__(self, folder: Path, *recorder: str, clock: str = "sim") -> None:
        self.folder = folder
        self.ring = Path(f"/dev/shm/interlock-test-{os.getpid()}-{folder.name}.ring")
        self.recordings = folder / "recordings"
        config = folder / "neuro.ilkc"
        robot = ROOT / "models/robots/neuro.toml"
        assert interlock("model", "compile", robot, "-o", config).returncode == 0
        bus, control, link = (folder / f"{name}.sock" for name in ("bus", "control", "link"))
        plant = ROOT / "models/plant/neuro.toml"
        simulator = options(plant=plant, robot=config, bus=bus, control=control, seed=1)
        self.sim = start([BIN / "interlock-sim", *simulator])
        self.recorder = self.start_recorder(*recorder)
        kernel: list[str | Path] = [*options(config=config, bus=f"sim:{bus}", link=link, clock=clock)]
        kernel += ["--black-box", self.ring, "--black-box-seconds", "10"]
        self.kernel = start([BIN / "interlock-kernel", *kernel])
        self.plant = PlantControl(control)
        self.link = link
        self.app = self.attach()

    def attach(self) -> LinkClient:
        return LinkClient(self.link)

    def start_recorder(self, *arguments: str) -> subprocess.Popen:
        files = ["--black-box", self.ring, "--folder", self.recordings]
        return start([BIN / "interlock-recorder", *files, *arguments])

    def files(self, kind: str) -> list[Path]:
        """Finished recordings of that kind."""
        return sorted(self.recordings.glob(f"*-{kind}-*.ilkr"))

    def wait_for_file(self, kind: str) -> Path:
        wait_until(f"a {kind} recording", lambda: bool(self.files(kind)))
        return self.files(kind)[0]

    def lock_by_estop(self) -> int:
        """Pulls the E-stop; returns the kernel's counter after the tick that locked."""
        self.plant("estop", pulled=True)
        wait_until("locked by the E-stop", lambda: self.app.run(5).state.estop == 1)
        return self.app.snapshot().state.cause_tick + 1

    def close(self) -> None:
        self.app.close()
        self.plant.close()
        for process in (self.kernel, self.recorder, self.sim):
            stop(process)
        self.ring.unlink(missing_ok=True)


RecordedKernelFactory = Callable[..., RecordedKernel]


@pytest.fixture
def recorded(short_tmp_path: Path) -> Iterator[RecordedKernelFactory]:
    running: list[RecordedKernel] = []

    def begin(*arguments: str, clock: str = "sim") -> RecordedKernel:
        running.append(RecordedKernel(short_tmp_path, *arguments, clock=clock))
        return running[-1]

    yield begin
    for kernel in running:
        kernel.close()


def unlock(kernel: RecordedKernel) -> None:
    kernel.app.run(30)
    assert kernel.app.ask("RESET") == "ACCEPTED"


def test_lock_leaves_a_recording_that_replays_identical(recorded: RecordedKernelFactory) -> None:
    kernel = recorded()
    unlock(kernel)
    kernel.app.run(500)
    locked = kernel.lock_by_estop()
    kernel.app.run(2100)
    first, last = replayed_ticks(kernel.wait_for_file("lock"))
    assert first <= locked
    assert locked + 2000 <= last


def test_killed_kernel_leaves_its_last_tick(recorded: RecordedKernelFactory) -> None:
    kernel = recorded(clock="real")
    kernel.app.run(300)
    kernel.kernel.kill()
    kernel.kernel.wait()
    _, last = replayed_ticks(kernel.wait_for_file("end"))
    assert last >= kernel.app.snapshot().state.tick
    wait_until("the ring is gone", lambda: not kernel.ring.exists())


def test_killed_app_does_not_end_the_recording(recorded: RecordedKernelFactory) -> None:
    kernel = recorded("--continuous", clock="real")
    kernel.app.run(200)
    kernel.app.close()
    kernel.app = kernel.attach()
    seen = kernel.app.snapshot().state.tick
    assert stop(kernel.kernel) == 0
    first, last = replayed_ticks(kernel.wait_for_file("continuous"))
    assert first == 1
    assert last >= seen


def test_killed_recorder_loses_nothing(recorded: RecordedKernelFactory) -> None:
    kernel = recorded()
    unlock(kernel)
    locked = kernel.lock_by_estop()
    kernel.app.run(500)
    kernel.recorder.kill()
    kernel.recorder.wait()
    assert not kernel.files("lock")
    kernel.app.run(2000)
    kernel.recorder = kernel.start_recorder()
    whole = f"-lock-{locked}.ilkr"
    wait_until(
        "the recording, and nothing else",
        lambda: [file.name.endswith(whole) for file in kernel.files("lock")] == [True],
    )
    [file] = kernel.files("lock")
    first, last = replayed_ticks(file)
    assert first <= locked
    assert locked + 2000 <= last


def test_cut_off_recording_ends_with_its_last_whole_block(recorded: RecordedKernelFactory) -> None:
    kernel = recorded("--continuous")
    seen = kernel.app.run(3000).state.tick
    wait_until("blocks", lambda: any(file.stat().st_size > 600_000 for file in kernel.recordings.iterdir()))
    kernel.recorder.kill()
    kernel.recorder.wait()
    (part,) = kernel.recordings.glob("*.part")
    first, last = replayed_ticks(part)
    assert first == 1
    assert 0 < last <= seen + 100
    cut = kernel.folder / "cut.ilkr"
    cut.write_bytes(part.read_bytes()[:-1000])
    done = interlock("replay", cut)
    assert done.returncode == 0
    assert "was cut off while it was written" in done.stdout
    assert done.stdout.endswith("identical\n")


def test_flipped_bit_is_refused_and_told_by_block(recorded: RecordedKernelFactory) -> None:
    kernel = recorded("--continuous")
    kernel.app.run(3000)
    assert stop(kernel.kernel) == 0
    data = bytearray(kernel.wait_for_file("continuous").read_bytes())
    data[len(data) // 2] ^= 4
    spoilt = kernel.folder / "spoilt.ilkr"
    spoilt.write_bytes(data)
    done = interlock("replay", spoilt)
    assert done.returncode == 1
    assert re.search(r"block \d+ at byte \d+ is damaged", done.stderr), done.stderr
    assert "identical\n" not in done.stdout
    data[0] ^= 1
    spoilt.write_bytes(data)
    done = interlock("replay", spoilt)
    assert done.returncode == 1
    assert "is no recording" in done.stderr


def test_on_demand_with_table_and_plot(stack: StackFactory, short_tmp_path: Path) -> None:
    robot = stack()
    file = short_tmp_path / "now.ilkr"
    done = interlock("record", "--state", robot.state, "-o", file)
    assert done.returncode == 0, done.stderr
    csv, plot = short_tmp_path / "now.csv", short_tmp_path / "now.svg"
    done = interlock("replay", file, "--csv", csv, "--plot", plot)
    assert done.returncode == 0, done.stderr
    ticks = re.search(r"^(\d+) ticks", done.stdout, re.MULTILINE)
    assert ticks is not None
    rows = csv.read_text().splitlines()
    assert len(rows) == int(ticks[1]) + 1
    assert rows[0].startswith("tick,begun_ns,mode,cause")
    assert {row.split(",")[2] for row in rows[1:]} <= {"LOCKED", "READY", "MOTION"}
    assert "<svg" in plot.read_text()[:200]
    assert interlock("record", "--state", robot.state, "-o", file).returncode == 3


def test_a_black_box_of_a_service_is_written_out_by_its_name(
    recorded: RecordedKernelFactory, short_tmp_path: Path
) -> None:
    kernel = recorded()
    kernel.app.run(300)
    file = short_tmp_path / "now.ilkr"
    done = interlock("record", "--black-box", kernel.ring, "-o", file)
    assert done.returncode == 0, done.stderr
    _, last = replayed_ticks(file)
    assert last >= 300
    missing = interlock("record", "--black-box", short_tmp_path / "no.ring", "-o", short_tmp_path / "x.ilkr")
    assert missing.returncode == 3
    assert "no.ring" in missing.stderr


def test_killed_run_is_rescued_by_the_next_one(short_tmp_path: Path) -> None:
    arguments = ["--robot", "neuro", "--realtime", "--seed", "1"]
    killed = Stack(short_tmp_path, *arguments)
    processes = [killed.pid(name) for name in ("kernel", "simulator", "app")]
    with watched(*processes) as descriptors:
        seen = killed.status()["tick"]
        killed.run.send_signal(signal.SIGKILL)
        killed.wait()
        assert all(has_ended(descriptor) for descriptor in descriptors)
    killed.close()
    again = Stack(short_tmp_path, *arguments)
    try:
        wait_until("rescued", lambda: any((again.state / "recordings").glob("*-rescue-*.ilkr")))
        (rescued,) = (again.state / "recordings").glob("*-rescue-*.ilkr")
        _, last = replayed_ticks(rescued)
        assert last >= seen
    finally:
        again.close()


def test_last_ticks_that_the_disk_refused_are_written_out_later(recorded: RecordedKernelFactory) -> None:
    kernel = recorded(clock="real")
    kernel.app.run(300)
    away = kernel.folder / "away"
    kernel.recordings.rename(away)
    kernel.kernel.kill()
    kernel.kernel.wait()
    assert kernel.ring.exists()
    kernel.recorder.kill()
    kernel.recorder.wait()
    away.rename(kernel.recordings)
    kernel.recorder = kernel.start_recorder()
    _, last = replayed_ticks(kernel.wait_for_file("rescue"))
    assert last >= kernel.app.snapshot().state.tick
    wait_until("the ring is gone", lambda: not kernel.ring.exists())


def test_fault_of_an_axis_is_recorded_by_interlock_run(stack: StackFactory) -> None:
    robot = stack()
    robot.control("jump", slot=0, counts=5000)
    robot.output.wait_for(r"-fault-\d+\.ilkr is complete")
    (file,) = (robot.state / "recordings").glob("*-fault-*.ilkr")
    _, last = replayed_ticks(file)
    assert last > 2000
