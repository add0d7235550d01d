#!/usr/bin/env python3
"""Mutants of the core against unit tests, proofs and whole ticks: what none notices is unchecked.

Usage: run.py [--count N] [--each N] [--seed TEXT] [--without-tests] [--matrix] [--list].

The seed (the commit) puts all mutants in an order. Of each function the first --each (5) are drawn, or all
if there are fewer, then the next of all until there are --count (400). Mutants that do not compile, or
that are the same code as one that was drawn, are passed over. Each is shown to the rungs, the cheapest
first, until one notices it; with --matrix to all, with --without-tests to the proofs alone, of which
nine of ten must be noticed.

What nothing notices is an equivalent only if CBMC shows that it does the same as the sound kernel (equal.py),
or a compiler makes the same instructions of it (compiled.py).

Prints a line for each mutant, the kill matrix and the survivors; writes build/evidence/mutation.json and,
in build/evidence/mutation, mutants, kill matrix and survivors (tables.py); without the tests all of that as
mutation_without_tests.
Verdicts are kept by content in build/mutation; --list draws, and judges nothing.
"""

import argparse
import sys
import time
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "evidence"))

import evidence
import tables
from compiled import TRAPPING_CLANG, Compiler, is_sound_program
from equal import shown_equal
from functions import Function, function_at, functions_in
from operators import Mutant, draw, mutants_of
from probes import Probe, probes_of_mutants, test_probe
from tree import ROOT, make_tree, on_trees, seeded
from verdicts import RUNGS, Kept, Verdict

SOON = ("tests",)
"""Rungs that answer within a minute; all proofs about a file take longer."""


def core_files() -> list[str]:
    """The files of the core that hold decisions; the CRC's table is data, proved entry by entry."""
    files = sorted(path for path in (ROOT / "kernel/src").iterdir() if path.name != "crc32_table.c")
    return [str(path.relative_to(ROOT)) for path in files]


class Drawing:
    """Draws mutants in the seed's order: a share of each function, then the rest."""

    def __init__(self, functions: Sequence[Function], each: int, count: int) -> None:
        self._compiler = Compiler(make_tree(ROOT / "build/mutation/drawing"))
        self._tree = ROOT / "build/mutation/drawing"
        self._functions = functions
        self._each = each
        self._count = count
        self._codes: set[str] = set()
        self.drawn: list[Mutant] = []
        self.of_function: Counter[str] = Counter({function.name: 0 for function in functions})

    def _name(self, mutant: Mutant) -> str:
        function = function_at(self._functions, mutant.file, mutant.line)
        return function.name if function else ""

    def _is_new(self, mutant: Mutant) -> bool:
        with seeded(self._tree, mutant.file, mutant.line, mutant.before, mutant.after):
            code = self._compiler.code(mutant.file)
        if not code or code in self._codes:
            return False
        # Mutants that are the sound code to the compiler stay: that they are equal is to be shown.
        self._codes |= {code} - {self._compiler.sound}
        return True

    def _take(self, mutant: Mutant) -> None:
        if self._is_new(mutant):
            self.drawn.append(mutant)
            self.of_function[self._name(mutant)] += 1

    def run(self, ordered: Sequence[Mutant]) -> list[Mutant]:
        for mutant in ordered:
            name = self._name(mutant)
            if name and self.of_function[name] < self._each:
                self._take(mutant)
        taken = set(self.drawn)
        for mutant in ordered:
            if len(self.drawn) >= self._count:
                break
            if mutant not in taken and self._name(mutant):
                self._take(mutant)
        return self.drawn


def ask(tree: Path, probes: Iterable[Probe], every: bool) -> dict[str, str]:
    """What each rung says of the mutant in the tree, until one notices it; with `every` of all."""
    told: dict[str, str] = {}
    for probe in probes:
        if told.get(probe.rung):
            continue
        said = probe.catch(tree)
        told[probe.rung] = f"{probe.part}: {said}" if said else ""
        if said and not every:
            break
    return told


def compiled_alike(tree: Path, mutant: Mutant) -> str:
    """Why the mutant in the tree is no fault, if a compiler tells; empty when it does not."""
    if is_sound_program(tree, mutant.file, TRAPPING_CLANG):
        return "clang: the same instructions as the sound kernel, traps for undefined behaviour included"
    return ""


def why_equal(tree: Path, mutant: Mutant) -> str:
    """Why the mutant in the tree, of which no proof complains, is no fault; empty when that is not known."""
    if is_sound_program(tree, mutant.file):
        return "clang: the same instructions as the sound kernel"
    return shown_equal(tree, mutant.file, mutant.line)


