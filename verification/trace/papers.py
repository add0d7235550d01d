"""The document set as HTML and PDF: papers.toml, filled from what is stated, sources and evidence."""

import json
import re
import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from itertools import groupby
from pathlib import Path

import item_units
from diagrams import modules, processes
from expected import read_checks
from gate import Finding, Trace, alike
from items import STRUCTURE, Item
from markdown_it import MarkdownIt
from matrix import Row, code_of, coverage, negative_lists, rows, status_of
from release import record
from results import Result
from weasyprint import HTML

HERE = Path(__file__).parent
MARKDOWN = MarkdownIt("commonmark", {"html": False}).enable("table")
LINK = re.compile(r"\[LINK: ([^\]]+)\]")
TEXT = re.compile(r"(?:^|(?<=>))[^<]+")
LONG = re.compile(r"(?<![^\s>;])[^\s<>&;]{18,}")
PARTING = re.compile(r"([/_:.,@%-])")
SHOWN_APART = frozenset({"UID", "TITLE", "STATEMENT", "RELATIONS"})
"""Fields that an item shows in a way of their own; each other has a line of its table."""


@dataclass(frozen=True)
class Paper:
    """One document of the set, as papers.toml describes it."""

    name: str
    title: str
    clauses: str
    tells: str
    not_covered: str
    chapters: Sequence[str]


@dataclass(frozen=True)
class Source:
    """All that the papers are made from."""

    trace: Trace
    documents: Mapping[str, Mapping]
    """StrictDoc's export of each document, by its UID."""
    found: Sequence[Finding]
    commit: str
    version: str


def read_papers() -> list[Paper]:
    return [Paper(**one) for one in tomllib.loads((HERE / "papers.toml").read_text("utf-8"))["paper"]]


def read_documents(export: Path) -> Mapping[str, Mapping]:
    """Each document of StrictDoc's export by its UID, or its title where it has none."""
    return {one.get("UID", one["TITLE"]): one for one in json.loads(export.read_text("utf-8"))["DOCUMENTS"]}


def words(text: str) -> str:
    """Markdown as HTML; StrictDoc's links to other documents by the document's identifier."""
    return MARKDOWN.render(LINK.sub(r"\1", text))


def breakable(cell: str) -> str:
    """A cell in which long names may break after the signs that part them."""

    def part(text: re.Match[str]) -> str:
        return LONG.sub(lambda match: PARTING.sub(r"\1<wbr>", match[0]), text[0])

    return TEXT.sub(part, cell)


def table(headings: Sequence[str], lines: Sequence[Sequence[str]], kind: str = "") -> str:
    """A table of cells that are HTML already."""
    if not lines:
        return "<p>None.</p>"
    head = "".join(f"<th>{escape(one)}</th>" for one in headings)
    body = "".join(
        "<tr>" + "".join(f"<td>{breakable(cell)}</td>" for cell in line) + "</tr>" for line in lines
    )
    return f'<table class="{kind}"><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>'


def texts(headings: Sequence[str], lines: Sequence[Sequence[object]], kind: str = "") -> str:
    """A table of plain texts."""
    return table(headings, [[escape(str(cell)) for cell in line] for line in lines], kind)


def status(word: str) -> str:
    return f'<span class="{escape(word)}">{escape(word)}</span>'


def field_name(name: str) -> str:
    """SAFETY_CLASS as Safety class."""
    return name.replace("_", " ").capitalize()


def item_block(of: Trace, item: Item) -> str:
    """An item with its statement, its fields, and what it is linked with."""
    lines = [
        (escape(field_name(name)), escape(text))
        for name, text in item.fields.items()
        if name not in SHOWN_APART and not name.startswith("_")
    ]
    for role in dict.fromkeys(role for role, _ in item.parents):
        lines.append((escape(role), escape(", ".join(item.parents_by(role)))))
    children = of.project.items.children(item.uid)
    if children:
        lines.append(("Named by", escape(", ".join(sorted({child.uid for child in children})))))
    if item.kind == "REQUIREMENT":
        carried = of.carried.get(item.uid, ())
        lines.append(("Code", escape(", ".join(code_of(of, item.uid)) or "none")))
        lines.append(("Results", f"{len(carried)}: {status(status_of(carried))}"))
    fields = "".join(f"<tr><th>{name}</th><td>{text}</td></tr>" for name, text in lines)
    shown = f'<table class="fields">{fields}</table>' if fields else ""
    head = (
        f'<h3 id="{escape(item.uid)}"><span class="uid">{escape(item.uid)}</span> {escape(item.title)}</h3>'
    )
    return f'<div class="item">{head}{words(item.statement)}{shown}</div>'


