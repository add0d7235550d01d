"""What the ladder must show: verification/expected.toml, and what decides whether a rung must run again."""

import hashlib
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from evidence import ROOT, STATUSES

EXPECTED = ROOT / "verification" / "expected.toml"
COMMON_INPUTS = ("verification/evidence/*.py", "verification/toolchain/*", "kernel/include/**/*")
KEYS = {"command", "inputs", "cores", "memory_gb", "status", "figures"}
MAY = {"after"}


class UnusableError(Exception):
    """The ladder cannot be run as asked; the text says what to correct."""


@dataclass(frozen=True)
class Rung:
    """One table of verification/expected.toml; the head of that file tells what each key means."""

    name: str
    command: str
    inputs: tuple[str, ...]
    cores: int
    memory_gb: float
    status: str
    figures: dict[str, float]
    after: tuple[str, ...] = ()
    """Rungs that this one waits for, as it reads what they leave. It runs without them, too, only longer."""


def read_expected(path: Path) -> list[Rung]:
    """The rungs of the file, in its order. Raises UnusableError naming the rung and key that is wrong."""
    rungs = []
    for name, table in tomllib.loads(path.read_text("utf-8")).get("rung", {}).items():
        if set(table) - MAY != KEYS:
            wrong = ", ".join(sorted((set(table) - MAY) ^ KEYS))
            raise UnusableError(f"{path.name}: [rung.{name}]: keys missing or unknown: {wrong}")
        if table["status"] not in STATUSES:
            known = ", ".join(STATUSES)
            raise UnusableError(
                f"{path.name}: [rung.{name}]: status '{table['status']}'; expected one of {known}"
            )
        later = sorted(set(table.get("after", ())) - {rung.name for rung in rungs})
        if later:
            raise UnusableError(
                f"{path.name}: [rung.{name}]: after '{later[0]}'; expected a rung that stands before it"
            )
        lists = {key: tuple(value) for key, value in table.items() if isinstance(value, list)}
        rungs.append(Rung(name, **{**table, **lists}))
    return rungs


def select(rungs: Sequence[Rung], names: Sequence[str]) -> list[Rung]:
    """The rungs of these names, all without names. Raises UnusableError for a name that there is not."""
    unknown = sorted(set(names) - {rung.name for rung in rungs})
    if unknown:
        known = ", ".join(rung.name for rung in rungs)
        raise UnusableError(f"no rung '{unknown[0]}'; expected one of {known}")
    return [rung for rung in rungs if not names or rung.name in names]


def content_key(rung: Rung) -> str:
    """A hash over all that decides the rung's result: its inputs by name and content, and its expectation.

    Raises UnusableError when a glob of its inputs matches no file.
    """
    digest = hashlib.sha256(repr(rung).encode())
    for pattern in (*COMMON_INPUTS, *rung.inputs):
        files = sorted(
            path for path in ROOT.glob(pattern) if path.is_file() and "__pycache__" not in path.parts
        )
        if not files:
            raise UnusableError(f"[rung.{rung.name}]: no file matches the input '{pattern}'")
        for file in files:
            digest.update(f"{file.relative_to(ROOT)}\0".encode() + hashlib.sha256(file.read_bytes()).digest())
    return digest.hexdigest()
