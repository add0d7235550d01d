"""What has been, for plots: decimated rows lose no peak, and single ticks come from the black box."""

import pytest
from conftest import StackFactory
from interface import judge
from motion import LATERAL, motor, propose, to_motion, wait_for_proposal, wait_until
from stack import Stack


@pytest.fixture
def moved(stack: StackFactory) -> Stack:
    """A robot whose lateral axis has moved."""
    robot = stack(speed=1)
    to_motion(robot)
    wait_for_proposal(robot, propose(robot, -300), "done")
    return robot


def history(robot: Stack, after: int = 0) -> dict:
    answer = judge(robot.api.get(f"/api/history?after={after}"))
    assert answer.status_code == 200, answer.text
    return answer.json()


def whole_history(robot: Stack) -> list[dict]:
    """All rows of the lateral axis: last tick, and both extremes of each quantity."""
    rows: list[dict] = []
    more, after = True, 0
    while more:
        part = history(robot, after)
        [axis] = [axis for axis in part["axes"] if axis["slot"] == LATERAL]
        for row, tick in enumerate(part["last_tick"]):
            extremes = {
                name: (values["least"][row], values["greatest"][row])
                for name, values in axis.items()
                if name != "slot"
            }
            rows.append({"tick": tick, "ticks": part["ticks"][row], "run": part["run"][row], **extremes})
        more, after = part["more"], part["next"]
    return rows


def capture_of(robot: Stack, slot: int, **parameters: int) -> dict:
    answer = judge(robot.api.get("/api/capture", params={"slot": slot, **parameters}))
    assert answer.status_code == 200, answer.text
    return answer.json()


def capture(robot: Stack, **parameters: int) -> dict:
    return capture_of(robot, LATERAL, **parameters)


def extremes_of(values: list[int | None]) -> tuple[int | None, int | None]:
    known = [value for value in values if value is not None]
    return (min(known), max(known)) if known else (None, None)


def test_the_history_has_the_extremes_of_the_ticks_that_the_black_box_holds(moved: Stack) -> None:
    rows = whole_history(moved)
    length = history(moved)["ticks_of_bucket"]
    last = rows[-1]["tick"]
    taken = capture(moved, seconds=10, until=last)
    ticks = dict(
        zip(
            taken["tick"],
            zip(taken["position_counts"], taken["setpoint_counts"], taken["drive"], strict=True),
            strict=True,
        )
    )
    # On a busy machine the app misses a tick now and then; it says so.
    whole = [row for row in rows if row["ticks"] == length and row["tick"] - length >= taken["tick"][0]]
    assert any(row["setpoint_counts"] != (None, None) for row in whole), "the move is not in the capture"
    for row in whole:
        of_row = [ticks[tick] for tick in range(row["tick"] - length + 1, row["tick"] + 1)]
        errors = [
            None if setpoint is None or position is None else setpoint - position
            for position, setpoint, _ in of_row
        ]
        assert row["position_counts"] == extremes_of([position for position, _, _ in of_row])
        assert row["setpoint_counts"] == extremes_of([setpoint for _, setpoint, _ in of_row])
        assert row["error_counts"] == extremes_of(errors)
        assert row["drive"] == extremes_of([drive for _, _, drive in of_row])


def test_the_history_shows_a_move_and_nothing_that_was_not_there(moved: Stack) -> None:
    rows = whole_history(moved)
    assert {row["run"] for row in rows} == {1}
    assert rows[0]["setpoint_counts"] == (None, None)
    assert min(row["position_counts"][0] for row in rows) <= -290
    assert min(row["velocity_counts_per_s"][0] or 0 for row in rows) < -10
    assert min(row["drive"][0] for row in rows) < 0
    assert motor(moved)["position_counts"] == pytest.approx(rows[-1]["position_counts"][1], abs=5)


def test_only_rows_after_a_number_are_sent_again(moved: Stack) -> None:
    before = history(moved)
    later = history(moved, before["next"])
    assert later["first"] == before["next"] + 1
    assert later["app_begun_s"] == before["app_begun_s"]


def test_a_capture_has_every_tick_up_to_the_one_that_is_asked_for(moved: Stack) -> None:
    # A quick machine is here before the kernel has run for a second.
    wait_until("a second of ticks", lambda: whole_history(moved)[-1]["tick"] >= 1000)
    last = whole_history(moved)[-1]["tick"]
    taken = capture(moved, seconds=1, until=last)
    assert taken["tick"] == list(range(last - 999, last + 1))
    assert taken["begun_us"][0] == 0
    assert taken["begun_us"] == sorted(taken["begun_us"])


def test_a_capture_has_the_velocity_that_the_positions_show(moved: Stack) -> None:
    taken = capture(moved, seconds=10)
    assert taken["forces"] is None, "this robot has no needle"
    velocity = taken["velocity_counts_per_s"]
    assert velocity[0] is None, "one reading is no velocity"
    assert min(value for value in velocity if value is not None) < -10
    position = taken["position_counts"]
    period_s = taken["period_us"] * 1e-6
    window = round(0.02 / period_s)
    steady = [
        (velocity[row], (position[row] - position[row - window]) / (window * period_s))
        for row in range(2 * window, len(position))
        if taken["tick"][row] - taken["tick"][row - 2 * window] == 2 * window
        and None not in position[row - 2 * window : row + 1]
    ]
    # A line through the readings and the difference of its ends agree but for the quantisation.
    assert all(slope == pytest.approx(mean, abs=120) for slope, mean in steady)
    assert len(steady) > window


def test_a_capture_of_a_robot_with_a_needle_has_both_forces(stack: StackFactory) -> None:
    robot = stack(robot="prostate", speed=1)
    axes = judge(robot.api.get("/api/motors")).json()
    wait_until("a tick in the black box", lambda: capture_of(robot, axes[0]["slot"])["tick"])
    taken = capture_of(robot, axes[0]["slot"])
    for force in ("hand_n", "needle_n"):
        known = [value for value in taken["forces"][force] if value is not None]
        assert len(taken["forces"][force]) == len(taken["tick"])
        assert known, "the sensor card was read"
        assert all(abs(value) < 1 for value in known), "nobody touches the needle"


def test_a_wrong_parameter_is_named(stack: StackFactory) -> None:
    robot = stack()
    wrong = {
        "history?after=-1": "after",
        "history?after=x": "after",
        "capture": "slot",
        "capture?slot=10": "slot",
        "capture?slot=5": "slot",
        "capture?slot=0&seconds=11": "seconds",
        "capture?slot=0&until=4294967296": "until",
    }
    for query, field in wrong.items():
        answer = judge(robot.api.get(f"/api/{query}"))
        assert answer.status_code == 422, query
        assert answer.json()["field"] == field, query