def nodes(of: Trace, parent: Mapping) -> Iterator[str]:
    """The nodes of a document or a section, in order."""
    for node in parent.get("NODES", []):
        if node["_NODE_TYPE"] == "SECTION":
            yield f"<h2>{escape(node['TITLE'])}</h2>"
            yield from nodes(of, node)
        elif node["_NODE_TYPE"] in STRUCTURE:
            yield words(node["STATEMENT"])
        else:
            yield item_block(of, of.project.items[node["UID"]])


def tools(source: Source) -> str:
    """The tools on which a claim rests."""
    named = tomllib.loads((source.trace.project.root / "spec/requirements/tools.toml").read_text("utf-8"))
    used = sorted({one.tool for one in source.trace.project.results if one.tool not in ("none", "unknown")})
    lines = [(name, one["use"], one["fault"], one["check"]) for name, one in named.items()]
    seen = "".join(f"<li>{escape(one)}</li>" for one in used)
    listed = texts(("tool", "intended use", "what a fault could do", "what would show it"), lines)
    return (
        f"{listed}<h2>Versions that made the results of this report</h2><ul>{seen or '<li>None.</li>'}</ul>"
    )


def units(source: Source) -> str:
    """Each function of the core with purpose and requirements."""

    def unit(function: object) -> str:
        requirements = ", ".join(source.trace.project.links.requirements_of(function)) or "none"
        place = f"{function.file}:{function.line}"
        head = f'<h3 id="{escape(place)}">{escape(function.name)}</h3>'
        about = f'<table class="fields"><tr><th>Place</th><td>{escape(place)}</td></tr>'
        about += f"<tr><th>Fulfils</th><td>{escape(requirements)}</td></tr></table>"
        return f'<div class="unit">{head}<p>{escape(function.purpose)}</p>{about}</div>'

    by_file: dict[str, list[str]] = {}
    for function in source.trace.project.functions:
        by_file.setdefault(function.file, []).append(unit(function))
    return "".join(f"<h2>{escape(file)}</h2>{''.join(blocks)}" for file, blocks in by_file.items())


def units_of_items(source: Source) -> str:
    """Each type and function that the headers of items of class C declare, with what they say of it."""
    project = source.trace.project
    described = item_units.units_by_item(project.root, project.items)
    shown = []
    for uid, entries in described.items():
        shown.append(f"<h2>{escape(uid)} {escape(project.items[uid].title)}</h2>")
        for file, within in groupby(entries, key=lambda one: one.file):
            each = list(within)
            about = " ".join(one.brief for one in each if one.kind == "file")
            lines = [(one.name, one.kind, one.brief) for one in each if one.kind != "file" and one.brief]
            shown.append(f"<h3>{escape(file)}</h3><p>{escape(about)}</p>")
            shown.append(texts(("unit", "kind", "says"), lines))
    return "".join(shown)


def methods(source: Source) -> str:
    """How many requirements are verified by which method."""
    counted: dict[str, int] = {}
    for requirement in source.trace.project.items.of("REQUIREMENT"):
        for method in requirement.fields["VERIFICATION"].split(", "):
            counted[method] = counted.get(method, 0) + 1
    return texts(("method", "requirements"), sorted(counted.items()))


def rungs(source: Source) -> str:
    """The rungs of the ladder with the exact figures that decide them."""
    lines = [
        (
            one.name,
            one.command,
            one.status,
            ", ".join(f"{name} {value}" for name, value in one.figures.items()),
        )
        for one in read_checks(source.trace.project.root / "verification/expected.toml")
        if one.target == "make verify"
    ]
    return texts(("rung", "run by", "must come to", "exact figures"), lines)


def made(result: Result) -> str:
    """When, from which commit and on what machine a result was made."""
    where = f", {result.machine}" if result.machine else ""
    return f"{result.date[:16] or 'no date'}, {result.commit[:12] or 'no commit'}{where}"


