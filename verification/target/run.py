#!/usr/bin/env python3
"""The target rung: the same bits on x86-64, a Cortex-A9 and a bare Cortex-M4, and size and stack in bounds.

The unit tests run under qemu-arm. A long random trace gives one digest on x86-64 and on the Cortex-A9. Ten
minutes with faults, recorded by the black box, are replayed by both, and by a kernel with a rule removed,
which must be found with the tick that differs first. Single ticks from any sound state give one digest each:
x86-64 makes the table, both ARM machines compare with it, and must find the entry that was changed in a
copy of it. PASSED: no difference. VACUOUS: a planted difference or the removed rule was not found,
or trace and vectors do not bring every mode, cause, fault, verdict and gate.
"""

import re
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

sys.path.append(str(Path(__file__).resolve().parents[1] / "evidence"))

import evidence
import size
import told

from build import (
    BUILD,
    CORTEX_A9,
    CORTEX_M4,
    NATIVE,
    ROOT,
    Machine,
    TargetError,
    core_with,
    image,
    run,
    unit_tests,
)

VECTORS = 20_000
TICKS = 1_000_000
RECORDED_TICKS = 600_000
RECORDED_FAULT = "P5_stall_cleared_by_move"
PLANTED = 12_345
SHOWN_ELSEWHERE = {"gate": {2, 3, 12}}
"""By number: the gate's terms for pedal and E-stop stand behind the end of MOTION, that for stall behind the
fault. The unit tests bring them."""
PROPERTIES = ["P1", "P2", "P15", "P16"]
T = TypeVar("T")


def timed(what: str, work: Callable[[], T]) -> T:
    started = time.monotonic()
    result = work()
    print(f"{what:<40} {time.monotonic() - started:6.1f} s", flush=True)
    return result


def keep(name: str, output: str) -> str:
    (evidence.log_directory("target") / f"{name}.log").write_text(output, "utf-8")
    return output


def run_trace(machine: Machine) -> str:
    """What the trace prints: counts of what happened, and the digest."""
    command = image(machine, "trace", "trace", [f"-DTRACE_TICKS={TICKS}"])
    return keep(f"trace-{machine.name}", timed(f"{TICKS} ticks, {machine.name}", lambda: run(command)))


def never_seen(*outputs: str) -> list[str]:
    """Modes, causes, faults, verdicts and gates, by number, that neither the trace nor the vectors bring."""
    missing = []
    for name in ("mode", "cause", "fault", "verdict", "gate"):
        rows = [re.search(rf"^{name}((?: \d+)+)$", output, re.MULTILINE)[1].split() for output in outputs]
        for code, counts in enumerate(zip(*rows, strict=True)):
            if not any(map(int, counts)) and code not in SHOWN_ELSEWHERE.get(name, ()):
                missing.append(f"neither trace nor vectors bring {name} {code}")
    return missing


def make_tables() -> tuple[Path, Path]:
    """The table of digests that x86-64 makes, and a copy with one bit of one entry changed."""
    command = image(NATIVE, "vectors", "vectors", [f"-DVECTORS={VECTORS}"])
    rows = timed(f"{VECTORS} vectors, x86-64", lambda: run(command)).splitlines()
    table, planted = BUILD / "expected.inc", BUILD / "planted.inc"
    table.write_text("\n".join(rows) + "\n", "ascii")
    flipped = int(rows[PLANTED][1:11], 16) ^ 1
    rows[PLANTED] = f"{{0x{flipped:08x}{rows[PLANTED][11:]}"
    planted.write_text("\n".join(rows) + "\n", "ascii")
    return table, planted


def compare(machine: Machine, table: Path) -> tuple[list[int], str]:
    """Numbers of the vectors whose digest on this machine differs from the table, and all that it printed."""
    defines = [f"-DVECTORS={VECTORS}", f'-DEXPECTED="{table}"']
    command = image(machine, "vectors", f"vectors-{table.stem}", defines)
    output = timed(f"{VECTORS} vectors, {machine.name}, {table.stem}", lambda: run(command, (0, 1)))
    keep(f"vectors-{machine.name}-{table.stem}", output)
    if f"vectors {VECTORS}\n" not in output:
        raise TargetError(f"{machine.name} did not come to the end of the vectors:\n{output[-2000:]}")
    numbers = re.findall(r"^(?:mismatch|unsound) (\d+)$", output, re.MULTILINE)
    return [int(number) for number in numbers], output


def record() -> list[str]:
    """Records ten minutes with faults on x86-64; returns what tells the replay which file it is."""
    file = [f'-DRECORDING="{BUILD / "run.ilkr"}"']
    command = image(NATIVE, "record", "record", [*file, f"-DRECORDED_TICKS={RECORDED_TICKS}"])
    timed(f"{RECORDED_TICKS} ticks recorded, x86-64", lambda: run(command))
    return file


