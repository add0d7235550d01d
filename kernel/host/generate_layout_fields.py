"""Writes the list of every field of every structure that crosses the link, from the headers that define them.

usage: generate_layout_fields.py OUTPUT HEADER...

The structures are flat lists of words, arrays and other structures, so a pattern reads them; a unit test
checks that the fields found tile each structure without a gap.
"""

import re
import sys
from pathlib import Path

COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
STRUCTURE = re.compile(r"typedef struct \{(?P<body>[^}]*)\} (?P<name>\w+);")
FIELD = re.compile(r"(?P<type>\w+)\s+(?P<name>\w+)\s*(?:\[[^;]*\])?;")
SHARED = ("ilk_link_hello_t", "ilk_link_kernel_region_t", "ilk_link_app_region_t")


def structures(headers: list[Path]) -> dict[str, list[tuple[str, str]]]:
    """Returns the fields of each structure as pairs of type and name."""
    found = {}
    for header in headers:
        for structure in STRUCTURE.finditer(COMMENT.sub("", header.read_text("utf-8"))):
            fields = FIELD.finditer(structure["body"])
            found[structure["name"]] = [(field["type"], field["name"]) for field in fields]
    return found


def reachable(known: dict[str, list[tuple[str, str]]], root: str) -> list[str]:
    """Returns root and the structures inside it, each before the one that holds it."""
    inner = [name for kind, _ in known[root] if kind in known for name in reachable(known, kind)]
    return list(dict.fromkeys([*inner, root]))


def main() -> None:
    output, *headers = map(Path, sys.argv[1:])
    known = structures(headers)
    shared = dict.fromkeys(name for root in SHARED for name in reachable(known, root))
    rows = [f"FIELD({name}, {field})" for name in shared for _, field in known[name]]
    output.write_text(" \\\n  ".join(["#define ILK_LAYOUT_FIELDS(FIELD)", *rows]) + "\n", "utf-8")


if __name__ == "__main__":
    main()
