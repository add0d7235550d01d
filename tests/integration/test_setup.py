"""Set-up: without root it changes nothing and says what is missing; each release gets its own packages."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
NOBODY = 65534


class Machine:
    """A folder with the toolchain, and a machine around it on which no package is installed."""

    def __init__(self, path: Path) -> None:
        self._path = path
        shutil.copytree(ROOT / "verification/toolchain", path / "verification/toolchain")
        self._release = path / "os-release"
        (path / "bin").mkdir()
        for program, does in {"dpkg-query": "exit 0", "sudo": "exit 1"}.items():
            (path / "bin" / program).write_text(f"#!/bin/sh\n{does}\n", "utf-8")
            (path / "bin" / program).chmod(0o755)

    def set_up(self, *sets: str, release: str = "debian 12") -> subprocess.CompletedProcess:
        """Runs set-up as a user who is neither root nor may become it."""
        name, version = release.split()
        self._release.write_text(f'ID={name}\nVERSION_ID="{version}"\n', "utf-8")
        environment = os.environ | {
            "PATH": f"{self._path}/bin:/usr/bin:/bin",
            "OS_RELEASE": str(self._release),
        }
        self._path.chmod(0o755)
        as_user = ["setpriv", f"--reuid={NOBODY}", "--clear-groups"] if os.geteuid() == 0 else []
        before = sorted(self._path.rglob("*"))
        done = subprocess.run(
            [*as_user, self._path / "verification/toolchain/setup", *sets],
            env=environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
        )
        assert sorted(self._path.rglob("*")) == before, "nothing is changed"
        return done


@pytest.fixture
def machine(short_tmp_path: Path) -> Machine:
    short_tmp_path.chmod(0o755)
    return Machine(short_tmp_path / "tree")


def packages(done: subprocess.CompletedProcess) -> set[str]:
    """The packages of the command that set-up prints."""
    command = re.search(r"apt-get update && apt-get install -qq --no-install-recommends (.+)", done.stderr)
    assert command, done.stderr
    return set(command[1].split())


def test_without_root_the_command_is_printed_and_nothing_is_changed(machine: Machine) -> None:
    done = machine.set_up("run")
    assert done.returncode == 1
    assert done.stdout == ""
    assert "neither root nor sudo" in done.stderr
    assert {"g++", "cmake", "libsodium-dev"} <= packages(done)


def test_running_needs_no_browser_no_provers_no_tests_and_no_fonts(machine: Machine) -> None:
    assert not [
        name
        for name in packages(machine.set_up("run"))
        if re.search(r"chromium|qemu|fonts|gtest|gmock|doxygen|clang-tidy|valgrind", name)
    ]


def test_every_set_brings_those_that_it_rests_on(machine: Machine) -> None:
    run, test = packages(machine.set_up("run")), packages(machine.set_up("test"))
    assert run < test
    for name in ("lint", "docs", "bench", "provers"):
        assert test < packages(machine.set_up(name))


@pytest.mark.parametrize(
    ("release", "boost"), [("debian 12", "libboost1.81-dev"), ("debian 13", "libboost1.83-dev")]
)
def test_each_release_gets_the_packages_that_it_has(machine: Machine, release: str, boost: str) -> None:
    named = packages(machine.set_up("run", release=release))
    assert [name for name in named if name.startswith("libboost")] == [boost]


@pytest.mark.parametrize("release", ["debian 11", "ubuntu 24.04"])
def test_another_system_is_named_with_what_is_expected(machine: Machine, release: str) -> None:
    done = machine.set_up("run", release=release)
    assert done.returncode == 1
    assert done.stderr == (
        f"setup: this is {release}; expected Debian 12 or 13, whose packages "
        "verification/toolchain/packages.txt names. Nothing was changed.\n"
    )


def test_an_unknown_set_is_named_with_those_that_there_are(machine: Machine) -> None:
    done = machine.set_up("run", "provres")
    assert done.returncode == 2
    assert "no set 'provres'; expected run, test, lint, docs, bench or provers" in done.stderr
