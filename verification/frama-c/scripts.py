"""Scripts of WP: which prover finds a goal that the one asked first does not find soon.

A script is a file `session/script/GOAL.json` in WP's own format. It proves nothing: WP gives the goal to the
prover that the script names, with the time that this took and some more, and to the others when it fails.
Without a script the first prover would use up its time before the next is asked.
"""

import json
import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

SESSION = Path(__file__).resolve().parent / "session"
FOLDER = SESSION / "script"

PROVED = re.compile(r"^\[wp\] \[(?P<prover>[^\]]+)\] Goal (?P<goal>\w+) : Valid(?P<rest>.*)$", re.MULTILINE)
SECONDS = re.compile(r"\((?P<number>[\d.]+)(?P<unit>m?s)\)")
STEPS = re.compile(r"\((\d+)\)")


@dataclass(frozen=True)
class Proof:
    """How WP's log says that a goal was proved. What a script proved has neither seconds nor steps there."""

    prover: str
    seconds: float
    steps: int

    @property
    def by_script(self) -> bool:
        return self.prover == "Script"


def proofs(log: str) -> dict[str, Proof]:
    """The goals that a log says to be proved, by name."""
    found = {}
    for line in PROVED.finditer(log):
        seconds, steps = SECONDS.search(line["rest"]), STEPS.search(line["rest"])
        scale = 0.001 if seconds and seconds["unit"] == "ms" else 1.0
        found[line["goal"]] = Proof(
            line["prover"],
            float(seconds["number"]) * scale if seconds else 0.0,
            int(steps.group(1)) if steps else 0,
        )
    return found


def is_late(proof: Proof, first_prover: str, soon_s: float) -> bool:
    """Whether the first prover had its time, `soon_s`, in vain before this proof was found."""
    another = not proof.prover.lower().startswith((first_prover, "qed"))
    return not proof.by_script and (another or proof.seconds > soon_s)


def keep(log: str, first_prover: str, soon_s: float) -> None:
    """Writes the scripts of one file's goals anew: those that help stay, those that were missed are added."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    for goal, proof in proofs(log).items():
        script = FOLDER / f"{goal}.json"
        if is_late(proof, first_prover, soon_s):
            step = {"prover": proof.prover.replace(" ", ":"), "verdict": "valid"}
            step |= {"time": proof.seconds, "steps": proof.steps}
            script.write_text(json.dumps([step]) + "\n", "utf-8")
        elif not proof.by_script:
            script.unlink(missing_ok=True)


def idle(logs: Iterable[str]) -> list[str]:
    """Scripts of goals that none of the logs has."""
    goals = {goal for log in logs for goal in proofs(log)}
    return sorted(script.stem for script in FOLDER.glob("*.json") if script.stem not in goals)
