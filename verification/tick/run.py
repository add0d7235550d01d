#!/usr/bin/env python3
"""The rung of whole ticks: CBMC shows over the real `ilk_step` that the monitors hold in every tick.

tick.h says how a tick is cut and why the steps add up; tick.toml lists the steps, and what each property
says and is shown to say. Before anything is run, `gaps` looks whether the steps do add up: that each part of
the relations that a step takes for granted is shown at the start and by each kind of step. Without arguments
every step is run and the evidence is written; with names of steps only those.
"""

import argparse
import os
import sys
import time
import tomllib
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "evidence"))
sys.path.append(str(Path(__file__).resolve().parents[1] / "cbmc"))

import evidence
import prover

HERE = Path(__file__).resolve().parent
SOURCES = sorted(path.name for path in (prover.ROOT / "kernel" / "src").glob("*.c") if path.name != "step.c")
"""harness.c includes step.c, whose phases are its own."""
STAND_INS = {
    "digest_of": "stand_in_digest",
    "ilk_crc32_words": "stand_in_crc",
    "frequency_word": "stand_in_frequency",
    "ilk_config_validate": "stand_in_validate",
    "ilk_frame_unpack": "stand_in_unpack",
    "checksum_is_right": "stand_in_checksum",
    "consent_of": "stand_in_consent",
}
REAL = {
    "reading": ["ilk_frame_unpack", "checksum_is_right"],
    "validity": ["ilk_config_validate"],
    "numbers": ["consent_of"],
}
"""Functions that a step takes as they are, because it is about them."""
PRODUCTS = {
    "kernel/src/axis.c": ["(uint64_t)config->max_delta_counts * axis->periods"],
    "kernel/monitors/monitors.c": ["(uint64_t)config->max_delta_counts * g->periods"],
}
"""What kernel and judge multiply alike. The prover need not compare multipliers: it takes each product for
the same unknown function of its factors. A claim that holds of every function holds of the product."""
CUTS = {
    "observation": "cut_after_observation",
    "drive": "cut_before_drive",
    "twins_see": "cut_of_seeing",
    "twins_drive": "cut_of_driving",
}
DOCUMENT = prover.ROOT / "docs" / "verification.md"
BEGIN, END = "<!-- claims of the whole tick -->", "<!-- end of the claims -->"
"""The marks between which the document shows the claims."""
SECONDS = 600
"""Processor time after which a step is given up."""


@dataclass(frozen=True)
class Step:
    """One run of the prover: an entry of harness.c, what it takes for granted and what it must show."""

    name: str
    entry: str
    slots: int = 1
    given: list[str] = field(default_factory=list)
    lemmas: list[str] = field(default_factory=list)
    shown: list[str] = field(default_factory=list)
    claims: list[str] = field(default_factory=list)
    supports: list[str] = field(default_factory=list)
    goals: int = 0
    unwind: int = 34
    named: int | None = None
    solver: str = ""


def load() -> tuple[list[Step], dict]:
    """The steps and the table of properties of tick.toml."""
    table = tomllib.loads((HERE / "tick.toml").read_text("utf-8"))
    return [Step(name, **entry) for name, entry in table["steps"].items()], table["properties"]


def kinds(step: Step) -> str:
    """What a step is for the induction: an entry, and for a request which slot it names."""
    return step.entry if step.named is None else f"{step.entry} {step.named}"


def gaps(steps: list[Step]) -> Iterator[str]:
    """Where the steps do not add up to an induction."""
    for slots in sorted({step.slots for step in steps}):
        of_size = [step for step in steps if step.slots == slots]
        needed = {"initially", "observation", "drive", *(f"one_request {axis}" for axis in range(slots + 1))}
        for part in sorted({part for step in of_size for part in step.given}):
            shown = {kinds(step) for step in of_size if part in step.shown}
            yield from (f"{part} is taken for granted, but not shown by: {kind}" for kind in needed - shown)
        shown_before: set[str] = set()
        for step in (step for step in of_size if step.entry == "observation"):
            yield from (f"{step.name}: {part} is not shown above" for part in set(step.lemmas) - shown_before)
            shown_before |= set(step.shown)


