"""Results of proofs and tests, converted from build/evidence and the JUnit reports in build/reports.

Nothing here is written by hand: a status comes from what a tool left behind, or the result is UNKNOWN. Each
rung of the ladder that judges several things (claims, harnesses, properties) gives a result for
each of them; the rung's own status caps theirs.
"""

import json
import re
import sys
import tomllib
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "evidence"))

from evidence import SOUND
from expected import Check

AWAITED = "AWAITED"
"""The status of a check that a release demands, that this report does not, and that is not there."""
PROPERTY = re.compile(r"(?<![A-Za-z0-9])(P(?:1[0-8]|[1-9])|L[12])(?=_)")
"""A property's identifier where a name begins with it: P1_gate, test_P2_P8_..., ensures P7_drive."""
TYPES = "TypeOK"
"""The invariant of each model that says what its variables range over; no requirement rests on it."""
GTEST_GROUP = re.compile(r"(?:\w+\.(?=[\w/]+\.\w))?[\w/]+(?=\.)")
"""Program, where CTest has it in the name, and suite; a parameter after the test's name may hold anything."""
SUITES = ("unit", "integration", "network", "console", "browser")


@dataclass(frozen=True)
class Result:
    """What one tool says about one thing."""

    uid: str
    title: str
    method: str
    """Test, Proof, ModelCheck or Analysis, as in the field VERIFICATION of a requirement."""
    status: str
    tool: str
    commit: str
    date: str
    bounds: str
    """Counts, and what bounds them."""
    log: str
    """The raw log, from the top of the tree."""
    supports: frozenset[str]
    """Identifiers of properties."""
    place: str = ""
    """What was run, from the top of the tree: harness, model, test program."""
    fresh: bool = True
    """False when what it was made from has changed since."""
    machine: str = ""
    """Operating system, architecture and cores, where the evidence tells them."""
    cases: tuple[str, ...] = ()
    """For tests: the names of all that ran."""
    failures: tuple[str, ...] = ()
    """For tests: those that did not pass, skipped ones among them."""


@dataclass(frozen=True)
class Source:
    """Where evidence lies, and what it must be made from."""

    root: Path
    commit: str
    """The commit for which the report is made, with `+changes` where the tree differs from it."""
    is_current: Callable[[str], bool]
    """Whether a check's inputs are those from which its evidence was made."""

    def made(self, commit: str) -> bool:
        """Whether what names `commit` was made from it. Two trees with changes of their own may differ."""
        return commit == self.commit and not commit.endswith("+changes")

    @property
    def evidence(self) -> Path:
        return self.root / "build/evidence"


@dataclass(frozen=True)
class Rung:
    """What build/evidence/ID.json says."""

    name: str
    status: str
    tool: str
    commit: str
    date: str
    figures: Mapping[str, float]
    supports: frozenset[str]
    fresh: bool
    logs: str
    text: str = field(repr=False)
    """What the rung printed."""
    machine: str = ""

    def result(self, uid: str, title: str, method: str, status: str, **more: object) -> Result:
        """A result of this rung. It is no better than the rung as a whole."""
        capped = status if self.status in SOUND else self.status
        common = {
            "tool": self.tool,
            "commit": self.commit,
            "date": self.date,
            "machine": self.machine,
            "fresh": self.fresh,
        }
        defaults = {"bounds": "", "log": f"{self.logs}/run.log", "supports": frozenset()}
        return Result(uid=uid, title=title, method=method, status=capped, **{**common, **defaults, **more})


def named_tools(names: str, versions: str) -> str:
    """Each tool with its version, from two lists; lists of unlike length as they are."""
    pairs = list(zip(names.split(", "), versions.split(", "), strict=False))
    if len(pairs) != len(names.split(", ")) or len(pairs) != len(versions.split(", ")):
        return f"{names} {versions}"
    return ", ".join(f"{name} {version}" for name, version in pairs)


def read_rung(source: Source, name: str) -> Rung | None:
    """The evidence of a rung, or nothing when there is none that can be read."""
    try:
        document = json.loads((source.evidence / f"{name}.json").read_text("utf-8"))
        logs = source.evidence / name
        printed = logs / "run.log"
        return Rung(
            name=name,
            status=document["status"],
            tool=named_tools(document["tool"]["name"], document["tool"]["version"]),
            commit=document["commit"],
            date=document["date"],
            machine=document.get("machine", ""),
            figures=document["figures"],
            supports=frozenset(document["supports"]),
            fresh=source.made(document["commit"]) or source.is_current(name),
            logs=logs.relative_to(source.root).as_posix(),
            text=printed.read_text("utf-8", "replace") if printed.exists() else "",
        )
    except (OSError, ValueError, KeyError, TypeError):
        return None


