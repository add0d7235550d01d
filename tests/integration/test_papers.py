"""The document set: each paper opens as a PDF with title, contents and page numbers, and has every item."""

import re
import sys
import tomllib
from pathlib import Path

import pytest
from pypdf import PdfReader

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "verification/trace"))

import diagrams
import gate
import item_units
import papers
from items import Items
from report import read_stated
from test_trace import ROOT, Tree, reviewed

CHAPTERS = (
    "DOC-RISK",
    "Requirements",
    "units",
    "methods",
    "results of units",
    "clauses",
    "findings",
    "matrix",
)


@pytest.fixture(scope="module")
def source(tmp_path_factory: pytest.TempPathFactory) -> papers.Source:
    """The clean project of the planted defects."""
    tree = Tree(tmp_path_factory.mktemp("papers"))
    stated: tuple[Items, str] = tree.stated()
    project = tree.project(stated, reviewed(stated[0]))
    of = gate.trace(project)
    documents = papers.read_documents(tree.path / "build/report/stated/json/index.json")
    return papers.Source(of, documents, gate.findings(of), "abcdef0123456789", "9.8.7")


@pytest.fixture(scope="module")
def pages(source: papers.Source, tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """The text of each page of a paper with every kind of chapter."""
    paper = papers.Paper("99-all", "Everything", "5.2", "All of it.", "Nothing.", CHAPTERS)
    [pdf] = papers.write_papers(source, tmp_path_factory.mktemp("out"), [paper])
    return [page.extract_text() for page in PdfReader(pdf).pages]


def test_a_paper_opens_with_title_version_commit_and_what_it_does_not_cover(pages: list[str]) -> None:
    for text in ("Everything", "9.8.7", "abcdef0123456789", "Nothing.", "5.2"):
        assert text in pages[0]


def test_contents_name_the_page_on_which_each_chapter_begins(pages: list[str]) -> None:
    contents = pages[1]
    assert contents.startswith("Contents")
    for title in ("Risk", "Requirements", "Units", "Methods", "Results", "Clauses", "Matrix"):
        [number] = re.findall(rf"^{title}[ .]*?(\d+)$", contents, re.MULTILINE)
        assert title in pages[int(number) - 1]
        assert f"{number} / {len(pages)}" in pages[int(number) - 1]


def test_a_paper_leaves_no_item_function_result_or_clause_out(
    pages: list[str], source: papers.Source
) -> None:
    text = re.sub(r"\s", "", "".join(pages))
    project = source.trace.project
    named = [
        *(item.uid for item in project.items),
        *(one.name for one in project.functions),
        *(one.uid for one in project.results if one.uid.startswith(("TICK", "CBMC", "TLC", "TEST:unit"))),
        *project.clauses,
    ]
    assert [one for one in named if one.replace(" ", "") not in text] == []


def test_every_chapter_of_the_set_is_one_that_there_is() -> None:
    stated = {
        line.removeprefix("UID: ")
        for path in (ROOT / "spec/requirements").glob("*.sdoc")
        for line in path.read_text("utf-8").splitlines()[:4]
        if line.startswith("UID: ")
    }
    told = {name for paper in papers.read_papers() for name in paper.chapters}
    files = {name for name in told if name.endswith(".md")}
    assert told - files - set(papers.TABLES) == stated
    assert all((ROOT / name).is_file() for name in files)
    assert set(papers.TABLES) <= told


def test_headers_of_class_C_are_units_of_the_item_that_names_their_folder(
    tmp_path: Path,
) -> None:
    items, _ = read_stated(ROOT, tmp_path)
    found = item_units.units_by_item(ROOT, items)
    files = {uid: {one.file for one in entries} for uid, entries in found.items()}
    assert "kernel/host/ring_reader.h" in files["IT-LINK"]
    assert "kernel/host/loop.h" in files["IT-HOST"]
    assert "app/control/piv_controller.hpp" in files["IT-MOTION"]
    assert "app/store/audit.hpp" in files["IT-STORE"]
    assert not any(
        one.startswith(("app/recorder", "app/replay")) for names in files.values() for one in names
    )
    folders = {path.relative_to(ROOT).as_posix() for path in (ROOT / "app").iterdir() if path.is_dir()}
    named = {place for item in items.of("ITEM") for place in item_units.folders_of(item.title)}
    assert folders - named == {"app/build_info"}


def test_a_chapter_that_there_is_not_is_refused(source: papers.Source) -> None:
    with pytest.raises(KeyError):
        papers.chapter(source, "DOC-NONE")


def test_edition_2_says_only_what_is_known() -> None:
    clauses = tomllib.loads((ROOT / "spec/requirements/clauses.toml").read_text("utf-8"))
    for clause, entry in clauses.items():
        expected = {"A": None, "B": "rigor level II", "C": "rigor level II"}[entry["class"]]
        assert entry.get("edition_2") == expected, clause


def test_what_follows_from_other_arrows_is_left_out_of_the_diagram() -> None:
    edges = {"cli": {"http", "robot"}, "http": {"robot"}, "robot": set()}
    assert diagrams.reduced(edges) == {"cli": {"http"}, "http": {"robot"}, "robot": set()}
