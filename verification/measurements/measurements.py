"""The measurements beside the ladder, and what decides whether one was made from what stands here now."""

import sys
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "evidence"))

from ladder import Rung, UnusableError, content_key

KEYS = {"title", "target", "demanded", "inputs"}
SCOPES = ("commit", "release")


@dataclass(frozen=True)
class Measurement:
    """One table of measurements.toml; the head of that file tells what each key means."""

    name: str
    title: str
    target: str
    demanded: str
    inputs: tuple[str, ...]
    least: Mapping[str, float] = field(default_factory=dict)

    def key(self) -> str:
        """A hash over all that decides the result, by the same rule as that of a rung.

        Raises UnusableError when a glob of the inputs matches no file.
        """
        return content_key(Rung(self.name, self.target, self.inputs, 0, 0, "PASSED", dict(self.least)))

    def too_short(self, figures: Mapping[str, float]) -> str:
        """In which figure a run came to less than it must, in words; empty when in none."""
        short = [
            f"{name} {figures.get(name, 'missing')}, at least {least}"
            for name, least in self.least.items()
            if not figures.get(name, 0) >= least
        ]
        return "; ".join(short)


def read_measurements(path: Path) -> list[Measurement]:
    """The measurements of a file. Raises UnusableError naming the table and key that is wrong."""
    found = []
    for name, table in tomllib.loads(path.read_text("utf-8")).items():
        if not KEYS <= set(table) <= KEYS | {"least"}:
            wrong = ", ".join(sorted(KEYS ^ (set(table) - {"least"})))
            raise UnusableError(f"{path.name}: [{name}]: keys missing or unknown: {wrong}")
        if table["demanded"] not in SCOPES:
            raise UnusableError(
                f"{path.name}: [{name}]: demanded '{table['demanded']}'; expected one of {', '.join(SCOPES)}"
            )
        found.append(Measurement(name, **{**table, "inputs": tuple(table["inputs"])}))
    return found
