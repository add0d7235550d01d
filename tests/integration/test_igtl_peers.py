"""Navigation programs on Debian's OpenIGTLink library, clients and servers, with headers 1 and 2, before
the real robot: every dialect through its whole sequence, with exact echoes and each answer in its order."""

from collections.abc import Callable, Iterator

import numpy as np
import pyigtl
import pytest
from conftest import RobotFile, StackFactory
from controllers import connections, make_controller
from library_navigator import Library, Tracking
from motion import (
    approve,
    confirm,
    enable,
    home_all,
    press,
    register,
    unlock,
    wait_for_mode,
    wait_until,
)
from navigation_phases import ENTRY, TARGET, Phases, aimed, short, to_targeting
from navigator import OK, Poses, Query, Rows, Status, text, transform
from stack import Stack

C, S = float(np.float32(0.96)), float(np.float32(0.28))
REGISTRATION = [C, -S, 0, 12.5, S, C, 0, -183, 0, 0, 1, -40, 0, 0, 0, 1]
ACCESS_DENIED, NOT_FOUND = 5, 4
TOOL_NAME = 19  # so many characters of a name have room in TDATA

ALL_THE_WAY = ((False, 1), (True, 2))
"""Whether it is a server, and its header version."""

Meeting = Callable[[str], tuple[Stack, Library]]


@pytest.fixture(params=["client 1", "client 2", "server 1", "server 2"])
def meet(request: pytest.FixtureRequest, stack: StackFactory, robot_file: RobotFile) -> Iterator[Meeting]:
    """A robot in a dialect, and the program that is its controller."""
    kind, version = request.param.split()
    programs: list[Library] = []

    def start(dialect: str) -> tuple[Stack, Library]:
        if kind == "server":
            programs.append(Library(int(version)))
            connect = f"127.0.0.1:{programs[0].port}"
            file = robot_file(connect=connect, first_controls=True)
            robot = stack(speed=1, robot=file, igtl=True, dialect=dialect)
            wait_until("controls", lambda: roles(robot) == ["controller"])
        else:
            robot = stack(speed=1, igtl=True, dialect=dialect)
            programs.append(Library(int(version), robot.igtl_port))
            wait_until("connected", lambda: roles(robot) == ["observer"])
            make_controller(robot)
        unlock(robot)
        home_all(robot)
        return robot, programs[0]

    yield start
    for program in programs:
        program.stop()


def roles(robot: Stack) -> list[str]:
    return [each["role"] for each in connections(robot)]


def newest(robot: Stack) -> dict:
    return robot.api.get("/api/proposals").json()[0]


@pytest.mark.parametrize("dialect", ["brp2013", "wpi2024"])
def test_the_phases_of_a_placement_one_after_the_other(meet: Meeting, dialect: str) -> None:
    """Half of the programs go all the way to the target, the others are stopped on it."""
    robot, program = meet(dialect)
    navigator = Phases(program)
    assert navigator.ask(Query("STATUS", "CURRENT_STATUS")).name == "UNDEFINED"
    assert navigator.ask(Query("TRANS", "TARGET_POSITION")).code == NOT_FOUND
    to_targeting(navigator, dialect)
    navigator.phase("MOVE_TO_TARGET", number="0004")
    approve(robot)
    press(robot)
    wait_until("it moves", lambda: newest(robot)["state"] == "executing")
    wait_until("streamed", lambda: "CURRENT_POSITION TRANSFORM" in map(short, navigator.messages()))
    if (program.is_server, program.version) in ALL_THE_WAY:
        reach(robot, navigator)
    navigator.phase("STOP", "STOP 1", number="0005")
    navigator.phase("EMERGENCY", "EMERGENCY 1", number="0006")
    assert all(axis["state"] == "DISABLED" for axis in robot.api.get("/api/motors").json())
    enable(robot, robot.api.get("/api/motors").json()[0]["slot"])
    navigator.phase("MANUAL", "MANUAL 1", number="0007")
    assert all(axis["state"] == "DISABLED" for axis in robot.api.get("/api/motors").json())
    assert navigator.ask(Query("STATUS", "CURRENT_STATUS")).name == "MANUAL"
    assert {each.header_version for each in navigator.heard.all[-5:]} == {program.version}


