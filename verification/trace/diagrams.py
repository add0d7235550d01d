"""Diagrams of the architecture, drawn by Graphviz."""

import re
import subprocess
from pathlib import Path

INCLUDE = re.compile(r'^#include "(\w+)/', re.MULTILINE)

LOOKS = """\
  node [shape=box, style="rounded,filled", fillcolor="#f2f4f7", color="#5b6470"]
  node [fontname="Inter", fontsize=11]
  edge [fontname="Inter", fontsize=9, color="#5b6470"]
"""
PROCESSES = f"""\
digraph {{
  graph [nodesep=0.5, ranksep=0.7]
{LOOKS}  browser [label="Console\\nin the browser"]
  slicer [label="Navigation\\nsoftware"]
  app [label="interlock-app (C++)\\nproposes"]
  kernel [label="interlock-kernel (C)\\ndecides, every tick", fillcolor="#dcefe3"]
  recorder [label="interlock-recorder\\nkeeps what happened"]
  cards [label="motor cards,\\nor interlock-sim"]
  inputs [label="pedal, E-stop, lamps"]
  browser -> app [label="HTTP, WebSocket", dir=both]
  slicer -> app [label="OpenIGTLink", dir=both]
  kernel -> app [label="link: snapshots, events\\n(the app cannot write)"]
  app -> kernel [label="link: requests\\n(the kernel trusts no byte)"]
  kernel -> cards [label="frames", dir=both]
  kernel -> inputs [label="contacts, outputs", dir=both]
  kernel -> recorder [label="ring in shared memory"]
}}
"""


def drawn(graph: str) -> str:
    """A graph as SVG that stands within a page."""
    done = subprocess.run(["dot", "-Tsvg"], input=graph, capture_output=True, text=True, check=True)
    return done.stdout[done.stdout.index("<svg") :]


def figure(graph: str, caption: str) -> str:
    return f"<figure>{drawn(graph)}<figcaption>{caption}</figcaption></figure>"


def processes() -> str:
    """The processes and what goes between them."""
    caption = "Processes, and what goes between them. The kernel runs, and stays safe, with no app."
    return figure(PROCESSES, caption)


def included(root: Path) -> dict[str, set[str]]:
    """For each folder of the app, the other folders whose headers it includes."""
    folders = sorted(path.name for path in (root / "app").iterdir() if path.is_dir())
    found = {}
    for folder in folders:
        files = [*(root / "app" / folder).rglob("*.hpp"), *(root / "app" / folder).rglob("*.cpp")]
        named = {name for path in files for name in INCLUDE.findall(path.read_text("utf-8"))}
        found[folder] = (named & set(folders)) - {folder}
    return found


def reduced(edges: dict[str, set[str]]) -> dict[str, set[str]]:
    """The same order without the edges that follow from others."""

    def reach(folder: str, passed: frozenset[str]) -> set[str]:
        found: set[str] = set()
        for other in edges[folder] - passed:
            found |= {other} | reach(other, passed | {folder, other})
        return found

    def follows(folder: str, other: str) -> bool:
        return any(other in reach(between, frozenset({folder})) for between in edges[folder] - {other})

    return {folder: {one for one in others if not follows(folder, one)} for folder, others in edges.items()}


def modules(root: Path) -> str:
    """What includes what in the app, from its sources."""
    lines = [
        f"  {folder} -> {other}"
        for folder, others in reduced(included(root)).items()
        for other in sorted(others)
    ]
    graph = "\n".join(["digraph {", "  graph [ranksep=0.45, nodesep=0.25]", LOOKS, *lines, "}"])
    caption = (
        "Folders of the app by their includes, from the sources; what follows from other arrows is left out."
    )
    return figure(graph, caption)
