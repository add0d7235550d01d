"""The pictures of `make bench`, after figures 18 to 23 of the thesis, drawn by the app's chart library."""

import json
import subprocess
from pathlib import Path

import numpy as np
from wakeups import Arrangement

COLUMNS = 700
"""As many as can be told apart; each shows its lowest and its highest value, so that no outlier is lost."""
COLOURS = {"before": "#c44e52", "shipped": "#0b62a4", "cyclictest": "#555555"}
ZOOM_US = 100
"""Half the width of the zoomed profile and histogram about the period."""
BIN_US = 4
"""Of the histogram that is not zoomed: the chart draws no more than 1500 points."""


def extremes(times: np.ndarray, values: np.ndarray) -> tuple[list[float], list[float]]:
    """A curve of at most 2 x COLUMNS points with the lowest and highest value of each column."""
    if len(values) <= 2 * COLUMNS:
        return times.tolist(), values.tolist()
    kept_times, kept_values = [], []
    for part in np.array_split(np.arange(len(values)), COLUMNS):
        kept_times += [float(times[part[0]]), float(times[part[-1]])]
        kept_values += [float(values[part].min()), float(values[part].max())]
    return kept_times, kept_values


def profile(notes: np.ndarray, title: str, colour: str, lowest: float = 0.0, highest: float = np.inf) -> dict:
    """Loop time over time, cut off at the bounds."""
    begun_s = (notes["begun_ns"] - notes["begun_ns"][0]) / 1e9
    loop_us = np.clip(np.diff(notes["begun_ns"].astype(np.int64)) / 1e3, lowest, highest)
    times, values = extremes(begun_s[:-1], loop_us)
    series = {"name": "loop time", "colour": colour, "values": values}
    return {
        "title": title,
        "x_label": "time [s]",
        "x": times,
        "panels": [{"label": "loop time [us]", "series": [series]}],
    }


def steps(edges: np.ndarray, counts: np.ndarray) -> tuple[list[float], list[float]]:
    """A histogram as the outline of its bars."""
    return np.repeat(edges, 2)[1:-1].tolist(), np.repeat(counts, 2).tolist()


def histogram(notes: np.ndarray, title: str, colour: str, period_us: float, most: int | None = None) -> dict:
    """How often each loop time occurred, up to two periods; counts of the zoomed one cut off at `most`."""
    loop_us = np.diff(notes["begun_ns"].astype(np.int64)) / 1e3
    width = BIN_US if most is None else 1
    half = period_us if most is None else ZOOM_US
    edges = np.arange(period_us - half, period_us + half + width, width)
    counts, _ = np.histogram(np.clip(loop_us, edges[0], edges[-1] - 1e-6), edges)
    x, outline = steps(edges, np.minimum(counts, most or counts.max()))
    begins = float(edges[0])
    series = {"name": "ticks", "colour": colour, "values": outline}
    return {
        "title": title,
        "x_label": "loop time [us]" if begins == 0 else f"loop time [us] less {begins:g}",
        "x": [each - begins for each in x],
        "panels": [{"label": f"ticks in {width} us", "series": [series]}],
    }


def all_pictures(notes: dict[str, dict[str, np.ndarray]], period_us: float) -> dict[str, dict]:
    """Each picture by its file name; `notes` by arrangement and loop."""
    before, shipped = notes["before_loaded"], notes["shipped_loaded"]
    main = shipped["main"]
    count = len(main)
    return {
        "18-before-bus": profile(before["bus"], "Bus in its own thread, round robin", COLOURS["before"]),
        "19-before-main": profile(before["main"], "Main loop beside it, round robin", COLOURS["before"]),
        "20-shipped": profile(main, "One loop, as shipped", COLOURS["shipped"]),
        "21-shipped-zoomed": profile(
            main,
            f"One loop, as shipped, within {ZOOM_US} us",
            COLOURS["shipped"],
            period_us - ZOOM_US,
            period_us + ZOOM_US,
        ),
        "22-histogram": histogram(
            main, f"Loop times of {count} ticks, as shipped", COLOURS["shipped"], period_us
        ),
        "23-histogram-zoomed": histogram(
            main,
            f"Loop times of {count} ticks, as shipped, rare ones",
            COLOURS["shipped"],
            period_us,
            max(count // 200, 1),
        ),
    }


def of_loop(notes: np.ndarray, arrangement: Arrangement, title: str, period_us: float) -> dict[str, dict]:
    """The loop times of one set-up: over time, and how often each occurred, all and the rare ones."""
    colour = COLOURS[arrangement.setup]
    rare = max(len(notes) // 200, 1)
    return {
        f"{arrangement.name}-profile": profile(notes, f"Loop time: {title}", colour),
        f"{arrangement.name}-histogram": histogram(notes, f"Loop times: {title}", colour, period_us),
        f"{arrangement.name}-rare": histogram(
            notes, f"Loop times, rare ones: {title}", colour, period_us, rare
        ),
    }


def draw(pictures: dict[str, dict], binaries: Path, folder: Path) -> None:
    """Writes each as FOLDER/NAME.svg."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, chart in pictures.items():
        drawn = subprocess.run(
            [binaries / "draw_chart"], input=json.dumps(chart).encode(), capture_output=True, check=True
        )
        (folder / f"{name}.svg").write_bytes(drawn.stdout)
