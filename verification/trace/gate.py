"""The gate: what must hold between hazards, controls, requirements, code and results, rule by rule."""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path

import fretish
from components import Component
from items import Item, Items, fingerprint
from results import AWAITED, SOUND, Result
from sources import Function, Links


@dataclass(frozen=True)
class Project:
    """All that the gate looks at."""

    root: Path
    items: Items
    functions: Sequence[Function]
    links: Links
    results: Sequence[Result]
    reviewed: Mapping[str, str]
    """Fingerprint of each item at its last review."""
    clauses: Mapping[str, Mapping[str, object]]
    """Clause by clause, what shows it, or the gap in words."""
    components: Sequence[Component]
    """What is shipped beside our own code; empty when it is not known."""
    exporter_log: str = ""
    """What StrictDoc printed."""
    release: bool = False
    """Whether all is demanded that a release demands."""


@dataclass(frozen=True)
class Finding:
    """A line that is missing or wrong."""

    rule: str
    uid: str
    text: str

    def __str__(self) -> str:
        return f"{self.rule} {self.uid}: {self.text}"


@dataclass(frozen=True)
class Trace:
    """A project with what follows from it: which results carry which requirement."""

    project: Project
    matched: Mapping[str, Sequence[str]] = field(default_factory=dict)
    """For each pattern of the links, the test cases that it matches."""
    carried: Mapping[str, Sequence[Result]] = field(default_factory=dict)
    """For each requirement and property, the results that speak of it."""

    def covers(self, uid: str) -> list[Item]:
        """The anomalies that explain a result, or name a method that a requirement still lacks."""
        return [
            anomaly
            for anomaly in self.project.items.of("ANOMALY")
            if any(fnmatchcase(uid, one) for one in anomaly.fields.get("COVERS", "").split(", "))
        ]

    def lacking(self, requirement: Item) -> list[str]:
        """Methods by which a requirement is to be verified, and of which it has no result."""
        have = {one.method for one in self.carried.get(requirement.uid, ()) if one.status != "UNKNOWN"}
        return [method for method in methods_of(requirement) if method not in have]

    def owed(self, requirement: Item) -> list[str]:
        """Those among them that an anomaly names: `SRS-K-001:Proof`. A release owes nothing."""
        lacking = [] if self.project.release else self.lacking(requirement)
        return [method for method in lacking if self.covers(f"{requirement.uid}:{method}")]


def selected(pattern: str, results: Sequence[Result]) -> list[tuple[Result, str]]:
    """The test cases that a pattern SUITE:NAME names, each with its result."""
    suite, _, name = pattern.partition(":")
    return [
        (result, case)
        for result in results
        if result.uid.startswith(f"TEST:{suite}:")
        for case in result.cases
        if any(fnmatchcase(case, f"{before}{name}") for before in ("", "*/", "*."))
    ]


def trace(project: Project) -> Trace:
    """Which results speak of which requirement: by property, by test."""
    carried: dict[str, dict[str, Result]] = {}
    matched: dict[str, list[str]] = {}

    def carry(uid: str, result: Result) -> None:
        carried.setdefault(uid, {})[result.uid] = result

    for result in project.results:
        for name in result.supports & set(project.items.by_uid):
            carry(name, result)
            for requirement in project.items[name].parents_by("Formalises"):
                carry(requirement, result)
    for requirement, patterns in project.links.tests.items():
        for pattern in patterns:
            found = selected(pattern, project.results)
            matched[pattern] = [case for _, case in found]
            for result, _ in found:
                carry(requirement, result)
    for requirement, patterns in project.links.results.items():
        for pattern in patterns:
            found = [result for result in project.results if fnmatchcase(result.uid, pattern)]
            matched[pattern] = [result.uid for result in found]
            for result in found:
                carry(requirement, result)
    return Trace(project, matched, {uid: list(by_uid.values()) for uid, by_uid in carried.items()})


