"""Plants one-line differences in the kernel and in the model, each of which the comparison must find."""

import shutil
import tomllib
from pathlib import Path

import phases
from table import TableError, load_phase
from tools import HERE, ROOT, TLA


def planted_copy(source: Path, target: Path, edit: dict[str, str]) -> Path:
    """A copy of a folder with the difference in it. Raises TableError when its place is not there once."""
    shutil.rmtree(target, ignore_errors=True)
    shutil.copytree(source, target)
    path = target / edit["file"]
    text = path.read_text("utf-8")
    if text.count(edit["old"]) != 1:
        raise TableError(f"planted difference: {edit['file']} does not hold once: {edit['old'].strip()}")
    path.write_text(text.replace(edit["old"], edit["new"]), "utf-8")
    return target


def findings(path: Path) -> dict[str, bool]:
    """Which parts of the rung found a planted difference."""
    edit = tomllib.loads(path.read_text("utf-8"))
    folder = phases.OUTPUT / "planted" / path.stem
    copy = planted_copy(ROOT / "kernel" if edit["where"] == "kernel" else TLA, folder / edit["where"], edit)
    kernel, model = (copy, TLA) if edit["where"] == "kernel" else (phases.KERNEL, copy)
    phase = load_phase(HERE / "phases" / f"{edit['phase']}.toml")
    table = phases.table_of(phase, folder, model)
    phases.build(phase, table, folder, kernel, model)
    report = phases.Report(
        phase.name, model=phases.model_hash(phase, model), table=table.digest(), rows=len(table.rows)
    )
    found = {"the compiled kernel on all rows": bool(phases.run_rows(table, folder))}
    phases.prove(phase, folder, kernel, report)
    found["the proof"] = any("not proved" in fault for fault in report.faults)
    if edit["where"] == "model":
        found["the manifest"] = bool(phases.against_manifest([report], only=phase.name))
    return found


def check_all() -> tuple[int, list[str]]:
    """How many planted differences were found by all that must find them, and what was missed."""
    count, missed = 0, []
    for path in sorted((HERE / "planted").glob("*.toml")):
        found = findings(path)
        blind = [
            f"planted difference {path.stem}: {part} did not find it"
            for part, saw in found.items()
            if not saw
        ]
        missed += blind
        count += not blind
        print(f"planted {path.stem}: {'missed' if blind else 'found by ' + ', '.join(found)}", flush=True)
    return count, missed
