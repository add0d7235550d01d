"""Steps that the tests of motion share, on a whole robot."""

import signal
import time
from collections.abc import Callable

import httpx
from bare_kernel import DEADLINE_S
from stack import Stack, has_ended, watched
from websockets.sync.client import ClientConnection, connect

LATERAL = 4
PRESS_TICKS = 250
"""The first drive of an approved motion comes within 85 ticks of a press, as far as seen."""


def open_stream(stack: Stack, origin: str | None = None) -> ClientConnection:
    """The stream, for the session of `stack.api`."""
    name = f"interlock_session_{stack.port}"
    cookie = f"{name}={stack.api.cookies[name]}"
    return connect(
        f"ws://127.0.0.1:{stack.port}/api/stream", origin=origin, additional_headers={"Cookie": cookie}
    )


def wait_until(what: str, condition: Callable[[], bool], limit_s: float = DEADLINE_S) -> None:
    deadline = time.monotonic() + limit_s
    while not condition():
        assert time.monotonic() < deadline, f"not within {limit_s} s: {what}"


def call(client: httpx.Client, method: str, path: str, body: object = None) -> httpx.Response:
    """Once more, as the answer says, when it waited a second on a busy machine, or 5 s for a busy disk."""
    answer = client.request(method, f"/api/{path}", json=body)
    while answer.status_code == 503 and answer.json()["code"] in ("LATE", "STORE"):
        answer = client.request(method, f"/api/{path}", json=body)
    return answer


def wait_for_mode(stack: Stack, mode: str) -> None:
    wait_until(f"mode {mode}", lambda: stack.status()["mode"] == mode)


def motor(stack: Stack, slot: int = LATERAL) -> dict:
    return stack.api.get(f"/api/motors/{slot}").raise_for_status().json()


def unlock(stack: Stack) -> None:
    """RESET as soon as nothing stands against it."""
    stack.control("pedal", pressed=False)
    wait_until("unlocked", lambda: stack.api.post("/api/reset").status_code == 200)


def act(stack: Stack, action: str, slot: int = LATERAL) -> None:
    stack.api.post(f"/api/motors/{slot}/{action}").raise_for_status()


def enable(stack: Stack, slot: int = LATERAL) -> None:
    """As soon as its power is up and the axis at rest."""
    path = f"/api/motors/{slot}/enable"
    wait_until(f"{slot} enabled", lambda: stack.api.post(path).status_code == 200)


def press(stack: Stack) -> None:
    """Waits until the released pedal is armed, presses it and waits for MOTION."""
    stack.control("pedal", pressed=False)
    wait_until("pedal armed", lambda: stack.status()["pedal_armed"])
    stack.control("pedal", pressed=True)
    wait_for_mode(stack, "MOTION")


def set_home(stack: Stack, axis: int | str = LATERAL) -> None:
    """Declares that the axis stands at home, whatever its switch would tell, as soon as it is at rest."""
    path = f"/api/motors/{axis}/set-home"
    wait_until(
        f"{axis} at rest", lambda: stack.api.post(path, json={"override_switch": True}).status_code == 200
    )


def home_all(stack: Stack) -> None:
    """Declares every axis at home, enables it and waits until the console shows it, as poses then do."""

    def motors() -> list[dict]:
        return stack.api.get("/api/motors").raise_for_status().json()

    for axis in motors():
        set_home(stack, axis["slot"])
        enable(stack, axis["slot"])
    wait_until("homed", lambda: all(axis["homed"] for axis in motors()))


IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]


def register(stack: Stack, pose: list[float] = IDENTITY, **more: object) -> None:
    """Says where the robot stands, which need not be where its file expects it: there is no scanner here."""
    body = {"registration": pose, "override_reason": "There is no scanner.", **more}
    call(stack.api, "PUT", "targeting/registration", body).raise_for_status()


def to_motion(stack: Stack, slot: int = LATERAL) -> None:
    """Unlocks, references the axis where it stands, enables it and presses the pedal."""
    unlock(stack)
    set_home(stack, slot)
    enable(stack, slot)
    press(stack)


