#!/usr/bin/env python3
"""Keeps the evidence of the long measurements with the sources. Usage: archive.py keep|restore

`keep` takes what a release demands from build/evidence to verification/measurements/kept, when it is sound,
holds for the inputs that stand here and was made of a commit without changes: NAME.json, in which paths
become relative to the tree that it was made in, its key as it is, and the raw logs as NAME.zip. `restore`
puts back what was kept of these inputs, unless build/evidence has some of its own. Both say what they did
with which measurement, and exit 2 when something cannot be read.
"""

import json
import sys
import zipfile
from collections.abc import Sequence
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "evidence"))

from evidence import EVIDENCE, ROOT, SOUND
from measurements import Measurement, UnusableError, read_measurements

KEPT = Path(__file__).with_name("kept")


def holds(folder: Path, one: Measurement) -> bool:
    """Whether the evidence in a folder was made from the inputs that stand here now."""
    key = folder / f"{one.name}.key"
    return key.is_file() and (folder / f"{one.name}.json").is_file() and key.read_text("utf-8") == one.key()


def why_not(one: Measurement) -> str:
    """What speaks against keeping the evidence in build/evidence, in words; empty when nothing does."""
    if not holds(EVIDENCE, one):
        return f"no evidence of these inputs; {one.target} makes it"
    document = json.loads((EVIDENCE / f"{one.name}.json").read_text("utf-8"))
    if document["status"] not in SOUND:
        return f"its status is {document['status']}"
    if document["commit"].endswith("+changes"):
        return "it was made with changes beside its commit, so nobody could make it again"
    if not logs(document):
        return f"its log, build/evidence/{document['log']}, holds nothing"
    return one.too_short(document["figures"])


def logs(document: dict) -> list[Path]:
    """The raw logs of a measurement: the file or folder that its evidence names, with all in it."""
    named = document["log"].removeprefix("build/evidence/")
    return sorted(path for path in (EVIDENCE / named, *(EVIDENCE / named).rglob("*")) if path.is_file())


def pack(files: Sequence[Path], packed: Path) -> None:
    """Packs the files under their names in build/evidence. Same files, same bytes."""
    with zipfile.ZipFile(packed, "w") as archive:
        for file in files:
            undated = zipfile.ZipInfo(file.relative_to(EVIDENCE).as_posix())
            archive.writestr(undated, file.read_bytes(), zipfile.ZIP_LZMA)


def keep(one: Measurement) -> str:
    if why := why_not(one):
        return f"not kept: {why}"
    if holds(KEPT, one):
        return "kept already"
    KEPT.mkdir(exist_ok=True)
    # Without a key before, and with it at the end: what is broken off on the way holds for nothing.
    key = KEPT / f"{one.name}.key"
    key.unlink(missing_ok=True)
    text = (EVIDENCE / f"{one.name}.json").read_text("utf-8").replace(f"{ROOT}/", "")
    pack(logs(json.loads(text)), KEPT / f"{one.name}.zip")
    (KEPT / f"{one.name}.json").write_text(text, "utf-8")
    key.write_text(one.key(), "utf-8")
    return "kept"


def restore(one: Measurement) -> str:
    if holds(EVIDENCE, one):
        return "made here"
    if not holds(KEPT, one):
        return f"not kept for these inputs; {one.target} makes it"
    with zipfile.ZipFile(KEPT / f"{one.name}.zip") as archive:
        archive.extractall(EVIDENCE)
    for suffix in ("json", "key"):
        (EVIDENCE / f"{one.name}.{suffix}").write_bytes((KEPT / f"{one.name}.{suffix}").read_bytes())
    document = json.loads((KEPT / f"{one.name}.json").read_text("utf-8"))
    return f"as kept with the sources, made of {document['commit'][:12]} on {document['date']}"


def main() -> int:
    actions = {"keep": keep, "restore": restore}
    if len(sys.argv) != 2 or sys.argv[1] not in actions:
        print(f"archive: expected one of {', '.join(actions)}", file=sys.stderr)
        return 2
    EVIDENCE.mkdir(parents=True, exist_ok=True)
    try:
        for one in read_measurements(Path(__file__).with_name("measurements.toml")):
            if one.demanded == "release":
                print(f"evidence of {one.name}: {actions[sys.argv[1]](one)}")
    except (UnusableError, OSError, ValueError, KeyError, zipfile.BadZipFile) as error:
        print(f"archive: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
