"""Positions, targeting, logs, connections, cards and modes over HTTP, on a whole robot."""

import json
import math
import re
from collections.abc import Callable, Iterator

import httpx
import pytest
from conftest import StackFactory
from interface import judge
from motion import (
    LATERAL,
    approve,
    enable,
    motor,
    open_stream,
    press,
    propose,
    register,
    set_home,
    unlock,
    wait_for_mode,
    wait_for_proposal,
    wait_until,
)
from stack import Stack
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection

NOISE_COUNTS = 1  # of every encoder, models/plant/neuro.toml
POSE = [0, -1, 0, 10.5, 1, 0, 0, -20, 0, 0, 1, 30, 0, 0, 0, 1]


@pytest.fixture
def robot(stack: StackFactory) -> Stack:
    return stack()


def problem(answer: httpx.Response, status: int, code: str) -> dict:
    judge(answer)
    assert (answer.status_code, answer.json()["code"]) == (status, code), answer.text
    return answer.json()


def at_rest(robot: Stack) -> None:
    """Unlocked, and every axis so still that the kernel takes its position."""
    unlock(robot)
    wait_until(
        "at rest",
        lambda: all(row["verdict"] in ("ACCEPTED", None) for row in zero_all(robot)),
    )


def zero_all(robot: Stack) -> list[dict]:
    return judge(robot.api.post("/api/motors/zero-all")).raise_for_status().json()


def saved(robot: Stack) -> dict:
    answer = judge(robot.api.get("/api/positions")).raise_for_status()
    assert re.fullmatch(
        r'attachment; filename="neuro-positions-\d{8}T\d{6}Z\.json"', answer.headers["content-disposition"]
    )
    return answer.json()


def restore(robot: Stack, file: dict, *axes: str) -> httpx.Response:
    return judge(robot.api.put("/api/motors/restore", json={"file": file, "axes": list(axes)}))


def restored_at_rest(robot: Stack, file: dict, *axes: str) -> list[dict]:
    """The verdicts once no encoder trembles any more."""
    rows: list[dict] = []

    def settled() -> bool:
        rows[:] = restore(robot, file, *axes).raise_for_status().json()
        return all(row["verdict"] != "BUSY" for row in rows)

    wait_until("at rest", settled)
    return rows


def motor_title(robot: Stack, slot: int) -> str:
    return next((each["title"] for each in robot.api.get("/api/motors").json() if each["slot"] == slot), "")


def positions(robot: Stack) -> dict[str, int]:
    return {each["name"]: each["position_counts"] for each in robot.api.get("/api/motors").json()}


def as_before(positions_before: dict[str, int]) -> object:
    """Equal to the positions of axes that only tremble: both readings have an encoder's noise."""
    return pytest.approx(positions_before, rel=0, abs=2 * NOISE_COUNTS)


def names(robot: Stack) -> list[str]:
    return judge(robot.api.get("/api/robots")).json()[0]["axes"]


def test_zero_all_answers_for_every_axis_in_the_order_of_the_robot(robot: Stack) -> None:
    at_rest(robot)
    rows = zero_all(robot)
    assert [row["axis"] for row in rows] == names(robot)
    for row in rows:
        axis = motor(robot, row["slot"])
        assert row["verdict"] == (None if axis["has_switch"] else "ACCEPTED")
        assert axis["homed"] == (not axis["has_switch"])
        assert abs(axis["position_counts"]) <= NOISE_COUNTS or axis["has_switch"]
        assert ("Not sent: it has a limit switch" in row.get("detail", "")) == axis["has_switch"]


def test_an_axis_with_a_switch_is_declared_at_home_only_against_its_switch(robot: Stack) -> None:
    unlock(robot)
    problem(robot.api.post(f"/api/motors/{LATERAL}/set-home"), 409, "HAS_SWITCH")
    assert not motor(robot)["homed"]
    set_home(robot)
    assert motor(robot)["homed"]
    said = [record["detail"].get("what") for record in robot.api.get("/api/audit").json()]
    assert "lateral set-home, its switch overridden" in said
    assert "lateral set-home" not in said


