"""What rung 1 checks: models.toml, and the wrong variants in spec/tla/wrong."""

import re
import tomllib
from collections.abc import Sequence, Set
from dataclasses import dataclass
from pathlib import Path

import tlc

MODELS = Path(__file__).with_name("models.toml")
WRONG = tlc.SPECIFICATION / "wrong"
MOST_LINES = 3
"""A wrong variant differs from the model by at most so many lines."""


class UnusableError(Exception):
    """The models cannot be checked as described; the text says what to correct."""


@dataclass(frozen=True)
class Model:
    """One model with one set of constants."""

    name: str
    module: str
    constants: tuple[str, ...]
    distinct_states: int
    actions: tuple[str, ...]
    properties: tuple[str, ...]
    invariants: tuple[str, ...] = ()
    specification: str = "Spec"
    view: str = ""
    about: str = "About"

    @property
    def named(self) -> list[str]:
        """Properties and invariants that carry an identifier of kernel.md or of the link."""
        return [name for name in (*self.invariants, *self.properties) if re.match(r"[A-Z]\d*_|[PLK]\d", name)]

    @property
    def told(self) -> set[str]:
        """What the model must say to have met: its actions, and what its properties are about."""
        return {*self.actions, *self.named}

    @property
    def supports(self) -> list[str]:
        """The identifiers of kernel.md that the model carries."""
        return [name.split("_")[0] for name in self.named if re.match(r"[PL]\d+_", name)]

    def configuration(self, only: Sequence[str] = ()) -> str:
        """The text of TLC's configuration, with all properties or with `only` some."""
        lines = [f"SPECIFICATION {self.specification}", "CHECK_DEADLOCK FALSE"]
        if self.constants:
            lines += ["CONSTANTS", *(f"  {constant}" for constant in self.constants)]
        if self.view:
            lines.append(f"VIEW {self.view}")
        for name in only or (*self.invariants, *self.properties, self.about):
            lines.append(f"{'INVARIANT' if name in self.invariants else 'PROPERTY'} {name}")
        return "\n".join(lines) + "\n"


@dataclass(frozen=True)
class Edit:
    """One place where a wrong variant differs from the model."""

    module: str
    old: str
    new: str

    @property
    def lines(self) -> int:
        return max(self.old.strip("\n").count("\n"), self.new.strip("\n").count("\n")) + 1


@dataclass(frozen=True)
class WrongVariant:
    """The model with one rule removed or wrong, and the property that must find it."""

    name: str
    property: str
    model: str
    why: str
    edits: tuple[Edit, ...]

    def plant(self, directory: Path) -> None:
        """Puts the wrong rule into the copy of the modules in `directory`."""
        for edit in self.edits:
            path = directory / f"{edit.module}.tla"
            path.write_text(path.read_text("utf-8").replace(edit.old, edit.new), "utf-8")


def read_models() -> list[Model]:
    """All models. Raises UnusableError when a field is missing or unknown."""
    models = []
    for entry in tomllib.loads(MODELS.read_text("utf-8"))["model"]:
        lists = {key: tuple(value) for key, value in entry.items() if isinstance(value, list)}
        try:
            model = Model(**{**entry, **lists})
        except TypeError as error:
            raise UnusableError(f"{MODELS.name}: model {entry.get('name', '?')}: {error}") from error
        models.append(model)
    return models


def read_wrong_variant(path: Path) -> WrongVariant:
    fields = tomllib.loads(path.read_text("utf-8"))
    edits = tuple(Edit(**edit) for edit in fields.pop("edit"))
    for edit in edits:
        module = tlc.SPECIFICATION / f"{edit.module}.tla"
        occurrences = module.read_text("utf-8").count(edit.old)
        if occurrences != 1:
            raise UnusableError(
                f"{path.name}: {edit.old!r} occurs {occurrences} times in {module.name}, expected once"
            )
    lines = sum(edit.lines for edit in edits)
    if lines > MOST_LINES:
        raise UnusableError(f"{path.name}: differs by {lines} lines, at most {MOST_LINES} are allowed")
    return WrongVariant(name=path.stem, edits=edits, **fields)


def read_wrong_variants(models: Set[str]) -> list[WrongVariant]:
    """All wrong variants. Raises UnusableError when one does not fit its module, or any of `models`."""
    variants = [read_wrong_variant(path) for path in sorted(WRONG.glob("*.toml"))]
    for variant in variants:
        if variant.model not in models:
            raise UnusableError(f"{variant.name}.toml: there is no model '{variant.model}' in {MODELS.name}")
    return variants