def results_where(source: Source, chosen: Callable[[Result], bool]) -> str:
    """A table of results: what 9.8 asks of a record."""
    found = [one for one in source.trace.project.results if chosen(one)]
    lines = [
        (
            f"{escape(one.uid)}<br><small>{escape(one.title)}</small>",
            status(one.status) + ("" if one.fresh else "<br>stale"),
            escape(one.bounds),
            f"{escape(one.tool)}<br><small>{escape(made(one))}</small>",
            escape(one.log),
        )
        for one in found
    ]
    sound = sum(one.status in ("PASSED", "BOUNDED") for one in found)
    fresh = sum(one.fresh for one in found)
    head = f"<p>{len(found)} results, {sound} of them PASSED or BOUNDED, {fresh} made from these sources.</p>"
    return head + table(("result", "status", "bounds", "tool, date, commit", "raw log"), lines, "wide")


INTEGRATION = ("TEST:integration:", "TEST-INTEGRATION", "TEST:network:", "TEST-NETWORK", "SCENARIOS")
"""Results of real processes with each other, by how their UIDs begin."""
SYSTEM = ("TEST:browser:", "TEST-BROWSER", "SOAK", "BENCH", "CONSOLE", "STEERING")
"""Results of the whole, through its outer interfaces."""


def unit_results(source: Source) -> str:
    return results_where(source, lambda one: not one.uid.startswith((*INTEGRATION, *SYSTEM)))


def integration_results(source: Source) -> str:
    return results_where(source, lambda one: one.uid.startswith(INTEGRATION))


def system_results(source: Source) -> str:
    return results_where(source, lambda one: one.uid.startswith(SYSTEM))


def requirements(source: Source) -> str:
    """Each software requirement with what became of its verification."""
    of = source.trace
    lines = [
        (
            escape(one.uid),
            escape(one.title),
            escape(one.fields["VERIFICATION"]),
            str(len(of.carried.get(one.uid, ()))),
            status(status_of(of.carried.get(one.uid, ()))),
        )
        for one in of.project.items.of("REQUIREMENT")
    ]
    return table(("requirement", "title", "methods", "results", "worst status"), lines)


def hazard_coverage(source: Source) -> str:
    lines = [
        (
            one.hazard.uid,
            one.hazard.title,
            one.hazard.fields["SEVERITY"],
            one.causes,
            one.failures,
            one.controls,
            one.requirements,
            one.sound,
        )
        for one in coverage(source.trace)
    ]
    return texts(
        (
            "hazard",
            "title",
            "severity",
            "causes, threats",
            "failures",
            "controls",
            "requirements",
            "with sound results",
        ),
        lines,
    )


def components(source: Source) -> str:
    described = {
        name.strip(): item.uid
        for item in source.trace.project.items.of("SOUP")
        for name in item.fields["COMPONENTS"].split(",")
    }
    lines = [
        (
            one.name,
            one.version,
            one.supplier,
            one.licence or "not known",
            one.purl,
            described.get(one.name, "none"),
        )
        for one in source.trace.project.components
    ]
    return texts(("component", "version", "supplier", "licence", "package URL", "SOUP item"), lines)


def release_facts(source: Source) -> str:
    facts = record(source.trace, source.found, source.commit)
    commands = "\n".join(facts["commands"])
    lines = [
        ("version", source.version),
        ("commit", source.commit),
        ("components", len(facts["components"])),
        ("anomalies", len(facts["anomalies"])),
        ("findings of the gate", facts["findings"]),
        *((f"awaited: {what.lower()}", ", ".join(uids) or "none") for what, uids in facts["awaited"].items()),
    ]
    return f"{texts(('', ''), lines)}<h2>Built and verified by</h2><pre>{escape(commands)}</pre>"


def release_files(source: Source) -> str:
    files = record(source.trace, source.found, source.commit)["files"]
    return texts(("file", "SHA-256"), list(files.items()), "hashes")


def threats(source: Source) -> str:
    """Each threat with the controls that meet it."""
    items = source.trace.project.items
    lines = [
        (
            one.uid,
            one.fields["INTERFACE"],
            one.fields["STRIDE"],
            one.title,
            ", ".join(control.uid for control in items.children(one.uid, "Mitigates")),
        )
        for one in items.of("THREAT")
    ]
    return texts(("threat", "interface", "STRIDE", "title", "controls"), lines)


def findings(source: Source) -> str:
    """Every line that is missing or wrong, as the gate says it."""
    lines = [
        f"<h2>{rule}: {escape(text)}</h2><p>{len(uids)}: {escape(', '.join(uids))}</p>"
        for (rule, text), uids in alike(source.found).items()
    ]
    return "".join(lines) or "<p>None: the gate is green.</p>"


