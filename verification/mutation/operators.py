"""One-token mutants of the kernel's core: what a slip of the pen could have made of a line.

The operators are those of Offutt et al., "An experimental determination of sufficient mutant operators"
(1996), as far as C without pointer arithmetic knows them: relation (each for each other), logical connector,
negation, arithmetic, bitwise, shift, constant, statement deletion; and for this kernel the exchange of an
enumerator for its neighbour, a condition turned round, and nothing in place of a result, an assigned value or
one that begins a member.
"""

import hashlib
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

T = TypeVar("T")

RELATION = ("<", "<=", ">", ">=", "==", "!=")
RELATIONS = {each: tuple(other for other in RELATION if other != each) for each in RELATION}
TOKENS = {
    "relation": (re.compile(r"(?<= )(<=|>=|==|!=|<|>)(?= )"), RELATIONS),
    "connector": (re.compile(r"&&|\|\|"), {"&&": ("||",), "||": ("&&",)}),
    "arithmetic": (re.compile(r"(?<= )[-+*](?= )"), {"+": ("-",), "-": ("+",), "*": ("+",)}),
    "bitwise": (re.compile(r"(?<= )[&|^](?= )"), {"&": ("|",), "|": ("&",), "^": ("|",)}),
    "shift": (re.compile(r"<<|>>"), {"<<": (">>",), ">>": ("<<",)}),
    "increment": (re.compile(r"\+\+"), {"++": ("--",)}),
    "constant": (re.compile(r"\b[01]u\b"), {"0u": ("1u",), "1u": ("0u", "2u")}),
    "negation": (re.compile(r"!(?=\w)"), {"!": ("",)}),
    "boolean": (re.compile(r"\b(?:true|false)\b"), {"true": ("false",), "false": ("true",)}),
}
CONDITION = re.compile(r"\b(if|while) \((?P<condition>.*)\) \{$")
RETURNED = re.compile(r"\breturn (?P<value>[^;]+);")
UNENDED = re.compile(r"\breturn (?=\w+\()[^;]+$")
"""A result that goes on in the next line and begins with a call: nothing is made of it by a factor."""
ASSIGNED = re.compile(r"^\s+(?:const \w+ )?\S+ = (?P<value>[^;{]+);$")
MEMBER = re.compile(r"(?<![\w\])])\.\w+ = (?P<value>[^,;{}()]+)[,}]")
NUMBER = re.compile(r"(?<![\w.])(?:[2-9]|[1-9]\d+)(?=u?\b(?!\.))")
ENUMERATOR = re.compile(r"\bILK_[A-Z]+(?:_[A-Z]+)*\b")
DELETABLE = re.compile(
    r"^\s+(?!return|static|const|bool|u?int\d+_t|ilk_\w+_t |finding_t|case|default|break)\S.*;$"
)
EMPTIED = re.compile(r"\{ (?P<body>(?!return)\S.*;) \}$")
SKIPPED = re.compile(r"^\s*(#|/\*|\*(?!\w)|//|_Static_assert|case |default:)")


@dataclass(frozen=True)
class Mutant:
    file: str
    line: int
    operator: str
    before: str
    after: str

    @property
    def name(self) -> str:
        """Short and the same on every machine: file, line, operator and a digest of the change."""
        digest = hashlib.sha256(f"{self.before}\0{self.after}".encode()).hexdigest()[:6]
        return f"{Path(self.file).stem}-{self.line}-{self.operator}-{digest}"


def neighbours(enumerations: list[list[str]]) -> dict[str, str]:
    """For each enumerator the next one of its enumeration, the first after the last."""
    pairs: dict[str, str] = {}
    for names in enumerations:
        pairs |= dict(zip(names, names[1:] + names[:1], strict=True))
    return pairs


def enumerations_of(header: str) -> list[list[str]]:
    """The enumerators of each `typedef enum` of a C header, in order."""
    bodies = re.findall(r"typedef enum \{(.*?)\}", header, re.DOTALL)
    return [re.findall(r"^\s+(ILK_\w+) =", body, re.MULTILINE) for body in bodies]


def code_lines(text: str) -> Iterator[tuple[int, str]]:
    """The lines of a C file that hold code, numbered from 1, without comments that end them."""
    in_comment = False
    for number, line in enumerate(text.splitlines(), 1):
        opens, closes = "/*" in line, "*/" in line
        if not in_comment and not SKIPPED.match(line) and line.strip():
            yield number, re.sub(r"\s*/\*.*$", "", line)
        in_comment = (in_comment or opens) and not closes


def changes(line: str, next_of: dict[str, str]) -> Iterator[tuple[str, str]]:
    """Every mutant of one line, as operator and new line."""
    for operator, (pattern, replacements) in TOKENS.items():
        for found in pattern.finditer(line):
            for new in replacements[found.group()]:
                yield operator, line[: found.start()] + new + line[found.end() :]
    for found in ENUMERATOR.finditer(line):
        if found.group() in next_of:
            yield "enumerator", line[: found.start()] + next_of[found.group()] + line[found.end() :]
    for operator, pattern, group in (
        ("condition", CONDITION, "condition"),
        ("result", RETURNED, "value"),
        ("value", ASSIGNED, "value"),
    ):
        if found := pattern.search(line):
            new = f"!({found[group]})" if operator == "condition" else "0"
            yield operator, line[: found.start(group)] + new + line[found.end(group) :]
    if UNENDED.search(line):
        yield "result", line.replace("return ", "return 0u * ", 1)
    for found in MEMBER.finditer(line):
        yield "member", line[: found.start("value")] + "0" + line[found.end("value") :]
    for found in NUMBER.finditer(line):
        yield "constant", line[: found.start()] + str(int(found.group()) + 1) + line[found.end() :]
    if found := EMPTIED.search(line):
        yield "deletion", line[: found.start("body")] + ";" + line[found.end("body") :]
    if DELETABLE.match(line) and line.count("(") == line.count(")"):
        yield "deletion", line[: len(line) - len(line.lstrip())] + ";"


def mutants_of(root: Path, files: list[str]) -> list[Mutant]:
    """All mutants of these files, which are named relative to `root`."""
    next_of = neighbours(enumerations_of((root / "kernel/include/interlock/catalog.h").read_text("utf-8")))
    return [
        Mutant(file, number, operator, line, after)
        for file in files
        for number, line in code_lines((root / file).read_text("utf-8"))
        for operator, after in changes(line, next_of)
    ]


def draw(candidates: Sequence[T], count: int, seed: str) -> list[T]:
    """`count` of them, chosen by `seed` alone, the same on every machine."""
    return sorted(candidates, key=lambda each: hashlib.sha256(f"{seed} {each}".encode()).digest())[:count]
