"""The app's HTTP interface and stream on a whole robot: what it answers is what spec/openapi.yaml says."""

import json
import signal
import struct
import zlib
from collections.abc import Iterator

import httpx
import pytest
from conftest import StackFactory
from interface import METHODS, judge, paths, spec
from motion import (
    LATERAL,
    enable,
    motor,
    open_stream,
    press,
    proposal,
    propose,
    to_motion,
    unlock,
    wait_for_mode,
    wait_for_proposal,
    wait_until,
)
from stack import Stack
from websockets.exceptions import InvalidStatus
from websockets.sync.client import ClientConnection

EMPTY_SLOT = 5
ROTATION = 1
FAR = -1900
RELEASE_TICKS = 500
# From the command until the plant's contacts are closed.
PRESS_TICKS = 10


@pytest.fixture
def robot(stack: StackFactory) -> Stack:
    return stack()


def texts(stream: ClientConnection) -> Iterator[dict]:
    for message in stream:
        if isinstance(message, str):
            yield json.loads(message)


def last(robot: Stack, kind: str) -> int | None:
    """Plant tick of the newest event of that kind."""
    return robot.control("record_event", kind=kind)["event_tick"]


def problem(answer: httpx.Response, status: int, code: str) -> dict:
    judge(answer)
    assert (answer.status_code, answer.json()["code"]) == (status, code), answer.text
    return answer.json()


def test_every_readable_path_answers_as_described(robot: Stack) -> None:
    to_motion(robot)
    number = propose(robot, -200)
    for target in (
        "/api/status",
        "/api/motors",
        f"/api/motors/{LATERAL}",
        "/api/proposals",
        f"/api/proposals/{number}",
        "/api/bench",
    ):
        assert judge(robot.api.get(target)).status_code == 200


def test_the_configuration_for_the_page_is_the_one_that_the_kernel_runs(robot: Stack) -> None:
    answer = judge(robot.api.get("/api/kernel/configuration")).raise_for_status().json()
    words = answer["words"]
    packed = struct.pack(f"<{len(words)}I", *words)
    assert words[1] == len(packed)
    assert zlib.crc32(packed[:-4]) == words[-1]
    assert answer["crc"] == f"{words[-1]:08x}" == robot.status()["config_crc"]


def test_every_path_answers_its_methods_and_no_others(robot: Stack) -> None:
    for path, operations in paths().items():
        target = path.replace("{axis}", str(LATERAL)).replace("{id}", "1").replace("{action}", "disable")
        for method in METHODS - operations.keys():
            answer = robot.api.request(method, target.replace("{command}", "status"))
            problem(answer, 405, "METHOD_NOT_ALLOWED")
            assert set(answer.headers["allow"].lower().split(", ")) == operations.keys(), path


def test_every_action_on_a_motor_answers_with_a_verdict(robot: Stack) -> None:
    unlock(robot)
    item = spec()["paths"]["/api/motors/{axis}/{action}"]
    [actions] = [each["schema"]["enum"] for each in item["parameters"] if each.get("name") == "action"]
    for action in actions:
        answer = judge(robot.api.post(f"/api/motors/{LATERAL}/{action}"))
        assert answer.status_code in {200, 409}, answer.text


def test_unlocking_twice_is_refused_with_its_reason(robot: Stack) -> None:
    unlock(robot)
    assert problem(robot.api.post("/api/reset"), 409, "MODE")["next_step"]


def test_a_stream_tells_a_move_from_draft_to_done(robot: Stack) -> None:
    with open_stream(robot) as stream:
        to_motion(robot)
        number = propose(robot, -300)
        states = []
        for message in texts(stream):
            if message["type"] == "proposal" and message["id"] == number:
                states.append(message["state"])
                if message["state"] == "done":
                    break
        assert states == ["drafted", "checked", "approved", "executing", "done"]


def test_a_stream_tells_modes_axes_and_refusals_but_no_routine(robot: Stack) -> None:
    with open_stream(robot) as stream:
        to_motion(robot)
        wait_for_proposal(robot, propose(robot, -300), "done")
        assert robot.api.post("/api/reset").status_code == 409
        told = []
        for message in texts(stream):
            if message["type"] == "event":
                told.append(message)
                if message.get("request") == "RESET" and message["verdict"] == "MODE":
                    break
    modes = [(event["from"], event["to"]) for event in told if event["kind"] == "mode"]
    assert modes == [("LOCKED", "READY"), ("READY", "MOTION")]
    axis = [(event["from"], event["to"]) for event in told if event["kind"] == "axis"]
    assert {("DISABLED", "ENABLED"), ("ENABLED", "MOVING"), ("MOVING", "ENABLED")} <= set(axis)
    accepted = {event["request"] for event in told if event.get("verdict") == "ACCEPTED"}
    assert not accepted & {"HEARTBEAT", "MOVE"}


