#!/usr/bin/python3
"""Runs make targets of the commit that is checked out in a bare root of Debian 12 or 13 (`--help`).

A bare root is what `mmdebstrap --variant=minbase` makes, with make, git and ca-certificates. Each run gets a
new one and deletes it at the end. All mounts live in a mount namespace of this process, which is also the
first process of its process namespace: however it ends, neither a mount nor a process is left behind.
Needs root, mmdebstrap and util-linux.

What apt, pip, npm and maven download is kept in `--folder` and read again by later runs. How this machine
reaches its package sources (certificates, proxies, pip's and npm's settings) is copied into the root.
"""

import argparse
import fcntl
import os
import re
import shutil
import signal
import socket
import stat
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SUITES = {"12": "bookworm", "13": "trixie"}
FOLDER = Path("/var/tmp/interlock-bare")
NAMESPACES = ["unshare", "--mount", "--pid", "--fork", "--kill-child", "--mount-proc"]
INSIDE = "INTERLOCK_BARE_ROOT"
DEVICES = {"null": 3, "zero": 5, "full": 7, "random": 8, "urandom": 9}
"""The devices of a root, by minor number. Its own nodes: the machine's cannot be deleted through it."""
SOURCES = re.compile(r"proxy$|^PIP_(INDEX|CERT|TRUSTED|DEFAULT)|_CERT$|_CERTS$|^npm_config_", re.IGNORECASE)
"""Variables that say how package sources are reached."""


@dataclass(frozen=True)
class Spent:
    """What a command took: seconds on the clock, and of the processor, its children included."""

    wall_s: float
    processor_s: float


def enter_namespaces() -> None:
    """Starts this program again in namespaces of its own, once."""
    if INSIDE not in os.environ:
        os.execvpe(NAMESPACES[0], [*NAMESPACES, sys.executable, *sys.argv], {**os.environ, INSIDE: "1"})
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))


