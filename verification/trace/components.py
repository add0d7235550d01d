"""What is shipped beside our own code, found in what was built, and its bill of materials."""

import base64
import json
import re
import subprocess
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

BUILT = re.compile(r"^([\w.-]+)==(\S+)(?: --hash=sha256:([0-9a-f]{64}))?", re.MULTILINE)
OURS = ("app/", "kernel/", "models/")
"""Folders whose object files are linked into what is shipped."""


@dataclass(frozen=True)
class Component:
    """One component that is shipped, by the name under which its distributor has it."""

    name: str
    version: str
    purl: str
    supplier: str = ""
    """Who distributes it; empty where that is not known, as are the other fields."""
    licence: str = ""
    is_spdx: bool = False
    """Whether the licence is named by its SPDX identifier."""
    digest: tuple[str, str] = ("", "")
    """Algorithm, as CycloneDX names it, and hexadecimal hash of the archive in which it came."""
    needs: frozenset[str] = frozenset()
    """Names of the components that it needs, shipped or not."""


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


def debian_licence(name: str) -> str:
    """The licence of most of a package, as its copyright file names it; empty when no machine can read it."""
    try:
        text = Path(f"/usr/share/doc/{name}/copyright").read_text("utf-8", "replace")
    except OSError:
        return ""
    found = re.search(r"^Files: *\*.*?^License: *(\S[^\n]*)", text, re.MULTILINE | re.DOTALL)
    return found[1] if found else ""


def debian_digests(packages: Sequence[str]) -> dict[str, str]:
    """SHA-256 of the archive of each NAME=VERSION of which apt's lists know it."""
    digests, shown = {}, ""
    for line in lines_of(["apt-cache", "show", *packages]):
        word, _, value = line.partition(": ")
        if word in ("Package", "Version"):
            shown = value if word == "Package" else f"{shown}={value}"
        elif word == "SHA256":
            digests[shown] = value
    return digests


def debian_packages(paths: Iterable[str]) -> list[Component]:
    """The packages that the paths come from. /lib and /usr/lib are one directory under two names."""
    known = set(paths)
    asked = sorted(known | {f"/usr{path}" for path in known} | {path.removeprefix("/usr") for path in known})
    return debian_components({line.split(":")[0] for line in lines_of(["dpkg-query", "-S", *asked]) if line})


def debian_components(named: Iterable[str]) -> list[Component]:
    """The packages of these names that are installed."""
    names = sorted(named)
    if not names:
        return []
    shown = lines_of(["dpkg-query", "-W", "-f", "${Package}\t${Version}\t${Depends}\n", *names])
    packages = sorted({tuple(line.split("\t", 2)) for line in shown if line.split("\t")[1]})
    digests = debian_digests([f"{name}={version}" for name, version, _ in packages])
    return [
        Component(
            name,
            version,
            f"pkg:deb/debian/{name}@{version}",
            supplier="Debian",
            licence=debian_licence(name),
            digest=("SHA-256", digests.get(f"{name}={version}", "")),
            needs=frozenset(re.findall(r"(?:^|[,|] )([a-z0-9][a-z0-9+.-]+)", depends)),
        )
        for name, version, depends in packages
    ]


def built_libraries(root: Path) -> list[Component]:
    """What is compiled from a source archive of PyPI."""
    pinned = (root / "verification/toolchain/libraries.txt").read_text("utf-8")
    found = []
    for name, version, digest in BUILT.findall(pinned):
        licence = root / "build/libraries" / name / "LICENSE"
        text = licence.read_text("utf-8") if licence.exists() else ""
        of = "MIT" if text.startswith("MIT License") else ""
        purl = f"pkg:pypi/{name}@{version}"
        found.append(Component(name, version, purl, "PyPI", of, bool(of), ("SHA-256", digest)))
    return found


def resolved(name: str, wanted_by: str, locked: Mapping[str, Mapping]) -> str:
    """The place in a lock file of the package that `wanted_by` gets: the nearest node_modules above it."""
    place = wanted_by
    while place and f"{place}/node_modules/{name}" not in locked:
        place = place.rpartition("/node_modules/")[0] if "/node_modules/" in place else ""
    return f"{place}/node_modules/{name}" if place else f"node_modules/{name}"


def npm_component(name: str, entry: Mapping) -> Component:
    """A package as the lock file has it."""
    version, licence = entry["version"], entry.get("license", "")
    algorithm, _, digest = entry.get("integrity", "").partition("-")
    return Component(
        name,
        version,
        f"pkg:npm/{name.replace('@', '%40')}@{version}",
        supplier="npm",
        licence=licence,
        is_spdx=bool(licence),
        digest=(algorithm.replace("sha", "SHA-"), base64.b64decode(digest).hex()),
        needs=frozenset(entry.get("dependencies", {})),
    )


def npm_packages(root: Path) -> list[Component]:
    """The packages of the console, and all that they need, as the lock file has them."""
    wanted = json.loads((root / "web/package.json").read_text("utf-8"))["dependencies"]
    locked = json.loads((root / "web/package-lock.json").read_text("utf-8"))["packages"]
    found: dict[str, Component] = {}
    waiting = [(name, "") for name in wanted]
    while waiting:
        name, wanted_by = waiting.pop()
        place = resolved(name, wanted_by, locked)
        if place in found:
            continue
        entry = locked[place]
        needs = entry.get("dependencies", {})
        found[place] = npm_component(name, entry)
        waiting += [(one, place) for one in needs]
    return list(found.values())


def shipped(root: Path) -> list[Component]:
    """Each component that is shipped, by its name; none when no program is built."""
    build = root / "build/release"
    programs = sorted((build / "bin").glob("interlock*"))
    if not programs:
        return []
    found = debian_packages(shared_libraries(programs) | headers(build))
    return sorted([*found, *built_libraries(root), *npm_packages(root)], key=lambda one: one.name)


def entry_of(one: Component) -> Mapping[str, object]:
    """A component as CycloneDX has it. What is not known is left out."""
    entry: dict[str, object] = {"type": "library", "bom-ref": one.purl}
    if one.supplier:
        entry["supplier"] = {"name": one.supplier}
    entry |= {"name": one.name, "version": one.version}
    if one.digest[1]:
        entry["hashes"] = [{"alg": one.digest[0], "content": one.digest[1]}]
    if one.licence:
        entry["licenses"] = [{"license": {"id" if one.is_spdx else "name": one.licence}}]
    return {**entry, "purl": one.purl}


def bill_of_materials(
    components: Sequence[Component], commit: str, name: str = "interlock"
) -> Mapping[str, object]:
    """What `name` consists of as CycloneDX 1.6, without time or serial number, so that two runs agree."""
    ours = {"type": "application", "bom-ref": name, "name": name, "version": commit}
    head = {"bomFormat": "CycloneDX", "specVersion": "1.6", "version": 1}
    needed = {one.purl: [other.purl for other in components if other.name in one.needs] for one in components}
    reached = {purl for purls in needed.values() for purl in purls}
    needed[name] = [one.purl for one in components if one.purl not in reached]
    return {
        **head,
        "metadata": {"component": ours},
        "components": [entry_of(one) for one in components],
        "dependencies": [{"ref": ref, "dependsOn": on} for ref, on in sorted(needed.items())],
    }
