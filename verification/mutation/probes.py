"""What can catch a fault in one file of the kernel's core: parts of the rungs, the cheapest first.

A probe catches a fault only by what it says of the code: a row that differs, a property or a contract that
does not hold, a goal that can no longer be reached, a function of which a proof tells when it must be called
and that nothing calls any more. Another number of properties or goals, which any change of the text brings,
catches nothing.
"""

import json
import re
import sys
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from bounded import output_of

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
        found = self.catches.search(output_of(self.command, TIMEOUT_S, cwd=tree) or "")
        return found.group().strip() if found else ""


def contract_probe(file: str, function: str = "") -> Probe:
    """The contracts of one file of kernel/src, or of one function of it.

    To WP a function is what its contract says, so a changed body can only break the proof of its own.
    """
    one = ("--function", function) if function else ()
    command = (sys.executable, "verification/frama-c/run.py", *one, file)
    return Probe("wp", file, command, re.compile(r"^ +(NOT PROVED|OUT OF REACH) .*$", re.MULTILINE))


def proof_probe(name: str) -> Probe:
    """One proof of verification/cbmc."""
    command = (sys.executable, "verification/cbmc/run.py", name)
    told = r"^ +(\w+: .*|goal \w+ is \w+; expected.*|\w+ is to be replaced, but .* no such function)$"
    return Probe("cbmc", name, command, re.compile(told, re.MULTILINE))


def row_probe(phase: str) -> Probe:
    """The compiled kernel over the model's rows of one phase, or of `all`; see rows.py."""
    names = () if phase == "all" else (phase,)
    command = (sys.executable, str(HERE / "rows.py"), ".", *names)
    return Probe(
        "conformance", phase, command, re.compile(r"^\w+: (\d+ rows differ|the run).*$", re.MULTILINE)
    )


def test_probe(part: str) -> Probe:
    """The kernel's unit tests, the `short` or the `long` ones."""
    command = (sys.executable, str(HERE / "unit_tests.py"), ".", part)
    return Probe("tests", part, command, re.compile(r"^FAILED.*$", re.MULTILINE))


KINDS = {"tests": test_probe, "wp": contract_probe, "cbmc": proof_probe, "conformance": row_probe}


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


def contracts_of(tree: Path, file: Path) -> Mapping[str, object]:
    """The functions of a file of kernel/src whose contracts are proved of the sound one."""
    return json.loads((tree / "verification/frama-c/expected.json").read_text("utf-8")).get(file.name, {})


def probes_of_mutants(tree: Path, file: Path, function: str) -> Iterator[Probe]:
    """All that can see a change of the body of this function, the cheapest first."""
    yield test_probe("short")
    yield row_probe("all")
    if function in contracts_of(tree, file):
        yield contract_probe(file.name, function)
    yield test_probe("long")
    yield from map(proof_probe, proofs_about(tree, file))


def probes_for(tree: Path, file: Path) -> Iterator[Probe]:
    """All that can see this file of kernel/src, but the unit tests."""
    yield row_probe("all")
    yield from map(proof_probe, proofs_about(tree, file))
    if contracts_of(tree, file):
        yield contract_probe(file.name)
