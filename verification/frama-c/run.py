#!/usr/bin/env python3
"""The contract rung: every function of the core keeps its ACSL contract, whatever it is given.

Each file of the core is given to Frama-C's WP on its own, functions of headers once. The goals of each
function are compared with expected.json, exactly; places that a smoke test shows to be out of reach must be
in dead.toml, each with its reason. Without arguments the functions of expected.json are proved and the
evidence is written. It counts, and the output names, the other functions, of which nothing is claimed, and
contracts of such functions that the proved files take for granted. With the names of files only these are
proved, with `--function` only that function of them, and no evidence is written; nor with `--cached`, which
takes as proved what an earlier such run proved. `--all` tries the other functions of the files, too;
`--accept` then writes expected.json anew, with the functions of which all is proved, and the scripts of goals
that the first prover does not find soon.
"""

import argparse
import json
import os
import re
import subprocess
import sys
import time
import tomllib
from collections.abc import Collection, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "evidence"))

import evidence
import scripts
from wp import CORE, CVC4_FIRST, FIRST_SECONDS, ROOT, Place, Report, functions_of, prove, provers_in_turn

HERE = Path(__file__).resolve().parent
EXPECTED = HERE / "expected.json"
HEADERS = ("arith.h", "crc32.h")
"""Headers with functions in them."""

Expected = Mapping[str, Mapping[str, Mapping[str, int]]]


@dataclass(frozen=True)
class Unit:
    """A file of the core: the functions whose one definition it holds, and all that are called there."""

    own: tuple[str, ...]
    called: frozenset[str]


def units_of_core() -> dict[str, Unit]:
    """The files that define functions, by name. A header's functions are its own in no other file."""
    seen: set[str] = set()
    units = {}
    for name in (*HEADERS, *sorted(path.name for path in CORE.glob("*.c"))):
        functions = functions_of(name)
        own = tuple(function for function in functions.defined if function not in seen)
        if name in HEADERS:
            seen.update(own)
        if own:
            units[name] = Unit(own, functions.called)
    return units


def write_prover_list(directory: Path) -> None:
    """Why3's list of provers, made anew, so that nobody's home directory decides what is run.

    Z3 must not choose its search by the look of a goal: for most of ours it then misses, in minutes, what the
    plain search finds in milliseconds. Nor does it look for models of quantified formulas: that finds none of
    our proofs, and what is not provable takes it all its steps (decision 14). Why3 puts arguments that stand
    behind the path before its own.
    """
    config = directory / "why3.conf"
    config.unlink(missing_ok=True)
    subprocess.run(["why3", "--config", str(config), "config", "detect"], check=True, capture_output=True)
    text, found = re.subn(
        r'^(path = ".*/z3)"$',
        r'\1 smt.auto_config=false smt.mbqi=false"',
        config.read_text("utf-8"),
        flags=re.M,
    )
    if found != 1:
        raise SystemExit(f"Why3 found {found} provers named z3, not one; see {config}")
    config.write_text(text, "utf-8")


def version(command: Sequence[str]) -> str:
    """The version number in what a tool says of itself."""
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    number = re.search(r"\d+(?:\.\d+)+\S*", text)
    return number.group(0) if number else text.strip()


def tools() -> dict[str, str]:
    return {
        "Frama-C": version(["frama-c", "-version"]),
        "Why3": version(["why3", "--version"]),
        "Z3": version(["z3", "--version"]),
        "CVC4": version(["cvc4", "--version"]),
    }


def allowed_dead() -> set[tuple[str, str]]:
    """File and text of each line that may be out of reach."""
    document = tomllib.loads((HERE / "dead.toml").read_text("utf-8"))
    return {(entry["file"], entry["line"]) for entry in document.get("dead", [])}


def line_of(place: Place) -> tuple[str, str]:
    """File and text of the line of a place."""
    return place.file, (CORE / place.file).read_text("utf-8").splitlines()[place.line - 1].strip()


def show(kind: str, place: Place) -> None:
    print(f"    {kind} {place.file}:{place.line} {place.function}: {place.clause}")


