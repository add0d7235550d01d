"""TLC as a subprocess: one model, one configuration, one answer."""

import re
import shutil
import signal
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

from tlc_command import tlc_command

ROOT = Path(__file__).resolve().parents[2]
SPECIFICATION = ROOT / "spec" / "tla"

HOLDS, VIOLATED = (0,), (12, 13)
"""Exit statuses of TLC: 0 all holds, 12 a safety property is violated, 13 a liveness property is."""

TIMED_OUT = -1

STATES = re.compile(r"^(\d+) states generated, (\d+) distinct states found, 0 states left", re.MULTILINE)
BROKEN = re.compile(r"(?:Invariant|Action property|property) (\w+) (?:is|was) violated")
TEMPORAL = "Temporal properties were violated."
VERSION = re.compile(r"^TLC2 Version ([\d.]+)", re.MULTILINE)
MET = re.compile(r'^<<"met", "(\w+)">>$', re.MULTILINE)


@dataclass(frozen=True)
class Answer:
    """What TLC said of one model: its exit status, its words, and the CPU-independent facts in them."""

    status: int
    text: str
    seconds: float

    @property
    def distinct(self) -> int | None:
        """Distinct states of a search that was finished, otherwise None."""
        found = STATES.search(self.text)
        return int(found.group(2)) if found else None

    @property
    def timed_out(self) -> bool:
        return self.status == TIMED_OUT

    @property
    def broken(self) -> str | None:
        """The property that TLC names in a refutation."""
        found = BROKEN.search(self.text)
        return found.group(1) if found else None

    def refutes(self, name: str) -> bool:
        """True for a trace against `name`; a temporal property is not named, so it must be the only one."""
        return self.broken == name or (self.broken is None and TEMPORAL in self.text)

    @property
    def met(self) -> set[str]:
        """The actions that were taken and the properties whose subject has happened, as the model tells."""
        return set(MET.findall(self.text))

    @property
    def version(self) -> str:
        found = VERSION.search(self.text)
        return found.group(1) if found else "unknown"


def prepare(directory: Path) -> None:
    """Makes `directory` a fresh copy of the modules."""
    shutil.rmtree(directory, ignore_errors=True)
    directory.mkdir(parents=True)
    for module in SPECIFICATION.glob("*.tla"):
        shutil.copy(module, directory)


def check(directory: Path, module: str, configuration: str, limit_s: int, brief: bool = False) -> Answer:
    """Runs TLC on a module in `directory` with a configuration given as text.

    The log stays there as tlc.log. A run that takes more than `limit_s` of processor time has the status
    TIMED_OUT.
    """
    (directory / "check.cfg").write_text(configuration, "utf-8")
    command = [
        "prlimit",
        f"--cpu={limit_s}:{limit_s + 5}",
        *tlc_command(directory, stack_mb=16, brief=brief),
        "-cleanup",
        "-metadir",
        str(directory / "states"),
    ]
    command += ["-config", "check.cfg", module]
    began = time.monotonic()
    with (directory / "tlc.log").open("w", encoding="utf-8") as log:
        done = subprocess.run(command, cwd=directory, stdout=log, stderr=subprocess.STDOUT, check=False)
    status = TIMED_OUT if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL) else done.returncode
    shutil.rmtree(directory / "states", ignore_errors=True)
    text = (directory / "tlc.log").read_text("utf-8", "replace")
    return Answer(status, text, time.monotonic() - began)
