"""The closing line of CI: every failure counts, and a run without tests is one."""

import subprocess
import sys
from pathlib import Path

SUMMARISE = Path(__file__).resolve().parents[2] / "verification/toolchain/summarise.py"
PASSED = '<testcase name="holds"/>'
FAILED = '<testcase name="breaks"><failure message="no"/></testcase>'
ERROR = '<testcase name="dies"><error message="no"/></testcase>'
SKIPPED = '<testcase name="rests"><skipped/></testcase>'


def summarise(reports: Path, suites: dict[str, str], *broken: str) -> tuple[int, list[str]]:
    for name, cases in suites.items():
        text = f"<testsuites><testsuite>{cases}</testsuite></testsuites>"
        (reports / f"{name}.xml").write_text(text if cases else "")
    command = [sys.executable, SUMMARISE, reports, *suites, "--", *broken]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout.splitlines()


def test_passed_tests_of_all_suites_add_up(tmp_path: Path) -> None:
    code, lines = summarise(tmp_path, {"unit": PASSED * 3 + SKIPPED, "browser": PASSED})
    assert (code, lines[-1]) == (0, "4 passed, 0 failed")


def test_failures_and_errors_fail_the_run(tmp_path: Path) -> None:
    code, lines = summarise(tmp_path, {"unit": PASSED + FAILED + ERROR}, "unit")
    assert (code, lines[-1]) == (1, "1 passed, 2 failed")


def test_a_step_that_broke_beside_its_tests_counts_once(tmp_path: Path) -> None:
    code, lines = summarise(tmp_path, {"unit": PASSED}, "lint", "unit")
    assert (code, lines[-1]) == (1, "1 passed, 2 failed")
    assert "lint: failed as a whole" in lines


def test_a_suite_in_which_no_test_ran_fails(tmp_path: Path) -> None:
    for cases in ("", SKIPPED, " "):
        code, lines = summarise(tmp_path, {"unit": PASSED, "browser": cases})
        assert (code, lines[-1]) == (1, "1 passed, 1 failed")
        assert "browser: no test ran" in lines


def test_a_failed_test_is_named_with_the_first_lines_of_what_it_said(tmp_path: Path) -> None:
    said = "\n".join(["", "expected 1", f"received 2 {'x' * 999}", *(f"line {n}" for n in range(99))])
    case = f'<testcase name="adds up"><failure message="no">{said}</failure></testcase>'
    _, lines = summarise(tmp_path, {"unit": PASSED + case})
    assert lines[:2] == ["unit: FAILED adds up", "    expected 1"]
    assert lines[2].startswith("    received 2 x")
    assert max(map(len, lines)) < 200
    assert len(lines) < 30
