"""Where two machines differ first, in the kernel's own names: which vector or tick, which word, what it was
given."""

import re
import sys
from collections.abc import Collection, Iterator, Sequence
from itertools import product
from pathlib import Path

from build import CORE, ROOT, Machine, image, run

sys.path += [str(ROOT / "kernel/recording"), str(ROOT / "verification/cbmc")]
from counterexample import code_names, in_words
from generate_recorded_fields import COMMENT, STRUCTURE

TYPES = ROOT / "kernel/include/interlock/types.h"
CATALOG = ROOT / "kernel/include/interlock/catalog.h"
FIELD = re.compile(r"(?P<type>\w+)\s+(?P<name>\w+)(?P<array>[^;]*);")
STRUCTURES = {
    "in": "ilk_inputs_t",
    "request": "ilk_request_t",
    "state": "ilk_state_t",
    "out": "ilk_outputs_t",
}
MOST_DIFFERING, MOST_GIVEN = 10, 60
Words = dict[str, int]
"""Each word of a tick by its name."""


def lengths() -> dict[str, int]:
    """The lengths that the headers give to arrays, by name; frames as the images have them."""
    text = TYPES.read_text("utf-8") + CATALOG.read_text("utf-8")
    return {
        name: int(value) for name, value in re.findall(r"(?:#define )?\b(ILK_\w+)(?: =)? (\d+)u?\b", text)
    }


def fields(structure: str, prefix: str) -> Iterator[tuple[str, bool]]:
    """All words of a structure of types.h in their order: the name, and whether it is signed."""
    text = COMMENT.sub("", TYPES.read_text("utf-8"))
    known = {found["name"]: found["body"] for found in STRUCTURE.finditer(text)}
    length = lengths()
    for field in FIELD.finditer(known[structure]):
        sides = [range(length[side]) for side in re.findall(r"\[(\w+)\]", field["array"])]
        for place in product(*sides):
            name = f"{prefix}.{field['name']}" + "".join(f"[{index}]" for index in place)
            if field["type"] in known:
                yield from fields(field["type"], name)
            else:
                yield name, field["type"] == "int32_t"


def named(structure: str, prefix: str, values: Sequence[int]) -> Words:
    """The words of one structure by their names. Raises ValueError when some are missing."""
    return {
        name: value - 2**32 if signed and value >= 2**31 else value
        for (name, signed), value in zip(fields(structure, prefix), values, strict=True)
    }


def words_of(output: str) -> Words:
    """The words that an image told of its tick, zeros included."""
    told: Words = {}
    for part, structure in STRUCTURES.items():
        values = [int(value, 16) for value in re.findall(rf"^word {part} \d+ ([0-9a-f]{{8}})$", output, re.M)]
        if part != "request":
            told |= named(structure, part, values)
            continue
        each = len(list(fields(structure, part)))
        for number, first in enumerate(range(0, len(values), each)):
            told |= named(structure, f"request[{number}]", values[first : first + each])
    return told


def is_of(name: str, slots: Collection[str]) -> bool:
    """Whether a word of the inputs may tell something of these slots: no other slot's frame does."""
    frame = re.match(r"in\.frame(\[\d+\])", name)
    return frame is None or frame[1] in slots


def compared(what: str, by_machine: dict[str, Words]) -> str:
    """Which words of a tick differ between two machines, and what is not zero of what the tick was given."""
    codes = code_names()
    (one, ours), (other, theirs) = by_machine.items()

    def said(name: str, value: int | None) -> str:
        return "absent" if value is None else in_words(name, str(value), codes).partition(" = ")[2]

    differing = [name for name in ours | theirs if ours.get(name) != theirs.get(name)]
    lines = [f"{what}: {len(differing)} words differ"]
    lines += [
        f"    {name} is {said(name, ours.get(name))} on {one}, {said(name, theirs.get(name))} on {other}"
        for name in differing[:MOST_DIFFERING]
    ]
    slots = {
        slot for name in differing for slot in re.findall(r"\.(?:axis|command|gate|frame)(\[\d+\])", name)
    }
    given = [
        name
        for name, value in ours.items()
        if value and name.startswith(("in.", "request[")) and is_of(name, slots)
    ]
    lines += ["  with", *(f"    {in_words(name, str(ours[name]), codes)}" for name in given[:MOST_GIVEN])]
    return "\n".join(lines)


def tick_of(machine: Machine, program: str, number: int, core: Sequence[Path]) -> Words:
    """All words of one vector, or of one tick of the trace, on a machine."""
    ticks = {"vectors": "VECTORS", "trace": "TRACE_TICKS"}[program]
    defines = [f"-D{ticks}={number + 1}", f"-DTOLD={number}"]
    return words_of(run(image(machine, program, f"{program}-told", defines, core)))


def vector(number: int, machines: Sequence[Machine], cores: Sequence[Sequence[Path]] = (CORE, CORE)) -> str:
    """How one vector differs between two machines, each with its build of the core."""
    told = {
        machine.name: tick_of(machine, "vectors", number, core)
        for machine, core in zip(machines, cores, strict=True)
    }
    return compared(f"vector {number}", told)


def trace(ticks: int, machines: Sequence[Machine], cores: Sequence[Sequence[Path]] = (CORE, CORE)) -> str:
    """How the first tick of the trace that differs does so between two machines."""
    pairs = list(zip(machines, cores, strict=True))
    defines = [f"-DTRACE_TICKS={ticks}", "-DEACH_TICK"]
    digests = [
        run(image(machine, "trace", "trace-each", defines, core)).splitlines() for machine, core in pairs
    ]
    first = next((n for n, pair in enumerate(zip(*digests, strict=False)) if len(set(pair)) > 1), None)
    if first is None or first >= ticks:
        return "the trace: each tick is the same now, so the machines do not repeat their own answers"
    told = {machine.name: tick_of(machine, "trace", first, core) for machine, core in pairs}
    return compared(f"the trace, tick {first}", told)
