#!/usr/bin/env python3
"""Runs the fault campaign on several processes and writes build/evidence/campaign.json.

Each process runs every N-th case, so the same number of cases gives the same totals however many run at once.
PASSED needs: nothing unsafe, nothing late, no flipped bit unmet; motion, homings and stops happened; and
the run was a full one: 100 million ticks and a million faults, each bit of state and configuration flipped,
E-stop and pedal at each tick of a move, and each fault of an axis and cause of a lock found by the kernel.
A shorter run is BOUNDED by its figures.
"""

import argparse
import json
import os
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "evidence"))
import cluster
import evidence

CASE_TICKS = 20_000
SUMMED = (
    "ticks",
    "faults_injected",
    "unsafe",
    "late",
    "bit_flips",
    "bit_flips_unsafe",
    "stops_met",
    "motion_ticks",
    "driven_axis_ticks",
    "homings",
    "moves_accepted",
    "requests_refused",
    "configurations_refused",
    "cases",
)
HAPPENED = (
    "motion_ticks",
    "driven_axis_ticks",
    "homings",
    "moves_accepted",
    "stops_met",
    "bit_flips",
    "configurations_refused",
)
FULL = {"ticks": 100_000_000, "faults_injected": 1_000_000}
"""What a full run has at least."""
SWEEPS = {
    "state_bits": "state_bits_flipped",
    "config_bits": "config_bits_flipped",
    "estop_ticks": "estop_ticks_swept",
    "pedal_ticks": "pedal_ticks_swept",
}
"""What a full run comes to all of: a set of bits in the program's totals, and the figure that counts it."""
KINDS = {"axis_faults": "axis_faults_seen", "causes": "lock_causes_seen"}
"""What the kernel can find wrong: how often it found each, by its number in the catalogue, from 1 on."""
COUNTED = {"config_bits_driven": "config_bits_flipped_driven", "kind_pairs": "kind_pairs_seen"}
"""Sets of which chance decides how much of them a run comes to."""
SUPPORTS = (*(f"P{number}" for number in range(1, 15)), "P16")


def merge(parts: list[dict]) -> dict[str, float]:
    """Totals of all processes; what each sweep came to at least once, and what there is to come to."""
    figures: dict[str, float] = {key: sum(part[key] for part in parts) for key in SUMMED}
    for key, name in (*SWEEPS.items(), *COUNTED.items()):
        seen = 0
        for part in parts:
            seen |= int(part[key], 16)
        figures[name] = seen.bit_count()
    for key, name in KINDS.items():
        found = [sum(counts) for counts in zip(*(part[key] for part in parts), strict=True)][1:]
        figures[key] = len(found)
        figures[name] = sum(count > 0 for count in found)
    for key in (*SWEEPS, "kind_pairs"):
        figures[key] = parts[0]["sizes"][key]
    processor_s = sum(part["processor_s"] for part in parts)
    figures["processor_s"] = round(processor_s, 1)
    figures["ticks_per_processor_s"] = round(figures["ticks"] / processor_s)
    # A sum modulo 2^53: any reader of JSON keeps it exactly.
    figures["digest"] = sum(part["digest"] for part in parts) % 2**53
    return figures


def options_of(arguments: argparse.Namespace, job: int) -> list[str]:
    """What the program is told to do as one of the jobs."""
    options = ["--seed", str(arguments.seed), "--first", str(job), "--stride", str(arguments.jobs)]
    if arguments.ticks:
        cases = -(-arguments.ticks // CASE_TICKS)
        return [*options, "--cases", str(len(range(job, cases, arguments.jobs)))]
    return [*options, "--seconds", str(arguments.seconds)]


def run_here(program: Path, parts: list[list[str]], log: Path) -> list[tuple[int, str]]:
    """Exit code and output of each part, all at once on this machine."""
    commands = [[str(program), *options, "--failures", str(log)] for options in parts]
    running = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for command in commands]
    outputs = [process.communicate()[0] for process in running]
    return [(process.returncode, output) for process, output in zip(running, outputs, strict=True)]


def print_table(figures: dict[str, float], parts: list[dict]) -> None:
    for key, value in figures.items():
        print(f"{key:24} {value:>16,}")
    kinds = {kind: sum(part["faults_by_kind"][kind] for part in parts) for kind in parts[0]["faults_by_kind"]}
    print("\ninjected")
    for kind, count in sorted(kinds.items(), key=lambda item: -item[1]):
        print(f"  {kind:34} {count:>12,}")


def left_out(figures: dict[str, float]) -> list[str]:
    """What the sweeps have not come to and the kernel has not found, each as a sentence."""
    return [
        f"{name}: {figures[name]:,.0f} of {figures[key]:,.0f}"
        for key, name in (SWEEPS | KINDS).items()
        if figures[name] != figures[key] or not figures[key]
    ]


def status_of(figures: dict[str, float], failed: bool) -> str:
    """What the figures come to."""
    if failed or figures["unsafe"] or figures["late"] or figures["bit_flips_unsafe"]:
        return "FAILED"
    if not all(figures[key] for key in HAPPENED):
        return "VACUOUS"
    if any(figures[key] < least for key, least in FULL.items()):
        return "BOUNDED"
    return "VACUOUS" if left_out(figures) else "PASSED"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bin", type=Path, default=evidence.ROOT / "build/release/bin")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=0, help="processes (as many as cores, or the cluster's)")
    parser.add_argument("--scheduler", help="of Dask, as tcp://HOST:PORT: runs on its workers")
    parser.add_argument("--seconds", type=float, default=300, help="of processor time, each process")
    parser.add_argument("--ticks", type=int, default=0, help="in all, instead of --seconds")
    arguments = parser.parse_args()
    if not arguments.jobs:
        own = os.cpu_count() or 1
        arguments.jobs = cluster.threads_of(arguments.scheduler) if arguments.scheduler else own
    if arguments.ticks:
        arguments.jobs = min(arguments.jobs, -(-arguments.ticks // CASE_TICKS))
    started = time.monotonic()
    log = evidence.log_directory("campaign")
    print(f"campaign: seed {arguments.seed}, {arguments.jobs} processes", flush=True)
    wanted = [options_of(arguments, job) for job in range(arguments.jobs)]
    program = arguments.bin / "kernel_campaign"
    if arguments.scheduler:
        done = cluster.run_parts(arguments.scheduler, program, wanted, log)
    else:
        done = run_here(program, wanted, log)
    if any(code not in (0, 1) for code, _ in done):
        print("campaign: a process did not end by itself", file=sys.stderr)
        return 2
    parts = [json.loads(output) for _, output in done]
    (log / "totals.json").write_text(json.dumps(parts, indent=1) + "\n", "utf-8")
    figures = merge(parts)
    figures["seed"] = arguments.seed
    print_table(figures, parts)
    failed = [part["first_failure"]["text"] for part in parts if "first_failure" in part]
    for text in failed:
        print(f"unsafe or late: {text}")
    for text in left_out(figures):
        print(f"not all of a sweep: {text}")
    status = status_of(figures, bool(failed))
    print(f"campaign: {status}")
    return evidence.write(
        "campaign", status, {"kernel_campaign": evidence.commit()[:12]}, figures, SUPPORTS, started
    )


if __name__ == "__main__":
    sys.exit(main())