def replay(machine: Machine, file: list[str]) -> str:
    """What keeps the recording from coming out the same on this machine; empty when nothing does."""
    command = image(machine, "replay", "replay", file)
    output = timed(f"replayed, {machine.name}", lambda: run(command, (0, 1)))
    keep(f"replay-{machine.name}", output)
    if output.endswith(f"ticks {RECORDED_TICKS}\nidentical\n"):
        return ""
    return f"{machine.name}: the recorded run: {output.splitlines()[-1] if output else 'nothing was said'}"


def changed_kernel_differs(file: list[str]) -> bool:
    """Whether the replay by a kernel with a rule removed names the tick whose state differs first."""
    command = image(NATIVE, "replay", "replay-changed", file, core_with(RECORDED_FAULT))
    output = keep("replay-changed", timed("replayed, changed kernel", lambda: run(command, (0, 1))))
    return re.search(r"^differs tick \d+ state", output, re.MULTILINE) is not None


def run_unit_tests() -> int:
    """Number of unit tests that passed on the Cortex-A9. Raises TargetError when one does not."""
    command = timed("unit tests built for Cortex-A9", unit_tests)
    output = keep("unit-tests", timed("unit tests, Cortex-A9", lambda: run(command)))
    return int(re.search(r"\[  PASSED  \] (\d+) tests", output)[1])


def versions() -> dict[str, str]:
    compilers = {tool.name: tool.compiler[0] for tool in (CORTEX_A9, CORTEX_M4)}
    tools = {f"gcc for {name}": run([gcc, "-dumpfullversion"]).strip() for name, gcc in compilers.items()}
    return tools | {"qemu": re.search(r"version (\S+)", run(["qemu-arm", "--version"]))[1]}


def measure(figures: dict[str, float]) -> tuple[list[str], list[str]]:
    """Runs everything, fills in the figures; returns what is wrong and what makes the result worthless."""
    sizes = timed("size and stack", lambda: size.measure(ROOT / "build" / "target"))
    wrong = [
        f"{name} is {sizes[name]}, limit {limit}"
        for name, limit in size.LIMITS.items()
        if sizes[name] > limit
    ]
    traces = {machine.name: run_trace(machine) for machine in (NATIVE, CORTEX_A9)}
    if len(set(traces.values())) != 1:
        wrong.append(told.trace(TICKS, (NATIVE, CORTEX_A9)))
    table, planted = make_tables()
    machines = (CORTEX_A9, CORTEX_M4)
    compared = {machine.name: compare(machine, table) for machine in machines}
    differing = {machine: compared[machine.name][0] for machine in machines}
    for machine, numbers in differing.items():
        if numbers:
            wrong.append(
                f"{machine.name}: {len(numbers)} of {VECTORS} vectors differ from x86-64, the first is"
            )
            wrong.append(told.vector(numbers[0], (NATIVE, machine)))
    found = {machine.name: compare(machine, planted)[0] for machine in machines}
    recording = record()
    replayed = {machine.name: replay(machine, recording) for machine in (NATIVE, CORTEX_A9)}
    wrong += [difference for difference in replayed.values() if difference]
    changed_found = changed_kernel_differs(recording)
    (BUILD / "run.ilkr").unlink()
    vacuous = [f"{name}: the planted difference was not found" for name in found if found[name] != [PLANTED]]
    vacuous += [] if changed_found else ["the replay does not notice a changed kernel"]
    vacuous += never_seen(traces[NATIVE.name], compared[CORTEX_M4.name][1])
    figures.update(
        vectors=VECTORS,
        mismatches=sum(map(len, differing.values())),
        planted_found=sum(numbers == [PLANTED] for numbers in found.values()),
        trace_ticks=TICKS,
        trace_differs=len(set(traces.values())) - 1,
        replayed_ticks=RECORDED_TICKS,
        replays_differing=sum(map(bool, replayed.values())),
        changed_kernel_found=int(changed_found),
        unit_tests=run_unit_tests(),
        **sizes,
    )
    return wrong, vacuous


def main() -> int:
    started = time.monotonic()
    figures: dict[str, float] = {}
    failures = evidence.Failures("target")
    try:
        wrong, vacuous = measure(figures)
    except TargetError as error:
        failures.tell(f"target: {error}")
        return evidence.write("target", "FAILED", versions(), figures, PROPERTIES, started)
    for failure in (*wrong, *vacuous):
        failures.tell(failure)
    status = "FAILED" if wrong else "VACUOUS" if vacuous else "PASSED"
    return evidence.write("target", status, versions(), figures, PROPERTIES, started)


if __name__ == "__main__":
    sys.exit(main())