def with_products(logs: Path) -> dict[str, str]:
    """Copies of the files with products as functions. Raises ValueError when a product is not there once."""
    made = {}
    for name, products in PRODUCTS.items():
        text = (prover.ROOT / name).read_text("utf-8")
        for product in products:
            if text.count(product) != 1:
                raise ValueError(f"{name} does not say once: {product}")
            text = text.replace(product, f"__CPROVER_uninterpreted_product({product.replace(' * ', ', ')})")
        copy = logs / Path(name).name
        copy.write_text(
            f"#include <stdint.h>\nuint64_t __CPROVER_uninterpreted_product(uint64_t, uint64_t);\n{text}",
            "utf-8",
        )
        made[name] = str(copy)
    return made


def program(step: Step, kind: str, logs: Path) -> Path:
    """The goto program of a step. Raises ValueError with the tool's words."""
    logs.mkdir(parents=True, exist_ok=True)
    linked, cut, made = stages = [logs / f"{kind}.{stage}" for stage in ("linked", "cut", "goto")]
    for stage in stages:
        stage.unlink(missing_ok=True)
    parts = {"GIVEN": step.given, "LEMMAS": step.lemmas, "SHOWN": step.shown}
    claims = "".join(f"CLAIM({claim});" for claim in step.claims)
    defines = [f"-D{name}=({' | '.join(named) or '0'})" for name, named in parts.items()]
    defines += [f"-DCLAIMS={claims}", f"-DILK_SLOTS={step.slots}"]
    defines += [] if step.named is None else [f"-DNAMED={step.named}"]
    defines += ["-DILK_COVER"] if kind == "cover" else []
    files = [str((HERE / name).relative_to(prover.ROOT)) for name in ("harness.c", "relation.c")]
    copied = with_products(logs)
    files += [copied.get(f"kernel/src/{name}", f"kernel/src/{name}") for name in SOURCES]
    folders = [str(logs), "kernel/include", "kernel/src", "kernel/monitors", "verification/tick"]
    includes = [part for folder in folders for part in ("-I", folder)]
    compile_ = ["-std=c11", *defines, *includes, "--function", step.entry, "-o", str(linked), *files]
    told = prover.call("goto-cc", compile_, logs / f"{kind}.compile.log", prover.COMPILE_SECONDS)
    if not linked.exists():
        raise ValueError(told.strip()[-300:])
    asked = ["--list-goto-functions", str(linked)]
    listed = prover.call("goto-instrument", asked, logs / f"{kind}.functions.log", prover.COMPILE_SECONDS)
    present = {word.strip(",") for word in listed.split()}
    turned = {name: by for name, by in STAND_INS.items() if name not in REAL.get(step.entry, [])}
    turned |= {"answer_requests": CUTS[step.entry]} if step.entry in CUTS else {}
    turned |= {"ilk_request_take": "stand_in_take"} if step.entry == "all_requests" else {}
    calls = []
    for function, by in turned.items():
        copies = [name for name in sorted(present) if name.split("$link")[0] == function]
        if not copies:
            raise ValueError(f"{function} is to be replaced, but the program has no such function")
        calls += [part for copy in copies for part in ("--replace-calls", f"{copy}:{by}")]
    told = prover.call("goto-instrument", [*calls, str(linked), str(cut)], logs / f"{kind}.cut.log", 60)
    told += prover.call(
        "goto-instrument", ["--drop-unused-functions", str(cut), str(made)], logs / f"{kind}.drop.log", 60
    )
    if not made.exists():
        raise ValueError(told.strip()[-300:])
    return made


def entries(step: Step, kind: str, logs: Path) -> list[dict]:
    """What the prover says of each claim, or of each goal."""
    made = program(step, kind, logs)
    options = ["--no-standard-checks", "--slice-formula", "--unwind", str(step.unwind), *prover.JSON]
    options += [f"--{step.solver}"] if step.solver else []
    options += ["--cover", "cover"] if kind == "cover" else ["--unwinding-assertions"]
    told = prover.messages(prover.call("cbmc", [*options, str(made)], logs / f"{kind}.json", SECONDS))
    return prover.entries(told, "goals" if kind == "cover" else "result")


