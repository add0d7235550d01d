"""What [openigtlink] of a robot's file says of connections, and `interlock igtl` at the other end of one."""

import contextlib
import json
import os
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator

import pyigtl
import pytest
from bare_kernel import BIN, DEADLINE_S
from conftest import RobotFile, StackFactory
from controllers import (
    CONNECTIONS,
    assert_rest_and_fresh_consent,
    connections,
    make_controller,
    ticks_around,
)
from interface import judge
from motion import is_driven, propose, register, to_motion, wait_for_proposal, wait_until
from navigator import OK, Navigator, text
from stack import Stack

HEARTBEAT_MS = 200
REGULAR_S = 2.5


def igtl(robot: Stack, *arguments: str) -> subprocess.CompletedProcess:
    command = [str(BIN / "interlock"), "igtl", *arguments, "--port", str(robot.igtl_port)]
    return subprocess.run(command, capture_output=True, text=True, timeout=DEADLINE_S, check=False)


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as server:
        return server.getsockname()[1]


@contextlib.contextmanager
def listening(port: int) -> Iterator[pyigtl.OpenIGTLinkServer]:
    server = pyigtl.OpenIGTLinkServer(port=port, local_server=True)
    try:
        yield server
    finally:
        server.stop()


def test_the_robot_connects_to_a_program_that_listens(stack: StackFactory, robot_file: RobotFile) -> None:
    port = free_port()
    file = robot_file(connect=f"127.0.0.1:{port}", first_controls=True)
    with listening(port) as server:
        robot = stack(speed=1, robot=file, igtl=True)
        mode = server.wait_for_message("mode", timeout=DEADLINE_S)
        assert mode is not None
        assert mode.string == "manual"
        wait_until("the controller", lambda: [each["role"] for each in connections(robot)] == ["controller"])
        server.send_message(text("ROBOT_TO_ENTRY", "7.25"))
        answer = server.wait_for_message("ROBOT_TO_ENTRY", timeout=DEADLINE_S)
        assert answer is not None
        assert answer.code == OK
        assert robot.api.get("/api/targeting").json()["robot_to_entry_offset"] == 7.25
        assert judge(robot.api.delete(f"{CONNECTIONS}/{connections(robot)[0]['id']}")).status_code == 200
        wait_until("connected again", lambda: [each["id"] for each in connections(robot)] == [2])


def test_the_first_connection_controls_where_the_file_says_so(
    stack: StackFactory, robot_file: RobotFile
) -> None:
    robot = stack(speed=1, robot=robot_file(first_controls=True), igtl=True)
    first = Navigator(robot.igtl_port)
    wait_until("one", lambda: len(connections(robot)) == 1)
    second = Navigator(robot.igtl_port)
    wait_until("two", lambda: len(connections(robot)) == 2)
    assert [each["role"] for each in connections(robot)] == ["controller", "observer"]
    assert first.ask(text("ROBOT_TO_ENTRY", "7.25")).code == OK
    robot.api.post("/api/control/release").raise_for_status()
    assert [each["role"] for each in connections(robot)] == ["observer", "observer"]
    robot.take_control()
    assert [each["role"] for each in connections(robot)] == ["controller", "observer"]
    records = robot.api.get("/api/audit", params={"records": 100}).json()
    given = [each for each in records if each["detail"].get("action") == "role"]
    assert [each["actor"] for each in given] == ["admin", "admin"]
    first.stop()
    second.stop()


BEATING = """
import os, select, signal, socket, struct, sys, time
peer = socket.create_connection(('127.0.0.1', int(sys.argv[1])))
beat = struct.pack('>H12s20sQQQ', 1, b'GET_STATUS', b'robot_status', 0, 0, 0)
asked = []
signal.signal(signal.SIGUSR1, lambda *_: asked.append('freeze'))
sys.stdin.readline()
since = answered = time.monotonic()
told = False
while True:
    now = time.monotonic()
    since = since if now - answered < 0.1 else now
    regular = now - since > float(sys.argv[2])
    if regular and not told:
        print('regular', flush=True)
        told = True
    if regular and asked:
        os.kill(os.getpid(), signal.SIGSTOP)
    peer.sendall(beat)
    readable, _, _ = select.select([peer], [], [], 0)
    if readable:
        if not peer.recv(65536):
            sys.exit()
        answered = time.monotonic()
    time.sleep(0.02)
"""


