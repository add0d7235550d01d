"""The functions of the kernel's core: where they are, what they take, who calls whom.

Read from the text, whose form clang-format keeps, so that a function may be renamed or split at any time.
"""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

HEAD = re.compile(
    r"^(?P<linkage>(?:static )?(?:inline )?)(?P<returns>(?:const )?\w+ \*?)(?P<name>\w+)"
    r"\((?P<parameters>[^;{}]*)\) \{(?P<rest>.*)$",
    re.MULTILINE,
)
COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)


@dataclass(frozen=True)
class Function:
    """One definition; lines count from 1."""

    file: str
    name: str
    first_line: int
    last_line: int
    returns: str
    parameters: tuple[str, ...]
    body: str
    is_static: bool


def without_comments(text: str) -> str:
    """The text with blanks for comments, every line in its place."""
    return COMMENT.sub(lambda found: re.sub(r"[^\n]", " ", found.group()), text)


def functions_of(file: str, text: str) -> list[Function]:
    """The functions that a C file defines."""
    plain = without_comments(text)
    found = []
    for head in HEAD.finditer(plain):
        one_line = head["rest"].rstrip().endswith("}")
        end = head.end() if one_line else plain.index("\n}", head.end()) + 2
        found.append(
            Function(
                file=file,
                name=head["name"],
                first_line=plain.count("\n", 0, head.start()) + 1,
                last_line=plain.count("\n", 0, end) + 1,
                returns=head["returns"].strip(),
                parameters=tuple(part.strip() for part in head["parameters"].split(",")),
                body=plain[head.start("rest") : end],
                is_static="static" in head["linkage"],
            )
        )
    return found


def functions_in(root: Path, files: Iterable[str]) -> list[Function]:
    """Those of all files, which are named relative to `root`."""
    return [each for file in files for each in functions_of(file, (root / file).read_text("utf-8"))]


def function_at(functions: Iterable[Function], file: str, line: int) -> Function | None:
    """The function that holds a line."""
    for each in functions:
        if each.file == file and each.first_line <= line <= each.last_line:
            return each
    return None


def callers_of(functions: Iterable[Function], name: str) -> list[Function]:
    """The functions that call one."""
    call = re.compile(rf"\b{name}\(")
    return [each for each in functions if each.name != name and call.search(each.body)]


def files_reached(functions: Iterable[Function], begin: Function) -> set[str]:
    """The files of every function that this one calls, directly or not, and its own."""
    every = list(functions)
    reached, waiting = {begin}, [begin]
    while waiting:
        called = set(re.findall(r"\b(\w+)\(", waiting.pop().body))
        new = [each for each in every if each.name in called and each not in reached]
        reached |= set(new)
        waiting += new
    return {each.file for each in reached}
