"""Every motion is kept as a run: with what was planned and what came of it, whoever is killed meanwhile."""

import contextlib
import csv
import io
import signal
import sqlite3
import tempfile
from collections.abc import Iterator
from datetime import datetime, timedelta
from pathlib import Path

import pytest
from bare_kernel import DEADLINE_S
from conftest import StackFactory
from interface import judge
from motion import (
    LATERAL,
    approve,
    press,
    propose,
    restart_app,
    to_motion,
    wait_for_proposal,
    wait_for_ticks,
    wait_until,
)
from stack import Stack
from test_paths import HEAD, ready
from test_paths import propose as propose_path

LIMIT_S = 30
SETTLING = timedelta(milliseconds=500)
TARGETS = {"lateral": -20.0, "head": -25.0}


def show(robot: Stack, path: str) -> dict:
    answer = judge(robot.api.get(f"/api/runs{path}"))
    assert answer.status_code == 200, answer.text
    return answer.json()


def run(robot: Stack, number: int) -> dict:
    """The run once it is kept as it was half a second after its end, when its axes rest."""

    def is_over() -> bool:
        answer = robot.api.get(f"/api/runs/{number}")
        found = answer.json()
        if answer.status_code != 200 or found["ended"] is None:
            return False
        return (datetime.fromisoformat(found["kept"]) - datetime.fromisoformat(found["ended"])) >= SETTLING

    wait_until("the run is over", is_over, LIMIT_S)
    return show(robot, f"/{number}")


def long_path(robot: Stack) -> int:
    """A motion of two axes that takes some seconds, under way."""
    number = approve(robot, propose_path(robot, kind="coordinated", targets=TARGETS))
    press(robot)
    wait_for_proposal(robot, number, "executing", LIMIT_S)
    return number


def kept_path(robot: Stack) -> int:
    """The same, once its begin is kept."""
    number = long_path(robot)
    wait_until("kept", lambda: robot.api.get(f"/api/runs/{number}").status_code == 200, LIMIT_S)
    return number


def test_a_motion_is_kept_with_its_plan_and_what_its_axes_did(stack: StackFactory) -> None:
    robot = ready(stack)
    number = approve(
        robot, propose_path(robot, kind="coordinated", targets={"lateral": -20.0, "head": -25.0})
    )
    press(robot)
    wait_for_proposal(robot, number, "done", LIMIT_S)
    kept = run(robot, number)
    assert (kept["id"], kept["outcome"], kept["kind"]) == (number, "done", "path")
    assert kept["case"] == robot.api.get(f"/api/proposals/{number}").json()["case"]
    assert kept["detail"] == "All axes rest within the deadband of their goals."
    motors = {axis["slot"]: axis for axis in robot.api.get("/api/motors").json()}
    assert {axis["slot"] for axis in kept["axes"]} == {LATERAL, HEAD}
    samples = show(robot, f"/{number}/samples")
    times = samples["times_s"]
    assert times == sorted(times)
    assert times[-1] >= kept["duration_s"], "it is followed until its axes rest"
    assert samples["plan"]["basis"] == "time"
    for axis, seen in zip(kept["axes"], samples["axes"], strict=True):
        now = motors[axis["slot"]]
        assert axis["end_counts"] == now["position_counts"] == seen["actual_counts"][-1]
        assert abs(axis["end_counts"] - axis["target_counts"]) <= now["deadband_counts"] + 2
        assert axis["begin_counts"] == pytest.approx(seen["actual_counts"][0], abs=2)
        errors = [
            abs(asked - was)
            for asked, was in zip(seen["commanded_counts"], seen["actual_counts"], strict=True)
            if asked is not None and was is not None
        ]
        assert max(errors) <= axis["largest_error_counts"], "single ticks are more than the samples"
        assert 0 < axis["rms_error_counts"] <= axis["largest_error_counts"]
        travel = abs(axis["target_counts"] - axis["begin_counts"])
        assert axis["largest_error_counts"] < travel / 4, "it followed its plan"
        assert samples["plan"]["axes"][kept["axes"].index(axis)]["positions_counts"][-1] == pytest.approx(
            axis["target_counts"], abs=1
        )


def test_a_move_of_one_axis_has_a_target_and_no_following_error(stack: StackFactory) -> None:
    robot = stack()
    to_motion(robot)
    number = propose(robot, -500)
    wait_for_proposal(robot, number, "done", LIMIT_S)
    [axis] = run(robot, number)["axes"]
    assert axis["target_counts"] == -500
    assert axis["largest_error_counts"] is None
    assert axis["rms_error_counts"] is None
    assert show(robot, f"/{number}/samples")["plan"]["basis"] == "way"


