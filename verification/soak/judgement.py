"""What the figures of a soak mean: missed deadlines beside those of the idle robot, and memory over time."""

import collections
import random
import statistics
from collections.abc import Sequence

SIGNIFICANCE = 0.01
SHUFFLES = 10_000
# Of the app's resident memory over the second half of the soak: what an allocator and the caches of the store
# may take in one step, and what may come in a minute.
RSS_STEP_KIB = 1024
RSS_KIB_PER_MINUTE = 32


def ranks(values: Sequence[int]) -> list[float]:
    """Of each value among all, from 1; equal ones share the mean of theirs."""
    rank_of = {}
    before = 0
    for value, count in sorted(collections.Counter(values).items()):
        rank_of[value] = before + (count + 1) / 2
        before += count
    return [rank_of[value] for value in values]


def chance_of_misses(idle: Sequence[int], loaded: Sequence[int]) -> float:
    """The chance that the loaded windows rank as high among all as they do, or higher, when load has no
    bearing on their missed deadlines: a permutation test of the ranks, one-sided, with the same shuffles
    every time.

    `idle` and `loaded` are misses by window. Ranks count and not misses, as these come in bursts: whatever
    takes the processor away takes it for many ticks. That holds for a machine that misses none as for a busy
    one that misses some in every window.
    """
    ranked = ranks([*loaded, *idle])
    seen = sum(ranked[: len(loaded)])
    shuffled = random.Random(1)
    as_high = sum(sum(shuffled.sample(ranked, len(loaded))) >= seen for _ in range(SHUFFLES))
    return (1 + as_high) / (1 + SHUFFLES)


def second_half(samples: Sequence[tuple[float, float]]) -> Sequence[tuple[float, float]]:
    """What comes after the caches have filled."""
    return samples[len(samples) // 2 :]


def growth_kib(samples: Sequence[tuple[float, float]]) -> tuple[float, float]:
    """KiB gained in the second half of the samples (time in s, KiB), from the mean of its first fifth to that
    of its last, and how much that is in a minute."""
    late = second_half(samples)
    fifth = max(1, len(late) // 5)
    (begin_s, first), (end_s, last) = (
        [statistics.fmean(values) for values in zip(*part, strict=True)]
        for part in (late[:fifth], late[-fifth:])
    )
    gained = last - first
    return gained, 60.0 * gained / (end_s - begin_s) if end_s > begin_s else 0.0


def growth_limit_kib(samples: Sequence[tuple[float, float]]) -> float:
    """What may be gained in the second half of the samples."""
    late = second_half(samples)
    return RSS_STEP_KIB + RSS_KIB_PER_MINUTE * (late[-1][0] - late[0][0]) / 60.0
