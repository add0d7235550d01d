"""The documentation site: what may stand in it, and that nothing is left out without a word."""

import re
import sys
import tomllib
from dataclasses import replace
from pathlib import Path

import pytest
import yaml

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "docs/site"))

import code_pages
import documented
import http_page
from deviations_page import deviations_page
from http_page import cell
from pictures_page import CAPTIONS, PictureError, pictures_page
from report_copy import copy_report
from staging import Staging

import build

ROOT = Path(__file__).resolve().parents[2]
CLASS = code_pages.Entry("app/a/b.hpp", 9, "class", "interlock::B", "", "", "class_b.html")
FUNCTION = code_pages.Entry(
    "app/a/b.hpp", 12, "function", "interlock::B::act", "(int n)", "", "class_b.html#1"
)
FIELD = code_pages.Entry("app/a/b.hpp", 14, "variable", "interlock::B::speed_mm_s", "", "", "class_b.html#2")


def named(found: list[str]) -> list[str]:
    return [line.split()[2] for line in found]


def test_public_function_and_type_without_a_word_are_refused() -> None:
    other = replace(CLASS, name="interlock::C", page="class_c.html")
    assert named(documented.undocumented([CLASS, other, FUNCTION])) == [
        "interlock::B",
        "interlock::C",
        "interlock::B::act",
    ]
    assert documented.undocumented([replace(one, brief="Said.") for one in (CLASS, other, FUNCTION)]) == []


def test_the_file_speaks_for_its_only_type_and_for_no_other_item() -> None:
    assert named(documented.undocumented([CLASS, FUNCTION])) == ["interlock::B::act"]


@pytest.mark.parametrize(
    ("name", "arguments", "one_line"),
    [
        ("interlock::B::B", "(int n)", False),
        ("interlock::B::~B", "()", False),
        ("interlock::B::operator==", "(const B &) const =default", False),
        ("interlock::B::size", "() const noexcept", True),
    ],
)
def test_names_that_say_it_themselves_need_no_word(name: str, arguments: str, one_line: bool) -> None:
    entry = replace(FUNCTION, name=name, arguments=arguments, is_one_line=one_line)
    assert documented.undocumented([replace(CLASS, brief="Said."), entry]) == []


def test_a_field_needs_a_word_in_the_kernels_interface_alone() -> None:
    assert documented.undocumented([replace(CLASS, brief="Said."), FIELD]) == []
    field = replace(FIELD, file="kernel/include/interlock/types.h")
    assert named(documented.undocumented([field])) == ["interlock::B::speed_mm_s"]


def test_a_link_leads_to_the_copy_of_what_it_names(tmp_path: Path) -> None:
    tree, site = tmp_path / "tree", tmp_path / "site"
    for folder in ("docs/decisions", "spec"):
        (tree / folder).mkdir(parents=True)
    (tree / "spec/x.toml").write_text("a = 1\n")
    (tree / "docs/other.md").write_text("# Other\n")
    (tree / "docs/decisions/1.md").write_text("[up](../other.md#part) [file](../../spec/x.toml)\n")
    (tree / "docs/a.md").write_text(
        "[of two\nlines](../spec/x.toml) [all](decisions/) [out](https://example.org)\n```\n[code](../spec/x.toml)\n```\n"
    )
    staging = Staging(tree, site)
    staging.add(Path("docs/a.md"))
    staging.add(Path("docs/decisions/1.md"))
    assert (site / "a.md").read_text() == (
        "[of two\nlines](tree/spec/x.toml) all (`docs/decisions`) [out](https://example.org)\n"
        "```\n[code](../spec/x.toml)\n```\n"
    )
    assert (site / "decisions/1.md").read_text() == "[up](../other.md#part) [file](../tree/spec/x.toml)\n"
    assert (site / "tree/spec/x.toml").read_text() == "a = 1\n"
    assert (site / "other.md").exists()


def test_a_link_to_nothing_stops_the_build(tmp_path: Path) -> None:
    (tmp_path / "docs").mkdir()
    (tmp_path / "docs/a.md").write_text("[gone](gone.md)\n")
    with pytest.raises(FileNotFoundError):
        Staging(tmp_path, tmp_path / "site").add(Path("docs/a.md"))


def test_pages_carry_nothing_that_the_apps_policy_forbids() -> None:
    page = '<script src="a.js"></script><script>run()</script><td style="x">c</td><a onclick="f()">b</a>'
    assert build.without_inline(page) == '<script src="a.js"></script><td>c</td><a>b</a>'


def test_the_report_on_the_site_leads_to_copies_and_nowhere_else(tmp_path: Path) -> None:
    root, site = tmp_path / "tree", tmp_path / "site"
    for folder in ("build/report/papers", "build/report/strictdoc", "kernel", "build/evidence/cbmc"):
        (root / folder).mkdir(parents=True)
    for name in ("kernel/a.c", "build/report/matrix.csv", "build/report/papers/index.html"):
        (root / name).write_text(name)
    (root / "build/report/strictdoc/index.html").write_text("<script>run()</script>")
    (root / "build/report/index.html").write_text(
        '<a href="../../kernel/a.c">code</a><a href="../../build/evidence/cbmc">logs</a>'
        '<a href="matrix.csv">csv</a><a href="index.html#P1">here</a><a href="#P2">below</a>'
        '<a href="papers/index.html">papers</a><a href="strictdoc/index.html">documents</a>'
        '<a href="gone.html">x</a>'
    )
    copy_report(root, site)
    assert (site / "report/index.html").read_text() == (
        '<a href="../tree/kernel/a.c">code</a><a>logs</a>'
        '<a href="matrix.csv">csv</a><a href="index.html#P1">here</a><a href="#P2">below</a>'
        '<a href="papers/index.html">papers</a><a>documents</a><a>x</a>'
    )
    assert (site / "tree/kernel/a.c").read_text() == "kernel/a.c"
    assert (site / "report/papers/index.html").is_file()
    assert not (site / "report/strictdoc").exists()


