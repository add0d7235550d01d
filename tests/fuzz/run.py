#!/usr/bin/env python3
"""Builds each fuzzer with address and undefined sanitizers, lets it run, and writes build/evidence/fuzz.json.

Usage: run.py seconds S   each fuzzer for S seconds
       run.py runs N      N inputs in all, the same share for each; ten million took 19 minutes

The fuzzers run beside each other, one core each. Ends by how many inputs there were, of each and in all.
FAILED says that one broke a fuzzer, or that there were fewer inputs than were asked for; BOUNDED that fewer
ran than the project asks for; PASSED is the rest.
What a fuzzer finds lies in build/fuzz/ and ends it; it belongs into tests/fuzz/corpus/ with the repair.
"""

import re
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2] / "verification/evidence"))

import evidence
from evidence import ROOT

FUZZERS = ("stream", "body")
REQUIRED_INPUTS = 10_000_000
CODEC = ("brp2013", "crc64", "crtk", "decode", "dialect", "dialects", "encode", "fault", "frame", "header")
CODEC += ("message", "phase", "thesis", "workphases", "wpi2024")
OUT = ROOT / "build/fuzz"


@dataclass
class Result:
    """What became of one fuzzer."""

    inputs: int
    seconds: float
    is_broken: bool


def build(fuzzer: str) -> Path:
    program = OUT / fuzzer
    command = ["clang++-19", "-std=c++20", "-O1", "-g", "-fno-omit-frame-pointer"]
    command += ["-fsanitize=fuzzer,address,undefined", "-fno-sanitize-recover=all"]
    command += ["-Iapp", "-isystem", "/usr/include/openigtlink", f"tests/fuzz/{fuzzer}.cpp"]
    command += [f"app/igtl/{part}.cpp" for part in CODEC]
    subprocess.run([*command, "-lOpenIGTLink", "-o", str(program)], cwd=ROOT, check=True)
    return program


def run(fuzzer: str, limit: str, log: Path) -> Result:
    program = build(fuzzer)
    found = OUT / "found" / fuzzer
    found.mkdir(parents=True, exist_ok=True)
    command = [str(program), limit, "-max_len=2048", "-seed=1", "-timeout=5", "-print_final_stats=1"]
    command += [f"-artifact_prefix={OUT}/{fuzzer}-", str(found), str(ROOT / "tests/fuzz/corpus" / fuzzer)]
    begun = time.monotonic()
    with log.open("w") as output:
        ended = subprocess.run(command, cwd=ROOT, stdout=output, stderr=output, check=False)
    told = log.read_text(errors="replace")
    counted = re.search(r"^stat::number_of_executed_units:\s*(\d+)", told, re.MULTILINE)
    inputs = int(counted[1]) if counted else 0
    is_broken = ended.returncode != 0
    if is_broken:
        print("\n".join(told.splitlines()[-40:]))
    print(f"fuzz: {fuzzer}: {inputs} inputs, {'one' if is_broken else 'none'} broke it", flush=True)
    return Result(inputs, round(time.monotonic() - begun, 1), is_broken)


def clang_version() -> str:
    told = subprocess.run(["clang++-19", "--version"], capture_output=True, text=True, check=True).stdout
    return told.splitlines()[0].split("version ")[1].split()[0]


def status_of(results: dict[str, Result], least: int) -> str:
    total = sum(result.inputs for result in results.values())
    if total < least or any(result.is_broken or result.inputs == 0 for result in results.values()):
        return "FAILED"
    return "PASSED" if total >= REQUIRED_INPUTS else "BOUNDED"


def main() -> int:
    match sys.argv[1:]:
        case ["seconds", amount] if amount.isdigit() and int(amount) > 0:
            least, limit = 1, f"-max_total_time={amount}"
        case ["runs", amount] if amount.isdigit() and int(amount) > 0:
            least, limit = int(amount), f"-runs={int(amount) // len(FUZZERS) + 1}"
        case _:
            print(__doc__, file=sys.stderr)
            return 2
    started = time.monotonic()
    logs = evidence.log_directory("fuzz")
    OUT.mkdir(parents=True, exist_ok=True)
    with ThreadPoolExecutor(len(FUZZERS)) as pool:
        ended = pool.map(lambda fuzzer: run(fuzzer, limit, logs / f"{fuzzer}.log"), FUZZERS)
        results = dict(zip(FUZZERS, ended, strict=True))
    figures: dict[str, float] = {"inputs": sum(result.inputs for result in results.values())}
    figures |= {"required_inputs": REQUIRED_INPUTS, "asked_inputs": least}
    figures["findings"] = sum(result.is_broken for result in results.values())
    for fuzzer, result in results.items():
        figures |= {f"{fuzzer}_inputs": result.inputs, f"{fuzzer}_s": result.seconds}
    status = status_of(results, least)
    code = evidence.write("fuzz", status, {"libFuzzer": clang_version()}, figures, [], started)
    print(f"fuzz: {status}: {figures['inputs']} inputs in all; build/evidence/fuzz.json")
    return code


if __name__ == "__main__":
    sys.exit(main())
