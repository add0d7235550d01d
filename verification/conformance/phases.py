"""Looks at one phase of the tick: rows from the model, the compiled kernel on all of them, the proof."""

import hashlib
import re
import time
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

import page
from emit import case_header
from table import Phase, Table, TableError, load_phase, read_rows
from tools import HERE, ROOT, TLA, ToolError, cbmc, compile_rows, run, tlc

MANIFEST = HERE / "manifest.toml"
OUTPUT = ROOT / "build" / "evidence" / "conformance"
KERNEL = ROOT / "kernel"
SHOWN = 5


@dataclass
class Report:
    """What came of a phase."""

    name: str
    model: str = ""
    table: str = ""
    rows: int = 0
    states: int = 0
    proved: int = 0
    proved_rows: int = 0
    reached: int = 0
    page_rows: int = 0
    seconds: float = 0.0
    faults: list[str] = field(default_factory=list)

    def line(self) -> str:
        """One line for people."""
        verdict = "FAILED" if self.faults else "agrees"
        return (
            f"{self.name}: {verdict}, {self.rows} rows, {self.states} states; proved: "
            f"{self.proved_rows} rows by {self.proved} assertions, {self.reached} answers reached; "
            f"{self.seconds:.0f} s"
        )


def names() -> list[str]:
    """All phases, the longest first."""
    return sorted(
        (path.stem for path in (HERE / "phases").glob("*.toml")),
        key=lambda name: name not in ("change_mode", "follow"),
    )


def extended(module: Path) -> list[str]:
    """The modules of the model that a module names as those it extends."""
    named = re.search(r"^EXTENDS (.*)$", module.read_text("utf-8"), re.MULTILINE)
    return [name for name in named[1].split(", ") if (TLA / f"{name}.tla").is_file()] if named else []


def model_hash(phase: Phase, model: Path = TLA) -> str:
    """SHA-256 over the model's operators, the module that prints the rows, and the phase file."""
    digest = hashlib.sha256()
    modules = ["Types", "System", "Axis", *extended(HERE / "rows" / f"{phase.rows}.tla")]
    files = [model / f"{module}.tla" for module in dict.fromkeys(modules)]
    for path in [*files, HERE / "rows" / f"{phase.rows}.tla", HERE / "phases" / f"{phase.name}.toml"]:
        digest.update(path.read_bytes())
    return digest.hexdigest()


def table_of(phase: Phase, folder: Path, model: Path = TLA) -> Table:
    """Lets TLC print the phase's rows. Raises ToolError when it does not finish them."""
    status, text = tlc(HERE / "rows" / f"{phase.rows}.tla", folder, phase.model_constants(), model)
    if status != 0:
        raise ToolError(
            f"TLC did not finish the rows of {phase.name} (status {status}); log {folder / 'tlc.log'}"
        )
    return read_rows(phase, text)


def write_case(phase: Phase, table: Table, folder: Path, model: Path = TLA) -> None:
    """Writes the phase's table as case.h, for the proof, and its rows, for the compiled kernel."""
    (folder / "case.h").write_text(case_header(table, model_hash(phase, model)), "utf-8")
    (folder / "rows.bin").write_bytes(table.packed())


def build(phase: Phase, table: Table, folder: Path, kernel: Path, model: Path = TLA) -> None:
    """Writes case.h and the rows, and compiles the native run."""
    write_case(phase, table, folder, model)
    compile_rows(folder, kernel, phase.includes)


def are_current(phase: Phase, folder: Path) -> bool:
    """Whether the rows in this folder are those of the model as it is, and the table's own."""
    header, rows = folder / "case.h", folder / "rows.bin"
    if not header.is_file() or not rows.is_file():
        return False
    text = header.read_text("utf-8")
    return model_hash(phase) in text and hashlib.sha256(rows.read_bytes()).hexdigest() in text


def print_missing(phase_names: Iterable[str]) -> None:
    """Lets TLC print the rows of these phases where they are missing or older than the model."""
    for name in phase_names:
        phase, folder = load_phase(HERE / "phases" / f"{name}.toml"), OUTPUT / name
        if not are_current(phase, folder):
            write_case(phase, table_of(phase, folder), folder)


