#!/usr/bin/env python3
"""Notes that items were reviewed as they stand now. Usage: review.py UID... | --all

Writes the fingerprint of each item, over its text and that of its parents, into
spec/requirements/reviewed.toml; the gate calls an item suspect once its fingerprint is another one. The UID
of a document stands for its prose, which is in no item. Run it after reading the item, its parents and its
links, and commit what it writes under the reviewer's name.
"""

import argparse
import sys
import tomllib
from pathlib import Path

from exporter import RefusedError, export, stage
from items import Items, fingerprint, read_items

ROOT = Path(__file__).resolve().parents[2]
HEAD = "# The fingerprint of each item at its last review. Written by verification/trace/review.py.\n\n"


def write_reviewed(items: Items, path: Path, chosen: set[str]) -> None:
    """Notes the chosen items; items that are no more are dropped."""
    before = tomllib.loads(path.read_text("utf-8")) if path.exists() else {}
    after = {
        uid: fingerprint(items, item) if uid in chosen else before.get(uid)
        for uid, item in items.to_review().items()
    }
    lines = "".join(f'"{uid}" = "{after[uid]}"\n' for uid in sorted(after) if after[uid])
    path.write_text(HEAD + lines, "utf-8")


def main() -> int:
    parser = argparse.ArgumentParser(description="Note that items were reviewed.")
    parser.add_argument("uids", nargs="*", metavar="UID")
    parser.add_argument("--all", action="store_true")
    arguments = parser.parse_args()
    requirements = ROOT / "spec/requirements"
    output = ROOT / "build/report"
    try:
        stage(requirements, output / "source")
        export(output / "source", requirements / "strictdoc_config.py", output / "stated", "json")
    except RefusedError as error:
        print(f"review: {error}", file=sys.stderr)
        return 2
    items = read_items(output / "stated/json/index.json")
    known = set(items.to_review())
    unknown = sorted(set(arguments.uids) - known)
    if unknown:
        parser.error(f"no item {unknown[0]}")
    chosen = known if arguments.all else set(arguments.uids)
    write_reviewed(items, requirements / "reviewed.toml", chosen)
    print(f"{len(chosen)} items reviewed")
    return 0


if __name__ == "__main__":
    sys.exit(main())
