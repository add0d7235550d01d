"""What evidence must show: verification/expected.toml; and the key that says what it was made from."""

import hashlib
import json
import os
import subprocess
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from functools import cache
from pathlib import Path

from evidence import EVIDENCE, ROOT, SOUND, STATUSES, commit

EXPECTED = ROOT / "verification" / "expected.toml"
KEPT = ROOT / "verification" / "evidence" / "kept"
EVERY_CHECK_READS = "verification/evidence/evidence.py"
DEMANDS = ("commit", "release")


class UnusableError(Exception):
    """The checks cannot be run as stated; the text says what to correct."""


@cache
def version(tool: str) -> str:
    """The first line of what a tool says of its version; empty without the tool."""
    path = f"{ROOT}/build/provers/bin:{ROOT}/build/venv/bin:{os.environ['PATH']}"
    command = ["env", f"PATH={path}", tool, "--version"]
    lines = subprocess.run(command, capture_output=True, text=True, check=False).stdout.splitlines()
    return next((line.strip() for line in lines if line.strip()), "")


@dataclass(frozen=True)
class Check:
    """One table of verification/expected.toml; the head of that file says what each key means."""

    name: str
    title: str
    target: str
    inputs: tuple[str, ...]
    tools: tuple[str, ...] = ()
    command: str = ""
    demanded: str = "commit"
    status: str = "PASSED"
    figures: Mapping[str, float] = field(default_factory=dict)
    least: Mapping[str, float] = field(default_factory=dict)
    cores: int = 1
    memory_gb: float = 1
    after: tuple[str, ...] = ()

    def missing_tools(self) -> list[str]:
        """The tools that this machine lacks, after set-up those that its release of Debian does not have."""
        return [tool for tool in self.tools if not version(tool)]

    def files(self) -> list[Path]:
        """The files that decide the result, of those that git does not ignore.

        Raises UnusableError when a glob matches none.
        """
        listed = subprocess.run(
            ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
            cwd=ROOT,
            check=True,
            capture_output=True,
            text=True,
        ).stdout.split("\0")
        sources = {ROOT / name for name in listed}
        found: set[Path] = set()
        for pattern in (EVERY_CHECK_READS, *self.inputs):
            matching = {path for path in ROOT.glob(pattern) if path in sources and path.is_file()}
            if not matching:
                raise UnusableError(f"[{self.name}]: no file matches the input '{pattern}'")
            found |= matching
        return sorted(found)

    def key(self) -> str:
        """A hash over all that decides the result: command, inputs by name and content, tools by version.

        It is the same in every clone on every machine with these tools.
        """
        digest = hashlib.sha256(f"{self.command or self.target}\0".encode())
        for tool in self.tools:
            digest.update(f"{tool}\0{version(tool)}\0".encode())
        for file in self.files():
            digest.update(f"{file.relative_to(ROOT)}\0".encode() + hashlib.sha256(file.read_bytes()).digest())
        return digest.hexdigest()

    def evidence(self, folder: Path = EVIDENCE) -> dict[str, object]:
        """The evidence in a folder, or an empty dictionary."""
        try:
            return json.loads((folder / f"{self.name}.json").read_text("utf-8"))
        except (OSError, json.JSONDecodeError):
            return {}

    def holds(self, folder: Path = EVIDENCE) -> bool:
        """Whether the evidence in a folder was made from what stands here now."""
        found = self.evidence(folder).get("key")
        return found is not None and found == self.key()

    def note_key(self, key: str, copy: Path = ROOT) -> None:
        """Writes the key into the evidence, in which paths become relative to `copy`, where it was made."""
        file = EVIDENCE / f"{self.name}.json"
        document = json.loads(file.read_text("utf-8").replace(f"{copy}/", ""))
        file.write_text(json.dumps({**document, "key": key}, indent=2) + "\n", "utf-8")

    def too_short(self, figures: Mapping[str, float]) -> str:
        """In which figure a run came to less than it must, in words; empty when in none."""
        short = [
            f"{name} {figures.get(name, 'missing')}, at least {least}"
            for name, least in self.least.items()
            if not figures.get(name, 0) >= least
        ]
        return "; ".join(short)

    def faults(self, evidence: Mapping[str, object]) -> list[str]:
        """Where evidence differs from what is expected, a sentence each."""
        status, figures = evidence["status"], evidence["figures"]
        faults = [] if status == self.status else [f"status {status}, expected {self.status}"]
        for name, expected in self.figures.items():
            found = figures.get(name)
            if found != expected:
                faults.append(f"{name} {'missing' if found is None else found}, expected {expected}")
        return [*faults, *filter(None, [self.too_short(figures)])]

    def why_not_kept(self) -> str:
        """What speaks against keeping the evidence in build/evidence, in words; empty when nothing does."""
        if not self.holds():
            return f"no evidence of these inputs; {self.target} makes it"
        document = self.evidence()
        if document["status"] not in SOUND:
            return f"its status is {document['status']}"
        if str(document["commit"]).endswith("+changes"):
            return "it was made with changes beside its commit, so nobody could make it again"
        return "; ".join(self.faults(document))


def read_checks(path: Path = EXPECTED) -> list[Check]:
    """The checks of the file, in its order. Raises UnusableError naming the table and key that is wrong."""
    keys = {one.name for one in fields(Check)} - {"name"}
    checks: list[Check] = []
    for name, table in tomllib.loads(path.read_text("utf-8")).items():
        where = f"{path.name}: [{name}]"
        wrong = sorted((set(table) - keys) | ({"title", "target", "inputs"} - set(table)))
        if wrong:
            raise UnusableError(f"{where}: keys missing or unknown: {', '.join(wrong)}")
        lists = {key: tuple(value) for key, value in table.items() if isinstance(value, list)}
        check = Check(name, **{**table, **lists})
        for key, value, known in (
            ("status", check.status, STATUSES),
            ("demanded", check.demanded, DEMANDS),
            *(("after", one, [other.name for other in checks]) for one in check.after),
        ):
            if value not in known:
                raise UnusableError(f"{where}: {key} '{value}'; expected one of {', '.join(known)}")
        checks.append(check)
    return checks


def drawn(checks: list[Check], limit_s: float) -> Check | None:
    """The kept check that this commit draws to be repeated, of those that their cores do within the limit."""
    able = [
        check
        for check in checks
        if check.command
        and check.evidence(KEPT).get("processor_s", limit_s * check.cores + 1) <= limit_s * check.cores
        and check.holds(KEPT)
    ]
    seed = commit().removesuffix("+changes")
    return min(able, key=lambda check: hashlib.sha256(f"{seed} {check.name}".encode()).digest(), default=None)
