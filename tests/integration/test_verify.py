"""The runner of the verification ladder: a rung passes by its exact figures, and by nothing else."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "verification/evidence"))
from tlc_command import tlc_command

EVIDENCE = Path(__file__).resolve().parents[2] / "verification/evidence"

RUNG = """\
import sys, time
sys.path.insert(0, "verification/evidence")
import evidence
with open("build/runs", "a") as runs:
    runs.write("x")
print("what the tool said")
{more}
figures = {{"goals": {goals}}}
sys.exit(evidence.write("proof", "{status}", {{"prover": "1.0"}}, figures, ["P1"], time.monotonic()))
"""
EXPECTED = """\
[rung.proof]
command = "python3 verification/proof/run.py"
inputs = ["verification/proof/*", "kernel/src/*"]
cores = 1
memory_gb = 1
status = "PASSED"
[rung.proof.figures]
goals = 7
"""


class Tree:
    """A small project with one rung."""

    def __init__(self, path: Path) -> None:
        self.path = path
        shutil.copytree(
            EVIDENCE, path / "verification/evidence", ignore=shutil.ignore_patterns("__pycache__")
        )
        self.write("verification/expected.toml", EXPECTED)
        self.write("verification/toolchain/packages.txt", "gcc\n")
        self.write("kernel/include/interlock/kernel.h", "\n")
        self.write("kernel/src/step.c", "int step;\n")
        self.write("build/runs", "")
        self.rung("PASSED", 7)
        for command in ("init -q", "add .", "-c user.name=a -c user.email=b commit -qm tree"):
            subprocess.run(["git", *command.split()], cwd=path, check=True)

    def write(self, name: str, text: str) -> None:
        (self.path / name).parent.mkdir(parents=True, exist_ok=True)
        (self.path / name).write_text(text, "utf-8")

    def rung(self, status: str, goals: int, more: str = "") -> None:
        self.write("verification/proof/run.py", RUNG.format(status=status, goals=goals, more=more))

    def verify(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "verification/evidence/verify.py", *arguments]
        environment = {name: value for name, value in os.environ.items() if name != "FRESH"}
        return subprocess.run(command, cwd=self.path, env=environment, capture_output=True, text=True)

    def runs(self) -> int:
        return len((self.path / "build/runs").read_text("utf-8"))


@pytest.fixture
def tree(tmp_path: Path) -> Tree:
    return Tree(tmp_path)


def test_a_rung_with_its_expected_status_and_figures_passes(tree: Tree) -> None:
    done = tree.verify()
    assert done.returncode == 0, done.stdout + done.stderr
    assert "goals=7" in done.stdout
    summary = json.loads((tree.path / "build/evidence/summary.json").read_text("utf-8"))
    assert summary["passed"] is True
    assert [(rung["id"], rung["faults"]) for rung in summary["rungs"]] == [("proof", [])]


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
    second = EXPECTED.replace("rung.proof", "rung.second").replace("proof/run.py", "proof/second.py")
    tree.write("verification/expected.toml", EXPECTED + second)
    text = RUNG.format(status="FAILED", goals=6, more="")
    tree.write("verification/proof/second.py", text.replace('write("proof"', 'write("second"'))
    done = tree.verify()
    table = done.stdout[done.stdout.index("rung  ") :].splitlines()
    assert [line.split()[:2] for line in table[1:3]] == [["proof", "PASSED"], ["second", "FAILED"]]
    assert all("goals=" in line and line.endswith("prover 1.0") for line in table[1:3])
    assert "status FAILED, expected PASSED" in table[3]
    assert table[-1].startswith("1 of 2 rungs as expected in ")
    assert "what the tool said" not in "\n".join(table)


def test_evidence_of_an_earlier_run_does_not_stand_in_for_a_rung_that_dies(tree: Tree) -> None:
    assert tree.verify().returncode == 0
    tree.write("verification/proof/run.py", "raise SystemExit(0)\n")
    done = tree.verify()
    assert done.returncode == 1
    assert "left no evidence" in done.stdout


def test_a_rung_runs_again_only_when_an_input_or_its_expectation_changed_or_fresh_asks(tree: Tree) -> None:
    tree.verify()
    tree.verify()
    assert tree.runs() == 1
    tree.write("kernel/src/step.c", "int step = 1;\n")
    tree.verify()
    assert tree.runs() == 2
    tree.verify("--fresh")
    assert tree.runs() == 3


def test_a_failed_rung_is_never_kept(tree: Tree) -> None:
    tree.rung("PASSED", 6)
    tree.verify()
    tree.verify()
    assert tree.runs() == 2


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("goals = 7", "goals = 7\n[rung.other]"), "[rung.other]: keys missing or unknown"),
        (("PASSED", "FINE"), "status 'FINE'; expected one of PASSED"),
        (
            ("cores = 1", 'cores = 1\nafter = ["later"]'),
            "after 'later'; expected a rung that stands",
        ),
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
    second = EXPECTED.replace("rung.proof", "rung.reader").replace("proof/run.py", "proof/reader.py")
    tree.write(
        "verification/expected.toml", EXPECTED + second.replace("cores = 1", 'cores = 1\nafter = ["proof"]')
    )
    tree.rung("PASSED", 7, 'time.sleep(0.5); open("build/left", "w").close()')
    text = RUNG.format(status="PASSED", goals=7, more='open("build/left").close()')
    tree.write("verification/proof/reader.py", text.replace('write("proof"', 'write("reader"'))
    environment = os.environ | {"JOBS": "2"}
    command = [sys.executable, "verification/evidence/verify.py", "--fresh"]
    done = subprocess.run(command, cwd=tree.path, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_rung_that_there_is_not_is_refused_with_those_that_there_are(tree: Tree) -> None:
    done = tree.verify("prof")
    assert done.returncode == 2
    assert "no rung 'prof'; expected one of proof" in done.stderr


def test_searches_side_by_side_unpack_their_standard_modules_apart(tmp_path: Path) -> None:
    places = set()
    for name in ("one", "two"):
        option = "-Djava.io.tmpdir="
        command = tlc_command(tmp_path / name, stack_mb=16)
        places |= {Path(word.removeprefix(option)) for word in command if word.startswith(option)}
    assert len(places) == 2
    assert all(place.is_dir() and tmp_path in place.parents for place in places)