def judge(tree: Path, mutant: Mutant, kept: Kept, asked: Sequence[str], every: bool) -> Verdict:
    """What becomes of one mutant before the rungs that are asked."""
    started = time.monotonic()
    with seeded(tree, mutant.file, mutant.line, mutant.before, mutant.after):
        if known := kept.find(tree):
            return known
        probes = [p for p in probes_of_mutants(tree, Path(mutant.file)) if p.rung in asked]
        # What does the same needs neither test nor proof to be asked.
        equal = compiled_alike(tree, mutant)
        told = {} if equal else ask(tree, [probe for probe in probes if probe.rung in SOON], every)
        if not equal and not any(told.values()):
            equal = shown_equal(tree, mutant.file, mutant.line, levels=1)
        if not equal and (every or not any(told.values())):
            told |= ask(tree, [probe for probe in probes if probe.rung not in SOON], every)
        reasons = tuple(f"{rung} {said}" for rung, said in told.items() if said)
        fate = "killed"
        if not reasons:
            equal = equal or why_equal(tree, mutant)
            fate, reasons = ("equivalent", (equal,)) if equal else ("survived", ())
        verdict = Verdict(fate, reasons, round(time.monotonic() - started, 1), told)
        kept.keep(tree, verdict)
    return verdict


def show(mutant: Mutant, verdict: Verdict) -> None:
    reasons = "".join(f"\n    {reason}" for reason in verdict.reasons)
    print(f"{verdict.fate:<10} {mutant.name:<40} {verdict.seconds:6.1f} s{reasons}", flush=True)


def judge_all(mutants: Sequence[Mutant], asked: Sequence[str], every: bool) -> list[Verdict]:
    """Judges the mutants, printing each as it is done."""
    kept = Kept(asked, every)

    def one(tree: Path, mutant: Mutant) -> Verdict:
        verdict = judge(tree, mutant, kept, asked, every)
        show(mutant, verdict)
        return verdict

    return on_trees("mutant-tree", list(mutants), one)


def figures_of(verdicts: Sequence[Verdict], least: int, functions: int) -> dict[str, float]:
    fates = Counter(verdict.fate for verdict in verdicts)
    by_rung = tables.by_rung(verdicts)
    return {
        "mutants": len(verdicts),
        "killed": fates["killed"],
        "equivalent": fates["equivalent"],
        "survived": fates["survived"],
        "functions": functions,
        "least_of_a_function": least,
        **{f"killed_by_{rung}": by_rung[rung]["killed"] for rung in RUNGS},
        "processor_s_of_first_judging": round(sum(verdict.seconds for verdict in verdicts), 1),
    }


def complaints_of_sound(tree: Path) -> list[str]:
    """What the cheap rungs say of the kernel as it is; a rung that complains of that kills nothing."""
    probes = (test_probe("short"), test_probe("long"))
    return [said for probe in probes if (said := probe.catch(tree))]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=400, help="mutants to draw at least (400)")
    parser.add_argument("--each", type=int, default=5, help="of each function at least (5)")
    parser.add_argument("--seed", default=evidence.commit(), help="chooses them (the commit)")
    parser.add_argument("--without-tests", action="store_true", help="ask the proofs alone")
    parser.add_argument("--matrix", action="store_true", help="show each mutant to every rung")
    parser.add_argument("--list", action="store_true", help="print the mutants that are drawn, and no more")
    arguments = parser.parse_args()
    started = time.monotonic()
    functions = functions_in(ROOT, core_files())
    ordered = draw(mutants_of(ROOT, core_files()), sys.maxsize, arguments.seed)
    drawing = Drawing(functions, arguments.each, arguments.count)
    mutants = drawing.run(ordered)
    least = min(drawing.of_function.values())
    few = sorted(name for name, count in drawing.of_function.items() if count < arguments.each)
    print(
        f"mutation: {len(mutants)} of {len(ordered)} mutants, drawn by {arguments.seed}, "
        f"of {len(functions)} functions; fewer than {arguments.each} there are of: {', '.join(few) or 'none'}"
    )
    if arguments.list:
        print("\n".join(f"{mutant.name}  {mutant.after.strip()}" for mutant in mutants))
        return 0
    if complaints := complaints_of_sound(make_tree(ROOT / "build/mutation/sound")):
        raise SystemExit(f"mutation: the sound kernel is noticed, too: {'; '.join(complaints)}")
    asked = RUNGS[1:] if arguments.without_tests else RUNGS
    verdicts = judge_all(mutants, asked, arguments.matrix)
    name = "mutation_without_tests" if arguments.without_tests else "mutation"
    log = evidence.log_directory(name)
    tables.write(log, mutants, verdicts, functions, arguments.matrix)
    print((log / "matrix.txt").read_text("utf-8"))
    print(f"survivors: {(log / 'survivors.txt').read_text('utf-8')}")
    figures = figures_of(verdicts, least, len(functions))
    print(", ".join(f"{name} {value}" for name, value in figures.items()))
    # Survivors are listed, not excused: the target is none, and without the unit tests one of ten.
    allowed = figures["killed"] / 9 if arguments.without_tests else 0
    sound = figures["mutants"] >= arguments.count and figures["killed"] > 0 and figures["survived"] <= allowed
    tools = {"gcc": "12", "seed": arguments.seed}
    return evidence.write(name, "PASSED" if sound else "FAILED", tools, figures, [], started)


if __name__ == "__main__":
    sys.exit(main())
