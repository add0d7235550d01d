"""The black box with real processes: what each kill leaves, and what a replay says of it."""

import contextlib
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


def black_box_of(pid: int) -> str:
    """The kernel's memory, by its inode."""
    (inode,) = set(re.findall(r"(\d+) +/memfd:interlock-black-box", Path(f"/proc/{pid}/maps").read_text()))
    return inode


def holders(black_box: str) -> list[int]:
    """Processes that keep that memory, mapped or as a descriptor."""
    found = []
    for process in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            mapped = re.search(rf"{black_box} +/memfd:interlock-black-box", (process / "maps").read_text())
            opened = [
                fd
                for fd in (process / "fd").iterdir()
                if "memfd:interlock-black-box" in str(fd.readlink()) and fd.stat().st_ino == int(black_box)
            ]
            found += [int(process.name)] if mapped or opened else []
    return found


class RecordedKernel:
    """Plant, recorder and kernel as real processes, with a short black box; the test is the app."""

    def __init__(self, folder: Path, *recorder: str, clock: str = "sim") -> None:
        self.folder = folder
        self.black_box = folder / "black-box"
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
        kernel += ["--black-box", self.black_box, "--black-box-seconds", "10"]
        self.kernel = start([BIN / "interlock-kernel", *kernel])
        self.plant = PlantControl(control)
        self.link = link
        self.app = self.attach()

    def attach(self) -> LinkClient:
        return LinkClient(self.link)

    def start_recorder(self, *arguments: str) -> subprocess.Popen:
        files = ["--black-box", self.black_box, "--folder", self.recordings]
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
        wait_until("locked by the E-stop", lambda: self.app.run(5).state.system.estop == 1)
        return self.app.snapshot().state.system.cause_tick + 1

    def close(self) -> None:
        self.app.close()
        self.plant.close()
        for process in (self.kernel, self.recorder, self.sim):
            stop(process)


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
    black_box = black_box_of(kernel.kernel.pid)
    wait_until("both hold it", lambda: len(holders(black_box)) == 2)
    kernel.kernel.kill()
    kernel.kernel.wait()
    _, last = replayed_ticks(kernel.wait_for_file("end"))
    assert last >= kernel.app.snapshot().state.system.tick
    wait_until("the memory is gone", lambda: not holders(black_box))


def test_killed_app_does_not_end_the_recording(recorded: RecordedKernelFactory) -> None:
    kernel = recorded("--continuous", clock="real")
    kernel.app.run(200)
    kernel.app.close()
    kernel.app = kernel.attach()
    seen = kernel.app.snapshot().state.system.tick
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
    kernel.app.run(3000)
    wait_until("blocks", lambda: any(file.stat().st_size > 150_000 for file in kernel.recordings.iterdir()))
    kernel.recorder.kill()
    kernel.recorder.wait()
    seen = kernel.app.snapshot().state.system.tick
    (part,) = kernel.recordings.glob("*.part")
    first, last = replayed_ticks(part)
    assert first == 1
    assert 0 < last <= seen
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


def test_a_black_box_of_a_service_is_written_out_by_its_socket(
    recorded: RecordedKernelFactory, short_tmp_path: Path
) -> None:
    kernel = recorded()
    kernel.app.run(300)
    file = short_tmp_path / "now.ilkr"
    done = interlock("record", "--black-box", kernel.black_box, "-o", file)
    assert done.returncode == 0, done.stderr
    _, last = replayed_ticks(file)
    assert last >= 300
    missing = interlock("record", "--black-box", short_tmp_path / "no-box", "-o", short_tmp_path / "x.ilkr")
    assert missing.returncode == 3
    assert "no-box" in missing.stderr


def test_a_stopped_kernel_is_no_reason_to_wait(recorded: RecordedKernelFactory, short_tmp_path: Path) -> None:
    kernel = recorded(clock="real")
    kernel.kernel.send_signal(signal.SIGSTOP)
    done = interlock("record", "--black-box", kernel.black_box, "-o", short_tmp_path / "now.ilkr")
    kernel.kernel.send_signal(signal.SIGCONT)
    assert done.returncode == 3
    assert "it may be stopped" in done.stderr


def test_killed_run_leaves_its_last_tick_and_no_memory(short_tmp_path: Path) -> None:
    """The recorder outlives the others, writes out what it holds, and ends; the next run begins meanwhile."""
    arguments = ["--robot", "neuro", "--realtime", "--seed", "1"]
    killed = Stack(short_tmp_path, *arguments)
    black_box = black_box_of(killed.pid("kernel"))
    wait_until("the recorder holds it", lambda: len(holders(black_box)) == 2)
    processes = [killed.pid(name) for name in ("kernel", "simulator", "app", "recorder")]
    with watched(*processes) as descriptors:
        seen = killed.status()["tick"]
        killed.run.send_signal(signal.SIGKILL)
        killed.wait()
        again = Stack(short_tmp_path, *arguments)
        try:
            assert all(has_ended(descriptor) for descriptor in descriptors)
        finally:
            again.close()
    killed.close()
    (end,) = (killed.state / "recordings").glob("*-end-*.ilkr")
    _, last = replayed_ticks(end)
    assert last >= seen
    assert holders(black_box) == []
    assert not list((killed.state / "recordings").glob("*.part"))


