"""Connections of OpenIGTLink as the console sees them, and what follows from the loss of the controller."""

from collections.abc import Callable

from interface import judge
from motion import LATERAL, press, proposal, record, wait_until
from stack import Stack

CONNECTIONS = "/api/communications/connections"
LOSS_MS = 300


def connections(robot: Stack) -> list[dict]:
    return judge(robot.api.get(CONNECTIONS)).raise_for_status().json()


def make_controller(robot: Stack, place: int = -1) -> None:
    """The newest connection, or that one, becomes the controller."""
    number = connections(robot)[place]["id"]
    answer = robot.api.put(f"{CONNECTIONS}/{number}/role", json={"role": "controller"})
    assert judge(answer).status_code == 200


def ticks_around(robot: Stack, event: Callable[[], object]) -> tuple[int, int]:
    """The plant's ticks before and after an event, however long the questions took on this machine."""
    before = robot.control("status")["tick"]
    event()
    return before, robot.control("status")["tick"]


def assert_rest_and_fresh_consent(robot: Stack, number: int, lost_between: tuple[int, int]) -> None:
    """Drive ended within its limit and stays away under the held pedal; another press goes on."""
    before, after = lost_between
    entries = record(robot, before, after + 3 * LOSS_MS)
    driven = [entry["tick"] for entry in entries if entry["drive"][LATERAL]]
    assert driven, "it had to move when its controller was lost"
    ended = max(driven)
    assert ended < after + LOSS_MS, f"lost in ticks {before} to {after}, driven until {ended}"
    shown = proposal(robot, number)
    assert shown["state"] == "paused"
    assert shown["detail"].startswith("The OpenIGTLink controller was lost. Motion ended; press and hold")
    press(robot)
    wait_until("goes on", lambda: proposal(robot, number)["state"] in ("executing", "done"))
