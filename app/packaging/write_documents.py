#!/usr/bin/python3
"""Writes what a package says of itself. Usage: write_documents.py PROGRAMS OUTPUT

`copyright` has the notices of what others wrote and we ship, `changelog.gz` what Debian wants beside
CHANGELOG.md, `man` a page for each program: what it prints for --help.
"""

import gzip
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from email.utils import formatdate
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2] / "verification/trace"))

import components

ROOT = Path(__file__).resolve().parents[2]
PEOPLE = "The Interlock developers"
PROGRAMS = {
    "interlock": "control software for MRI-compatible surgical robots",
    "interlock-app": "shows the robot and sends requests to the kernel",
    "interlock-kernel": "decides each tick what the robot may do",
    "interlock-player": "shows a recording in the kernel's place",
    "interlock-recorder": "stores what the kernel's black box holds",
    "interlock-sim": "simulates the robot's hardware",
}
COMPILED_IN = (
    "libcli11-dev",
    "libeigen3-dev",
    "libexpected-dev",
    "libopenigtlink-dev",
    "liborocos-kdl-dev",
    "libspdlog-dev",
    "libsqlitecpp-dev",
    "libtomlplusplus-dev",
    "nlohmann-json3-dev",
    "prometheus-cpp-dev",
)
"""Debian's packages whose code is compiled into our programs. Boost's licence asks for no notice there."""
OURS = f"""Interlock
Copyright (c) 2025-2026 {PEOPLE}

Licensed under the Apache License, Version 2.0. On Debian systems its text is in
/usr/share/common-licenses/Apache-2.0.

The programs and the console contain code of others. Their notices follow.
"""


def licence_of(package: Path) -> str:
    """The text of a node package's licence."""
    files = sorted(package.glob("LICEN[CS]E*"))
    if not files:
        raise SystemExit(f"write_documents: no licence file in {package}; `make build` installs it")
    return files[0].read_text("utf-8")


def notices() -> Iterator[tuple[str, str]]:
    """Name and notice of each part that others wrote."""
    for one in sorted(components.npm_packages(ROOT), key=lambda one: one.name):
        yield f"{one.name} {one.version}", licence_of(ROOT / "web/node_modules" / one.name)
    yield "ruckig", (ROOT / "build/libraries/ruckig/LICENSE").read_text("utf-8")
    for name in COMPILED_IN:
        yield name, Path(f"/usr/share/doc/{name}/copyright").read_text("utf-8")


def changelog(version: str) -> str:
    """The one entry that Debian's tools read; its date is the commit's, as SOURCE_DATE_EPOCH has it."""
    date = formatdate(int(os.environ.get("SOURCE_DATE_EPOCH", "0"))).replace("-0000", "+0000")
    entry = "  * CHANGELOG.md in this folder lists what changed."
    head = f"interlock ({version}) unstable; urgency=medium"
    return f"{head}\n\n{entry}\n\n -- {PEOPLE} <interlock@localhost>  {date}\n"


def manual_page(program: Path, version: str) -> str:
    told = subprocess.check_output([program, "--help"], text=True)
    escaped = re.sub(r"^([.'])", r"\\&\1", told.replace("\\", "\\e").replace("-", "\\-"), flags=re.MULTILINE)
    name = program.name.replace("-", "\\-")
    return f""".TH {program.name.upper()} 1 "" "Interlock {version}"
.SH NAME
{name} \\- {PROGRAMS[program.name]}
.SH DESCRIPTION
.nf
{escaped}.fi
.SH SEE ALSO
/usr/share/doc/interlock
"""


def compressed(text: str) -> bytes:
    return gzip.compress(text.encode("utf-8"), 9, mtime=0)


def main() -> int:
    programs, output = Path(sys.argv[1]), Path(sys.argv[2])
    (output / "man").mkdir(parents=True, exist_ok=True)
    printed = subprocess.check_output([programs / "interlock", "--version"], text=True)
    version = printed.split()[1].rstrip(",")
    rule = "-" * 79
    parts = [OURS, *(f"{rule}\n{name}\n\n{text.strip()}\n" for name, text in notices())]
    (output / "copyright").write_text("\n".join(parts), "utf-8")
    (output / "changelog.gz").write_bytes(compressed(changelog(version)))
    for name in PROGRAMS:
        (output / f"man/{name}.1.gz").write_bytes(compressed(manual_page(programs / name, version)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