def freeze(program: subprocess.Popen) -> None:
    """Stops it once both have long heard each other without a gap, which a busy machine may make."""
    program.send_signal(signal.SIGUSR1)
    _, status = os.waitpid(program.pid, os.WUNTRACED)
    assert os.WIFSTOPPED(status)


@pytest.mark.parametrize("keys", [{}, {"heartbeat_ms": HEARTBEAT_MS}], ids=["regular", "heartbeat_ms"])
def test_a_controller_that_freezes_pauses_the_motion_within_300_ms(
    stack: StackFactory, robot_file: RobotFile, keys: dict
) -> None:
    """Its machine lives and goes on to acknowledge, so that only its silence tells."""
    robot = stack(speed=1, robot=robot_file(**keys), igtl=True)
    command = [sys.executable, "-c", BEATING, str(robot.igtl_port), str(REGULAR_S)]
    with subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1
    ) as program:
        assert program.stdin is not None
        assert program.stdout is not None
        wait_until("connected", lambda: len(connections(robot)) == 1)
        program.stdin.write("begin\n")
        make_controller(robot)
        to_motion(robot)
        assert program.stdout.readline() == "regular\n"
        number = propose(robot, -1900)
        wait_until("driven", lambda: is_driven(robot))
        frozen_between = ticks_around(robot, lambda: freeze(program))
        wait_for_proposal(robot, number, "paused")
        program.kill()
    assert_rest_and_fresh_consent(robot, number, frozen_between)


def test_send_shows_the_answer_and_listen_what_the_robot_tells(stack: StackFactory) -> None:
    robot = stack(speed=1, igtl=True)
    noted = igtl(robot, "send", "string", "IMAGER_STATUS", "scanning")
    assert (noted.returncode, noted.stdout) == (0, "IMAGER_STATUS STATUS 1 OK: Noted.\n")
    refused = igtl(robot, "send", "transform", "REGISTRATION", "1", "-2.5", "3", "--json")
    assert refused.returncode == 1
    assert (json.loads(refused.stdout)["code"], json.loads(refused.stdout)["error"]) == (5, "CONTROL")
    assert "observer" in refused.stderr

    def asked() -> dict:
        return json.loads(igtl(robot, "send", "get", "scanner_to_robot_reg", "TRANSFORM", "--json").stdout)

    assert asked()["code"] == 4, "no registration is set"
    register(robot)
    wait_until("it is known", lambda: "matrix" in asked())
    assert asked()["matrix"] == [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
    heard = igtl(robot, "listen", "--name", "mode", "--count", "1", "--wait", "5")
    assert (heard.returncode, heard.stdout) == (0, "mode STRING manual\n")
    point = igtl(robot, "send", "point", "TARGET_POINT", "1", "2", "3")
    assert (point.returncode, "CONTROL" in point.stdout) == (1, True)


def test_phase_shows_each_answer_with_its_time(stack: StackFactory) -> None:
    robot = stack(speed=1, igtl=True, dialect="brp2013")
    stop = igtl(robot, "phase", "STOP", "--id", "7")
    assert stop.returncode == 0, stop.stderr
    lines = stop.stdout.splitlines()
    assert [line.split(" ms  ")[1].split()[0] for line in lines] == ["ACK_7", "CURRENT_STATUS", "STOP"]
    unknown = igtl(robot, "phase", "NO_SUCH_PHASE", "--id", "8")
    assert (unknown.returncode, "There is no phase" in unknown.stderr) == (1, True)
    refused = igtl(robot, "phase", "START_UP", "--json")
    assert refused.returncode == 1
    assert [json.loads(line)["name"] for line in refused.stdout.splitlines()][-1] == "START_UP"


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["send", "string", "X", "y", "--port", "1"], 6, "interlock run --igtl-port"),
        (["send", "transform", "X", "1", "2"], 2, "3 numbers"),
        (["send", "transform", "X", "1", "2", "x"], 2, "no number"),
        (["send", "point", "X", "1"], 2, "3 numbers"),
        (["send", "status", "X", "70000"], 2, "code"),
        (["send", "string", "X"], 2, "one text"),
        (["send", "song", "X", "y"], 2, "song"),
        (["send", "string", "x" * 21, "y"], 2, "20"),
        (["phase"], 2, "PHASE"),
        (["listen", "--wait", "-1"], 2, "--wait"),
    ],
)
def test_what_is_wrong_is_named(arguments: list[str], code: int, words: str) -> None:
    done = subprocess.run(
        [str(BIN / "interlock"), "igtl", *arguments], capture_output=True, text=True, check=False
    )
    assert done.returncode == code
    assert words in done.stderr
