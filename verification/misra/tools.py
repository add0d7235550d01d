"""Runs the checkers of the coding rules and turns what they print into findings.

No exit status is trusted: cppcheck exits 0 whatever its addon finds, and a checker that skipped a file says
so only in passing, so that it must be looked for.
"""

import os
import re
import shutil
import subprocess
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
GENERATED = ROOT / "build" / "misra"
JOBS = int(os.environ.get("JOBS", "1"))

INCLUDES = [
    "kernel/include",
    "kernel/src",
    "kernel/host",
    "kernel/host/include",
    "kernel/recording/include",
    "build/misra",
]
DEFINES = ["-D_GNU_SOURCE", "-DILK_FRAME_WORDS=32"]
FLAGS = ["-std=c11", *DEFINES, *(f"-I{directory}" for directory in INCLUDES)]

GCC_WARNINGS = re.findall(
    r"\S+",
    "-pedantic -Wall -Wextra -Wshadow -Wconversion -Wcast-qual -Wcast-function-type -Wvla -Wundef"
    " -Wstrict-prototypes -Wmissing-prototypes -Wold-style-definition -Wredundant-decls -Wlogical-op"
    " -Wduplicated-cond -Wduplicated-branches -Wjump-misses-init -Wwrite-strings",
)

TIDY_CHECKS = "readability-inconsistent-declaration-parameter-name,readability-non-const-parameter"
"""On top of the project's own .clang-tidy."""


class ToolError(Exception):
    """A checker did not do its work; the text says which, on what, and what it printed."""


@dataclass(frozen=True, order=True)
class Finding:
    check: str
    """A MISRA rule such as `10.3`, or the checker's own name for what it found."""
    file: str
    line: int
    text: str = ""


def _run(command: Sequence[str], log: Path) -> str:
    """Standard output and error together, kept in `log` too."""
    done = subprocess.run(
        command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace"
    )
    with log.open("a", encoding="utf-8") as file:
        file.write(f"$ {' '.join(command)}\n{done.stdout}\n")
    return done.stdout


def _relative(path: str) -> str:
    return os.path.relpath(ROOT / path, ROOT)


def generate_layout() -> None:
    """The header that the build generates for the executive; the checkers need it, too."""
    GENERATED.mkdir(parents=True, exist_ok=True)
    headers = ["kernel/include/interlock/types.h", "kernel/include/interlock/link.h"]
    script = "kernel/host/generate_layout_fields.py"
    subprocess.run(
        ["/usr/bin/python3", script, str(GENERATED / "layout_fields.h"), *headers], cwd=ROOT, check=True
    )


def cppcheck(files: Sequence[str], log: Path) -> set[Finding]:
    """MISRA C:2012 by cppcheck's addon, and cppcheck's own checks, over all files as one program.

    Headers must be among the files: the addon looks at comments and spelling only in files that it is given.
    """
    scratch = GENERATED / log.stem  # cppcheck's notes, which would else lie beside the sources
    shutil.rmtree(scratch, ignore_errors=True)
    scratch.mkdir(parents=True)
    command = [
        "cppcheck",
        f"--cppcheck-build-dir={scratch}",
        "--addon=misra",
        "--std=c11",
        "--platform=unix64",
        "--library=posix,gnu",
    ]
    command += ["--enable=warning,style,performance,portability,information", "--force"]
    command += ["--suppress=missingIncludeSystem", "--template={file}|{line}|{id}|{severity}|{message}"]
    command += [*DEFINES, *(f"-I{directory}" for directory in INCLUDES), *files]
    output = _run(command, log)
    checked = set(re.findall(r"^Checking (\S+?)(?: \.\.\.|: )", output, re.MULTILINE))
    missing = sorted(set(files) - checked)
    if missing:
        raise ToolError(f"cppcheck did not check {', '.join(missing)}; see {log}")
    rows = re.findall(r"^([^|\n]*)\|(\d+)\|([^|]+)\|[^|]*\|(.*)$", output, re.MULTILINE)
    found = {
        Finding(name.removeprefix("misra-c2012-"), _relative(file), int(line), text)
        for file, line, name, text in rows
    }
    return found


