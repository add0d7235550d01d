"""Puts the pages of the report on the site, with every file of the tree that they lead to."""

import re
import shutil
from html import unescape
from pathlib import Path

LINK = re.compile(r' href="([^"]*)"')
UP = "../../"
"""How a page of build/report leads to the top of the tree."""


def copy_report(root: Path, site: Path) -> None:
    """Copies build/report to site/report. A link to a file of the tree leads to its copy below site/tree; one
    to a folder, or to what is not copied, loses its target.

    StrictDoc's own pages stay where they are: they have scripts of their own, which the app's policy forbids.
    """
    report, target = root / "build/report", site / "report"
    target.mkdir(parents=True)
    for path in sorted(report.iterdir()):
        if path.is_file() and path.suffix != ".html":
            shutil.copyfile(path, target / path.name)
    if (report / "papers").is_dir():
        shutil.copytree(report / "papers", target / "papers")

    def relink(match: re.Match[str]) -> str:
        link = unescape(match[1])
        name = link.partition("#")[0]
        if link.startswith(UP):
            file = Path(name.removeprefix(UP))
            if not (root / file).is_file():
                return ""
            copy = site / "tree" / file
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(root / file, copy)
            return f' href="../tree/{file.as_posix()}"'
        kept = not name or ((report / name).is_file() and not name.startswith("strictdoc/"))
        return match[0] if kept else ""

    for page in sorted(report.glob("*.html")):
        (target / page.name).write_text(LINK.sub(relink, page.read_text("utf-8")), "utf-8")
