"""Opens rows of the matrix as an assessor would: from the hazard down to code and raw logs, and back up."""

import random
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from html import escape, unescape
from itertools import pairwise
from pathlib import Path

from matrix import Row
from results import AWAITED

ROWS = 20
CODE = re.compile(r"([^: ]+)(?::(\d+) (\w+))?")
LEFT_NOTHING = (AWAITED, "UNKNOWN")
"""Of these there is no log; other rules of the gate say so."""
RAW_LOG = re.compile(r'<dt>Raw log<dd><a href="([^"]+)"')


@dataclass(frozen=True)
class Pages:
    """The report as it was written."""

    written: Mapping[str, str]
    """Our own pages, by name."""
    output: Path
    """Folder in which they stand, beside what else they lead to."""
    root: Path

    def opened(self, page: str, anchor: str) -> str:
        """What stands from an anchor on; nothing when there is no such anchor."""
        _, found, rest = self.written[page].partition(f'id="{escape(anchor)}"')
        return rest.partition("</article>")[0] if found else ""


def uid_of(cell: str) -> str:
    return cell.partition(" ")[0]


def steps(row: Row) -> list[str]:
    """The items of a row, from the hazard down."""
    cells = (row.hazard, row.cause, row.control, row.system_requirement, row.requirement)
    return [uid_of(cell) for cell in cells]


def wrong_steps(row: Row, pages: Pages) -> Iterator[str]:
    for above, below in pairwise(steps(row)):
        for here, there in ((above, below), (below, above)):
            if f'href="trace.html#{there}"' not in pages.opened("trace.html", here):
                yield f"{here} does not lead to {there}"


def wrong_code(row: Row, pages: Pages) -> Iterator[str]:
    requirement = pages.opened("trace.html", steps(row)[-1])
    for code in filter(None, row.code.split("; ")):
        file, line, name = CODE.fullmatch(code).groups()
        path = pages.root / file
        if f'href="../../{file}"' not in requirement:
            yield f"it does not lead to {file}"
        if not path.exists():
            yield f"{file} is not there"
        elif line and name not in path.read_text("utf-8").splitlines()[int(line) - 1]:
            yield f"{name} does not begin at {file}:{line}"


def wrong_results(row: Row, pages: Pages) -> Iterator[str]:
    for result in filter(None, row.results.split("; ")):
        uid, _, status = result.rpartition(" ")
        page = pages.opened("results.html", uid)
        if status not in page or f'href="trace.html#{steps(row)[-1]}"' not in page:
            yield f"{uid} does not say {status}, or does not lead back"
        logs = [unescape(log) for log in RAW_LOG.findall(page)]
        there = [(pages.output / log).resolve().exists() for log in logs]
        if status not in LEFT_NOTHING and not (there and all(there)):
            yield f"the raw log of {uid} is not there"


def complaints(row: Row, pages: Pages) -> list[str]:
    """What is wrong with the way of one row; nothing when it opens from end to end."""
    return [*wrong_steps(row, pages), *wrong_code(row, pages), *wrong_results(row, pages)]


def drawn(matrix: Sequence[Row], seed: str) -> list[Row]:
    """The rows that the seed chooses, or all when there are fewer."""
    return random.Random(seed).sample(list(matrix), k=min(ROWS, len(matrix)))