def methods_of(item: Item) -> list[str]:
    """The methods by which a requirement is to be verified."""
    return [method for method in item.fields.get("VERIFICATION", "").split(", ") if method]


FAILURES = ("FAILURE_MODE", "SOUP")
"""Kinds of items that fail: functions and interfaces of our own, and what is used of others'."""


def rests_on_information(items: Items, cause: Item) -> bool:
    """Whether people are only told of what could injure gravely (criterion 2 of the risk management plan)."""
    controls = items.children(cause.uid, "Mitigates")
    hazards = [items[uid] for uid in cause.parents_by("Causes") if uid in items.by_uid]
    grave = any(hazard.fields["SEVERITY"] in ("S4", "S5") for hazard in hazards)
    return grave and {control.fields["KIND"] for control in controls} == {"InformationForSafety"}


def g1(of: Trace) -> Iterator[Finding]:
    """Each hazard has a cause, each cause and threat a control, each failure what meets it."""
    items = of.project.items
    for hazard in items.of("HAZARD"):
        if not items.children(hazard.uid, "Causes"):
            yield Finding("G1", hazard.uid, "no cause is stated")
    for cause in items.of("CAUSE", "THREAT"):
        if not items.children(cause.uid, "Mitigates"):
            yield Finding("G1", cause.uid, "no risk control mitigates it")
        if rests_on_information(items, cause):
            yield Finding("G1", cause.uid, "leads to S4 or S5 and is met by information for safety alone")
    for cause in items.of("CAUSE", "THREAT", *FAILURES):
        if not cause.parents_by("Causes"):
            yield Finding("G1", cause.uid, "leads to no hazard")
    for failure in items.of(*FAILURES):
        met = failure.parents_by("MetBy")
        if not any(items[uid].kind in ("CONTROL", "REQUIREMENT") for uid in met if uid in items.by_uid):
            yield Finding("G1", failure.uid, "no risk control or requirement meets it")


def carried_out(items: Items, control: Item, system: Item) -> list[Item]:
    """The software requirements by which a system requirement carries out a risk control."""
    return [
        requirement
        for requirement in items.children(system.uid, "Refines")
        if control.uid in requirement.parents_by("CarriesOut")
    ]


def g2(of: Trace) -> Iterator[Finding]:
    """Each risk control has a system requirement, each of these software requirements that carry it out."""
    items = of.project.items
    for control in items.of("CONTROL"):
        systems = items.children(control.uid, "Implements")
        if not systems:
            yield Finding("G2", control.uid, "no system requirement carries it out")
        for system in systems:
            if not carried_out(items, control, system):
                yield Finding("G2", control.uid, f"no software requirement of {system.uid} carries it out")
    for requirement in items.of("REQUIREMENT"):
        asked = {
            control
            for system in requirement.parents_by("Refines")
            if system in items.by_uid
            for control in items[system].parents_by("Implements")
        }
        for control in requirement.parents_by("CarriesOut"):
            if control not in asked:
                yield Finding(
                    "G2", requirement.uid, f"carries out {control}, but refines nothing that asks for it"
                )
    for requirement in items.of("SYSREQ"):
        if not items.children(requirement.uid, "Refines"):
            yield Finding("G2", requirement.uid, "no software requirement refines it")


