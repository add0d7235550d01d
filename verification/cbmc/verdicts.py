"""What the two runs of a proof come to, against what its proof.toml expects."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from proofs import Proof
from prover import Property, Result

GOAL_NAME = re.compile(r"condition '(\w+)")
MODULAR = ("arithmetic overflow on unsigned", "arithmetic overflow on signed to unsigned type conversion")
"""Checks of arithmetic modulo 2^32, which the language defines, but which must be meant."""


@dataclass(frozen=True)
class Outcome:
    """How a proof came out.

    FAILED: a property does not hold. VACUOUS: a cover goal came out otherwise than expected. UNKNOWN: no
    answer, or another number of properties than expected. PASSED: everything exactly as expected.
    """

    status: str
    properties: int = 0
    goals: int = 0
    covered: int = 0
    seconds: float = 0.0
    failed: list[Property] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)


def is_meant(proof: Proof, found: Property) -> bool:
    """True for arithmetic modulo 2^32 in a function that is meant to wrap."""
    wrapping = {one.function for one in proof.wraps}
    return found.description.startswith(MODULAR) and found.function in wrapping


def idle_wraps(proof: Proof, found: list[Property]) -> Iterator[str]:
    """Functions that proof.toml lets wrap although they never do: the permission is too wide."""
    wrapping = {one.function for one in found if is_meant(proof, one) and not one.holds}
    for one in proof.wraps:
        if one.function not in wrapping:
            yield f"{one.function} never wraps here: take it out of [[wraps]]"


def wrong_goals(proof: Proof, goals: list[Property]) -> Iterator[str]:
    """Every difference between the goals that were reached and those that proof.toml names."""
    names = {match[1]: goal.holds for goal in goals if (match := GOAL_NAME.match(goal.description))}
    for name in sorted(proof.reachable - names.keys()) + sorted(proof.contradictions - names.keys()):
        yield f"goal {name} is expected, but the harness has none of that name"
    for name, reached in names.items():
        if name not in proof.reachable | proof.contradictions:
            yield f"goal {name} is in the harness, but not in proof.toml"
        elif reached != (name in proof.reachable):
            yield f"goal {name} is {'reachable' if reached else 'unreachable'}; expected the contrary"
    if len(names) != len(goals):
        yield f"{len(goals)} goals have {len(names)} names; give each a variable of its own"


def judge(proof: Proof, proved: Result, reached: Result) -> Outcome:
    """Compares what came out with what was expected, number by number and name by name."""
    seconds = proved.seconds + reached.seconds
    troubles = [trouble for trouble in (proved.trouble, reached.trouble) if trouble]
    if proved.trouble:
        return Outcome("UNKNOWN", seconds=seconds, remarks=troubles)
    counted = [one for one in proved.properties if not is_meant(proof, one)]
    failed = [one for one in counted if not one.holds]
    vacuous = list(wrong_goals(proof, reached.properties)) if not reached.trouble else []
    odd = list(idle_wraps(proof, proved.properties))
    if len(counted) != proof.properties:
        odd.append(f"{len(counted)} properties; expected {proof.properties}")
    status = "FAILED" if failed else "VACUOUS" if vacuous else "UNKNOWN" if odd or troubles else "PASSED"
    covered = sum(goal.holds for goal in reached.properties)
    remarks = [*troubles, *vacuous, *odd]
    return Outcome(status, len(counted), len(proof.reachable), covered, seconds, failed, remarks)
