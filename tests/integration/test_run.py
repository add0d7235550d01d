"""`interlock run`: starts the robot, watches it, and leaves nothing behind."""

import re
import signal
import socket
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from bare_kernel import BIN, DEADLINE_S, ROOT
from conftest import StackFactory
from stack import PROGRAMS, Stack, has_ended, watched

DONE, REFUSED, USAGE, PRECONDITION, PROCESS_ENDED, APP_KEPT_ENDING = range(6)


def interlock(*arguments: str | Path) -> subprocess.CompletedProcess:
    """Runs a command that is expected to end by itself."""
    command = [str(part) for part in (BIN / "interlock", *arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=DEADLINE_S)


def pids(stack: Stack, *names: str) -> list[int]:
    """Of the programs of these names, of all without names."""
    return [stack.pid(name) for name in names or PROGRAMS]


def is_free(port: int) -> bool:
    with socket.socket() as listener:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            listener.bind(("127.0.0.1", port))
        except OSError:
            return False
    return True


@pytest.fixture
def private(short_tmp_path: Path) -> Iterator[Stack]:
    """As a person starts it: the sockets in a private directory under $XDG_RUNTIME_DIR."""
    stack = Stack(short_tmp_path, "--clock", "sim")
    yield stack
    stack.close()


def assert_nothing_left(stack: Stack, children: list[int]) -> None:
    assert list(stack.runtime.iterdir()) == []
    assert not any(stack.sockets.glob("*"))
    assert is_free(stack.port)
    assert [pid for pid in children if Path(f"/proc/{pid}").exists()] == []


def test_serves_the_api_of_the_robot_that_was_asked_for(stack: StackFactory) -> None:
    status = stack().status()
    assert status["robot"] == "neuro"
    assert status["connected"]
    assert status["simulated"]
    assert status["clock"] == "sim"


def test_control_socket_of_the_plant_is_in_the_given_directory(stack: StackFactory) -> None:
    assert stack().control("status")["ok"]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_signal_ends_all_and_leaves_nothing_behind(private: Stack, number: signal.Signals) -> None:
    children = pids(private)
    private.run.send_signal(number)
    assert private.wait() == DONE
    assert_nothing_left(private, children)


def test_given_socket_directory_is_left_empty(stack: StackFactory) -> None:
    running = stack()
    children = pids(running)
    assert {path.name for path in running.sockets.iterdir()} >= {"bus.sock", "control.sock", "link.sock"}
    running.run.send_signal(signal.SIGINT)
    assert running.wait() == DONE
    assert_nothing_left(running, children)


def test_killed_app_is_restarted_and_serves_while_the_kernel_runs_on(stack: StackFactory) -> None:
    running = stack()
    app, others = running.pid("app"), pids(running, "simulator", "recorder", "kernel")
    before = running.status()["tick"]
    running.signal("app", signal.SIGKILL)
    running.output.wait_for(r"app ended: killed by signal 9 .*restarting it \(1 of 5")
    running.output.wait_for(r"^ready ", count=2)
    assert running.pid("app") != app
    assert pids(running, "simulator", "recorder", "kernel") == others
    assert running.status_when(lambda status: status["connected"])["tick"] > before


def test_app_that_keeps_ending_ends_all_with_the_cause(private: Stack) -> None:
    for start in range(1, 7):
        private.output.wait_for(r"^ready ", count=start)
        children = pids(private)
        private.signal("app", signal.SIGKILL)
    assert private.wait() == APP_KEPT_ENDING
    assert "app ended: killed by signal 9 (Killed); it was restarted 5 times" in private.output.text
    assert_nothing_left(private, children)


def test_a_frozen_app_is_killed_after_the_time_of_its_unit_and_restarted(stack: StackFactory) -> None:
    unit = (ROOT / "app/packaging/systemd/interlock-app.service").read_text()
    watchdog_s = re.search(r"^WatchdogSec=(\d+)$", unit, re.MULTILINE)
    assert watchdog_s
    running = stack()
    app, kernel = running.pid("app"), running.pid("kernel")
    running.signal("app", signal.SIGSTOP)
    running.output.wait_for(rf"app gave no sign of life for {watchdog_s[1]} s; ending it")
    running.output.wait_for(r"app ended: killed by signal 9 .*restarting it \(1 of 5")
    running.output.wait_for(r"^ready ", count=2)
    assert running.pid("app") != app
    assert running.pid("kernel") == kernel
    assert running.status_when(lambda status: status["connected"])


def test_a_recorder_that_keeps_ending_is_left_and_the_robot_goes_on(stack: StackFactory) -> None:
    running = stack()
    others = pids(running, "simulator", "kernel", "app")
    for start in range(1, 7):
        running.output.wait_for(r"^ready ", count=start)
        running.signal("recorder", signal.SIGKILL)
    running.output.wait_for(r"recorder ended: .*; it was restarted 5 times .* it is not started again")
    assert pids(running, "simulator", "kernel", "app") == others
    running.signal("app", signal.SIGKILL)
    running.output.wait_for(r"app ended: .*restarting it \(1 of 5")
    running.output.wait_for(r"^ready ", count=8)


@pytest.mark.parametrize("name", ["kernel", "simulator"])
def test_end_of_kernel_or_simulator_ends_all_with_the_cause(private: Stack, name: str) -> None:
    children = pids(private)
    private.signal(name, signal.SIGKILL)
    assert private.wait() == PROCESS_ENDED
    assert f"interlock: {name} ended: killed by signal 9 (Killed)" in private.output.text
    assert_nothing_left(private, children)


def test_killed_supervisor_takes_its_children_along_and_the_next_start_clears_its_directory(
    private: Stack, short_tmp_path: Path
) -> None:
    with watched(*pids(private)) as children:
        private.run.kill()
        assert private.wait() == -signal.SIGKILL
        assert all(has_ended(child) for child in children)
    (left,) = private.runtime.iterdir()
    following = Stack(short_tmp_path, "--clock", "sim")
    try:
        assert not left.exists()
    finally:
        following.close()
    assert_nothing_left(following, [])


def test_second_instance_is_refused_and_the_first_runs_on(private: Stack) -> None:
    children = pids(private)
    before = private.status()["tick"]
    second = interlock("run", "--port", "0", "--state", private.state, "--clock", "sim")
    assert second.returncode == PRECONDITION
    assert f"another instance uses the state directory {private.state}" in second.stderr
    assert f"process {private.run.pid}, {private.url}" in second.stderr
    assert second.stdout == ""
    assert pids(private) == children
    assert private.status()["tick"] >= before


def test_two_instances_with_their_own_state_run_side_by_side(stack: StackFactory) -> None:
    first, second = stack(), stack()
    assert first.port != second.port
    assert first.status()["connected"]
    assert second.status()["connected"]


def test_busy_port_is_named_and_nothing_starts(short_tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = listener.getsockname()[1]
        refused = interlock("run", "--port", str(port), "--state", short_tmp_path / "state")
    assert refused.returncode == PRECONDITION
    assert f"port {port} of 127.0.0.1 cannot be used: Address already in use" in refused.stderr
    assert refused.stdout == ""


def test_refused_robot_is_named_with_its_line_and_nothing_starts(short_tmp_path: Path) -> None:
    text = (ROOT / "models/robots/neuro.toml").read_text()
    robot = short_tmp_path / "broken.toml"
    robot.write_text(text.replace("coast_counts = 12", "coast_counts = 0", 1))
    refused = interlock("run", "--robot", robot, "--state", short_tmp_path / "state")
    assert refused.returncode == REFUSED
    line = text[: text.index("coast_counts = 12")].count("\n") + 1
    assert f"{robot}:{line}: axis.yaw.mechanics.coast_counts" in refused.stderr
    assert refused.stdout == ""
    assert not (short_tmp_path / "state").exists()


def test_unknown_robot_names_the_places_that_were_looked_at(short_tmp_path: Path) -> None:
    refused = interlock("run", "--robot", "elbow", "--state", short_tmp_path)
    assert refused.returncode == PRECONDITION
    assert "models/robots/elbow.toml" in refused.stderr


@pytest.mark.parametrize(
    "arguments",
    [
        ("--port", "65536"),
        ("--clock", "lunar"),
        ("--clock", "real"),
        ("--speed", "0"),
        ("--speed", "-1"),
        ("--speed", "2", "--realtime"),
        ("--speed", "2", "--clock", "sim"),
        ("--realtime", "--clock", "sim"),
        ("--plant", "/nowhere.toml"),
        ("--elbow",),
    ],
)
def test_wrong_option_is_a_usage_error(arguments: tuple[str, ...]) -> None:
    refused = interlock("run", *arguments)
    assert refused.returncode == USAGE
    assert arguments[0] in refused.stderr


def test_robot_can_be_a_file(stack: StackFactory, short_tmp_path: Path) -> None:
    robot = short_tmp_path / "copy.toml"
    robot.write_text((ROOT / "models/robots/neuro.toml").read_text())
    assert stack(robot=robot).status()["robot"] == "neuro"
