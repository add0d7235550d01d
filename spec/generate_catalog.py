"""Writes the C enumerations from spec/catalog.toml."""

import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def c_header(catalog: dict) -> str:
    lines = [
        "/* Generated from spec/catalog.toml by `make generate`. Do not edit. */",
        "#ifndef INTERLOCK_CATALOG_H",
        "#define INTERLOCK_CATALOG_H",
        "",
    ]
    for name, family in catalog["family"].items():
        lines += [f"/** {family['about']} */", "typedef enum {"]
        width = max(len(code["name"]) for code in catalog[name])
        for code in catalog[name]:
            entry = f"{family['prefix']}_{code['name']} = {code['number']},"
            lines.append(f"  {entry:<{len(family['prefix']) + width + 6}} /**< {code['meaning']} */")
        lines += [f"}} {family['type']};", "", f"#define {family['prefix']}_COUNT {len(catalog[name])}u", ""]
    lines += ["#endif", ""]
    return "\n".join(lines)


if __name__ == "__main__":
    catalog = tomllib.loads((ROOT / "spec/catalog.toml").read_text())
    (ROOT / "kernel/include/interlock/catalog.h").write_text(c_header(catalog))
