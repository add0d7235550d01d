#!/usr/bin/env python3
"""Writes the trace report of this commit into build/report and judges it.

Usage: report.py [--gate-only] [--release]. Without --release the measurements that only a release demands are
named as awaited where they are missing; with it they are lines that are missing.

Reads spec/requirements by StrictDoc, the functions of kernel/src, and the evidence in build/evidence and
build/reports. Writes index.html, matrix.html, trace.html, results.html, matrix.csv, trace.json, sbom.json,
sbom-tools.json, release.json, StrictDoc's own pages, and the papers as HTML and PDF. Prints every line that
is missing or wrong; exits 1 when there is one, 2 when there is no report.
"""

import argparse
import json
import re
import shutil
import sys
import tomllib
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "evidence"))

import documents
import evidence
import figures
import gate
import pages
import papers
import release
import walk
from components import Component, bill_of_materials, shipped
from expected import Check, UnusableError, read_checks
from exporter import RefusedError, export, stage
from items import Items, read_items
from matrix import Row, as_csv, negative_lists, rows
from results import Source, read_results
from sources import functions_of, read_links
from tool_components import tools


def read_toml(path: Path) -> dict:
    return tomllib.loads(path.read_text("utf-8"))


def version(root: Path) -> str:
    """The version that CMakeLists.txt gives the project."""
    return re.search(r"project\(interlock VERSION (\S+)", (root / "CMakeLists.txt").read_text("utf-8"))[1]


def read_stated(root: Path, output: Path) -> tuple[Items, str]:
    """What spec/requirements says, and what StrictDoc printed. Raises RefusedError when it takes it not."""
    requirements = root / "spec/requirements"
    stage(requirements, output / "source")
    printed = export(output / "source", requirements / "strictdoc_config.py", output / "stated", "json")
    return read_items(output / "stated/json/index.json"), printed


def read_project(
    source: Source,
    stated: tuple[Items, str],
    checks: Iterable[Check],
    components: Sequence[Component],
    release: bool = False,
) -> gate.Project:
    """All that the gate looks at: what is stated, sources, evidence of `checks`.

    Those that a release demands are demanded only when it is one.
    """
    requirements = source.root / "spec/requirements"
    items, printed = stated
    return gate.Project(
        root=source.root,
        items=items,
        functions=functions_of(source.root),
        links=read_links(requirements / "links.toml"),
        results=read_results(source, checks, release=release),
        reviewed=read_toml(requirements / "reviewed.toml"),
        clauses=read_toml(requirements / "clauses.toml"),
        components=components,
        exporter_log=printed,
        release=release,
    )


def write_documents(of: gate.Trace, output: Path) -> str:
    """Writes units and results as documents, and all documents as pages. Returns what StrictDoc printed."""
    (output / "source/90_units.sdoc").write_text(documents.units(of), "utf-8")
    (output / "source/91_results.sdoc").write_text(documents.results(of), "utf-8")
    shutil.rmtree(output / "strictdoc", ignore_errors=True)
    config = of.project.root / "spec/requirements/strictdoc_config.py"
    return export(output / "source", config, output / "strictdoc", "html,json")


def dump(document: object) -> str:
    return json.dumps(document, indent=2) + "\n"


def write_pages(
    of: gate.Trace,
    found: Sequence[gate.Finding],
    output: Path,
    commit: str,
    used: Sequence[Component],
) -> list[gate.Finding]:
    """Writes our own pages, the matrix as CSV, figures, findings and both bills of materials as JSON.

    `used` is what builds and verifies.

    Returns a finding for each link of the pages that leads nowhere, and for each drawn row that ends.
    """
    written = pages.write_all(of, found, commit)
    for name, text in written.items():
        (output / name).write_text(text, "utf-8")
    matrix = rows(of)
    (output / "matrix.csv").write_text(as_csv(matrix), "utf-8")
    summary = {
        "commit": commit,
        "counts": pages.counts(of),
        "rows": len(matrix),
        "negative_lists": negative_lists(of),
        "awaited": gate.awaited(of),
        "findings": [{"rule": one.rule, "uid": one.uid, "text": one.text} for one in found],
    }
    (output / "trace.json").write_text(dump(summary), "utf-8")
    materials = bill_of_materials(of.project.components, commit)
    (output / "sbom.json").write_text(dump(materials), "utf-8")
    beside = bill_of_materials(used, commit, "interlock-tools")
    (output / "sbom-tools.json").write_text(dump(beside), "utf-8")
    (output / "release.json").write_text(dump(release.record(of, found, commit)), "utf-8")
    broken = sorted(pages.broken_links(written, output))
    return [
        *(gate.Finding("G9", page, f"its link {link} leads nowhere") for page, link in broken),
        *walked(matrix, walk.Pages(written, output, of.project.root), commit),
    ]


def walked(matrix: Sequence[Row], written: walk.Pages, commit: str) -> list[gate.Finding]:
    """A finding for whatever ends the way through the rows that the commit draws."""
    chosen = walk.drawn(matrix, commit)
    print(f"{len(chosen)} of {len(matrix)} rows of the matrix opened, drawn by {commit}")
    return [
        gate.Finding("G9", walk.uid_of(row.requirement), f"its row does not open from {row.hazard}: {wrong}")
        for row in chosen
        for wrong in walk.complaints(row, written)
    ]


def main() -> int:
    parser = argparse.ArgumentParser(description="Write and judge the trace report.")
    parser.add_argument("--gate-only", action="store_true", help="judge, and write no pages")
    parser.add_argument("--release", action="store_true", help="demand what a release demands, too")
    arguments = parser.parse_args()
    root = evidence.ROOT
    output = root / "build/report"
    commit = evidence.commit()
    try:
        checks = read_checks()
        current = {check.name: check.holds() for check in checks}
        source = Source(root, commit, current.__getitem__)
        stated_now = read_stated(root, output)
        project = read_project(source, stated_now, checks, shipped(root), arguments.release)
        if not arguments.gate_only:
            printed = write_documents(gate.trace(project), output)
            project = replace(project, exporter_log=project.exporter_log + printed)
        of = gate.trace(project)
        found = gate.findings(of)
        if wrong := figures.complaint(root, project.items):
            found.append(gate.Finding("G9", "README.md", wrong))
        if not arguments.gate_only:
            stated = papers.read_documents(output / "stated/json/index.json")
            set_of = papers.Source(of, stated, found, commit, version(root))
            papers.write_papers(set_of, output / "papers", papers.read_papers())
            found += write_pages(of, found, output, commit, tools(root))
    except (RefusedError, UnusableError, ValueError, OSError) as error:
        print(f"report: {error}", file=sys.stderr)
        return 2
    for (rule, text), uids in gate.alike(found).items():
        print(f"{rule} {text}: {', '.join(uids)}")
    by_rule = ", ".join(f"{rule} {count}" for rule, count in Counter(one.rule for one in found).items())
    print(", ".join(f"{count} {name}" for name, count in pages.counts(of).items()))
    for what, uids in gate.awaited(of).items():
        if uids:
            print(f"awaited, demanded by a release alone: {what.lower()}: {', '.join(uids)}")
    print(f"gate: {len(found)} lines are missing or wrong ({by_rule})" if found else "gate: green")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
