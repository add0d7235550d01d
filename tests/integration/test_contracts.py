"""The rung of contracts: what a script of WP can do, and what it cannot."""

import sys
from pathlib import Path

import pytest
from bare_kernel import ROOT

sys.path.append(str(ROOT / "verification/mutation"))
sys.path.append(str(ROOT / "verification/frama-c"))

import scripts
from probes import contract_probe
from tree import make_tree, seeded

LOG = """\
[wp] [Qed] Goal typed_f_ensures_a : Valid (4ms)
[wp] [Z3 4.8.12] Goal typed_f_ensures_b : Valid (Qed:11ms) (210ms) (84942)
[wp] [CVC4 1.8] Goal typed_f_ensures_c : Valid (Qed:22ms) (90ms) (32368)
[wp] [Failed] Goal typed_f_ensures_d
[wp] [Z3 4.8.12] Goal typed_f_ensures_d : Valid (Qed:20ms) (7.5s) (17104264)
[wp] [Script] Goal typed_f_ensures_e : Valid
[wp] [Failed] Goal typed_f_ensures_g
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(scripts, "FOLDER", tmp_path)
    return tmp_path


def test_scripts_are_kept_for_the_goals_that_the_first_prover_does_not_find_soon(folder: Path) -> None:
    for name in ("b", "e"):
        (folder / f"typed_f_ensures_{name}.json").write_text("[]\n")
    scripts.keep(LOG, "z3", 5.0)
    assert sorted(script.stem[-1] for script in folder.glob("*.json")) == ["c", "d", "e"]
    assert (folder / "typed_f_ensures_d.json").read_text() == (
        '[{"prover": "Z3:4.8.12", "verdict": "valid", "time": 7.5, "steps": 17104264}]\n'
    )


def test_a_script_whose_goal_is_gone_is_idle(folder: Path) -> None:
    for name in ("typed_f_ensures_e", "typed_old_ensures_x"):
        (folder / f"{name}.json").write_text("[]\n")
    assert scripts.idle([LOG]) == ["typed_old_ensures_x"]


@pytest.mark.provers
def test_a_script_convinces_nobody_of_a_goal_that_is_false(tmp_path: Path) -> None:
    assert (scripts.FOLDER / "typed_frequency_word_ensures_P16_speed.json").exists()
    tree = make_tree(tmp_path / "tree")
    source = (ROOT / "kernel/src/frame.c").read_text().splitlines()
    sound = "(drive < faster) ? drive : faster"
    line = 1 + next(number for number, text in enumerate(source) if sound in text)
    with seeded(tree, "kernel/src/frame.c", line, source[line - 1], source[line - 1].replace("<", ">")):
        caught = contract_probe("frame.c", "frequency_word").catch(tree)
    assert caught.startswith("NOT PROVED frame.c")
    assert "frequency_word" in caught
