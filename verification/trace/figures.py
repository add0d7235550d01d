#!/usr/bin/env python3
"""The figures that README.md states, counted from the sources alone. Usage: figures.py [--write]

They follow from spec/requirements, the functions of the core, the lists of proofs and models, and the tests
as they are written, so that no run makes them true and none becomes stale when they are written down.
Prints README.md's table; --write puts it there.
"""

import argparse
import re
import sys
from collections.abc import Mapping
from pathlib import Path

from exporter import export, stage
from items import Items, read_items
from results import CONVERTERS, Rung, Source
from sources import functions_of

KINDS = {
    "hazards": "HAZARD",
    "causes": "CAUSE",
    "failure modes": "FAILURE_MODE",
    "threats": "THREAT",
    "risk controls": "CONTROL",
    "system requirements": "SYSREQ",
    "software requirements": "REQUIREMENT",
    "properties": "PROPERTY",
    "SOUP items": "SOUP",
    "anomalies": "ANOMALY",
}
"""What is counted of the documents, and the node type of each."""
BEGIN, END = "<!-- figures of the report -->", "<!-- end of the figures -->"
GTEST = re.compile(r"^TEST(?:_P|_F)?\((\w+),\s*(\w+)", re.MULTILINE)
PROVERS = ("tick", "cbmc", "model")


def written_tests(root: Path) -> dict[str, list[str]]:
    """The tests of each suite as the sources name them; one with parameters counts once."""

    def texts(pattern: str) -> list[tuple[Path, str]]:
        return [(path, path.read_text("utf-8")) for path in sorted((root / "tests").glob(pattern))]

    def of_pytest(network: bool) -> list[str]:
        return [
            f"tests.integration.{path.stem}::{name}"
            for path, text in texts("integration/test_*.py")
            if ("pytestmark = pytest.mark.network" in text) == network
            for name in re.findall(r"^def (test_\w+)", text, re.MULTILINE)
        ]

    return {
        "unit": [".".join(names) for _, text in texts("unit/**/*.cpp") for names in GTEST.findall(text)],
        "integration": of_pytest(network=False),
        "network": of_pytest(network=True),
        "console": [
            f"{path.stem}::{name}"
            for path in sorted((root / "web/src").rglob("*.test.ts*"))
            for name in re.findall(r"\bit\(\s*[`\"]([^`\"]+)", path.read_text("utf-8"))
        ],
        "browser": [
            f"{path.name}::{name}"
            for path, text in texts("browser/*.spec.ts")
            for name in re.findall(r"\btest\(\s*[`\"]([^`\"]+)", text.replace("${way}", "Esc"))
        ],
    }


def planned_results(root: Path, method: str) -> int:
    """How many results of a method the rungs of the ladder give, whatever they come to."""
    source = Source(root, "", lambda _: False)
    silent = [Rung(name, "UNKNOWN", "", "", "", {}, frozenset(), False, "", "") for name in PROVERS]
    return sum(one.method == method for rung in silent for one in CONVERTERS[rung.name](source, rung))


def figures(root: Path, items: Items) -> Mapping[str, int]:
    """Each figure by what it counts."""
    return {
        **{name: len(items.of(kind)) for name, kind in KINDS.items()},
        "functions of the core": len(functions_of(root)),
        "results of proof": planned_results(root, "Proof"),
        "results of model checking": planned_results(root, "ModelCheck"),
        "tests as written": sum(len(names) for names in written_tests(root).values()),
    }


def table(found: Mapping[str, int]) -> str:
    """The figures as README.md has them, with the marks around them."""
    lines = "".join(f"| {name} | {count:,} |\n" for name, count in found.items())
    return f"{BEGIN}\n| what | count |\n| --- | --- |\n{lines}{END}"


def stated_in(readme: str) -> str:
    """The table that stands between the marks; empty when none does."""
    begin, end = readme.find(BEGIN), readme.find(END)
    return readme[begin : end + len(END)] if 0 <= begin < end else ""


def complaint(root: Path, items: Items) -> str:
    """In what README.md differs from the sources; empty when in nothing."""
    counted = table(figures(root, items))
    try:
        stated = stated_in((root / "README.md").read_text("utf-8"))
    except OSError:
        stated = ""
    if stated == counted:
        return ""
    return "its figures are not those of the sources; `verification/trace/figures.py --write` puts them right"


def main() -> int:
    parser = argparse.ArgumentParser(description="Count what README.md states.")
    parser.add_argument("--write", action="store_true", help="put the table into README.md")
    arguments = parser.parse_args()
    root = Path(__file__).resolve().parents[2]
    requirements, output = root / "spec/requirements", root / "build/report"
    stage(requirements, output / "source")
    export(output / "source", requirements / "strictdoc_config.py", output / "stated", "json")
    counted = table(figures(root, read_items(output / "stated/json/index.json")))
    print(counted)
    readme = root / "README.md"
    text = readme.read_text("utf-8")
    if arguments.write and not stated_in(text):
        print(f"figures: README.md has no lines '{BEGIN}' and '{END}'", file=sys.stderr)
        return 2
    if arguments.write:
        readme.write_text(text.replace(stated_in(text), counted), "utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
