#!/usr/bin/env python3
"""The proof rung: CBMC over the real kernel sources, harness by harness, with exact expectations.

Each directory beside this file that holds a proof.toml is one proof (see proofs.py). It is run twice: once
to prove its properties, once to find which of its cover goals can be reached. Without arguments all proofs
are run and the evidence is written; with the names of proofs only those are run, and none is written.
"""

import argparse
import os
import sys
import time
from collections.abc import Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "evidence"))

import evidence
import prover
from counterexample import describe
from proofs import Proof, load_all, unjustified
from verdicts import Outcome, judge

WORST_FIRST = ("FAILED", "VACUOUS", "UNKNOWN", "PASSED")


def prove(proof: Proof, pool: ThreadPoolExecutor, logs: Path) -> tuple[Future, Future]:
    """Starts both runs of a proof."""
    return (
        pool.submit(prover.check_properties, proof, logs / proof.name),
        pool.submit(prover.check_goals, proof, logs / proof.name),
    )


def report(proof: Proof, outcome: Outcome, logs: Path, failures: evidence.Failures) -> None:
    """One line for a proof that came out as expected; what is wrong, and a counterexample, for another."""
    print(
        f"{outcome.status:8} {proof.name:20} {outcome.properties:5} properties"
        f" {outcome.covered:3}/{outcome.goals:<3} goals {outcome.seconds:7.1f} s",
        flush=True,
    )
    if outcome.status != "PASSED":
        failures.tell(f"{proof.name}, {outcome.status}; it shows: {proof.proves}")
    for remark in outcome.remarks:
        failures.tell(f"    {remark}")
    for failed in outcome.failed[:3]:
        failures.tell(describe(proof, failed, prover.trace(proof, failed.name, logs / proof.name)))


def run(proofs: Sequence[Proof], logs: Path) -> list[Outcome]:
    """Runs the proofs, the longest first, on as many cores as JOBS says."""
    longest_first = sorted(proofs, key=lambda proof: proof.seconds, reverse=True)
    outcomes, failures = [], evidence.Failures("cbmc")
    with ThreadPoolExecutor(max_workers=int(os.environ.get("JOBS", "1"))) as pool:
        started = [(proof, *prove(proof, pool, logs)) for proof in longest_first]
        for proof, properties, goals in started:
            outcomes.append(judge(proof, properties.result(), goals.result()))
            report(proof, outcomes[-1], logs, failures)
    return outcomes


def worst(outcomes: Sequence[Outcome]) -> str:
    """The status of the rung: that of its worst proof."""
    return next(status for status in WORST_FIRST if any(outcome.status == status for outcome in outcomes))


def figures(outcomes: Sequence[Outcome]) -> dict[str, float]:
    """What the rung's evidence counts. `cover_goals` are those that must be reachable."""
    return {
        "harnesses": len(outcomes),
        "properties": sum(outcome.properties for outcome in outcomes),
        "failed": sum(len(outcome.failed) for outcome in outcomes),
        "cover_goals": sum(outcome.goals for outcome in outcomes),
        "covered": sum(outcome.covered for outcome in outcomes),
    }


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", help="proofs to run; all when none is named")
    names = parser.parse_args().names
    started = time.monotonic()
    proofs = load_all()
    unknown = set(names) - {name for proof in proofs for name in (proof.name, proof.directory.name)}
    if unknown:
        parser.error(f"no such proof: {', '.join(sorted(unknown))}")
    if not names and unjustified(proofs):
        parser.error("\n".join(unjustified(proofs)))
    chosen = [proof for proof in proofs if not names or {proof.name, proof.directory.name} & set(names)]
    outcomes = run(chosen, evidence.log_directory("cbmc"))
    status = worst(outcomes)
    print(f"{status}: {figures(outcomes)} in {time.monotonic() - started:.0f} s")
    if names:
        return 0 if status == "PASSED" else 1
    supports = sorted(
        {one for proof in proofs for one in proof.supports}, key=lambda one: (one[0], int(one[1:]))
    )
    return evidence.write("cbmc", status, {"CBMC": prover.version()}, figures(outcomes), supports, started)


if __name__ == "__main__":
    sys.exit(main())
