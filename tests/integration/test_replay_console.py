"""`interlock replay --console`: what was recorded is seen again, and nothing can be asked of it."""

from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest
from bare_kernel import DEADLINE_S, stop
from motion import wait_until
from stack import Output, start_interlock
from test_recorder import RecordedKernelFactory, interlock, recorded, replayed_ticks, unlock

__all__ = ["recorded"]


@pytest.fixture
def recording(recorded: RecordedKernelFactory) -> Path:
    """Of a robot that was unlocked, and locked by its E-stop."""
    kernel = recorded()
    unlock(kernel)
    kernel.app.run(300)
    kernel.lock_by_estop()
    kernel.app.run(2100)
    return kernel.wait_for_file("lock")


class Replay:
    """A recording in the console, with its first user logged in."""

    def __init__(self, recording: Path, runtime: Path) -> None:
        arguments = ["replay", recording, "--console", "--port", "0", "--speed", "100"]
        self.process = start_interlock(runtime, *arguments)
        self.output = Output(self.process)
        self.api = httpx.Client(base_url=self.output.wait_for(r"^ready (http\S+)")[1], timeout=DEADLINE_S)
        password = self.output.wait_for(r"^first login: admin (\S+)$")[1]
        self.api.post("/api/login", json={"name": "admin", "password": password}).raise_for_status()

    def status(self) -> dict:
        return self.api.get("/api/status").json()


@pytest.fixture
def replay(recording: Path, short_tmp_path: Path) -> Iterator[Replay]:
    runtime = short_tmp_path / "runtime"
    runtime.mkdir()
    shown = Replay(recording, runtime)
    yield shown
    shown.api.close()
    assert stop(shown.process) == 0
    assert list(runtime.iterdir()) == []


def test_the_console_sees_the_recorded_run_to_its_last_tick(replay: Replay, recording: Path) -> None:
    _, last = replayed_ticks(recording)
    wait_until("the last tick", lambda: replay.status()["tick"] == last)
    shown = replay.status()
    assert (shown["replay"], shown["connected"], shown["simulated"]) == (True, True, True)
    assert (shown["mode"], shown["cause"], shown["estop"]) == ("LOCKED", "ESTOP", True)
    replay.output.wait_for(rf"the recording ends at tick {last}")
    log = replay.api.get("/api/logs").text
    assert "ESTOP" in log


def test_nothing_can_be_asked_of_a_recording(replay: Replay) -> None:
    for path in ("/api/control/request", "/api/control/take-over"):
        refused = replay.api.post(path)
        assert (refused.status_code, refused.json()["code"]) == (409, "REPLAY")
    assert replay.api.post("/api/reset").json()["code"] == "CONTROL"
    assert replay.api.post("/api/stop").json() == {"verdict": None, "tick": None}


def test_a_recording_of_another_configuration_is_not_shown(recording: Path) -> None:
    refused = interlock("replay", recording, "--console", "--robot", "prostate", "--port", "0")
    assert refused.returncode == 3
    assert "not prostate compiles to it; name the robot's file" in refused.stderr
