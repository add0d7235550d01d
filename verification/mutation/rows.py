#!/usr/bin/env python3
"""Runs a changed kernel over the rows that the model printed for the tree as it is: rows.py KERNEL FOLDER.

KERNEL is the folder `kernel` of the changed tree; FOLDER takes what is built. The rows are those that
verification/conformance/run.py left in build/evidence/conformance. Prints each phase that differs, as
`PHASE: N rows differ`; exits 2 when the rows of a phase are missing.
"""

import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CONFORMANCE = ROOT / "verification" / "conformance"
sys.path.append(str(CONFORMANCE))

from table import load_phase  # noqa: E402
from tools import kernel_sources  # noqa: E402


def compiled(case: Path, kernel: Path, included: list[str]) -> bool:
    """Whether the native run of a phase could be built; without optimisation, as it is run only once."""
    flags = ["-std=c11", "-O1", f"-I{case}", f"-I{kernel}/include", f"-I{kernel}/src", "-DILK_FRAME_WORDS=32"]
    command = ["gcc", *flags, str(CONFORMANCE / "run_rows.c"), *kernel_sources(kernel, included)]
    return subprocess.run([*command, "-o", str(case / "run_rows")], capture_output=True).returncode == 0


def differing(case: Path) -> int:
    """How many rows differ; one when the run broke off."""
    command = [str(case / "run_rows"), str(case / "rows.bin")]
    done = subprocess.run(command, capture_output=True, text=True, errors="replace")
    end = re.search(r"^ROWS \d+ DIFFERENCES (\d+)$", done.stdout, re.MULTILINE)
    return int(end[1]) if end else 1


def main() -> int:
    kernel, folder = (Path(argument).resolve() for argument in sys.argv[1:3])
    for path in sorted((CONFORMANCE / "phases").glob("*.toml")):
        phase, case = load_phase(path), folder / path.stem
        case.mkdir(parents=True, exist_ok=True)
        for name in ("case.h", "rows.bin"):
            source = ROOT / "build/evidence/conformance" / path.stem / name
            if not source.is_file():
                print(
                    f"rows.py: {source} is missing; run verification/conformance/run.py first",
                    file=sys.stderr,
                )
                return 2
            shutil.copyfile(source, case / name)
        if not compiled(case, kernel, phase.includes):
            print(f"{path.stem}: does not compile", file=sys.stderr)
        elif rows := differing(case):
            print(f"{path.stem}: {rows} rows differ", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
