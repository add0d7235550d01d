"""Tells a counterexample in the words of the kernel: the property, and what the harness chose."""

import re

from proofs import Proof
from prover import ROOT, Property

CATALOG = ROOT / "kernel" / "include" / "interlock" / "catalog.h"
CODES = {
    "mode": "MODE",
    "cause": "CAUSE",
    "pedal": "PEDAL",
    "state": "AXIS",
    "fault": "FAULT",
    "homing_phase": "HOMING",
    "kind": "REQUEST",
    "verdict": "VERDICT",
    "gate": "GATE",
    "card": "CARD",
    "limit_side": "LIMIT",
    "direction": "DIRECTION",
    "driven_direction": "DIRECTION",
    "stall_direction": "DIRECTION",
    "reverse_direction": "DIRECTION",
}
"""Fields that hold a code, with the prefix of its names in the catalog."""


TEMPORARIES = ("return_value_", "tmp_", "__")


def code_names() -> dict[tuple[str, int], str]:
    """The catalog's names by prefix and value."""
    found = re.findall(r"^  ILK_([A-Z]+)_(\w+) = (\d+),", CATALOG.read_text("utf-8"), re.MULTILINE)
    return {(prefix, int(value)): name for prefix, name, value in found}


def flatten(name: str, value: dict) -> dict[str, str]:
    """A value of a trace as its leaves by their full names."""
    leaves = {}
    for member in value.get("members", []):
        leaves |= flatten(f"{name}.{member['name']}", member["value"])
    for element in value.get("elements", []):
        leaves |= flatten(f"{name}[{element['index']}]", element["value"])
    if "data" in value:
        leaves[name] = str(value["data"]).rstrip("ul")
    return leaves


def chosen(steps: list[dict]) -> dict[str, str]:
    """The variables of the harness, as they were at the failure. Temporaries and pointers say nothing."""
    values: dict[str, str] = {}
    for step in steps:
        of_harness = step.get("sourceLocation", {}).get("function") == "harness"
        if of_harness and step.get("assignmentType") == "variable":
            values |= flatten(step["lhs"], step["value"])
    return {
        name: value
        for name, value in values.items()
        if not name.startswith(TEMPORARIES) and not value.startswith("&") and "!" not in value
    }


def in_words(name: str, value: str, names: dict[tuple[str, int], str]) -> str:
    """`name = value`, with the catalog's name when the field holds a code."""
    prefix = CODES.get(re.split(r"[.\[]", name.rstrip("]"))[-1])
    code = names.get((prefix, int(value))) if prefix and value.isdigit() else None
    return f"{name} = {value} ({code})" if code else f"{name} = {value}"


def telling(values: dict[str, str]) -> dict[str, str]:
    """Without what is zero, or as in the structure before: of a state afterwards, what has changed."""
    last: dict[str, str] = {}
    told = {}
    for name, value in values.items():
        plain = {"FALSE": "0", "TRUE": "1"}.get(value, value)
        field = name.partition(".")[2] or name
        if plain != last.get(field, "0"):
            told[name] = plain
        last[field] = plain
    return told


def describe(proof: Proof, failed: Property, steps: list[dict]) -> str:
    """Which property failed, where, and with which values in the harness."""
    names = code_names()
    heading = f"    {proof.name}: {failed.description}\n    {failed.name} at {failed.place}, with"
    told = [in_words(name, value, names) for name, value in telling(chosen(steps)).items()]
    return "\n".join([heading, *(f"      {line}" for line in told)])
