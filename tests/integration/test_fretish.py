"""FRETish: what its grammar takes and refuses, and that the requirements keep it."""

import re
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "verification/trace"))

import fretish

ROOT = Path(__file__).resolve().parents[2]
WRITTEN = [
    line
    for path in sorted((ROOT / "spec/requirements").glob("*.sdoc"))
    for line in re.findall(r"^FRETISH: (.*)$", path.read_text("utf-8"), re.MULTILINE)
]


@pytest.mark.parametrize(
    "text",
    [
        "the kernel shall always satisfy drive <= max_drive",
        "kernel shall satisfy quiet",
        "whenever link_age > 20 the kernel shall immediately satisfy stop_latched",
        "when link_age > 20, the kernel shall within 1 ticks satisfy stop_latched",
        "in stopped mode the kernel shall always satisfy drive_enable = 0",
        "when not in motion mode, if a & (b | !c) => d the kernel shall at the next timepoint satisfy e",
        "before ready mode upon x + 2 - y >= 3 the kernel shall for 12 ticks satisfy (x + 1) < y & true",
        "unless in ready mode the kernel shall until (a) satisfy !(b = 1)",
    ],
)
def test_sentences_of_the_language_are_taken(text: str) -> None:
    fretish.check(text)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "expected a component, found the end"),
        (
            "in locked mode until reset the kernel shall always satisfy x",
            "expected a component, found 'until'",
        ),
        ("whenever mode = LOCKED the kernel shall satisfy x", "expected a quantity, found 'mode'"),
        ("in locked the kernel shall satisfy x", "expected 'mode', found 'the'"),
        ("the kernel must satisfy x", "expected 'shall', found 'must'"),
        ("the kernel shall always", "expected 'satisfy', found the end"),
        ("the kernel shall satisfy", "expected a quantity, found the end"),
        ("the kernel shall soon satisfy x", "expected 'satisfy', found 'soon'"),
        ("the kernel shall within 3 satisfy x", "expected 'ticks', found 'satisfy'"),
        ("the kernel shall within some ticks satisfy x", "expected a number, found 'some'"),
        ("the kernel shall satisfy (x & y", "found"),
        ("the kernel shall satisfy x y", "expected the end, found 'y'"),
        ("the kernel shall satisfy x && y", "expected a quantity, found '&'"),
        ("the kernel shall satisfy x == y", "expected a quantity, found '='"),
        ("the kernel shall satisfy x; y", "';' is no sign of the language"),
    ],
)
def test_other_sentences_are_refused_with_what_was_expected(text: str, said: str) -> None:
    with pytest.raises(fretish.FretishError, match=re.escape(said)):
        fretish.check(text)


def test_every_formal_sentence_of_the_requirements_keeps_the_grammar() -> None:
    assert len(WRITTEN) >= 32
    for text in WRITTEN:
        fretish.check(text)
