"""OpenIGTLink on a whole robot: with pyigtl as the navigation program, and with bytes that none sends."""

import contextlib
import os
import signal
import socket
import struct
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pyigtl
import pytest
from bare_kernel import DEADLINE_S
from conftest import StackFactory
from interface import judge
from motion import (
    LATERAL,
    enable,
    home_all,
    last_drive,
    motor,
    plant_tick,
    press,
    propose,
    register,
    set_home,
    unlock,
    wait_for_mode,
    wait_until,
)
from navigator import OK, Navigator, Poses, Query, Rows, text, transform
from stack import Stack

ACCESS_DENIED, CONFIGURATION, UNKNOWN_INSTRUCTION = 5, 10, 12
UNREACHABLE, CHECKSUM, NOT_READY = 8, 9, 13
CONNECTIONS = "/api/communications/connections"
ENTRY, TARGET = [8, 250, 70], [5, 200, 60]
C, S = float(np.float32(0.96)), float(np.float32(0.28))
REGISTRATION = [C, -S, 0, 12.5, S, C, 0, -183, 0, 0, 1, -40, 0, 0, 0, 1]


@pytest.fixture
def robot(stack: StackFactory) -> Stack:
    started = stack(speed=1, igtl=True)
    unlock(started)
    return started


@pytest.fixture
def navigate(robot: Stack) -> Iterator[Callable[..., Navigator]]:
    navigators: list[Navigator] = []

    def connect(version: int = 1) -> Navigator:
        navigators.append(Navigator(robot.igtl_port, version))
        return navigators[-1]

    yield connect
    for navigator in navigators:
        navigator.stop()


def connections(robot: Stack) -> list[dict]:
    return judge(robot.api.get(CONNECTIONS)).raise_for_status().json()


def make_controller(robot: Stack, place: int = -1) -> int:
    """The newest connection, or that one, becomes the controller."""
    wait_until("listed", lambda: len(connections(robot)) > 0)
    number = connections(robot)[place]["id"]
    answer = robot.api.put(f"{CONNECTIONS}/{number}/role", json={"role": "controller"})
    assert judge(answer).status_code == 200, answer.text
    return number


def within_reach(axis: dict) -> float:
    """Where the axis stands, or as near to it as its soft limits let a trajectory come."""
    lowest, highest = (axis[end] / axis["counts_per_unit"] for end in ("min_counts", "max_counts"))
    margin = 0.02 * (highest - lowest)
    return min(max(axis["position"], lowest + margin), highest - margin)


@pytest.mark.parametrize("version", [1, 2])
def test_the_whole_state_comes_on_connecting_in_the_version_that_the_program_speaks(
    robot: Stack, navigate: Callable[..., Navigator], version: int
) -> None:
    register(robot)
    navigator = navigate(version)
    assert np.array_equal(navigator.receive("scanner_to_robot_reg").matrix, np.eye(4))
    assert navigator.receive("mode").string == "manual"
    assert navigator.receive("treatment_to_tip").string
    assert len(navigator.receive("measured_jp").string.split(",")) == len(robot.api.get("/api/motors").json())
    assert navigator.receive("robot_status").code == OK
    answer = navigator.ask(text("IMAGER_STATUS", "scanning"))
    assert (answer.code, answer.header_version) == (OK, version)
    assert connections(robot)[0]["header_version"] == version


