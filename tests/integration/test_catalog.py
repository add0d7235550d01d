"""The catalog is complete, and what is generated from it is what is committed."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
GENERATED = (
    "kernel/include/interlock/catalog.h",
    "kernel/host/config_error_text.c",
    "app/robot/catalog.hpp",
    "app/robot/catalog.cpp",
    "web/src/generated/catalog.ts",
    "docs/catalog.md",
)


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    for name in ("spec/catalog.toml", *GENERATED):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    return tmp_path


def generate(root: Path, *options: str) -> subprocess.CompletedProcess[str]:
    generator = ROOT / "spec/generate_catalog.py"
    return subprocess.run(
        [sys.executable, generator, "--root", root, *options], capture_output=True, text=True, check=False
    )


def edit(root: Path, old: str, new: str) -> None:
    path = root / "spec/catalog.toml"
    text = path.read_text("utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), "utf-8")


def test_committed_files_match_the_catalog() -> None:
    checked = generate(ROOT, "--check")
    assert checked.returncode == 0, checked.stderr


@pytest.mark.parametrize("name", GENERATED)
def test_a_stale_file_is_named(tree: Path, name: str) -> None:
    with (tree / name).open("a") as file:
        file.write("edited by hand\n")
    checked = generate(tree, "--check")
    assert checked.returncode == 1
    assert checked.stderr.splitlines() == [
        f"{name}: does not match spec/catalog.toml; run `make generate` and commit it"
    ]


def test_a_missing_file_is_named_and_written_anew(tree: Path) -> None:
    (tree / "docs/catalog.md").unlink()
    assert "docs/catalog.md: does not match" in generate(tree, "--check").stderr
    assert generate(tree).returncode == 0
    assert generate(tree, "--check").returncode == 0


@pytest.mark.parametrize("key", ["meaning", "cause", "next_step", "clears", "properties"])
def test_a_code_for_operators_without_text_is_refused(tree: Path, key: str) -> None:
    path = tree / "spec/catalog.toml"
    before, stall, after = path.read_text("utf-8").partition('name = "STALL"\n')
    lines = [line for line in after.splitlines() if line]
    lines.remove(next(line for line in lines if line.startswith(f"{key} =")))
    path.write_text(before + stall + "\n".join(lines) + "\n", "utf-8")
    for options in ([], ["--check"]):
        refused = generate(tree, *options)
        assert refused.returncode == 1
        assert refused.stderr == f"fault.STALL: lacks '{key}'; write it in spec/catalog.toml\n"


@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        ('number = 1\nname = "LOCKED"', 'number = 0\nname = "LOCKED"', "mode: numbers are [0, 0, 2, 3]"),
        ('number = 1\nname = "LOCKED"', 'number = 7\nname = "LOCKED"', "mode: numbers are [0, 7, 2, 3]"),
        ('number = 1\nname = "LOCKED"', 'number = 1\nname = "INIT"', "mode.INIT: name occurs more than once"),
        ("[family.colour]", "[family.color]", "colour: has codes but no [family.colour] table"),
        ("[family.colour]", "[family.color]", "color: has no code"),
        ("[family.mode]", "[family.mode", "spec/catalog.toml: "),
    ],
)
def test_a_faulty_catalog_is_refused_by_place_and_expectation(
    tree: Path, old: str, new: str, complaint: str
) -> None:
    edit(tree, old, new)
    refused = generate(tree)
    assert refused.returncode == 1
    assert complaint in refused.stderr
    assert "Traceback" not in refused.stderr