def _gcc_one(file: str, flags: Sequence[str], log: Path) -> set[Finding]:
    output = _run(["gcc", *FLAGS, *flags, "-c", file, "-o", "/dev/null"], log)
    if re.search(r"\b(?:fatal )?error: ", output):
        raise ToolError(f"gcc cannot compile {file}:\n{output}")
    rows = re.findall(r"^(\S+?):(\d+):\d+: warning: (.*?) \[(-W[^\]]+)\]$", output, re.MULTILINE)
    return {Finding(name, _relative(path), int(line), text) for path, line, text, name in rows}


def gcc(files: Iterable[str], log: Path) -> set[Finding]:
    """Warnings of the optimising compiler, and its analyser on code that the optimiser has not touched.

    With optimisation the analyser misses faults: the optimiser removes them before it looks.
    """
    jobs = [(file, flags) for file in files for flags in (["-O2", *GCC_WARNINGS], ["-O0", "-fanalyzer"])]
    with ThreadPoolExecutor(JOBS) as pool:
        return set().union(*pool.map(lambda job: _gcc_one(*job, log), jobs))


def clang_tidy(files: Sequence[str], log: Path) -> set[Finding]:
    """The project's own clang-tidy configuration, and a few more checks that stand for MISRA rules."""

    def one(file: str) -> set[Finding]:
        output = _run(["clang-tidy-19", "--quiet", f"--checks={TIDY_CHECKS}", file, "--", *FLAGS], log)
        pattern = r"^(\S+?):(\d+):\d+: (?:error|warning): (.*?) \[([^\]]+)\]$"
        rows = re.findall(pattern, output, re.MULTILINE)
        return {
            Finding(name.removesuffix(",-warnings-as-errors"), _relative(path), int(line), text)
            for path, line, text, name in rows
        }

    with ThreadPoolExecutor(JOBS) as pool:
        return set().union(*pool.map(one, files))


SCANS = {
    "scan include": re.compile(r"#include (?!<std(?:int|bool|def)\.h>)<"),
    "scan function-macro": re.compile(r"#define \w+\("),
    "scan plain-type": re.compile(r"\b(?:int|unsigned|signed|long|short|char|float|double)\b"),
    "scan assembler": re.compile(r"\b(?:asm|__asm__|__asm)\b"),
    "scan file": re.compile(r"\b(?:fopen|freopen|fdopen|tmpfile|fclose|fgetpos|fsetpos)\s*\("),
    "scan function-pointer": re.compile(r"\(\s*\*\s*\w*\s*\)\s*\("),
}
CORE_ONLY = {"scan include", "scan function-macro", "scan plain-type", "scan function-pointer"}
SUPPRESSION = re.compile(r"cppcheck-suppress|NOLINT|GCC diagnostic|clang diagnostic")


def scan(files: Sequence[str], core: bool) -> set[Finding]:
    """What a look at the text alone decides. In the executive, only what is forbidden everywhere."""
    found = set()
    for file in files:
        text = (ROOT / file).read_text("utf-8")
        code = re.sub(r"/\*.*?\*/", lambda comment: "\n" * comment[0].count("\n"), text, flags=re.DOTALL)
        if file.endswith(".h") and not re.match(r"\s*#ifndef (\w+)\s*\n#define \1\b", code):
            found.add(Finding("scan guard", file, 1))
        for number, line in enumerate(code.splitlines(), 1):
            names = [name for name, pattern in SCANS.items() if core or name not in CORE_ONLY]
            found |= {Finding(name, file, number, line.strip()) for name in names if SCANS[name].search(line)}
        for number, line in enumerate(text.splitlines(), 1):
            if SUPPRESSION.search(line):
                found.add(Finding("scan suppression", file, number, line.strip()))
    return found
