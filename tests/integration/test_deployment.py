"""Interlock as services of a machine: units, package, installation, and what the processes tell systemd."""

import os
import re
import signal
import socket
import subprocess
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest
from bare_kernel import BIN, DEADLINE_S, ROOT, options, stop

UNITS = ROOT / "app/packaging/systemd"
SERVICES = sorted(UNITS.glob("*.service"))
PROGRAMS = (
    "interlock",
    "interlock-app",
    "interlock-kernel",
    "interlock-player",
    "interlock-recorder",
    "interlock-sim",
)
MOST_EXPOSED = 20
"""Of 100, as systemd-analyze counts what a service could still reach."""
WATCHDOG_US = 400_000


def run(*command: str | Path, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [str(part) for part in command],
        capture_output=True,
        text=True,
        env={**os.environ, **environment},
    )


def settings(unit: Path) -> dict[str, list[str]]:
    found: dict[str, list[str]] = {}
    for key, value in re.findall(r"^(\w+)=(.*)$", unit.read_text(), re.MULTILINE):
        found.setdefault(key, []).append(value)
    return found


@pytest.mark.parametrize("unit", SERVICES, ids=lambda unit: unit.stem)
def test_a_unit_is_sound_and_its_program_takes_its_options(unit: Path, short_tmp_path: Path) -> None:
    """With the programs of this build in place of the installed ones."""
    for each in UNITS.iterdir():
        text = re.sub(r"^ExecStart=", f"ExecStart={BIN}/", each.read_text(), flags=re.MULTILINE)
        (short_tmp_path / each.name).write_text(text)
    verified = run(
        "systemd-analyze",
        "verify",
        "--man=no",
        short_tmp_path / unit.name,
        SYSTEMD_UNIT_PATH=f"{short_tmp_path}:",
    )
    assert (verified.returncode, verified.stdout + verified.stderr) == (0, "")
    [command] = settings(unit)["ExecStart"]
    program, *arguments = command.split()
    told = run(BIN / program, "--help").stdout
    wanted = [word for word in arguments if word.startswith("--")]
    assert wanted
    assert [word for word in wanted if not re.search(rf"{word}\b", told)] == []


def calls(program: Path) -> set[str]:
    """Names of the shared functions that a program uses, without their versions."""
    listed = run("readelf", "--wide", "--dyn-syms", program).stdout
    return set(re.findall(r" UND (\w+)", listed))


@pytest.mark.parametrize("name", PROGRAMS)
def test_a_shipped_program_ends_at_a_smashed_stack_or_buffer_and_keeps_its_tables_read_only(
    name: str,
) -> None:
    program = BIN / name
    header = run("readelf", "--wide", "--file-header", "--program-headers", "--dynamic", program).stdout
    assert re.search(r"Type: +DYN \(Position-Independent Executable", header)
    assert re.search(r"GNU_STACK .* RW +0x", header)
    assert "GNU_RELRO" in header
    assert re.search(r"FLAGS.*BIND_NOW", header)
    assert "__stack_chk_fail" in calls(program)
    assert {name for name in calls(program) if re.fullmatch(r"__\w+_chk", name)}


@pytest.mark.parametrize("name", PROGRAMS)
def test_a_shipped_program_does_not_name_the_folder_in_which_it_was_built(name: str) -> None:
    assert os.fsencode(ROOT) not in (BIN / name).read_bytes()


@pytest.mark.parametrize("name", sorted({*PROGRAMS} - {"interlock-kernel"}))
def test_a_shipped_program_ends_at_an_index_past_the_end(name: str) -> None:
    assert "_ZSt21__glibcxx_assert_failPKciS0_S0_" in calls(BIN / name)


@pytest.mark.parametrize("unit", SERVICES, ids=lambda unit: unit.stem)
def test_a_service_can_reach_little_of_the_system(unit: Path) -> None:
    judged = run("systemd-analyze", "security", "--offline=yes", f"--threshold={MOST_EXPOSED}", unit)
    assert judged.returncode == 0, judged.stdout[-200:] + judged.stderr