def prove(step: Step, logs: Path, failures: evidence.Failures) -> dict[str, int]:
    """Runs a step and counts what came out; says what is wrong."""
    started = time.monotonic()
    count = {"claims": 0, "failed": 0, "cover_goals": 0, "covered": 0, "unknown": 0}
    try:
        result = entries(step, "proof", logs / step.name)
        count["claims"] = len(result)
        for one in result:
            if one["status"] != "SUCCESS":
                count["failed"] += 1
                failures.tell(f"{step.name}: {one['description']}")
        if step.goals:
            reached = entries(step, "cover", logs / step.name)
            count["cover_goals"] = step.goals
            count["covered"] = sum(one["status"] == "satisfied" for one in reached)
            if count["covered"] != step.goals or len(reached) != step.goals:
                told = f"{count['covered']} of {len(reached)} goals reached; expected {step.goals}"
                failures.tell(f"{step.name}: {told}")
    except ValueError as error:
        count["unknown"] = 1
        failures.tell(f"{step.name} gave no answer: {error}")
    print(f"{step.name:20} {count} {time.monotonic() - started:6.1f} s", flush=True)
    return count


def table(properties: dict) -> str:
    """The claims as docs/verification.md shows them."""
    rows = ["| property | stated | shown | bound | exempt |", "|---|---|---|---|---|"]
    keys = ("stated", "shown", "bound", "exempt")
    for name, entry in properties.items():
        rows.append(f"| {name} | {' | '.join(entry.get(key, '') for key in keys)} |")
    return "\n".join(["Generated from `verification/tick/tick.toml`.", "", *rows])


def with_table(document: str, properties: dict) -> str:
    """The document with the claims of today between its marks."""
    head, rest = document.split(BEGIN)
    return f"{head}{BEGIN}\n{table(properties)}\n{END}{rest.split(END)[1]}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", help="steps to run; all when none is named")
    parser.add_argument("--table", action="store_true", help="write the claims into docs/verification.md")
    names = (arguments := parser.parse_args()).names
    started = time.monotonic()
    steps, properties = load()
    if arguments.table:
        DOCUMENT.write_text(with_table(DOCUMENT.read_text("utf-8"), properties), "utf-8")
        return 0
    if unknown_names := set(names) - {step.name for step in steps}:
        parser.error(f"no such step: {', '.join(sorted(unknown_names))}")
    if found := list(gaps(steps)):
        parser.error("\n".join(found))
    chosen = [step for step in steps if not names or step.name in names]
    logs, failures = evidence.log_directory("tick"), evidence.Failures("tick")
    with ThreadPoolExecutor(max_workers=int(os.environ.get("JOBS", "1"))) as pool:
        counts = list(pool.map(lambda step: prove(step, logs, failures), chosen))
    total = {key: sum(count[key] for count in counts) for key in counts[0]}
    unknown = total.pop("unknown")
    monitors = {claim for step in steps for claim in step.claims}
    figures = {
        "slots": max(step.slots for step in steps),
        **total,
        "monitors": len(monitors),
        "exempt": sum("exempt" in entry for entry in properties.values()),
    }
    vacuous = total["covered"] != total["cover_goals"]
    status = "FAILED" if total["failed"] else "UNKNOWN" if unknown else "VACUOUS" if vacuous else "PASSED"
    print(f"{status}: {figures} in {time.monotonic() - started:.0f} s")
    if names:
        return 0 if status == "PASSED" else 1
    shown = monitors | {name for step in steps for name in step.supports}
    whole = [name for name, entry in properties.items() if name in shown and "exempt" not in entry]
    return evidence.write("tick", status, {"CBMC": prover.version()}, figures, whole, started)


if __name__ == "__main__":
    sys.exit(main())
