"""How fast the loop could run: the highest rate at which no deadline is missed, and cyclictest's beside it.

The periods tried are those that a configuration may have, 2000 us down to 125 us, and that divide the times
of the robot's file. At each the executive runs with the plant in its own process and nobody attached
(executive_bench rate), then cyclictest for as long on the same core. The rate stated is the last before the
first miss.
"""

import json
import os
import re
import subprocess
import tempfile
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PERIODS_US = (2000, 1000, 500, 400, 250, 200, 125)
PRIORITY = 80


def configuration(binaries: Path, period_us: int, folder: Path) -> Path:
    """The NeuroRobot's configuration for that period."""
    text = (ROOT / "models/robots/neuro.toml").read_text("utf-8")
    robot, compiled = folder / f"{period_us}.toml", folder / f"{period_us}.ilkc"
    robot.write_text(
        re.sub(r"^period_us = \d+$", f"period_us = {period_us}", text, flags=re.MULTILINE), "utf-8"
    )
    command = [binaries / "interlock", "model", "compile", robot, "-o", compiled]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return compiled


def executive_misses(binaries: Path, compiled: Path, seconds: int, core: int) -> int:
    plant = ROOT / "models/plant/neuro.toml"
    command = [
        binaries / "executive_bench",
        "rate",
        compiled,
        plant,
        str(seconds),
        "1",
        str(core),
        str(PRIORITY),
    ]
    return json.loads(subprocess.run(command, check=True, capture_output=True).stdout)["missed"]


def cyclictest_misses(period_us: int, seconds: int, core: int, log: Path) -> int:
    """1 when its longest wake-up took longer than a period, for it does not count them."""
    options = ["-q", "-m", "-t1", f"-a{core}", f"-p{PRIORITY}", f"-i{period_us}", f"-D{seconds}"]
    subprocess.run(["cyclictest", *options, f"--json={log}"], check=True, stdout=subprocess.DEVNULL)
    return int(json.loads(log.read_text("utf-8"))["thread"]["0"]["max"] > period_us)


def highest(misses: Callable[[int], int]) -> tuple[float, dict[str, int]]:
    """The highest rate in Hz before the first miss, 0 when the longest period missed; what was seen."""
    rate, seen = 0.0, {}
    for period_us in PERIODS_US:
        seen[str(period_us)] = misses(period_us)
        if seen[str(period_us)]:
            break
        rate = round(1e6 / period_us, 1)
    return rate, seen


def search(binaries: Path, seconds: int) -> dict:
    core = max(os.sched_getaffinity(0))
    with tempfile.TemporaryDirectory(prefix="interlock-rate-") as name:
        folder = Path(name)
        ours, ours_seen = highest(
            lambda period: executive_misses(binaries, configuration(binaries, period, folder), seconds, core)
        )
        theirs, theirs_seen = highest(
            lambda period: cyclictest_misses(period, seconds, core, folder / "cyclictest.json")
        )
    return {
        "seconds": seconds,
        "executive_hz": ours,
        "cyclictest_hz": theirs,
        "missed_by_period_us": {"executive": ours_seen, "cyclictest": theirs_seen},
    }
