"""The core, compiled for another machine, on every row of the model: rung 2's comparison, made there."""

import re
import sys
import tomllib
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from build import BUILD, JOBS, ROOT, Machine, TargetError, run

sys.path.append(str(ROOT / "verification/conformance"))

import phases
from planted import planted_copy
from table import Phase, TableError, load_phase, unpacked
from tools import ToolError

CONFORMANCE = phases.HERE
PLANTED = CONFORMANCE / "planted/kernel_lease_stops_at_one.toml"
END = re.compile(r"^ROWS (\d+) DIFFERENCES (\d+)$", re.MULTILINE)


@dataclass(frozen=True)
class Compared:
    """What came of one phase: rows that were run, whether all of them agree, and what differs in words."""

    rows: int
    differing: int
    differences: tuple[str, ...]


def phase_named(name: str) -> Phase:
    """A phase file. Raises TargetError when it cannot be read."""
    try:
        return load_phase(CONFORMANCE / "phases" / f"{name}.toml")
    except (OSError, TableError) as error:
        raise TargetError(f"phase {name}: {error}") from error


def compile_core(machine: Machine, kernel: Path, folder: Path) -> list[str]:
    """The core's objects for the machine, each compiled as it is shipped. Returns the flags for the rest."""
    folder.mkdir(parents=True, exist_ok=True)
    flags = ["-std=c11", f"-I{kernel}/include", f"-I{kernel}/src", "-DILK_FRAME_WORDS=32"]
    sources = sorted((kernel / "src").glob("*.c"))
    with ThreadPoolExecutor(JOBS) as pool:
        list(
            pool.map(
                lambda source: run(
                    [*machine.compiler, *flags, "-c", str(source), "-o", str(folder / f"{source.stem}.o")]
                ),
                sources,
            )
        )
    return flags


def compare(machine: Machine, phase: Phase, folder: Path, flags: Sequence[str]) -> Compared:
    """The core of `folder` on all rows of a phase. Raises TargetError when it does not come to their end."""
    case, program = phases.OUTPUT / phase.name, folder / phase.name
    objects = sorted(str(path) for path in folder.glob("*.o") if f"{path.stem}.c" not in phase.includes)
    rest = [f"-I{case}", str(CONFORMANCE / "run_rows.c"), *objects, "-o", str(program)]
    run([*machine.compiler, *flags, *rest])
    data = (case / "rows.bin").read_bytes()
    text = run([*machine.runner, str(program), str(case / "rows.bin")], (0, 1))
    expected = len(data) // (4 * (len(phase.inputs) + len(phase.outputs)))
    end = END.search(text)
    if end is None or int(end[1]) != expected:
        raise TargetError(
            f"{machine.name} did not come to the end of the rows of {phase.name}:\n{text[-2000:]}"
        )
    differing = int(end[2])
    told = phases.differences(unpacked(phase, data), text, folder) if differing else []
    return Compared(expected, differing, tuple(f"{machine.name}: {line}" for line in told))


def compare_all(machine: Machine) -> Compared:
    """The core on all rows of all phases. Rows that rung 2 did not leave are printed by the model first."""
    names = phases.names()
    try:
        phases.print_missing(names)
    except (TableError, ToolError) as error:
        raise TargetError(f"the model's rows: {error}") from error
    folder = BUILD / f"rows-{machine.name}"
    flags = compile_core(machine, ROOT / "kernel", folder)
    with ThreadPoolExecutor(JOBS) as pool:
        found = list(pool.map(lambda name: compare(machine, phase_named(name), folder, flags), names))
    return Compared(
        sum(one.rows for one in found),
        sum(one.differing for one in found),
        tuple(line for one in found for line in one.differences),
    )


def planted_is_found(machine: Machine) -> bool:
    """Whether the rows notice a core with one line changed."""
    edit = tomllib.loads(PLANTED.read_text("utf-8"))
    folder = BUILD / f"rows-{machine.name}-planted"
    kernel = planted_copy(ROOT / "kernel", folder / "kernel", edit)
    flags = compile_core(machine, kernel, folder)
    return compare(machine, phase_named(edit["phase"]), folder, flags).differing > 0
