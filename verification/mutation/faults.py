#!/usr/bin/env python3
"""Shows that the rungs notice faults: seeds each line of faults.toml and wants the named proofs to fail.

Usage: faults.py [--check | --all | --seed TEXT] [--find] [NAME ...]. Without a name a third of the faults,
chosen by the seed (the commit). A fault counts as caught when each `RUNG PART` that its `caught_by` names
notices it. With --find every part of every rung is tried instead, and what catches the fault is printed, one
part a rung, to be written into faults.toml. With --check nothing is seeded: it names only those faults whose
line the kernel no longer has.

Prints a table of faults and rungs, the wrong variants of the model among them with what rung 1 last said of
each ("-": the rung was asked and noticed nothing); writes build/evidence/faults.json.
"""

import argparse
import sys
import time
import tomllib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "evidence"))

import evidence
from model_faults import NOT_ASKED, UNNOTICED, ModelFault, model_faults
from operators import draw
from probes import Probe, probe_named, probes_for
from rows import all_phases, print_missing
from tree import ROOT, UnusableFaultError, line_of, on_trees, seeded

FAULTS = Path(__file__).with_name("faults.toml")
RUNGS = ("model", "conformance", "cbmc", "wp")


@dataclass(frozen=True)
class Fault:
    """One changed line of the kernel: which promise it breaks, and what must notice."""

    name: str
    why: str
    file: str
    before: str
    after: str
    caught_by: tuple[str, ...]


@dataclass(frozen=True)
class Outcome:
    fault: Fault
    told: dict[str, str]
    """What each part said that caught it."""
    asked: frozenset[str]
    """The rungs that were asked."""
    complaint: str
    seconds: float


def read_faults() -> list[Fault]:
    """All faults, in the order of the file."""
    entries = tomllib.loads(FAULTS.read_text("utf-8"))["fault"]
    return [Fault(**{**entry, "caught_by": tuple(entry["caught_by"])}) for entry in entries]


def check(faults: Sequence[Fault]) -> int:
    """Names the faults whose line the kernel no longer has exactly once; 1 when there is one."""
    wrong = 0
    for fault in faults:
        try:
            line_of((ROOT / fault.file).read_text("utf-8"), fault.before, fault.file)
        except UnusableFaultError as error:
            wrong = 1
            print(f"{fault.name}: {error}")
    return wrong


def catches(probes: Sequence[Probe], tree: Path) -> Iterator[tuple[str, str]]:
    """The parts that notice, with what they say; after the first of a rung the rest of it is not asked."""
    done: set[str] = set()
    for probe in probes:
        told = "" if probe.rung in done else probe.catch(tree)
        if told:
            done.add(probe.rung)
            part = told.partition(":")[0] if probe.rung == "conformance" else probe.part
            yield f"{probe.rung} {part}", told


def judge(fault: Fault, tree: Path, find: bool) -> Outcome:
    """Seeds the fault and asks the parts that must notice it, or all."""
    started = time.monotonic()
    asked: frozenset[str] = frozenset()
    try:
        line = line_of((tree / fault.file).read_text("utf-8"), fault.before, fault.file)
        probes = list(probes_for(tree, Path(fault.file))) if find else [*map(probe_named, fault.caught_by)]
        asked = frozenset(probe.rung for probe in probes)
        with seeded(tree, fault.file, line, fault.before, fault.after):
            told = dict(catches(probes, tree))
        missed = [] if find else [part for part in fault.caught_by if part not in told]
        complaint = f"unnoticed by {', '.join(missed)}" if missed else "" if told else "unnoticed by all"
    except UnusableFaultError as error:
        told, complaint = {}, str(error)
    return Outcome(fault, told, asked, complaint, time.monotonic() - started)


def show(outcome: Outcome) -> None:
    verdict = "FAILED" if outcome.complaint else "caught"
    print(f"{verdict}  {outcome.fault.name:<36} {outcome.seconds:6.1f} s  {outcome.complaint}")
    for part, told in outcome.told.items():
        print(f"        {part}: {told}", flush=True)


def judge_all(faults: Sequence[Fault], find: bool) -> list[Outcome]:
    """Judges the faults, printing each as it is done."""

    def one(tree: Path, fault: Fault) -> Outcome:
        outcome = judge(fault, tree, find)
        show(outcome)
        return outcome

    return on_trees("fault-tree", faults, one)


def phases_named_by(faults: Sequence[Fault]) -> set[str]:
    """The phases of the tick whose rows must notice one of the faults."""
    probes = (probe_named(name) for fault in faults for name in fault.caught_by)
    return {probe.part for probe in probes if probe.rung == "conformance"}


def cells(outcome: Outcome) -> dict[str, str]:
    """For each rung the part that caught the fault, or UNNOTICED, or NOT_ASKED."""
    parts = dict(part.split(" ", 1) for part in outcome.told)
    return {rung: parts.get(rung, UNNOTICED) if rung in outcome.asked else NOT_ASKED for rung in RUNGS}


def table(outcomes: Sequence[Outcome], of_model: Sequence[ModelFault]) -> str:
    """Which rung caught which fault, by which of its parts: of the kernel, then of the model."""
    rows = [(outcome.fault.name, cells(outcome)) for outcome in outcomes]
    rows += [(f"model: {fault.name}", {"model": fault.told}) for fault in of_model]
    lines = [f"{'fault':<44} " + " ".join(f"{rung:<18}" for rung in RUNGS)]
    for name, told in rows:
        lines.append(f"{name:<44} " + " ".join(f"{told.get(rung, NOT_ASKED):<18}" for rung in RUNGS))
    return "\n".join(line.rstrip() for line in lines)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", help="faults to seed")
    parser.add_argument("--check", action="store_true", help="only show that each can still be seeded")
    parser.add_argument("--all", action="store_true", help="seed every fault")
    parser.add_argument("--seed", default=evidence.commit(), help="chooses a third (the commit)")
    parser.add_argument("--find", action="store_true", help="try every part of every rung")
    arguments = parser.parse_args()
    started = time.monotonic()
    faults = read_faults()
    if arguments.check:
        return check(faults)
    if unknown := set(arguments.names) - {fault.name for fault in faults}:
        parser.error(f"no fault of that name in faults.toml: {', '.join(sorted(unknown))}")
    if arguments.names:
        chosen = [fault for fault in faults if fault.name in arguments.names]
    else:
        chosen = faults if arguments.all else draw(faults, -(-len(faults) // 3), arguments.seed)
    print(f"faults: {len(chosen)} of {len(faults)} seeded one at a time", flush=True)
    # Before the trees are used side by side, or two of them would write the same rows.
    print_missing(all_phases() if arguments.find else phases_named_by(chosen))
    outcomes = judge_all(chosen, arguments.find)
    of_model = [] if arguments.names else list(model_faults())
    print(table(outcomes, of_model))
    figures = {
        "faults": len(outcomes),
        "caught": sum(not outcome.complaint for outcome in outcomes),
        "model_faults": sum(fault.told != NOT_ASKED for fault in of_model),
        "model_faults_caught": sum(fault.told not in (NOT_ASKED, UNNOTICED) for fault in of_model),
    }
    passed = figures["faults"] == figures["caught"] > 0
    passed = passed and figures["model_faults"] == figures["model_faults_caught"]
    return evidence.write("faults", "PASSED" if passed else "FAILED", {"gcc": "12"}, figures, [], started)


if __name__ == "__main__":
    sys.exit(main())