def judge(unit: str, report: Report, expected: Expected, allowed: set[tuple[str, str]]) -> dict[str, int]:
    """Prints how a file came out; returns its figures, with `wrong` the number of things that are."""
    counts = report.counts.values()
    goals, proved = sum(c.goals for c in counts), sum(c.qed + c.smt for c in counts)
    smoke = sum(c.smoke for c in counts)
    dead = [place for place in report.dead if line_of(place) not in allowed]
    wanted = expected.get(unit, {})
    differing = [
        function
        for function in report.counts.keys() | wanted.keys()
        if function not in report.counts or asdict(report.counts[function]) != wanted.get(function)
    ]
    print(
        f"{unit:14} {len(counts):3} functions {proved:5}/{goals:<5} goals {smoke:4} smoke tests"
        f" {report.seconds:7.1f} s",
        flush=True,
    )
    for place in report.unproved:
        show("NOT PROVED", place)
    for place in dead:
        show("OUT OF REACH", place)
    for function in report.uncontracted:
        print(f"    NO CONTRACT {unit} {function}: say what it assigns and ensures")
    for function in sorted(differing):
        was, now = wanted.get(function), report.counts.get(function)
        print(f"    GOALS DIFFER {unit} {function}: expected {was}, got {now and asdict(now)}")
    return {
        "functions": len(counts),
        "goals": goals,
        "proved": proved,
        "smoke_tests": smoke,
        "smoke_failed": len(dead),
        "wrong": goals - proved + len(report.uncontracted) + len(differing),
    }


def provers_work(name: str, counts: Mapping[str, Mapping[str, int]]) -> tuple[bool, int]:
    """Orders files by the time that provers take for them: goals about all axes take longest."""
    return name in CVC4_FIRST, sum(count["smt"] + count["smoke"] for count in counts.values())


def run(functions: Mapping[str, Sequence[str]], directory: Path, cache: Path | None) -> dict[str, Report]:
    """Proves functions of each file, the longest first, on as many cores as JOBS says.

    One file more than there are cores is in hand, as a third of its time each waits between provers.
    """
    expected = read_expected()
    longest_first = sorted(
        functions, key=lambda name: provers_work(name, expected.get(name, {})), reverse=True
    )
    with ThreadPoolExecutor(max_workers=int(os.environ.get("JOBS", "1")) + 1) as pool:
        started = {
            name: pool.submit(prove, name, functions[name], directory, cache) for name in longest_first
        }
        return {name: future.result() for name, future in started.items()}


def read_expected() -> Expected:
    return json.loads(EXPECTED.read_text("utf-8"))


def proved_functions(report: Report) -> dict[str, dict[str, int]]:
    """The functions that say what they assign and ensure, and of which every goal is proved, by name."""
    return {
        function: asdict(counts)
        for function, counts in sorted(report.counts.items())
        if function not in report.uncontracted and counts.goals == counts.qed + counts.smt
    }


def accept(reports: Mapping[str, Report]) -> None:
    """Writes expected.json and the scripts anew for the files that were tried."""
    expected = {**read_expected(), **{name: proved_functions(report) for name, report in reports.items()}}
    EXPECTED.write_text(json.dumps(expected, indent=1, sort_keys=True) + "\n", "utf-8")
    for name, report in reports.items():
        scripts.keep(report.log, provers_in_turn(name)[0], float(FIRST_SECONDS))


def properties(reports: Sequence[Report]) -> list[str]:
    """The properties that proved clauses are named for, such as P1 for P1_gate."""
    names = {match.group(0) for r in reports for c in r.clauses if (match := re.match(r"P\d+(?=_)", c))}
    return sorted(names, key=lambda name: int(name[1:]))


def judge_all(reports: Mapping[str, Report], expected: Expected, whole: bool) -> dict[str, int]:
    """Judges each file; returns the sums of their figures. In the `whole` no exception, no script is idle."""
    allowed = allowed_dead()
    figures = [judge(name, report, expected, allowed) for name, report in sorted(reports.items())]
    total = {key: sum(figure[key] for figure in figures) for key in figures[0]}
    used = {line_of(place) for report in reports.values() for place in report.dead}
    for file, line in sorted(allowed - used) if whole else []:
        print(f"    IN REACH {file}: '{line}' is in dead.toml; take it out")
        total["wrong"] += 1
    for goal in scripts.idle(report.log for report in reports.values()) if whole else []:
        print(f"    NO SUCH GOAL {goal}: take its script out")
        total["wrong"] += 1
    return total


