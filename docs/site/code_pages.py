"""Pages of the code by folder, from Doxygen's XML: every documented item by name, with a link to its page.

They let the site's search find code.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from xml.etree import ElementTree

COMPOUNDS = ("class", "struct", "union")
HEADERS = (".h", ".hpp")


@dataclass(frozen=True)
class Entry:
    """One item of a header."""

    file: str
    line: int
    kind: str
    """function, class, variable and so on, in Doxygen's words."""
    name: str
    """With what it stands in: `ilk_state_t::tick`."""
    arguments: str
    brief: str
    page: str
    """Its page among Doxygen's, with the place in it."""
    is_one_line: bool = False
    """Whether its whole definition stands beside its declaration."""


def words(element: ElementTree.Element | None) -> str:
    """All text of an element, in one line."""
    return " ".join("".join(element.itertext()).split()) if element is not None else ""


def documentation(element: ElementTree.Element) -> str:
    """Brief description, or else the first paragraph of the other."""
    return words(element.find("briefdescription")) or words(element.find("detaileddescription/para"))


def page_of(identity: str) -> str:
    """Doxygen's page for the identity of a member: what stands before the last `_1` is the page."""
    page, _, place = identity.rpartition("_1")
    return f"{page}.html#{place}"


def place_of(element: ElementTree.Element) -> tuple[str, int]:
    location = element.find("location")
    return ("", 0) if location is None else (location.get("file", ""), int(location.get("line", 0)))


def is_one_line(element: ElementTree.Element) -> bool:
    location = element.find("location")
    return location is not None and location.get("bodystart") == location.get("bodyend") == location.get(
        "line"
    )


def members(compound: ElementTree.Element, kind: str) -> Iterator[Entry]:
    """The public members of a file, namespace or type, and the values of its enumerations."""
    within = "" if kind == "file" else f"{words(compound.find('compoundname'))}::"
    for member in compound.iter("memberdef"):
        file, line = place_of(member)
        if member.get("prot") != "public" or not file.endswith(HEADERS):
            continue
        name, page = words(member.find("name")), page_of(member.get("id", ""))
        arguments = words(member.find("argsstring"))
        said, kind = documentation(member), member.get("kind", "")
        yield Entry(file, line, kind, within + name, arguments, said, page, is_one_line(member))
        for each in member.iter("enumvalue"):
            value_page = page_of(each.get("id", ""))
            value_name = f"{within}{name}::{words(each.find('name'))}"
            yield Entry(file, line, "enumvalue", value_name, "", documentation(each), value_page)


def entries(xml: Path) -> list[Entry]:
    """Every public item of the headers that Doxygen read, each once, by file and line."""
    found: dict[str, Entry] = {}
    for path in sorted(xml.glob("*.xml")):
        if path.name == "index.xml":
            continue
        for compound in ElementTree.parse(path).getroot().iter("compounddef"):
            kind = compound.get("kind", "")
            file, line = place_of(compound)
            page = f"{compound.get('id')}.html"
            if (
                file.endswith(HEADERS)
                and kind in ("file", *COMPOUNDS)
                and compound.get("prot", "public") == "public"
            ):
                name = file if kind == "file" else words(compound.find("compoundname"))
                line = 0 if kind == "file" else line
                found[page] = Entry(file, line, kind, name, "", documentation(compound), page)
            if kind in ("file", "namespace", *COMPOUNDS) and compound.get("prot", "public") == "public":
                for entry in members(compound, kind):
                    found.setdefault(entry.page, entry)
    return sorted(found.values(), key=lambda one: (one.file, one.line, one.name))


def escaped(text: str) -> str:
    """A text in a cell of a table, with nothing that Markdown would read."""
    for letter in "\\|*_`<>[]#$":
        text = text.replace(letter, f"\\{letter}")
    return text


def pages(found: list[Entry]) -> Mapping[str, str]:
    """A page for each folder with headers, and the index of them, by file name."""
    written: dict[str, str] = {}
    for folder, within in groupby(found, key=lambda one: one.file.rpartition("/")[0]):
        lines = [f"# {folder}\n"]
        for file, items in groupby(within, key=lambda one: one.file):
            lines.append(f"## {file.rpartition('/')[2]}\n")
            rows = list(items)
            about = next((one for one in rows if one.kind == "file"), None)
            if about:
                lines.append(f"{escaped(about.brief)} [Includes and sources](doxygen:{about.page})\n")
            rows = [one for one in rows if one.kind != "file" and one.brief]
            if rows:
                lines += ["| item | kind | |", "| --- | --- | --- |"]
            for one in rows:
                lines.append(
                    f"| [{escaped(one.name)}](doxygen:{one.page}) | {one.kind} | {escaped(one.brief)} |"
                )
            lines.append("")
        written[f"{folder.replace('/', '-')}.md"] = "\n".join(lines)
    listed = "\n".join(name.removesuffix(".md") for name in written)
    head = "# Code\n\nKernel and app by folder, with call and include graphs of this commit.\n\n"
    written["index.md"] = f"{head}```{{toctree}}\n:maxdepth: 1\n\n{listed}\n```\n"
    return written
