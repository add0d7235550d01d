"""That the tables together are the kernel's tick: no operator of the model is left without one.

The model's tick is `Tick` of Kernel.tla. Every operator that it is made of must be evaluated by the module of
a table, on all its states and inputs, or stand in whole.toml with the reason why it has no table and with
what shows it instead.
"""

import json
import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Set
from pathlib import Path

from catalog import families
from table import Phase, load_phase
from tools import HERE, ROOT, TLA

WHOLE = HERE / "whole.toml"
TICK = "Tick"
MODULES = ("Types", "System", "Axis", "Kernel")
COMMENT = re.compile(r"\(\*.*?\*\)|\\\*[^\n]*", re.DOTALL)
HEAD = r"^\w+\s*(?:\([^=]*?\))?\s*=="
DEFINITION = re.compile(rf"(?P<head>{HEAD})(?P<body>.*?)(?={HEAD}|^RECURSIVE|\Z)", re.DOTALL | re.MULTILINE)
STRING = re.compile(r'"[^"]*"')
NAME = re.compile(r"(?<![!.])\b[A-Za-z]\w*\b")


def text_of(path: Path) -> str:
    """A module without its comments and strings."""
    return STRING.sub('""', COMMENT.sub("", path.read_text("utf-8")))


def definitions(model: Path = TLA) -> dict[str, set[str]]:
    """For each operator of the model the others that its definition names."""
    found = [each for module in MODULES for each in DEFINITION.finditer(text_of(model / f"{module}.tla"))]
    bodies = {NAME.match(each["head"])[0]: each["body"] for each in found}
    return {name: {used for used in NAME.findall(body) if used in bodies} for name, body in bodies.items()}


def reached(first: Iterable[str], uses: Mapping[str, Set[str]]) -> set[str]:
    """These operators and all that they are made of."""
    seen: set[str] = set()
    waiting = list(first)
    while waiting:
        name = waiting.pop()
        if name not in seen:
            seen.add(name)
            waiting += uses[name]
    return seen


def evaluated_by_tables(uses: Mapping[str, Set[str]]) -> set[str]:
    """The operators that the modules of the tables evaluate."""
    modules = [HERE / "rows" / f"{phase.rows}.tla" for phase in all_phases()]
    named = {name for module in modules for name in NAME.findall(text_of(module)) if name in uses}
    return reached(named, uses)


def all_phases() -> list[Phase]:
    return [load_phase(path) for path in sorted((HERE / "phases").glob("*.toml"))]


def unknown_evidence(shown_by: str) -> str:
    """What is wrong with a name of what shows an operator; empty when there is such evidence.

    `cbmc NAME` is a proof of verification/cbmc, `wp FUNCTION` a function whose contract is proved,
    `table NAME` a phase, `traces` the runs that the model accepts.
    """
    rung, _, part = shown_by.partition(" ")
    contracts = json.loads((ROOT / "verification/frama-c/expected.json").read_text("utf-8"))
    known = {
        "cbmc": (ROOT / "verification/cbmc" / part / "proof.toml").is_file(),
        "wp": any(part in functions for functions in contracts.values()),
        "table": (HERE / "phases" / f"{part}.toml").is_file(),
        "traces": part == "",
    }
    return "" if known.get(rung) else f"'{shown_by}' is no proof, contract or table"


def operators_without_table() -> Iterator[str]:
    """What is wrong with whole.toml or with the tables, a sentence each."""
    uses = definitions()
    missing = reached([TICK], uses) - evaluated_by_tables(uses)
    told = {entry["name"]: entry for entry in tomllib.loads(WHOLE.read_text("utf-8"))["operator"]}
    for name in sorted(missing - told.keys()):
        yield f"no table evaluates {name} of the model, and whole.toml does not say what shows it"
    for name in sorted(told.keys() - missing):
        yield f"whole.toml: {name} is evaluated by a table, or is no part of the tick; take it out"
    for name, entry in told.items():
        if not entry.get("reason") or not entry.get("shown_by"):
            yield f"whole.toml: {name} wants a reason and what shows it"
        for shown_by in entry.get("shown_by", ()):
            fault = unknown_evidence(shown_by)
            if fault:
                yield f"whole.toml: {name}: {fault}"


def requests_without_table() -> Iterator[str]:
    """Kinds of requests that no table judges or applies."""
    for part in ("judge", "apply"):
        told = {kind for phase in all_phases() if phase.name.startswith(f"{part}_") for kind in phase.kinds}
        for kind in families()["request"]:
            if kind not in told:
                yield f"no table of part {part} covers the request {kind}"


def uncovered() -> list[str]:
    """What of the tick neither a table nor whole.toml accounts for, a sentence each."""
    return [*operators_without_table(), *requests_without_table()]