def test_a_run_whose_app_was_killed_says_so_and_ids_go_on(stack: StackFactory) -> None:
    robot = ready(stack, speed=1)
    number = kept_path(robot)
    assert show(robot, f"/{number}")["outcome"] == "running"
    restart_app(robot)
    kept = show(robot, f"/{number}")
    assert (kept["outcome"], kept["detail"]) == ("interrupted", "The app ended while it went on.")
    assert kept["ended"] is None
    records = robot.api.get("/api/audit").raise_for_status().json()
    starts = [each["detail"] for each in records if each["kind"] == "start"]
    assert starts[-1]["interrupted_runs"] == [number]
    robot.take_control()
    assert propose_path(robot, kind="home") > number


def test_an_app_that_is_killed_loses_no_more_than_the_last_seconds(stack: StackFactory) -> None:
    robot = ready(stack, speed=1)
    number = kept_path(robot)
    wait_for_ticks(robot, 500)
    robot.control("pedal", pressed=False)
    wait_until("kept again", lambda: len(show(robot, f"/{number}/samples")["times_s"]) > 30, LIMIT_S)
    assert show(robot, f"/{number}")["outcome"] == "running", "a pause is part of it"
    restart_app(robot)
    assert show(robot, f"/{number}")["outcome"] == "interrupted"
    samples = show(robot, f"/{number}/samples")
    assert samples["plan"]["basis"] == "time"
    lateral = samples["axes"][0]["actual_counts"]
    assert lateral[-1] != lateral[0], "it had moved"


def test_a_run_is_there_when_everything_was_started_anew_after_the_kernel_died(short_tmp_path: Path) -> None:
    directory = short_tmp_path / "0"
    sockets = directory / "sockets"

    def started(**_options: object) -> Stack:
        robot = Stack(directory, "--robot", "neuro", "--speed", "1", "--sockets", sockets)
        robot.connect_control()
        return robot

    robot = ready(started)
    with contextlib.closing(robot):
        number = kept_path(robot)
        robot.signal("kernel", signal.SIGKILL)
        robot.wait()
    with contextlib.closing(started()) as again:
        kept = show(again, f"/{number}")
        assert kept["detail"]
        assert kept["outcome"] in ("aborted", "interrupted"), "whichever the app saw of it"


def test_a_run_that_is_stopped_shows_where_its_axes_came_to_rest(stack: StackFactory) -> None:
    robot = ready(stack, speed=1)
    number = kept_path(robot)
    wait_for_ticks(robot, 1000)
    robot.api.post("/api/stop").raise_for_status()
    kept = run(robot, number)
    assert kept["outcome"] == "aborted"
    assert kept["detail"].startswith("STOP by")
    for axis in kept["axes"]:
        now = robot.api.get(f"/api/motors/{axis['slot']}").json()
        assert axis["end_counts"] == pytest.approx(now["position_counts"], abs=2)
        assert axis["end_counts"] != axis["begin_counts"]


@contextlib.contextmanager
def stalled_store(robot: Stack) -> Iterator[None]:
    file = robot.state / "interlock.db"
    with contextlib.closing(sqlite3.connect(file, timeout=DEADLINE_S, isolation_level=None)) as store:
        store.execute("BEGIN IMMEDIATE")
        yield
        store.execute("ROLLBACK")


def test_a_motion_goes_on_while_the_store_stalls_and_is_kept_afterwards(stack: StackFactory) -> None:
    robot = ready(stack)
    number = kept_path(robot)
    with stalled_store(robot):
        wait_for_proposal(robot, number, "done", LIMIT_S)
    assert run(robot, number)["outcome"] == "done"


def test_a_store_that_refuses_runs_stops_neither_motion_nor_stop(stack: StackFactory) -> None:
    """As a full disk does, with the next write; the records of the audit still find room."""
    robot = ready(stack)
    file = robot.state / "interlock.db"

    def execute(sql: str) -> None:
        with contextlib.closing(sqlite3.connect(file, timeout=DEADLINE_S)) as store:
            store.execute(sql)

    execute("CREATE TRIGGER full BEFORE INSERT ON runs BEGIN SELECT RAISE(ABORT, 'disk full'); END")
    number = long_path(robot)
    wait_until(
        "the log says so",
        lambda: any(
            "disk full" in line["text"] for line in robot.api.get("/api/logs?lines=200").json()["lines"]
        ),
        LIMIT_S,
    )
    assert robot.api.get(f"/api/runs/{number}").status_code == 404
    robot.api.post("/api/stop").raise_for_status()
    wait_for_proposal(robot, number, "aborted", LIMIT_S)
    execute("DROP TRIGGER full")
    assert run(robot, number)["outcome"] == "aborted"


