"""What `make bench` makes of what it saw, and the reaction that it measures."""

import importlib.util
import json
import subprocess
import sys
from pathlib import Path

import jsonschema
import numpy as np
import pytest
from bare_kernel import BIN

sys.path.append(str(Path(__file__).resolve().parents[2] / "verification/bench"))

import hostile
import pictures
import rates
import wakeups
import watch

ROOT = Path(__file__).resolve().parents[2]
BENCH = ROOT / "verification/bench"
PERIOD_NS = 1_000_000


def notes_of(late_us: list[float]) -> np.ndarray:
    """Ticks a millisecond apart, each so late."""
    notes = np.zeros(len(late_us), wakeups.NOTE)
    notes["late_ns"] = np.array(late_us) * 1e3
    notes["begun_ns"] = np.arange(1, len(late_us) + 1) * PERIOD_NS + notes["late_ns"]
    return notes


def test_wakeups_and_loop_times_of_a_known_run() -> None:
    seen = wakeups.of_notes(notes_of([10.0] * 999 + [1500.0]), period_us=1000)
    assert seen["wake"] == {
        "wakeups": 1000,
        "median_us": 10.0,
        "p99_us": 10.0,
        "p999_us": pytest.approx(11.5, abs=1.5),
        "p9999_us": pytest.approx(1351.0, abs=1.0),
        "max_us": 1500.0,
    }
    assert seen["loop"]["median_us"] == 1000.0
    assert seen["loop"]["max_us"] == 2490.0
    assert seen["missed_deadlines"] == 1
    assert seen["held_up"] == 0


def test_a_tick_that_the_simulated_bus_held_up_is_no_wakeup() -> None:
    notes = notes_of([10.0, 20.0, 1700.0, 40.0])
    notes["busy_until_ns"][2] = 3 * PERIOD_NS + 1
    seen = wakeups.of_notes(notes, period_us=1000)
    assert (seen["wake"]["wakeups"], seen["wake"]["max_us"]) == (3, 40.0)
    assert (seen["held_up"], seen["missed_deadlines"]) == (1, 0)
    assert seen["loop"]["max_us"] == 2680.0


def test_wakeups_of_cyclictest_are_counted_beyond_its_histogram_too() -> None:
    report = {"thread": {"0": {"histogram": {"5": 990, "7": 8}, "cycles": 1000}}}
    seen = wakeups.of_counts(wakeups.histogram_of(report), 1000)
    assert seen == {
        "wakeups": 1000,
        "median_us": 5,
        "p99_us": 5,
        "p999_us": wakeups.MOST_LATE_US,
        "p9999_us": wakeups.MOST_LATE_US,
        "max_us": wakeups.MOST_LATE_US,
        "missed_deadlines": 2,
    }


