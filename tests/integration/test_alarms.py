"""What asks somebody to act, from the hardware to everybody who is to know: one list."""

import json
import signal
from collections.abc import Callable

from conftest import StackFactory
from interface import judge
from motion import LATERAL, call, enable, open_stream, unlock, wait_for_mode, wait_until
from stack import Stack
from websockets.sync.client import ClientConnection


def alarms(robot: Stack) -> list[dict]:
    return judge(robot.api.get("/api/alarms")).raise_for_status().json()["alarms"]


def codes(robot: Stack) -> list[str]:
    return [alarm["code"] for alarm in alarms(robot)]


def wait_for_codes(robot: Stack, *expected: str) -> None:
    wait_until(f"alarms {expected}", lambda: codes(robot) == list(expected))


def wait_for_message(stream: ClientConnection, holds: Callable[[dict], bool]) -> dict:
    while True:
        received = stream.recv()
        message = json.loads(received) if isinstance(received, str) else {}
        if message.get("type") == "alarms" and holds(message):
            return message


def test_an_estop_is_one_alarm_in_interface_stream_log_audit_and_metrics_from_begin_to_end(
    stack: StackFactory,
) -> None:
    robot = stack()
    unlock(robot)
    assert codes(robot) == []
    with open_stream(robot) as stream:
        robot.control("estop", pulled=True)
        message = wait_for_message(stream, lambda each: bool(each["alarms"]))
        (alarm,) = message["alarms"]
        assert (alarm["code"], alarm["priority"], alarm["layer"]) == ("ESTOP", "high", "person")
        assert alarm["next_step"].startswith("Make sure that the robot is safe")
        assert 'interlock_alarms{priority="high"} 1' in robot.api.get("/api/metrics").text
        lines = robot.api.get("/api/logs", params={"lines": 1000, "level": "error"}).json()["lines"]
        assert any("The E-stop was pulled" in line["text"] for line in lines)
        robot.control("estop", pulled=False)
        unlock(robot)
        wait_for_message(stream, lambda each: each["alarms"] == [])
    past = judge(robot.api.get("/api/alarms")).json()["past"]
    assert [(each["code"], each["ended"] is not None) for each in past] == [("ESTOP", True)]
    records = robot.api.get("/api/audit").raise_for_status().json()
    assert [each["detail"]["code"] for each in records if each["kind"] == "alarm"] == ["ESTOP"]


def test_cards_that_are_lost_together_are_one_alarm_that_ends_with_the_last_cleared_fault(
    stack: StackFactory,
) -> None:
    robot = stack()
    unlock(robot)
    slots = [each["slot"] for each in robot.api.get("/api/motors").json()]
    for slot in slots:
        robot.control("card_power", slot=slot, on=False)
    wait_until("all in one", lambda: [len(each["axes"]) for each in alarms(robot)] == [len(slots)])
    assert codes(robot) == ["BUS"]
    for slot in slots:
        robot.control("card_power", slot=slot, on=True)
    unlock(robot)
    assert codes(robot) == ["BUS"]
    for slot in slots:
        path = f"/api/motors/{slot}/clear-fault"
        wait_until(f"{slot} clear", lambda path=path: robot.api.post(path).status_code == 200)
    wait_for_codes(robot)


def test_an_alarm_is_acknowledged_by_an_engineer_in_the_audit_and_stays_until_it_is_over(
    stack: StackFactory,
) -> None:
    robot = stack()
    unlock(robot)
    enable(robot)
    robot.control("card_power", slot=LATERAL, on=False)
    wait_for_codes(robot, "CARD")
    (alarm,) = alarms(robot)
    assert alarm["axes"] == ["lateral"]
    viewer = robot.client_of_new("vera", "viewer")
    path = f"/api/alarms/{alarm['id']}/acknowledge"
    assert judge(viewer.post(path)).json()["code"] == "ROLE"
    assert judge(robot.api.post("/api/alarms/99/acknowledge")).json()["code"] == "NOT_FOUND"
    answer = judge(call(robot.api, "POST", f"alarms/{alarm['id']}/acknowledge")).raise_for_status().json()
    assert answer["alarms"][0]["acknowledged"]["user"] == "admin"
    records = robot.api.get("/api/audit").raise_for_status().json()
    kept = [each["detail"] for each in records if each["kind"] == "acknowledgement"]
    assert [each["alarm"]["code"] for each in kept] == ["CARD"]
    assert codes(robot) == ["CARD"]


def test_a_lock_after_start_alarms_nobody_and_a_kernel_that_stands_still_does(stack: StackFactory) -> None:
    robot = stack()
    wait_for_mode(robot, "LOCKED")
    assert codes(robot) == []
    robot.signal("kernel", signal.SIGSTOP)
    wait_for_codes(robot, "SILENT")
    robot.signal("kernel", signal.SIGCONT)
    wait_until("it goes on", lambda: "SILENT" not in codes(robot))
