"""Where design and verification stand: FILE:LINE of functions, properties, claims and tests."""

import re
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path

from gate import Trace
from results import Result

UNIT_SUITE = re.compile(r"^(?:TYPED_)?TEST(?:_P|_F)?\((\w+),", re.MULTILINE)
DEFINITION = re.compile(r"^(\w+)(?:\([^)]*\))? *==", re.MULTILINE)
HARNESS = re.compile(r"^void harness\(", re.MULTILINE)


def line_at(text: str, place: int) -> int:
    return text.count("\n", 0, place) + 1


class Places:
    """Looks places up in the sources of one project; each file is read once."""

    def __init__(self, of: Trace) -> None:
        self.root: Path = of.project.root
        self.functions = {f"{one.file}:{one.name}": one for one in of.project.functions}

    @cached_property
    def unit_suites(self) -> Mapping[str, str]:
        """The first test of each GoogleTest suite."""
        found: dict[str, str] = {}
        for path in sorted(self.root.glob("tests/unit/**/*.cpp")):
            text = path.read_text("utf-8")
            for match in UNIT_SUITE.finditer(text):
                place = f"{path.relative_to(self.root).as_posix()}:{line_at(text, match.start())}"
                found.setdefault(match[1], place)
        return found

    @cached_property
    def definitions(self) -> Mapping[tuple[str, str], str]:
        """Each definition of the model by module and name."""
        found: dict[tuple[str, str], str] = {}
        for path in sorted(self.root.glob("spec/tla/*.tla")):
            text = path.read_text("utf-8")
            for match in DEFINITION.finditer(text):
                place = f"{path.relative_to(self.root).as_posix()}:{line_at(text, match.start())}"
                found.setdefault((path.stem, match[1]), place)
        return found

    def definition(self, module: str, name: str) -> str:
        """Where a module, or one that it stands on, defines a name; empty where none does."""
        own = self.definitions.get((module, name))
        return own or next((at for (_, one), at in self.definitions.items() if one == name), "")

    def of_result(self, result: Result) -> str:
        """Where what a result comes from stands: function, property, harness or first test of its group."""
        kind, _, rest = result.uid.partition(":")
        if kind == "TLC":
            return self.definition(Path(result.place).stem, rest.rpartition(":")[2]) or result.place
        if kind in ("CBMC", "TICK"):
            path = self.root / result.place
            found = HARNESS.search(path.read_text("utf-8")) if path.is_file() else None
            return f"{result.place}:{line_at(found.string, found.start())}" if found else result.place
        return self.of_tests(rest) if kind == "TEST" else result.place

    def of_tests(self, group: str) -> str:
        """Where the tests of a group begin; SUITE:NAME as in the UID of their result."""
        suite, _, name = group.partition(":")
        if suite == "unit":
            last = re.split(r"[./]", name)
            return next((self.unit_suites[one] for one in reversed(last) if one in self.unit_suites), "")
        folder = {"console": "web/", "browser": "tests/browser/"}.get(suite)
        path = f"{name.replace('.', '/')}.py" if folder is None else folder + name
        return f"{path}:1" if (self.root / path).is_file() else ""

    def design_of(self, of: Trace, requirement: str) -> list[str]:
        """The described functions that fulfil a requirement, and the properties of the model."""
        functions = [
            f"{one.name} {one.file}:{one.line}"
            for one in of.project.functions
            if one.purpose and requirement in of.project.links.requirements_of(one)
        ]
        checked = [one for one in of.carried.get(requirement, ()) if one.uid.startswith("TLC:")]
        properties = {one.uid.rpartition(":")[2]: self.of_result(one) for one in checked}
        return [*functions, *(f"{name} {place}" for name, place in sorted(properties.items()))]
