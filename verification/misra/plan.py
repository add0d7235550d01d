"""Holds the guideline enforcement plan, enforcement.md, against all guidelines and all checks that are run.

Only the numbers and categories of the guidelines are here; their texts are licensed.
"""

import re
from dataclasses import dataclass
from pathlib import Path

from named_proofs import faults_of_named_proofs

HERE = Path(__file__).resolve().parent

RULES = dict(enumerate((4, 7, 2, 2, 9, 2, 4, 14, 5, 8, 9, 5, 6, 4, 7, 7, 8, 8, 2, 14, 21, 10), 1))
"""Rules of each section of MISRA C:2012 with Amendments 1 and 2."""
DIRECTIVES = {1: 1, 2: 1, 3: 1, 4: 14}
MANDATORY = set(
    re.findall(r"\S+", "9.1 12.5 13.6 17.3 17.4 17.6 19.1 21.13 21.17 21.18 21.19 21.20 22.2 22.4 22.5 22.6")
)
ADVISORY = set(
    re.findall(
        r"\S+",
        "1.2 2.3 2.4 2.5 2.6 2.7 4.2 5.9 8.7 8.9 8.11 8.13 10.5 11.4 11.5 12.1 12.3 12.4 13.3 13.4 15.1 15.4"
        " 15.5 17.5 17.8 18.4 18.5 19.2 20.1 20.5 21.12 D4.2 D4.4 D4.5 D4.6 D4.8 D4.9 D4.13",
    )
)

RUNNERS = {
    rung: HERE.parent / directory / "run.py"
    for rung, directory in (
        ("cbmc", "cbmc"),
        ("coverage", "coverage"),
        ("target", "target"),
    )
}
"""Rungs that discharge what no checker can decide."""

ROW = re.compile(r"\| (D?\d+\.\d+) \| (mandatory|required|advisory) \| ([^|]+) \| ([^|]+) \|")
METHOD = re.compile(
    r"cppcheck|gcc -W[\w=-]+|clang-tidy [\w-]+|scan [\w-]+|proof (?P<rung>\w+)|by \d+\.\d+|build|review"
    r"|deviation|disapplied"
)


@dataclass(frozen=True)
class Row:
    guideline: str
    category: str
    core: tuple[str, ...]
    host: tuple[str, ...]


def guidelines() -> list[str]:
    """All guidelines, directives first, `D` before their numbers."""
    numbered = [f"D{section}.{n}" for section, last in DIRECTIVES.items() for n in range(1, last + 1)]
    return numbered + [f"{section}.{n}" for section, last in RULES.items() for n in range(1, last + 1)]


def category(guideline: str) -> str:
    if guideline in MANDATORY:
        return "mandatory"
    return "advisory" if guideline in ADVISORY else "required"


def read_plan() -> list[Row]:
    rows = []
    for line in (HERE / "enforcement.md").read_text("utf-8").splitlines():
        match = re.fullmatch(
            r"\| (D?\d+\.\d+) \| (mandatory|required|advisory) \| ([^|]+) \| ([^|]+) \|", line
        )
        if match:
            cells = [tuple(method.strip() for method in match[n].split(",")) for n in (3, 4)]
            rows.append(Row(match[1], match[2], *cells))
    return rows


def _proving_rungs(row: Row) -> list[str]:
    """The rungs that the row says to decide its guideline."""
    matches = (METHOD.fullmatch(method) for method in (*row.core, *row.host))
    return [match["rung"] for match in matches if match and match["rung"]]


def _unknown_methods(row: Row, seeded: set[str]) -> list[str]:
    faults = []
    for method in {*row.core, *row.host}:
        match = METHOD.fullmatch(method)
        if not match:
            faults.append(f"'{method}' is no method; the head of enforcement.md lists them")
        elif match["rung"] and (match["rung"] not in RUNNERS or not RUNNERS[match["rung"]].exists()):
            faults.append(f"there is no rung '{match['rung']}' to prove it")
        check = row.guideline if method == "cppcheck" else re.sub("^(gcc|clang-tidy) ", "", method)
        if re.match(r"cppcheck|gcc|clang-tidy|scan", method) and check not in seeded:
            faults.append(f"no seeded violation shows that '{method}' detects it")
    return faults


def faults_of_plan(seeded: set[str], deviating: set[str], disapplied: set[str]) -> list[str]:
    """What is wrong with the plan, a sentence each: a guideline without a row, a category, a method that is
    not run or that no seeded violation shows to detect, a deviation that is told but not recorded, or the
    other way round, a proof that is named but does not exist, or is not named.
    """
    rows = read_plan()
    wanted = guidelines()
    planned = [row.guideline for row in rows]
    faults = [f"{name}: not in enforcement.md" for name in wanted if name not in planned]
    if planned != wanted and not faults:
        faults.append("enforcement.md: rows are out of order, repeated or of no guideline")
    for row in rows:
        if row.category != category(row.guideline):
            faults.append(f"{row.guideline}: category {row.category}, expected {category(row.guideline)}")
        if {"deviation", "disapplied"} & set(row.core):
            faults.append(f"{row.guideline}: the core has no deviations")
        for mark, recorded in (("deviation", deviating), ("disapplied", disapplied)):
            if (mark in row.host) != (row.guideline in recorded):
                faults.append(f"{row.guideline}: enforcement.md and deviations.toml disagree on '{mark}'")
        faults += [f"{row.guideline}: {fault}" for fault in _unknown_methods(row, seeded)]
    return faults + faults_of_named_proofs({row.guideline: _proving_rungs(row) for row in rows})
