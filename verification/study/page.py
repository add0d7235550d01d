"""The curves that are kept, and their tables and pictures in docs/degradation.md."""

import json
import re
from collections.abc import Iterator
from html import escape
from pathlib import Path

from curves import ROOT, Row

KEPT = Path(__file__).with_name("curves.json")
PAGE = ROOT / "docs/degradation.md"

# What holds up to some size: all runs are done, and these figures are no larger.
STATED = {
    ("homing", "neuro"): {"worst_counts": 1},
    ("homing", "prostate"): {"worst_counts": 1},
    ("tracking", "neuro"): {"worst_counts": 2},
    ("tracking", "prostate"): {"worst_counts": 40},
    ("rotation", "prostate"): {"p95_mm": 1.1},
    ("targeting", "neuro"): {"p95_mm": 0.1},
    ("targeting", "prostate"): {"p95_mm": 0.1},
}
DRAWN = {"homing": "done", "tracking": "worst_counts", "rotation": "worst_counts", "targeting": "p95_mm"}
COLOURS = ("#0b62a4", "#d1495b", "#2e7d32", "#b26a00", "#6a3d9a", "#00838f", "#8d6e63", "#c2185b", "#455a64")


def kept() -> list[Row]:
    return json.loads(KEPT.read_text())


def by_disturbance(rows: list[Row], curve: str, robot: str) -> Iterator[tuple[str, list[Row]]]:
    """Each disturbance of a curve with its points, the undisturbed one first."""
    chosen = [row for row in rows if (row["curve"], row["robot"]) == (curve, robot)]
    undisturbed = [{**row, "size": 0} for row in chosen if row["disturbance"] == "none"]
    names = dict.fromkeys(row["disturbance"] for row in chosen if row["disturbance"] != "none")
    for name in names:
        points = [row for row in chosen if row["disturbance"] == name]
        yield name, undisturbed + sorted(points, key=lambda row: row["size"])


def holds(row: Row) -> bool:
    stated = STATED[row["curve"], row["robot"]]
    return row["done"] == row["runs"] and all(row[figure] <= most for figure, most in stated.items())


def reach(points: list[Row]) -> str:
    """Up to which size what is stated holds."""
    good = 0
    while good < len(points) and holds(points[good]):
        good += 1
    if good == 0:
        return "no size"
    return f"{points[good - 1]['size']:g}" + ("" if good < len(points) else ", the largest tried")


def cell_of(row: Row) -> str:
    """The result of a point, for its cell."""
    if row["done"] < row["runs"]:
        return f"{row['done']} of {row['runs']}"
    match row["curve"]:
        case "homing":
            return f"{row['worst_counts']:g}"
        case "targeting":
            return f"{row['mean_mm']:.2f}, {row['p95_mm']:.2f}; {100 * row['within_claim']:.0f} %"
        case "rotation":
            return f"{row['worst_counts']:.0f}; {row['p95_mm']:.2f}"
    return f"{row['rms_counts']:.1f}, {row['worst_counts']:.1f}; {row['time_s']:.0f} s"


def table(rows: list[Row], curve: str, robot: str) -> str:
    lines = ["| | size: result | holds up to |", "|---|---|---|"]
    for name, points in by_disturbance(rows, curve, robot):
        cells = " · ".join(f"{row['size']:g}: {cell_of(row)}" for row in points)
        lines.append(f"| {name} | {cells} | {reach(points)} |")
    return "\n".join(lines)


def picture(rows: list[Row], curve: str, robot: str) -> str:
    """Each disturbance as a line: the figure over the size, in parts of the largest size that was tried."""
    figure = DRAWN[curve]
    share = figure == "done"
    lines = list(by_disturbance(rows, curve, robot))
    of_all = [row for _, points in lines for row in points if figure in row]
    top = 1.05 * max(row[figure] / (row["runs"] if share else 1) for row in of_all)
    width, height, left, below = 520, 260, 50, 30
    parts = [
        '<svg xmlns="http://www.w3.org/2000/svg" '
        f'viewBox="0 0 {width} {height + below + 16 * len(lines) + 10}" '
        'font-family="sans-serif" font-size="11">',
        '<rect width="100%" height="100%" fill="#fff"/>',
        f'<path d="M{left} 10V{height}H{width - 10}" fill="none" stroke="#444"/>',
        f'<text x="{left - 6}" y="16" text-anchor="end">{top:.3g}</text>',
        f'<text x="{left - 6}" y="{height}" text-anchor="end">0</text>',
        f'<text x="{width - 10}" y="{height + 14}" text-anchor="end">largest size that was tried</text>',
        f'<text x="{left}" y="{height + 14}">{"share of homings that are done" if share else figure}</text>',
    ]
    for place, (name, points) in enumerate(lines):
        colour = COLOURS[place % len(COLOURS)]
        largest = points[-1]["size"]
        drawn = [
            (
                left + (width - left - 10) * row["size"] / largest,
                height - (height - 10) * row[figure] / (row["runs"] if share else 1) / top,
            )
            for row in points
            if figure in row
        ]
        way = " ".join(f"{x:.1f},{y:.1f}" for x, y in drawn)
        parts.append(f'<polyline points="{way}" fill="none" stroke="{colour}" stroke-width="1.5"/>')
        parts += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2.5" fill="{colour}"/>' for x, y in drawn]
        at = height + below + 16 * place + 6
        parts.append(f'<path d="M{left} {at}h18" stroke="{colour}" stroke-width="2"/>')
        parts.append(f'<text x="{left + 24}" y="{at + 4}">{escape(name)}, to {largest:g}</text>')
    return "\n".join([*parts, "</svg>"]) + "\n"


def keep(rows: list[Row]) -> None:
    """Keeps the curves, and draws them into the page, between its marks."""
    KEPT.write_text(json.dumps(rows, indent=1, ensure_ascii=False) + "\n")
    text = PAGE.read_text()
    for curve, robot in STATED:
        drawn = f"images/degradation-{curve}-{robot}.svg"
        (ROOT / "docs" / drawn).write_text(picture(rows, curve, robot))
        made = f"{table(rows, curve, robot)}\n\n![{curve} of the {robot} robot]({drawn})\n"
        mark = f"<!-- {curve} {robot} -->\n"
        text, found = re.subn(rf"(?s){mark}.*?{mark}", lambda _, m=mark, t=made: m + t + m, text)
        assert found == 1, f"docs/degradation.md has no pair of marks {mark.strip()}"
    PAGE.write_text(text)
