"""The trace matrix: one row for each way from a hazard by cause and control to a software requirement.

A software requirement names the risk controls that it carries out: that it refines a system requirement which
does, beside others, would not be enough. One that carries out none has no row; the overview names it.
"""

import csv
import io
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, fields

from gate import FAILURES, Trace, carried_out
from items import Item, fingerprint
from places import Places
from results import AWAITED, PROPERTY, SOUND, Result


@dataclass(frozen=True)
class Row:
    """One line of the matrix. Cells that hold several things separate them by `; `."""

    severity: str
    harm: str
    hazard: str
    situation: str
    cause: str
    cause_item: str
    cause_kind: str
    initial_risk: str
    control: str
    control_kind: str
    system_requirement: str
    requirement: str
    text_hash: str
    item: str
    properties: str
    design: str
    code: str
    methods: str
    verification: str
    tests: str
    results: str
    bounds: str
    status: str
    dates: str
    commits: str
    tools: str
    residual: str
    anomalies: str


def named(item: Item) -> str:
    return f"{item.uid} {item.title}"


def code_of(of: Trace, uid: str) -> list[str]:
    """Where a requirement is fulfilled: PATH:LINE FUNCTION in the kernel core, else PATH."""
    project = of.project
    functions = [
        f"{one.file}:{one.line} {one.name}"
        for one in project.functions
        if uid in project.links.requirements_of(one)
    ]
    return functions or list(project.links.code.get(uid, ()))


def tests_of(of: Trace, uid: str) -> list[str]:
    """The test cases about a requirement: those of its links, and those named for a property of it."""
    patterns = of.project.links.tests.get(uid, ())
    linked = {case for pattern in patterns for case in of.matched.get(pattern, ())}
    properties = {one.uid for one in of.project.items.children(uid, "Formalises")}
    named = {
        case
        for result in of.carried.get(uid, ())
        for case in result.cases
        if properties & set(PROPERTY.findall(f"{case}_"))
    }
    return sorted(linked | named)


def status_of(results: Sequence[Result]) -> str:
    """The worst status of several results; AWAITED when all of them are, MISSING for none."""
    order = ("FAILED", "VACUOUS", "UNKNOWN", "BOUNDED", "PASSED", AWAITED)
    return next((status for status in order if any(one.status == status for one in results)), "MISSING")


def anomalies_of(of: Trace, requirement: Item, results: Sequence[Result]) -> list[str]:
    affected = {one.uid for one in of.project.items.children(requirement.uid, "Affects")}
    return sorted(
        affected
        | {one.uid for result in results if result.status not in SOUND for one in of.covers(result.uid)}
    )


def ways(of: Trace) -> Iterator[tuple[Item, Item, Item, Item, Item]]:
    """Every hazard, cause, control, system requirement and requirement that follow from each other."""
    items = of.project.items
    for hazard in items.of("HAZARD"):
        for cause in items.children(hazard.uid, "Causes"):
            for control in items.children(cause.uid, "Mitigates"):
                for system in items.children(control.uid, "Implements"):
                    for requirement in carried_out(items, control, system):
                        yield hazard, cause, control, system, requirement


def without_control(of: Trace) -> list[str]:
    """The software requirements that carry out no risk control: what the robot does besides being safe."""
    return [one.uid for one in of.project.items.of("REQUIREMENT") if not one.parents_by("CarriesOut")]


def rows(of: Trace) -> list[Row]:
    """The whole matrix, in the order of the documents."""
    items = of.project.items
    places = Places(of)
    found = []
    for hazard, cause, control, system, requirement in ways(of):
        results = sorted(of.carried.get(requirement.uid, ()), key=lambda one: one.uid)
        properties = items.children(requirement.uid, "Formalises")
        found.append(
            Row(
                severity=hazard.fields["SEVERITY"],
                harm=hazard.fields["HARM"],
                hazard=named(hazard),
                situation=hazard.fields["SITUATION"],
                cause=named(cause),
                cause_item=cause.fields.get("ITEM", cause.fields.get("INTERFACE", "")),
                cause_kind=cause.fields.get("KIND", cause.fields.get("STRIDE", "")),
                initial_risk=f"{hazard.fields['SEVERITY']}, taken to occur",
                control=named(control),
                control_kind=control.fields["KIND"],
                system_requirement=named(system),
                requirement=named(requirement),
                text_hash=fingerprint(items, requirement),
                item="; ".join(requirement.parents_by("Allocated")),
                properties="; ".join(one.uid for one in properties),
                design="; ".join(places.design_of(of, requirement.uid)),
                code="; ".join(code_of(of, requirement.uid)),
                methods=requirement.fields["VERIFICATION"],
                verification="; ".join(dict.fromkeys(filter(None, map(places.of_result, results)))),
                tests="; ".join(tests_of(of, requirement.uid)),
                results="; ".join(f"{one.uid} {one.status}" for one in results),
                bounds="; ".join(dict.fromkeys(one.bounds.replace("; ", ", ") for one in results)),
                status=status_of(results),
                dates="; ".join(sorted({one.date[:10] for one in results if one.date})),
                commits="; ".join(sorted({one.commit[:12] for one in results if one.commit})),
                tools="; ".join(sorted({one.tool for one in results})),
                residual=hazard.fields["RESIDUAL"],
                anomalies="; ".join(anomalies_of(of, requirement, results)),
            )
        )
    return found


def as_csv(matrix: Sequence[Row]) -> str:
    """The matrix with a line of headings."""
    text = io.StringIO()
    writer = csv.DictWriter(text, [one.name for one in fields(Row)], lineterminator="\n")
    writer.writeheader()
    writer.writerows(asdict(row) for row in matrix)
    return text.getvalue()


@dataclass(frozen=True)
class Coverage:
    """How far one hazard is covered."""

    hazard: Item
    causes: int
    """Causes and threats."""
    failures: int
    """Failure modes and SOUP items that could lead to it."""
    controls: int
    requirements: int
    sound: int
    """Requirements all of whose results are sound."""


def coverage(of: Trace) -> list[Coverage]:
    """Each hazard with what stands against it."""
    found = []
    for hazard in of.project.items.of("HAZARD"):
        way = [one for one in ways(of) if one[0] is hazard]
        requirements = {one[4].uid for one in way}
        sound = [uid for uid in requirements if status_of(of.carried.get(uid, ())) in SOUND]
        leading = of.project.items.children(hazard.uid, "Causes")
        failures = sum(one.kind in FAILURES for one in leading)
        found.append(
            Coverage(
                hazard=hazard,
                causes=len(leading) - failures,
                failures=failures,
                controls=len({one[2].uid for one in way}),
                requirements=len(requirements),
                sound=len(sound),
            )
        )
    return found


def negative_lists(of: Trace) -> dict[str, list[str]]:
    """What must not be there at a release; each list empty when all is well."""
    project = of.project
    items = project.items
    covered = {way[0].uid for way in ways(of)}
    return {
        "Hazards without control": [one.uid for one in items.of("HAZARD") if one.uid not in covered],
        "Requirements without code or without result": [
            one.uid
            for one in items.of("REQUIREMENT")
            if not of.carried.get(one.uid)
            or (not code_of(of, one.uid) and one.fields["VERIFICATION"] != "Analysis")
        ],
        "Functions without requirement": [
            f"{one.file}:{one.name}" for one in project.functions if not project.links.requirements_of(one)
        ],
        "Results failed, unknown, vacuous or stale": [
            one.uid
            for one in project.results
            if one.status != AWAITED and (one.status not in SOUND or not one.fresh)
        ],
    }