def g3(of: Trace) -> Iterator[Finding]:
    """Each requirement has a parent, an item, code, one *shall*, and no FRETish that breaks its grammar."""
    project = of.project
    fulfilled = {uid for one in project.functions for uid in project.links.requirements_of(one)}
    for requirement in project.items.of("REQUIREMENT"):
        if not requirement.parents_by("Refines"):
            yield Finding("G3", requirement.uid, "refines no system requirement")
        if len(requirement.parents_by("Allocated")) != 1:
            yield Finding("G3", requirement.uid, "is not allocated to one item of the architecture")
        analysed = methods_of(requirement) == ["Analysis"]
        if not (analysed or requirement.uid in fulfilled or project.links.code.get(requirement.uid)):
            yield Finding("G3", requirement.uid, "no function or file fulfils it")
        try:
            if "FRETISH" in requirement.fields:
                fretish.check(requirement.fields["FRETISH"])
        except fretish.FretishError as error:
            yield Finding("G3", requirement.uid, f"its FRETish is not: {error}")
    for requirement in project.items.of("REQUIREMENT", "SYSREQ"):
        if len(re.findall(r"\bshall\b", requirement.statement)) != 1:
            yield Finding("G3", requirement.uid, "does not say 'shall' exactly once")
    for prop in project.items.of("PROPERTY"):
        if not prop.parents_by("Formalises"):
            yield Finding("G3", prop.uid, "formalises no requirement")


def g4(of: Trace) -> Iterator[Finding]:
    """Each method by which a requirement is to be verified has a result, awaits or is owed one."""
    for requirement in of.project.items.of("REQUIREMENT"):
        lacking = of.lacking(requirement)
        if not methods_of(requirement):
            yield Finding("G4", requirement.uid, "names no method of verification")
        for method in methods_of(requirement):
            known = of.covers(f"{requirement.uid}:{method}")
            if method in lacking and method not in of.owed(requirement):
                yield Finding("G4", requirement.uid, f"no result by {method}")
            elif method not in lacking and known:
                yield Finding(
                    "G4", requirement.uid, f"{known[0].uid} owes {method}, of which there is a result"
                )


def g5(of: Trace) -> Iterator[Finding]:
    """No result is FAILED, UNKNOWN or VACUOUS, unless an anomaly explains it; an awaited one is no result."""
    for result in of.project.results:
        if result.status not in (*SOUND, AWAITED) and not of.covers(result.uid):
            because = f": {', '.join(result.failures[:3])}" if result.failures else ""
            yield Finding("G5", result.uid, f"{result.status} ({result.bounds}){because}")


def g6(of: Trace) -> Iterator[Finding]:
    """Each function of the core fulfils a requirement, and its links name what there is."""
    project = of.project
    known = {item.uid for item in project.items.of("REQUIREMENT")}
    present = {(one.file, one.name) for one in project.functions}
    for function in project.functions:
        if not project.links.requirements_of(function):
            yield Finding("G6", f"{function.file}:{function.name}", "fulfils no requirement")
        for uid in project.links.requirements_of(function):
            if uid not in known:
                yield Finding("G6", f"{function.file}:{function.name}", f"fulfils {uid}, which there is not")
    for file, functions in project.links.functions.items():
        for name in functions:
            if (file, name) not in present:
                yield Finding("G6", f"{file}:{name}", "is linked, but there is no such function")


def g7(of: Trace) -> Iterator[Finding]:
    """Each result was made from the sources of this commit."""
    for result in of.project.results:
        if result.status not in ("UNKNOWN", AWAITED) and not result.fresh:
            made = result.commit[:12] or "an unknown commit"
            yield Finding("G7", result.uid, f"stale: made at {made}, and its inputs have changed since")


def g8(of: Trace) -> Iterator[Finding]:
    """Each item, and the prose of each document, says what it and its parents said at the last review."""
    items = of.project.items
    known = items.to_review()
    for uid in sorted(known):
        if uid not in of.project.reviewed:
            yield Finding("G8", uid, "was never reviewed")
        elif of.project.reviewed[uid] != fingerprint(items, known[uid]):
            yield Finding("G8", uid, "suspect: it or one of its parents changed since its review")
    for uid in sorted(set(of.project.reviewed) - set(known)):
        yield Finding("G8", uid, "was reviewed, but there is no such item")


