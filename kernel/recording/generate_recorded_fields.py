"""Writes the tables that name each recorded word, from the headers that define the structures.

usage: generate_recorded_fields.py OUTPUT HEADER...

The structures are flat lists of words, arrays and other structures, so a pattern reads them; a unit test
checks that the fields found tile each structure without a gap.
"""

import re
import sys
from pathlib import Path

COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
STRUCTURE = re.compile(r"typedef struct \{(?P<body>[^}]*)\} (?P<name>\w+);")
FIELD = re.compile(r"(?P<type>\w+)\s+(?P<name>\w+)\s*(?P<array>\[[^;]*\])?;")
ROOTS = ("ilk_config_t", "ilk_picture_t", "ilk_request_t")
Fields = list[tuple[str, str, bool]]


def structures(headers: list[Path]) -> dict[str, Fields]:
    """Returns type, name, and whether it is an array, of the fields of each structure."""
    found = {}
    for header in headers:
        for structure in STRUCTURE.finditer(COMMENT.sub("", header.read_text("utf-8"))):
            fields = FIELD.finditer(structure["body"])
            found[structure["name"]] = [(f["type"], f["name"], f["array"] is not None) for f in fields]
    return found


def reachable(known: dict[str, Fields], root: str) -> list[str]:
    """Returns root and the structures inside it, each before the one that holds it."""
    inner = [name for kind, _, _ in known[root] if kind in known for name in reachable(known, kind)]
    return list(dict.fromkeys([*inner, root]))


def row(known: dict[str, Fields], structure: str, kind: str, name: str, array: bool) -> str:
    field = f"(({structure} *)0)->{name}"
    element_bytes = f"(uint32_t)sizeof({field}[0])" if array else "0u"
    inner = f"&table_of_{kind}" if kind in known else "NULL"
    integer = "true" if kind == "int32_t" else "false"
    place = f"(uint32_t)offsetof({structure}, {name}), (uint32_t)sizeof({field})"
    return f'  {{"{name}", {place}, {element_bytes}, {integer}, {inner}}},'


def table(known: dict[str, Fields], name: str) -> str:
    rows = [row(known, name, *field) for field in known[name]]
    return "\n".join(
        [
            f"static const ilk_field_t fields_of_{name}[] = {{",
            *rows,
            "};",
            f"static const ilk_field_table_t table_of_{name} = {{",
            f"    fields_of_{name}, (uint32_t)(sizeof fields_of_{name} / sizeof fields_of_{name}[0]),",
            f"    (uint32_t)sizeof({name})}};",
        ]
    )


def main() -> None:
    output, *headers = map(Path, sys.argv[1:])
    known = structures(headers)
    recorded = dict.fromkeys(name for root in ROOTS for name in reachable(known, root))
    output.write_text("\n".join(table(known, name) for name in recorded) + "\n", "utf-8")


if __name__ == "__main__":
    main()
