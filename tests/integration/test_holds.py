"""What holds a whole robot still from outside: a breathing gate and a scan, by HTTP and by OpenIGTLink."""

import pytest
from conftest import StackFactory
from interface import judge
from motion import (
    approve,
    call,
    home_all,
    motor,
    press,
    proposal,
    propose,
    release,
    restart_app,
    unlock,
    wait_for_mode,
    wait_for_proposal,
    wait_for_ticks,
    wait_until,
)
from navigator import OK, Navigator, text
from stack import Stack

INSERTION, DEEP_MM = 3, 15.0
ACCESS_DENIED, CONFIGURATION, NOT_READY = 5, 10, 13
SLOWED_DOWN_TICKS = 600


@pytest.fixture
def robot(stack: StackFactory) -> Stack:
    # A signal of two seconds of this clock lasts twenty for whoever renews it.
    started = stack(speed=0.1, igtl=True)
    unlock(started)
    home_all(started)
    return started


def holds(robot: Stack) -> dict:
    return judge(robot.api.get("/api/holds")).raise_for_status().json()


def put(robot: Stack, what: str, **body: bool) -> dict:
    return judge(call(robot.api, "PUT", f"holds/{what}", body)).raise_for_status().json()


def signal(robot: Stack, state: str) -> None:
    body = {"state": state, "valid_ms": 2000}
    judge(call(robot.api, "POST", "holds/gate/signal", body)).raise_for_status()


def depth(robot: Stack) -> int:
    return motor(robot, INSERTION)["position_counts"]


def insert(robot: Stack) -> int:
    """Proposes and approves an insertion along a path, and presses the pedal."""
    body = {"kind": "coordinated", "targets": {"insertion": DEEP_MM, "lateral": -2.0}}
    answer = robot.api.post("/api/proposals", json=body)
    assert answer.status_code == 201, answer.text
    number = approve(robot, answer.json()["id"])
    press(robot)
    wait_for_proposal(robot, number, "executing")
    return number


def waits_for_breath(robot: Stack, number: int) -> bool:
    return "for the breathing gate" in proposal(robot, number)["detail"]


def test_an_insertion_advances_only_while_the_gate_says_open(robot: Stack) -> None:
    assert put(robot, "gate", in_use=True)["gate"] == {"in_use": True, "state": "no_signal", "source": None}
    begin = depth(robot)
    number = insert(robot)
    wait_until("it waits", lambda: waits_for_breath(robot, number))
    wait_for_ticks(robot, 300)
    assert depth(robot) == begin

    def has_advanced() -> bool:
        signal(robot, "open")
        return depth(robot) > begin + 200

    wait_until("it advances", has_advanced)
    signal(robot, "hold")
    wait_until("it waits", lambda: waits_for_breath(robot, number))
    wait_for_ticks(robot, SLOWED_DOWN_TICKS)
    held = depth(robot)
    signal(robot, "hold")
    assert holds(robot)["gate"]["state"] == "hold"
    wait_for_ticks(robot, 300)
    assert abs(depth(robot) - held) <= 1
    assert proposal(robot, number)["state"] == "executing"

    def is_done() -> bool:
        signal(robot, "open")
        return proposal(robot, number)["state"] == "done"

    wait_until("it goes on by itself", is_done)


def test_a_closed_gate_that_is_turned_off_under_the_held_pedal_waits_for_a_new_press(robot: Stack) -> None:
    put(robot, "gate", in_use=True)
    begin = depth(robot)
    number = insert(robot)
    wait_until("it waits", lambda: waits_for_breath(robot, number))
    assert put(robot, "gate", in_use=False)["gate"]["state"] == "off"
    wait_for_ticks(robot, 500)
    assert depth(robot) == begin
    assert "release the pedal and press it" in proposal(robot, number)["detail"]
    put(robot, "gate", in_use=True)
    for _ in range(5):
        signal(robot, "open")
        wait_for_ticks(robot, 100)
    assert depth(robot) == begin, "the press that it waits for has not come"
    assert "release the pedal and press it" in proposal(robot, number)["detail"]
    put(robot, "gate", in_use=False)
    release(robot)
    press(robot)
    wait_for_proposal(robot, number, "done")
    assert depth(robot) > begin


