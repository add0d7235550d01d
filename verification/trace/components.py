"""What is shipped beside our own code: shared libraries, libraries that we build, the console's packages."""

import json
import re
import subprocess
from collections.abc import Sequence
from pathlib import Path

BUILT = re.compile(r"^([\w.-]+)==(\S+)", re.MULTILINE)


def lines_of(command: Sequence[str]) -> list[str]:
    """What a command prints; a path that dpkg does not know makes no difference to the others."""
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout.splitlines()


def shared_libraries(programs: Sequence[Path]) -> set[str]:
    """Paths of all shared libraries that the programs load."""
    found = set()
    for program in programs:
        found.update(re.findall(r"=> (/\S+)", "\n".join(lines_of(["ldd", str(program)]))))
    return found


def debian_packages(paths: set[str]) -> dict[str, str]:
    """Packages and versions that the paths come from. /lib and /usr/lib are one directory under two names."""
    asked = sorted(paths | {f"/usr{path}" for path in paths} | {path.removeprefix("/usr") for path in paths})
    names = sorted({line.split(":")[0] for line in lines_of(["dpkg-query", "-S", *asked]) if line})
    if not names:
        return {}
    shown = lines_of(["dpkg-query", "-W", "-f", "${Package} ${Version}\n", *names])
    return dict(line.split(" ", 1) for line in shown)


def shipped(root: Path) -> dict[str, str]:
    """Name and version of each component that is shipped; empty when no program is built."""
    programs = sorted((root / "build/release/bin").glob("interlock*"))
    if not programs:
        return {}
    found = debian_packages(shared_libraries(programs))
    found |= dict(BUILT.findall((root / "verification/toolchain/libraries.txt").read_text("utf-8")))
    wanted = json.loads((root / "web/package.json").read_text("utf-8"))["dependencies"]
    locked = json.loads((root / "web/package-lock.json").read_text("utf-8"))["packages"]
    return found | {name: locked[f"node_modules/{name}"]["version"] for name in wanted}
