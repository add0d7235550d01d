#!/usr/bin/env python3
"""Notes what a run of tests is made from, before it starts. Usage: begin_tests.py SUITE

Removes build/reports/SUITE.xml, so that no earlier report can stand in for this run, and writes
SUITE.run.json beside it: commit, date, tool and machine, which a JUnit report does not tell.
"""

import importlib.metadata
import json
import subprocess
import sys
from datetime import UTC, datetime

from evidence import ROOT, commit, machine


def debian_version(package: str) -> str:
    command = ["dpkg-query", "-W", "-f", "${Version}", package]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def npm_version(package: str) -> str:
    locked = json.loads((ROOT / "web/package-lock.json").read_text("utf-8"))
    return str(locked["packages"][f"node_modules/{package}"]["version"])


def tool_of(suite: str) -> str:
    """Name and version of the tool that runs a suite. Raises KeyError for one that there is not."""
    tools = {
        "unit": lambda: f"GoogleTest {debian_version('libgtest-dev')}",
        "integration": lambda: f"pytest {importlib.metadata.version('pytest')}",
        "network": lambda: f"pytest {importlib.metadata.version('pytest')}",
        "console": lambda: f"Vitest {npm_version('vitest')}",
        "browser": lambda: f"Playwright {npm_version('playwright-core')}",
    }
    return tools[suite]()


def main() -> int:
    suite = sys.argv[1]
    reports = ROOT / "build/reports"
    reports.mkdir(parents=True, exist_ok=True)
    (reports / f"{suite}.xml").unlink(missing_ok=True)
    run = {
        "commit": commit(),
        "date": datetime.now(UTC).isoformat(timespec="seconds"),
        "tool": tool_of(suite),
        "machine": machine(),
    }
    (reports / f"{suite}.run.json").write_text(json.dumps(run, indent=2) + "\n", "utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