def test_the_end_of_its_source_closes_the_gate_and_only_who_is_in_control_turns_it_off(robot: Stack) -> None:
    put(robot, "gate", in_use=True)
    source = robot.client("admin", robot.password)
    body = {"state": "open", "valid_ms": 2000}
    assert judge(call(source, "POST", "holds/gate/signal", body)).status_code == 200
    wait_until("open", lambda: holds(robot)["gate"]["state"] == "open")
    assert judge(source.put("/api/holds/gate", json={"in_use": False})).json()["code"] == "CONTROL"
    other = judge(robot.api.post("/api/holds/gate/signal", json=body))
    assert (other.status_code, other.json()["code"]) == (409, "GATE_SOURCE")
    judge(source.post("/api/logout")).raise_for_status()
    wait_until("closed", lambda: holds(robot)["gate"]["state"] == "no_signal")
    assert put(robot, "gate", in_use=False)["gate"]["state"] == "off"


def test_nothing_moves_during_a_scan_and_what_moved_goes_on_with_a_press_after_it(robot: Stack) -> None:
    number = insert(robot)
    assert put(robot, "scan", active=True)["scan"]["active"]
    wait_for_mode(robot, "READY")
    wait_until("it says so", lambda: "Held still for a scan" in proposal(robot, number)["detail"])
    wait_for_ticks(robot, 100)
    held = depth(robot)
    robot.control("pedal", pressed=False)
    wait_until("pedal armed", lambda: robot.status()["pedal_armed"])
    robot.control("pedal", pressed=True)
    wait_for_ticks(robot, 300)
    assert abs(depth(robot) - held) <= 1
    put(robot, "scan", active=False)
    press(robot)
    wait_for_proposal(robot, number, "done")


def test_an_imager_holds_still_and_its_end_opens_nothing(robot: Stack) -> None:
    imager, other = Navigator(robot.igtl_port), Navigator(robot.igtl_port)
    assert imager.ask(text("SCAN", "please")).code == CONFIGURATION
    assert imager.ask(text("SCAN", "on")).code == OK
    assert other.ask(text("scan", "OFF")).code == NOT_READY
    shown = holds(robot)["scan"]
    assert shown["active"]
    assert shown["source"].startswith("OpenIGTLink 127.0.0.1")
    assert imager.ask(text("SCAN", "off")).code == OK
    assert not holds(robot)["scan"]["active"]
    assert imager.ask(text("SCAN", "on")).code == OK
    imager.stop()
    other.stop()
    wait_until("gone", lambda: judge(robot.api.get("/api/communications/connections")).json() == [])
    for path, body in (
        ("proposals", {"slot": 4, "target_counts": -100}),
        ("jog", {"slot": 4, "direction": "decreasing"}),
        ("proposals", {"kind": "home", "slot": INSERTION}),
    ):
        refused = judge(call(robot.api, "POST", path, body))
        assert (refused.status_code, refused.json()["code"]) == (409, "SCANNING"), refused.text
    age_s = holds(robot)["scan"]["age_s"]
    restart_app(robot)
    robot.take_control()
    assert holds(robot)["scan"]["active"], "a restart of the app ends no scan"
    wait_until("it grows older", lambda: holds(robot)["scan"]["age_s"] > age_s)
    put(robot, "scan", active=False)
    assert propose(robot, -100, slot=4)


def test_a_program_may_close_the_gate_and_only_the_controller_open_it(robot: Stack) -> None:
    put(robot, "gate", in_use=True)
    navigator = Navigator(robot.igtl_port)
    assert navigator.ask(text("BREATHING_GATE", "open 2000")).code == ACCESS_DENIED
    assert navigator.ask(text("BREATHING_GATE", "hold 2000")).code == OK
    wait_until("closed", lambda: holds(robot)["gate"]["state"] == "hold")
    for wrong in ("open 49", "open 2001", "open soon", "shut"):
        assert navigator.ask(text("BREATHING_GATE", wrong)).code == CONFIGURATION
    [connection] = judge(robot.api.get("/api/communications/connections")).json()
    role = f"/api/communications/connections/{connection['id']}/role"
    judge(robot.api.put(role, json={"role": "controller"})).raise_for_status()

    def is_open() -> bool:
        assert navigator.ask(text("BREATHING_GATE", "open 2000")).code == OK
        return holds(robot)["gate"]["state"] == "open"

    wait_until("open", is_open)
    navigator.stop()
    wait_until("closed", lambda: holds(robot)["gate"]["state"] == "no_signal")


@pytest.mark.parametrize("dialect", ["brp2013", "wpi2024"])
def test_every_dialect_takes_what_holds_still(stack: StackFactory, dialect: str) -> None:
    robot = stack(igtl=True, dialect=dialect)
    navigator = Navigator(robot.igtl_port)
    assert navigator.ask(text("SCAN", "on")).code == OK
    assert holds(robot)["scan"]["active"]
    assert navigator.ask(text("BREATHING_GATE", "hold")).code == OK
    assert navigator.ask(text("SCAN", "off")).code == OK
    assert not holds(robot)["scan"]["active"]
    navigator.stop()
