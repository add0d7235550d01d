"""What compilers make of the core: mutants that are one program, and mutants that are the sound one."""

import hashlib
import subprocess
from functools import cache
from pathlib import Path

from tree import ROOT

FLAGS = ("-std=c11", "-O2", "-w", "-ffreestanding", "-S", "-Ikernel/include", "-Ikernel/src", "-o", "-")
GCC = ("gcc", *FLAGS)
CLANG = ("clang-19", "--target=x86_64-linux-gnu", *FLAGS)
"""Brings more loops and conditions into one form than gcc does."""
TRAPPING_CLANG = (*CLANG, "-fsanitize=undefined", "-fsanitize-trap=undefined")
"""Undefined behaviour ends in an instruction of its own, so that it is no freedom of the compiler."""


def sources(tree: Path) -> list[Path]:
    return sorted((tree / "kernel/src").glob("*.c"))


def assembly(compiler: tuple[str, ...], tree: Path, source: Path) -> bytes:
    """What the compiler makes of a file of the tree; empty when it does not compile."""
    command = [*compiler, str(source.relative_to(tree))]
    done = subprocess.run(command, cwd=tree, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    return done.stdout if done.returncode == 0 else b""


@cache
def sound_assembly(compiler: tuple[str, ...], name: str) -> bytes:
    """What the compiler makes of a file of the kernel's core as it is."""
    return assembly(compiler, ROOT, ROOT / "kernel/src" / name)


def is_sound_program(tree: Path, file: str, compiler: tuple[str, ...] = CLANG) -> bool:
    """Whether a compiler makes the instructions of the sound kernel of the tree, which differs in one file.

    It keeps what a program does, so programs that become one are equivalent, unless their behaviour is
    undefined: ask CLANG only when CBMC has found nothing of that; of TRAPPING_CLANG both trap alike. Method:
    Papadakis et al., Trivial Compiler Equivalence, ICSE 2015.
    """
    changed = [tree / file] if file.endswith(".c") else sources(tree)
    pairs = [(assembly(compiler, tree, source), sound_assembly(compiler, source.name)) for source in changed]
    return all(ours and ours == sound for ours, sound in pairs)


class Compiler:
    """What gcc makes of the core's files, each text of them once."""

    def __init__(self, tree: Path) -> None:
        self._tree = tree
        self._sound = {path.name: self._compile(path) for path in sources(tree)}

    def _compile(self, source: Path) -> str:
        """A hash of the assembly; empty when there is none."""
        made = assembly(GCC, self._tree, source)
        return hashlib.sha256(made).hexdigest() if made else ""

    def code(self, file: str) -> str:
        """A hash over the core with that file as it is now in the tree; empty when it does not compile."""
        made = dict(self._sound)
        for path in sources(self._tree):
            if path.name == Path(file).name or file.endswith(".h"):
                made[path.name] = self._compile(path)
        return "" if "" in made.values() else hashlib.sha256(repr(sorted(made.items())).encode()).hexdigest()

    @property
    def sound(self) -> str:
        return hashlib.sha256(repr(sorted(self._sound.items())).encode()).hexdigest()
