"""The record of a release: what was built, from which commit, by which commands, and what is known of it."""

import hashlib
from collections.abc import Mapping, Sequence
from pathlib import Path

from gate import Finding, Trace, awaited

COMMANDS = ("make build", "make test", "make verify", "make selftest", "make report")
"""What leads from a fresh clone on Debian 12 to what is recorded; `awaited` names what a release adds."""

INSTALLED = (".toml", ".service", ".target", ".rules", ".conf")
"""Endings of what an installation copies as it is: robots and their plants, units, rules."""


def digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def built_files(root: Path) -> list[Path]:
    """Programs and console as built, what is installed beside them, and the package where one was made.

    The package has the programs without their debugging symbols, so it is checked by its own hash.
    """
    programs = sorted((root / "build/release/bin").glob("interlock*"))
    console = [path for path in sorted((root / "web/dist").rglob("*")) if path.is_file()]
    beside = [
        path
        for folder in ("models/robots", "models/plant", "app/packaging")
        for path in sorted((root / folder).rglob("*"))
        if path.is_file() and path.suffix in INSTALLED
    ]
    return [*programs, *console, *beside, *sorted((root / "build/release/package").glob("*.deb"))]


def record(of: Trace, found: Sequence[Finding], commit: str) -> Mapping[str, object]:
    """The record, with the number of findings and the anomalies that stand."""
    root = of.project.root
    return {
        "commit": commit,
        "commands": list(COMMANDS),
        "files": {path.relative_to(root).as_posix(): digest(path) for path in built_files(root)},
        "components": {one.purl: one.version for one in of.project.components},
        "anomalies": {one.uid: one.title for one in of.project.items.of("ANOMALY")},
        "findings": len(found),
        "awaited": awaited(of),
    }
