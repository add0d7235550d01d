"""A phase of the tick, how its words are named in model and kernel, and the rows that TLC printed."""

import hashlib
import struct
import tomllib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from math import prod
from pathlib import Path

from catalog import Kind, families


class TableError(Exception):
    """A table that does not say what it must; the text tells which, where and what was expected."""


@dataclass(frozen=True)
class Column:
    """One word: its name in the model, its kind, and C expressions that read and write it in a case."""

    name: str
    kind: Kind
    at: str
    read: str
    write: str


@dataclass(frozen=True)
class Phase:
    """A phase file, phases/NAME.toml; phases/README.md tells what its keys mean."""

    name: str
    title: str
    rows: str
    includes: list[str]
    subject: str
    call: str
    inputs: list[Column]
    outputs: list[Column]
    constants: dict[str, dict[str, int]] = field(default_factory=dict)
    prelude: str = ""
    configure: list[str] = field(default_factory=list)
    assume: list[str] = field(default_factory=list)
    changes: list[str] = field(default_factory=list)
    relations: dict[str, str] = field(default_factory=dict)

    stands_in: list[str] = field(default_factory=list)
    kinds: list[str] = field(default_factory=list)
    solver: str = ""
    parameters: dict[str, int] = field(default_factory=dict)

    def model_constants(self) -> dict[str, int]:
        """The constants as the model names them."""
        constants = {name: value for group in self.constants.values() for name, value in group.items()}
        return constants | self.parameters


def column(entry: list[str] | dict[str, str], names: dict[str, dict[str, int]]) -> Column:
    """A column of a phase file: `[name, kind, word of the case]`, or C expressions."""
    if isinstance(entry, list):
        name, spelling, at = entry
        kind = Kind(spelling, names)
        return Column(name, kind, at, kind.read(f"c->{at}"), kind.write(f"c->{at}", "v"))
    kind = Kind(entry["kind"], names)
    return Column(entry["name"], kind, "", kind.read(entry["read"]), entry.get("write", ""))


def load_phase(path: Path) -> Phase:
    """Reads a phase file."""
    entries = tomllib.loads(path.read_text("utf-8"))
    names = families()
    for side in ("inputs", "outputs"):
        entries[side] = [column(entry, names) for entry in entries[side]]
    return Phase(name=path.stem, **entries)


@dataclass
class Table:
    """The rows of a phase: inputs' codes to outputs' codes, sorted."""

    phase: Phase
    rows: list[tuple[tuple[int, ...], tuple[int, ...]]]
    domains: list[list[int]]

    def places(self) -> list[int]:
        """Where each row stands in the dense table, in lexicographic order of the inputs' domains."""
        sizes = [len(domain) for domain in self.domains]
        if len(self.rows) == prod(sizes):
            return list(range(len(self.rows)))
        strides = [prod(sizes[level + 1 :]) for level in range(len(sizes))]
        steps = [
            {value: i * stride for i, value in enumerate(domain)}
            for domain, stride in zip(self.domains, strides, strict=True)
        ]
        return [sum(map(dict.__getitem__, steps, inputs)) for inputs, _ in self.rows]

    def dense(self, places: list[int], leaves: Iterable[int], absent: int) -> list[int]:
        """`leaves`, one for each row, over all combinations of the inputs; `absent` where there is no row."""
        table = [absent] * prod(len(domain) for domain in self.domains)
        for place, leaf in zip(places, leaves, strict=True):
            table[place] = leaf
        return table

    def states(self) -> int:
        """How many states of the kernel the inputs are of: what comes from outside is left out."""
        outside = ("in.", "reading.", "request.", "alarms.")
        own = [
            i
            for i, column_ in enumerate(self.phase.inputs)
            if column_.at and not column_.at.startswith(outside)
        ]
        return len({tuple([inputs[i] for i in own]) for inputs, _ in self.rows})

    def packed(self) -> bytes:
        """The rows as 32-bit little-endian words, for the native run and for the hash."""
        width = len(self.phase.inputs) + len(self.phase.outputs)
        pack = struct.Struct(f"<{width}i").pack
        return b"".join(pack(*inputs, *outputs) for inputs, outputs in self.rows)

    def digest(self) -> str:
        """SHA-256 over the packed rows."""
        return hashlib.sha256(self.packed()).hexdigest()


def unpacked(phase: Phase, data: bytes) -> Table:
    """The table of packed rows."""
    width = len(phase.inputs)
    words = struct.iter_unpack(f"<{width + len(phase.outputs)}i", data)
    rows = [(row[:width], row[width:]) for row in words]
    return Table(
        phase, rows, [sorted(set(column_)) for column_ in zip(*(row[0] for row in rows), strict=True)]
    )


class Codes(dict[str, int]):
    """The codes of the tokens that a column has shown so far."""

    def __init__(self, kind: Kind) -> None:
        super().__init__()
        self.kind = kind

    def __missing__(self, token: str) -> int:
        """The code of a token that is new."""
        self[token] = self.kind.code(token.strip())
        return self[token]


def tuples(text: str) -> Iterator[list[str]]:
    """The tuples that TLC printed, whose long ones it breaks over lines."""
    for line in text.replace(",\n", ",").replace(",  ", ",").split("\n"):
        if line.startswith("<<"):
            yield line.strip("<> ").split(",")


def read_rows(phase: Phase, text: str) -> Table:
    """The table that TLC printed. Raises TableError for a row of another width, or for two answers."""
    columns = [*phase.inputs, *phase.outputs]
    codes_of = [Codes(column_.kind) for column_ in columns]
    rows: dict[tuple[int, ...], tuple[int, ...]] = {}
    for tokens in tuples(text):
        if len(tokens) != len(columns):
            raise TableError(
                f"{phase.name}: a row of {len(tokens)} columns, expected {len(columns)}: {tokens}"
            )
        codes = tuple(map(Codes.__getitem__, codes_of, tokens))
        inputs, outputs = codes[: len(phase.inputs)], codes[len(phase.inputs) :]
        if rows.setdefault(inputs, outputs) != outputs:
            raise TableError(f"{phase.name}: two answers for {inputs}: {rows[inputs]} and {outputs}")
    if not rows:
        raise TableError(f"{phase.name}: TLC printed no row")
    return Table(
        phase, sorted(rows.items()), [sorted(set(codes.values())) for codes in codes_of[: len(phase.inputs)]]
    )
