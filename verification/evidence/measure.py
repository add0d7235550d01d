#!/usr/bin/env python3
"""Runs a check and notes from which inputs its evidence was made. Usage: measure.py NAME COMMAND...

Evidence of an earlier run is removed first, so that none can stand in for this one. The key is written into
the evidence only when the inputs are the same at the end as at the beginning. Exits as the command does.
"""

import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from evidence import EVIDENCE, ROOT
from expected import Check, UnusableError, read_checks


def measure(check: Check, command: Sequence[str], tree: Path = ROOT, **options: object) -> int:
    """Runs the command of a check in the tree, or in a copy of it; returns its exit status."""
    evidence = EVIDENCE / f"{check.name}.json"
    evidence.unlink(missing_ok=True)
    key = check.key()
    code = subprocess.run(command, cwd=tree, check=False, **options).returncode
    if evidence.exists() and check.key() == key:
        check.note_key(key, tree)
    elif evidence.exists():
        print(f"inputs of {check.name} changed while it ran; its evidence holds for its commit alone")
    return code


def main() -> int:
    name, *command = sys.argv[1:]
    try:
        by_name = {one.name: one for one in read_checks()}
        if name not in by_name or not command:
            raise UnusableError(f"expected one of {', '.join(by_name)} and a command")
        return measure(by_name[name], command)
    except UnusableError as error:
        print(f"measure: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
