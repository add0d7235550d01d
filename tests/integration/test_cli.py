"""The commands of `interlock` that end by themselves."""

import json
import re
import socket
import struct
import zlib
from pathlib import Path

import pytest
from bare_kernel import ROOT
from conftest import StackFactory
from test_run import DONE, REFUSED, USAGE, interlock

NEURO = ROOT / "models/robots/neuro.toml"
NO_ANSWER = 6


def test_model_check_says_that_a_sound_robot_is_valid() -> None:
    checked = interlock("model", "check", NEURO)
    assert checked.returncode == DONE
    assert re.match(r"neuro: 7 axes, configuration [0-9a-f]{8}, valid\n", checked.stdout)


@pytest.mark.parametrize("robot", sorted((ROOT / "models/robots").glob("*.toml")), ids=lambda path: path.stem)
def test_every_robot_of_the_project_is_valid(robot: Path) -> None:
    assert interlock("model", "check", robot).returncode == DONE


def test_model_check_names_file_line_key_and_what_was_expected(tmp_path: Path) -> None:
    broken = tmp_path / "broken.toml"
    broken.write_text('name = "Neuro"\n')
    checked = interlock("model", "check", broken)
    assert checked.returncode == REFUSED
    assert checked.stderr == (
        f"interlock: {broken}:1: name: 'Neuro' is given; "
        "expected a name of lower-case letters, digits and _, a letter first\n"
    )


def test_model_compile_writes_the_same_sealed_words_each_time(tmp_path: Path) -> None:
    files = [tmp_path / "first.ilkc", tmp_path / "second.ilkc"]
    for file in files:
        assert interlock("model", "compile", NEURO, "-o", file).returncode == DONE
    first, second = (file.read_bytes() for file in files)
    assert first == second
    version, size = struct.unpack_from("<2I", first)
    assert (version, size) == (2, len(first))
    assert struct.unpack("<I", first[-4:])[0] == zlib.crc32(first[:-4])


def test_model_compile_leaves_no_file_of_a_refused_robot(tmp_path: Path) -> None:
    broken = tmp_path / "broken.toml"
    broken.write_text(NEURO.read_text().replace("debounce_ms = 10", "debounce_ms = 51"))
    compiled = interlock("model", "compile", broken, "-o", tmp_path / "neuro.ilkc")
    assert compiled.returncode == REFUSED
    assert "PEDAL_DEBOUNCE" in compiled.stderr
    assert list(tmp_path.iterdir()) == [broken]


def test_version_names_commit_and_configuration() -> None:
    version = interlock("--version", "--robot", "neuro")
    assert version.returncode == DONE
    assert re.fullmatch(
        r"interlock \d+\.\d+\.\d+, commit \S+\nconfiguration [0-9a-f]{8} of neuro\n", version.stdout
    )


def test_status_shows_mode_cause_and_next_step(stack: StackFactory) -> None:
    status = interlock("status", "--port", str(stack().port))
    assert status.returncode == DONE
    assert re.search(r"^Mode +LOCKED: ", status.stdout, re.MULTILINE)
    assert re.search(r"^Cause +BOOT: ", status.stdout, re.MULTILINE)
    assert re.search(r"^ +Next: ", status.stdout, re.MULTILINE)


def test_status_passes_on_the_answer_as_json(stack: StackFactory) -> None:
    status = interlock("status", "--json", "--port", str(stack().port))
    assert status.returncode == DONE
    assert json.loads(status.stdout)["mode"] == "LOCKED"


def test_status_without_an_app_says_so() -> None:
    with socket.socket() as unused:
        unused.bind(("127.0.0.1", 0))
        status = interlock("status", "--port", str(unused.getsockname()[1]))
    assert status.returncode == NO_ANSWER
    assert "Connection refused" in status.stderr


@pytest.mark.parametrize("arguments", [(), ("elbow",), ("model",), ("model", "check"), ("run", "status")])
def test_command_that_is_not_understood_is_a_usage_error(arguments: tuple[str, ...]) -> None:
    assert interlock(*arguments).returncode == USAGE