def test_the_http_reference_has_every_operation_schema_and_word_of_the_stream() -> None:
    document = yaml.safe_load((ROOT / "spec/openapi.yaml").read_text("utf-8"))
    page = http_page.http_page(document)
    for path, item in document["paths"].items():
        for method in set(item) & set(http_page.METHODS):
            assert f"\n## {method.upper()} {path}\n" in page
    schemas = document["components"]["schemas"]
    assert all(f"\n## Schema {name}\n" in page for name in schemas)
    assert set(re.findall(r"\(#schema-(\w+)\)", page)) <= {name.lower() for name in schemas}
    for word in document["components"]["x-stream"]["header"]:
        assert f"`{word['name']}`" in page


def test_every_file_that_doxygen_is_given_is_there() -> None:
    named = re.findall(r"docs/site/\S+", (ROOT / "docs/site/Doxyfile").read_text("utf-8"))
    named = [name for name in named if not name.endswith(".py")]
    assert len(named) == 3
    assert [name for name in named if not (ROOT / name).is_file()] == []


def test_every_document_has_a_place_on_the_site() -> None:
    index = (ROOT / "docs/site/index.md").read_text("utf-8").split()
    assert {path.stem for path in (ROOT / "docs").glob("*.md")} <= set(index)


def test_every_recorded_deviation_is_on_the_site_with_its_reason() -> None:
    text = (ROOT / "verification/misra/deviations.toml").read_text("utf-8")
    page = deviations_page(text)
    for kind, records in tomllib.loads(text).items():
        for record in records:
            row = next(line for line in page.splitlines() if cell(record["reason"]) in line)
            assert row.startswith(f"| {record['rule']} |"), kind
            assert all(file in row for file in record["files"])


def test_each_picture_of_the_console_stands_on_its_page_and_none_is_left_out() -> None:
    kinds = ("light-1280x800", "dark-1280x800", "light-3840x2160", "dark-3840x2160")
    files = [f"{page}-{kind}.png" for page in CAPTIONS for kind in kinds]
    page = pictures_page(files)
    assert [file for file in files if f"(pictures/{file})" not in page] == []
    assert "without them" in pictures_page([])
    with pytest.raises(PictureError, match="new-light"):
        pictures_page([*files, "new-light-1280x800.png"])
    with pytest.raises(PictureError, match="login: no picture dark-1280x800"):
        pictures_page([file for file in files if file != "login-dark-1280x800.png"])


def igtl_source(name: str) -> str:
    return (ROOT / f"app/igtl/{name}.cpp").read_text("utf-8")


IGTL_NAMES = {
    "thesis": r'\{"([a-z_]+)",',
    "crtk": r'"([a-z_]+)"',
    "workphases": r'_name = "([A-Z_]+)"',
    "wpi2024": r'"([A-Z_]{4,})"',
}
"""How each dialect's source writes the names that it takes and sends."""


@pytest.mark.parametrize("dialect", IGTL_NAMES)
def test_the_openigtlink_reference_has_every_name_of_the_dialects_source(dialect: str) -> None:
    told = set(re.findall(r"\w+", (ROOT / "docs/openigtlink.md").read_text("utf-8").lower()))
    names = set(re.findall(IGTL_NAMES[dialect], igtl_source(dialect)))
    assert len(names) > 3
    assert sorted(name for name in names if name.lower() not in told) == []


@pytest.mark.parametrize("dialect", ["thesis", "workphases"])
def test_the_openigtlink_reference_has_every_error_name_of_an_answer(dialect: str) -> None:
    text = (ROOT / "docs/openigtlink.md").read_text("utf-8")
    given = re.findall(r"Status\{.*?;", igtl_source(dialect), re.DOTALL)
    names = {name for status in given for name in re.findall(r'"([A-Z]+)"', status)}
    assert names
    assert sorted(name for name in names if not re.search(rf"^\|.*\b{name}\b", text, re.MULTILINE)) == []


def test_the_openigtlink_reference_names_nothing_that_the_thesis_dialect_does_not_know() -> None:
    text = (ROOT / "docs/openigtlink.md").read_text("utf-8")
    tables = text.partition("## Messages to the robot: thesis")[2].partition("Answers use header version")[0]
    rows = [line.split("|")[1] for line in tables.splitlines() if line.startswith("| ")]
    named = {name for row in rows for name in re.findall(r"\b[A-Za-z]+_[A-Za-z_]+\b", row)}
    sources = (igtl_source("thesis") + igtl_source("crtk")).lower()
    assert len(named) > 20
    assert sorted(name for name in named if f'"{name.lower()}"' not in sources) == []
