"""Frama-C's WP on one file of the kernel: what to run, and what its reports say."""

import csv
import json
import os
import re
import subprocess
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import scripts

ROOT = Path(__file__).resolve().parents[2]
CORE = ROOT / "kernel/src"

WRAPPING = frozenset(
    {"arith.h", "checks.c", "config.c", "crc32.h", "crc32.c", "frame.c", "integrity.c", "step.c"}
)
"""Files that compute modulo 2^32 on purpose (counters, sequence numbers, checksums, digests). In every other
file an unsigned operation that leaves its type is a goal that cannot be proved."""

CVC4_FIRST = frozenset({"mode.c", "request.c", "step.c"})
"""Files whose functions change all axes. Z3 combines every three addresses of a goal, and these have many;
the prover that is asked first takes its whole time before the other one is asked."""

FIRST_SECONDS, LAST_SECONDS = "5", "40"
"""What a prover gets for a goal, first when each is tried in turn, then for those that neither proved.
Little at first, as what one does not find soon the other mostly does; a busy machine takes its time."""

PREPROCESSOR = f"-I{ROOT / 'kernel/include'} -I{CORE} -DILK_FRAME_WORDS=32"
PARSE = ["frama-c", "-c11", "-machdep", "gcc_x86_64", f"-cpp-extra-args={PREPROCESSOR}"]
PROVE = ["-warn-signed-downcast", "-wp-rte", "-wp-model", "Typed", "-wp-par", "1"]
PROVE += ["-wp", "-wp-timeout", FIRST_SECONDS, "-wp-session", str(scripts.SESSION), "-wp-time-extra", "20"]
PROVE_REST = ["-then", "-wp", "-wp-timeout", LAST_SECONDS]
SMOKE_TEST = ["-then", "-wp", "-wp-smoke-tests", "-wp-prover=-cvc4"]
SMOKE_TEST += ["-wp-par", "4", "-wp-steps", "300000", "-wp-smoke-timeout", "20"]
"""A second run, of the smoke tests alone: one that passes takes all that a prover may take. Hence Z3 alone,
bounded in its own steps, which are the same on every machine; the seconds are there for a machine gone wrong.
Most of a test's time is Why3's waiting, so several go at once. WP forgets between runs what to prove."""
SMOKE = "_wp_smoke_"


@dataclass(frozen=True)
class Functions:
    """The functions that a file and its headers define, and those called there, whoever defines them."""

    defined: tuple[str, ...]
    called: frozenset[str]


@dataclass
class Counts:
    """Goals of one function: proved without a prover (`qed`), by one (`smt`), not at all; and smoke tests."""

    goals: int = 0
    qed: int = 0
    smt: int = 0
    smoke: int = 0


@dataclass(frozen=True)
class Place:
    """Something that did not come out as it should: where, and the clause with its property."""

    file: str
    line: int
    function: str
    clause: str


@dataclass
class Report:
    """What WP said about one file."""

    counts: dict[str, Counts] = field(default_factory=dict)
    unproved: list[Place] = field(default_factory=list)
    dead: list[Place] = field(default_factory=list)
    uncontracted: list[str] = field(default_factory=list)
    clauses: set[str] = field(default_factory=set)
    seconds: float = 0.0
    log: str = ""


def functions_of(unit: str) -> Functions:
    """Functions of a file and of the headers that it includes, as Frama-C counts them."""
    command = [*PARSE, str(CORE / unit), "-metrics"]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout

    def listed(title: str) -> list[tuple[str, str]]:
        found = re.search(rf"{title} \(\d+\)\n\s*=+\n(.*?)\n\s*\n", text, re.DOTALL)
        if found is None:
            raise SystemExit(f"{unit}: Frama-C's metrics have no list '{title}':\n{text}")
        return re.findall(r"(\w+) \((\d+) calls?\)", found.group(1))

    defined = listed("Defined functions")
    declared = [*listed("Specified-only functions"), *listed("Undefined and unspecified functions")]
    called = (name for name, calls in (*defined, *declared) if calls != "0")
    return Functions(tuple(name for name, _ in defined), frozenset(called))


