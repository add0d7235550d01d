"""The console in pictures as Markdown, from what `make pictures` took of the real console."""

import re
from collections.abc import Sequence

CAPTIONS = {
    "login": "Before anybody logs in: what the robot does, and STOP",
    "robot": "The robot's page while an axis moves; one proposal done, one refused with its reason",
    "robot-help": "Everything unfolded: why an axis does not move, more faults, and the keys",
    "robot-covered": "The app went silent: what it said last is covered after a second",
    "prostate": "The prostate robot",
    "workflow": "From opening a case to closing it, step by step",
    "prostate-workflow": "The same with a biopsy",
    "targeting": "Registration, entry and target, and what they ask of each axis",
    "proposals": "Every proposal, one of them with its checks, its way and what became of it",
    "runs": "Every motion that was carried out, one of them beside another: planned, actual, and in numbers",
    "plots": "Position, error, velocity and drive of an axis over time, and the times of the loop",
    "3d": "The robot in its workspace",
    "codes": "The codes",
    "users": "Users and their roles",
    "audit": "The audit trail",
    "account": "The account",
}
"""What each picture shows, in the order of the page."""
NAME = re.compile(r"(?P<page>.+)-(?P<theme>light|dark)-(?P<width>\d+)x(?P<height>\d+)\.png")
SHOWN = ("light-1280x800", "dark-1280x800")
"""What stands on the page; other sizes are linked."""


class PictureError(Exception):
    """A picture without a caption, or a caption without its pictures; the text names it."""


def section(page: str, kinds: Sequence[str]) -> str:
    """One page of the console; `kinds` are the themes and sizes that it was taken in."""
    if missing := [kind for kind in SHOWN if kind not in kinds]:
        raise PictureError(f"{page}: no picture {', '.join(missing)}; run make pictures")
    shown = [f"![{CAPTIONS[page]}, {kind}](pictures/{page}-{kind}.png)" for kind in SHOWN]
    links = [f"[{kind}](pictures/{page}-{kind}.png)" for kind in sorted(kinds) if kind not in SHOWN]
    return "\n\n".join([f"## {CAPTIONS[page]}", *shown, "In full: " + ", ".join(links) if links else ""])


def pictures_page(files: Sequence[str]) -> str:
    """The page of the files with these names.

    Raises PictureError when a picture has no caption, or a caption no pictures; without any file the
    page says so.
    """
    kinds: dict[str, list[str]] = {page: [] for page in CAPTIONS}
    for file in files:
        found = NAME.fullmatch(file)
        if found is None or found["page"] not in CAPTIONS:
            raise PictureError(f"{file}: it has no caption in docs/site/pictures_page.py")
        kinds[found["page"]].append(f"{found['theme']}-{found['width']}x{found['height']}")
    about = "Taken by a browser of the real console on simulated hardware, in both themes: `make pictures`."
    if not files:
        return f"# The console in pictures\n\n{about} This copy of the site was made without them.\n"
    sections = [section(page, taken) for page, taken in kinds.items()]
    return "\n\n".join(["# The console in pictures", about, *sections]) + "\n"
