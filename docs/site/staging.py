"""Puts the documents of docs/, and what they link to, where the site generator reads them."""

import os
import re
import shutil
from pathlib import Path

LINK = re.compile(r"(?<!!)\[(?P<text>[^\]]*)\]\((?P<target>[^)\s]+)\)")
FENCE = re.compile(r"(^```.*?^```$)", re.MULTILINE | re.DOTALL)


def staged_path(path: Path) -> Path:
    """Where a file of the tree stands on the site: docs/x.md as x.md, anything else below tree/."""
    return path.relative_to("docs") if path.is_relative_to("docs") else Path("tree") / path


class Staging:
    """Copies documents from the tree `root` to `output`, each with all files that it links to."""

    def __init__(self, root: Path, output: Path) -> None:
        self.root = root
        self.output = output
        self.done: set[Path] = set()

    def add(self, path: Path) -> None:
        """Copies one file, by its path in the tree, and what it links to. A file is copied once."""
        if path in self.done:
            return
        self.done.add(path)
        target = self.output / staged_path(path)
        target.parent.mkdir(parents=True, exist_ok=True)
        if path.suffix != ".md":
            shutil.copyfile(self.root / path, target)
            return
        parts = FENCE.split((self.root / path).read_text("utf-8"))
        # Every second part is a block of code, whose brackets are no links.
        told = [part if number % 2 else self.relinked(path, part) for number, part in enumerate(parts)]
        target.write_text("".join(told), "utf-8")

    def relinked(self, path: Path, text: str) -> str:
        """The text with every link to the tree leading to the copy; a folder is named and not linked."""

        def relink(match: re.Match[str]) -> str:
            name, _, place = match["target"].partition("#")
            if not name or re.match(r"[a-z]+:", name):
                return match[0]
            linked = Path(os.path.normpath(path.parent / name))
            if (self.root / linked).is_dir():
                return f"{match['text']} (`{linked}`)"
            self.add(linked)
            there = os.path.relpath(staged_path(linked), staged_path(path).parent)
            return f"[{match['text']}]({there}{'#' if place else ''}{place})"

        return LINK.sub(relink, text)