@pytest.mark.parametrize("version", [1, 2])
def test_what_the_controller_sets_is_stored_told_to_all_and_audited(
    robot: Stack, navigate: Callable[..., Navigator], version: int
) -> None:
    observer = navigate()
    observer.receive("mode")
    assert observer.receive("registration_state").string.endswith((" not set.", "No case is open."))
    navigator = navigate(version)
    wait_until("both listed", lambda: len(connections(robot)) == 2)
    make_controller(robot)
    assert navigator.ask(transform("REGISTRATION", REGISTRATION)).code == OK
    assert observer.receive("scanner_to_robot_reg").matrix.ravel().tolist() == REGISTRATION
    assert observer.receive("registration_state").string == "VALID"
    points = {"ENTRY_POINT": [1.5, 2, 3], "TARGET_POINT": [4, 5, 60]}
    for name, position in points.items():
        assert navigator.ask(pyigtl.PointMessage([position], names=["p"], device_name=name)).code == OK
    assert navigator.ask(text("ROBOT_TO_ENTRY", "7.25")).code == OK
    assert navigator.ask(transform("CURRENT_POSE", REGISTRATION)).code == OK
    kept = robot.api.get("/api/targeting").json()
    assert kept["registration"] == REGISTRATION
    assert (kept["entry_point"], kept["target_point"]) == ([1.5, 2, 3], [4, 5, 60])
    assert kept["robot_to_entry_offset"] == 7.25
    assert kept["reported_position"] == REGISTRATION
    history = judge(robot.api.get("/api/targeting/history")).json()
    assert [list(change["new"])[-1] for change in history["changes"]] == [
        "robot_to_entry_offset",
        "target_point",
        "entry_point",
        "registration_state",
    ]
    assert {change["source"] for change in history["changes"]} == {"openigtlink"}
    assert history["last_set"]["reported_position"]["client"].startswith("openigtlink 127.0.0.1:")
    records = robot.api.get("/api/audit", params={"records": 100}).json()
    heard = [each["detail"]["name"] for each in records if each["detail"].get("action") == "message"]
    assert heard == ["REGISTRATION", "ENTRY_POINT", "TARGET_POINT", "ROBOT_TO_ENTRY", "CURRENT_POSE"]


def test_a_pose_of_an_imager_never_takes_the_encoders_place(
    robot: Stack, navigate: Callable[..., Navigator]
) -> None:
    home_all(robot)
    register(robot)
    navigator = navigate()
    measured = navigator.receive("measured_cp").matrix
    make_controller(robot)
    assert navigator.ask(transform("CURRENT_POSE", REGISTRATION)).code == OK
    navigator.send(Query("TRANS", "measured_cp"))
    # At rest an encoder trembles by a count.
    assert np.allclose(navigator.receive("measured_cp").matrix, measured, atol=0.05)
    shown = robot.api.get("/api/targeting/alignment").json()["current"]
    assert np.allclose(np.array(shown).reshape(4, 4), measured, atol=0.05)


def test_an_observer_changes_nothing_and_may_stop(robot: Stack, navigate: Callable[..., Navigator]) -> None:
    navigator = navigate()
    before = robot.api.get("/api/targeting").json()
    for message in (transform("REGISTRATION", REGISTRATION), text("MODE", "draping"), text("START_UP", "")):
        answer = navigator.ask(message)
        assert (answer.code, answer.name) == (ACCESS_DENIED, "CONTROL")
    assert robot.api.get("/api/targeting").json() == before
    assert navigator.ask(text("STOP", "")).code == OK
    records = robot.api.get("/api/audit").json()
    assert [each["kind"] for each in records].count("stop") == 1
    assert connections(robot)[0]["refused"] == 3


REFUSED = [
    ("shear", transform("REGISTRATION", [1, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]), CONFIGURATION),
    ("coarse", transform("REGISTRATION", [1, 2e-4, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]), CONFIGURATION),
    ("zeros", transform("REGISTRATION", [0] * 15 + [1]), CONFIGURATION),
    ("mirror", transform("REGISTRATION", [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]), CONFIGURATION),
    ("far", pyigtl.PointMessage([[1e6, 0, 0]], device_name="TARGET_POINT"), CONFIGURATION),
    ("two points", pyigtl.PointMessage([[1, 0, 0], [2, 0, 0]], device_name="ENTRY_POINT"), CONFIGURATION),
    ("word for number", text("TREATMENT_TO_TIP", "long"), CONFIGURATION),
    ("large offset", text("TREATMENT_TO_TIP", "2000"), CONFIGURATION),
    ("wrong type", text("REGISTRATION", "x"), CONFIGURATION),
    ("setpoint", transform("servo_cp", REGISTRATION), ACCESS_DENIED),
    ("unknown name", text("FIRE", ""), UNKNOWN_INSTRUCTION),
    ("unknown mode", text("MODE", "dance"), UNKNOWN_INSTRUCTION),
    ("homing while disabled", text("START_UP", ""), NOT_READY),
    ("homing as a mode", text("MODE", "home"), NOT_READY),
    ("enabling", text("arm/state_command", "enable"), ACCESS_DENIED),
    ("no trajectory", text("MODE", "trajectory"), NOT_READY),
    ("no target", text("MODE", "targeting"), NOT_READY),
    ("columns", Rows([[0, 1], [1, 1]], "TRAJECTORY"), CONFIGURATION),
]


