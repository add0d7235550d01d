"""What became of mutants, kept by content until something that it rests on changes."""

import hashlib
import json
import threading
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path

from functions import without_comments
from tree import ROOT

FILE = ROOT / "build/mutation/verdicts.json"
RUNGS = ("tests", "cbmc", "tick")
"""In the order of the tables."""
READ_BY = {
    "tests": ("tests/unit/kernel",),
    "cbmc": ("verification/cbmc",),
    "tick": ("verification/tick", "kernel/monitors"),
    "all": ("verification/mutation",),
}
"""What a rung reads besides the kernel; what shows that a mutant is no fault, where none complained."""


@dataclass(frozen=True)
class Verdict:
    """What became of a mutant: `killed`, `equivalent` or `survived`, by which probes or why."""

    fate: str
    reasons: tuple[str, ...]
    seconds: float
    told_by: dict[str, str] = field(default_factory=dict)
    """For each rung that was asked what it said, empty when it noticed nothing."""


def digest_of_files(folders: tuple[str, ...]) -> str:
    digest = hashlib.sha256()
    for folder in folders:
        for path in sorted((ROOT / folder).rglob("*")):
            if path.is_file() and "__pycache__" not in path.parts:
                digest.update(str(path.relative_to(ROOT)).encode() + path.read_bytes())
    return digest.hexdigest()


def kernel_digest(tree: Path) -> str:
    """Of the kernel's code, comments and blanks apart."""
    code = hashlib.sha256()
    for folder in ("src", "include/interlock"):
        for path in sorted((tree / "kernel" / folder).glob("*.[ch]")):
            text = path.read_text("utf-8")
            code.update(path.name.encode() + "".join(without_comments(text).split()).encode())
    return code.hexdigest()


class Kept:
    """The verdicts of earlier runs before the same rungs."""

    def __init__(self, asked: Sequence[str], every: bool) -> None:
        self._verdicts: dict[str, dict] = json.loads(FILE.read_text("utf-8")) if FILE.is_file() else {}
        self._rungs = {rung: digest_of_files(folders) for rung, folders in READ_BY.items()}
        self._asked = tuple(asked)
        self._every = every
        self._lock = threading.Lock()

    def key(self, tree: Path, rung: str) -> str:
        """Of the mutant in the tree, as far as a rung can see it; `all` sees everything."""
        read = [self._rungs[each] for each in ((*self._asked, "all") if rung == "all" else [rung])]
        parts = [rung, *self._asked, str(self._every), kernel_digest(tree), *read]
        return hashlib.sha256("".join(parts).encode()).hexdigest()

    def find(self, tree: Path) -> Verdict | None:
        """The verdict on the mutant in the tree, if nothing changed that it rests on."""
        for rung in (*self._asked, "all"):
            if found := self._verdicts.get(self.key(tree, rung)):
                return Verdict(**{**found, "reasons": tuple(found["reasons"])})
        return None

    def keep(self, tree: Path, verdict: Verdict) -> None:
        """A kill rests on the rung that killed, an equivalence on all of them.

        That a mutant survived rests on the time that provers had, too, so it is judged again.
        """
        if verdict.fate == "survived":
            return
        rung = verdict.reasons[0].split()[0] if verdict.fate == "killed" and not self._every else "all"
        with self._lock:
            self._verdicts[self.key(tree, rung)] = asdict(verdict)
            FILE.parent.mkdir(parents=True, exist_ok=True)
            FILE.write_text(json.dumps(self._verdicts), "utf-8")