def explain(table: Table, line: str) -> str:
    """A difference in the project's terms: the case, the model's answer and the kernel's."""
    found = re.match(r"DIFFERS (kernel|table|input) (\d+) (.+) (-?\d+) (-?\d+)$", line)
    if found is None:
        return f"{table.phase.name}: {line}"
    phase, (inputs, _) = table.phase, table.rows[int(found[2])]
    case = ", ".join(f"{c.name}={c.kind.text(v)}" for c, v in zip(phase.inputs, inputs, strict=True))
    column = next(c for c in [*phase.outputs, *phase.inputs] if c.name == found[3])
    expected, got = column.kind.text(int(found[4])), column.kind.text(int(found[5]))
    answers = f"{column.name} is {expected} in the model, {got} in the {found[1]}"
    return f"{phase.name}, {phase.title}: with {case}: {answers}"


def run_rows(table: Table, folder: Path) -> list[str]:
    """The compiled kernel on all rows; what differs."""
    _, text = run([str(folder / "run_rows"), str(folder / "rows.bin")], folder / "rows.log")
    return differences(table, text, folder)


def differences(table: Table, text: str, folder: Path) -> list[str]:
    """What the run of all rows found. Raises ToolError when it did not come to their end."""
    end = re.search(r"^ROWS (\d+) DIFFERENCES (\d+)$", text, re.MULTILINE)
    if end is None or int(end[1]) != len(table.rows):
        raise ToolError(
            f"the compiled kernel did not finish the rows of {table.phase.name}; log {folder / 'rows.log'}"
        )
    return [explain(table, line) for line in text.splitlines() if line.startswith("DIFFERS")][:SHOWN]


def prove(phase: Phase, folder: Path, kernel: Path, report: Report) -> None:
    """The proof; what failed, with the case in which it did."""
    proof = cbmc(folder, kernel, [*phase.includes, *phase.stands_in], phase.solver)
    report.proved, report.reached = len(proof.proved), proof.reached
    report.proved_rows = 0 if proof.failed else report.rows
    case = ", ".join(
        f"{column.name}={column.kind.text(code)}"
        for column, code in zip(phase.inputs, proof.case, strict=False)
    )
    report.faults += [f"{phase.name}: not proved: {text}; for example with {case}" for text in proof.failed]
    report.faults += [f"{phase.name}: vacuous: {text} never happens" for text in proof.unreached]


def check(name: str) -> Report:
    """Looks at a phase from rows to proof."""
    started = time.monotonic()
    phase = load_phase(HERE / "phases" / f"{name}.toml")
    folder = OUTPUT / name
    report = Report(name, model=model_hash(phase))
    try:
        table = table_of(phase, folder)
        build(phase, table, folder, KERNEL)
        report.table, report.rows, report.states = table.digest(), len(table.rows), table.states()
        report.faults += run_rows(table, folder)
        if page.is_asked(phase):
            text = page.run_rows(phase, table, folder / "rows.bin", report.model)
            report.faults += [f"in the page: {fault}" for fault in differences(table, text, folder / "page")]
            report.page_rows = report.rows
        prove(phase, folder, KERNEL, report)
    except (TableError, ToolError) as error:
        report.faults.append(str(error))
    report.seconds = time.monotonic() - started
    return report


def write_manifest(reports: list[Report]) -> None:
    """Writes what the tables are, to be committed with the model. Other phases stay as they are."""
    told = tomllib.loads(MANIFEST.read_text("utf-8"))
    told |= {
        report.name: {"model": report.model, "rows": report.rows, "table": report.table} for report in reports
    }
    lines = ["# What the model says of each phase: written by run.py --update, compared on every run."]
    for name in sorted(told.keys() & set(names())):
        entry = told[name]
        lines += [
            "",
            f"[{name}]",
            f'model = "{entry["model"]}"',
            f"rows = {entry['rows']}",
            f'table = "{entry["table"]}"',
        ]
    MANIFEST.write_text("\n".join(lines) + "\n", "utf-8")


def against_manifest(reports: list[Report], only: str = "") -> list[str]:
    """What the committed manifest says otherwise, of all phases or of `only` one."""
    committed = tomllib.loads(MANIFEST.read_text("utf-8"))
    if only:
        committed = {only: committed.get(only)}
    found = {r.name: {"model": r.model, "rows": r.rows, "table": r.table} for r in reports}
    different = sorted(
        name for name in committed.keys() | found.keys() if committed.get(name) != found.get(name)
    )
    return [
        f"manifest.toml is stale or edited by hand at {name}; run.py --update writes it anew"
        for name in different
    ]