def test_a_refused_move_names_verdict_range_and_next_step(robot: Stack) -> None:
    to_motion(robot)
    answer = robot.api.post("/api/proposals", json={"slot": LATERAL, "target_counts": 100_000})
    refusal = problem(answer, 409, "RANGE")
    assert str(motor(robot)["max_counts"]) in refusal["expected"]
    assert refusal["next_step"]
    assert judge(robot.api.get("/api/proposals")).json()[0]["state"] == "refused"


def test_a_move_in_the_unit_of_the_axis_arrives(robot: Stack) -> None:
    to_motion(robot)
    answer = judge(robot.api.post("/api/proposals", json={"slot": LATERAL, "target": -5.0}))
    wait_for_proposal(robot, answer.json()["id"], "done")
    axis = motor(robot)
    assert abs(axis["position"] + 5.0) <= 1.5 / axis["counts_per_unit"]


def test_a_disabled_axis_takes_no_proposal(robot: Stack) -> None:
    unlock(robot)
    answer = robot.api.post("/api/proposals", json={"slot": LATERAL, "target_counts": 0})
    assert "enable" in problem(answer, 409, "DISABLED")["next_step"].lower()


def test_a_locked_system_takes_no_proposal(robot: Stack) -> None:
    wait_for_mode(robot, "LOCKED")
    problem(robot.api.post("/api/proposals", json={"slot": LATERAL, "target_counts": 0}), 409, "MODE")


@pytest.mark.parametrize(
    ("body", "field"),
    [
        ({"target": 1}, "slot"),
        ({"slot": LATERAL}, "target"),
        ({"slot": LATERAL, "target": "1 mm"}, "target"),
        ({"slot": LATERAL, "target": 1, "speed": 3}, "speed"),
    ],
)
def test_a_wrong_field_is_named(robot: Stack, body: dict, field: str) -> None:
    assert problem(robot.api.post("/api/proposals", json=body), 422, "INVALID")["field"] == field


def test_what_does_not_exist_is_not_found(robot: Stack) -> None:
    problem(robot.api.get(f"/api/motors/{EMPTY_SLOT}"), 404, "NOT_FOUND")
    problem(robot.api.post(f"/api/motors/{LATERAL}/explode"), 404, "NOT_FOUND")
    problem(robot.api.get("/api/proposals/99"), 404, "NOT_FOUND")
    problem(robot.api.post("/api/proposals/99/abort"), 404, "NOT_FOUND")
    answer = robot.api.post("/api/proposals", json={"slot": EMPTY_SLOT, "target": 1})
    problem(answer, 404, "NOT_FOUND")
    assert robot.api.get("/api/nothing").json()["code"] == "NOT_FOUND"


def test_a_released_pedal_pauses_and_the_next_press_goes_on(stack: StackFactory) -> None:
    robot = stack(speed=4)
    to_motion(robot)
    number = propose(robot, -600)
    wait_for_proposal(robot, number, "executing")
    robot.control("pedal", pressed=False)
    wait_for_proposal(robot, number, "paused")
    press(robot)
    wait_for_proposal(robot, number, "done")


def test_stop_aborts_every_open_proposal_and_ends_motion(stack: StackFactory) -> None:
    robot = stack(speed=1)
    to_motion(robot)
    enable(robot, ROTATION)
    numbers = [propose(robot, FAR), propose(robot, 100, ROTATION)]
    assert judge(robot.api.post("/api/stop")).json()["verdict"] == "ACCEPTED"
    assert {proposal(robot, number)["state"] for number in numbers} == {"aborted"}
    wait_for_mode(robot, "READY")
    assert not robot.status()["pedal_armed"]


def test_an_estop_discards_every_proposal(stack: StackFactory) -> None:
    robot = stack(speed=1)
    to_motion(robot)
    number = propose(robot, FAR)
    robot.control("estop", pulled=True)
    wait_for_proposal(robot, number, "aborted")
    assert "ESTOP" in proposal(robot, number)["detail"]
    assert robot.status()["cause"] == "ESTOP"


