"""What a check, as a rung of the ladder, leaves in build/evidence/: one JSON file and its raw logs."""

import json
import os
import platform
import resource
import subprocess
import time
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
EVIDENCE = ROOT / "build" / "evidence"

SOUND = ("PASSED", "BOUNDED")
"""The statuses that may carry a claim. A bounded result says its bounds in its figures."""
STATUSES = (*SOUND, "UNKNOWN", "FAILED", "VACUOUS")


def log_directory(rung: str) -> Path:
    """The directory for the raw logs of a rung, made if it is missing."""
    directory = EVIDENCE / rung
    directory.mkdir(parents=True, exist_ok=True)
    return directory


class Failures:
    """What a rung found wrong, in the project's terms, kept in build/evidence/RUNG/failures.txt.

    A rung's log may be long; what `make verify` shows of a rung that failed is this file. One for each run
    of a rung: it begins empty.
    """

    def __init__(self, rung: str) -> None:
        self.path = failures_file(rung)
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self.path.unlink(missing_ok=True)

    def tell(self, text: str) -> None:
        """Prints a failure, of one line or several, and keeps it."""
        print(text, flush=True)
        with self.path.open("a", encoding="utf-8") as file:
            file.write(text.rstrip("\n") + "\n")


def failures_file(rung: str) -> Path:
    """Where a rung keeps its failures; there is none when it told none."""
    return EVIDENCE / rung / "failures.txt"


def machine() -> str:
    """What a run was made on, in words: operating system, architecture and cores; no name of it."""
    system = platform.freedesktop_os_release()["PRETTY_NAME"]
    return f"{system}, Linux {platform.release()} {platform.machine()}, {os.cpu_count()} cores"


def processor_s() -> float:
    """Processor time of this program and of all that it ran: what load beside it hardly changes."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(one.ru_utime + one.ru_stime for one in used)


def commit() -> str:
    """The commit that the sources are at, with `+changes` when they differ from it.

    A check that runs in a copy of its inputs is given the commit of their tree as SOURCE_COMMIT.
    """
    if given := os.environ.get("SOURCE_COMMIT"):
        return given

    def git(*arguments: str) -> str:
        done = subprocess.run(["git", *arguments], cwd=ROOT, check=True, capture_output=True, text=True)
        return done.stdout.strip()

    return git("rev-parse", "HEAD") + ("+changes" if git("status", "--porcelain") else "")


def write(
    rung: str,
    status: str,
    tools: Mapping[str, str],
    figures: Mapping[str, float],
    supports: Sequence[str],
    started: float,
) -> int:
    """Writes build/evidence/RUNG.json and returns the exit status of the rung: 0 only for PASSED and BOUNDED.

    `tools` gives each tool's version by its name, `supports` the properties (P1 to P16, L1, L2) that the
    result carries, `started` the `time.monotonic()` at which the rung began. Raises ValueError for an unknown
    status.
    """
    if status not in STATUSES:
        raise ValueError(f"status of {rung}: '{status}'; expected one of {', '.join(STATUSES)}")
    document = {
        "id": rung,
        "status": status,
        "tool": {"name": ", ".join(tools), "version": ", ".join(tools.values())},
        "commit": commit(),
        "date": datetime.now(UTC).isoformat(timespec="seconds"),
        "machine": machine(),
        "duration_s": round(time.monotonic() - started, 1),
        "processor_s": round(processor_s(), 1),
        "figures": dict(figures),
        "supports": list(supports),
        "log": str(log_directory(rung).relative_to(EVIDENCE)),
    }
    (EVIDENCE / f"{rung}.json").write_text(json.dumps(document, indent=2) + "\n", "utf-8")
    return 0 if status in SOUND else 1
