"""Fixtures for every integration test. Programs come from $INTERLOCK_BIN, by default build/release/bin."""

import json
import signal
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from stack import Stack

StackFactory = Callable[..., Stack]
RobotFile = Callable[..., Path]

NEURO = Path(__file__).resolve().parents[2] / "models/robots/neuro.toml"


# A worker of pytest-xdist ignores Ctrl-C, and its programs would inherit that.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture
def short_tmp_path() -> Iterator[Path]:
    """A folder whose name leaves room for a socket: pytest's own paths can be too long for one."""
    with tempfile.TemporaryDirectory(prefix="interlock-test-") as directory:
        yield Path(directory)


@pytest.fixture(scope="module")
def robot() -> Iterator[Stack]:
    """One robot for all tests of a file, as `interlock run` starts it."""
    with tempfile.TemporaryDirectory(prefix="interlock-test-") as directory:
        started = Stack(Path(directory))
        try:
            yield started
        finally:
            started.close()


@pytest.fixture
def stack(short_tmp_path: Path) -> Iterator[StackFactory]:
    """Starts whole robots: `stack()` as fast as possible, `stack(speed=1)` paced, `stack(realtime=True)`.

    Each is stopped when the test ends.
    """
    running: list[Stack] = []

    def start(
        speed: float = 0,
        realtime: bool = False,
        robot: str | Path = "neuro",
        seed: int = 1,
        igtl: bool = False,
        dialect: str = "thesis",
        plant: Path | None = None,
    ) -> Stack:
        directory = short_tmp_path / str(len(running))
        arguments = [
            "--robot",
            robot,
            "--seed",
            str(seed),
            "--sockets",
            directory / "sockets",
        ]
        if realtime:
            arguments += ["--realtime"]
        else:
            arguments += ["--speed", str(speed)] if speed else ["--clock", "sim"]
        if plant is not None:
            arguments += ["--plant", plant]
        if igtl:
            arguments += ["--igtl-port", "0", "--igtl-dialect", dialect]
        started = Stack(directory, *arguments)
        running.append(started)
        started.connect_control()
        return started

    yield start
    for started in running:
        started.close()


@pytest.fixture
def robot_file(tmp_path: Path) -> RobotFile:
    """The neuro robot's file with these keys of [openigtlink] besides the usual ones."""

    def write(**keys: object) -> Path:
        table = {"bind": "127.0.0.1", "port": 18944, "dialect": "thesis"} | keys
        lines = [f"{key} = {json.dumps(value)}" for key, value in table.items()]
        file = tmp_path / "neuro.toml"
        file.write_text(NEURO.read_text() + "\n[openigtlink]\n" + "\n".join(lines) + "\n")
        return file

    return write
