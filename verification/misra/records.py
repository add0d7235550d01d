"""deviations.toml: which findings are accepted, and why. An entry that accepts nothing is a fault itself."""

import re
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass
from fnmatch import fnmatch
from pathlib import Path

from plan import category
from tools import ROOT, Finding

RECORDS = Path(__file__).resolve().parent / "deviations.toml"
KEYS = {
    "deviation": {"rule", "category", "files", "sites", "reason"},
    "disapplied": {"rule", "category", "files", "reason"},
    "false_positive": {"rule", "files", "sites", "reason"},
}

WHOLE_PROGRAM = {"2.3", "2.5", "8.7"}
"""Rules about what no other file uses. The checker sees the C files only; the console, the tests and the
proofs use the kernel's headers, too."""
SOURCES = {".c", ".h", ".cpp", ".hpp"}
OTHER_USERS = ("app", "models", "tests", "verification/bench", "verification/cbmc", "verification/target")


@dataclass(frozen=True)
class Record:
    kind: str
    rule: str
    files: tuple[str, ...]
    reason: str
    sites: int | None = None
    category: str | None = None

    def covers(self, finding: Finding) -> bool:
        return finding.check == self.rule and any(fnmatch(finding.file, file) for file in self.files)


def _faults(record: Record) -> list[str]:
    faults = []
    if record.kind != "false_positive":
        if any(file.startswith(("kernel/src", "kernel/include")) for file in record.files):
            faults.append("the core has no deviations")
        if record.category != category(record.rule):
            faults.append(f"category {record.category}, expected {category(record.rule)}")
        if record.category == "mandatory" or (record.kind == "disapplied" and record.category != "advisory"):
            faults.append(f"a {record.category} rule cannot be a {record.kind}")
    return [f"deviations.toml: {record.kind} {record.rule}: {fault}" for fault in faults]


def read_records() -> tuple[list[Record], list[str]]:
    """The records and what is wrong with them."""
    records, faults = [], []
    for kind, tables in tomllib.loads(RECORDS.read_text("utf-8")).items():
        for table in tables:
            if kind not in KEYS or set(table) != KEYS[kind]:
                faults.append(f"deviations.toml: {kind} {table.get('rule')}: keys missing or unknown")
                continue
            record = Record(kind, **{**table, "files": tuple(table["files"])})
            records.append(record)
            faults += _faults(record)
    return records, faults


def _name_at(finding: Finding) -> str:
    """The identifier that the finding is about: a macro, a type or a function that its line introduces."""
    line = (ROOT / finding.file).read_text("utf-8").splitlines()[finding.line - 1]
    match = re.search(r"#define (\w+)|(\w+)\(|\} (\w+);|\btypedef .*?(\w+);", line)
    return next(filter(None, match.groups()), "") if match else ""


def used_elsewhere(finding: Finding) -> bool:
    """True for a finding of a whole-program rule whose name is used in files that were not checked."""
    name = _name_at(finding)
    if finding.check not in WHOLE_PROGRAM or not name:
        return False
    use = re.compile(rf"\b{name}\b")
    files = (path for place in OTHER_USERS for path in (ROOT / place).rglob("*") if path.suffix in SOURCES)
    return any(use.search(path.read_text("utf-8")) for path in files)


def settle(findings: Iterable[Finding], records: list[Record]) -> tuple[list[Finding], list[str]]:
    """The findings that no record accepts, and the records that do not accept exactly what they say."""
    open_findings = []
    sites = dict.fromkeys(records, 0)
    for finding in sorted(findings):
        record = next((record for record in records if record.covers(finding)), None)
        if record:
            sites[record] += 1
        elif not used_elsewhere(finding):
            open_findings.append(finding)
    faults = []
    for record, found in sites.items():
        if not found or (record.sites is not None and record.sites != found):
            expected = "at least one" if record.sites is None else record.sites
            faults.append(
                f"deviations.toml: {record.kind} {record.rule}: accepts {found} findings, expected {expected}"
            )
    return open_findings, faults
