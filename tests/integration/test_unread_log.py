"""Nobody takes what the programs print or log: they go on all the same."""

import contextlib
import os
import pty
import re
import signal
import subprocess
import termios
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest
from bare_kernel import BIN, DEADLINE_S, ROOT, options
from motion import wait_until
from stack import has_ended, watched

# Twice what the pipes of app and supervisor hold together, and that of its output (queued_output.cpp).
UNREAD_BYTES = 2 * (2 * 65536 + (1 << 20))


def log_bytes(client: httpx.Client, count: int) -> None:
    """Lets the app log as many bytes, at the level debug."""
    client.put("/api/logs", json={"level": "debug"}).raise_for_status()
    logged = 0
    while logged < count:
        place = f"/api/motors/{'x' * 2000}{logged}"
        assert client.get(place).status_code == 404
        logged += len(place)


class Reader:
    """The reading end of what a program writes: a pipe, or the master of a terminal."""

    def __init__(self, descriptor: int) -> None:
        self.stream = os.fdopen(descriptor, "r", encoding="utf-8", errors="replace", closefd=False)
        self.descriptor = descriptor

    def wait_for(self, pattern: str) -> re.Match:
        for line in self.stream:
            if found := re.search(pattern, line):
                return found
        raise AssertionError(f"ended without {pattern!r}")


@contextlib.contextmanager
def unread_run(
    directory: Path, output: int, reader: Reader
) -> Iterator[tuple[subprocess.Popen, httpx.Client]]:
    """`interlock run` whose output is read until it is ready and then no more, and an administrator."""
    command = [BIN / "interlock", "run", "--port", "0", "--state", directory / "state", "--clock", "sim"]
    environment = {**os.environ, "XDG_RUNTIME_DIR": str(directory)}
    with subprocess.Popen(
        command, stdout=output, stderr=output, stdin=subprocess.DEVNULL, env=environment
    ) as run:
        os.close(output)
        try:
            password = reader.wait_for(r"^first login: admin (\S+)")[1]
            url = reader.wait_for(r"^ready (http\S+)")[1]
            with httpx.Client(base_url=url, timeout=DEADLINE_S) as client:
                client.post("/api/login", json={"name": "admin", "password": password}).raise_for_status()
                yield run, client
        finally:
            run.kill()


@pytest.fixture(params=["pipe", "terminal"])
def unread(request: pytest.FixtureRequest) -> Iterator[tuple[int, Reader]]:
    """An output for a program, and its reader."""
    reader, writer = os.pipe() if request.param == "pipe" else pty.openpty()
    yield writer, Reader(reader)
    os.close(reader)


def answers_stop(client: httpx.Client) -> bool:
    try:
        return client.post("/api/stop").status_code == 200
    except httpx.TransportError:
        return False


def child_of(run: subprocess.Popen, program: str) -> int:
    for child in Path(f"/proc/{run.pid}/task/{run.pid}/children").read_text().split():
        if Path(f"/proc/{child}/cmdline").read_bytes().split(b"\0")[0].endswith(program.encode()):
            return int(child)
    raise AssertionError(f"no {program}")


def test_STOP_is_answered_a_dead_app_restarted_and_SIGTERM_obeyed_while_nobody_reads_the_output(
    unread: tuple[int, Reader], short_tmp_path: Path
) -> None:
    output, reader = unread
    with unread_run(short_tmp_path, output, reader) as (run, client):
        log_bytes(client, UNREAD_BYTES)
        assert client.get("/api/status").status_code == 200
        assert client.post("/api/stop").status_code == 200
        with watched(child_of(run, "interlock-app")) as [app]:
            signal.pidfd_send_signal(app, signal.SIGKILL)
            assert has_ended(app)
        wait_until("answered by the app that was started anew", lambda: answers_stop(client))
        run.send_signal(signal.SIGTERM)
        assert run.wait(timeout=DEADLINE_S) == 0


def test_SIGTERM_is_obeyed_at_a_terminal_that_was_stopped(short_tmp_path: Path) -> None:
    """Ctrl-S, by mistake perhaps: not one byte goes to the terminal from then on."""
    master, terminal = pty.openpty()
    with unread_run(short_tmp_path, os.dup(terminal), Reader(master)) as (run, client):
        termios.tcflow(terminal, termios.TCOOFF)
        log_bytes(client, 10_000)
        run.send_signal(signal.SIGTERM)
        assert run.wait(timeout=DEADLINE_S) == 0
    os.close(terminal)
    os.close(master)


@pytest.fixture
def stuck_log(short_tmp_path: Path) -> Iterator[int]:
    """A pipe in the place of the app's log file, as a disk that takes no more until somebody reads."""
    log = short_tmp_path / "state/log/interlock-app.log"
    log.parent.mkdir(parents=True, mode=0o700)
    os.mkfifo(log)
    descriptor = os.open(log, os.O_RDONLY | os.O_NONBLOCK)
    yield descriptor
    os.close(descriptor)


def test_the_app_ends_by_itself_while_its_log_file_takes_nothing(
    stuck_log: int, short_tmp_path: Path
) -> None:
    robot, config, state = (
        ROOT / "models/robots/neuro.toml",
        short_tmp_path / "r.ilkc",
        short_tmp_path / "state",
    )
    subprocess.run([BIN / "interlock", "model", "compile", robot, "-o", config], check=True)
    given = options(robot=robot, config=config, link=short_tmp_path / "link", port=0, state=state)
    command = [BIN / "interlock-app", *given, "--log-level", "debug"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as app:
        assert app.stdout is not None
        reader = Reader(app.stdout.fileno())
        try:
            password = reader.wait_for(r"^first login: admin (\S+)")[1]
            url = reader.wait_for(r"^ready (http\S+)")[1]
            with httpx.Client(base_url=url, timeout=DEADLINE_S) as client:
                client.post("/api/login", json={"name": "admin", "password": password}).raise_for_status()
                log_bytes(client, UNREAD_BYTES)
            app.send_signal(signal.SIGTERM)
            assert app.wait(timeout=DEADLINE_S) == 0
        finally:
            app.kill()