def g9(of: Trace) -> Iterator[Finding]:
    """Every link leads somewhere: to tests, code, logs; and StrictDoc skipped nothing."""
    project = of.project
    known = {item.uid for item in project.items.of("REQUIREMENT")}
    for uid in sorted({*project.links.code, *project.links.tests, *project.links.results} - known):
        yield Finding("G9", uid, "has links, but there is no such requirement")
    for uid, paths in project.links.code.items():
        for path in paths:
            if not (project.root / path).exists():
                yield Finding("G9", uid, f"fulfilled by {path}, which there is not")
    for uid, patterns in [*project.links.tests.items(), *project.links.results.items()]:
        for pattern in patterns:
            if not of.matched[pattern]:
                yield Finding("G9", uid, f"no test or result matches '{pattern}'")
    for result in project.results:
        for path in (result.log, result.place):
            if result.status not in ("UNKNOWN", AWAITED) and path and not (project.root / path).exists():
                yield Finding("G9", result.uid, f"names {path}, which there is not")
    for line in project.exporter_log.splitlines():
        if re.search(r"skipping|warning", line, re.IGNORECASE):
            yield Finding("G9", "StrictDoc", line.strip())


PLATFORM = "platform:"
"""Before the name of a SOUP component that belongs to the computer on which Interlock is installed."""


def g10(of: Trace) -> Iterator[Finding]:
    """Each component that is shipped is a SOUP item, and each SOUP item is shipped or of the platform."""
    described = {
        name.strip(): item.uid
        for item in of.project.items.of("SOUP")
        for name in item.fields["COMPONENTS"].split(",")
        if not name.strip().startswith(PLATFORM)
    }
    if not of.project.components:
        yield Finding("G10", "SBOM", "what is shipped is not known: build the release first")
        return
    shipped = {one.name: one for one in of.project.components}
    for name in sorted(set(shipped) - set(described)):
        yield Finding("G10", name, f"{shipped[name].purl} is shipped, but no SOUP item describes it")
    for name in sorted(set(described) - set(shipped)):
        yield Finding("G10", described[name], f"describes {name}, which is not shipped")


def g11(of: Trace) -> Iterator[Finding]:
    """Each clause has what shows it."""
    for clause, entry in of.project.clauses.items():
        shown = entry.get("shown_by", [])
        if not shown and not entry.get("outside"):
            yield Finding("G11", clause, f"nothing shows it: {entry.get('missing', 'not stated')}")
        for path in shown:
            if not (of.project.root / path).exists():
                yield Finding("G11", clause, f"shown by {path}, which there is not")


RULES: Sequence[Callable[[Trace], Iterator[Finding]]] = (g1, g2, g3, g4, g5, g6, g7, g8, g9, g10, g11)


def awaited(of: Trace) -> dict[str, list[str]]:
    """What this report does not judge because a release alone demands it: measurements, and requirements.

    The requirements are those of which a method of verification has no other result, or none at all and an
    anomaly says so.
    """
    results = [result.uid for result in of.project.results if result.status == AWAITED]
    requirements, owed = [], []
    for requirement in of.project.items.of("REQUIREMENT"):
        owed += [f"{requirement.uid} by {method}" for method in of.owed(requirement)]
        carried = of.carried.get(requirement.uid, ())
        sound = {result.method for result in carried if result.status in SOUND}
        waits = {result.method for result in carried if result.status == AWAITED} - sound
        if waits & set(methods_of(requirement)):
            requirements.append(requirement.uid)
    return {
        "Measurements": results,
        "Requirements that rest on one of them alone": requirements,
        "Verification that an anomaly owes": owed,
    }


def alike(found: Sequence[Finding]) -> dict[tuple[str, str], list[str]]:
    """Findings by rule and text, each with all UIDs that it is said of."""
    groups: dict[tuple[str, str], list[str]] = {}
    for one in found:
        groups.setdefault((one.rule, one.text), []).append(one.uid)
    return groups


def findings(of: Trace) -> list[Finding]:
    """All that is missing or wrong, by rule; none when the gate is green."""
    return [finding for rule in RULES for finding in rule(of)]
