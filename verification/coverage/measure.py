"""Statement, branch and MC/DC coverage of the core out of llvm-cov's export, and what is missing by place.

A function of a header exists once in each file that includes it. What any of these copies shows is shown: it
is the same source.
"""

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

CODE_REGION = 0
Place = tuple[str, int, int, int, int]
"""File, and line and column of start and end."""


@dataclass
class Coverage:
    """By place: whether its code ran, which ways its condition went, which of its conditions decided."""

    regions: dict[Place, bool] = field(default_factory=dict)
    branches: dict[Place, tuple[bool, bool]] = field(default_factory=dict)
    decisions: dict[Place, tuple[bool, ...]] = field(default_factory=dict)

    def counts(self) -> dict[str, tuple[int, int]]:
        """Shown and all: statements (regions of code without a branch), branches, conditions of decisions."""
        ways = [way for both in self.branches.values() for way in both]
        conditions = [shown for all_shown in self.decisions.values() for shown in all_shown]
        return {
            "statement": (sum(self.regions.values()), len(self.regions)),
            "branch": (sum(ways), len(ways)),
            "mcdc": (sum(conditions), len(conditions)),
        }

    def missing(self) -> Iterator[str]:
        """A sentence for each thing that no test shows."""
        for place, ran in sorted(self.regions.items()):
            if not ran:
                yield f"{_at(place)}: never runs"
        for place, ways in sorted(self.branches.items()):
            for way, shown in zip(("true", "false"), ways, strict=True):
                if not shown:
                    yield f"{_at(place)}: never {way}"
        for place, conditions in sorted(self.decisions.items()):
            for number, shown in enumerate(conditions, 1):
                if not shown:
                    yield f"{_at(place)}: condition {number} of {len(conditions)} is never shown to decide"


def _at(place: Place) -> str:
    file, line, column, end_line, end_column = place
    first = Path(file).read_text("utf-8").splitlines()[line - 1]
    text = first[column - 1 : end_column - 1] if end_line == line else first[column - 1 :]
    return f"{file[file.index('kernel/') :]}:{line}: '{text.strip()}'"


def read(exported: str) -> Coverage:
    """Sums up an export over all functions of the core."""
    coverage = Coverage()
    for function in json.loads(exported)["data"][0]["functions"]:
        files = function["filenames"]
        for region in function["regions"]:
            place, count, file, kind = region[:4], region[4], region[5], region[7]
            if kind == CODE_REGION:
                key = (files[file], *place)
                coverage.regions[key] = coverage.regions.get(key, False) or count > 0
        for branch in function["branches"]:
            key = (files[branch[6]], *branch[:4])
            before = coverage.branches.get(key, (False, False))
            coverage.branches[key] = (before[0] or branch[4] > 0, before[1] or branch[5] > 0)
        for decision in function["mcdc_records"]:
            key = (files[0], *decision[:4])
            shown = tuple(decision[-1])
            before = coverage.decisions.get(key, (False,) * len(shown))
            coverage.decisions[key] = tuple(a or b for a, b in zip(before, shown, strict=True))
    return coverage


def operators(sources: list[Path]) -> int:
    """Logical operators in the text of the sources. A decision of n conditions has n - 1 of them."""
    total = 0
    for source in sources:
        code = re.sub(r"/\*.*?\*/|//[^\n]*", "", source.read_text("utf-8"), flags=re.DOTALL)
        code = re.sub(r"^_Static_assert.*?;|^#.*?$", "", code, flags=re.DOTALL | re.MULTILINE)
        total += len(re.findall(r"&&|\|\|", code))
    return total