def reach(robot: Stack, navigator: Phases) -> None:
    confirm(robot)
    wait_until("there", lambda: newest(robot)["state"] == "done")
    navigator.await_answers("ACK_0004 STRING", "CURRENT_STATUS 1 MOVE_TO_TARGET", "MOVE_TO_TARGET 1")
    wait_until("last one", lambda: short(navigator.heard.all[-1]) == "CURRENT_POSITION TRANSFORM")
    reached = navigator.heard.all[-1].matrix[:3, 3]
    assert np.linalg.norm(reached - np.array(aimed()).reshape(4, 4)[:3, 3]) < 0.5


def test_the_exchange_of_the_thesis(meet: Meeting) -> None:
    robot, program = meet("thesis")
    register(robot)
    for name in ("scanner_to_robot_reg", "measured_cp", "measured_jp", "mode", "treatment_to_tip"):
        program.receive(name)
    set_up(robot, program)
    program.send(Query("TRANS", "scanner_to_robot_reg"))
    assert program.receive("scanner_to_robot_reg").matrix.ravel().tolist() == REGISTRATION
    program.send(Query("CAPABIL", ""))
    assert {"TRANSFORM", "STRING", "STATUS", "POINT", "NDARRAY", "TDATA"} <= set(program.receive("").content)
    stream_of_poses(program)
    assert program.ask(transform("servo_cp", REGISTRATION)).code == ACCESS_DENIED
    move_along_rows(robot, program)
    assert program.ask(text("STOP", "")).code == OK
    wait_until("ended", lambda: newest(robot)["state"] == "aborted")
    wait_for_mode(robot, "READY")


def set_up(robot: Stack, program: Library) -> None:
    """Registration, points, offset and an imager's pose are answered, stored and told again."""
    assert program.ask(transform("REGISTRATION", REGISTRATION)).code == OK
    for name, position in {"ENTRY_POINT": ENTRY, "TARGET_POINT": TARGET}.items():
        assert program.ask(pyigtl.PointMessage([position.tolist()], device_name=name)).code == OK
    assert program.ask(text("ROBOT_TO_ENTRY", "7.25")).code == OK
    assert program.ask(transform("CURRENT_POSE", REGISTRATION)).code == OK
    kept = robot.api.get("/api/targeting").json()
    assert (kept["registration"], kept["reported_position"]) == (REGISTRATION, REGISTRATION)
    assert (kept["entry_point"], kept["target_point"]) == (ENTRY.tolist(), TARGET.tolist())
    wait_until("told", lambda: np.allclose(program.receive("target_point").positions, [TARGET]))


def stream_of_poses(program: Library) -> None:
    program.send(Tracking(20))
    assert program.receive("").content is True
    streamed = program.receive("robot").content
    registration = "scanner_to_robot_reg"[:TOOL_NAME]
    assert {registration, "measured_cp"} <= set(streamed)
    assert streamed[registration] == REGISTRATION
    program.send(Tracking(None))
    assert program.receive("").content is True


def move_along_rows(robot: Stack, program: Library) -> None:
    """A trajectory of rows becomes a proposal, and what it moves is streamed as the program's own types."""
    axes = robot.api.get("/api/motors").json()
    here = [min(max(axis["position"], low(axis)), high(axis)) for axis in axes]
    there = [
        place - 1.0 if axis["unit"] == "mm" and place - 1.0 > low(axis) else place
        for place, axis in zip(here, axes, strict=True)
    ]
    assert here != there
    answer = program.ask(Rows([[0, *here], [8, *there]], "TRAJECTORY"))
    assert answer.code == OK, answer.text
    refused = program.ask(Poses([("word", np.eye(4))], "TRAJECTORY"))
    assert "row 1, name" in refused.text
    assert program.ask(text("MODE", "trajectory")).code == OK
    proposal = program.receive("proposal")
    assert isinstance(proposal, Status)
    assert newest(robot)["state"] == "checked"
    approve(robot)
    press(robot)
    wait_until("it moves", lambda: newest(robot)["state"] == "executing")
    wait_until("velocities", lambda: len(program.receive("measured_js").content) == 2)


def low(axis: dict) -> float:
    return axis["min_counts"] / axis["counts_per_unit"] + margin(axis)


def high(axis: dict) -> float:
    return axis["max_counts"] / axis["counts_per_unit"] - margin(axis)


def margin(axis: dict) -> float:
    """So far a trajectory stays from the ends of an axis."""
    return 0.02 * (axis["max_counts"] - axis["min_counts"]) / axis["counts_per_unit"]