def test_only_the_kernel_has_devices_and_real_time_and_only_the_app_a_network() -> None:
    units = {unit.stem.removeprefix("interlock-"): settings(unit) for unit in SERVICES}
    assert sorted(units) == ["app", "kernel", "recorder"]
    assert units["kernel"]["DeviceAllow"] == ["char-spi rw", "char-gpiochip rw"]
    assert "PrivateDevices" not in units["kernel"]
    assert "RestrictRealtime" not in units["kernel"]
    for name in ("app", "recorder"):
        assert units[name]["PrivateDevices"] == units[name]["RestrictRealtime"] == ["yes"]
        assert not {"DeviceAllow", "SupplementaryGroups", "LimitRTPRIO"} & set(units[name])
    for name in ("kernel", "recorder"):
        assert units[name]["PrivateNetwork"] == ["yes"]
        assert units[name]["RestrictAddressFamilies"] == ["AF_UNIX"]
    assert units["app"]["IPAddressAllow"] == ["localhost"]
    assert units["app"]["User"] != units["kernel"]["User"]
    assert all(unit["CapabilityBoundingSet"] == [""] for unit in units.values())
    rules = (ROOT / "app/packaging/udev/60-interlock.rules").read_text()
    [group] = units["kernel"]["SupplementaryGroups"]
    assert set(re.findall(r'GROUP="([^"]+)"', rules)) == {group}
    users = (ROOT / "app/packaging/sysusers/interlock.conf").read_text()
    assert {group, *(unit["User"][0] for unit in units.values())} == set(
        re.findall(r"^[gu] (\S+)", users, re.M)
    )


def test_the_package_brings_programs_that_run_and_what_they_need(tmp_path: Path) -> None:
    made = run("cpack", "--config", BIN.parent / "CPackConfig.cmake", "-B", tmp_path / "made")
    assert made.returncode == 0, made.stdout + made.stderr
    [package] = (tmp_path / "made").rglob("interlock_*.deb")
    assert run("dpkg-deb", "-x", package, tmp_path / "root").returncode == 0
    usr = tmp_path / "root/usr"
    version = run(usr / "bin/interlock", "--version").stdout
    assert version == run(BIN / "interlock", "--version").stdout
    number = run("dpkg-deb", "-f", package, "Version").stdout.strip()
    assert version.startswith(f"interlock {number}, commit ")
    for program in PROGRAMS[1:]:
        assert run(usr / "bin" / program, "--help").returncode == 0, program
    checked = run(usr / "bin/interlock", "model", "check", usr / "share/interlock/models/robots/neuro.toml")
    assert checked.returncode == 0, checked.stderr
    assert re.search(r"\blibc6 \(>=", run("dpkg-deb", "-f", package, "Depends").stdout)
    for file in (
        *(f"lib/systemd/system/{unit.name}" for unit in UNITS.iterdir()),
        "lib/udev/rules.d/60-interlock.rules",
        "lib/sysusers.d/interlock.conf",
        "share/doc/interlock/copyright",
        *(f"share/man/man1/{name}.1.gz" for name in PROGRAMS),
        "share/interlock/web/index.html",
        "share/interlock/web/index.html.br",
        "share/interlock/web/index.html.gz",
    ):
        assert (usr / file).is_file(), file
    notices = (usr / "share/doc/interlock/copyright").read_text()
    for name in ("three", "uplot", "react-dom", "@fontsource-variable/inter", "ruckig", "libspdlog-dev"):
        assert re.search(rf"^{name}\b", notices, re.MULTILINE), name
    checked = run("lintian", "--allow-root", "--fail-on", "error,warning", package)
    assert (checked.returncode, checked.stdout) == (0, "")
    control = tmp_path / "control"
    assert run("dpkg-deb", "-e", package, control).returncode == 0
    for script in ("postinst", "prerm"):
        assert run("sh", "-n", control / script).returncode == 0
        assert os.access(control / script, os.X_OK)


def test_an_installation_goes_below_its_prefix_and_its_stage_and_nowhere_else(tmp_path: Path) -> None:
    done = run("cmake", "--install", BIN.parent, "--prefix", "/opt/robot", DESTDIR=str(tmp_path))
    assert done.returncode == 0, done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["opt"]
    installed = tmp_path / "opt/robot"
    assert {path.name for path in (installed / "bin").iterdir()} == set(PROGRAMS)
    assert (installed / "lib/systemd/system/interlock.target").is_file()


class Manager:
    """The service manager's socket, and the environment that names it."""

    def __init__(self, folder: Path) -> None:
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.socket.bind(str(folder / "notify"))
        self.environment = {
            **os.environ,
            "NOTIFY_SOCKET": str(folder / "notify"),
            "WATCHDOG_USEC": str(WATCHDOG_US),
        }

    def start(self, *command: str | Path) -> subprocess.Popen:
        return subprocess.Popen(
            [str(part) for part in command],
            env=self.environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )

    def hear(self, within_s: float = DEADLINE_S) -> str:
        self.socket.settimeout(within_s)
        try:
            return self.socket.recv(100).decode()
        except TimeoutError:
            return ""

    def expect_a_life(self, process: subprocess.Popen) -> None:
        """Ready, alive as long as it runs, silent when it stands still, and its end."""
        assert self.hear() == "READY=1"
        assert [self.hear() for _ in range(3)] == ["WATCHDOG=1"] * 3
        process.send_signal(signal.SIGSTOP)
        while self.hear(WATCHDOG_US / 1e6):
            pass
        assert self.hear(WATCHDOG_US / 1e6) == ""
        process.send_signal(signal.SIGCONT)
        assert self.hear() == "WATCHDOG=1"
        assert stop(process) == 0
        while (told := self.hear()) == "WATCHDOG=1":
            pass
        assert told == "STOPPING=1"
        self.socket.close()


