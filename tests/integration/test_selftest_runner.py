"""The runner of seeded faults itself: it reports noticed faults as such, and nothing else."""

import runpy
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

RUNNER = Path(__file__).resolve().parents[2] / "tests/failure/run.py"
HEADER = """\
# target: pytest
# test: tests/test_limit.py::test_limit_holds
# expect: assert 11 <= 10
# why: the limit is one too high
"""
EFFECTIVE = """\
--- a/app/limit.py
+++ b/app/limit.py
@@ -1 +1 @@
-LIMIT = 10
+LIMIT = 11
"""
INEFFECTIVE = EFFECTIVE.replace("+LIMIT = 11", "+LIMIT = 9")


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """A small source tree with one promise and a test that keeps it."""
    files = {
        "app/limit.py": "LIMIT = 10\n",
        "tests/test_limit.py": (
            "import pathlib\n\n\n"
            "def test_limit_holds() -> None:\n"
            "    assert int(pathlib.Path('app/limit.py').read_text().split()[-1]) <= 10\n"
        ),
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    (tmp_path / "tests/failure").mkdir()
    subprocess.run(["git", "init", "--quiet", tmp_path], check=True)
    return tmp_path


def seed(root: Path, patch: str, name: str = "limit") -> None:
    (root / f"tests/failure/{name}.patch").write_text(patch)


def selftest(root: Path, *options: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, RUNNER, "--root", root, *(options or ["--all"])],
        capture_output=True,
        text=True,
        check=False,
    )


def test_an_effective_fault_is_noticed(root: Path) -> None:
    seed(root, HEADER + EFFECTIVE)
    done = selftest(root)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.endswith("selftest: 1 noticed, 0 failed\n")
    report = ElementTree.parse(root / "build/reports/selftest.xml").getroot()
    assert report.attrib["failures"] == "0"
    assert [case.attrib["name"] for case in report] == ["limit"]


def test_a_check_names_each_patch_that_no_longer_applies(root: Path) -> None:
    seed(root, HEADER + EFFECTIVE)
    assert selftest(root, "--check").returncode == 0
    seed(root, HEADER + EFFECTIVE.replace("-LIMIT = 10", "-LIMIT = 12"), "stale")
    done = selftest(root, "--check")
    assert done.returncode == 1
    assert done.stdout.startswith("stale.patch no longer applies; renew it")
    assert "limit.patch" not in done.stdout


@pytest.mark.parametrize(
    ("patch", "complaint"),
    [
        (HEADER + INEFFECTIVE, "unnoticed: tests/test_limit.py::test_limit_holds passes although the limit"),
        (HEADER + EFFECTIVE.replace("-LIMIT = 10", "-LIMIT = 12"), "the patch no longer applies; renew it"),
        (HEADER.replace("11 <=", "12 <=") + EFFECTIVE, "noticed for another reason; no match of /assert 12"),
        (HEADER.replace("limit_holds", "other") + EFFECTIVE, "the test does not pass without the patch"),
        (HEADER.replace("# why", "# reason") + EFFECTIVE, "header keys missing or unknown: reason, why"),
        (HEADER.replace("expect: ", "expect: (") + EFFECTIVE, "'expect' is no regular expression"),
    ],
)
def test_a_fault_that_is_not_noticed_as_expected_fails(root: Path, patch: str, complaint: str) -> None:
    seed(root, patch)
    done = selftest(root)
    assert done.returncode == 1
    assert complaint in done.stdout
    assert done.stdout.endswith("selftest: 0 noticed, 1 failed\n")
    report = ElementTree.parse(root / "build/reports/selftest.xml").getroot()
    assert report.attrib["failures"] == "1"


def test_the_tree_itself_is_never_patched(root: Path) -> None:
    seed(root, HEADER + EFFECTIVE)
    selftest(root)
    assert (root / "app/limit.py").read_text() == "LIMIT = 10\n"


def test_a_run_without_faults_fails(root: Path) -> None:
    done = selftest(root)
    assert done.returncode == 1
    assert "no fault was seeded" in done.stderr


def test_the_seed_chooses_a_third_and_over_time_every_fault() -> None:
    choose = runpy.run_path(str(RUNNER))["choose"]
    faults = [Path(f"fault-{number}.patch") for number in range(7)]
    assert choose(faults, "one") == choose(faults, "one")
    assert len(choose(faults, "one")) == 3
    assert set(faults) == {fault for seed in range(12) for fault in choose(faults, str(seed))}


def test_of_the_faults_that_were_noticed_before_one_is_seeded_again() -> None:
    choose = runpy.run_path(str(RUNNER))["choose_changed"]
    faults = [Path(f"fault-{number}.patch") for number in range(9)]
    keys = {fault: f"key of {fault}" for fault in faults[:6]}
    known = set(keys.values()) - {keys[faults[0]]}
    chosen = {seed: choose(faults, keys, known, str(seed)) for seed in range(40)}
    assert {(len(set(one) & set(faults[1:6])), len(one)) for one in chosen.values()} == {(1, 3)}
    assert {fault for one in chosen.values() for fault in one} == set(faults)
