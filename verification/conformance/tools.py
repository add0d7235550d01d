"""Runs TLC, the compiler and CBMC, and keeps their raw output."""

import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "evidence"))
from tlc_command import tlc_command

ROOT = Path(__file__).resolve().parents[2]
HERE = Path(__file__).resolve().parent
PROVERS = ROOT / "build" / "provers"
TLA = ROOT / "spec" / "tla"
CBMC_SECONDS = 900


class ToolError(Exception):
    """A tool did not do its work; the text names it and its log."""


def run(command: list[str], log: Path, folder: Path = ROOT, seconds: int = 300) -> tuple[int, str]:
    """Runs a command in `folder` and logs what it said; gives its exit status and standard output.

    Raises ToolError when it takes more than `seconds` of processor time: load beside it does not count.
    """
    limited = ["prlimit", f"--cpu={seconds}:{seconds + 5}", *command]
    done = subprocess.run(limited, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        raise ToolError(f"{command[0]} gave no answer in {seconds} s of processor time; log {log}")
    log.parent.mkdir(parents=True, exist_ok=True)
    log.write_text(" ".join(command) + "\n" + done.stdout[-200_000:] + done.stderr[-20_000:], "utf-8")
    return done.returncode, done.stdout


def tlc(
    module: Path,
    folder: Path,
    constants: dict[str, int],
    model: Path = TLA,
    checks: dict[str, str] | None = None,
) -> tuple[int, str]:
    """Runs TLC on a copy of `module` in `folder`, with its other modules from beside it and from `model`.

    `checks` are further lines of the configuration. Gives TLC's exit status and what it printed.
    """
    folder.mkdir(parents=True, exist_ok=True)
    if module.parent != folder:
        shutil.copy(module, folder)
    lines = [f"CONSTANT {name} = {value}" for name, value in constants.items()]
    lines += [f"{name} {value}" for name, value in (checks or {}).items()]
    (folder / f"{module.stem}.cfg").write_text("\n".join([*lines, ""]), "utf-8")
    command = [*tlc_command(folder, 64, [module.parent, model]), "-metadir", "states"]
    return run([*command, "-config", f"{module.stem}.cfg", module.stem], folder / "tlc.log", folder)


def kernel_sources(kernel: Path, included: Sequence[str]) -> list[str]:
    """The kernel's files, without those that the case takes in whole, to get at their inner functions."""
    return [str(path) for path in sorted((kernel / "src").glob("*.c")) if path.name not in included]


def compile_rows(case: Path, kernel: Path, included: Sequence[str]) -> None:
    """Compiles the native run of a case with the kernel's sources. Raises ToolError."""
    program, log = case / "run_rows", case / "gcc.log"
    sources = kernel_sources(kernel, included)
    flags = [
        "-std=c11",
        "-O2",
        "-flto",
        f"-I{case}",
        f"-I{kernel}/include",
        f"-I{kernel}/src",
        "-DILK_FRAME_WORDS=32",
    ]
    status, _ = run(["gcc", *flags, str(HERE / "run_rows.c"), *sources, "-o", str(program)], log)
    if status != 0:
        raise ToolError(f"the native run of {case.name} does not compile; log {log}")


@dataclass
class Proof:
    """What CBMC said of each assertion of a harness."""

    proved: list[str] = field(default_factory=list)
    failed: list[str] = field(default_factory=list)
    reached: int = 0
    unreached: list[str] = field(default_factory=list)
    case: list[int] = field(default_factory=list)
    """The codes of the inputs in a counterexample."""


RESULT = re.compile(
    r"^\[(?P<id>[^\]]+)\] (?:line \d+ )?(?P<text>.*): (?P<answer>SUCCESS|FAILURE|UNKNOWN)$", re.MULTILINE
)


SEARCHED_AS_THEY_ARE = {"apply_axis", "gate_front", "judge_door", "judge_system", "wanted"}
"""Phases whose formulas MiniSat answers sooner than it simplifies them: two to twenty times."""


def cbmc(case: Path, kernel: Path, included: Sequence[str], solver: str = "") -> Proof:
    """Proves a case, with the built-in solver or with another. Raises ToolError."""
    log = case / "cbmc.log"
    sources = kernel_sources(kernel, included)
    flags = [f"-I{case}", f"-I{kernel}/include", f"-I{kernel}/src", "-DILK_FRAME_WORDS=32", "--slice-formula"]
    flags += ["--no-standard-checks", "--unwinding-assertions", "--drop-unused-functions"]
    flags += ["--no-sat-preprocessor"] if case.name in SEARCHED_AS_THEY_ARE else []
    goals = [str(PROVERS / "bin" / "cbmc"), *flags, str(HERE / "prove.c"), *sources]
    command = [*goals, f"--{solver}"] if solver else goals
    # Another solver proves; that an answer occurs MiniSat finds sooner.
    asked = [(command, log)]
    if solver:
        asked = [([*command, "-DWITHOUT_GOALS"], log), ([*goals, "-DGOALS_ALONE"], case / "goals.log")]
    results = [result for one, log_of_one in asked for result in answers(one, log_of_one)]
    proof = Proof()
    for result in results:
        holds = result["answer"] == "SUCCESS"
        if not result["text"].startswith("reach "):
            (proof.proved if holds else proof.failed).append(result["text"])
        elif holds:
            proof.unreached.append(result["text"])
        else:
            proof.reached += 1
    if proof.failed:
        _, text = run(
            [*command, "--trace", "-DWITHOUT_GOALS"], case / "counterexample.log", ROOT, CBMC_SECONDS
        )
        proof.case = counterexample(text, proof.failed[0])
    return proof


def answers(command: list[str], log: Path) -> list[re.Match[str]]:
    """What CBMC says of each assertion. Raises ToolError when it says nothing."""
    status, text = run(command, log, ROOT, CBMC_SECONDS)
    results = list(RESULT.finditer(text))
    if status not in (0, 10) or not results:
        raise ToolError(f"CBMC gave no result (status {status}); log {log}")
    return results


def counterexample(text: str, assertion: str) -> list[int]:
    """The inputs' codes in the trace of a failed assertion."""
    traces = re.split(r"^Trace for ", text, flags=re.MULTILINE)
    trace = next((part for part in traces if f"  {assertion}\n" in part), "")
    codes = {
        int(index): int(code) for index, code in re.findall(r"^  in\[(\d+)l*\]=(-?\d+) ", trace, re.MULTILINE)
    }
    return [codes[index] for index in sorted(codes)]


def cbmc_version() -> str:
    """The version that CBMC states."""
    return run(
        [str(PROVERS / "bin" / "cbmc"), "--version"],
        ROOT / "build" / "evidence" / "conformance" / "version.log",
    )[1].split()[0]
