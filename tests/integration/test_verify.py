"""Checks and their evidence: what passes, what is run again, and what is kept with the sources."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "verification/evidence"))
from expected import read_checks
from tlc_command import tlc_command

ROOT = Path(__file__).resolve().parents[2]
EVIDENCE = ROOT / "verification/evidence"

RUNG = """\
import sys, time
sys.path.insert(0, "verification/evidence")
import evidence
with (evidence.EVIDENCE / "runs").open("a") as runs:
    runs.write("proof ")
print("what the tool said")
{more}
figures = {{"goals": {goals}}}
sys.exit(evidence.write("proof", "{status}", {{"prover": "1.0"}}, figures, ["P1"], time.monotonic()))
"""
EXPECTED = """\
[proof]
title = "A proof"
target = "make verify"
command = "python3 verification/proof/run.py"
inputs = ["verification/proof/*", "kernel/src/*"]
tools = ["prover"]
[proof.figures]
goals = 7
"""
CAMPAIGN = """\
[campaign]
title = "Faults"
target = "make campaign"
demanded = "release"
inputs = ["kernel/src/*"]
least = { faults = 3 }
"""


class Tree:
    """A small project with one rung, and a prover of its own."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.evidence = path / "build/evidence/proof.json"
        self.kept = path / "verification/evidence/kept"
        ignored = shutil.ignore_patterns("__pycache__", "kept")
        shutil.copytree(EVIDENCE, path / "verification/evidence", ignore=ignored)
        self.write("verification/expected.toml", EXPECTED)
        self.write("kernel/src/step.c", "int step;\n")
        self.write(".gitignore", "/build/\n__pycache__/\n")
        self.prover("1.0")
        self.rung("PASSED", 7)
        self.git("init", "-q")
        self.commit()

    def write(self, name: str, text: str) -> None:
        (self.path / name).parent.mkdir(parents=True, exist_ok=True)
        (self.path / name).write_text(text, "utf-8")

    def prover(self, version: str) -> None:
        self.write("build/provers/bin/prover", f"#!/bin/sh\necho {version}\n")
        (self.path / "build/provers/bin/prover").chmod(0o755)

    def git(self, *arguments: str) -> None:
        command = ["git", "-c", "user.name=a", "-c", "user.email=b", *arguments]
        subprocess.run(command, cwd=self.path, check=True, capture_output=True)

    def commit(self) -> None:
        self.git("add", ".")
        self.git("commit", "-qm", "tree", "--allow-empty")

    def rung(self, status: str, goals: int, more: str = "") -> None:
        self.write("verification/proof/run.py", RUNG.format(status=status, goals=goals, more=more))

    def run(self, program: str, *arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, str(self.path / "verification/evidence" / program), *arguments]
        inherited = {name: value for name, value in os.environ.items() if name != "FRESH"}
        return subprocess.run(
            command, cwd=self.path, env=inherited | environment, capture_output=True, text=True, check=False
        )

    def verify(self, *arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
        return self.run("verify.py", *arguments, **environment)

    def keep(self, action: str = "keep") -> str:
        done = self.run("keep.py", action)
        assert done.returncode == 0, done.stderr
        return done.stdout

    def keep_in_a_fresh_clone(self) -> None:
        """What a clone finds whose sources have the evidence of the rung."""
        self.verify()
        assert "proof: kept\n" in self.keep()
        self.commit()
        shutil.rmtree(self.path / "build/evidence")

    def runs(self) -> int:
        runs = self.path / "build/evidence/runs"
        return len(runs.read_text("utf-8").split()) if runs.exists() else 0


@pytest.fixture
def tree(tmp_path: Path) -> Tree:
    return Tree(tmp_path)


def test_a_rung_with_its_expected_status_and_figures_passes(tree: Tree) -> None:
    done = tree.verify()
    assert done.returncode == 0, done.stdout + done.stderr
    assert "goals=7" in done.stdout
    assert "1 of 1 checks as expected" in done.stdout
    assert '<testcase classname="verify" name="proof"' in (tree.path / "build/reports/verify.xml").read_text()


@pytest.mark.parametrize(
    ("status", "goals", "fault"),
    [
        ("PASSED", 6, "goals 6, expected 7"),
        ("PASSED", 8, "goals 8, expected 7"),
        ("BOUNDED", 7, "status BOUNDED, expected PASSED"),
        ("VACUOUS", 7, "status VACUOUS, expected PASSED"),
        ("FAILED", 7, "status FAILED, expected PASSED"),
    ],
)
def test_a_rung_that_shows_anything_else_fails_and_says_what(
    tree: Tree, status: str, goals: int, fault: str
) -> None:
    tree.rung(status, goals)
    done = tree.verify()
    assert done.returncode == 1
    assert fault in done.stdout
    assert "what the tool said" in done.stdout


def test_a_failure_is_shown_in_the_rungs_own_words_however_long_its_log(tree: Tree) -> None:
    tell = 'failures = evidence.Failures("proof")\nfailures.tell("P1_gate broken\\n  tick 1: pedal RELEASED")'
    tree.rung("FAILED", 7, f"{tell}\nprint('noise\\n' * 1000)")
    done = tree.verify()
    shown = done.stdout.split("--- proof: what it found wrong")[1]
    assert "P1_gate broken\n  tick 1: pedal RELEASED\n" in shown
    assert "noise" not in shown
    assert (tree.path / "build/evidence/proof/failures.txt").is_file()


def test_failures_are_shown_within_a_bound_and_never_those_of_an_earlier_run(tree: Tree) -> None:
    many = 'evidence.Failures("proof").tell("\\n".join(f"row {row} differs" for row in range(2000)))'
    tree.rung("FAILED", 7, many)
    done = tree.verify()
    assert "row 499 differs" in done.stdout
    assert "row 500 differs" not in done.stdout
    assert "... 1500 more lines in build/evidence/proof/failures.txt" in done.stdout
    tree.write("verification/proof/run.py", "raise SystemExit('out of memory')\n")
    done = tree.verify()
    assert "differs" not in done.stdout
    assert "out of memory" in done.stdout


def test_the_table_stands_whole_at_the_end(tree: Tree) -> None:
    second = EXPECTED.replace("[proof", "[second").replace("proof/run.py", "proof/second.py")
    tree.write("verification/expected.toml", EXPECTED + second)
    text = RUNG.format(status="FAILED", goals=6, more="")
    tree.write("verification/proof/second.py", text.replace('write("proof"', 'write("second"'))
    done = tree.verify()
    table = done.stdout[done.stdout.index("check  ") :].splitlines()
    assert [line.split()[:2] for line in table[1:3]] == [["proof", "PASSED"], ["second", "FAILED"]]
    assert all("goals=" in line and line.endswith("prover 1.0") for line in table[1:3])
    assert "status FAILED, expected PASSED" in table[3]
    assert table[-1].startswith("1 of 2 checks as expected in ")
    assert "what the tool said" not in "\n".join(table)


def test_evidence_of_an_earlier_run_does_not_stand_in_for_a_rung_that_dies(tree: Tree) -> None:
    assert tree.verify().returncode == 0
    tree.write("verification/proof/run.py", "raise SystemExit(0)\n")
    done = tree.verify()
    assert done.returncode == 1
    assert "left no evidence" in done.stdout


def test_a_rung_runs_again_only_when_an_input_or_tool_changed_or_fresh_asks(tree: Tree) -> None:
    tree.verify()
    tree.write("README.md", "no input\n")
    tree.verify()
    assert tree.runs() == 1
    tree.write("kernel/src/step.c", "int step = 1;\n")
    tree.verify()
    assert tree.runs() == 2
    tree.prover("1.1")
    tree.verify()
    assert tree.runs() == 3
    tree.verify("--fresh")
    assert tree.runs() == 4


def test_a_rung_whose_tool_is_missing_fails_without_a_run_and_names_the_tool(tree: Tree) -> None:
    (tree.path / "build/provers/bin/prover").unlink()
    done = tree.verify()
    assert done.returncode == 1
    assert "this machine has no prover" in done.stdout
    assert tree.runs() == 0


def test_a_changed_expectation_is_held_against_the_rung_itself(tree: Tree) -> None:
    tree.verify()
    tree.write("verification/expected.toml", EXPECTED.replace("goals = 7", "goals = 8"))
    assert "goals 7, expected 8" in tree.verify().stdout


def test_a_rung_cannot_read_what_is_not_among_its_inputs(tree: Tree) -> None:
    tree.write("kernel/include/kernel.h", "\n")
    tree.rung("PASSED", 7, 'open("kernel/src/step.c").close(); open("kernel/include/kernel.h").close()')
    done = tree.verify()
    assert done.returncode == 1
    assert "No such file or directory: 'kernel/include/kernel.h'" in done.stdout


def test_the_key_of_a_rung_is_the_same_in_another_folder(tree: Tree, tmp_path: Path) -> None:
    tree.verify()
    tree.git("clone", "-q", ".", str(tmp_path / "clone"))
    shutil.copytree(tree.path / "build", tmp_path / "clone/build", symlinks=True)
    done = tree.run("../../clone/verification/evidence/verify.py")
    assert "(kept)" in done.stdout


def test_a_failed_rung_is_never_kept(tree: Tree) -> None:
    tree.rung("PASSED", 6)
    tree.verify()
    tree.verify()
    assert tree.runs() == 2


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("goals = 7", "goals = 7\n[other]"), "[other]: keys missing or unknown: inputs, target, title"),
        (("tools", 'status = "FINE"\ntools'), "status 'FINE'; expected one of PASSED"),
        (("tools", 'after = ["later"]\ntools'), "after 'later'; expected one of"),
        (("kernel/src/*", "kernel/nowhere/*"), "no file matches the input 'kernel/nowhere/*'"),
    ],
)
def test_an_expectation_that_cannot_be_used_is_refused_by_name(
    tree: Tree, change: tuple[str, str], message: str
) -> None:
    tree.write("verification/expected.toml", EXPECTED.replace(*change))
    done = tree.verify()
    assert done.returncode == 2
    assert message in done.stderr
    assert tree.runs() == 0


