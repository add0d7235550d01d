#!/usr/bin/env python3
"""Runs scenarios on real processes and writes build/evidence/scenarios.json.

    run.py [--seed 1] [--count 200] [--jobs N]     numbers 0 to COUNT - 1
    run.py --seed 1 --only 17                      one of them again

Each scenario has namespaces of its own: its processes, mounts and shared memory end with it. PASSED asks that
every one ran and none found anything; UNKNOWN says that this machine could not run some of them.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "evidence"))

import evidence
from plan import kinds_within, plan

SCENARIO = Path(__file__).resolve().with_name("scenario.py")
LONGEST_S = 1800.0
"""Ends a scenario that hangs."""
SUPPORTS = ("P1", "P2", "P9", "P10", "P12")


def namespaces() -> list[str]:
    """The command that gives a scenario processes and mounts of its own; without root by a user namespace."""
    apart = [
        "unshare",
        "--mount",
        "--pid",
        "--fork",
        "--kill-child",
        "--mount-proc",
        "--propagation",
        "private",
    ]
    return apart if os.geteuid() == 0 else [*apart, "--map-root-user"]


def run_scenario(seed: int, number: int) -> dict:
    """The outcome of one scenario, as scenario.py prints it."""
    with tempfile.TemporaryDirectory(prefix="interlock-scenario-") as folder:
        command = [*namespaces(), sys.executable, str(SCENARIO), str(seed), str(number), folder]
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=LONGEST_S)
            lines = done.stdout.splitlines()
            return json.loads(lines[-1]) if lines else broken(number, done.stderr)
        except (subprocess.TimeoutExpired, json.JSONDecodeError) as error:
            return broken(number, str(error))


def broken(number: int, why: str) -> dict:
    finding = "it could not be ended: " + (why.strip().splitlines() or ["no reason"])[-1]
    return {"number": number, "fault": "?", "skipped": False, "findings": [finding], "figures": {}}


def tell(seed: int, outcome: dict) -> None:
    verdict = "skipped" if outcome["skipped"] else "FAILED" if outcome["findings"] else "ok"
    print(f"scenario {outcome['number']:>4}  {outcome['fault']:<18} {verdict}", flush=True)
    for finding in outcome["findings"]:
        print(f"    {finding}")
    if outcome["findings"]:
        print(f"    again: make scenarios SEED={seed} ONLY={outcome['number']}", flush=True)


def worst(outcomes: Sequence[dict], figure: str) -> float:
    return max((outcome["figures"].get(figure, 0.0) for outcome in outcomes), default=0.0)


def figures_of(seed: int, outcomes: Sequence[dict]) -> dict[str, float]:
    kinds = Counter(outcome["fault"] for outcome in outcomes if not outcome["skipped"])
    restarts = [
        plan(seed, outcome["number"]) for outcome in outcomes if outcome["fault"] == "restart_in_order"
    ]
    return {
        "seed": seed,
        "scenarios": sum(kinds.values()),
        "skipped": sum(outcome["skipped"] for outcome in outcomes),
        "failed": sum(bool(outcome["findings"]) for outcome in outcomes),
        "findings": sum(len(outcome["findings"]) for outcome in outcomes),
        "kinds": len(kinds),
        "end_orders": len({each.end_order for each in restarts}),
        "start_orders": len({each.start_order for each in restarts}),
        "records_acknowledged": sum(outcome["figures"].get("acknowledged", 0) for outcome in outcomes),
        "stopped_in_motion": sum(outcome["figures"].get("moving", False) for outcome in outcomes),
        "stop_ticks_worst": worst(outcomes, "stop_ticks"),
        "stop_request_ms_worst": worst(outcomes, "stop_request_ms"),
        "bring_up_s_worst": worst(outcomes, "bring_up_s"),
    }


def verdict_of(figures: dict[str, float], wanted: int) -> str:
    if figures["failed"]:
        return "FAILED"
    if (
        not figures["records_acknowledged"]
        or not figures["stopped_in_motion"]
        or figures["kinds"] + figures["skipped"] < kinds_within(int(figures["seed"]), wanted)
    ):
        return "VACUOUS"
    return "UNKNOWN" if figures["skipped"] else "PASSED"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--only", type=int, help="the number of the one scenario to run; writes no evidence")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    arguments = parser.parse_args()
    started = time.monotonic()
    if arguments.only is not None:
        outcome = run_scenario(arguments.seed, arguments.only)
        tell(arguments.seed, outcome)
        print(json.dumps(outcome, indent=1))
        return 1 if outcome["findings"] else 0

    print(
        f"scenarios: seed {arguments.seed}, {arguments.count} of them, {arguments.jobs} at a time", flush=True
    )

    def run_and_tell(number: int) -> dict:
        outcome = run_scenario(arguments.seed, number)
        tell(arguments.seed, outcome)
        return outcome

    with ThreadPoolExecutor(arguments.jobs) as crowd:
        outcomes = list(crowd.map(run_and_tell, range(arguments.count)))
    log = evidence.log_directory("scenarios")
    (log / "outcomes.json").write_text(json.dumps(outcomes, indent=1) + "\n", "utf-8")
    figures = figures_of(arguments.seed, outcomes)
    for name, value in figures.items():
        print(f"{name:24} {value:>12}")
    verdict = verdict_of(figures, arguments.count)
    print(f"scenarios: {verdict}; build/evidence/scenarios.json")
    tools = {"interlock": evidence.commit()[:12]}
    return evidence.write("scenarios", verdict, tools, figures, SUPPORTS, started)


if __name__ == "__main__":
    sys.exit(main())