def test_only_the_seconds_in_which_cyclictest_ran_are_judged() -> None:
    kept = wakeups.within(notes_of([0.0] * 10), 3 * PERIOD_NS, 7 * PERIOD_NS)
    assert (kept["begun_ns"] // PERIOD_NS).tolist() == [3, 4, 5, 6]


def test_the_work_beside_a_hostile_app_is_set_against_that_beside_an_honest_one() -> None:
    notes = notes_of([0.0] * 40_000)
    notes["work_ns"] = 6_000
    slow = {"honest": (0, 20_000), "hostile": (10_000, 60_000), "honest_again": (20_000, 10_000)}
    for first, work_ns in slow.values():
        notes["work_ns"][first : first + 10] = work_ns
    turns = [
        (name, n * 10_000 * PERIOD_NS + 1, (n + 1) * 10_000 * PERIOD_NS)
        for n, name in enumerate(hostile.TURNS)
    ]
    seen = hostile.of_turns(notes, turns)
    assert seen["work_us_median_honest"] == seen["work_us_median_hostile"] == 6.0
    assert seen["work_us_p9999_honest"] == 20.0
    assert seen["work_p9999_hostile_to_honest"] == 3.0
    assert seen["work_p9999_honest_to_honest"] == 2.0


def test_the_rate_is_the_last_before_the_first_miss() -> None:
    rate, seen = rates.highest(lambda period_us: int(period_us in (400, 200)))
    assert rate == 2000.0
    assert list(seen) == ["2000", "1000", "500", "400"]
    assert rates.highest(lambda _: 1)[0] == 0.0


def test_a_picture_keeps_the_outlier_of_a_long_run() -> None:
    late = [5.0] * 100_000
    late[54_321] = 2345.0
    drawn = pictures.profile(notes_of(late), "long", "#000000")
    [series] = drawn["panels"][0]["series"]
    assert max(series["values"]) == pytest.approx(3340.0)
    assert len(drawn["x"]) == len(series["values"]) <= 2 * pictures.COLUMNS


def test_a_histogram_counts_every_tick_once() -> None:
    drawn = pictures.histogram(notes_of([5.0] * 400 + [1800.0, 5.0, 5.0]), "counted", "#000000", 1000)
    [series] = drawn["panels"][0]["series"]
    assert sum(series["values"]) / 2 == 402
    assert len(drawn["x"]) == len(series["values"])


def test_pictures_are_drawn(tmp_path: Path) -> None:
    notes = notes_of([5.0] * 3000)
    loops = {"main": notes, "bus": notes}
    every = pictures.all_pictures({"before_loaded": loops, "shipped_loaded": loops}, 1000)
    pictures.draw(every, BIN, tmp_path)
    drawn = sorted(tmp_path.glob("*.svg"))
    assert [each.name[:2] for each in drawn] == ["18", "19", "20", "21", "22", "23"]
    assert all("<polyline" in each.read_text() for each in drawn)
    assert "loop time [us] less 900" in drawn[-1].read_text()


def test_an_hour_of_one_set_up_leaves_a_record_of_its_schema_a_table_and_pictures(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    notes = notes_of([10.0] * 999 + [1500.0])
    beside = wakeups.of_counts(np.bincount([5] * 998 + [8] * 2), 1000)
    shares = dict.fromkeys(wakeups.SHARES, 2.0)
    seen = {"seconds": 1, "loops": {"main": wakeups.of_notes(notes, 1000)}, "cyclictest": beside}
    seen |= {"wake_to_cyclictest": shares, "load": {}, "notes": {"main": notes}}
    monkeypatch.setattr(wakeups, "measure", lambda *_: dict(seen))
    monkeypatch.setattr(watch, "FOLDER", tmp_path)
    arrangement = watch.BY_NAME["shipped_idle"]
    told = watch.watch(arrangement, 1, BIN)
    jsonschema.validate(watch.record_of(arrangement, told), json.loads(watch.SCHEMA.read_text("utf-8")))
    assert "missed deadlines 1, held up 0" in watch.table(told)
    drawn = sorted(path.stem for path in (tmp_path / "pictures").glob("*.svg"))
    assert drawn == ["shipped_idle-histogram", "shipped_idle-profile", "shipped_idle-rare"]


@pytest.fixture(scope="module")
def bench_run() -> object:
    specification = importlib.util.spec_from_file_location("bench_run", BENCH / "run.py")
    assert specification is not None
    assert specification.loader is not None
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


def full_figures(bench_run: object) -> dict[str, float]:
    """Of a full run in which nothing was above its limit."""
    schema = json.loads(bench_run.SCHEMA.read_text())
    named = dict.fromkeys(schema["properties"]["figures"]["required"], 1.0)
    edges = {"reaction_edges": bench_run.EDGES, "reaction_edges_timed": bench_run.EDGES}
    return named | dict.fromkeys(bench_run.limits_of(300), 0) | edges | {"rate_seconds": bench_run.RATE_S}


def test_a_record_without_a_figure_that_the_ladder_names_is_refused(bench_run: object) -> None:
    figures = full_figures(bench_run)
    schema = json.loads(bench_run.SCHEMA.read_text())
    detail = {name: {} for name in schema["properties"]["detail"]["required"]}
    bench_run.check(bench_run.record_of(figures, 300, 0.0, detail))
    del figures["wake_p999_us"]
    with pytest.raises(jsonschema.ValidationError, match="wake_p999_us"):
        bench_run.check(bench_run.record_of(figures, 300, 0.0, detail))


def test_a_figure_above_its_limit_fails_the_run_and_a_short_run_is_bounded(bench_run: object) -> None:
    figures = full_figures(bench_run)
    assert bench_run.status_of(figures, 300) == "PASSED"
    assert bench_run.status_of(figures, 299) == "BOUNDED"
    assert bench_run.status_of(figures | {"reaction_edges_timed": 9_999}, 300) == "BOUNDED"
    assert bench_run.status_of(figures | {"rate_seconds": 59}, 300) == "BOUNDED"
    for name, limit in bench_run.limits_of(300).items():
        assert bench_run.status_of(figures | {name: limit}, 300) == "PASSED"
        short = "FAILED" if name in bench_run.LIMITS else "BOUNDED"
        assert bench_run.status_of(figures | {name: limit + 1}, 300) == "FAILED"
        assert bench_run.status_of(figures | {name: limit + 1}, 10) == short
    assert bench_run.LIMITS["step_ns_median"] * 2 == bench_run.LIMITS["step_ns_worst_path"] == 2000
    assert bench_run.LIMITS["step_instructions_median"] == 11_000
    assert bench_run.LIMITS["reaction_ticks_most"] == 2


def test_a_full_run_times_ten_thousand_edges_and_a_short_one_as_many_as_fit(bench_run: object) -> None:
    assert bench_run.edges_timed(300) == bench_run.edges_timed(3600) == 10_000
    assert bench_run.edges_timed(10) == 340


def searched(folder: Path) -> dict:
    command = [BIN / "worst_path", folder, "3", "30000", "1"]
    return json.loads(subprocess.run(command, check=True, capture_output=True).stdout)


def test_the_search_goes_uphill_and_equal_seeds_find_equal_steps(tmp_path: Path) -> None:
    found, again = searched(tmp_path / "one")["found"], searched(tmp_path / "two")["found"]
    assert all(each["blocks"] >= each["start_blocks"] for each in found)
    assert max(each["blocks"] for each in found) > max(each["start_blocks"] for each in found)
    for one, two in zip(found, again, strict=True):
        assert Path(one["file"]).read_bytes() == Path(two["file"]).read_bytes()


def test_a_step_that_was_found_is_played_again_and_a_broken_one_is_named(tmp_path: Path) -> None:
    file = Path(searched(tmp_path)["found"][0]["file"])
    subprocess.run([BIN / "step_bench", file, "3"], check=True)
    step = json.loads(file.read_text())
    step["state"].pop()
    file.write_text(json.dumps(step))
    refused = subprocess.run([BIN / "step_bench", file, "3"], capture_output=True, text=True)
    assert refused.returncode == 2
    assert f"{file}: state has {len(step['state'])} words, expected" in refused.stderr


def test_P2_the_wire_carries_zero_drive_within_two_ticks_of_the_pedals_release(tmp_path: Path) -> None:
    compiled = rates.configuration(BIN, 1000, tmp_path)
    plant = ROOT / "models/plant/neuro.toml"
    command = [BIN / "executive_bench", "reaction-sim", compiled, plant, "300", "7"]
    seen = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
    assert seen["edges"] == 300
    assert seen["ticks"]["more"] == 0
    assert seen["ticks"]["1"] + seen["ticks"]["2"] == 300