def test_a_rung_waits_for_those_whose_files_it_reads(tree: Tree) -> None:
    second = EXPECTED.replace("[proof", "[reader").replace("proof/run.py", "proof/reader.py")
    second = second.replace("tools", 'after = ["proof"]\ntools')
    tree.write("verification/expected.toml", EXPECTED + second)
    tree.rung("PASSED", 7, 'time.sleep(0.5); (evidence.EVIDENCE / "left").touch()')
    text = RUNG.format(status="PASSED", goals=7, more='(evidence.EVIDENCE / "left").read_text()')
    tree.write("verification/proof/reader.py", text.replace('write("proof"', 'write("reader"'))
    done = tree.verify("--fresh", JOBS="2")
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_rung_that_there_is_not_is_refused_with_those_that_there_are(tree: Tree) -> None:
    done = tree.verify("prof")
    assert done.returncode == 2
    assert "no check 'prof'; expected one of proof" in done.stderr


def test_what_is_kept_with_the_sources_stands_for_a_run_but_for_the_one_that_the_commit_draws(
    tree: Tree,
) -> None:
    other = EXPECTED.replace("[proof", "[other").replace("proof/run.py", "proof/other.py")
    tree.write("verification/expected.toml", EXPECTED + other)
    text = RUNG.format(status="PASSED", goals=7, more="").replace("proof ", "other ")
    tree.write("verification/proof/other.py", text.replace('write("proof"', 'write("other"'))
    tree.commit()
    tree.keep_in_a_fresh_clone()
    drawn = set()
    while drawn < {"proof ", "other "}:
        done = tree.verify()
        assert done.returncode == 0, done.stdout + done.stderr
        assert (done.stdout.count("(drawn)"), done.stdout.count("(kept)")) == (2, 2)
        drawn.add((tree.path / "build/evidence/runs").read_text("utf-8"))
        # What was repeated for this commit is not repeated for it again.
        assert "(drawn)" not in tree.verify().stdout
        shutil.rmtree(tree.path / "build/evidence")
        tree.commit()


