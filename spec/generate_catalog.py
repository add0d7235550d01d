"""Writes from spec/catalog.toml what C, C++, TypeScript and the documentation know of its codes.

Run it by `make generate`. `--check` writes nothing: it names each fault of the catalog and each stale
file, and exits 1 when there is any.
"""

import argparse
import json
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

Catalog = dict[str, Any]

ROOT = Path(__file__).resolve().parent.parent
NOTICE = "Generated from spec/catalog.toml by `make generate`. Do not edit."
TEXTS = ("meaning", "cause", "next_step", "clears")


def problems(catalog: Catalog) -> list[str]:
    """Returns one sentence for each fault of the catalog, naming family, code and what was expected."""
    found = []
    families = catalog["family"]
    for name in sorted(set(catalog) - {"family"} - set(families)):
        found.append(f"{name}: has codes but no [family.{name}] table; add one")
    for name, family in families.items():
        codes = catalog.get(name, [])
        numbers = [code.get("number") for code in codes]
        first = numbers[0] if numbers else 0
        if numbers != list(range(first, first + len(numbers))):
            found.append(f"{name}: numbers are {numbers}; expected consecutive ones in order, each once")
        names = [code.get("name") for code in codes]
        for repeated in sorted({code for code in names if names.count(code) > 1}):
            found.append(f"{name}.{repeated}: name occurs more than once; expected it once in its family")
        required = (*TEXTS, "properties") if family.get("full_text") else ("meaning",)
        for code in codes:
            for key in required:
                if not code.get(key):
                    found.append(f"{name}.{code.get('name')}: lacks '{key}'; write it in spec/catalog.toml")
        if not codes:
            found.append(f"{name}: has no code; add [[{name}]] tables or remove [family.{name}]")
    return found


def c_header(catalog: Catalog) -> str:
    says = "Every mode, request, verdict, cause, fault and gate by its number."
    about = f"/**\n * @file\n * {says} {NOTICE}\n */"
    lines = [about, "#ifndef INTERLOCK_CATALOG_H", "#define INTERLOCK_CATALOG_H", ""]
    for name, family in catalog["family"].items():
        lines += [f"/** {family['about']} */", "typedef enum {"]
        width = max(len(code["name"]) for code in catalog[name])
        for code in catalog[name]:
            entry = f"{family['prefix']}_{code['name']} = {code['number']},"
            lines.append(f"  {entry:<{len(family['prefix']) + width + 6}} /**< {code['meaning']} */")
        count = f"#define {family['prefix']}_COUNT {len(catalog[name])}u"
        lines += [f"}} {family['type']};", "", f"/** Codes of {family['type']}. */", count, ""]
    return "\n".join([*lines, "#endif", ""])


C_CONFIG_ERRORS = """/* {notice} */
#include "config_error_text.h"

ilk_config_error_text_t ilk_config_error_text(uint32_t error) {{
  static const ilk_config_error_text_t texts[ILK_CONFIG_ERROR_COUNT] = {{
{rows}
  }};
  static const ilk_config_error_text_t unknown = {{"UNKNOWN", "The code is not in the catalog."}};
  return error < ILK_CONFIG_ERROR_COUNT ? texts[error] : unknown;
}}
"""


def c_config_errors(catalog: Catalog) -> str:
    rows = (
        f'    [ILK_CONFIG_ERROR_{code["name"]}] = {{"{code["name"]}", {json.dumps(code["meaning"])}}},'
        for code in catalog["config_error"]
    )
    return C_CONFIG_ERRORS.format(notice=NOTICE, rows="\n".join(rows))


CPP_HEADER = """/**
 * @file
 * {notice}
 *
 * The texts of every code that an operator, a client or a log meets, by family and number.
 * The numbers themselves are the enumerations of interlock/catalog.h.
 */
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace interlock::catalog {{

/** Families of codes, in the order of the catalog. */
enum class Family : std::uint8_t {{
{families}
}};

/** One code. Texts that a family does not carry are empty. */
struct Entry {{
  std::uint32_t number;
  std::string_view name;
  std::string_view meaning;
  std::string_view cause;
  std::string_view next_step;
  std::string_view clears;
  std::span<const std::string_view> properties; /**< identifiers such as "P3" */
}};

/** Every code of the family, by rising number. */
[[nodiscard]] std::span<const Entry> entries(Family family) noexcept;

/** The code of that number, or nullptr when the family has none. */
[[nodiscard]] const Entry* find(Family family, std::uint32_t number) noexcept;

/** The code of that name, or nullptr when the family has none. */
[[nodiscard]] const Entry* find(Family family, std::string_view name) noexcept;

/** The code of that number, or a safe entry named "UNKNOWN" that tells the operator what to do. */
[[nodiscard]] const Entry& entry(Family family, std::uint32_t number) noexcept;

/** The code's name, or "UNKNOWN_<number>". */
[[nodiscard]] std::string name(Family family, std::uint32_t number);

}}  // namespace interlock::catalog
"""