def figures_in_words(figures: Mapping[str, float]) -> str:
    return ", ".join(
        f"{name} {value:g}" if isinstance(value, float) else f"{name} {value}"
        for name, value in figures.items()
    )


def cbmc(source: Source, rung: Rung) -> Iterator[Result]:
    """A result for each proof, from the line that the rung printed for it."""
    line = re.compile(
        r"^(PASSED|UNKNOWN|FAILED|VACUOUS)\s+(\S+)\s+(\d+) properties\s+(\d+)/(\d+)\s+goals", re.MULTILINE
    )
    said = {match[2]: match for match in line.finditer(rung.text)}
    for path in sorted((source.root / "verification/cbmc").glob("*/proof.toml")):
        table = tomllib.loads(path.read_text("utf-8"))
        variants = table.pop("variants", {})
        name = path.parent.name
        for proof, differs in {
            name: {},
            **{f"{name}-{one}": entries for one, entries in variants.items()},
        }.items():
            facts = {**table, **differs}
            match = said.get(proof)
            bounds = (
                "not run"
                if match is None
                else (f"{match[3]} properties; {match[4]} of {match[5]} cover goals reached; loops closed")
            )
            yield rung.result(
                f"CBMC:{proof}",
                str(facts["proves"]),
                "Proof",
                match[1] if match else "UNKNOWN",
                bounds=bounds,
                log=f"{rung.logs}/{proof}/proof.json",
                supports=frozenset(facts["supports"]),
                place=f"verification/cbmc/{name}/harness.c",
            )


def tick(source: Source, rung: Rung) -> Iterator[Result]:
    """A result for each property that a step claims over whole ticks, from the lines of those steps."""
    line = re.compile(r"^(\S+)\s+\{.*'failed': (\d+).*'unknown': (\d+).*\}", re.MULTILINE)
    said = {match[1]: (int(match[2]), int(match[3])) for match in line.finditer(rung.text)}
    for path in (source.root / "verification/tick").glob("tick.toml"):
        table = tomllib.loads(path.read_text("utf-8"))
        for name, stated in table["properties"].items():
            steps = [
                one
                for one, step in table["steps"].items()
                if name in (*step.get("claims", ()), *step.get("supports", ()))
            ]
            told = [said.get(step, (0, 1)) for step in steps]
            if not steps:
                continue
            yield rung.result(
                f"TICK:{name}",
                stated["shown"],
                "Proof",
                "FAILED"
                if any(one[0] for one in told)
                else "UNKNOWN"
                if any(one[1] for one in told)
                else "PASSED",
                bounds=f"{stated['bound']}; by {', '.join(steps)}",
                supports=frozenset({name}),
                place="verification/tick/harness.c",
            )


def model(source: Source, rung: Rung) -> Iterator[Result]:
    """A result for each property of each model, and whether a wrong variant of it was refuted."""
    said = {
        match[2]: match
        for match in re.finditer(r"^(\w+)\s+[\d.]+ s\s+(\w+) +(\d+) states", rung.text, re.MULTILINE)
    }
    # A liveness property is refuted with or without all states, as TLC's clock has it look.
    refuted = re.findall(
        r"^ok +[\d.]+ s +\w+: wrong variant (\w+) +(?:refuted|\d+ states)$", rung.text, re.MULTILINE
    )
    models = tomllib.loads((source.root / "verification/model/models.toml").read_text("utf-8"))["model"]
    for one in models:
        name = one["name"]
        match = said.get(name)
        for stated in sorted({*one.get("invariants", ()), *one["properties"]} - {TYPES}):
            found = frozenset(PROPERTY.findall(f"{stated}_"))
            teeth = sum(wrong.startswith(f"{stated.split('_')[0]}_") for wrong in refuted)
            status = "UNKNOWN" if match is None else ("BOUNDED" if match[1] == "ok" else "FAILED")
            if status == "BOUNDED" and not teeth:
                status = "VACUOUS"
            states = match[3] if match else "no"
            constants = f"constants {'; '.join(one['constants'])}"
            yield rung.result(
                f"TLC:{name}:{stated}",
                f"{stated} in model {name}",
                "ModelCheck",
                status,
                bounds=f"{states} distinct states; {teeth} wrong variants refuted; {constants}",
                log=f"{rung.logs}/{name}/holds/tlc.log",
                supports=found,
                place=f"spec/tla/{one['module']}.tla",
            )


CONVERTERS: Mapping[str, Callable[[Source, Rung], Iterator[Result]]] = {
    "tick": tick,
    "cbmc": cbmc,
    "model": model,
}
"""What turns the evidence of a check that judges several things into results; others give one result each."""