def test_a_drawn_rung_that_differs_from_what_is_kept_fails(tree: Tree) -> None:
    tree.keep_in_a_fresh_clone()
    tree.write("build/provers/luck", "")
    tree.rung("PASSED", 7, 'goals = 6 if open("build/provers/luck").read() else 7')
    text = (
        (tree.path / "verification/proof/run.py").read_text("utf-8").replace('"goals": 7', '"goals": goals')
    )
    tree.write("verification/proof/run.py", text)
    tree.commit()
    tree.keep_in_a_fresh_clone()
    tree.write("build/provers/luck", "out")
    done = tree.verify()
    assert done.returncode == 1
    assert "goals 6, expected 7" in done.stdout
    assert "differs from what is kept, made of " in done.stdout


def test_evidence_is_keyed_by_its_inputs_unless_they_change_while_it_is_made(tree: Tree) -> None:
    tree.write("verification/expected.toml", CAMPAIGN)
    campaign = tree.path / "build/evidence/campaign.json"
    campaign.parent.mkdir()

    def key(script: str, code: int = 0) -> str | None:
        assert tree.run("measure.py", "campaign", "sh", "-c", script).returncode == code
        return json.loads(campaign.read_text("utf-8")).get("key") if campaign.exists() else None

    first = key("echo {} > build/evidence/campaign.json; exit 3", 3)
    assert first is not None
    assert key("echo {} > build/evidence/campaign.json; echo 13 > kernel/src/step.c") is None
    assert key("echo {} > build/evidence/campaign.json") not in (None, first)
    assert key("true") is None
    assert not campaign.exists()


