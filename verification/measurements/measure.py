#!/usr/bin/env python3
"""Runs a measurement and notes from which inputs it was made. Usage: measure.py ID COMMAND...

Evidence of an earlier run is removed first, so that none can stand in for this one. The key is written beside
the evidence only when the inputs are the same at the end as at the beginning. Exits as the command does.
"""

import subprocess
import sys
from pathlib import Path

from measurements import UnusableError, read_measurements

ROOT = Path(__file__).resolve().parents[2]


def main() -> int:
    name, *command = sys.argv[1:]
    by_name = {one.name: one for one in read_measurements(Path(__file__).with_name("measurements.toml"))}
    if name not in by_name or not command:
        print(f"measure: expected one of {', '.join(by_name)} and a command", file=sys.stderr)
        return 2
    evidence = ROOT / "build/evidence" / f"{name}.json"
    key_file = evidence.with_suffix(".key")
    for path in (evidence, key_file):
        path.unlink(missing_ok=True)
    try:
        key = by_name[name].key()
        code = subprocess.run(command, cwd=ROOT, check=False).returncode
        if evidence.exists() and by_name[name].key() == key:
            key_file.write_text(key, "utf-8")
        elif evidence.exists():
            print(f"measure: inputs of {name} changed while it ran; its evidence holds for its commit alone")
    except UnusableError as error:
        print(f"measure: {error}", file=sys.stderr)
        return 2
    return code


if __name__ == "__main__":
    sys.exit(main())
