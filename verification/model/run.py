#!/usr/bin/env python3
"""Rung 1: TLC checks the models of verification/model/models.toml, and that the checks can fail.

Each model must hold all its properties, with the exact number of distinct states and no action that is never
taken; what each property is about must happen. Each wrong variant in spec/tla/wrong must be refuted with a
trace that names its property. Names of models as arguments restrict the run to them, for work at the desk;
evidence is then not written. JOBS: how many TLC run at once.
"""

import os
import sys
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "evidence"))

import evidence
import tlc
from refutation import readable

from models import Model, UnusableError, WrongVariant, read_models, read_wrong_variants

RUNG = "model"
TIMEOUT_S = 1200
"""A search that takes longer on any machine is a model that has grown by mistake."""


@dataclass(frozen=True)
class Finding:
    """One check: its name, what TLC said, and if it failed the status that this gives and the fault."""

    name: str
    is_wrong_variant: bool
    answer: tlc.Answer
    status: str = ""
    fault: str = ""


def directory_for(*names: str) -> Path:
    directory = evidence.log_directory(RUNG).joinpath(*names)
    tlc.prepare(directory)
    return directory


def verdict_on(model: Model, answer: tlc.Answer) -> tuple[str, str]:
    """The status and the fault of a model, both empty when all is as it must be."""
    if answer.timed_out:
        return "UNKNOWN", f"no answer in {TIMEOUT_S} s"
    if answer.status not in tlc.HOLDS or answer.distinct is None:
        return "FAILED", f"does not hold: {answer.broken or 'see the log'}\n{readable(answer.text)}"
    if model.told - answer.met:
        return "VACUOUS", f"never taken, or about nothing: {', '.join(sorted(model.told - answer.met))}"
    if answer.distinct != model.distinct_states:
        return "FAILED", f"{answer.distinct} distinct states, expected {model.distinct_states}"
    return "", ""


def check_holds(model: Model) -> Finding:
    """The model itself: everything holds, the states are as many as expected, every action is taken."""
    directory = directory_for(model.name, "holds")
    answer = tlc.check(directory, model.module, model.configuration(), TIMEOUT_S)
    return Finding(model.name, False, answer, *verdict_on(model, answer))


def check_wrong(model: Model, variant: WrongVariant) -> Finding:
    """A wrong variant: TLC must refute it, and name the property."""
    directory = directory_for(model.name, f"wrong-{variant.name}")
    variant.plant(directory)
    answer = tlc.check(
        directory, model.module, model.configuration([variant.property]), TIMEOUT_S, brief=True
    )
    status, fault = "", ""
    if answer.timed_out:
        status, fault = "UNKNOWN", f"no answer in {TIMEOUT_S} s"
    elif answer.status not in tlc.VIOLATED:
        status, fault = "VACUOUS", f"{variant.property} refutes nothing, not even this: {variant.why}"
    elif not answer.refutes(variant.property):
        status, fault = "FAILED", f"refuted by {answer.broken}, expected {variant.property}"
    return Finding(f"{model.name}: wrong variant {variant.name}", True, answer, status, fault)


def all_checks(models: Sequence[Model], variants: Sequence[WrongVariant]) -> list[Callable[[], Finding]]:
    """The longest first, so that the cores are busy to the end."""
    by_name = {model.name: model for model in models}
    checks: list[Callable[[], Finding]] = []
    for model in sorted(models, key=lambda model: -model.distinct_states):
        checks.append(lambda model=model: check_holds(model))
    for variant in variants:
        if variant.model in by_name:
            checks.append(lambda variant=variant: check_wrong(by_name[variant.model], variant))
    return checks


def report(finding: Finding, failures: evidence.Failures) -> None:
    answer, verdict = finding.answer, finding.status or "ok"
    states = f"{answer.distinct} states" if answer.distinct else "refuted"
    print(f"{verdict:7} {answer.seconds:7.1f} s  {finding.name:58} {states}", flush=True)
    if finding.fault:
        failures.tell(f"{finding.name}: {finding.fault}")


def figures(models: Sequence[Model], findings: Sequence[Finding]) -> dict[str, float]:
    wrong = [finding for finding in findings if finding.is_wrong_variant]
    states = {f.name: f.answer.distinct or 0 for f in findings if not f.is_wrong_variant}
    return {
        "models": len(models),
        "distinct_states": sum(states.values()),
        "properties": len({named for model in models for named in model.named}),
        "wrong_variants": len(wrong),
        "wrong_variants_caught": sum(not finding.status for finding in wrong),
        **{f"states_{name}": count for name, count in states.items()},
    }


def status_of(findings: Sequence[Finding]) -> str:
    found = {finding.status for finding in findings}
    return next((status for status in ("FAILED", "VACUOUS", "UNKNOWN") if status in found), "BOUNDED")


def main() -> int:
    started = time.monotonic()
    try:
        chosen = sys.argv[1:]
        models = read_models()
        variants = read_wrong_variants({model.name for model in models})
        models = [model for model in models if not chosen or model.name in chosen]
    except UnusableError as error:
        print(f"model: {error}", file=sys.stderr)
        return 2
    failures = evidence.Failures(RUNG)
    with ThreadPoolExecutor(int(os.environ.get("JOBS", "2"))) as pool:
        pending = [pool.submit(check) for check in all_checks(models, variants)]
        findings = []
        for future in pending:
            findings.append(future.result())
            report(findings[-1], failures)
    status = status_of(findings)
    if chosen:
        print(f"{status}; of {', '.join(chosen)} alone, so no evidence is written")
        return 0 if status == "BOUNDED" else 1
    supports = sorted({identifier for model in models for identifier in model.supports})
    tools = {"TLC": findings[0].answer.version}
    return evidence.write(RUNG, status, tools, figures(models, findings), supports, started)


if __name__ == "__main__":
    sys.exit(main())
