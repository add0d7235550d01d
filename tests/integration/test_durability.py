"""What was acknowledged is kept: the app is killed at random instants while clients write."""

import json
import random
import sqlite3
import subprocess
import threading
import time
from http.client import HTTPConnection, HTTPException, HTTPResponse
from pathlib import Path

from bare_kernel import BIN, DEADLINE_S, ROOT, BareKernel, bare_kernel, options, stop
from motion import wait_until

KILLS = 100
WRITERS = 3
LONGEST_LIFE_S = 0.1
SEED = 20_260


class App:
    """interlock-app beside a kernel that outlives it, always with the same store."""

    def __init__(self, kernel: BareKernel, state: Path) -> None:
        self.password = ""
        self.command = [
            BIN / "interlock-app",
            *options(
                robot=ROOT / "models/robots/neuro.toml",
                config=kernel.directory / "neuro.ilkc",
                link=kernel.link_path,
                state=state,
                port=0,
            ),
        ]

    def start(self) -> None:
        self.process = subprocess.Popen(
            [str(part) for part in self.command], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
        )
        assert self.process.stdout is not None
        for line in self.process.stdout:
            match line.split():
                case ["first", "login:", "admin", password]:
                    self.password = password
                case ["ready", url]:
                    self.port = int(url.rstrip("/").rpartition(":")[2])
                    return
        raise AssertionError(f"the app ended with {self.process.wait()} before it was ready")

    def cookie(self, token: str) -> str:
        """The session's cookie, whose name has the port: another one in each life."""
        return f"interlock_session_{self.port}={token}"

    def kill(self) -> None:
        self.process.kill()
        self.process.wait()


class Writer(threading.Thread):
    """Sets the target again and again, each time to another point, and remembers what was acknowledged."""

    def __init__(self, app: App, cookie: str, life: int, number: int) -> None:
        super().__init__()
        self.began = threading.Event()
        self.connection = HTTPConnection("127.0.0.1", app.port, timeout=DEADLINE_S)
        self.cookie = cookie
        self.points = ([life, number, count] for count in range(10_000))
        self.acknowledged: list[list[int]] = []
        self.refusal = ""

    def run(self) -> None:
        try:
            for point in self.points:
                answer = send(
                    self.connection, "PUT", "/api/targeting/target", self.cookie, {"target_point": point}
                )
                if answer.status != 200:
                    self.refusal = answer.read().decode()
                    return
                answer.read()
                self.acknowledged.append(point)
                self.began.set()
        except (HTTPException, OSError):
            return  # The app was killed, as it should be.
        finally:
            self.connection.close()


def send(connection: HTTPConnection, method: str, path: str, cookie: str, body: dict) -> HTTPResponse:
    connection.request(method, path, json.dumps(body), {"Cookie": cookie})
    return connection.getresponse()


def ask(app: App, method: str, path: str, cookie: str, body: dict) -> HTTPResponse:
    answer = send(HTTPConnection("127.0.0.1", app.port, timeout=DEADLINE_S), method, path, cookie, body)
    assert answer.status < 300, answer.read()
    return answer


def log_in(app: App) -> str:
    """The token of a session, which outlives the app."""
    answer = ask(app, "POST", "/api/login", "", {"name": "admin", "password": app.password})
    return answer.headers["Set-Cookie"].partition(";")[0].partition("=")[2]


def write_until_killed(app: App, token: str, life: int, seconds: float) -> list[list[int]]:
    cookie = app.cookie(token)
    ask(app, "POST", "/api/control/request", cookie, {})
    if life == 0:
        ask(app, "POST", "/api/cases", cookie, {"label": "of the test"})
    else:
        ask(app, "POST", "/api/cases/1/resume", cookie, {})
    writers = [Writer(app, cookie, life, number) for number in range(WRITERS)]
    for writer in writers:
        writer.start()
    for writer in writers:
        assert writer.began.wait(DEADLINE_S), writer.refusal
    time.sleep(seconds)  # The instant of the kill is the experiment, not a wait for anything.
    app.kill()
    for writer in writers:
        writer.join(DEADLINE_S)
    assert [writer.refusal for writer in writers] == [""] * WRITERS
    return [point for writer in writers for point in writer.acknowledged]


def audited_targets(state: Path) -> list[list[int]]:
    """Every target in the audit, in its order."""
    with sqlite3.connect(f"file:{state / 'interlock.db'}?mode=ro", uri=True) as store:
        details = [json.loads(row[0]) for row in store.execute("SELECT detail FROM audit ORDER BY number")]
    return [detail["new"]["target_point"] for detail in details if "target_point" in detail.get("new", {})]


def test_what_was_acknowledged_outlives_a_kill_at_any_instant(short_tmp_path: Path) -> None:
    dice = random.Random(SEED)
    state = short_tmp_path / "state"
    with bare_kernel(clock="real") as kernel:
        app = App(kernel, state)
        app.start()
        token = log_in(app)
        acknowledged: list[list[int]] = []
        for life in range(KILLS):
            acknowledged += write_until_killed(app, token, life, dice.uniform(0, LONGEST_LIFE_S))
            app.start()
        kept = json.load(ask(app, "GET", "/api/targeting", app.cookie(token), {}))["target_point"]
        stop(app.process)

    audited = audited_targets(state)
    assert len(acknowledged) >= KILLS * WRITERS
    assert [point for point in acknowledged if point not in audited] == []
    assert kept == audited[-1]
    verified = subprocess.run(
        [BIN / "interlock", "audit", "verify", "--state", state], capture_output=True, text=True
    )
    assert verified.returncode == 0, verified.stderr


def propose(app: App, token: str) -> int:
    """The number of a proposal, which a locked kernel refuses and the app lists all the same."""
    cookie = app.cookie(token)
    ask(app, "POST", "/api/control/request", cookie, {})
    wait_until("a kernel", lambda: json.load(ask(app, "GET", "/api/status", cookie, {}))["connected"])
    connection = HTTPConnection("127.0.0.1", app.port, timeout=DEADLINE_S)
    refused = send(connection, "POST", "/api/proposals", cookie, {"slot": 0, "target_counts": 0})
    assert refused.status == 409, refused.read()
    return max(each["id"] for each in json.load(ask(app, "GET", "/api/proposals", cookie, {})))


def test_a_number_of_a_proposal_means_the_same_after_a_restart(short_tmp_path: Path) -> None:
    with bare_kernel(clock="real") as kernel:
        app = App(kernel, short_tmp_path / "state")
        app.start()
        token = log_in(app)
        numbers = [propose(app, token), propose(app, token)]
        for _ in range(2):
            app.kill()
            app.start()
            numbers += [propose(app, token), propose(app, token)]
        stop(app.process)
    assert numbers[:2] == [1, 2]
    assert numbers == sorted(set(numbers))