def whole(source: Source, one: Check, release: bool) -> Result:
    """The result of a check that judges one thing. It is fresh when made from this commit or the same inputs.

    One that is missing, stale or too short is AWAITED where a report does not demand it, so that it neither
    passes nor fails.
    """
    rung = read_rung(source, one.name)
    if rung is None:
        missing = missing_result(one.name, f"{one.title}: no evidence", one.target)
        return missing if release or one.demanded == "commit" else replace(missing, status=AWAITED)
    log = json.loads((source.evidence / f"{one.name}.json").read_text("utf-8")).get("log", "")
    log = log if log.startswith("build/") else f"build/evidence/{log or one.name}"
    bounds = figures_in_words(rung.figures)
    status = rung.status
    short = one.too_short(rung.figures)
    if short and status in SOUND:
        bounds, status = f"too short: {short}. {bounds}", "UNKNOWN"
    unmade = bool(short) or not rung.fresh
    if unmade and status not in ("FAILED", "VACUOUS") and not (release or one.demanded == "commit"):
        bounds, status = f"not of these inputs, or too short; {one.target} makes it. {bounds}", AWAITED
    result = rung.result(one.name.upper(), one.title, "Analysis", rung.status, bounds=bounds, log=log)
    return replace(result, status=status, supports=rung.supports)


def missing_result(name: str, title: str, target: str) -> Result:
    """Stands for a check or suite that left nothing, so that its absence is a line of the report."""
    return Result(
        uid=name.upper(),
        title=title,
        method="Analysis",
        status="UNKNOWN",
        tool="none",
        commit="",
        date="",
        bounds=f"not run; {target} makes it",
        log=f"build/evidence/{name}.json",
        supports=frozenset(),
        fresh=False,
    )


def test_group(suite: str, case: ElementTree.Element) -> tuple[str, str]:
    """Group and full name of a test case: its GoogleTest suite, or its file."""
    classname, name = case.get("classname", ""), case.get("name", "")
    if suite == "unit":
        group = GTEST_GROUP.match(name)
        return group[0] if group else name, name
    return classname, f"{classname}::{name}"


def suites(source: Source, suite: str) -> Iterator[Result]:
    """A result for each group of tests in a JUnit report. A skipped test did not pass.

    The report tells neither commit nor tool: `make test` leaves them beside it as SUITE.run.json.
    """
    report = source.root / f"build/reports/{suite}.xml"
    try:
        cases = list(ElementTree.parse(report).getroot().iter("testcase"))
    except (OSError, ElementTree.ParseError):
        cases = []
    try:
        run = json.loads((source.root / f"build/reports/{suite}.run.json").read_text("utf-8"))
    except (OSError, json.JSONDecodeError):
        run = {"commit": "", "date": "", "tool": "unknown"}
    if not cases:
        yield replace(
            missing_result(f"test-{suite}", f"Suite {suite}: no report", "make test"),
            method="Test",
            log=f"build/reports/{suite}.xml",
        )
    groups: dict[str, list[tuple[str, bool]]] = {}
    for case in cases:
        group, name = test_group(suite, case)
        passed = all(case.find(tag) is None for tag in ("failure", "error", "skipped"))
        passed = passed and case.get("status", "run") == "run"
        groups.setdefault(group, []).append((name, passed))
    for group, tests in groups.items():
        failures = tuple(name for name, passed in tests if not passed)
        yield Result(
            uid=f"TEST:{suite}:{group}",
            title=f"Tests {group} ({suite})",
            method="Test",
            status="FAILED" if failures else "PASSED",
            tool=run["tool"],
            commit=run["commit"],
            date=run["date"],
            machine=run.get("machine", ""),
            bounds=f"{len(tests) - len(failures)} of {len(tests)} tests passed",
            log=f"build/reports/{suite}.xml",
            supports=frozenset(one for name, _ in tests for one in PROPERTY.findall(f"{name}_")),
            fresh=source.made(run["commit"]),
            cases=tuple(name for name, _ in tests),
            failures=failures,
        )


def read_results(
    source: Source, checks: Iterable[Check], names: Sequence[str] = SUITES, release: bool = False
) -> list[Result]:
    """All results, by their UIDs. A check or suite that left nothing is UNKNOWN.

    A check that a release alone demands, in a report that is of none, is AWAITED instead.
    """
    found: list[Result] = []
    for check in checks:
        rung = read_rung(source, check.name)
        if rung and check.name in CONVERTERS:
            found += CONVERTERS[check.name](source, rung)
        else:
            found.append(whole(source, check, release))
    for name in names:
        found += suites(source, name)
    return sorted(found, key=lambda result: result.uid)