def propose(stack: Stack, target_counts: int, slot: int = LATERAL) -> int:
    answer = call(stack.api, "POST", "proposals", {"slot": slot, "target_counts": target_counts})
    assert answer.status_code == 201, answer.text
    return answer.json()["id"]


def approve(stack: Stack, number: int | None = None) -> int:
    """The proposal of that number, or the newest, once it waits for that; gives its number."""

    def waiting() -> dict | None:
        newest = stack.api.get("/api/proposals").raise_for_status().json()[:1]
        found = newest if number is None else [proposal(stack, number)]
        return next((each for each in found if each["state"] == "checked"), None)

    wait_until("it waits", lambda: waiting() is not None)
    known = waiting()["id"]
    call(stack.api, "POST", f"proposals/{known}/approve").raise_for_status()
    return known


def confirm(stack: Stack) -> None:
    """The newest proposal, once it is aligned, and presses the pedal for its insertion."""

    def newest() -> dict:
        return stack.api.get("/api/proposals").raise_for_status().json()[0]

    wait_until("aligned", lambda: newest()["wants_confirmation"])
    call(stack.api, "POST", f"proposals/{newest()['id']}/confirm").raise_for_status()
    press(stack)


def propose_home(stack: Stack, **which: object) -> int:
    """Proposes and approves homing: all steps, or one."""
    answer = stack.api.post("/api/proposals", json={"kind": "home", **which})
    assert answer.status_code == 201, answer.text
    made = answer.json()
    return approve(stack, made["id"]) if made["state"] == "checked" else made["id"]


def proposal(stack: Stack, number: int) -> dict:
    return stack.api.get(f"/api/proposals/{number}").raise_for_status().json()


def wait_for_proposal(stack: Stack, number: int, state: str, limit_s: float = DEADLINE_S) -> None:
    wait_until(f"proposal {state}", lambda: proposal(stack, number)["state"] == state, limit_s)


def is_driven(stack: Stack, slot: int = LATERAL) -> bool:
    return motor(stack, slot)["gate"] == "OPEN"


def record(stack: Stack, first: int, last: int) -> list[dict]:
    """The plant's own record of the wire, once the plant is past `last`."""
    wait_until(f"plant tick {last}", lambda: stack.control("status")["tick"] > last)
    return stack.control("record", **{"from": first, "to": last})["entries"]


def plant_tick(stack: Stack) -> int:
    return stack.control("status")["tick"]


def last_drive(stack: Stack) -> int:
    """The newest tick at which a drive was on the wire, as the plant recorded it."""
    return stack.control("record_event", kind="last_nonzero_drive")["event_tick"] or 0


def wait_until_driven(stack: Stack) -> None:
    begin = last_drive(stack)
    wait_until("an axis is driven", lambda: last_drive(stack) > begin)


def wait_for_ticks(stack: Stack, ticks: int) -> None:
    begin = plant_tick(stack)
    wait_until(f"{ticks} ticks have passed", lambda: plant_tick(stack) > begin + ticks)


def release(stack: Stack) -> None:
    """Lets go of the pedal and waits until the next press counts."""
    stack.control("pedal", pressed=False)
    wait_until("READY", lambda: stack.status()["mode"] == "READY" and stack.status()["pedal_armed"])


def press_for_a_while(stack: Stack) -> bool:
    """Whether any axis was driven by it."""
    before = last_drive(stack)
    stack.control("pedal", pressed=True)
    wait_for_ticks(stack, PRESS_TICKS)
    release(stack)
    return last_drive(stack) != before


def restart_app(stack: Stack, meanwhile: Callable[[], object] = lambda: None) -> int:
    """Kills the app and waits until the next one serves; nobody is in control then.

    Gives the plant's tick by which the app was dead, which is when `meanwhile` is called.
    """
    ready = sum(line.startswith("ready http") for line in stack.output.lines)
    with watched(stack.pid("app")) as [app]:
        stack.signal("app", signal.SIGKILL)
        assert has_ended(app)
    died = plant_tick(stack)
    meanwhile()
    stack.output.wait_for(r"^ready http", count=ready + 1)
    wait_until("served again", lambda: stack.status()["app_alive"])
    return died
