"""Which public items must have a word said about them, and which of them have none."""

from collections.abc import Sequence

from code_pages import COMPOUNDS, Entry

INTERFACE = "kernel/include/"
"""What the world sees of the kernel: here every field, value and macro needs a word, too."""
OURS = ("kernel/include/", "kernel/host/", "kernel/recording/include/", "app/")
TYPES = ("class", "struct", "union", "enum", "typedef")


def is_special(entry: Entry) -> bool:
    """Whether its name says it: constructor, destructor, operator, or what returns one thing in one line."""
    scope, _, name = entry.name.rpartition("::")
    own = scope.rpartition("::")[2].partition("<")[0].strip()
    fixed = entry.arguments.endswith(("=default", "=delete", "= default", "= delete"))
    reads = entry.is_one_line and entry.arguments.startswith("() const")
    return fixed or reads or name.startswith(("operator", "~")) or name == own


def needs_word(entry: Entry) -> bool:
    """Files, types and functions do. A field of the app says what it is by its name and unit."""
    if not entry.file.startswith(OURS) or not entry.name.rpartition("::")[2]:
        return False
    if entry.file.startswith(INTERFACE):
        return not (entry.kind == "define" and entry.name.endswith("_H"))
    # The second is a library's, of which a class of ours is made.
    if entry.name == "_Static_assert" or entry.name.startswith("spdlog::"):
        return False
    if entry.kind == "function":
        return not is_special(entry)
    return entry.kind in ("file", *TYPES)


def told_by_file(found: Sequence[Entry]) -> set[str]:
    """Pages of the types that the docstring of their file speaks of: each is the only one of its header."""
    scopes = {one.name for one in found if one.kind in COMPOUNDS}
    alone: dict[str, list[Entry]] = {}
    for one in found:
        if one.kind in TYPES and one.name.rpartition("::")[0] not in scopes:
            alone.setdefault(one.file, []).append(one)
    return {types[0].page for types in alone.values() if len(types) == 1}


def undocumented(found: Sequence[Entry]) -> list[str]:
    """A line for each item that needs a word and has none."""
    told = told_by_file(found)
    return [
        f"{one.file}:{one.line}: {one.kind} {one.name} has no docstring"
        for one in found
        if needs_word(one) and not one.brief and one.page not in told
    ]
