"""A copy of what the rungs read, in which one fault at a time is seeded into the kernel."""

import os
import shutil
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from queue import SimpleQueue
from typing import TypeVar

ROOT = Path(__file__).resolve().parents[2]
COPIED = ("kernel", "verification")
Item = TypeVar("Item")
Outcome = TypeVar("Outcome")


class UnusableFaultError(Exception):
    """The fault cannot be seeded; the text says what to correct."""


def make_tree(tree: Path) -> Path:
    """Makes `tree` a fresh copy that shares only the provers with the project."""
    shutil.rmtree(tree, ignore_errors=True)
    for folder in COPIED:
        shutil.copytree(ROOT / folder, tree / folder, ignore=shutil.ignore_patterns("__pycache__"))
    (tree / "build").mkdir()
    (tree / "build/provers").symlink_to(ROOT / "build/provers")
    return tree


def on_trees(stem: str, items: Sequence[Item], judge: Callable[[Path, Item], Outcome]) -> list[Outcome]:
    """What `judge` says of each item, each time in a tree of its own, on as many as JOBS says."""
    jobs = int(os.environ.get("JOBS", os.cpu_count() or 1))
    trees: SimpleQueue[Path] = SimpleQueue()
    for number in range(jobs):
        trees.put(make_tree(ROOT / f"build/mutation/{stem}-{number}"))

    def one(item: Item) -> Outcome:
        tree = trees.get()
        try:
            return judge(tree, item)
        finally:
            trees.put(tree)

    with ThreadPoolExecutor(jobs) as pool:
        return list(pool.map(one, items))


@contextmanager
def seeded(tree: Path, file: str, line: int, before: str, after: str) -> Iterator[None]:
    """The tree with line `line` (from 1) of `file` changed from `before` to `after` inside the block."""
    path = tree / file
    original = path.read_text("utf-8")
    lines = original.splitlines(keepends=True)
    lines[line - 1] = lines[line - 1].replace(before, after)
    path.write_text("".join(lines), "utf-8")
    try:
        yield
    finally:
        path.write_text(original, "utf-8")


def line_of(text: str, wanted: str, where: str) -> int:
    """The number of the one line that is `wanted`, blanks at both ends aside. Raises UnusableFaultError."""
    found = [number for number, line in enumerate(text.splitlines(), 1) if line.strip() == wanted]
    if len(found) != 1:
        raise UnusableFaultError(f"{where} has the line {wanted!r} {len(found)} times; expected once")
    return found[0]
