"""Another user of the machine, who was there first: files, sockets, folders and locks at every name that the
product uses. It starts all the same, or says exactly what to remove. Needs root: `make test-network`."""

import os
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest
from bare_kernel import BIN, DEADLINE_S
from stack import Output

pytestmark = pytest.mark.network

SOCKETS = ("bus.sock", "control.sock", "link.sock", "black-box.sock")
OTHERS = ("neuro.ilkc", "lock", "interlock.db", "interlock.db.lock", "recordings", "log", "interlock-neuro")
TAKE = """
import fcntl, os, socket, sys
kind, *paths = sys.argv[1:]
kept = []
for path in paths:
    if kind == "file":
        open(path, "x").close()
    elif kind == "folder":
        os.mkdir(path)
    elif kind == "socket":
        kept.append(socket.socket(socket.AF_UNIX))
        kept[-1].bind(path)
        kept[-1].listen()
    else:
        fcntl.flock(os.open(path, os.O_RDONLY), fcntl.LOCK_EX)
print("taken", flush=True)
sys.stdin.read()
"""


AS_OTHER = ("setpriv", "--reuid=nobody", "--regid=nogroup", "--clear-groups", "/usr/bin/python3", "-c")


class OtherUser:
    """Does what any user may do, and keeps it until the test ends."""

    def __init__(self) -> None:
        self._running: list[subprocess.Popen] = []

    def take(self, kind: str, *paths: Path) -> None:
        taking = subprocess.Popen(
            [*AS_OTHER, TAKE, kind, *map(str, paths)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        self._running.append(taking)
        assert taking.stdout is not None
        assert taking.stdout.readline() == "taken\n"

    def leave(self) -> None:
        for process in self._running:
            process.kill()
            process.wait()


@pytest.fixture
def other() -> Iterator[OtherUser]:
    user = OtherUser()
    yield user
    user.leave()


@pytest.fixture
def common() -> Iterator[Path]:
    """A folder like /tmp: everybody may write to it, and remove only what is theirs."""
    with tempfile.TemporaryDirectory(prefix="ilk-") as directory:
        folder = Path(directory)
        folder.chmod(0o1777)
        yield folder


def begin(common: Path, *arguments: str | Path) -> subprocess.Popen:
    """`interlock run` with that folder as the machine's temporary one, and no other."""
    environment = {key: value for key, value in os.environ.items() if key != "XDG_RUNTIME_DIR"}
    command = [BIN / "interlock", "run", "--robot", "neuro", "--port", "0", *arguments]
    return subprocess.Popen(
        [str(part) for part in command],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        env=environment | {"TMPDIR": str(common), "XDG_STATE_HOME": str(common / "mine")},
    )


def expect_start(common: Path, *arguments: str | Path) -> None:
    robot = begin(common, *arguments)
    output = Output(robot)
    try:
        output.wait_for(r"^ready http")
    finally:
        robot.terminate()
        robot.wait(timeout=2 * DEADLINE_S)


def refusal(common: Path, *arguments: str | Path) -> str:
    robot = begin(common, *arguments)
    text, _ = robot.communicate(timeout=DEADLINE_S)
    assert robot.returncode == 3, text
    return text


@pytest.mark.parametrize("kind", ["file", "folder", "socket"])
def test_it_starts_beside_any_name_in_the_temporary_folder(common: Path, other: OtherUser, kind: str) -> None:
    other.take(kind, *(common / name for name in (*SOCKETS, *OTHERS)))
    other.take("lock", common)
    expect_start(common)


@pytest.mark.parametrize("kind", ["file", "folder", "socket"])
@pytest.mark.parametrize("name", [*SOCKETS, "neuro.ilkc"])
def test_a_name_that_is_taken_in_a_given_folder_is_what_it_says_to_remove(
    common: Path, other: OtherUser, kind: str, name: str
) -> None:
    other.take(kind, common / name)
    text = refusal(common, "--sockets", common)
    assert f"{common / name} is there already" in text
    assert "remove it, or choose another directory with --sockets" in text


def test_a_lock_on_a_given_folder_keeps_nothing_from_starting(common: Path, other: OtherUser) -> None:
    other.take("lock", common)
    expect_start(common, "--sockets", common)


def test_a_lock_in_a_given_state_directory_is_what_it_says_to_remove(common: Path, other: OtherUser) -> None:
    state = common / "state"
    other.take("folder", state)
    other.take("file", state / "lock")
    other.take("lock", state / "lock")
    text = refusal(common, "--state", state)
    assert f"{state / 'lock'} belongs to another user, who keeps it locked" in text
    assert "remove it, or choose another --state" in text


def test_another_user_gets_no_black_box_and_no_link(common: Path, other: OtherUser) -> None:
    robot = begin(common)
    output = Output(robot)
    try:
        output.wait_for(r"^ready http")
        (runtime,) = common.glob("interlock-neuro-*")
        attempt = "import os, sys; os.listdir(sys.argv[1])"
        done = subprocess.run([*AS_OTHER, attempt, runtime], capture_output=True, text=True, check=False)
        assert "PermissionError" in done.stderr
    finally:
        robot.terminate()
        robot.wait(timeout=2 * DEADLINE_S)
