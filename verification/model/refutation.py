"""A refutation of TLC as a person reads it: what changed from one tick to the next."""

import re
from collections.abc import Iterator

STATE = re.compile(r"^State (\d+): <?(\w+)")
TOKEN = re.compile(r'"[^"]*"|\|->|:>|@@|<<|>>|-?\w+|[][{}(),]')
REPEATS = ("before", "after", "system", "axis", "axes", "observed", "witness")
"""Parts of `io` that repeat what the records of the kernel say; they are left out."""
MOST_LINES = 300

OPENING = {"[": "]", "{": "}", "<<": ">>", "(": ")"}


def leaves(tokens: list[str], path: str) -> Iterator[tuple[str, str]]:
    """Each scalar of a printed value with its path. Takes the value's tokens from the front of `tokens`."""
    first = tokens.pop(0)
    if first not in OPENING:
        yield path, first.strip('"')
        return
    place = 0
    while tokens[0] != OPENING[first]:
        if tokens[0] in (",", "@@"):
            tokens.pop(0)
            continue
        place += 1
        name = str(place)
        if tokens[1] in ("|->", ":>"):
            name = tokens.pop(0)
            tokens.pop(0)
        yield from leaves(tokens, f"{path}.{name}")
    tokens.pop(0)


def variables_of(lines: list[str]) -> dict[str, str]:
    """Every scalar of one state by its path, such as `axis.position_counts`."""
    scalars: dict[str, str] = {}
    for conjunct in re.split(r"^/\\ ", "\n".join(lines), flags=re.MULTILINE)[1:]:
        name, _, value = conjunct.partition(" = ")
        for path, scalar in leaves(TOKEN.findall(value), name.strip()):
            if not (path.startswith("io.") and any(part in REPEATS for part in path.split(".")[1:])):
                scalars[path] = scalar
    return scalars


def changes(before: dict[str, str], after: dict[str, str]) -> list[str]:
    """What is not as it was, `path: old -> new`."""
    paths = [*after, *(path for path in before if path not in after)]
    return [
        f"{path}: {before.get(path, '-')} -> {after.get(path, '-')}"
        for path in paths
        if before.get(path) != after.get(path)
    ]


def readable(text: str) -> str:
    """The trace in a log of TLC, tick by tick; the errors alone when there is no trace."""
    told = [line for line in text.splitlines() if line.startswith("Error:") and line != "Error: "]
    before: dict[str, str] = {}
    pending: list[str] = []
    heading = ""
    for line in [*text.splitlines(), "State 0: <end"]:
        state = STATE.match(line)
        if state:
            if heading:
                after = variables_of(pending)
                told += [heading, *(f"    {change}" for change in changes(before, after))]
                before = after
            heading, pending = f"  tick {int(state.group(1)) - 1}: {state.group(2)}", []
        elif not line:
            continue
        elif heading and (line.startswith("/\\") or line.startswith(" ")):
            pending.append(line)
    return "\n".join(told[:MOST_LINES])