def clauses(source: Source) -> str:
    """Each clause in both editions."""

    def state(entry: Mapping) -> str:
        if "outside" in entry:
            return f"not ours: {entry['outside']}"
        shown = ", ".join(entry.get("shown_by", ()))
        if "missing" in entry:
            return f"{shown + '; ' if shown else ''}missing: {entry['missing']}"
        return shown

    lines = [
        (clause, entry["title"], entry["class"], entry.get("edition_2", "not known"), state(entry))
        for clause, entry in source.trace.project.clauses.items()
    ]
    head = ("edition 1.1", "subject", "from class", "edition 2", "shown by")
    gaps = sum("missing" in entry for entry in source.trace.project.clauses.values())
    return f"<p>{len(lines)} lines, {gaps} of them gaps.</p>{texts(head, lines)}"


def lists_of_negatives(source: Source) -> str:
    return "".join(
        f"<h2>{escape(name)}</h2><p>{escape(', '.join(uids)) or 'None.'}</p>"
        for name, uids in negative_lists(source.trace).items()
    )


def counted(results: str) -> str:
    """How many results a row of the matrix lists."""
    number = results.count("; ") + bool(results)
    return f"{number} result{'' if number == 1 else 's'}"


def matrix_ways(source: Source) -> str:
    """Each hazard with its harm and risk, and under it a line for each way from a cause to a requirement."""
    parts = []
    for hazard, ways in groupby(rows(source.trace), key=lambda row: row.hazard):
        found = list(ways)
        lines = [
            (
                f"{escape(row.cause)}<br><small>{escape(row.cause_item)}, {escape(row.cause_kind)}</small>",
                f"{escape(row.control)}<br><small>{escape(row.control_kind)}</small>",
                escape(row.system_requirement),
                f"{escape(row.requirement)}<br><small>{escape(row.text_hash)}</small>",
                escape(row.item),
                f"{status(row.status)}<br><small>{counted(row.results)}</small>",
                escape(row.anomalies),
            )
            for row in found
        ]
        head = ("cause", "control", "system requirement", "requirement, hash of its text", "item", "status")
        parts.append(f"<h2>{escape(hazard)}</h2>{facts_of(found[0], HAZARD_FACTS)}")
        parts.append(table((*head, "anomalies"), lines, "matrix"))
    return "".join(parts)


def matrix_requirements(source: Source) -> str:
    """Each requirement of the matrix once, with everything that its ways have in common."""
    once = {row.requirement: row for row in rows(source.trace)}
    blocks = []
    for requirement, row in sorted(once.items()):
        head = f'<h3 id="rests-{requirement.split()[0]}">{escape(requirement)}</h3>'
        blocks.append(f'<div class="unit">{head}{facts_of(row, REQUIREMENT_FACTS)}</div>')
    return "".join(blocks)


def facts_of(row: Row, names: Sequence[str]) -> str:
    """Columns of a row one below the other, those without a value left out."""
    lines = [
        f"<tr><th>{escape(name.replace('_', ' '))}</th><td>{escape(value)}</td></tr>"
        for name in names
        if (value := getattr(row, name))
    ]
    return f'<table class="fields facts">{"".join(lines)}</table>'


HAZARD_FACTS = ("harm", "severity", "situation", "initial_risk", "residual")
REQUIREMENT_FACTS = (
    *("properties", "design", "code", "methods", "verification"),
    *("results", "bounds", "tools", "dates", "commits"),
)


TABLES: Mapping[str, tuple[str, Callable[[Source], str]]] = {
    "tools": ("Tools and their assurance", tools),
    "processes": ("Processes and interfaces", lambda _: processes()),
    "modules": ("What includes what in the app", lambda source: modules(source.trace.project.root)),
    "units": ("Units", units),
    "units of other items": ("Units of the other items of class C", units_of_items),
    "methods": ("Methods", methods),
    "rungs": ("The verification ladder", rungs),
    "results of units": ("Results", unit_results),
    "results of integration": ("Results", integration_results),
    "results of the system": ("Results", system_results),
    "requirements": ("Requirements and their results", requirements),
    "coverage": ("Coverage by hazard", hazard_coverage),
    "components": ("What is shipped beside our own code", components),
    "release": ("Release", release_facts),
    "files": ("Files", release_files),
    "threats": ("Threats and controls", threats),
    "findings": ("Findings of the gate", findings),
    "clauses": ("Clauses", clauses),
    "negative lists": ("What must be empty at a release", lists_of_negatives),
    "matrix": ("Matrix", matrix_ways),
    "matrix requirements": ("What each requirement of the matrix rests on", matrix_requirements),
}
"""Chapters that are made, by their name in papers.toml: title and maker."""


