"""A whole robot as real processes, started by `interlock run`: simulator, kernel and app."""

import contextlib
import os
import re
import select
import signal
import subprocess
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import httpx
from bare_kernel import BIN, DEADLINE_S, PlantControl, without_priority

PROGRAMS = {
    "simulator": "interlock-sim",
    "recorder": "interlock-recorder",
    "kernel": "interlock-kernel",
    "app": "interlock-app",
}


class Output:
    """The lines of a process, read as they come so that it never waits for its reader."""

    def __init__(self, process: subprocess.Popen) -> None:
        self.lines: list[str] = []
        self._process = process
        self._changed = threading.Condition()
        self._ended = False
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        assert self._process.stdout is not None
        for line in self._process.stdout:
            with self._changed:
                self.lines.append(line.rstrip("\n"))
                self._changed.notify_all()
        with self._changed:
            self._ended = True
            self._changed.notify_all()

    def wait_for(self, pattern: str, count: int = 1) -> re.Match:
        """The match of the `count`-th line that matches, now or later."""

        def found() -> list[re.Match]:
            return [match for line in self.lines if (match := re.search(pattern, line))]

        with self._changed:
            self._changed.wait_for(lambda: self._ended or len(found()) >= count, timeout=DEADLINE_S)
            assert len(found()) >= count, f"no line {pattern!r} ({count} times) in:\n" + self.text
            return found()[count - 1]

    def wait_for_end(self) -> None:
        self._reader.join(timeout=DEADLINE_S)

    @property
    def text(self) -> str:
        return "\n".join(self.lines)


def start_interlock(runtime: Path, *arguments: str | Path) -> subprocess.Popen:
    """`interlock` with its runtime directory; errors come with its output."""
    command = [str(part) for part in (BIN / "interlock", *arguments)]
    return subprocess.Popen(
        without_priority(command) if "--realtime" in command else command,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        env={**os.environ, "XDG_RUNTIME_DIR": str(runtime)},
    )


class Stack:
    """One running robot. `control` commands the plant, `api` speaks HTTP to the app as an administrator who
    is in control, with a case open."""

    def __init__(self, directory: Path, *arguments: str | Path) -> None:
        self.state = directory / "state"
        self.runtime = directory / "run"
        self.sockets = directory / "sockets"
        self.runtime.mkdir(parents=True, exist_ok=True)
        self.run = start_interlock(self.runtime, "run", "--port", "0", "--state", self.state, *arguments)
        self.output = Output(self.run)
        self._connections = contextlib.ExitStack()
        try:
            self.url = self.output.wait_for(r"^ready (http\S+)")[1]
            self.password = self._first_password(directory / "password")
            self.api = self.client("admin", self.password)
            self.take_control()
            self.status_when(lambda status: status["connected"])
        except BaseException:
            self.run.kill()
            self.run.wait()
            raise

    def _first_password(self, kept: Path) -> str:
        """As the first start with this state says it; a later one knows it from the first."""
        if not kept.exists():
            kept.write_text(self.output.wait_for(r"^first login: admin (\S+)$")[1])
        return kept.read_text()

    def visitor(self) -> httpx.Client:
        """A client that nobody is logged in at."""
        return self._connections.enter_context(httpx.Client(base_url=self.url, timeout=DEADLINE_S))

    def client(self, name: str, password: str) -> httpx.Client:
        """A client at which that user is logged in, in a session of its own."""
        client = self.visitor()
        client.post("/api/login", json={"name": name, "password": password}).raise_for_status()
        return client

    def client_of_new(self, name: str, role: str) -> httpx.Client:
        """A client at which a user is logged in who was just added."""
        user = {"name": name, "role": role, "password": f"password of {name}"}
        self.api.post("/api/users", json=user).raise_for_status()
        return self.client(name, user["password"])

    def take_control(self) -> None:
        """Anew after the app was started anew: sessions outlive it, control does not. A case is open then."""
        assert self.api.post("/api/control/request").status_code == 200
        self.open_case()

    def open_case(self) -> None:
        """The one in hand is open, resumed if need be, or another one."""
        newest = next(iter(self.api.get("/api/cases").raise_for_status().json()), {"state": "closed"})
        if newest["state"] == "closed":
            self.api.post("/api/cases", json={"label": "of the test"}).raise_for_status()
        elif newest["state"] == "suspended":
            self.api.post(f"/api/cases/{newest['number']}/resume").raise_for_status()

    def connect_control(self) -> None:
        """Opens `control`, the plant's control socket, in the directory that was given for the sockets."""
        self.control = self._connections.enter_context(
            contextlib.closing(PlantControl(self.sockets / "control.sock"))
        )

    @property
    def port(self) -> int:
        return httpx.URL(self.url).port or 80

    @property
    def igtl_port(self) -> int:
        """Of a robot that was started with `igtl=True`; another one after each start of the app."""
        line = r"OpenIGTLink 127\.0\.0\.1:(\d+)$"
        self.output.wait_for(line)
        return int([found for each in self.output.lines if (found := re.search(line, each))][-1][1])

    def pid(self, name: str) -> int:
        """Process of the simulator, the recorder, the kernel or the app."""
        for child in Path(f"/proc/{self.run.pid}/task/{self.run.pid}/children").read_text().split():
            if Path(f"/proc/{child}/cmdline").read_bytes().split(b"\0")[0].endswith(PROGRAMS[name].encode()):
                return int(child)
        raise AssertionError(f"interlock run has no {name}; its output:\n{self.output.text}")

    def signal(self, name: str, number: signal.Signals) -> None:
        os.kill(self.pid(name), number)

    def status(self) -> dict:
        return self.api.get("/api/status").raise_for_status().json()

    def status_when(self, holds: Callable[[dict], bool]) -> dict:
        """The first status for which the condition holds; an app serves before it is attached to a kernel."""
        deadline = time.monotonic() + DEADLINE_S
        while not holds(status := self.status()):
            assert time.monotonic() < deadline, status
        return status

    def wait(self) -> int:
        """Exit code, once it has ended."""
        code = self.run.wait(timeout=DEADLINE_S)
        self.output.wait_for_end()
        return code

    def close(self) -> None:
        self._connections.close()
        if self.run.poll() is None:
            self.run.send_signal(signal.SIGINT)
        try:
            self.wait()
        finally:
            self.run.kill()


@contextlib.contextmanager
def watched(*pids: int) -> Iterator[list[int]]:
    """Descriptors by which `has_ended` sees the end of processes, even of those that are no children."""
    descriptors = [os.pidfd_open(pid) for pid in pids]
    try:
        yield descriptors
    finally:
        for descriptor in descriptors:
            os.close(descriptor)


def has_ended(descriptor: int) -> bool:
    """Whether the process ends before the deadline."""
    return bool(select.select([descriptor], [], [], DEADLINE_S)[0])
