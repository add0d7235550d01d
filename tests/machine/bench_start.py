#!/usr/bin/env python3
"""Measures `make run` in bare roots of Debian: `make bench-start`; start.schema.json explains each figure.

A first root fills the folder of downloads, a second one is measured: set-up, build, start to "ready", and
start again with nothing changed. Processor time is that of the command and of all that it ran; that of a
start ends with the end of the robot, a second or two after "ready". Load beside it lengthens the seconds on
the clock, and those of the processor, too, by caches that are shared; the record states the load.
"""

import argparse
import json
import os
import sys
from collections.abc import Mapping
from datetime import UTC, datetime
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2] / "verification/evidence"))

import bare_root
import evidence
import jsonschema

SCHEMA = Path(__file__).with_name("start.schema.json")
LIMITS = {"wall_s": 360, "processor_s": 480, "again_wall_s": 5}
"""Of a first `make run` as a whole, and of one with nothing changed, on two idle cores."""


def measure(release: str, folder: Path) -> Mapping[str, object]:
    """What each phase took in a bare root of this release."""
    with bare_root.BareRoot(release, folder) as filling:
        filling.run("make", "setup-run")
    with bare_root.BareRoot(release, folder) as bare:
        phases = {"set-up": bare.run("make", "setup-run"), "build": bare.run("make", "build")}
        phases["start"], _ = bare.start_robot()
        again, printed = bare.start_robot()
    wall, processor = (
        round(sum(getattr(one, name) for one in phases.values()), 1) for name in ("wall_s", "processor_s")
    )
    figures = {"wall_s": wall, "processor_s": processor, "again_wall_s": again.wall_s}
    for name, spent in {**phases, "again": again}.items():
        print(f"Debian {release} {name:8} {spent.wall_s:8} s {spent.processor_s:8} s of processor time")
    for name, value in figures.items():
        above = f"  ABOVE {LIMITS[name]}" if value > LIMITS[name] else ""
        print(f"Debian {release} {name:14} {value:8}{above}", flush=True)
    taken = {name: vars(spent) for name, spent in {**phases, "again": again}.items()}
    return {**figures, "lines_printed_again": len(printed), "phases": taken}


def main() -> int:
    parser = argparse.ArgumentParser(description="Measures `make run` in bare roots of Debian.")
    parser.add_argument("releases", nargs="*", metavar="release", default=[*bare_root.SUITES])
    parser.add_argument("--folder", type=Path, default=bare_root.FOLDER)
    asked = parser.parse_args()
    bare_root.enter_namespaces()
    load = [round(os.getloadavg()[0], 1)]
    measured = {release: measure(release, asked.folder) for release in asked.releases}
    above = [name for one in measured.values() for name, limit in LIMITS.items() if one[name] > limit]
    record = {
        "id": "start",
        "status": "FAILED" if above else "PASSED",
        "commit": evidence.commit(),
        "date": datetime.now(UTC).isoformat(timespec="seconds"),
        "machine": evidence.machine(),
        "load_average": [*load, round(os.getloadavg()[0], 1)],
        "limits": LIMITS,
        "releases": measured,
    }
    jsonschema.validate(record, json.loads(SCHEMA.read_text("utf-8")))
    evidence.EVIDENCE.mkdir(parents=True, exist_ok=True)
    path = evidence.EVIDENCE / "start.json"
    path.write_text(json.dumps(record, indent=2) + "\n", "utf-8")
    print(f"bench-start: {path.relative_to(evidence.ROOT)}")
    return 1 if above else 0


if __name__ == "__main__":
    sys.exit(main())