def test_each_check_names_inputs_that_there_are_and_a_target() -> None:
    targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text("utf-8"), re.MULTILINE))
    for check in read_checks():
        assert check.key()
        assert check.target.removeprefix("make ") in targets


def test_kept_evidence_comes_back_as_it_was_with_its_log(tree: Tree) -> None:
    def made() -> list[bytes]:
        return [path.read_bytes() for path in (tree.evidence, tree.path / "build/evidence/proof/run.log")]

    tree.verify()
    first = made()
    tree.keep_in_a_fresh_clone()
    assert "as kept with the sources" in tree.keep("restore")
    assert made() == first


def test_kept_evidence_does_not_come_back_for_other_inputs(tree: Tree) -> None:
    tree.keep_in_a_fresh_clone()
    tree.write("kernel/src/step.c", "13")
    assert "not kept for these inputs" in tree.keep("restore")
    assert not tree.evidence.exists()


def test_what_was_made_here_is_not_replaced_by_what_was_kept(tree: Tree) -> None:
    tree.keep_in_a_fresh_clone()
    tree.verify()
    document = json.loads(tree.evidence.read_text("utf-8")) | {"status": "FAILED"}
    tree.evidence.write_text(json.dumps(document), "utf-8")
    assert "made here" in tree.keep("restore")
    assert json.loads(tree.evidence.read_text("utf-8"))["status"] == "FAILED"


def test_only_evidence_as_expected_and_of_a_commit_is_kept(tree: Tree) -> None:
    assert "no evidence of these inputs" in tree.keep()
    for status, goals, why in (("FAILED", 7, "its status is FAILED"), ("PASSED", 6, "goals 6, expected 7")):
        tree.rung(status, goals)
        tree.commit()
        tree.verify()
        assert why in tree.keep()
    tree.rung("PASSED", 7)
    tree.verify()
    assert "with changes beside its commit" in tree.keep()
    tree.commit()
    tree.verify("--fresh")
    (tree.path / "build/evidence/proof/run.log").unlink()
    assert "its log, proof, has no text" in tree.keep()
    assert not tree.kept.exists()


def test_a_run_that_is_too_short_is_not_kept(tree: Tree) -> None:
    tree.write("verification/expected.toml", CAMPAIGN)
    tree.commit()
    document = '{"status": "PASSED", "commit": "1", "figures": {"faults": 2}}'
    (tree.path / "build/evidence").mkdir()
    tree.run("measure.py", "campaign", "sh", "-c", f"echo '{document}' > build/evidence/campaign.json")
    assert "faults 2, at least 3" in tree.keep()


def test_logs_that_are_too_large_are_not_kept(tree: Tree) -> None:
    tree.rung("PASSED", 7, "import random; print(random.Random(1).randbytes(1_400_000).hex())")
    tree.commit()
    tree.verify()
    assert "at most 1024 KiB" in tree.keep()


def test_kept_evidence_names_nothing_outside_of_its_tree(tree: Tree) -> None:
    tree.rung("PASSED", 7, 'import os; evidence.machine = lambda: f"{os.getcwd()}/build/1.json"')
    tree.commit()
    tree.verify()
    tree.keep()
    assert json.loads((tree.kept / "proof.json").read_text("utf-8"))["machine"] == "build/1.json"


def test_keeping_twice_leaves_the_same_bytes(tree: Tree) -> None:
    tree.verify()
    tree.keep()
    first = {path.name: path.read_bytes() for path in tree.kept.iterdir()}
    (tree.path / "build/evidence/proof/run.log").touch()
    for path in tree.kept.iterdir():
        path.unlink()
    tree.keep()
    assert {path.name: path.read_bytes() for path in tree.kept.iterdir()} == first
    assert "kept already" in tree.keep()


def test_kept_logs_that_cannot_be_read_end_with_what_is_wrong(tree: Tree) -> None:
    tree.keep_in_a_fresh_clone()
    (tree.kept / "proof.zip").write_text("no archive", "utf-8")
    done = tree.run("keep.py", "restore")
    assert done.returncode == 2
    assert "kept logs of proof" in done.stderr
    assert not tree.evidence.exists()


def test_searches_side_by_side_unpack_their_standard_modules_apart(tmp_path: Path) -> None:
    places = set()
    for name in ("one", "two"):
        option = "-Djava.io.tmpdir="
        command = tlc_command(tmp_path / name, stack_mb=16)
        places |= {Path(word.removeprefix(option)) for word in command if word.startswith(option)}
    assert len(places) == 2
    assert all(place.is_dir() and tmp_path in place.parents for place in places)
