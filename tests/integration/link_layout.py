"""ctypes structures of everything the processes share, made from the C headers themselves.

Every field there is a 32-bit word, an array of words, or another structure of the same kind; anything else in
the headers is an error here, so that a test can never read a layout that the kernel does not have.
"""

import ctypes
import re
from pathlib import Path

INCLUDE = Path(__file__).resolve().parents[2] / "kernel/include/interlock"

FIELD = re.compile(r"^\s*(?P<type>\w+)\s+(?P<name>\w+)(?P<dimensions>(\[\w+\])*);")


def _without_comments(text: str) -> str:
    return re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)


def _constants(text: str) -> dict[str, int]:
    """`#define NAME number`, enumerators with a number, and the generated `_COUNT`s."""
    found = {
        name: int(value, 0) for name, value in re.findall(r"#define (\w+) (0x[0-9a-fA-F]+|\d+)u?\b", text)
    }
    found |= {name: int(value) for name, value in re.findall(r"\b(ILK_\w+) = (\d+)", text)}
    return found


def _structures(text: str, constants: dict[str, int]) -> dict[str, type]:
    types: dict[str, type] = {"uint32_t": ctypes.c_uint32, "int32_t": ctypes.c_int32}
    for body, name in re.findall(r"typedef struct \{(.*?)\} (\w+);", text, flags=re.DOTALL):
        fields = []
        for line in body.strip().splitlines():
            if not line.strip():
                continue
            match = FIELD.match(line)
            if match is None:
                raise ValueError(f"{name}: cannot read field {line.strip()!r}")
            kind = types[match["type"]]
            for dimension in reversed(re.findall(r"\[(\w+)\]", match["dimensions"])):
                kind = kind * (constants[dimension] if dimension in constants else int(dimension))
            fields.append((match["name"], kind))
        types[name] = type(name, (ctypes.Structure,), {"_fields_": fields})
    return types


def _read() -> tuple[dict[str, int], dict[str, type]]:
    names = ("catalog.h", "types.h", "sim_bus.h", "link.h")
    text = _without_comments("\n".join((INCLUDE / name).read_text() for name in names))
    constants = _constants(text)
    return constants, _structures(text, constants)


CONSTANTS, STRUCTURES = _read()


def name_of(prefix: str, number: int) -> str:
    """Name of a code, without its prefix: `name_of("ILK_MODE", 2)` is "READY"."""
    for name, value in CONSTANTS.items():
        if name.startswith(f"{prefix}_") and value == number and not name.endswith("_COUNT"):
            return name[len(prefix) + 1 :]
    raise ValueError(f"{prefix} has no code {number}")