def chapter(source: Source, name: str) -> tuple[str, str]:
    """Title and text of a chapter. Raises KeyError for one that there is not."""
    if name in TABLES:
        title, make = TABLES[name]
        return title, make(source)
    if name.endswith(".md"):
        text = (source.trace.project.root / name).read_text("utf-8")
        title, _, rest = text.removeprefix("# ").partition("\n")
        return title, words(re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", rest))
    document = source.documents[name]
    return document["TITLE"], "".join(nodes(source.trace, document))


def section(source: Source, name: str) -> str:
    """A chapter with its heading; a wide one lies on its side."""
    title, text = chapter(source, name)
    lies = ' class="landscape"' if name in LANDSCAPE else ""
    return f"<section{lies}><h1>{escape(title)}</h1>{text}</section>"


LANDSCAPE = frozenset({"matrix"})
HEADING = re.compile(r"<h([123])([^>]*)>(.*?)</h\1>", re.DOTALL)
IDENTITY = re.compile(r'id="([^"]*)"')


def with_contents(body: str) -> tuple[str, str]:
    """The body with a place at each heading, and the contents that lead there."""
    lines: list[str] = []

    def mark(match: re.Match[str]) -> str:
        level, attributes, text = match[1], match[2], match[3]
        given = IDENTITY.search(attributes)
        place = given[1] if given else f"part-{len(lines) + 1}"
        if level in "12":
            lines.append(f'<li class="level-{level}"><a href="#{place}">{text}</a></li>')
        return f'<h{level} id="{place}">{text}</h{level}>'

    marked = HEADING.sub(mark, body)
    return marked, f"<ul>{''.join(lines)}</ul>"


def as_html(source: Source, paper: Paper) -> str:
    """One paper as a page that stands by itself: title page, contents, chapters."""
    body, contents = with_contents("".join(section(source, name) for name in paper.chapters))
    facts = (
        ("Version", source.version),
        ("Commit", source.commit),
        ("Clauses", f"{paper.clauses} (IEC 62304:2006+A1:2015 unless another is named)"),
        ("Approved by", "nobody: this is evidence of a research system, not an approved document"),
    )
    lines = "".join(f"<tr><th>{name}</th><td>{escape(value)}</td></tr>" for name, value in facts)
    title = (
        f'<section class="title"><p class="product">Interlock</p><p class="name">{escape(paper.title)}</p>'
        f"<p>{escape(paper.tells)}</p><p><b>Not covered:</b> {escape(paper.not_covered)}</p>"
        f'<table class="fields">{lines}</table></section>'
    )
    style = '<link rel=stylesheet href="paper.css">'
    head = f'<meta charset="utf-8"><title>{escape(paper.title)}</title>{style}'
    foot = f'<div class="running">Interlock {escape(source.version)}, {escape(source.commit[:12])}</div>'
    listed = f'<nav class="contents"><p class="name">Contents</p>{contents}</nav>'
    return (
        f"<!doctype html><html lang=en><head>{head}</head><body>{foot}{title}{listed}{body}</body></html>\n"
    )


def index(chosen: Sequence[Paper]) -> str:
    """A page that leads to every paper."""
    lines = [
        (
            f'<a href="{paper.name}.html">{escape(paper.title)}</a>',
            f'<a href="{paper.name}.pdf">PDF</a>',
            escape(paper.clauses),
            escape(paper.tells),
        )
        for paper in chosen
    ]
    listed = table(("document", "", "clauses", "tells"), lines)
    head = '<meta charset="utf-8"><title>Documents</title><link rel=stylesheet href="../style.css">'
    menu = '<nav><a href="../index.html">Overview</a></nav><h1>Documents</h1>'
    return f"<!doctype html><html lang=en>{head}{menu}{listed}</html>\n"


def write_papers(source: Source, output: Path, chosen: Sequence[Paper]) -> list[Path]:
    """Writes the chosen papers as HTML and PDF into `output`, and returns the PDFs."""
    output.mkdir(parents=True, exist_ok=True)
    (output / "index.html").write_text(index(chosen), "utf-8")
    (output / "paper.css").write_text((HERE / "paper.css").read_text("utf-8"), "utf-8")
    written = []
    for paper in chosen:
        text = as_html(source, paper)
        (output / f"{paper.name}.html").write_text(text, "utf-8")
        written.append(output / f"{paper.name}.pdf")
        HTML(string=text, base_url=output.as_uri() + "/").write_pdf(written[-1])
    return written
