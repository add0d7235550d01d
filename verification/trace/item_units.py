"""The units of architecture items outside of the kernel core, as their headers describe them.

Doxygen reads the headers, as `make docs` does, but writes XML alone, which takes seconds.
"""

import re
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from fnmatch import fnmatchcase
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2] / "docs/site"))

import code_pages
from items import Item, Items

FOLDERS = re.compile(r"\(([^()]+)\)$")
SETTINGS = """INPUT = app kernel/host
FILE_PATTERNS = *.hpp *.h
RECURSIVE = YES
STRIP_FROM_PATH = .
FULL_PATH_NAMES = YES
JAVADOC_AUTOBRIEF = YES
EXTRACT_ALL = YES
EXTRACT_ANON_NSPACES = NO
GENERATE_HTML = NO
GENERATE_LATEX = NO
GENERATE_XML = YES
XML_PROGRAMLISTING = NO
QUIET = YES
WARNINGS = NO
OUTPUT_DIRECTORY = {output}
"""


def folders_of(title: str) -> list[str]:
    """The places that a title names in brackets: `app/motion, control` is app/motion and app/control."""
    named = FOLDERS.search(title)
    places: list[str] = []
    for part in named[1].split(", ") if named else []:
        within = places[0].rpartition("/")[0] if places and "/" not in part else ""
        places.append(f"{within}/{part}" if within else part)
    return places


def item_of(file: str, items: Sequence[Item]) -> Item | None:
    """The item whose places name a file; of several the one that names it most closely."""
    found = [
        (len(place), item)
        for item in items
        for place in folders_of(item.title)
        if file.startswith(f"{place}/") or fnmatchcase(file, f"{place}*")
    ]
    return max(found, key=lambda one: one[0])[1] if found else None


def units_by_item(root: Path, items: Items) -> Mapping[str, Sequence[code_pages.Entry]]:
    """What the headers of each item of class C declare, by the item's UID.

    Raises OSError when Doxygen is missing or ends with an error.
    """
    with tempfile.TemporaryDirectory(prefix="interlock-units-") as output:
        done = subprocess.run(
            ["doxygen", "-"],
            input=SETTINGS.format(output=output),
            cwd=root,
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode != 0:
            raise OSError(f"doxygen: {(done.stdout + done.stderr).strip()}")
        entries = code_pages.entries(Path(output) / "xml")
    architecture = items.of("ITEM")
    found: dict[str, list[code_pages.Entry]] = {
        item.uid: [] for item in architecture if item.fields["SAFETY_CLASS"] == "C"
    }
    for entry in entries:
        item = item_of(entry.file, architecture)
        if item and item.uid in found:
            found[item.uid].append(entry)
    return {uid: declared for uid, declared in found.items() if declared}