def test_one_side_of_the_prostate_robot_does_not_home_while_the_other_is_unknown(stack: StackFactory) -> None:
    prostate = stack(robot="prostate")
    unlock(prostate)
    sliders = [slot for slot in range(10) if "slider" in motor_title(prostate, slot)]
    assert len(sliders) == 4
    for slot in sliders:
        enable(prostate, slot)
    for draft in ({"step": "left_home"}, {"step": "right_home"}, *({"slot": slot} for slot in sliders)):
        refused = prostate.api.post("/api/proposals", json={"kind": "home", **draft})
        assert "part" in problem(refused, 409, "SEPARATION")["detail"]
    assert prostate.api.get("/api/mode").json()["mode"] == "manual"
    inward = {"kind": "home", "step": "right_inward"}
    assert prostate.api.post("/api/proposals", json=inward).status_code == 201


def test_positions_outlive_the_robot_and_come_back_by_restore(stack: StackFactory) -> None:
    before = stack()
    unlock(before)
    set_home(before)
    enable(before)
    press(before)
    wait_for_proposal(before, propose(before, -300), "done")
    file = saved(before)
    name = motor(before)["name"]
    [moved] = [axis["position_counts"] for axis in file["axes"] if axis["axis"] == name]
    assert moved != 0
    assert {axis["axis"] for axis in file["axes"]} == set(names(before))

    after = stack(seed=2)
    unlock(after)
    row = next(
        row
        for row in judge(after.api.post("/api/positions/compare", json=file)).json()["axes"]
        if row["axis"] == name
    )
    assert (row["saved_counts"], row["enabled"], row["restorable"]) == (moved, True, True)
    [verdict] = restored_at_rest(after, file, name)
    assert verdict["verdict"] == "ACCEPTED"
    axis = motor(after)
    assert axis["position_counts"] == pytest.approx(moved, abs=NOISE_COUNTS)
    assert not axis["homed"]
    assert axis["state"] == "DISABLED"
    assert axis["setpoint_counts"] is None


def test_a_position_beyond_the_limits_is_refused_by_its_verdict(robot: Stack) -> None:
    at_rest(robot)
    file = saved(robot)
    name = motor(robot)["name"]
    for axis in file["axes"]:
        if axis["axis"] == name:
            axis["position_counts"] = motor(robot)["soft_max_counts"] + 10 * NOISE_COUNTS
    compared = judge(robot.api.post("/api/positions/compare", json=file)).json()
    assert [row["axis"] for row in compared["axes"] if not row["restorable"]] == [name]
    before = positions(robot)
    [row] = restored_at_rest(robot, file, name)
    assert row["verdict"] == "RANGE"
    assert row["detail"]
    assert positions(robot) == as_before(before)


CHANGES: dict[str, tuple[Callable[[dict], object], int, str]] = {
    "another robot": (lambda file: file.update(robot="prostate"), 409, "POSITIONS_ROBOT"),
    "another configuration": (lambda file: file.update(config_crc="00c0ffee"), 409, "POSITIONS_CONFIG"),
    "another version": (lambda file: file.update(version=2, novelty=1), 409, "POSITIONS_VERSION"),
    "another format": (lambda file: file.update(format="positions"), 422, "INVALID"),
    "an axis twice": (lambda file: file["axes"].append(file["axes"][0]), 422, "INVALID"),
    "an unknown axis": (lambda file: file["axes"][0].update(axis="elbow"), 422, "INVALID"),
    "an axis missing": (lambda file: file["axes"].pop(), 422, "INVALID"),
    "an unknown field": (lambda file: file.update(note="mine"), 422, "INVALID"),
    "a wrong type": (lambda file: file["axes"][0].update(homed="yes"), 422, "INVALID"),
}


