"""What can catch a fault in one file of the kernel's core: parts of the rungs, the cheapest first.

A probe catches a fault only by what it says of the code: a row that differs, a property or a contract that
does not hold, a goal that can no longer be reached. Another number of properties or goals, which any change
of the text brings, catches nothing.
"""

import json
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
TIMEOUT_S = 900


@dataclass(frozen=True)
class Probe:
    rung: str
    part: str
    command: tuple[str, ...]
    catches: re.Pattern[str]

    def catch(self, tree: Path) -> str:
        """The first line that tells what the fault broke in this tree; empty when nothing did."""
        try:
            done = subprocess.run(
                self.command,
                cwd=tree,
                capture_output=True,
                text=True,
                timeout=TIMEOUT_S,
                stdin=subprocess.DEVNULL,
            )
        except subprocess.TimeoutExpired:
            return ""
        found = self.catches.search(done.stdout)
        return found.group().strip() if found else ""


def contract_probe(file: Path) -> Probe:
    command = (sys.executable, "verification/frama-c/run.py", file.name)
    return Probe("wp", file.name, command, re.compile(r"^ +(NOT PROVED|OUT OF REACH) .*$", re.MULTILINE))


def proof_probes(tree: Path, file: Path) -> Iterator[Probe]:
    """The CBMC proofs that link or include the file, the fastest first; for a header, all of them."""
    proofs = []
    for path in (tree / "verification/cbmc").glob("*/proof.toml"):
        table = tomllib.loads(path.read_text("utf-8"))
        harness = (path.parent / "harness.c").read_text("utf-8")
        linked = file.name in table["sources"] or f'#include "{file.name}"' in harness
        if file.suffix == ".h" or linked:
            proofs.append((table["seconds"], path.parent.name))
    for _, name in sorted(proofs):
        command = (sys.executable, "verification/cbmc/run.py", name)
        yield Probe("cbmc", name, command, re.compile(r"^(FAILED|VACUOUS) .*\n.*$", re.MULTILINE))


def row_probe() -> Probe:
    """The compiled kernel over the rows of the model; see rows.py."""
    command = (sys.executable, str(HERE / "rows.py"), "kernel", "build/rows")
    return Probe("conformance", "rows", command, re.compile(r"^\w+: \d+ rows differ$", re.MULTILINE))


def probes_for(tree: Path, file: Path) -> Iterator[Probe]:
    """All that can see this file of kernel/src; contracts only where they are proved of the sound file."""
    yield row_probe()
    yield from proof_probes(tree, file)
    if file.name in json.loads((tree / "verification/frama-c/expected.json").read_text("utf-8")):
        yield contract_probe(file)
