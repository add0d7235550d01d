"""The check of naming and bugs: it finds what it is shown, and does not pass where it checked nothing."""

import json
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
WELL_NAMED = "namespace shapes {\nint area_mm2();\n}\n"


class Sources:
    """A folder of sources that a build compiles, under the project's rules."""

    def __init__(self, path: Path) -> None:
        self._path = path
        (path / "app").mkdir()
        shutil.copy(ROOT / ".clang-tidy", path)
        self._compiled = []

    def add(self, name: str, text: str) -> None:
        (self._path / name).write_text(text, "utf-8")
        self._compiled.append(
            {"directory": str(self._path), "file": name, "command": f"c++ -std=c++20 -c {name}"}
        )

    def check(self, files: str = "/app/") -> subprocess.CompletedProcess[str]:
        (self._path / "compile_commands.json").write_text(json.dumps(self._compiled), "utf-8")
        return subprocess.run(
            [ROOT / "verification/toolchain/tidy", self._path, files],
            capture_output=True,
            text=True,
            check=False,
        )


@pytest.fixture
def sources(tmp_path: Path) -> Sources:
    return Sources(tmp_path)


def test_well_named_source_passes(sources: Sources) -> None:
    sources.add("app/shapes.cpp", WELL_NAMED)
    done = sources.check()
    assert (done.returncode, done.stdout) == (0, "")


def test_one_badly_named_source_among_good_ones_fails_and_is_shown(sources: Sources) -> None:
    sources.add("app/shapes.cpp", WELL_NAMED)
    sources.add("app/names.cpp", "int WrongCase;\n")
    done = sources.check()
    assert done.returncode == 1
    assert "app/names.cpp:1:5: error: invalid case style for variable 'WrongCase'" in done.stdout


def test_source_that_clang_does_not_compile_fails(sources: Sources) -> None:
    sources.add("app/shapes.cpp", "int area_mm2() { return side_mm; }\n")
    done = sources.check()
    assert done.returncode == 1
    assert "use of undeclared identifier 'side_mm'" in done.stdout


def test_nothing_to_check_fails(sources: Sources) -> None:
    sources.add("app/shapes.cpp", WELL_NAMED)
    done = sources.check("/kernel/")
    assert done.returncode == 1
    assert "no file of" in done.stdout


def test_build_that_was_not_configured_fails(tmp_path: Path) -> None:
    done = subprocess.run(
        [ROOT / "verification/toolchain/tidy", tmp_path, "/app/"], capture_output=True, text=True, check=False
    )
    assert done.returncode == 1
    assert "compil" in done.stdout
