#!/usr/bin/env python3
"""Writes the documentation site of this tree to build/docs/site. Usage: build.py

Doxygen reads kernel and app; Sphinx makes one site with search from docs/, the HTTP reference of
spec/openapi.yaml, the record of MISRA deviations and the items that Doxygen found. The pictures of
`make pictures` and the report of `make report` are put beside them where they were made. Exits 1, and
says why, for a public item without a word, a link that leads nowhere, a picture without a caption, or
anything that either program warns of; 2 when it cannot run.
"""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import yaml

sys.path.append(str(Path(__file__).resolve().parents[2] / "verification/evidence"))

import code_pages
import deviations_page
import documented
import evidence
import http_page
import pictures_page
from report_copy import copy_report
from staging import Staging

HERE = Path(__file__).resolve().parent
INLINE = re.compile(r"<script>.*?</script>|\s(?:style|on[a-z]+)=(?:\"[^\"]*\"|'[^']*')", re.DOTALL)
"""What a page may not have under the app's policy, and what no page needs to be read."""


class FailedError(Exception):
    """What is wrong with the documents, line by line."""


def run(command: list[str], root: Path) -> str:
    """Runs a program. Raises FailedError with what it printed when it ends with an error."""
    done = subprocess.run(command, cwd=root, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise FailedError(f"{Path(command[0]).name}: {(done.stdout + done.stderr).strip()}")
    return done.stdout


def doxygen(root: Path, output: Path) -> list[code_pages.Entry]:
    """Runs Doxygen and returns what it found. Raises FailedError for a warning, or an item without a word."""
    shutil.rmtree(output / "doxygen", ignore_errors=True)
    (output / "doxygen").mkdir(parents=True)
    run(["doxygen", "docs/site/Doxyfile"], root)
    warnings = (output / "doxygen/warnings.log").read_text("utf-8").strip()
    if warnings:
        raise FailedError(warnings)
    found = code_pages.entries(output / "doxygen/xml")
    if missing := documented.undocumented(found):
        raise FailedError("\n".join(missing))
    return found


def stage(root: Path, source: Path, found: list[code_pages.Entry]) -> None:
    """Puts all documents, written and generated, into an empty folder `source`."""
    shutil.rmtree(source, ignore_errors=True)
    (source / "code").mkdir(parents=True)
    staging = Staging(root, source)
    for path in sorted((root / "docs").glob("*.md")):
        staging.add(path.relative_to(root))
    decisions = sorted((root / "docs/decisions").glob("*.md"))
    for path in decisions:
        staging.add(path.relative_to(root))
    listed = "\n".join(path.stem for path in decisions)
    (source / "decisions/index.md").write_text(
        f"# Decisions\n\n```{{toctree}}\n:maxdepth: 1\n\n{listed}\n```\n", "utf-8"
    )
    staging.add(Path("verification/misra/enforcement.md"))
    for picture in sorted((root / "docs/images").iterdir()):
        staging.add(picture.relative_to(root))
    others = sorted(path.relative_to(source).with_suffix("") for path in source.glob("tree/**/*.md"))
    index = (HERE / "index.md").read_text("utf-8").replace("OTHERS", "\n".join(map(str, others)))
    (source / "index.md").write_text(index, "utf-8")
    document = yaml.safe_load((root / "spec/openapi.yaml").read_text("utf-8"))
    (source / "http.md").write_text(http_page.http_page(document), "utf-8")
    stage_pictures(root / "build/pictures", source)
    records = (root / "verification/misra/deviations.toml").read_text("utf-8")
    (source / "deviations.md").write_text(deviations_page.deviations_page(records), "utf-8")
    for name, text in code_pages.pages(found).items():
        (source / "code" / name).write_text(text, "utf-8")


def stage_pictures(taken: Path, source: Path) -> None:
    """Puts the pictures of the console beside their page. Raises FailedError for one without a caption."""
    files = sorted(taken.glob("*.png"))
    (source / "pictures").mkdir()
    for file in files:
        shutil.copyfile(file, source / "pictures" / file.name)
    try:
        page = pictures_page.pictures_page([file.name for file in files])
    except pictures_page.PictureError as error:
        raise FailedError(str(error)) from error
    (source / "pictures.md").write_text(page, "utf-8")


def without_inline(text: str) -> str:
    """A page without scripts and styles of its own."""
    return INLINE.sub("", text)


def main() -> int:
    root = evidence.ROOT
    output = root / "build/docs"
    site = output / "site"
    try:
        found = doxygen(root, output)
        stage(root, output / "source", found)
        shutil.rmtree(site, ignore_errors=True)
        sphinx = [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-E", "-b", "html"]
        run([*sphinx, "-c", str(HERE), "-d", str(output / "cache"), str(output / "source"), str(site)], root)
        shutil.copytree(output / "doxygen/html", site / "doxygen")
        if (root / "build/report/index.html").is_file():
            copy_report(root, site)
        for page in site.rglob("*.html"):
            page.write_text(without_inline(page.read_text("utf-8")), "utf-8")
    except FailedError as error:
        print(error, file=sys.stderr)
        return 1
    except OSError as error:
        print(f"docs: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
