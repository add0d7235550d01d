"""Turns a phase and its table into case.h: what the proof and the native run share."""

import re

from catalog import ROOT
from diagram import NO_ROW, as_c, reduce
from table import Column, Phase, Table, TableError

REACHED_AT_MOST = 24
"""A column with more answers than this is a number: which of them occur is not asked one by one."""


def reader(name: str, columns: list[Column]) -> str:
    """C function that gives the codes of the columns of a case."""
    lines = [f"static void {name}(const case_t *c, const case_t *b, int32_t *codes) {{", "  (void)b;"]
    lines += [
        f"  codes[{index}] = {column.read}; /* {column.name} */" for index, column in enumerate(columns)
    ]
    return "\n".join([*lines, "}", ""])


def writer(columns: list[Column]) -> str:
    """C function that makes the plainest case with the given codes."""
    lines = ["static void write_inputs(case_t *c, const int32_t *codes) {"]
    for index, column in enumerate(columns):
        lines.append(f"  {{ const int32_t v = codes[{index}]; (void)v; {column.write} }}")
    return "\n".join([*lines, "}", ""])


def settings(phase: Phase) -> str:
    """C functions that set the model's constants, and tell whether a case stands for its world."""
    lines = [
        f"  c->{group}.{name} = {value};"
        for group, values in phase.constants.items()
        for name, value in values.items()
    ]
    lines += [f"  {statement}" for statement in phase.configure]
    conditions = [f"  if (!({condition})) {{ return 0; }}" for condition in phase.assume]
    return "\n".join(
        [
            "static void configure(case_t *c) {",
            *lines,
            "}",
            "static int may_be(const case_t *c) {",
            "  (void)c;",
            *conditions,
            "  return 1;",
            "}",
            f"static void call(case_t *c) {{ {phase.call} }}",
            "",
        ]
    )


def fields_of(structure: str) -> list[str]:
    """The fields of a structure of types.h."""
    text = (ROOT / "kernel" / "include" / "interlock" / "types.h").read_text("utf-8")
    body = re.search(r"typedef struct \{([^}]*)\} " + structure + ";", text)
    if body is None:
        raise TableError(f"types.h has no structure {structure}")
    return re.findall(r"^  u?int32_t (\w+);", body[1], re.MULTILINE)


def frame(phase: Phase) -> str:
    """C function that tells whether something has changed that the phase does not say it changes."""
    words = []
    for structure, member in re.findall(r"(ilk_state_t|ilk_axis_t) (\w+);", phase.subject):
        words += [f"{member}.{name}" for name in fields_of(structure)]
        if structure == "ilk_state_t":
            words += [
                f"{member}.axis[{slot}].{name}" for slot in range(10) for name in fields_of("ilk_axis_t")
            ]
    changes = [column.at for column in phase.outputs if column.at] + phase.changes
    kept = [
        word
        for word in words
        if not any(word == change or word.startswith((f"{change}.", f"{change}[")) for change in changes)
    ]
    lines = [f"  if (c->{word} != b->{word}) {{ return false; }}" for word in kept]
    return "\n".join(
        [
            "static bool keeps(const case_t *c, const case_t *b) {",
            "  (void)c; (void)b;",
            *lines,
            "  return true;",
            "}",
            "",
        ]
    )


def checks(table: Table) -> str:
    """C macros that name each column, relation and answer."""
    phase = table.phase
    columns = " ".join(f'CHECK({i}, table_{i}(in), "{c.name}")' for i, c in enumerate(phase.outputs))
    relations = " ".join(f'RELATION({text}, "{name}")' for name, text in phase.relations.items())
    reached = []
    for index, column in enumerate(phase.outputs):
        answers = sorted({outputs[index] for _, outputs in table.rows})
        if len(answers) <= REACHED_AT_MOST:
            reached += [
                f'REACH({index}, {value}, "{column.name} {column.kind.text(value)}")' for value in answers
            ]
    within = " ".join(
        f"WITHIN({index}, {domain[0]}, {domain[-1]})"
        for index, (input_, domain) in enumerate(zip(phase.inputs, table.domains, strict=True))
        if input_.kind.name == "within"
    )
    macros = {
        "CHECK_ALL": columns,
        "RELATION_ALL": relations,
        "REACH_ALL": " ".join(reached),
        "WITHIN_ALL": within,
    }
    return "".join(f"#define {name} {text}\n" for name, text in macros.items())


def tables(table: Table) -> str:
    """C functions of the inputs: one for each output column, and one that tells which inputs have a row."""
    sizes = [len(domain) for domain in table.domains]
    places = table.places()
    has_row = reduce(table.dense(places, [1] * len(places), 0), sizes)
    parts = [as_c("has_row_within", has_row, table.domains)]
    for index in range(len(table.phase.outputs)):
        leaves = table.dense(places, [outputs[index] for _, outputs in table.rows], NO_ROW)
        parts.append(as_c(f"table_{index}", reduce(leaves, sizes), table.domains))
    known = [
        "(" + " || ".join(f"in[{level}] == {value}" for value in domain) + ")"
        for level, domain in enumerate(table.domains)
    ]
    known_all = " &&\n         ".join(known)
    return "\n".join(
        [
            *parts,
            f"static int has_row(const int32_t *in) {{\n  return {known_all} && has_row_within(in);\n}}",
            "",
        ]
    )


def case_header(table: Table, model_hash: str) -> str:
    """The text of case.h for a phase."""
    phase = table.phase
    names = ", ".join(f'"{column.name}"' for column in [*phase.inputs, *phase.outputs])
    return "\n".join(
        [
            f"/* {phase.name}: {phase.title}. From the model {model_hash}, rows {table.digest()}. */",
            "#include <stdbool.h>",
            "#include <stdint.h>",
            '#include "interlock/kernel.h"',
            *[f'#include "{name}"' for name in phase.includes],
            f"enum {{ INPUTS = {len(phase.inputs)}, OUTPUTS = {len(phase.outputs)} }};",
            f"typedef struct {{ {phase.subject} }} case_t;",
            phase.prelude,
            settings(phase),
            reader("read_inputs", phase.inputs),
            writer(phase.inputs),
            reader("read_outputs", phase.outputs),
            frame(phase),
            tables(table),
            checks(table),
            "#ifndef __CPROVER__",
            f"static const char *const column_name[INPUTS + OUTPUTS] = {{{names}}};",
            "#endif",
            "",
        ]
    )
