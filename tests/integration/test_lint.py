"""The check of naming and bugs: it finds what it is shown, and does not pass where it checked nothing."""

import json
import os
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
        self._reads = path / "reads"
        self.write(
            "bin/clang-tidy-19", f'#!/bin/sh\necho "$@" >>{self._reads}\nexec /usr/bin/clang-tidy-19 "$@"\n'
        )
        (path / "bin/clang-tidy-19").chmod(0o755)

    def add(self, name: str, text: str) -> None:
        self.write(name, text)
        command = f"c++ -std=c++20 -o {name}.o -c {name}"
        self._compiled.append({"directory": str(self._path), "file": name, "command": command})

    def write(self, name: str, text: str) -> None:
        (self._path / name).parent.mkdir(exist_ok=True)
        (self._path / name).write_text(text, "utf-8")

    def build(self) -> None:
        """Compiles by ninja, which records what each object was compiled from."""
        command = "c++ -std=c++20 -MD -MF $out.d -o $out -c $in"
        rule = f"rule cc\n command = {command}\n depfile = $out.d\n deps = gcc\n"
        files = [one["file"] for one in self._compiled]
        self.write("build.ninja", rule + "".join(f"build {file}.o: cc {file}\n" for file in files))
        subprocess.run(["ninja", "--quiet"], cwd=self._path, check=True)

    def check(self, files: str = "/app/", **environment: str) -> subprocess.CompletedProcess[str]:
        self.write("compile_commands.json", json.dumps(self._compiled))
        inherited = {name: value for name, value in os.environ.items() if name != "FRESH"}
        path = f"{self._path}/bin:{os.environ['PATH']}"
        return subprocess.run(
            [ROOT / "verification/toolchain/tidy", self._path, files, self._path / "kept"],
            env=inherited | {"PATH": path} | environment,
            capture_output=True,
            text=True,
            check=False,
        )

    def reads(self) -> int:
        """How many units clang-tidy has read since it was asked last."""
        reads = self._reads.read_text("utf-8").count("-quiet")
        self._reads.write_text("", "utf-8")
        return reads

    def keep(self) -> None:
        """Leaves what a fresh clone has: what was found clean, as kept with the sources."""
        (self._path / "clean-units").rename(self._path / "kept")


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


def test_a_clean_unit_is_read_again_when_what_it_includes_changed_or_the_commit_draws_it(
    sources: Sources,
) -> None:
    sources.write("app/area.hpp", "extern int area_mm2;\n")
    sources.add("app/shapes.cpp", '#include "area.hpp"\n')
    sources.add("app/names.cpp", WELL_NAMED)
    sources.build()
    assert (sources.check().returncode, sources.reads()) == (0, 2)
    assert (sources.check().returncode, sources.reads()) == (0, 0)
    sources.keep()
    assert (sources.check().returncode, sources.reads()) == (0, 1)
    assert (sources.check(FRESH="1").returncode, sources.reads()) == (0, 2)
    sources.write("app/area.hpp", "extern int AreaMm2;\n")
    sources.build()
    done = sources.check()
    assert (done.returncode, sources.reads()) == (1, 1)
    assert "app/area.hpp:1:12: error: invalid case style for variable 'AreaMm2'" in done.stdout
    assert (sources.check().returncode, sources.reads()) == (1, 1)


def test_a_unit_without_a_record_of_what_it_includes_is_read_each_time(sources: Sources) -> None:
    sources.add("app/shapes.cpp", WELL_NAMED)
    assert [(sources.check().returncode, sources.reads()) for _ in range(2)] == [(0, 1), (0, 1)]
