"""The functions of the kernel core, and what spec/requirements/links.toml says of them."""

import re
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

FUNCTION = re.compile(
    r"^(?:static |inline )*(?:const )?[A-Za-z_]\w* \*?(?P<name>[a-z_]\w*)\([^;{}()]*\) \{",
    re.MULTILINE,
)
"""The head of a function's definition as clang-format sets it: from the first column to its brace."""
COMMENT = re.compile(r"/\*.*?\*/\s*\Z", re.DOTALL)
PURPOSE = re.compile(r"/\*\*(.*?)\*/", re.DOTALL)
STARS = re.compile(r"^ *\* ?", re.MULTILINE)


@dataclass(frozen=True)
class Function:
    """A function of the kernel core."""

    name: str
    file: str
    line: int
    purpose: str
    """The comment above its definition or its declaration, in words."""


@dataclass(frozen=True)
class Links:
    """spec/requirements/links.toml; its head tells what each table means."""

    functions: Mapping[str, Mapping[str, Sequence[str]]] = field(default_factory=dict)
    code: Mapping[str, Sequence[str]] = field(default_factory=dict)
    tests: Mapping[str, Sequence[str]] = field(default_factory=dict)
    results: Mapping[str, Sequence[str]] = field(default_factory=dict)

    def requirements_of(self, function: Function) -> Sequence[str]:
        """The requirements that a function fulfils; none when it is not listed."""
        return self.functions.get(function.file, {}).get(function.name, [])


def comments_above(text: str, place: int) -> str:
    """The comments that end right above a place in a text."""
    start = place
    while (comment := text.rfind("/*", 0, start)) >= 0 and COMMENT.fullmatch(text, comment, start):
        start = comment
    return text[start:place]


def functions_of(root: Path) -> list[Function]:
    """Every function that kernel/src defines, by file and line."""
    sources = sorted((root / "kernel/src").glob("*.[ch]"))
    public = sorted((root / "kernel/include").glob("**/*.h"))
    texts = {path: path.read_text("utf-8") for path in (*sources, *public)}
    found = []
    for path in sources:
        text = texts[path]
        for match in FUNCTION.finditer(text):
            name = match["name"]
            above = comments_above(text, match.start())
            if not PURPOSE.search(above):
                above = declaration_comments(texts, name)
            purpose = "\n".join(STARS.sub("", part).strip() for part in PURPOSE.findall(above))
            line = text.count("\n", 0, match.start()) + 1
            found.append(Function(name, path.relative_to(root).as_posix(), line, purpose))
    return found


def declaration_comments(texts: Mapping[Path, str], name: str) -> str:
    """The comments above the declaration of a function in a header, or nothing."""
    for path, text in texts.items():
        if path.suffix == ".h":
            declared = re.search(rf"^[A-Za-z_][\w ]* \*?{name}\([^;{{}}]*\);$", text, re.MULTILINE)
            if declared:
                return comments_above(text, declared.start())
    return ""


def read_links(path: Path) -> Links:
    """The links of a file. Raises ValueError for a table that there is not."""
    tables = tomllib.loads(path.read_text("utf-8"))
    known = ("functions", "code", "tests", "results")
    unknown = set(tables) - set(known)
    if unknown:
        raise ValueError(f"{path.name}: no table '{min(unknown)}'; expected one of {', '.join(known)}")
    return Links(**tables)
