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

from table import load_phase
from tools import HERE, ROOT, TLA

WHOLE = HERE / "whole.toml"
TICK = "Tick"
MODULES = ("Types", "System", "Axis", "Kernel")
COMMENT = re.compile(r"\(\*.*?\*\)|\\\*[^\n]*", re.DOTALL)
DEFINITION = re.compile(r"^(?P<name>\w+)\s*(?:\([^)=]*(?:\([^)]*\)[^)=]*)*\))?\s*==(?P<body>.*?)(?=^\w[\w(), ]*==|\Z)", re.DOTALL | re.MULTILINE)
STRING = re.compile(r'"[^"]*"')
NAME = re.compile(r"(?<![!.])\b[A-Za-z]\w*\b")


def text_of(path: Path) -> str:
    """A module without its comments and strings."""
    return STRING.sub('""', COMMENT.sub("", path.read_text("utf-8")))


def definitions(model: Path = TLA) -> dict[str, set[str]]:
    """For each operator of the model the others that its definition names."""
    bodies = {
        found["name"]: found["body"] for module in MODULES for found in DEFINITION.finditer(text_of(model / f"{module}.tla"))
    }
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
