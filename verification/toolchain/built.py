"""What a build by ninja was made from: a verdict on it holds until something of that changes."""

import hashlib
import json
import os
import re
import shlex
import subprocess
from collections.abc import Iterable
from functools import cached_property
from pathlib import Path


def output_of(*command: str, cwd: Path) -> str:
    return subprocess.run(command, cwd=cwd, capture_output=True, text=True, check=False).stdout


def drawn(keys: Iterable[str], root: Path) -> str:
    """The key that the commit of a tree draws; empty without keys."""
    seed = output_of("git", "rev-parse", "HEAD", cwd=root)
    return min(keys, key=lambda key: hashlib.sha256((seed + key).encode()).digest(), default="")


def keys_in(file: Path) -> set[str]:
    """The keys in a list of lines `KEY NAME`; none without the list."""
    lines = file.read_text("utf-8").splitlines() if file.is_file() else []
    return {line.partition(" ")[0] for line in lines}


class Build:
    """A folder of a build, within the tree `root` or elsewhere."""

    def __init__(self, folder: Path, root: Path) -> None:
        self.folder, self.root = folder, str(root)
        self._digests: dict[str, str] = {}

    @cached_property
    def entries(self) -> list[dict]:
        """The entries of compile_commands.json. Raises OSError without it."""
        return json.loads((self.folder / "compile_commands.json").read_text("utf-8"))

    @cached_property
    def flags(self) -> dict[str, str]:
        """The command that compiles each object."""
        words = ((shlex.split(entry["command"]), entry["command"]) for entry in self.entries)
        return {line[line.index("-o") + 1]: command for line, command in words if "-o" in line}

    @cached_property
    def _recorded(self) -> dict[str, list[str]]:
        """The files that each object was compiled from, where ninja's record is of the present ones."""
        blocks = output_of("ninja", "-t", "deps", cwd=self.folder).split("\n\n")
        heads = (block.split("\n") for block in blocks if "(VALID)" in block)
        return {head.partition(": #deps")[0]: [line.strip() for line in lines] for head, *lines in heads}

    def read_by(self, output: str) -> set[str] | None:
        """The files that an object was compiled from, or nothing without a record of all."""
        if output not in self._recorded:
            return None
        files: set[str] = set()
        for file in self._recorded[output]:
            more = {file}
            if file.endswith(".gch"):
                more = self.read_by(os.path.relpath(self.folder / file, self.folder))
            if more is None:
                return None
            files |= more
        return files

    def program_key(self, target: str, *parts: str) -> str:
        """A key of a program and the files that it is given; empty without a record of its sources."""
        inputs = output_of("ninja", "-t", "inputs", target, cwd=self.folder).splitlines()
        objects = [one for one in inputs if one in self.flags]
        read = [self.read_by(one) for one in objects]
        if not read or None in read:
            return ""
        files = {str(self.folder / file) for file in {*inputs}.union(*read)}
        commands = [self.flags[one] for one in objects]
        for given in re.findall(rf'"({re.escape(self.root)}/[^"\\]*)', "".join(commands)):
            files |= {str(path) for path in Path(given).resolve().rglob("*")}
        made = f"{self.folder}/"
        files = {file for file in files if not file.startswith(made) and Path(file).is_file()}
        return self.key(files, *commands, *parts)

    def key(self, files: Iterable[str], *parts: str) -> str:
        """A hash of texts, and of files by name and content, that is the same wherever the tree stands."""
        lines = [*parts, *(f"{file} {self._digest(file)}" for file in sorted(files))]
        return hashlib.sha256("\0".join(lines).replace(self.root, "").encode()).hexdigest()

    def _digest(self, file: str) -> str:
        if file not in self._digests:
            content = (self.folder / file).read_bytes().replace(self.root.encode(), b"")
            self._digests[file] = hashlib.sha256(content).hexdigest()
        return self._digests[file]