class BareRoot:
    """A new root of one release with a clone of the checkout in it; deleted at the end of a `with`.

    There is one of each release at a time; another one waits.
    """

    def __init__(self, release: str, folder: Path = FOLDER) -> None:
        self.release = release
        self.folder = folder
        self.root = folder / f"root-{release}"

    def __enter__(self) -> "BareRoot":
        self.folder.mkdir(parents=True, exist_ok=True)
        self._lock = (self.folder / f"lock-{self.release}").open("w")
        fcntl.flock(self._lock, fcntl.LOCK_EX)
        self._delete()
        archive = self.folder / f"base-{self.release}.tar"
        if not archive.exists():
            fresh = archive.with_suffix(".new")
            include = "--include=make,git,ca-certificates"
            command = ["mmdebstrap", "--quiet", "--variant=minbase", include, "--format=tar"]
            subprocess.run([*command, SUITES[self.release], str(fresh)], check=True)
            fresh.rename(archive)
        self.root.mkdir()
        subprocess.run(["tar", "-C", str(self.root), "-xf", str(archive)], check=True)
        clone = ["git", "clone", "--quiet", "--no-hardlinks", str(ROOT), str(self.root / "srv/interlock")]
        subprocess.run(clone, check=True)
        self._mount()
        self._copy_settings()
        return self

    def __exit__(self, *_: object) -> None:
        subprocess.run(["umount", "--recursive", "--lazy", str(self.root)], check=False)
        self._delete()
        self._lock.close()

    def command(self, *words: str) -> list[str]:
        """A command line that runs these words at the top of the clone."""
        kept = [f"{name}={value}" for name, value in os.environ.items() if SOURCES.search(name)]
        ours = [
            "PATH=/usr/sbin:/usr/bin:/sbin:/bin",
            "LANG=C.UTF-8",
            "HOME=/root",
            "XDG_STATE_HOME=/var/tmp/state",
        ]
        environment = ["env", "-i", *ours, *kept, "env", "-C", "/srv/interlock"]
        return ["chroot", str(self.root), *environment, *words]

    def run(self, *words: str) -> Spent:
        """Runs a command at the top of the clone; ends the program when it fails."""
        begin = time.monotonic()
        return finish(subprocess.Popen(self.command(*words), stdin=subprocess.DEVNULL), begin, words)

    def start_robot(self) -> tuple[Spent, list[str]]:
        """Runs `make run` to "ready" and ends it; the time to that line, and what was printed up to it."""
        begin, lines, ready = time.monotonic(), [], 0.0
        words = ("make", "run", f"PORT={free_port()}")
        process = subprocess.Popen(
            self.command(*words), stdout=subprocess.PIPE, text=True, start_new_session=True
        )
        assert process.stdout is not None
        for line in process.stdout:
            print(line, end="", flush=True)
            if ready:
                continue
            lines.append(line.rstrip("\n"))
            if line.startswith("ready "):
                ready = time.monotonic()
                os.killpg(process.pid, signal.SIGINT)
        if not ready:
            raise SystemExit(f"bare_root: {' '.join(words)}: ended without the line 'ready ...'")
        spent = finish(process, begin, words, allowed=(0, 2, 130, -signal.SIGINT))
        return Spent(round(ready - begin, 1), spent.processor_s), lines

    def _mount(self) -> None:
        self.root.joinpath("srv").mkdir(exist_ok=True)
        subprocess.run(["mount", "--bind", str(self.root), str(self.root)], check=True)
        self._mount_one("proc", ["-t", "proc", "proc"])
        self._mount_one("sys", ["--rbind", "-o", "ro", "/sys"])
        self._mount_one("dev", ["-t", "tmpfs", "tmpfs"])
        for name, minor in DEVICES.items():
            os.mknod(self.root / "dev" / name, 0o666 | stat.S_IFCHR, os.makedev(1, minor))
            (self.root / "dev" / name).chmod(0o666)
        for name, target in {"fd": "fd", "stdin": "fd/0", "stdout": "fd/1", "stderr": "fd/2"}.items():
            (self.root / "dev" / name).symlink_to(f"/proc/self/{target}")
        (self.root / "dev/ptmx").symlink_to("pts/ptmx")
        self._mount_one("dev/pts", ["-t", "devpts", "-o", "newinstance,ptmxmode=0666", "devpts"])
        self._mount_one("dev/shm", ["-t", "tmpfs", "tmpfs"])
        for place in ("var/cache/apt/archives", "var/lib/apt/lists", "root"):
            kept = self.folder / f"downloads-{self.release}" / place
            kept.mkdir(parents=True, exist_ok=True)
            self._mount_one(place, ["--bind", str(kept)])

    def _mount_one(self, place: str, what: Sequence[str]) -> None:
        (self.root / place).mkdir(parents=True, exist_ok=True)
        subprocess.run(["mount", *what, str(self.root / place)], check=True)

    def _copy_settings(self) -> None:
        shutil.copy("/etc/resolv.conf", self.root / "etc/resolv.conf")
        for file in ("/etc/pip.conf", str(Path.home() / ".npmrc")):
            if Path(file).exists():
                shutil.copy(file, self.root / ("root" if file.endswith(".npmrc") else "etc"))
        for certificate in Path("/usr/local/share/ca-certificates").glob("*.crt"):
            shutil.copy(certificate, self.root / "usr/local/share/ca-certificates")
        self.run("update-ca-certificates", "--fresh")
        dumped = subprocess.run(["apt-config", "dump"], capture_output=True, text=True, check=True).stdout
        access = re.findall(r'^Acquire::(?:https?|Check)\S* "[^"]+";$', dumped, re.MULTILINE)
        (self.root / "etc/apt/apt.conf.d/90machine").write_text("\n".join([*access, ""]))

    def _delete(self) -> None:
        """Deletes the root, and nothing that is mounted in it."""
        mounted = [line.split()[4] for line in Path("/proc/self/mountinfo").read_text().splitlines()]
        inside = [place for place in mounted if Path(place).is_relative_to(self.root)]
        if inside:
            raise SystemExit(f"bare_root: {inside[0]} is mounted; unmount it first")
        subprocess.run(["rm", "-rf", "--one-file-system", str(self.root)], check=True)


def finish(
    process: subprocess.Popen, begin: float, words: Sequence[str], allowed: Sequence[int] = (0,)
) -> Spent:
    """Waits for a process, and says what it took; ends the program when it failed."""
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode not in allowed:
        raise SystemExit(f"bare_root: {' '.join(words)}: exit status {process.returncode}")
    return Spent(round(time.monotonic() - begin, 1), round(used.ru_utime + used.ru_stime, 1))


def free_port() -> str:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return str(probe.getsockname()[1])


def main() -> int:
    parser = argparse.ArgumentParser(description="Runs make targets in a bare root of Debian.")
    parser.add_argument("release", choices=SUITES)
    parser.add_argument("targets", nargs="+", metavar="target", help="`run` is ended once it is ready")
    parser.add_argument("--folder", type=Path, default=FOLDER, help=f"downloads and roots ({FOLDER})")
    asked = parser.parse_args()
    enter_namespaces()
    with BareRoot(asked.release, asked.folder) as bare:
        for target in asked.targets:
            if target == "run":
                spent, _ = bare.start_robot()
            else:
                spent = bare.run("make", target)
            print(f"{target}: {spent.wall_s} s, {spent.processor_s} s of processor time", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