@pytest.fixture
def simulator(short_tmp_path: Path) -> Iterator[Path]:
    """The folder of a running simulator, with the compiled robot."""
    config, bus, control = (short_tmp_path / name for name in ("r.ilkc", "bus", "control"))
    robot = ROOT / "models/robots/neuro.toml"
    assert run(BIN / "interlock", "model", "compile", robot, "-o", config).returncode == 0
    plant = ROOT / "models/plant/neuro.toml"
    command = [str(BIN / "interlock-sim"), *options(plant=plant, robot=config, bus=bus, control=control)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline().startswith("ready")
        yield short_tmp_path
        stop(process)


def kernel_of(folder: Path, *more: str) -> list[str | Path]:
    given = options(config=folder / "r.ilkc", bus=f"sim:{folder / 'bus'}", link=folder / "link")
    return [BIN / "interlock-kernel", *given, *more]


def test_the_kernel_tells_the_service_manager_that_its_loop_goes_on(simulator: Path) -> None:
    manager = Manager(simulator)
    manager.expect_a_life(manager.start(*kernel_of(simulator)))


def test_the_app_tells_the_service_manager_that_both_its_threads_go_on(simulator: Path) -> None:
    manager = Manager(simulator)
    robot = ROOT / "models/robots/neuro.toml"
    state = simulator / "state"
    given = options(robot=robot, config=simulator / "r.ilkc", link=simulator / "link", state=state, port=0)
    manager.expect_a_life(manager.start(BIN / "interlock-app", *given))


def test_the_link_is_its_users_alone_unless_it_is_shared_with_the_group(simulator: Path) -> None:
    for more, mode in (((), 0o600), (("--link-shared",), 0o660)):
        manager = Manager(simulator)
        kernel = manager.start(*kernel_of(simulator, *more))
        assert manager.hear() == "READY=1"
        assert (simulator / "link").stat().st_mode & 0o777 == mode
        assert stop(kernel) == 0
        manager.socket.close()
        (simulator / "notify").unlink()


def test_the_black_box_is_the_kernels_user_alone_who_is_not_the_apps(simulator: Path) -> None:
    box = simulator / "black-box"
    manager = Manager(simulator)
    kernel = manager.start(*kernel_of(simulator, "--black-box", str(box), "--black-box-seconds", "1"))
    assert manager.hear() == "READY=1"
    assert box.stat().st_mode & 0o777 == 0o600
    assert stop(kernel) == 0
    manager.socket.close()
    units = {unit.stem.removeprefix("interlock-"): settings(unit) for unit in SERVICES}
    assert "--black-box /run/interlock/" in units["kernel"]["ExecStart"][0]
    assert units["recorder"]["User"] == units["kernel"]["User"] != units["app"]["User"]
    assert "black-box" not in units["app"]["ExecStart"][0]


def test_a_kernel_whose_cards_are_not_there_names_what_is_missing(simulator: Path) -> None:
    wiring = simulator / "wiring"
    wiring.write_text("speed_hz 20000000\ncard 0 /dev/spidev99.0\n")
    given = options(config=simulator / "r.ilkc", bus=f"spi:{wiring}", link=simulator / "link")
    refused = run(BIN / "interlock-kernel", *given)
    assert refused.returncode == 2
    assert "slot 1 has a card in the configuration" in refused.stderr
    assert not (simulator / "link").exists()


def test_the_example_of_a_wiring_names_every_line_that_a_robot_needs(simulator: Path) -> None:
    robot = tomllib.loads((ROOT / "models/robots/neuro.toml").read_text("utf-8"))
    slots = [one["slot"] for kind in ("axis", "sensor") for one in robot.get(kind, [])]
    example = (ROOT / "app/packaging/wiring.example").read_text("utf-8").splitlines()
    lines = [line for line in example if not line.startswith(("card", "gpio"))]
    lines += ["gpio /dev/nowhere", *(f"card {slot} /dev/nowhere{slot}" for slot in slots)]
    wiring = simulator / "wiring"
    wiring.write_text("\n".join(lines) + "\n")
    given = options(config=simulator / "r.ilkc", bus=f"spi:{wiring}", link=simulator / "link")
    refused = run(BIN / "interlock-kernel", *given)
    assert refused.returncode == 2
    assert "device '/dev/nowhere" in refused.stderr