@pytest.fixture(scope="module")
def moved() -> Iterator[tuple[Stack, list[int]]]:
    """A robot with three runs."""
    with tempfile.TemporaryDirectory(prefix="interlock-test-") as folder:
        directory = Path(folder)
        arguments = ("--robot", "neuro", "--clock", "sim", "--sockets", directory / "sockets")
        with contextlib.closing(Stack(directory, *arguments)) as robot:
            robot.connect_control()
            to_motion(robot)
            numbers = []
            for target in (-300, -600, -900):
                numbers.append(propose(robot, target))
                wait_for_proposal(robot, numbers[-1], "done", LIMIT_S)
                run(robot, numbers[-1])
            yield robot, numbers


def test_runs_are_listed_by_case_outcome_kind_axis_and_time_in_pages(moved: tuple[Stack, list[int]]) -> None:
    robot, numbers = moved

    def listed(query: str) -> list[int]:
        return [each["id"] for each in show(robot, query)["runs"] if each["id"] in numbers]

    newest_first = numbers[::-1]
    assert listed("") == newest_first
    case = show(robot, f"/{numbers[0]}")["case"]
    assert listed(f"?case={case or 0}") == newest_first
    assert listed("?case=99") == []
    assert listed("?outcome=done") == newest_first
    assert listed("?outcome=aborted") == []
    assert listed("?kind=move&axis=lateral") == newest_first
    assert listed("?kind=path") == []
    assert listed("?axis=head") == []
    assert listed("?axis=later") == [], "whole names only"
    second = show(robot, f"/{numbers[1]}")["begun"]
    assert listed(f"?since={second}") == newest_first[:2]
    page = show(robot, f"?count=1&before={numbers[2]}")
    assert [each["id"] for each in page["runs"]] == [numbers[1]]
    assert page["more"]
    wrong = judge(robot.api.get("/api/runs?since=yesterday"))
    assert (wrong.status_code, wrong.json()["field"]) == (422, "since")


def test_a_run_is_exported_in_the_units_that_people_read(moved: tuple[Stack, list[int]]) -> None:
    robot, numbers = moved
    answer = judge(robot.api.get(f"/api/runs/{numbers[0]}/csv"))
    rows = list(csv.DictReader(io.StringIO(answer.text)))
    samples = show(robot, f"/{numbers[0]}/samples")
    [axis] = show(robot, f"/{numbers[0]}")["axes"]
    assert list(rows[0]) == ["time_s", "lateral_planned_mm", "lateral_commanded_mm", "lateral_actual_mm"]
    assert len(rows) == len(samples["times_s"])
    for row, time, counts in zip(rows, samples["times_s"], samples["axes"][0]["actual_counts"], strict=True):
        assert float(row["time_s"]) == pytest.approx(time)
        assert float(row["lateral_actual_mm"]) == pytest.approx(counts / axis["counts_per_unit"], abs=1e-5)
        assert row["lateral_planned_mm"] == "", "no time was planned"


def test_a_note_is_kept_and_the_audit_has_no_text_of_it(moved: tuple[Stack, list[int]]) -> None:
    robot, numbers = moved
    path = f"/api/runs/{numbers[0]}/note"
    noted = judge(robot.api.put(path, json={"text": "stiff cable"}))
    assert noted.json()["note"] == "stiff cable"
    assert show(robot, f"/{numbers[0]}")["note"] == "stiff cable"
    records = robot.api.get("/api/audit").json()
    assert {"run": numbers[0], "changed": "note"} in [each["detail"] for each in records]
    assert "stiff cable" not in str(records)
    assert judge(robot.api.put(path, json={"text": "two\nlines"})).status_code == 422
    assert judge(robot.api.put("/api/runs/999999/note", json={"text": "x"})).status_code == 404
    assert judge(robot.api.put(path, json={"text": ""})).json()["note"] == ""


def test_retention_is_stated_and_bad_values_are_refused(moved: tuple[Stack, list[int]]) -> None:
    robot, numbers = moved
    assert show(robot, "")["retention"] == {"count": 2000, "days": 365, "always": 20}
    path = "/api/runs/retention"
    for body in ({"count": 19, "days": 1}, {"count": 20, "days": 0}, {"count": 20}):
        assert judge(robot.api.put(path, json=body)).status_code == 422, body
    changed = judge(robot.api.put(path, json={"count": 50, "days": 30}))
    assert changed.json() == {"count": 50, "days": 30, "always": 20}
    assert show(robot, "")["retention"] == changed.json()
    assert [each["id"] for each in show(robot, "")["runs"]][: len(numbers)] == numbers[::-1]
