"""What is shipped beside our own code, found in what was built, and its bill of materials."""

import json
import re
import subprocess
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

BUILT = re.compile(r"^([\w.-]+)==(\S+)", re.MULTILINE)
OURS = ("app/", "kernel/", "models/")
"""Folders whose object files are linked into what is shipped."""


@dataclass(frozen=True)
class Component:
    """One component that is shipped, by the name under which its distributor has it."""

    name: str
    version: str
    purl: str


def lines_of(command: Sequence[str]) -> list[str]:
    """What a command prints; a path that dpkg does not know makes no difference to the others."""
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout.splitlines()


def shared_libraries(programs: Sequence[Path]) -> set[str]:
    """Paths of all shared libraries that the programs load."""
    printed = [line for program in programs for line in lines_of(["ldd", str(program)])]
    return set(re.findall(r"=> (/\S+)", "\n".join(printed)))


def headers(build: Path) -> set[str]:
    """Paths of the system's headers that were compiled into our object files."""
    found, ours = set(), False
    for line in lines_of(["ninja", "-C", str(build), "-t", "deps"]):
        if "#deps" in line:
            ours = line.startswith(OURS)
        elif ours and line.strip().startswith("/usr/"):
            found.add(str(Path(line.strip()).resolve()))
    return found


def debian_packages(paths: Iterable[str]) -> list[Component]:
    """The packages that the paths come from. /lib and /usr/lib are one directory under two names."""
    known = set(paths)
    asked = sorted(known | {f"/usr{path}" for path in known} | {path.removeprefix("/usr") for path in known})
    names = sorted({line.split(":")[0] for line in lines_of(["dpkg-query", "-S", *asked]) if line})
    if not names:
        return []
    shown = lines_of(["dpkg-query", "-W", "-f", "${Package} ${Version}\n", *names])
    pairs = sorted({tuple(line.split(" ", 1)) for line in shown})
    return [Component(name, version, f"pkg:deb/debian/{name}@{version}") for name, version in pairs]


def shipped(root: Path) -> list[Component]:
    """Each component that is shipped, by its name; none when no program is built."""
    build = root / "build/release"
    programs = sorted((build / "bin").glob("interlock*"))
    if not programs:
        return []
    found = debian_packages(shared_libraries(programs) | headers(build))
    built = BUILT.findall((root / "verification/toolchain/libraries.txt").read_text("utf-8"))
    found += [Component(name, version, f"pkg:pypi/{name}@{version}") for name, version in built]
    wanted = json.loads((root / "web/package.json").read_text("utf-8"))["dependencies"]
    locked = json.loads((root / "web/package-lock.json").read_text("utf-8"))["packages"]
    for name in wanted:
        version = locked[f"node_modules/{name}"]["version"]
        found.append(Component(name, version, f"pkg:npm/{name.replace('@', '%40')}@{version}"))
    return sorted(found, key=lambda one: one.name)


def bill_of_materials(components: Sequence[Component], commit: str) -> Mapping[str, object]:
    """What is shipped as CycloneDX 1.6, without time or serial number, so that two runs agree."""
    libraries = [
        {"type": "library", "bom-ref": one.purl, "name": one.name, "version": one.version, "purl": one.purl}
        for one in components
    ]
    ours = {"type": "application", "name": "interlock", "version": commit}
    head = {"bomFormat": "CycloneDX", "specVersion": "1.6", "version": 1}
    return {**head, "metadata": {"component": ours}, "components": libraries}