@pytest.mark.parametrize("change", CHANGES)
def test_a_changed_file_is_refused_and_nothing_is_restored(robot: Stack, change: str) -> None:
    at_rest(robot)
    alter, status, code = CHANGES[change]
    file = saved(robot)
    name = file["axes"][-1]["axis"]
    for axis in file["axes"]:
        axis["position_counts"] += 10 * NOISE_COUNTS
    alter(file)
    before = positions(robot)
    assert problem(robot.api.post("/api/positions/compare", json=file), status, code)["expected"]
    problem(restore(robot, file, name), status, code)
    assert positions(robot) == as_before(before)


def test_a_truncated_file_is_malformed(robot: Stack) -> None:
    text = json.dumps(saved(robot))
    answer = robot.api.post("/api/positions/compare", content=text[: len(text) // 2])
    problem(answer, 400, "MALFORMED")


def test_an_axis_is_named_by_slot_or_by_name(robot: Stack) -> None:
    axis = judge(robot.api.get(f"/api/motors/{LATERAL}")).json()
    assert judge(robot.api.get(f"/api/motors/{axis['name']}")).json()["slot"] == LATERAL
    unlock(robot)
    path = f"/api/motors/{axis['name']}/enable"
    wait_until("enabled by name", lambda: judge(robot.api.post(path)).status_code == 200)
    assert motor(robot)["state"] == "ENABLED"


def test_ten_slots_show_their_cards_and_a_card_that_fails(robot: Stack) -> None:
    cards = judge(robot.api.get("/api/status")).json()["cards"]
    assert [card["slot"] for card in cards] == list(range(10))
    for card in cards:
        assert card["detected"] == (card["card"] != "NONE")
    failures = cards[LATERAL]["checksum_failures"]
    robot.control("frame", slot=LATERAL, fault="corrupt", count=2)
    wait_until(
        "checksum failures",
        lambda: robot.status()["cards"][LATERAL]["checksum_failures"] >= failures + 2,
    )
    robot.control("card_power", slot=LATERAL, on=False)
    wait_until("card lost", lambda: not robot.status()["cards"][LATERAL]["detected"])
    lost = robot.status()["cards"][LATERAL]
    assert not lost["heartbeat_live"]
    assert lost["frame_age_ms"] > 0
    wait_until(
        "the last frame ages",
        lambda: robot.status()["cards"][LATERAL]["frame_age_ms"] > lost["frame_age_ms"],
    )
    robot.control("card_power", slot=LATERAL, on=True)
    robot.control("card_reset", slot=LATERAL)
    wait_until("card is back", lambda: robot.status()["cards"][LATERAL]["heartbeat_live"])
    assert all(card["detected"] for card in robot.status()["cards"] if card["card"] != "NONE")


def test_the_robot_goes_home_by_its_mode_and_back(robot: Stack) -> None:
    modes = judge(robot.api.get("/api/mode")).json()
    assert modes == {"mode": "manual", "modes": judge(robot.api.get("/api/robots")).json()[0]["modes"]}
    problem(robot.api.put("/api/mode", json={"mode": "home"}), 409, "MODE")
    unlock(robot)
    set_home(robot, "feet")
    for axis in robot.api.get("/api/motors").json():
        enable(robot, axis["slot"])
    assert judge(robot.api.put("/api/mode", json={"mode": "home"})).json()["mode"] == "manual"
    approve(robot)
    assert robot.status()["app_mode"] == "home"
    draft = {"slot": LATERAL, "target_counts": 0}
    problem(robot.api.post("/api/proposals", json=draft), 409, "MODE_HOME")
    assert judge(robot.api.put("/api/mode", json={"mode": "manual"})).json()["mode"] == "manual"
    states = [each["state"] for each in robot.api.get("/api/proposals").json() if each["kind"] == "home"]
    assert states == ["aborted", "refused"]


def test_the_robot_homes_by_its_mode_and_is_manual_again(robot: Stack) -> None:
    unlock(robot)
    set_home(robot, "feet")
    axes = robot.api.get("/api/motors").json()
    for axis in axes:
        enable(robot, axis["slot"])
    judge(robot.api.put("/api/mode", json={"mode": "home"})).raise_for_status()
    approve(robot)
    press(robot)
    wait_until("manual again", lambda: robot.status()["app_mode"] == "manual")
    assert robot.api.get("/api/proposals").json()[0]["state"] == "done"
    assert all(motor(robot, axis["slot"])["homed"] for axis in axes if axis["has_switch"])
    wait_for_mode(robot, "MOTION")


def test_targeting_comes_back_as_it_was_set(robot: Stack) -> None:
    register(robot, [str(each) for each in POSE], ignore_registration_rotation=True)
    judge(robot.api.put("/api/targeting/current", json={"current_position": POSE})).raise_for_status()
    target = {
        "entry_point": ["1.5", 2, "-3e1"],
        "target_point": [4, 5, 6],
        "canula_to_treatment_offset": "7.5",
    }
    answer = judge(robot.api.put("/api/targeting/target", json=target)).raise_for_status()
    values = judge(robot.api.get("/api/targeting")).json()
    assert values == answer.json()
    assert values["registration"] == values["reported_position"] == POSE
    assert values["ignore_registration_rotation"] is True
    assert values["entry_point"] == [1.5, 2, -30]
    assert values["cannula_to_treatment_offset"] == values["canula_to_treatment_offset"] == 7.5
    judge(robot.api.put("/api/targeting/target", json={"cannula_to_treatment_offset": 8})).raise_for_status()
    assert robot.api.get("/api/targeting").json()["canula_to_treatment_offset"] == 8
    records = judge(robot.api.get("/api/audit")).json()
    changes = [record["detail"] for record in records if record["kind"] == "setting"]
    assert changes[-1]["old"]["cannula_to_treatment_offset"] == 7.5
    assert changes[-1]["new"]["cannula_to_treatment_offset"] == 8


def test_the_alignment_tells_what_is_missing_then_what_is_desired_reachable_and_current(robot: Stack) -> None:
    def alignment() -> dict:
        return judge(robot.api.get("/api/targeting/alignment")).raise_for_status().json()

    first = alignment()
    assert (first["alignment"], first["current"], first["current_deviation"]) == (None, None, None)
    assert first["alignment_problem"]["code"] == first["current_problem"]["code"] == "NO_REGISTRATION"
    assert (first["frame"], first["current_body_problem"]["code"]) == ("robot", "NOT_HOMED")

    shift = [1, 0, 0, 100, 0, 1, 0, -50, 0, 0, 1, 25, 0, 0, 0, 1]
    register(robot, shift)
    second = alignment()
    assert second["alignment_problem"]["code"] == "NO_TARGET"
    assert second["current_problem"]["code"] == "NOT_HOMED"
    assert "Yaw" in second["current_problem"]["text"]
    target = {"entry_point": [108, 200, 95], "target_point": [105, 150, 85]}
    judge(robot.api.put("/api/targeting/target", json=target)).raise_for_status()
    unlock(robot)
    for axis in robot.api.get("/api/motors").json():
        set_home(robot, axis["slot"])
    wait_until("it rested on no home", lambda: alignment()["alignment_problem"]["code"] == "NO_REGISTRATION")
    register(robot, shift)
    view = alignment()
    assert (view["alignment_problem"], view["current_problem"]) == (None, None)
    aligned = view["alignment"]
    assert aligned["setpoints"]["head"]["position"] == pytest.approx(-18.420966, abs=0.01)
    assert [aligned["desired"][index] for index in (3, 7, 11)] == pytest.approx([105, 150, 85])
    assert aligned["deviation"]["distance_mm"] < 0.1
    assert aligned["clamped"] == []
    # Every axis at 0, to a count: the published home pose, moved by the registration.
    current = [view["current"][index] for index in (3, 7, 11)]
    assert current == pytest.approx([118.32, 159.89, 97.91], abs=0.1)
    apart = math.dist(current, [105, 150, 85])
    assert view["current_deviation"]["distance_mm"] == pytest.approx(apart)

    beyond = {"entry_point": [108, 200, 95], "target_point": [108, 200, 95]}
    judge(robot.api.put("/api/targeting/target", json=beyond)).raise_for_status()
    assert alignment()["alignment_problem"]["code"] == "DEGENERATE"


@pytest.mark.parametrize(
    ("path", "body", "field"),
    [
        ("registration", {"registration": POSE[:15]}, "registration"),
        ("registration", {"registration": [2, *POSE[1:]]}, "registration"),
        ("registration", {"registration": ["x", *POSE[1:]]}, "registration[0]"),
        ("registration", {"registration": [*POSE[:15], 2]}, "registration[15]"),
        ("current", {}, "current_position"),
        ("target", {"target_point": [0, 0, 10001]}, "target_point[2]"),
        ("target", {"robot_to_entry_offset": 1001}, "robot_to_entry_offset"),
        (
            "target",
            {"cannula_to_treatment_offset": 1, "canula_to_treatment_offset": 1},
            "canula_to_treatment_offset",
        ),
    ],
)
def test_wrong_targeting_is_named_and_changes_nothing(
    robot: Stack, path: str, body: dict, field: str
) -> None:
    before = robot.api.get("/api/targeting").json()
    answer = robot.api.put(f"/api/targeting/{path}", json=body)
    assert problem(answer, 422, "INVALID")["field"] == field
    assert robot.api.get("/api/targeting").json() == before


def logged(stream: ClientConnection) -> Iterator[dict]:
    for message in stream:
        if isinstance(message, str) and json.loads(message)["type"] == "log":
            yield json.loads(message)


def test_the_log_is_read_follows_live_and_changes_its_level(robot: Stack) -> None:
    log = judge(robot.api.get("/api/logs?lines=1000")).json()
    assert log["level"] == "info"
    numbers = [line["sequence"] for line in log["lines"]]
    assert numbers == list(range(numbers[0], numbers[0] + len(numbers)))
    assert any("attached to the kernel" in line["text"] for line in log["lines"])
    with open_stream(robot) as stream:
        changed = judge(robot.api.put("/api/logs", json={"level": "debug"})).raise_for_status().json()
        assert changed == {"level": "debug", "lines": []}
        robot.api.get("/api/mode")
        line = next(line for line in logged(stream) if "/api/mode" in line["text"])
        assert line["level"] == "debug"
    lines = judge(robot.api.get("/api/logs?level=debug&lines=1000")).json()["lines"]
    assert line["sequence"] in [each["sequence"] for each in lines]
    assert robot.password not in json.dumps(lines)
    problem(robot.api.get("/api/logs?lines=0"), 422, "INVALID")
    problem(robot.api.get("/api/logs?level=loud"), 422, "INVALID")
    problem(robot.api.put("/api/logs", json={"level": "loud"}), 422, "INVALID")
    assert robot.api.get("/api/logs").json()["level"] == "debug"


def read_to_end(stream: ClientConnection) -> None:
    while True:
        stream.recv()


def consoles(robot: Stack) -> list[dict]:
    connections = judge(robot.api.get("/api/communications")).json()
    return [each for each in connections if each["type"] == "console"]


def test_every_connection_is_listed_and_a_console_can_be_disconnected(robot: Stack) -> None:
    types = {each["type"]: each["connected"] for each in robot.api.get("/api/communications").json()}
    assert types == {"kernel": True, "bench": True}
    with open_stream(robot) as first, open_stream(robot) as second:
        wait_until("both are listed", lambda: len(consoles(robot)) == 2)
        gone, stays = consoles(robot)
        assert gone["client"] == "{}:{}".format(*first.local_address[:2])
        assert (gone["user"], gone["port"]) == ("admin", robot.port)
        left = judge(robot.api.put("/api/communications/disconnect", json={"id": gone["id"]}))
        left.raise_for_status()
        wait_until("one is left", lambda: [each["id"] for each in consoles(robot)] == [stays["id"]])
        with pytest.raises(ConnectionClosed):
            read_to_end(first)
        assert second.recv()
        problem(robot.api.put("/api/communications/disconnect", json={"id": gone["id"]}), 404, "NOT_FOUND")
        problem(robot.api.put("/api/communications/disconnect", json={}), 422, "INVALID")
