"""What builds and verifies and is not shipped: from verification/toolchain and the console's lock file."""

import json
import re
from pathlib import Path

from components import Component, debian_components, npm_component


def npm_tools(root: Path) -> list[Component]:
    """The packages that build and test the console and are no part of it, as the lock file has them."""
    locked = json.loads((root / "web/package-lock.json").read_text("utf-8"))["packages"]
    return [
        npm_component(place.rpartition("node_modules/")[2], entry)
        for place, entry in locked.items()
        if entry.get("dev")
    ]


def pinned(root: Path, file: str, pattern: str) -> list[tuple[str, ...]]:
    """What the lines of a file of verification/toolchain name by a pattern."""
    return re.findall(pattern, (root / "verification/toolchain" / file).read_text("utf-8"), re.MULTILINE)


def tools(root: Path) -> list[Component]:
    """Each tool, by its name: as pinned, or as installed where Debian's is taken as it is."""
    names = set(pinned(root, "packages.txt", r"^[a-z]+ (\S+)"))
    python = [
        Component(name, version, f"pkg:pypi/{name.lower()}@{version}", supplier="PyPI")
        for name, version in pinned(root, "requirements.txt", r"^([\w.-]+)==(\S+)")
    ]
    debian = [
        Component(name, version, f"pkg:deb/debian/{name}@{version}", supplier="Debian")
        for name, version in pinned(root, "cbmc.txt", r"^(\S+)=(\S+)")
    ]
    maven = [
        Component(
            name, version, f"pkg:maven/{group}/{name}@{version}", "Maven Central", digest=("SHA-256", digest)
        )
        for group, name, version, digest in pinned(root, "tlc.txt", r"^(\S+):(\S+):(\S+) ([0-9a-f]{64})")
    ]
    found = [*debian_components(names), *python, *debian, *maven, *npm_tools(root)]
    return sorted(set(found), key=lambda one: (one.name, one.version, one.purl))
