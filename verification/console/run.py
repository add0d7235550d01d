"""Measures the console against its budgets in Chromium and writes build/evidence/console.json.

Times, memory and processor share depend on the machine and its load, so no test asserts them: the evidence
says FAILED when a figure is above its limit, and the table marks it.
"""

import argparse
import json
import os
import subprocess
import sys
import time
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "evidence"))
import evidence

LIMITS = {
    "first_load_compressed_bytes": 400_000,
    "interaction_to_paint_ms_p98": 100,
    "plots_interaction_to_paint_ms_p98": 100,
    # A page that keeps nothing was measured within 14 KiB of no growth.
    "memory_growth_kib": 64,
    "memory_growth_nodes": 50,
    "plots_memory_growth_kib": 64,
    "plots_memory_growth_nodes": 50,
    "app_cpu_percent_of_four": 15,
    "plots_app_cpu_percent_of_four": 15,
}


def chromium_version() -> str:
    command = [os.environ.get("CHROMIUM", "/usr/bin/chromium-headless-shell"), "--version"]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()[-1]


def measure(minutes: float, log: Path) -> dict[str, float]:
    """Figures by name; the browser's report goes to the log."""
    figures = log / "figures.json"
    figures.unlink(missing_ok=True)
    environment = {**os.environ, "CONSOLE_MINUTES": str(minutes), "CONSOLE_FIGURES": str(figures)}
    with (log / "browser.log").open("w") as report:
        done = subprocess.run(
            ["npm", "run", "--silent", "measure", "--", "budget.measure.ts"],
            cwd=evidence.ROOT / "web",
            env=environment,
            stdout=report,
            stderr=subprocess.STDOUT,
            check=False,
        )
    if done.returncode != 0:
        raise SystemExit(f"the console could not be measured; see {log / 'browser.log'}")
    return json.loads(figures.read_text())


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=10, help="for which memory is watched")
    arguments = parser.parse_args()
    started = time.monotonic()
    log = evidence.log_directory("console")
    figures = measure(arguments.minutes, log)
    above = {name for name, limit in LIMITS.items() if not figures[name] <= limit}
    for name, value in figures.items():
        beside = f"   limit {LIMITS[name]}" if name in LIMITS else ""
        print(f"{name:32} {value:>10}{beside}{'   ABOVE' if name in above else ''}")
    tools = {"chromium": chromium_version(), "interlock": evidence.commit()[:12]}
    return evidence.write("console", "FAILED" if above else "PASSED", tools, figures, [], started)


if __name__ == "__main__":
    sys.exit(main())
