"""The record of MISRA deviations as Markdown, from verification/misra/deviations.toml."""

import tomllib
from collections.abc import Mapping, Sequence

from http_page import table

KINDS = (
    (
        "deviation",
        "Deviations",
        "Findings that stay, each with its reason. The core, `kernel/src` and `kernel/include`, has none."
        " One finding more or less than its record accepts fails the rung `misra`.",
        ("rule", "category", "sites", "files", "reason"),
    ),
    (
        "disapplied",
        "Disapplied guidelines",
        "Advisory guidelines that the named files do not follow.",
        ("rule", "category", "files", "reason"),
    ),
    (
        "false_positive",
        "False positives",
        "What a checker reports although the rule is kept.",
        ("rule", "sites", "files", "reason"),
    ),
)
"""Kind of record, its heading, what is said of it, and its columns."""


def said(value: object) -> str:
    """A value of a record: files one after the other, the rest as it is."""
    return ", ".join(f"`{file}`" for file in value) if isinstance(value, list) else str(value)


def deviations_page(text: str) -> str:
    """The page. Raises KeyError when a record lacks one of its columns."""
    records: Mapping[str, Sequence[Mapping[str, object]]] = tomllib.loads(text)
    parts = [
        "# Deviations from MISRA C:2012",
        "Numbers are those of MISRA C:2012 with Amendments 1 and 2; their texts are licensed, not repeated."
        " How each guideline is enforced, and which proofs stand for those that no checker decides, is in the"
        " [enforcement plan](tree/verification/misra/enforcement.md); the source of this page is"
        " `verification/misra/deviations.toml`, which the rung `misra` checks on every run.",
    ]
    for kind, heading, about, columns in KINDS:
        rows = [[said(record[column]) for column in columns] for record in records.get(kind, ())]
        parts += [f"## {heading}", about, table(columns, rows) or "None."]
    return "\n\n".join(parts) + "\n"