def test_what_cannot_be_is_refused_with_its_reason(robot: Stack, navigate: Callable[..., Navigator]) -> None:
    navigator = navigate(2)
    make_controller(robot)
    before = robot.api.get("/api/targeting").json()
    for what, message, code in REFUSED:
        answer = navigator.ask(message)
        assert answer.code == code, (what, answer.text)
        assert answer.text, what
    assert robot.api.get("/api/targeting").json() == before
    assert {each["state"] for each in robot.api.get("/api/proposals").json()} <= {"refused"}
    assert connections(robot)[0]["refused"] == len(REFUSED)


def test_homing_becomes_a_proposal_that_somebody_has_to_approve(
    robot: Stack, navigate: Callable[..., Navigator]
) -> None:
    set_home(robot, "feet")
    for axis in robot.api.get("/api/motors").json():
        enable(robot, axis["slot"])
    navigator = navigate()
    make_controller(robot)
    answer = navigator.ask(text("START_UP", ""))
    assert answer.code == OK, answer.text
    [proposed] = judge(robot.api.get("/api/proposals")).json()
    assert (proposed["kind"], proposed["source"], proposed["state"]) == ("home", "openigtlink", "checked")


def test_a_trajectory_becomes_a_proposal_that_somebody_has_to_approve(
    robot: Stack, navigate: Callable[..., Navigator]
) -> None:
    home_all(robot)
    axes = robot.api.get("/api/motors").json()
    here = [within_reach(axis) for axis in axes]
    navigator = navigate()
    make_controller(robot)
    answer = navigator.ask(Rows([[0, *here], [2, *here]], "TRAJECTORY"))
    assert answer.code == OK, answer.text
    assert robot.api.get("/api/trajectory").json()["rows"] == 2
    answer = navigator.ask(text("MODE", "trajectory"))
    assert answer.code == OK, answer.text
    told = navigator.receive("proposal")
    assert told.name in ("drafted", "checked")
    [proposal] = judge(robot.api.get("/api/proposals")).json()
    assert (proposal["source"], proposal["state"]) == ("openigtlink", "checked")
    assert robot.api.get("/api/mode").json()["mode"] == "manual"


def bad_arrays(axes: list[dict]) -> dict[str, tuple[Rows, str]]:
    """Trajectories of 2000 rows at one place, each wrong in one way, and where they are."""
    here = [within_reach(axis) for axis in axes]
    first, last = (f"{axis['name']} [{axis['unit']}]" for axis in (axes[0], axes[-1]))

    def rows(wrong: dict[int, list[float]], width: int = 1 + len(here)) -> Rows:
        array = [wrong.get(row + 1, [row * 0.01, *here])[:width] for row in range(2000)]
        return Rows(array, "TRAJECTORY")

    return {
        "unsorted times": (rows({30: [0.05, *here]}), "Row 30, time [s]: "),
        "beyond a limit": (rows({977: [9.76, *here[:-1], 1e4]}), f"Row 977, {last}: "),
        "no number": (rows({20: [0.19, float("nan"), *here[1:]]}), "NDARRAY, row 20, column 2: "),
        "too few columns": (rows({}, width=len(here)), f"Row 1, {last}: "),
        "too many columns": (Rows([[0, *here, 1]], "TRAJECTORY"), "Row 1, column 9: "),
        "too fast": (rows({2: [0.001, here[0] - 0.1, *here[1:]]}), f"Row 1, {first}: "),
        "empty": (Rows([[]], "TRAJECTORY"), "NDARRAY: "),
    }


