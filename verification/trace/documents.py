"""Documents that are written from sources and evidence, as StrictDoc reads them: units and results."""

from collections.abc import Iterable, Sequence

from gate import Trace
from results import Result
from sources import Function

HEAD = """\
[DOCUMENT]
TITLE: {title}
UID: {uid}
OPTIONS:
  MARKUP: Text

[GRAMMAR]
IMPORT_FROM_FILE: grammar.sgra
"""


def node(kind: str, fields: Sequence[tuple[str, str]], relations: Iterable[str]) -> str:
    """One node. An empty field is left out; one of several lines is fenced."""
    lines = [f"\n[{kind}]"]
    for name, text in fields:
        if "\n" in text:
            lines.append(f"{name}: >>>\n{text}\n<<<")
        elif text:
            lines.append(f"{name}: {text}")
    related = [line for relation in relations for line in relation.splitlines()]
    return "\n".join([*lines, *(["RELATIONS:", *related] if related else [])]) + "\n"


def parent(uid: str, role: str) -> str:
    return f"- TYPE: Parent\n  VALUE: {uid}\n  ROLE: {role}"


def source_file(path: str, function: str = "") -> str:
    """A relation to a file, or to a function in it."""
    inside = f"\n  ELEMENT: function\n  ID: {function}" if function else ""
    return f"- TYPE: File\n  PATH: {path}{inside}"


NAMED = "What its name says."
"""Of a function without a comment; StrictDoc takes no empty statement."""


def units(of: Trace) -> str:
    """The detailed design: each function of the core with its purpose and its requirements."""

    def unit(function: Function) -> str:
        requirements = of.project.links.requirements_of(function)
        fields = [
            ("UID", f"UNIT-{function.file.rpartition('/')[2]}-{function.name}"),
            ("TITLE", function.name),
        ]
        relations = [
            *(parent(uid, "Fulfils") for uid in requirements),
            source_file(function.file, function.name),
        ]
        return node("UNIT", [*fields, ("STATEMENT", function.purpose or NAMED)], relations)

    head = HEAD.format(title="Detailed design: units of the kernel core", uid="DOC-UNITS")
    return head + "".join(unit(function) for function in of.project.functions)


def results(of: Trace) -> str:
    """Every result with what it supports, its bounds and its log."""

    def one(result: Result) -> str:
        supported = sorted(uid for uid, carried in of.carried.items() if result in carried)
        fields = [
            ("UID", result.uid),
            ("TITLE", result.title),
            ("METHOD", result.method),
            ("STATUS", result.status),
            ("TOOL", result.tool),
            ("COMMIT", result.commit or "unknown"),
            ("DATE", result.date or "unknown"),
            ("LOG", result.log),
            ("STATEMENT", result.bounds or "no figures"),
        ]
        place = [source_file(result.place)] if (of.project.root / result.place).is_file() else []
        return node("RESULT", fields, [*(parent(uid, "Verifies") for uid in supported), *place])

    head = HEAD.format(title="Verification results", uid="DOC-RESULTS")
    return head + "".join(one(result) for result in of.project.results)
