#!/usr/bin/env python3
"""Keeps evidence with the sources. Usage: keep.py keep|restore

`keep` takes from build/evidence to verification/evidence/kept what is as expected, holds for the inputs that
stand here and was made of a commit without changes: NAME.json, which has its key, and the logs as NAME.zip.
`restore` puts back what was kept of these inputs, unless build/evidence has some of its own. Both say what
they did with which check, and exit 2 when something cannot be read.
"""

import sys
import zipfile
from collections.abc import Sequence
from pathlib import Path

from evidence import EVIDENCE
from expected import KEPT, Check, UnusableError, read_checks

MOST_BYTES = 2**20
"""So much the packed logs of a check may have: the history of the sources has every version of them."""
TEXTS = (".log", ".json", ".txt", ".csv")


def logs(document: dict) -> list[Path]:
    """The logs of a check: the file or folder that its evidence names, with the texts in it."""
    named = EVIDENCE / document["log"].removeprefix("build/evidence/")
    return sorted(path for path in (named, *named.rglob("*")) if path.is_file() and path.suffix in TEXTS)


def pack(files: Sequence[Path], packed: Path) -> None:
    """Packs the files under their names in build/evidence. Same files, same bytes."""
    with zipfile.ZipFile(packed, "w") as archive:
        for file in files:
            undated = zipfile.ZipInfo(file.relative_to(EVIDENCE).as_posix())
            archive.writestr(undated, file.read_bytes(), zipfile.ZIP_LZMA)


def keep(check: Check) -> str:
    if why := check.why_not_kept():
        return f"not kept: {why}"
    if check.holds(KEPT):
        return "kept already"
    document = check.evidence()
    if not (files := logs(document)):
        return f"not kept: its log, {document['log']}, has no text"
    KEPT.mkdir(exist_ok=True)
    # The old document goes first and the new one comes last: what breaks off on the way holds for nothing.
    kept, packed = KEPT / f"{check.name}.json", KEPT / f"{check.name}.zip"
    kept.unlink(missing_ok=True)
    pack(files, packed)
    if packed.stat().st_size > MOST_BYTES:
        size = packed.stat().st_size // 1024
        packed.unlink()
        return f"not kept: its logs pack to {size} KiB, at most {MOST_BYTES // 1024} KiB"
    kept.write_bytes((EVIDENCE / kept.name).read_bytes())
    return "kept"


def restore(check: Check) -> str:
    if check.holds():
        return "made here"
    if not check.holds(KEPT):
        return f"not kept for these inputs; {check.target} makes it"
    EVIDENCE.mkdir(parents=True, exist_ok=True)
    try:
        with zipfile.ZipFile(KEPT / f"{check.name}.zip") as archive:
            archive.extractall(EVIDENCE)
    except (OSError, zipfile.BadZipFile) as error:
        raise UnusableError(f"kept logs of {check.name}: {error}") from error
    name = f"{check.name}.json"
    (EVIDENCE / name).write_bytes((KEPT / name).read_bytes())
    document = check.evidence()
    return f"as kept with the sources, made of {document['commit'][:12]} on {document['date']}"


def main() -> int:
    actions = {"keep": keep, "restore": restore}
    if len(sys.argv) != 2 or sys.argv[1] not in actions:
        print(f"keep: expected one of {', '.join(actions)}", file=sys.stderr)
        return 2
    try:
        for check in read_checks():
            print(f"evidence of {check.name}: {actions[sys.argv[1]](check)}")
    except (UnusableError, OSError, ValueError, KeyError) as error:
        print(f"keep: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
