"""Lets CBMC show that a mutant is no fault: for all inputs it does the same as the sound kernel.

The sound kernel stands beside the changed one in one program, every name of it with a prefix. Both run on
the same arguments and memory, whatever these hold, and must leave the same results and memory. That is asked
of the changed function first; where it differs, of all functions that call it, and of those that call these:
what a caller overwrites or never reads is no fault.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from bounded import output_of
from functions import COMMENT, Function, callers_of, files_reached, functions_in
from tree import ROOT

SOUND = "sound_"
LEVELS = 3
SOLVERS = ((("--smt2", "--z3"), 30), ((), 180))
"""Options of CBMC, and seconds for each: Z3 sees that products are equal, MiniSat knows more of memory."""
UNWINDS = (18, 66)
"""Turns of a loop, tried in turn: of those over axes or requests, then of those over the words of frames."""
ELEMENTS = 16
"""Of an array whose length a parameter does not tell: as many as there can be requests in a tick."""
FLAGS = ("-DILK_FRAME_WORDS=32", "--no-standard-checks", "--unwinding-assertions", "--drop-unused-functions")
NAMES = re.compile(
    r"^\} (\w+);|^typedef [\w ]+ (\w+);|^#define (\w+)|^#ifndef (\w+)|^static const [\w ]+?(\w+)(?:\[| =)|"
    r"^\s+(ILK_\w+|[A-Z][A-Z_0-9]+)(?= = |,$|$)",
    re.MULTILINE,
)
PARAMETER = re.compile(
    r"^(?P<const>const )?(?P<type>\w+) (?P<pointer>\*(?:const )?)?(?P<name>\w+)(?P<array>\[(?P<size>\w*)\])?$"
)


@dataclass(frozen=True)
class Argument:
    """One parameter, as the harness makes it."""

    number: int
    name: str
    type: str
    kind: str
    """`value`, `read` for what is pointed to and not written, `written`."""
    size: str
    """Elements, empty for one."""


def core_files(kernel: Path) -> list[str]:
    return sorted(str(path.relative_to(kernel)) for path in (kernel / "src").glob("*.[ch]"))


def core_functions() -> list[Function]:
    return functions_in(ROOT, [f"kernel/{file}" for file in core_files(ROOT / "kernel")])


def names_of(kernel: Path) -> set[str]:
    """Every name that a file of the core brings into the program, and none of its public headers."""
    names = {each.name for each in functions_in(kernel, core_files(kernel))}
    for file in core_files(kernel):
        plain = COMMENT.sub("", (kernel / file).read_text("utf-8"))
        names |= {name for found in NAMES.finditer(plain) for name in found.groups() if name}
    public = "".join(path.read_text("utf-8") for path in (kernel / "include/interlock").glob("*.h"))
    shared = set(re.findall(r"\b(?:ILK_\w+|\w+_t)\b", COMMENT.sub("", public)))
    return names - shared


def write_sound(kernel: Path, folder: Path) -> None:
    """The sound kernel with its prefix, and prototypes of what the public headers declare without it."""
    names = names_of(kernel)
    word = re.compile(r"\b(" + "|".join(sorted(names, key=len, reverse=True)) + r")\b")
    public = [each for each in functions_in(kernel, core_files(kernel)) if not each.is_static]
    prototypes = [f"{each.returns} {SOUND}{each.name}({', '.join(each.parameters)});" for each in public]
    known = "".join(path.read_text("utf-8") for path in (kernel / "include/interlock").glob("*.h"))
    declared = [line for each, line in zip(public, prototypes, strict=True) if f"{each.name}(" in known]
    head = '#include "interlock/kernel.h"\n' + "\n".join(declared) + "\n"
    (folder / f"{SOUND}public.h").write_text(head, "utf-8")
    for file in core_files(kernel):
        plain = COMMENT.sub(" ", (kernel / file).read_text("utf-8"))
        renamed = word.sub(lambda found: SOUND + found.group(), plain)
        renamed = re.sub(r'#include "(?!interlock/)(\w+\.h)"', rf'#include "{SOUND}\1"', renamed)
        text = f'#include "{SOUND}public.h"\n' + renamed
        (folder / f"{SOUND}{Path(file).name}").write_text(text, "utf-8")


def argument(number: int, parameter: str) -> Argument | None:
    """The parameter of that number; nothing when it has a form that the harness cannot make."""
    found = PARAMETER.match(" ".join(parameter.split()))
    if found is None:
        return None
    if not found["pointer"] and not found["array"]:
        return Argument(number, found["name"], found["type"], "value", "")
    size = (found["size"] or str(ELEMENTS)) if found["array"] else ""
    return Argument(number, found["name"], found["type"], "read" if found["const"] else "written", size)


def same(first: str, second: str) -> str:
    """Every word of two objects of one size is the same, and what is left of them."""
    one, other = (f"((const unsigned char *)&{name})[n]" for name in (first, second))
    assumed = f"unsigned n; __CPROVER_assume(n < sizeof {first});"
    return f'  {{ {assumed}\n    __CPROVER_assert({one} == {other}, "same"); }}\n'


def harness(function: Function, arguments: Sequence[Argument], local: set[str]) -> str:
    """A program that runs the function and its sound twin side by side."""

    def sound(name: str) -> str:
        return SOUND + name if name in local else name

    name = Path(function.file).name
    made, theirs, ours, checks = [], [], [], []
    for each in arguments:
        size = f"[{each.size}]" if each.size else ""
        address = "" if each.size or each.kind == "value" else "&"
        made.append(f"  {each.type} a{each.number}{size}; {sound(each.type)} b{each.number}{size};")
        copied = f"memcpy(&b{each.number}, &a{each.number}, sizeof a{each.number})"
        plain = not each.size and sound(each.type) == each.type
        made.append(f"  b{each.number} = a{each.number};" if plain else f"  {copied};")
        ours.append(f"{address}a{each.number}")
        theirs.append(f"{address}b{each.number}")
        if each.kind == "written":
            checks.append(same(f"a{each.number}", f"b{each.number}"))
    call, twin = f"{function.name}({', '.join(ours)})", f"{SOUND}{function.name}({', '.join(theirs)})"
    if function.returns == "void":
        calls = f"  {call};\n  {twin};\n"
    else:
        base = function.returns.removeprefix("const ").rstrip(" *")
        calls = f"  {function.returns} r = {call};\n"
        calls += f"  {function.returns.replace(base, sound(base))} s = {twin};\n"
        checks.append('  __CPROVER_assert(r == s, "same");\n' if is_scalar(base) else same("r", "s"))
    return (
        f'#include <string.h>\n#include "{SOUND}public.h"\n#include "{name}"\n#include "{SOUND}{name}"\n'
        "int main(void) {\n" + "\n".join(made) + "\n" + calls + "".join(checks) + "  return 0;\n}\n"
    )


def is_scalar(base: str) -> bool:
    return base in ("bool", "int32_t", "uint32_t", "int64_t", "uint64_t")


def is_same(function: Function, tree: Path, folder: Path) -> bool:
    """Whether CBMC shows that the function of the changed tree does what its sound twin does."""
    arguments = [argument(*each) for each in enumerate(function.parameters) if each[1] != "void"]
    if any(each is None for each in arguments):
        return False
    made = [each for each in arguments if each]
    text = harness(function, made, names_of(ROOT / "kernel"))
    source = folder / f"same_{function.name}.c"
    source.write_text(text, "utf-8")
    taken_in = Path(function.file).name
    needed = {Path(file).name for file in files_reached(core_functions(), function)} | {"crc32_table.c"}
    others = [
        str(path)
        for path in (*sorted((tree / "kernel/src").glob("*.c")), *sorted(folder.glob(f"{SOUND}*.c")))
        if path.name.removeprefix(SOUND) in needed - {taken_in}
    ]
    command = [str(ROOT / "build/provers/bin/cbmc"), *FLAGS, "--function", "main", f"-I{folder}"]
    command += [f"-I{tree}/kernel/include", f"-I{tree}/kernel/src", str(source), *others]
    for turns in UNWINDS:
        told = answer([*command, "--unwind", str(turns)])
        (folder / f"same_{function.name}.log").write_text(told, "utf-8")
        if not re.search(r"unwinding assertion.*: FAILURE$", told, re.MULTILINE):
            break
    return "VERIFICATION SUCCESSFUL" in told and '"same"' in text


def answer(command: Sequence[str]) -> str:
    """All that CBMC says with the first solver that comes to an end in its time; empty when none does."""
    told = (output_of([*command, *options], seconds) for options, seconds in SOLVERS)
    return next(filter(None, told), "")


def shown_equal(tree: Path, file: str, line: int, levels: int = LEVELS) -> str:
    """Where CBMC shows that a mutant makes no difference; empty when it does not.

    `tree` holds the mutant, ROOT the sound kernel; with one level only the changed function is asked about.
    """
    functions = core_functions()
    asked = [each for each in functions if each.file == file and each.first_line <= line <= each.last_line]
    folder = tree / "build/equal"
    folder.mkdir(parents=True, exist_ok=True)
    write_sound(ROOT / "kernel", folder)
    for _ in range(levels):
        if not asked:
            return ""
        if all(is_same(each, tree, folder) for each in asked):
            return f"CBMC: {', '.join(each.name for each in asked)} the same for all inputs"
        asked = unique(caller for each in asked for caller in callers_of(functions, each.name))
    return ""


def unique(functions: Iterable[Function]) -> list[Function]:
    return list(dict.fromkeys(functions))