def test_a_bad_array_is_refused_whole_with_row_column_and_reason_and_nothing_moves(
    robot: Stack, navigate: Callable[..., Navigator]
) -> None:
    home_all(robot)
    axes = robot.api.get("/api/motors").json()
    press(robot)
    navigator = navigate()
    make_controller(robot)
    for name, (message, place) in bad_arrays(axes).items():
        answer = navigator.ask(message)
        assert answer.code == CONFIGURATION, (name, answer.text)
        assert answer.text.startswith(place), (name, answer.text)
        assert robot.api.get("/api/trajectory").json()["rows"] == 0, name
    now = robot.api.get("/api/motors").json()
    moved = [
        abs(after["position_counts"] - axis["position_counts"]) for after, axis in zip(now, axes, strict=True)
    ]
    assert max(moved) <= 1
    assert robot.api.get("/api/proposals").json() == []


def aim(robot: Stack, navigate: Callable[..., Navigator]) -> tuple[Navigator, dict]:
    """A controller of the homed robot, and the alignment that reaches for ENTRY and TARGET."""
    home_all(robot)
    register(robot)
    navigator = navigate()
    make_controller(robot)
    target = {"entry_point": ENTRY, "target_point": TARGET}
    judge(robot.api.put("/api/targeting/target", json=target)).raise_for_status()
    reached = robot.api.get("/api/targeting/alignment").json()["alignment"]
    return navigator, reached


def test_poses_become_a_trajectory_that_leads_the_treatment_point_through_them(
    robot: Stack, navigate: Callable[..., Navigator]
) -> None:
    """From 2 mm before the pose that the alignment reaches to that pose."""
    navigator, reached = aim(robot, navigate)
    goal = np.array(reached["reachable"]).reshape(4, 4)
    drawn_back = goal.copy()
    drawn_back[:3, 3] -= 2.0 * goal[:3, 2]
    answer = navigator.ask(Poses([("0", drawn_back), ("4.5", goal)], "TRAJECTORY"))
    assert answer.code == OK, answer.text
    loaded = robot.api.get("/api/trajectory").json()
    assert (loaded["rows"], loaded["duration_s"]) == (2, 4.5)
    for axis in loaded["axes"]:
        there = reached["setpoints"][axis["name"]]["position"]
        assert min(abs(axis[end] - there) for end in ("lowest", "highest")) < 0.05, axis
    assert max(axis["highest"] - axis["lowest"] for axis in loaded["axes"] if axis["unit"] == "mm") > 1.0
    assert navigator.ask(text("MODE", "trajectory")).code == OK
    register(robot, REGISTRATION)
    wait_until("it is stale", lambda: robot.api.get("/api/proposals").json()[0]["state"] == "aborted")
    refused = navigator.ask(text("MODE", "trajectory"))
    assert (refused.code, refused.name) == (NOT_READY, "STALE")


def test_bad_poses_are_refused_with_row_column_and_reason(
    robot: Stack, navigate: Callable[..., Navigator]
) -> None:
    navigator, reached = aim(robot, navigate)
    good = np.array(reached["reachable"]).reshape(4, 4)
    far = good.copy()
    far[:3, 3] += 500.0 * good[:3, 2]
    shear, not_a_number = good.copy(), good.copy()
    shear[0, 1] += 0.1
    not_a_number[1, 3] = np.nan
    for second, place in (
        (("word", good), "TRAJECTORY, row 2, name: "),
        (("0", good), "Row 2, time [s]: "),
        (("1", shear), "Row 2, pose: "),
        (("1", far), "Row 2, "),
        (("1", not_a_number), "TDATA, row 2, matrix: "),
    ):
        answer = navigator.ask(Poses([("0", good), second], "TRAJECTORY"))
        assert answer.code in (CONFIGURATION, UNREACHABLE), answer.text
        assert answer.text.startswith(place), answer.text
    assert robot.api.get("/api/trajectory").json()["rows"] == 0


