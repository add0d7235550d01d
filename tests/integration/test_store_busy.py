"""While the store cannot be written nothing moves that was not recorded first (STOP: test_faults.py)."""

import contextlib
import sqlite3
import threading
from collections.abc import Iterator

import httpx
from bare_kernel import DEADLINE_S
from conftest import StackFactory
from motion import LATERAL, propose, to_motion, wait_for_proposal, wait_until
from stack import Stack


@contextlib.contextmanager
def busy_store(robot: Stack) -> Iterator[None]:
    """Another process writes, so that the app's records have to wait."""
    file = robot.state / "interlock.db"
    with contextlib.closing(sqlite3.connect(file, timeout=DEADLINE_S, isolation_level=None)) as store:
        store.execute("BEGIN IMMEDIATE")
        yield
        store.execute("ROLLBACK")


class Proposing(threading.Thread):
    """Proposes a move; the answer comes when the store can be written again."""

    def __init__(self, robot: Stack) -> None:
        super().__init__()
        self.client = robot.visitor()
        self.client.cookies = robot.api.cookies

    def run(self) -> None:
        draft = {"slot": LATERAL, "target_counts": -500}
        self.answer: httpx.Response = self.client.post("/api/proposals", json=draft)


def test_a_move_that_waited_for_the_store_for_more_than_a_second_is_refused(stack: StackFactory) -> None:
    robot = stack(speed=1)
    to_motion(robot)
    proposing = Proposing(robot)
    with busy_store(robot):
        proposing.start()
        begun = robot.control("status")["tick"]
        wait_until("a second has passed", lambda: robot.control("status")["tick"] > begun + 1500)
        assert proposing.is_alive()
    proposing.join()
    assert (proposing.answer.status_code, proposing.answer.json()["code"]) == (503, "LATE")
    assert robot.api.get("/api/proposals").json() == []


def test_a_move_is_recorded_before_it_is_acknowledged(stack: StackFactory) -> None:
    robot = stack()
    to_motion(robot)
    wait_for_proposal(robot, propose(robot, -300), "done")
    records = robot.api.get("/api/audit").raise_for_status().json()
    asked = [record["detail"]["asked"] for record in records if "asked" in record["detail"]]
    assert {"kind": "move", "axis": "lateral", "target_counts": -300} in asked
