"""What `make soak` concludes from its figures."""

import sys
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).resolve().parents[2] / "verification/soak"))

from judgement import SIGNIFICANCE, chance_of_misses, growth_kib, growth_limit_kib

QUIET = [0] * 60


def memory(kib_per_minute: float, step_kib: float = 0.0, minutes: int = 30) -> list[tuple[float, float]]:
    """Samples every ten seconds; the step comes three quarters through."""
    times = [10.0 * sample for sample in range(6 * minutes)]
    step_at = 45.0 * minutes
    return [(time, 12_000 + kib_per_minute * time / 60 + step_kib * (time > step_at)) for time in times]


@pytest.mark.parametrize(
    "loaded", [[0] * 180, [0] * 179 + [900], [0, 0, 0, 5] * 45], ids=["none", "one burst", "as before"]
)
def test_misses_that_come_without_load_as_well_are_not_held_against_it(loaded: list[int]) -> None:
    idle = [0, 0, 0, 5] * 15 if any(loaded[:4]) else QUIET
    assert chance_of_misses(idle, loaded) >= SIGNIFICANCE


def test_a_busy_machine_misses_some_in_every_window_and_that_is_not_held_against_the_load() -> None:
    idle = [700 + 7 * window % 50 for window in range(60)]
    loaded = [700 + 11 * window % 50 for window in range(180)]
    assert chance_of_misses(idle, loaded) >= SIGNIFICANCE


@pytest.mark.parametrize("loaded", [[0, 0, 1] * 60, [1] * 20 + [0] * 160])
def test_misses_that_come_with_the_load_are_seen(loaded: list[int]) -> None:
    assert chance_of_misses(QUIET, loaded) < SIGNIFICANCE


def test_a_leak_is_seen_and_a_step_is_none() -> None:
    for samples, grows in (
        (memory(0.0), False),
        (memory(0.0, step_kib=900.0), False),
        (memory(150.0), True),
        (memory(600.0, minutes=5), True),
    ):
        assert (growth_kib(samples)[0] > growth_limit_kib(samples)) == grows
    assert growth_kib(memory(150.0))[1] == pytest.approx(150.0)