def test_the_controller_hears_something_every_50_ms_while_a_move_of_one_axis_is_approved(
    robot: Stack, navigate: Callable[..., Navigator]
) -> None:
    home_all(robot)
    navigator = navigate()
    make_controller(robot)
    axis = motor(robot, LATERAL)
    propose(robot, (axis["min_counts"] + axis["max_counts"]) // 2)
    begun, tick = len(navigator.heard.all), robot.status()["tick"]

    def told() -> int:
        return [message.device_name for message in navigator.heard.all[begun:]].count("robot_status")

    wait_until("told twenty times", lambda: told() >= 20)
    assert robot.status()["tick"] - tick < 5000, "at rest it would be once a second"


def moving(robot: Stack, navigate: Callable[..., Navigator]) -> Navigator:
    """The robot moves along a trajectory of the controller's."""
    home_all(robot)
    axes = robot.api.get("/api/motors").json()
    here = [within_reach(axis) for axis in axes]
    there = [
        place - (1.0 if axis["slot"] == LATERAL else 0.0) for place, axis in zip(here, axes, strict=True)
    ]
    navigator = navigate()
    make_controller(robot)
    assert navigator.ask(Rows([[0, *here], [8, *there]], "TRAJECTORY")).code == OK
    assert navigator.ask(text("MODE", "trajectory")).code == OK
    [proposal] = robot.api.get("/api/proposals").json()
    robot.api.post(f"/api/proposals/{proposal['id']}/approve").raise_for_status()
    press(robot)
    wait_until("it moves", lambda: robot.api.get("/api/proposals").json()[0]["state"] == "executing")
    return navigator


@pytest.mark.parametrize("mode", ["targeting", "insertion", "draping"])
def test_a_mode_becomes_a_proposal_that_moves_once_it_is_approved(
    robot: Stack, navigate: Callable[..., Navigator], mode: str
) -> None:
    home_all(robot)
    register(robot)
    navigator = navigate()
    make_controller(robot)
    for name, point in {"ENTRY_POINT": ENTRY, "TARGET_POINT": TARGET}.items():
        assert navigator.ask(pyigtl.PointMessage([point], device_name=name)).code == OK
    answer = navigator.ask(text("MODE", mode))
    assert answer.code == OK, answer.text
    [proposal] = robot.api.get("/api/proposals").json()
    assert (proposal["source"], proposal["state"]) == ("openigtlink", "checked")
    robot.api.post(f"/api/proposals/{proposal['id']}/approve").raise_for_status()
    press(robot)
    wait_until("it moves", lambda: newest(robot)["state"] == "executing")
    assert robot.api.get("/api/mode").json()["mode"] != "manual"


def test_a_stop_overtakes_a_mode_that_waits_for_its_turn(robot: Stack) -> None:
    home_all(robot)
    with socket.create_connection(("127.0.0.1", robot.igtl_port)) as program:
        wait_until("listed", lambda: len(connections(robot)) == 1)
        make_controller(robot)
        program.sendall(text("MODE", "draping").pack() + text("STOP", "").pack())
        wait_until("refused", lambda: connections(robot)[0]["refused"] == 1)
    assert [each for each in robot.api.get("/api/proposals").json() if each["state"] != "aborted"] == []


def newest(robot: Stack) -> dict:
    return robot.api.get("/api/proposals").json()[0]


def test_the_loss_of_the_controller_pauses_what_moves_until_somebody_presses_anew(
    robot: Stack, navigate: Callable[..., Navigator]
) -> None:
    navigator = moving(robot, navigate)
    navigator.stop()
    wait_until("paused", lambda: newest(robot)["state"] == "paused")
    wait_for_mode(robot, "READY")
    assert "controller was lost" in newest(robot)["detail"]
    press(robot)
    wait_until("goes on", lambda: newest(robot)["state"] == "executing")


def test_another_controller_ends_what_the_lost_one_had_asked_for(
    robot: Stack, navigate: Callable[..., Navigator]
) -> None:
    navigator = moving(robot, navigate)
    assert navigator.ask(text("MODE", "trajectory")).code == OK
    navigator.stop()
    wait_until("paused", lambda: robot.api.get("/api/proposals").json()[1]["state"] == "paused")
    assert newest(robot)["state"] == "aborted", "nobody had approved it"
    wait_until("gone", lambda: connections(robot) == [])
    navigate()
    make_controller(robot)
    assert [each["state"] for each in robot.api.get("/api/proposals").json()] == ["aborted", "aborted"]


def test_stop_over_openigtlink_stops_what_moves(robot: Stack, navigate: Callable[..., Navigator]) -> None:
    navigator = moving(robot, navigate)
    assert navigator.ask(text("STOP", "")).code == OK
    wait_until("ended", lambda: robot.api.get("/api/proposals").json()[0]["state"] == "aborted")


def test_a_stop_does_not_wait_for_what_its_sender_has_sent_before(
    robot: Stack, navigate: Callable[..., Navigator]
) -> None:
    """Of a thousand messages a hundred are read in 100 ms."""
    moving(robot, navigate)
    with socket.create_connection(("127.0.0.1", robot.igtl_port)) as program:
        program.sendall(Query("STATUS", "robot_status").pack() * 1000 + text("STOP", "").pack())
        sent_tick = plant_tick(robot)
        wait_until("all of it is read", lambda: plant_tick(robot) > sent_tick + 1000)
    assert sent_tick - 100 < last_drive(robot) < sent_tick + 500
    assert newest(robot)["state"] == "aborted"


def test_the_role_ends_with_control(robot: Stack, navigate: Callable[..., Navigator]) -> None:
    navigator = navigate()
    make_controller(robot)
    assert navigator.ask(text("ROBOT_TO_ENTRY", "1")).code == OK
    robot.api.post("/api/control/release").raise_for_status()
    assert navigator.ask(text("ROBOT_TO_ENTRY", "2")).code == ACCESS_DENIED
    assert connections(robot)[0]["role"] == "observer"
    refused = robot.api.put(f"{CONNECTIONS}/{connections(robot)[0]['id']}/role", json={"role": "controller"})
    assert judge(refused).status_code == 409


def test_there_is_one_controller(robot: Stack, navigate: Callable[..., Navigator]) -> None:
    navigate()
    wait_until("one", lambda: len(connections(robot)) == 1)
    make_controller(robot, 0)
    navigate()
    wait_until("two", lambda: len(connections(robot)) == 2)
    make_controller(robot, 1)
    assert [each["role"] for each in connections(robot)] == ["observer", "controller"]


def test_each_connection_is_shown_and_can_be_ended(robot: Stack, navigate: Callable[..., Navigator]) -> None:
    navigator = navigate()
    navigator.ask(text("IMAGER_STATUS", "scanning"))
    [shown] = connections(robot)
    assert shown["dialect"] == "thesis"
    assert shown["port"] == robot.igtl_port
    [heard] = shown["messages"]
    assert (heard["name"], heard["type"], heard["count"]) == ("IMAGER_STATUS", "STRING", 1)
    assert 0 <= heard["age_s"] < DEADLINE_S
    listed = judge(robot.api.get("/api/communications")).json()
    assert [each["client"] for each in listed if each["type"] == "openigtlink"] == [shown["client"]]
    assert judge(robot.api.delete(f"{CONNECTIONS}/{shown['id']}")).status_code == 200
    assert judge(robot.api.delete(f"{CONNECTIONS}/{shown['id']}")).status_code == 404
    assert judge(robot.api.put(f"{CONNECTIONS}/{shown['id']}/role", json={"role": "king"})).status_code == 422


def test_the_last_words_of_an_imager_are_kept_with_their_age_and_outlive_their_sender(
    robot: Stack, navigate: Callable[..., Navigator]
) -> None:
    def imager() -> dict:
        return judge(robot.api.get("/api/communications/imager")).raise_for_status().json()

    assert imager() == {"status": None, "tip": None}
    navigator = navigate()
    assert navigator.ask(text("IMAGER_STATUS", "warming up")).code == OK
    assert navigator.ask(text("IMAGER_STATUS", "scanning")).code == OK
    assert navigator.ask(transform("TIP_POSE", REGISTRATION)).code == OK
    mirror = [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
    assert navigator.ask(transform("TIP_POSE", mirror)).code == CONFIGURATION
    [connection] = connections(robot)
    status, tip = (imager()[key] for key in ("status", "tip"))
    assert (status["code"], status["name"], status["text"]) == (None, "", "scanning")
    assert tip["scanner_from_tip"] == REGISTRATION
    for word in (status, tip):
        assert word["client"] == connection["client"]
        assert 0 <= word["age_s"] < DEADLINE_S
    navigator.stop()
    wait_until("gone", lambda: connections(robot) == [])
    wait_until("older", lambda: imager()["status"]["age_s"] > status["age_s"])
    assert imager()["status"]["text"] == "scanning"


def bare(robot: Stack) -> socket.socket:
    connection = socket.create_connection(("127.0.0.1", robot.igtl_port), timeout=DEADLINE_S)
    connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return connection


def header(kind: bytes, size: int, crc: int = 0, version: int = 1) -> bytes:
    return struct.pack(">H12s20sQQQ", version, kind, b"NAME", 0, size, crc)


HOSTILE = [
    header(b"VIDEO", 0xFFFFFFFF) + bytes(400),
    header(b"STRING", 2**64 - 1) + bytes(400),
    header(b"TRANSFORM", 2**32 + 48) + bytes(48),
    header(b"TRANSFORM", 0x7FFFFFFF) + bytes(400),
    header(b"TRANSFORM", 0),
    header(b"TRANSFORM", 47) + bytes(47),
    header(b"STRING", 4) + b"\0\3\xff\xff",
    header(b"STRING", 12, version=2) + b"\xff" * 12,
    header(b"STRING", 4, version=9) + bytes(4),
    b"GET / HTTP/1.1\r\nHost: x\r\n\r\n" + bytes(100),
    bytes(58),
]


def test_hostile_bytes_harm_nobody(robot: Stack, navigate: Callable[..., Navigator]) -> None:
    navigator = navigate()
    app = robot.pid("app")
    for hostile in HOSTILE:
        with bare(robot) as connection:
            connection.sendall(hostile)
            connection.shutdown(socket.SHUT_WR)
            with contextlib.suppress(ConnectionResetError):
                while connection.recv(4096):
                    pass
    assert navigator.ask(text("IMAGER_STATUS", "still here")).code == OK
    assert robot.pid("app") == app


def test_a_program_that_is_frozen_disturbs_nobody(robot: Stack, navigate: Callable[..., Navigator]) -> None:
    code = (
        "import socket, sys\n"
        "peer = socket.create_connection(('127.0.0.1', int(sys.argv[1])))\n"
        "print('on', flush=True)\n"
        "sys.stdin.read()\n"
    )
    with subprocess.Popen(
        [sys.executable, "-c", code, str(robot.igtl_port)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    ) as frozen:
        assert frozen.stdout is not None
        assert frozen.stdout.readline() == "on\n"
        os.kill(frozen.pid, signal.SIGSTOP)
        navigator = navigate()
        assert navigator.ask(text("IMAGER_STATUS", "scanning")).code == OK
        frozen.kill()
    wait_until("it is gone", lambda: len(connections(robot)) == 1)


def test_two_hundred_connections_leave_no_descriptor(robot: Stack) -> None:
    descriptors = Path(f"/proc/{robot.pid('app')}/fd")
    bare(robot).close()
    wait_until("gone", lambda: connections(robot) == [])
    before = len(list(descriptors.iterdir()))
    for _ in range(200):
        with bare(robot) as connection:
            connection.recv(58)
    wait_until("all gone", lambda: connections(robot) == [])
    assert len(list(descriptors.iterdir())) <= before
