"""What a monitoring server reads, by Prometheus' own parser, on a whole robot."""

import math

import httpx
from conftest import StackFactory
from interface import judge
from motion import unlock, wait_for_mode
from prometheus_client.parser import text_string_to_metric_families
from stack import Stack

Series = tuple[str, frozenset[tuple[str, str]]]


def metrics(robot: Stack) -> dict[Series, float]:
    answer = judge(httpx.get(f"{robot.url}api/metrics")).raise_for_status()
    samples = [sample for family in text_string_to_metric_families(answer.text) for sample in family.samples]
    series = {(sample.name, frozenset(sample.labels.items())): sample.value for sample in samples}
    assert len(series) == len(samples), "a series came twice"
    return series


def value(series: dict[Series, float], name: str, **labels: str) -> float:
    return series[name, frozenset(labels.items())]


def test_metrics_say_without_login_what_the_status_says(stack: StackFactory) -> None:
    robot = stack()
    unlock(robot)
    wait_for_mode(robot, "READY")
    before = robot.status()
    series = metrics(robot)
    after = robot.status()
    assert value(series, "interlock_mode", mode="READY") == 1
    assert value(series, "interlock_mode", mode="LOCKED") == 0
    assert value(series, "interlock_lock_cause", cause="ESTOP") == 0
    assert before["tick"] <= value(series, "interlock_ticks_total") <= after["tick"]
    assert value(series, "interlock_snapshot_age_seconds") >= 0
    steps = [
        (math.inf if dict(labels)["le"] == "+Inf" else float(dict(labels)["le"]), count)
        for (name, labels), count in series.items()
        if name == "interlock_phase_seconds_bucket" and ("phase", "step") in labels
    ]
    counts = [count for _, count in sorted(steps)]
    assert counts == sorted(counts)
    assert counts[-1] >= before["tick"]
    axes = {row["name"] for row in robot.api.get("/api/motors").json()}
    assert {dict(labels)["axis"] for name, labels in series if name == "interlock_axis_homed"} == axes


def test_metrics_name_what_locked_the_system(stack: StackFactory) -> None:
    robot = stack()
    unlock(robot)
    robot.control("estop", pulled=True)
    wait_for_mode(robot, "LOCKED")
    series = metrics(robot)
    assert value(series, "interlock_mode", mode="LOCKED") == 1
    assert value(series, "interlock_lock_cause", cause="ESTOP") == 1
    assert value(series, "interlock_estop") == 1
