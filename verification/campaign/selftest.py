#!/usr/bin/env python3
"""Shows that the campaign and the hostile driver notice each rule of the kernel that is taken out.

Usage: selftest.py [NAME ...]; all rules of verification/mutation/rules.toml when none is named. Each kernel
is compiled from the sources with the rule's edits and linked with what `make build-tests` built. It counts
as noticed when the driver that it names reports its clause within the seconds given; the healthy kernel must
not fail.
Prints a line a rule and writes build/evidence/campaign_selftest.json.
"""

import argparse
import json
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "verification/evidence"))
import evidence  # noqa: E402

KERNEL, MONITORS, BUILT = ROOT / "kernel", ROOT / "kernel/monitors", ROOT / "build/release"
HOSTILE = ROOT / "verification/monitors/hostile.c"
COMPILE = ["gcc", "-std=c11", "-O2", "-ffreestanding", f"-I{KERNEL}/include"]
SLOTS_OF_HOSTILE = 2
SEED = 1


def read_rules(names: list[str]) -> list[dict]:
    rules = tomllib.loads((ROOT / "verification/mutation/rules.toml").read_text("utf-8"))["rule"]
    return [rule for rule in rules if not names or rule["name"] in names]


def edited(rule: dict | None, folder: Path) -> Path:
    """The sources with the rule's edits. Raises ValueError when a text does not stand there once."""
    sources = folder / "src"
    shutil.copytree(KERNEL / "src", sources)
    for name, before, after in rule["edits"] if rule else ():
        text = (sources / name).read_text("utf-8")
        if text.count(before) != 1:
            raise ValueError(f"{rule['name']}: {text.count(before)} times in {name}: {before!r}")
        (sources / name).write_text(text.replace(before, after), "utf-8")
    return sources


def build_hostile(sources: Path, program: Path) -> None:
    files = [*sources.glob("*.c"), HOSTILE, MONITORS / "monitors.c", MONITORS / "adopt.c"]
    options = [f"-DILK_SLOTS={SLOTS_OF_HOSTILE}", f"-I{sources}", f"-I{MONITORS}", f"-I{HOSTILE.parent}"]
    subprocess.run(
        ["gcc", "-std=c11", "-O2", f"-I{KERNEL}/include", *options, *files, "-o", program], check=True
    )


def build_campaign(sources: Path, program: Path) -> None:
    objects = []
    for file in sources.glob("*.c"):
        objects.append(file.with_suffix(".o"))
        options = ["-DILK_FRAME_WORDS=32", f"-I{sources}"]
        subprocess.run([*COMPILE, *options, "-c", file, "-o", objects[-1]], check=True)
    [main] = BUILT.glob("verification/campaign/CMakeFiles/kernel_campaign.dir/**/*.o")
    libraries = [
        BUILT / "verification/campaign/libinterlock_campaign.a",
        BUILT / "kernel/monitors/libinterlock_monitors.a",
        BUILT / "models/plant/libinterlock_plant.a",
    ]
    subprocess.run(["g++", main, *libraries, *objects, "-ltomlplusplus", "-o", program], check=True)


def finding(driver: str, rule: dict | None, seconds: float, clause: str = "") -> tuple[str, float]:
    """What the driver finds of such a kernel up to the clause, or nothing, and after how many seconds."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        sources, program = edited(rule, folder), folder / driver
        (build_hostile if driver == "hostile" else build_campaign)(sources, program)
        started = time.monotonic()
        if driver == "hostile":
            command = [program, str(seconds), str(SEED), *([clause] if clause else ())]
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            found = [
                line for line in done.stdout.splitlines() if line.startswith("VIOLATED") and clause in line
            ]
            text = found[0].partition(": ")[2] if found else ""
        else:
            command = [
                program,
                "--seed",
                str(SEED),
                "--seconds",
                str(seconds),
                "--failures",
                folder / "cases",
            ]
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            text = json.loads(done.stdout.splitlines()[0]).get("first_failure", {}).get("text", "")
        if done.returncode not in (0, 1):
            raise RuntimeError(f"{driver} did not run: {done.stderr.strip()}")
        return text, time.monotonic() - started


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", help="rules to take out (default: all)")
    parser.add_argument("--seconds", type=float, default=60, help="of processor time for each rule")
    arguments = parser.parse_args()
    started = time.monotonic()
    rules, outcomes, unnoticed = read_rules(arguments.names), {}, []
    healthy = {driver: finding(driver, None, 20)[0] for driver in ("campaign", "hostile")}
    for rule in rules:
        driver, clause = rule["campaign"].split(" ", 1)
        text, seconds = finding(driver, rule, arguments.seconds, clause)
        noticed = clause in text
        unnoticed += [] if noticed else [rule["name"]]
        outcomes[rule["name"]] = {"driver": driver, "text": text, "seconds": round(seconds, 1)}
        print(
            f"{'noticed' if noticed else 'MISSED ':8} {rule['name']:54} {seconds:6.1f} s  {text}", flush=True
        )
    sick = {driver: text for driver, text in healthy.items() if text}
    print(
        f"campaign selftest: {len(unnoticed)} of {len(rules)} rules not noticed; "
        f"healthy kernel: {sick or 'no finding'}"
    )
    log = evidence.log_directory("campaign_selftest") / "outcomes.json"
    log.write_text(json.dumps({"healthy": healthy, **outcomes}, indent=1) + "\n", "utf-8")
    figures = {
        "rules": len(rules),
        "rules_noticed": len(rules) - len(unnoticed),
        "seconds_worst": max((each["seconds"] for each in outcomes.values()), default=0.0),
        "seconds_most": arguments.seconds,
    }
    status = "FAILED" if unnoticed or sick else "PASSED"
    tools = {"gcc": evidence.commit()[:12]}
    return evidence.write("campaign_selftest", status, tools, figures, [], started)


if __name__ == "__main__":
    sys.exit(main())