# The system continues a stopped process whose parent died, and sends it SIGHUP before.
def test_a_stopped_recorder_of_a_killed_run_leaves_the_last_tick_too(short_tmp_path: Path) -> None:
    killed = Stack(short_tmp_path, "--robot", "neuro", "--realtime", "--seed", "1")
    black_box = black_box_of(killed.pid("kernel"))
    wait_until("the recorder holds it", lambda: len(holders(black_box)) == 2)
    with watched(killed.pid("recorder")) as [recorder]:
        seen = killed.status()["tick"]
        killed.signal("recorder", signal.SIGSTOP)
        killed.run.send_signal(signal.SIGKILL)
        killed.wait()
        assert has_ended(recorder)
    killed.close()
    (end,) = (killed.state / "recordings").glob("*-end-*.ilkr")
    _, last = replayed_ticks(end)
    assert last >= seen
    assert holders(black_box) == []


def test_nothing_is_left_when_all_processes_are_killed_at_once(short_tmp_path: Path) -> None:
    killed = Stack(short_tmp_path, "--robot", "neuro", "--realtime", "--seed", "1")
    black_box = black_box_of(killed.pid("kernel"))
    processes = [killed.pid(name) for name in ("recorder", "kernel", "simulator", "app")]
    with watched(*processes) as descriptors:
        for pid in (killed.run.pid, *processes):
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)
        killed.wait()
        assert all(has_ended(descriptor) for descriptor in descriptors)
    killed.close()
    assert holders(black_box) == []


def test_no_process_keeps_anything_in_a_folder_that_others_can_write_to(stack: StackFactory) -> None:
    """But in the private folder of its sockets: the memory that they share has no name."""
    robot = stack(realtime=True)
    own = str(robot.state.parent)
    for name in ("simulator", "kernel", "recorder", "app"):
        process = Path(f"/proc/{robot.pid(name)}")
        mapped = re.findall(r" (/\S+)$", (process / "maps").read_text(), re.MULTILINE)
        opened = [str(fd.readlink()) for fd in (process / "fd").iterdir()]
        common = [each for each in (*mapped, *opened) if each.startswith(("/dev/shm/", "/tmp/", "/var/tmp/"))]
        assert [each for each in common if not each.startswith((own, str(BIN.parent)))] == [], name


def test_a_start_that_fails_leaves_no_memory(short_tmp_path: Path) -> None:
    """The link is taken; so is the socket of the black box."""
    config = short_tmp_path / "neuro.ilkc"
    assert interlock("model", "compile", ROOT / "models/robots/neuro.toml", "-o", config).returncode == 0
    before = shared_memory()
    for taken in ("link", "black-box"):
        (short_tmp_path / taken).mkdir()
        given = options(config=config, bus=f"sim:{short_tmp_path / 'bus'}", link=short_tmp_path / "link")
        failed = subprocess.run(
            [BIN / "interlock-kernel", *given, "--black-box", short_tmp_path / "black-box"],
            capture_output=True,
            text=True,
            timeout=DEADLINE_S,
        )
        assert failed.returncode == 2, failed.stderr
        (short_tmp_path / taken).rmdir()
    assert shared_memory() <= before


def shared_memory() -> set[str]:
    """Files of this user's kernels in the machine's shared memory."""
    return {file.name for file in Path("/dev/shm").iterdir() if "black" in file.name}


def test_last_ticks_that_the_disk_refused_are_written_when_it_takes_them(
    recorded: RecordedKernelFactory,
) -> None:
    kernel = recorded(clock="real")
    kernel.app.run(300)
    black_box = black_box_of(kernel.kernel.pid)
    away = kernel.folder / "away"
    kernel.recordings.rename(away)
    kernel.kernel.kill()
    kernel.kernel.wait()
    assert kernel.recorder.stdout is not None
    while "holds it until the disk takes it" not in kernel.recorder.stdout.readline():
        assert kernel.recorder.poll() is None
    assert holders(black_box) == [kernel.recorder.pid]
    away.rename(kernel.recordings)
    assert stop(kernel.recorder) == 0
    (end,) = kernel.files("end")
    _, last = replayed_ticks(end)
    assert last >= kernel.app.snapshot().state.system.tick


def test_fault_of_an_axis_is_recorded_by_interlock_run(stack: StackFactory) -> None:
    robot = stack()
    robot.control("jump", slot=0, counts=5000)
    robot.output.wait_for(r"-fault-\d+\.ilkr is complete")
    (file,) = (robot.state / "recordings").glob("*-fault-*.ilkr")
    _, last = replayed_ticks(file)
    assert last > 2000