CPP_SOURCE = """// {notice}
#include "catalog.hpp"

#include <algorithm>
#include <array>

namespace interlock::catalog {{
namespace {{

using Names = std::span<const std::string_view>;

{tables}

constexpr Entry kUnknown{{{unknown}, Names{{}}}};

}}  // namespace

std::span<const Entry> entries(Family family) noexcept {{
  switch (family) {{
{cases}
  }}
  return {{}};
}}

const Entry* find(Family family, std::uint32_t number) noexcept {{
  const auto codes = entries(family);
  const auto found = std::ranges::find(codes, number, &Entry::number);
  return found == codes.end() ? nullptr : &*found;
}}

const Entry* find(Family family, std::string_view name) noexcept {{
  const auto codes = entries(family);
  const auto found = std::ranges::find(codes, name, &Entry::name);
  return found == codes.end() ? nullptr : &*found;
}}

const Entry& entry(Family family, std::uint32_t number) noexcept {{
  const Entry* found = find(family, number);
  return found == nullptr ? kUnknown : *found;
}}

std::string name(Family family, std::uint32_t number) {{
  const Entry* found = find(family, number);
  return found == nullptr ? "UNKNOWN_" + std::to_string(number) : std::string(found->name);
}}

}}  // namespace interlock::catalog
"""

UNKNOWN = {
    "name": "UNKNOWN",
    "meaning": "The catalog of this program does not have the code.",
    "cause": "App, kernel and console are of different versions.",
    "next_step": "Do not move the robot; install all parts from the same release.",
    "clears": "A code of the catalog.",
}


def quoted(code: Catalog) -> str:
    return ", ".join(json.dumps(code.get(key, ""), ensure_ascii=False) for key in ("name", *TEXTS))


def array_name(family: str) -> str:
    return "k" + "".join(word.capitalize() for word in family.split("_"))


def cpp_header(catalog: Catalog) -> str:
    families = "\n".join(f"  {name}, /**< {family['about']} */" for name, family in catalog["family"].items())
    return CPP_HEADER.format(notice=NOTICE, families=families)


def cpp_source(catalog: Catalog) -> str:
    tables: list[str] = []
    cases: list[str] = []
    for family in catalog["family"]:
        array = array_name(family)
        rows = []
        for code in catalog[family]:
            properties = "Names{}"
            if code.get("properties"):
                properties = f"{array}{code['number']}Properties"
                listed = ", ".join(f'"{name}"' for name in code["properties"])
                count = len(code["properties"])
                tables.append(f"constexpr std::array<std::string_view, {count}> {properties}{{{listed}}};")
            rows.append(f"    Entry{{{code['number']}, {quoted(code)}, {properties}}},")
        tables += [f"constexpr std::array<Entry, {len(rows)}> {array}{{", *rows, "};"]
        cases.append(f"    case Family::{family}:\n      return {array};")
    return CPP_SOURCE.format(
        notice=NOTICE,
        tables="\n".join(tables),
        cases="\n".join(cases),
        unknown=f"UINT32_MAX, {quoted(UNKNOWN)}",
    )


