"""`make scenarios`: a few of them, drawn by a seed; equal seeds are equal; and its judge is not blind."""

import itertools
import random
import sys
from dataclasses import replace
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).resolve().parents[2] / "verification/scenarios"))

import judge
from plan import FAULTS, ORDERS, PROCESSES, TURN, plan
from run_scenarios import figures_of, run_scenario, verdict_of

SEED = 20_264
CHOSEN = sorted(random.Random(SEED).sample(range(len(TURN)), 5))
OFF, ON = [0] * 10, [0, 0, 0, 0, 300, 0, 0, 0, 0, 0]


def entry(tick: int, drive: list[int] = OFF, pedal: bool = True, estop: bool = True) -> dict:
    return {
        "tick": tick,
        "kernel_tick": tick + 1000,
        "pedal_no": pedal,
        "pedal_nc": not pedal,
        "estop_loop": estop,
        "drive": drive,
        "amplifier": OFF,
    }


def released_at(released: int, last_driven: int) -> list[dict]:
    """Driven from the tenth tick to the last one given; the pedal is up from another tick on."""
    return [
        entry(tick, ON if 10 <= tick <= last_driven else OFF, pedal=tick < released) for tick in range(100)
    ]


@pytest.mark.parametrize("number", CHOSEN, ids=lambda number: plan(SEED, number).fault)
def test_a_fault_of_real_processes_leaves_no_drive_no_process_and_no_lost_record(number: int) -> None:
    outcome = run_scenario(SEED, number)
    assert not outcome["skipped"], "one was drawn that needs root"
    assert outcome["findings"] == [], f"again: make scenarios SEED={SEED} ONLY={number}"
    assert outcome["fault"] == plan(SEED, number).fault
    assert outcome["figures"]["acknowledged"] > 0


def test_a_scenario_is_its_seed_and_its_number() -> None:
    assert [plan(7, number) for number in range(60)] == [plan(7, number) for number in range(60)]
    assert [plan(7, number) for number in range(60)] != [
        replace(plan(8, number), seed=7) for number in range(60)
    ]


def test_every_kind_of_fault_comes_in_each_turn() -> None:
    drawn = [plan(1, number) for number in range(20 * len(TURN))]
    for turn in range(20):
        kinds = [one.fault for one in drawn[turn * len(TURN) : (turn + 1) * len(TURN)]]
        assert sorted(kinds) == sorted(TURN)
    assert set(TURN) == set(FAULTS)
    assert {one.stop for one in drawn} == {"pedal", "estop", "request"}


@pytest.mark.parametrize("seed", range(1, 21))
def test_200_scenarios_of_any_seed_end_and_start_the_processes_in_every_order(seed: int) -> None:
    drawn = [plan(seed, number) for number in range(200)]
    restarts = [one for one in drawn if one.fault == "restart_in_order"]
    every = set(itertools.permutations(PROCESSES))
    assert {one.end_order for one in restarts} == every
    assert {one.start_order for one in restarts} == every
    assert len({(one.end_order, one.start_order) for one in restarts[: len(ORDERS)]}) == len(ORDERS)
    assert [one.end_order for one in restarts] != [one.start_order for one in restarts]


def test_orders_are_counted_of_scenarios_that_restart_alone() -> None:
    restarts = [number for number in range(len(TURN)) if plan(1, number).fault == "restart_in_order"]
    outcomes = [
        {"number": number, "fault": plan(1, number).fault, "skipped": False, "findings": [], "figures": {}}
        for number in range(len(TURN))
    ]
    figures = figures_of(1, outcomes)
    assert figures["end_orders"] == figures["start_orders"] == len(restarts) == 3


def test_P2_a_drive_that_outlives_the_pedal_by_more_than_two_ticks_is_found() -> None:
    assert judge.driven_without_consent(released_at(50, last_driven=51)) == []
    assert len(judge.driven_without_consent(released_at(50, last_driven=52))) == 1
    pulled = [entry(tick, ON if 10 <= tick <= 60 else OFF, estop=tick < 50) for tick in range(100)]
    assert len(judge.driven_without_consent(pulled)) == 9


def test_P10_a_drive_later_than_allowed_after_the_fault_is_found() -> None:
    record = released_at(100, last_driven=62)
    assert judge.stop_ticks(record, fault=50) == 12
    assert judge.driven_later_than(record, 50, 12) == []
    assert len(judge.driven_later_than(record, 50, 11)) == 1
    assert judge.stop_ticks(record, fault=62) == 0
    assert judge.was_moving(record, tick=99)
    assert not judge.was_moving(released_at(100, last_driven=40), tick=99)


def test_a_card_that_outlives_the_silence_of_the_kernel_is_found() -> None:
    assert judge.amplifier_outlives_silence(100, 105) == []
    assert len(judge.amplifier_outlives_silence(100, 106)) == 1
    assert len(judge.amplifier_outlives_silence(100, None)) == 1
    assert judge.silences([entry(1), entry(6), entry(12)]) == [(6, 12)]


def test_a_record_that_was_acknowledged_and_is_gone_is_found() -> None:
    assert judge.lost_records([[1, 1, 0]], [[1, 1, 0], [2, 1, 0]]) == []
    assert len(judge.lost_records([[1, 1, 0], [3, 1, 0]], [[1, 1, 0]])) == 1


def test_the_verdict_asks_for_every_kind_for_records_and_for_stops_in_motion() -> None:
    outcomes: list[dict] = [
        {
            "number": number,
            "fault": fault,
            "skipped": False,
            "findings": [],
            "figures": {"acknowledged": 3, "moving": True},
        }
        for number, fault in enumerate(FAULTS)
    ]
    wanted = len(TURN)
    assert verdict_of(figures_of(1, outcomes), wanted) == "PASSED"
    assert verdict_of(figures_of(1, outcomes[1:]), wanted) == "VACUOUS"
    for nothing in ({"acknowledged": 3}, {"moving": True}):
        idle = [one | {"figures": nothing} for one in outcomes]
        assert verdict_of(figures_of(1, idle), wanted) == "VACUOUS"
    assert (
        verdict_of(figures_of(1, [*outcomes[1:], outcomes[0] | {"findings": ["driven"]}]), wanted) == "FAILED"
    )
    assert verdict_of(figures_of(1, [*outcomes[1:], outcomes[0] | {"skipped": True}]), wanted) == "UNKNOWN"