def test_a_newer_proposal_replaces_the_older(stack: StackFactory) -> None:
    robot = stack(speed=1)
    to_motion(robot)
    older = propose(robot, FAR)
    newer = propose(robot, -50)
    assert proposal(robot, older)["state"] == "aborted"
    wait_for_proposal(robot, newer, "done")


def test_an_aborted_proposal_stops_its_axis_at_once(stack: StackFactory) -> None:
    robot = stack(speed=1)
    to_motion(robot)
    number = propose(robot, FAR)
    wait_for_proposal(robot, number, "executing")
    assert judge(robot.api.post(f"/api/proposals/{number}/abort")).json()["state"] == "aborted"
    wait_until("undriven", lambda: motor(robot)["drive"] == 0)
    assert robot.status()["mode"] == "MOTION"
    problem(robot.api.post(f"/api/proposals/{number}/abort"), 409, "ENDED")


def test_a_bench_pedal_that_is_not_renewed_comes_up_after_half_a_second_of_kernel_time(robot: Stack) -> None:
    unlock(robot)
    wait_until("pedal armed", lambda: robot.status()["pedal_armed"])
    judge(robot.api.post("/api/bench/pedal", json={"pressed": True})).raise_for_status()
    wait_until("pressed", lambda: last(robot, "pedal_pressed") is not None)
    pressed = last(robot, "pedal_pressed")
    wait_until("released", lambda: (last(robot, "pedal_released") or 0) > pressed)
    assert last(robot, "pedal_released") - pressed >= RELEASE_TICKS - PRESS_TICKS
    wait_for_mode(robot, "READY")


def test_a_late_renewal_of_the_bench_pedal_is_no_press(robot: Stack) -> None:
    renewal = {"pressed": True, "renew": True}
    assert problem(robot.api.post("/api/bench/pedal", json=renewal), 409, "PEDAL_LAPSED")["next_step"]
    wrong = problem(robot.api.post("/api/bench/pedal", json={"pressed": True, "renew": 1}), 422, "INVALID")
    assert wrong["field"] == "renew"
    judge(robot.api.post("/api/bench/pedal", json={"pressed": False})).raise_for_status()
    assert last(robot, "pedal_pressed") is None


def test_the_bench_passes_commands_on_and_names_its_refusals(robot: Stack) -> None:
    judge(robot.api.post("/api/bench/estop", json={"pulled": True})).raise_for_status()
    wait_until("E-stop seen", lambda: robot.status()["estop"])
    problem(robot.api.post("/api/bench/estop", json={"pulled": 3}), 422, "INVALID")
    problem(robot.api.post("/api/bench/explode", json={}), 422, "INVALID")
    problem(robot.api.post("/api/bench/estop", json={"command": "clear"}), 422, "INVALID")
    problem(robot.api.post("/api/bench/estop", content="{"), 400, "MALFORMED")


def test_a_kernel_that_hangs_is_named_and_no_late_request_reaches_it(stack: StackFactory) -> None:
    robot = stack(realtime=True)
    wait_until("app alive", lambda: robot.status()["app_alive"])
    robot.signal("kernel", signal.SIGSTOP)
    problem(robot.api.post("/api/reset"), 503, "NO_KERNEL")
    assert judge(robot.api.post("/api/stop")).json()["verdict"] is None
    assert robot.status()["age_ms"] > 1000
    robot.signal("kernel", signal.SIGCONT)
    tick = robot.status()["tick"]
    wait_until("kernel goes on", lambda: robot.status()["tick"] > tick + 100)
    assert robot.status()["mode"] == "LOCKED"


def test_a_simulator_that_hangs_is_named(stack: StackFactory) -> None:
    robot = stack(realtime=True)
    robot.signal("simulator", signal.SIGSTOP)
    problem(robot.api.get("/api/bench"), 503, "NO_BENCH")
    robot.signal("simulator", signal.SIGCONT)
    wait_until("bench is back", lambda: robot.api.get("/api/bench").status_code == 200)


def test_only_the_servers_own_page_may_open_the_stream(robot: Stack) -> None:
    with open_stream(robot, origin=f"http://127.0.0.1:{robot.port}") as stream:
        assert stream.recv()
    with pytest.raises(InvalidStatus) as refusal, open_stream(robot, origin="http://evil.example"):
        pass
    assert refusal.value.response.status_code == 403


def test_a_page_of_another_origin_changes_nothing(robot: Stack) -> None:
    answer = robot.api.post("/api/stop", headers={"Origin": "http://evil.example"})
    problem(answer, 403, "ORIGIN")
    problem(robot.api.get("/api/status", headers={"Host": "evil.example"}), 403, "HOST")
