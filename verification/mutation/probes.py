"""What can catch a fault in one file of the kernel's core: parts of the rungs, the cheapest first.

A probe catches a fault only by what it says of the code: a test that fails, a property that does not hold, a
goal that can no longer be reached, a function of which a proof tells when it must be called and that nothing
calls any more. Another number of properties or goals, which any change of the text brings, catches nothing.
"""

import re
import sys
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from bounded import output_of

HERE = Path(__file__).resolve().parent
TIMEOUT_S = 900
TOLD = re.compile(
    r"^ +(\w+: .*|goal \w+ is \w+; expected.*|\w+ is to be replaced, but .* no such function)$", re.MULTILINE
)
"""What a proof says of the code."""
TICK_TOLD = re.compile(r"^[a-z_]+: .*$", re.MULTILINE)
"""What a step of the whole tick says of it: a claim that does not hold, or goals that are not reached."""


@dataclass(frozen=True)
class Probe:
    rung: str
    part: str
    command: tuple[str, ...]
    catches: re.Pattern[str]

    def catch_all(self, tree: Path) -> list[str]:
        """Each line that tells what the fault broke in this tree."""
        said = output_of(self.command, TIMEOUT_S, cwd=tree) or ""
        return [found.group().strip() for found in self.catches.finditer(said)]

    def catch(self, tree: Path) -> str:
        """The first of them; empty when nothing was noticed."""
        return next(iter(self.catch_all(tree)), "")


def proof_probe(name: str) -> Probe:
    """One proof of verification/cbmc."""
    return Probe("cbmc", name, (sys.executable, "verification/cbmc/run.py", name), TOLD)


def tick_probe(part: str = "all") -> Probe:
    """Whole ticks against the monitors: one claim of verification/tick, or `all`."""
    names = () if part == "all" else (part,)
    return Probe("tick", part, (sys.executable, "verification/tick/run.py", *names), TICK_TOLD)


def test_probe(part: str) -> Probe:
    """The kernel's unit tests, the `short` or the `long` ones."""
    command = (sys.executable, str(HERE / "unit_tests.py"), ".", part)
    return Probe("tests", part, command, re.compile(r"^FAILED.*$", re.MULTILINE))


KINDS = {"tests": test_probe, "tick": tick_probe, "cbmc": proof_probe}


def probe_named(name: str) -> Probe:
    """The probe that is called `RUNG PART`. Raises KeyError for an unknown rung."""
    rung, part = name.split(" ", 1)
    return KINDS[rung](part)


def proofs_about(tree: Path, file: Path) -> Iterator[str]:
    """The CBMC proofs that link or take in the file, the fastest first; all of them for a header."""
    proofs = []
    for path in (tree / "verification/cbmc").glob("*/proof.toml"):
        table = tomllib.loads(path.read_text("utf-8"))
        harness = path.with_name("harness.c").read_text("utf-8")
        taken_in = f'#include "{file.name}"' in harness
        if file.suffix == ".h" or taken_in or file.name in table["sources"]:
            proofs.append((table["seconds"], path.parent.name))
    return (name for _, name in sorted(proofs))


def probes_of_mutants(tree: Path, file: Path) -> Iterator[Probe]:
    """All that can see a change of this file of kernel/src, the cheapest first."""
    yield test_probe("short")
    yield test_probe("long")
    yield from map(proof_probe, proofs_about(tree, file))
    yield tick_probe()