TYPESCRIPT = """// {notice}

/** One code. Texts that a family does not carry are empty. */
export interface CatalogEntry {{
  readonly number: number;
  readonly name: string;
  readonly meaning: string;
  readonly cause: string;
  readonly next_step: string;
  readonly clears: string;
  readonly properties: readonly string[];
}}

/** Every code that kernel, app and console share, by family and rising number. */
export const catalog = {{
{families}
}} as const satisfies Readonly<Record<string, readonly CatalogEntry[]>>;

export type Family = keyof typeof catalog;

/** The names of a family, e.g. `CodeName<"mode">`. */
export type CodeName<F extends Family> = (typeof catalog)[F][number]["name"];

/** The code of that number or name, or a safe entry named "UNKNOWN_<code>" that tells what to do. */
export function entry(family: Family, code: number | string): CatalogEntry {{
  const codes: readonly CatalogEntry[] = catalog[family];
  const found = codes.find((candidate) => candidate.number === code || candidate.name === code);
  return found ?? {{ ...unknown, name: `UNKNOWN_${{code}}` }};
}}

const unknown: CatalogEntry = {unknown};
"""


def typescript(catalog: Catalog) -> str:
    def literal(code: Catalog) -> str:
        fields = {"number": code["number"], "name": code["name"]}
        fields |= {key: code.get(key, "") for key in TEXTS} | {"properties": code.get("properties", [])}
        return json.dumps(fields, ensure_ascii=False)

    families = []
    for name, family in catalog["family"].items():
        rows = [f"    {literal(code)}," for code in catalog[name]]
        families += [f"  /** {family['about']} */", f"  {name}: [", *rows, "  ],"]
    return TYPESCRIPT.format(
        notice=NOTICE, families="\n".join(families), unknown=literal({"number": -1, **UNKNOWN})
    )


def document(catalog: Catalog) -> str:
    def row(cells: list[str]) -> str:
        return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"

    columns: dict[str, tuple[str, Callable[[Catalog], str]]] = {
        "number": ("Number", lambda code: str(code["number"])),
        "name": ("Name", lambda code: f"`{code['name']}`"),
        "meaning": ("Meaning", lambda code: code["meaning"]),
        "cause": ("Likely cause", lambda code: code["cause"]),
        "next_step": ("Next step", lambda code: code["next_step"]),
        "clears": ("Clears when", lambda code: code["clears"]),
        "fields": ("Fields", lambda code: ", ".join(f"`{field}`" for field in code["fields"])),
        "checks": ("Checks, in order", lambda code: ", ".join(f"`{check}`" for check in code["checks"])),
        "properties": ("Properties", lambda code: ", ".join(code["properties"])),
    }
    lines = [f"<!-- {NOTICE} -->", "# Codes", ""]
    lines += ["Look up here what a code means, what probably caused it and what to do next.", ""]
    for name, family in catalog["family"].items():
        used = [column for key, column in columns.items() if any(key in code for code in catalog[name])]
        lines += [f"## {name.replace('_', ' ').capitalize()}", "", family["about"], ""]
        lines += [row([title for title, _ in used]), row(["---"] * len(used))]
        lines += [row([cell(code) for _, cell in used]) for code in catalog[name]]
        lines.append("")
    return "\n".join(lines)


OUTPUTS: dict[str, Callable[[Catalog], str]] = {
    "kernel/include/interlock/catalog.h": c_header,
    "kernel/host/config_error_text.c": c_config_errors,
    "app/robot/catalog.hpp": cpp_header,
    "app/robot/catalog.cpp": cpp_source,
    "web/src/generated/catalog.ts": typescript,
    "docs/catalog.md": document,
}


def stale(catalog: Catalog, root: Path) -> list[str]:
    """Returns one sentence for each generated file under root that differs from the catalog."""
    return [
        f"{path}: does not match spec/catalog.toml; run `make generate` and commit it"
        for path, generate in OUTPUTS.items()
        if not (root / path).is_file() or (root / path).read_text("utf-8") != generate(catalog)
    ]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="write nothing; exit 1 on a fault")
    parser.add_argument("--root", type=Path, default=ROOT, help="source tree (default: this one)")
    arguments = parser.parse_args()
    root: Path = arguments.root
    try:
        catalog = tomllib.loads((root / "spec/catalog.toml").read_text("utf-8"))
    except (OSError, tomllib.TOMLDecodeError) as error:
        print(f"spec/catalog.toml: {error}", file=sys.stderr)
        return 1
    found = problems(catalog)
    if arguments.check and not found:
        found = stale(catalog, root)
    for problem in found:
        print(problem, file=sys.stderr)
    if found or arguments.check:
        return 1 if found else 0
    for path, generate in OUTPUTS.items():
        (root / path).parent.mkdir(parents=True, exist_ok=True)
        (root / path).write_text(generate(catalog), "utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