def provers_in_turn(unit: str) -> tuple[str, str]:
    """The provers of a goal without a script, in the order in which they are asked."""
    return ("cvc4", "z3") if unit in CVC4_FIRST else ("z3", "cvc4")


def prove(unit: str, functions: Sequence[str], directory: Path, cache: Path | None) -> Report:
    """Proves the contracts of `functions`, which `unit` defines. Raw output goes to `directory`.

    With a `cache`, goals that were proved before are not proved again; evidence is made without one.
    """
    stem = directory / unit
    overflow = [] if unit in WRAPPING else ["-warn-unsigned-overflow"]
    provers = ["-wp-prover", f"script,{','.join(provers_in_turn(unit))}"]
    caching = ["-wp-cache", "update", "-wp-cache-dir", str(cache)] if cache else ["-wp-cache", "none"]
    chosen = ["-wp-fct", ",".join(functions)]
    command = [
        *(*PARSE, str(CORE / unit), *PROVE, *provers, *overflow, *caching),
        *(*chosen, *PROVE_REST, *chosen, *SMOKE_TEST, *chosen),
        *("-wp-report-json", f"{stem}.json", "-then", "-report-csv", f"{stem}.csv"),
    ]
    started = time.monotonic()
    # Frama-C tells the folders of places as seen from $PWD, wherever it runs.
    environment = {**os.environ, "WHY3CONFIG": str(directory / "why3.conf"), "PWD": str(ROOT)}
    outcome = subprocess.run(command, capture_output=True, text=True, env=environment, cwd=ROOT, check=False)
    report = Report(seconds=time.monotonic() - started, log=outcome.stdout)
    log_file = Path(f"{stem}.log")
    log_file.write_text(outcome.stdout + outcome.stderr, "utf-8")
    if outcome.returncode != 0:
        raise SystemExit(f"{unit}: Frama-C gave up; see {log_file}\n{outcome.stdout[-2000:]}")
    count_goals(report, json.loads(Path(f"{stem}.json").read_text("utf-8")), functions)
    find_unproved(report, Path(f"{stem}.csv"), functions)
    return report


def count_goals(report: Report, document: dict, functions: Sequence[str]) -> None:
    """Goals by function, from WP's report."""
    for function in functions:
        counts = report.counts.setdefault(function, Counts())
        for name, provers in document["wp:functions"].get(function, {}).items():
            if name == "wp:section":
                continue
            total = provers["wp:main"]["total"]
            if SMOKE in name:
                counts.smoke += total
                continue
            qed = provers.get("qed", {}).get("valid", 0)
            counts.goals += total
            counts.qed += qed
            counts.smt += provers["wp:main"].get("valid", 0) - qed


def find_unproved(report: Report, table: Path, functions: Sequence[str]) -> None:
    """Clauses not proved, places out of reach, and functions that do not say what they assign and ensure.

    A smoke test that fails shows in the table as an assertion of falsehood that was proved. The text of a
    property may go on in lines that have no other column. A function's precondition stands with its callers,
    a row for each call; the row of its own sums up all calls, those by functions that were not tried, too.
    """
    stated: dict[str, set[str]] = {function: set() for function in functions}
    with table.open(encoding="utf-8", newline="") as rows:
        for row in csv.DictReader(rows, delimiter="\t", quoting=csv.QUOTE_NONE):
            if row["line"] is None or row["property kind"] == "precondition":
                continue
            place = Place(
                row["file"], int(row["line"]), row["function"], f"{row['property kind']} {row['property']}"
            )
            if row["status"] == "Invalid or unreachable":
                report.dead.append(place)
            elif row["function"] in stated and row["directory"].startswith("kernel"):
                stated[row["function"]].add(row["property kind"])
                if row["status"] in ("Valid", "Partially proven"):
                    report.clauses.add(row["property"].split(":")[0])
                else:
                    report.unproved.append(place)
    needed = {"assigns clause", "postcondition"}
    report.uncontracted = [function for function, kinds in stated.items() if not needed <= kinds]
