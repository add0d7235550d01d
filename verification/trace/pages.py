"""The report as pages that work without a network: overview, matrix, and every item with both directions."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import fields
from html import escape, unescape
from pathlib import Path

from figures import KINDS
from gate import Finding, Trace, alike, awaited
from items import Item
from matrix import Row, code_of, coverage, negative_lists, rows, status_of, tests_of, without_control
from results import AWAITED, Result

STYLE = "style.css"
FILTER = "filter.js"
LINK = re.compile(r'href="([^"]+)"')
ANCHOR = re.compile(r'id="([^"]+)"')
MENU = {
    "Overview": "index.html",
    "Matrix": "matrix.html",
    "Items": "trace.html",
    "Results": "results.html",
    "Papers": "papers/index.html",
    "Documents": "strictdoc/html/index.html",
    "CSV": "matrix.csv",
    "SBOM": "sbom.json",
    "Tools": "sbom-tools.json",
    "Release": "release.json",
}
CONTENTS = (
    *("Function", "InputOutput", "Interface", "Alarm", "Security", "UserInterface"),
    *("Data", "Installation", "Operation", "Network", "Maintenance", "Regulatory"),
)
"""Contents a to l of clause 5.2.2, as grammar.sgra names them."""
TOP = "../.."
"""From build/report to the top of the tree."""


def page(title: str, body: str, script: str = "") -> str:
    head = f'<meta charset="utf-8"><title>{escape(title)}</title><link rel=stylesheet href="{STYLE}">'
    menu = "".join(f'<a href="{target}">{name}</a>' for name, target in MENU.items())
    tail = f'<script src="{script}"></script>' if script else ""
    whole = f"<nav>{menu}</nav><h1>{escape(title)}</h1>{body}{tail}"
    return f"<!doctype html><html lang=en>{head}{whole}</html>\n"


def filtered(body: str) -> str:
    field = '<input id="filter" placeholder="Filter by words: H-03 P2 FAILED ...">'
    return f'{field} <span id="count"></span>{body}'


def item_link(uid: str, text: str = "") -> str:
    return f'<a href="trace.html#{escape(uid)}">{escape(text or uid)}</a>'


def result_link(result: Result) -> str:
    return f'<a href="results.html#{escape(result.uid)}">{escape(result.uid)}</a> {status(result.status)}'


def file_link(path: str) -> str:
    """A link to a file of the tree; `path` may go on with :LINE and words."""
    return f'<a href="{TOP}/{escape(path.split(":")[0].split(" ")[0])}">{escape(path)}</a>'


def status(word: str) -> str:
    return f'<span class="{word}">{word}</span>'


def listed(lines: Sequence[str]) -> str:
    return "<ul>" + "".join(f"<li>{line}" for line in lines) + "</ul>" if lines else "<p>None.</p>"


def folded(title: str, uids: Sequence[str]) -> str:
    """A line that opens to a list."""
    return f"<details><summary>{escape(title)}</summary>{listed([escape(uid) for uid in uids])}</details>"


def table(headings: Sequence[str], lines: Sequence[Sequence[str]]) -> str:
    head = "".join(f"<th>{escape(one)}" for one in headings)
    body = "".join("<tr data-line>" + "".join(f"<td>{cell}" for cell in line) for line in lines)
    return f"<table><thead><tr>{head}</thead><tbody>{body}</tbody></table>"


def counts(of: Trace) -> dict[str, int]:
    """The figures of the report."""
    project = of.project
    tests = [one for one in project.results if one.method == "Test"]
    return {
        **{name: len(project.items.of(kind)) for name, kind in KINDS.items()},
        "functions of the core": len(project.functions),
        "results of proof": sum(one.method == "Proof" for one in project.results),
        "results of model checking": sum(one.method == "ModelCheck" for one in project.results),
        "tests": sum(len(one.cases) for one in tests),
        "measurements awaited": sum(one.status == AWAITED for one in project.results),
    }


def requirements_by_content(of: Trace) -> dict[str, int]:
    """How many software requirements have each content of clause 5.2.2, so that one without any shows."""
    found = dict.fromkeys(CONTENTS, 0)
    for requirement in of.project.items.of("REQUIREMENT"):
        found[requirement.fields["CATEGORY"]] += 1
    return found


def overview(of: Trace, found: Sequence[Finding], commit: str) -> str:
    """Counts, the gate, the negative lists, coverage by hazard."""
    figures = table(("figure", "count"), [(escape(name), str(count)) for name, count in counts(of).items()])
    gate = (
        f"<p>{status('PASSED')}</p>"
        if not found
        else f"<p>{status('FAILED')}: {len(found)} lines are missing or wrong.</p>"
    )
    gate += "".join(
        folded(f"{rule} {text}: {len(uids)}", uids) for (rule, text), uids in alike(found).items()
    )
    negative = "".join(folded(f"{title}: {len(uids)}", uids) for title, uids in negative_lists(of).items())

    besides = without_control(of)
    negative += folded(f"Requirements that carry out no risk control (allowed): {len(besides)}", besides)
    waiting = "".join(folded(f"{title}: {len(uids)}", uids) for title, uids in awaited(of).items())

    def row_link(hazard: Item) -> str:
        words = f"{hazard.uid} {hazard.title}"
        return f'<a href="matrix.html?q={escape(hazard.uid)}">{escape(words)}</a>'

    covered = table(
        (
            "hazard",
            "severity",
            "causes, threats",
            "failures",
            "controls",
            "requirements",
            "with sound results only",
        ),
        [
            (
                row_link(one.hazard),
                one.hazard.fields["SEVERITY"],
                str(one.causes),
                str(one.failures),
                str(one.controls),
                str(one.requirements),
                str(one.sound),
            )
            for one in coverage(of)
        ],
    )
    contents = table(
        ("content of 5.2.2", "requirements"),
        [(escape(name), str(count)) for name, count in requirements_by_content(of).items()],
    )
    sections = {
        "Gate": gate,
        "Must be empty at a release": negative,
        "Awaited: a release demands it, this report does not": waiting,
        "Coverage by hazard": covered,
        "Figures": figures,
        "Software requirements by content": contents,
    }
    note = f"<p>Commit {escape(commit)}. Evidence organised by IEC 62304 clause.</p>"
    return page(
        "Interlock: trace report",
        note + "".join(f"<section><h2>{name}</h2>{body}</section>" for name, body in sections.items()),
    )


def matrix_page(of: Trace, matrix: Sequence[Row]) -> str:
    """The matrix, one line a row, each cell a link to what it names."""
    by_uid = {one.uid: one for one in of.project.results}

    def cell(name: str, text: str) -> str:
        parts = text.split("; ") if text else []
        if name in ("hazard", "cause", "control", "system_requirement", "requirement"):
            return item_link(text.split(" ")[0], text)
        if name in ("item", "properties", "anomalies"):
            return "<br>".join(item_link(part) for part in parts)
        if name in ("code", "verification"):
            return "<br>".join(file_link(part) for part in parts)
        if name == "tests":
            return f"{len(parts)} by name" if parts else ""
        if name in ("design", "bounds"):
            return "<br>".join(escape(part) for part in parts)
        if name == "results":
            return "<br>".join(result_link(by_uid[part.rpartition(" ")[0]]) for part in parts)
        return status(text) if name == "status" else escape(text)

    names = [one.name for one in fields(Row)]
    lines = [[cell(name, getattr(row, name)) for name in names] for row in matrix]
    return page("Trace matrix", filtered(table([name.replace("_", " ") for name in names], lines)), FILTER)


def items_page(of: Trace) -> str:
    """Every item with its parents, children, code and results."""

    def article(item: Item) -> str:
        shown = [
            (name, text)
            for name, text in item.fields.items()
            if not name.startswith("_") and name not in ("UID", "TITLE")
        ]
        body = "".join(f"<dt>{escape(name.capitalize())}<dd>{escape(text)}" for name, text in shown)
        up = [
            f"{item_link(uid)} {escape(of.project.items[uid].title)} <span class=kind>{role}</span>"
            for role, uid in item.parents
        ]
        down = [
            f"{item_link(child.uid)} {escape(child.title)} <span class=kind>{role}</span>"
            for role, uid in of.project.items.child_uids.get(item.uid, [])
            for child in [of.project.items[uid]]
        ]
        carried = sorted(of.carried.get(item.uid, ()), key=lambda one: one.uid)
        parts = {"Up": up, "Down": down, "Code": [file_link(one) for one in code_of(of, item.uid)]}
        parts["Results"] = [result_link(one) for one in carried]
        if item.kind == "REQUIREMENT":
            parts["Tests"] = [escape(case) for case in tests_of(of, item.uid)]
        links = "".join(f"<h4>{name}</h4>{listed(lines)}" for name, lines in parts.items() if lines)
        word = status(status_of(carried)) if item.kind in ("REQUIREMENT", "PROPERTY") else ""
        head = f"<h3>{escape(item.uid)} {escape(item.title)} <span class=kind>{item.kind}</span> {word}</h3>"
        return f'<article id="{escape(item.uid)}" data-line>{head}<dl>{body}</dl>{links}</article>'

    return page(
        "Items, both directions", filtered("".join(article(item) for item in of.project.items)), FILTER
    )


def results_page(of: Trace) -> str:
    """Every result with its bounds, raw log and what it carries."""

    def article(result: Result) -> str:
        carries = sorted(uid for uid, carried in of.carried.items() if result in carried)
        facts = {
            "Status": status(result.status) + ("" if result.fresh else " (stale)"),
            "Method": result.method,
            "Tool": escape(result.tool),
            "Commit": escape(result.commit or "unknown"),
            "Date": escape(result.date or "unknown"),
            "Machine": escape(result.machine),
            "Bounds": escape(result.bounds),
            "Raw log": escape(result.log) if result.status == AWAITED else file_link(result.log),
            "Ran": file_link(result.place) if result.place else "",
            "Carries": ", ".join(item_link(uid) for uid in carries),
            "Did not pass": listed([escape(one) for one in result.failures]) if result.failures else "",
            "Tests": listed([escape(one) for one in result.cases]) if result.cases else "",
        }
        body = "".join(f"<dt>{name}<dd>{text}" for name, text in facts.items() if text)
        head = f"<h3>{escape(result.uid)} <span class=kind>{escape(result.title)}</span></h3>"
        return f'<article id="{escape(result.uid)}" data-line>{head}<dl>{body}</dl></article>'

    return page("Results", filtered("".join(article(one) for one in of.project.results)), FILTER)


def broken_links(written: Mapping[str, str], output: Path) -> set[tuple[str, str]]:
    """Page and link of each link that leads to no anchor and no file. `output` is where the pages stand."""
    anchors = {name: set(ANCHOR.findall(text)) for name, text in written.items()}
    broken = set()
    for name, text in written.items():
        for link in set(LINK.findall(text)):
            target, _, anchor = unescape(link).partition("#")
            target = target.partition("?")[0]
            there = target in written or (output / target).exists()
            if not there or (anchor and escape(anchor) not in anchors.get(target, ())):
                broken.add((name, link))
    return broken


def write_all(of: Trace, found: Sequence[Finding], commit: str) -> dict[str, str]:
    """The pages by file name, with the two files that they share."""
    shared = {name: Path(__file__).with_name(name).read_text("utf-8") for name in (STYLE, FILTER)}
    return {
        **shared,
        "index.html": overview(of, found, commit),
        "matrix.html": matrix_page(of, rows(of)),
        "trace.html": items_page(of),
        "results.html": results_page(of),
    }
