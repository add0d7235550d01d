#!/usr/bin/env python3
"""Runs a changed kernel over the rows that the model printed: rows.py TREE [PHASE ...].

Without a phase over those of all. TREE is the changed copy of the project; what is built stays in its
build/rows. The rows are those that verification/conformance/run.py left here; those that are missing are
printed by TLC anew. Prints each phase that differs, as `PHASE: N rows differ, first in COLUMN`.
"""

import hashlib
import re
import subprocess
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "conformance"))

import phases
from phases import print_missing
from table import Phase, load_phase
from tools import HERE, kernel_sources


def phase_named(name: str) -> Phase:
    """The phase of that name in verification/conformance."""
    return load_phase(HERE / "phases" / f"{name}.toml")


def all_phases() -> list[str]:
    """The names of all phases of the tick."""
    return phases.names()


def compile_kernel(kernel: Path, folder: Path) -> list[str]:
    """Compiles what changed of the kernel since the last time in this folder; gives the compiler's flags."""
    folder.mkdir(parents=True, exist_ok=True)
    flags = ["-std=c11", "-O1", "-w", f"-I{kernel}/include", f"-I{kernel}/src", "-DILK_FRAME_WORDS=32"]
    headers = b"".join(path.read_bytes() for path in sorted(kernel.rglob("*.h")))
    changed = []
    for source in sorted((kernel / "src").glob("*.c")):
        key = hashlib.sha256(headers + source.read_bytes()).hexdigest()
        kept = folder / f"{source.stem}.key"
        if not kept.is_file() or kept.read_text("utf-8") != key:
            changed.append((source, kept, key))
    if changed:
        sources = [str(source) for source, _, _ in changed]
        subprocess.run(["gcc", *flags, "-c", *sources], cwd=folder, check=True, capture_output=True)
    for _, kept, key in changed:
        kept.write_text(key, "utf-8")
    return flags


def difference(phase: Phase, kernel: Path, folder: Path, flags: list[str]) -> str:
    """How many rows the changed kernel answers otherwise; empty when none."""
    case, program = phases.OUTPUT / phase.name, folder / phase.name
    objects = [f"{folder}/{Path(source).stem}.o" for source in kernel_sources(kernel, phase.includes)]
    command = ["gcc", *flags, f"-I{case}", str(HERE / "run_rows.c"), *objects, "-o", str(program)]
    subprocess.run(command, check=True, capture_output=True)
    done = subprocess.run([program, case / "rows.bin"], capture_output=True, text=True, errors="replace")
    end = re.search(r"^ROWS \d+ DIFFERENCES (\d+)$", done.stdout, re.MULTILINE)
    if end is None:
        return f"{phase.name}: the run broke off"
    first = re.search(r"^DIFFERS kernel \d+ (.+) -?\d+ -?\d+$", done.stdout, re.MULTILINE)
    return f"{phase.name}: {end[1]} rows differ, first in {first[1] if first else '?'}" if int(end[1]) else ""


def main() -> int:
    """The command line."""
    tree, names = Path(sys.argv[1]).resolve(), sys.argv[2:] or all_phases()
    folder = tree / "build" / "rows"
    print_missing(names)
    flags = compile_kernel(tree / "kernel", folder)
    for name in names:
        found = difference(phase_named(name), tree / "kernel", folder, flags)
        if found:
            print(found, flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