def reach(units: Mapping[str, Unit], tried: Collection[str], expected: Expected) -> dict[str, int]:
    """How far the proofs reach: functions without one, and contracts of those that the `tried` files use."""
    missing = {name: [f for f in unit.own if f not in expected.get(name, {})] for name, unit in units.items()}
    without = {function for functions in missing.values() for function in functions}
    assumed = {name: sorted(units[name].called & without) for name in sorted(tried)}
    for name, functions in missing.items():
        if functions:
            print(f"{name:14} no contract proof of {', '.join(functions)}")
    for name, functions in assumed.items():
        for function in functions:
            print(f"{name:14} takes for granted the contract of {function}")
    return {
        "functions_without_contract_proof": len(without),
        "assumed_contracts": len({function for functions in assumed.values() for function in functions}),
    }


def choose(units: Mapping[str, Unit], names: Sequence[str], expected: Expected) -> dict[str, list[str]]:
    """The functions to prove of each named file: those expected. Exits when the core has no such file."""
    unknown = sorted(set(names) - units.keys())
    if unknown:
        raise SystemExit(
            f"no functions in '{unknown[0]}' of the core; expected one of {', '.join(sorted(units))}"
        )
    return {name: [f for f in units[name].own if f in expected.get(name, {})] for name in names}


def only(function: str, chosen: Mapping[str, Sequence[str]]) -> dict[str, list[str]]:
    """The one function, in the file that holds it. Exits when none of the chosen files does."""
    found = {name: [function] for name, functions in chosen.items() if function in functions}
    if not found:
        raise SystemExit(f"no contract of '{function}' is expected to be proved in {', '.join(chosen)}")
    return found


def narrowed(expected: Expected, chosen: Mapping[str, Sequence[str]]) -> Expected:
    """What is expected of the chosen functions alone."""
    return {
        name: {function: expected[name][function] for function in functions}
        for name, functions in chosen.items()
    }


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "units", nargs="*", help="files of kernel/src to prove; those of expected.json when none"
    )
    parser.add_argument("--function", help="prove this one function of the named files")
    parser.add_argument("--all", action="store_true", help="try the functions that are not expected, too")
    parser.add_argument("--cached", action="store_true", help="reuse goals proved before; write no evidence")
    parser.add_argument("--accept", action="store_true", help="write expected.json and the scripts anew")
    arguments = parser.parse_args()
    started = time.monotonic()
    directory = evidence.log_directory("wp")
    write_prover_list(directory)
    units = units_of_core()
    expected = read_expected()
    chosen = choose(units, arguments.units or sorted(expected), expected)
    if arguments.all:
        chosen = {name: list(units[name].own) for name in chosen}
    elif not all(chosen.values()):
        raise SystemExit("a file of which nothing is expected to be proved: use --all")
    if arguments.function:
        chosen = only(arguments.function, chosen)
    cache = ROOT / "build/wp-cache" if arguments.cached else None
    if cache:
        cache.mkdir(parents=True, exist_ok=True)
    reports = run(chosen, directory, cache)
    if arguments.accept:
        accept(reports)
        expected = read_expected()
    whole = not (arguments.units or arguments.function)
    judged = narrowed(expected, chosen) if arguments.function else expected
    total = judge_all(reports, judged, whole)
    wrong = total.pop("wrong")
    total |= reach(units, chosen, expected)
    status = "FAILED" if wrong else ("VACUOUS" if total["smoke_failed"] else "PASSED")
    print(f"{status}: {total}")
    if not whole or arguments.all or cache:
        return 0 if status == "PASSED" else 1
    return evidence.write("wp", status, tools(), total, properties(list(reports.values())), started)


if __name__ == "__main__":
    sys.exit(main())
