"""The long measurements: evidence holds for the inputs that it was made from, here and where it was kept."""

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "verification/measurements"))

from measurements import read_measurements

ROOT = Path(__file__).resolve().parents[2]
MEASURED = """[campaign]
title = "Faults"
target = "make campaign"
demanded = "release"
inputs = ["kernel/src/*"]
least = { faults = 3 }
"""


class Measured:
    """A repository with one measurement, the campaign of gate.c."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.evidence = path / "build/evidence/campaign.json"
        self.log = path / "build/evidence/campaign/run.log"
        self.kept = path / "verification/measurements/kept"
        for name in ("evidence", "measurements"):
            ignored = shutil.ignore_patterns("__pycache__", "*.toml", "kept")
            shutil.copytree(ROOT / "verification" / name, path / "verification" / name, ignore=ignored)
        self.write("verification/measurements/measurements.toml", MEASURED)
        for name in ("verification/toolchain/gcc.txt", "kernel/include/a.h", "kernel/src/gate.c"):
            self.write(name, "12")
        self.write(".gitignore", "/build/\n__pycache__/\n")
        self.evidence.parent.mkdir(parents=True)
        self.git("init", "-q")
        self.commit()

    def write(self, name: str, text: str) -> None:
        (self.path / name).parent.mkdir(parents=True, exist_ok=True)
        (self.path / name).write_text(text, "utf-8")

    def git(self, *arguments: str) -> None:
        command = ["git", "-c", "user.name=a", "-c", "user.email=b", *arguments]
        subprocess.run(command, cwd=self.path, check=True, capture_output=True)

    def commit(self) -> None:
        self.git("add", ".")
        self.git("commit", "-qm", "tree")

    def run(self, program: str, *arguments: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, str(self.path / "verification/measurements" / program), *arguments]
        return subprocess.run(command, cwd=self.path, capture_output=True, text=True, check=False)

    def measure(self, script: str) -> int:
        return self.run("measure.py", "campaign", "sh", "-c", script).returncode

    def campaign(self, status: str = "PASSED", faults: int = 3) -> None:
        """Runs a campaign that notes how it went, as those of the project do."""
        self.write(
            "build/run.py",
            "import sys, time\nsys.path.insert(0, 'verification/evidence')\nimport evidence\n"
            "(evidence.log_directory('campaign') / 'run.log').write_text('three faults')\n"
            f"figures = {{'faults': {faults}}}\n"
            f"evidence.write('campaign', '{status}', {{'gcc': '12'}}, figures, [], time.monotonic())\n",
        )
        assert self.measure(f"{sys.executable} build/run.py") == 0

    def archive(self, action: str) -> str:
        done = self.run("archive.py", action)
        assert done.returncode == 0, done.stderr
        return done.stdout

    def forget(self) -> None:
        shutil.rmtree(self.evidence.parent)


@pytest.fixture
def measured(tmp_path: Path) -> Measured:
    return Measured(tmp_path)


def test_a_measurement_is_keyed_by_its_inputs_unless_they_change_while_it_runs(measured: Measured) -> None:
    key = measured.evidence.with_suffix(".key")
    assert measured.measure("echo {} > build/evidence/campaign.json; exit 3") == 3
    first = key.read_text("utf-8")
    assert measured.measure("echo {} > build/evidence/campaign.json; echo 13 > kernel/src/gate.c") == 0
    assert not key.exists()
    assert measured.measure("echo {} > build/evidence/campaign.json") == 0
    assert key.read_text("utf-8") != first
    assert measured.measure("true") == 0
    assert not key.exists()
    assert not measured.evidence.exists()


def test_each_measurement_names_inputs_that_there_are_and_a_target() -> None:
    targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text("utf-8"), re.MULTILINE))
    for one in read_measurements(ROOT / "verification/measurements/measurements.toml"):
        assert one.key()
        assert one.target.removeprefix("make ") in targets


def test_kept_evidence_comes_back_as_it_was_with_its_log(measured: Measured) -> None:
    measured.campaign()
    assert "campaign: kept\n" in measured.archive("keep")
    made = [
        path.read_bytes() for path in (measured.evidence, measured.evidence.with_suffix(".key"), measured.log)
    ]
    measured.commit()
    measured.forget()
    assert "as kept with the sources" in measured.archive("restore")
    back = [
        path.read_bytes() for path in (measured.evidence, measured.evidence.with_suffix(".key"), measured.log)
    ]
    assert back == made


def test_kept_evidence_does_not_come_back_for_other_inputs(measured: Measured) -> None:
    measured.campaign()
    measured.archive("keep")
    measured.forget()
    measured.write("kernel/src/gate.c", "13")
    assert "not kept for these inputs" in measured.archive("restore")
    assert not measured.evidence.exists()


def test_what_was_measured_here_is_not_replaced_by_what_was_kept(measured: Measured) -> None:
    measured.campaign()
    measured.archive("keep")
    measured.commit()
    measured.campaign("FAILED")
    assert "made here" in measured.archive("restore")
    assert json.loads(measured.evidence.read_text("utf-8"))["status"] == "FAILED"


def test_only_sound_evidence_of_a_commit_and_of_full_length_is_kept(measured: Measured) -> None:
    assert "no evidence of these inputs" in measured.archive("keep")
    measured.campaign("FAILED")
    assert "its status is FAILED" in measured.archive("keep")
    measured.campaign(faults=2)
    assert "faults 2, at least 3" in measured.archive("keep")
    measured.write("README.md", "not committed")
    measured.campaign()
    assert "with changes beside its commit" in measured.archive("keep")
    assert not measured.kept.exists()


def test_evidence_without_a_log_is_not_kept(measured: Measured) -> None:
    measured.campaign()
    measured.log.unlink()
    assert "its log, build/evidence/campaign, holds nothing" in measured.archive("keep")
    assert not measured.kept.exists()


def test_kept_evidence_names_nothing_outside_of_its_tree(measured: Measured) -> None:
    measured.campaign()
    found = json.loads(measured.evidence.read_text("utf-8"))
    found["case"] = f"{measured.path}/build/evidence/1.json"
    measured.evidence.write_text(json.dumps(found), "utf-8")
    measured.archive("keep")
    kept = json.loads((measured.kept / "campaign.json").read_text("utf-8"))
    assert kept["case"] == "build/evidence/1.json"


def test_keeping_twice_leaves_the_same_bytes(measured: Measured) -> None:
    measured.campaign()
    measured.archive("keep")
    first = {path.name: path.read_bytes() for path in measured.kept.iterdir()}
    measured.log.touch()
    for path in measured.kept.iterdir():
        path.unlink()
    measured.archive("keep")
    assert {path.name: path.read_bytes() for path in measured.kept.iterdir()} == first
    assert "kept already" in measured.archive("keep")


def test_kept_logs_that_cannot_be_read_end_with_what_is_wrong(measured: Measured) -> None:
    measured.campaign()
    measured.archive("keep")
    measured.forget()
    (measured.kept / "campaign.zip").write_text("no archive", "utf-8")
    done = measured.run("archive.py", "restore")
    assert done.returncode == 2
    assert "archive: " in done.stderr
    assert not measured.evidence.exists()
