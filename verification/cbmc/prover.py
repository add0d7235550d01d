"""Runs CBMC's tools on one proof. Every proof is checked with the same flags; none can switch a check off."""

import json
import re
import resource
import signal
import subprocess
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from proofs import HERE, Proof

ROOT = HERE.parents[1]
TOOLS = ROOT / "build" / "provers" / "bin"
MEMORY_BYTES = 6 * 10**9
PATIENCE = 6
"""A run is given up after so many times its expected time, but never before LEAST_SECONDS."""
LEAST_SECONDS = 60

COMPILE_SECONDS = 60

COMPILE = [
    "-std=c11",
    "-ffreestanding",
    "-I",
    "verification/cbmc/include",
    "-I",
    "kernel/include",
    "-I",
    "kernel/src",
]
CHECKS = [
    "--bounds-check",
    "--pointer-check",
    "--pointer-primitive-check",
    "--pointer-overflow-check",
    "--div-by-zero-check",
    "--signed-overflow-check",
    "--unsigned-overflow-check",
    "--conversion-check",
    "--undefined-shift-check",
    "--enum-range-check",
    "--unwinding-assertions",
]


@dataclass(frozen=True)
class Property:
    """A property as CBMC names it, and whether it holds."""

    name: str
    function: str
    description: str
    place: str
    holds: bool


@dataclass(frozen=True)
class Result:
    """What one run told. `trouble` says why it told nothing."""

    seconds: float
    properties: list[Property] = field(default_factory=list)
    trouble: str = ""


JSON = ["--json-ui", "--verbosity", "4"]


def version() -> str:
    """The version of CBMC, as it tells it."""
    told = subprocess.run([TOOLS / "cbmc", "--version"], check=True, capture_output=True, text=True).stdout
    return told.split()[0]


def call(tool: str, arguments: list[str], log: Path, seconds: int) -> str:
    """Runs a tool from the top of the tree and returns its output, as in `log`.

    Raises ValueError when the tool took more than `seconds` of processor time, which do not depend on what
    else the machine does.
    """

    def bound() -> None:
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY_BYTES, MEMORY_BYTES))
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))

    with log.open("w", encoding="utf-8") as output:
        done = subprocess.run(
            [TOOLS / tool, *arguments],
            cwd=ROOT,
            stdout=output,
            stderr=subprocess.STDOUT,
            preexec_fn=bound,
            check=False,
        )
    if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        raise ValueError(f"{tool} gave no answer in {seconds} s of processor time")
    return log.read_text("utf-8")


def replacements(proof: Proof, linked: Path, logs: Path) -> list[str]:
    """How to turn calls to the stubs. An inline function has a copy for each file that calls it."""
    list_functions = ["--list-goto-functions", str(linked)]
    log = logs / f"{linked.name}.functions.log"  # properties and goals of a proof are compiled side by side
    listed = call("goto-instrument", list_functions, log, COMPILE_SECONDS)
    present = re.findall(r"/\* ([^\s,]+)", listed)
    arguments = []
    for one in proof.replaced:
        copies = [name for name in present if name.split("$link")[0] == one.function]
        if not copies:
            raise ValueError(f"{one.function} is to be replaced, but the program has no such function")
        arguments += [part for copy in copies for part in ("--replace-calls", f"{copy}:{one.by}")]
    return arguments


def compiled(proof: Proof, logs: Path, kind: str) -> Path:
    """The goto program of a proof, with its replacements. Raises ValueError with the tool's words."""
    logs.mkdir(parents=True, exist_ok=True)
    program, linked = logs / f"{kind}.goto", logs / f"{kind}.linked.goto"
    program.unlink(missing_ok=True)
    linked.unlink(missing_ok=True)
    files = [str(proof.harness.relative_to(ROOT)), *(f"kernel/src/{source}" for source in proof.sources)]
    defines = [f"-D{name}={value}" for name, value in proof.defines.items()]
    defines += ["-DILK_COVER"] if kind == "cover" else []
    told = call(
        "goto-cc",
        [*COMPILE, *defines, "--function", "harness", "-o", str(linked), *files],
        logs / f"{kind}.compile.log",
        COMPILE_SECONDS,
    )
    if not linked.exists():
        raise ValueError(told.strip())
    told = call(
        "goto-instrument",
        [*replacements(proof, linked, logs), "--drop-unused-functions", str(linked), str(program)],
        logs / f"{kind}.replace.log",
        COMPILE_SECONDS,
    )
    if not program.exists():
        raise ValueError(told.strip())
    return program


def patience(proof: Proof) -> int:
    """Seconds of processor time after which a run of this proof is given up."""
    return max(LEAST_SECONDS, int(PATIENCE * proof.seconds))


def options(proof: Proof) -> list[str]:
    """How far loops are unwound, and the solver where it is not the built-in one."""
    named = [f"{loop}:{count}" for loop, count in proof.unwindset.items()]
    unwindset = ["--unwindset", ",".join(named)] if named else []
    solver = [f"--{proof.solver}"] if proof.solver else []
    return ["--unwind", str(proof.unwind), *unwindset, *solver]


def messages(text: str) -> list[dict]:
    """CBMC's JSON output. Raises ValueError when it broke off."""
    try:
        return json.loads(text)
    except json.JSONDecodeError as error:
        raise ValueError(f"CBMC broke off: {text.strip()[-300:]}") from error


def entries(told: list[dict], key: str) -> list[dict]:
    """The list that CBMC gives under `key`. Raises ValueError with its last words when there is none."""
    for message in told:
        if key in message:
            return message[key]
    words = [message["messageText"] for message in told if message.get("messageType") == "ERROR"]
    raise ValueError("CBMC gave no answer: " + "; ".join(words))


def property_of(entry: dict, name: str, holds: bool) -> Property:
    """A property or a goal from CBMC's JSON. Copies of an inline function go by the function's own name."""
    place = entry.get("sourceLocation", {})
    function = place.get("function", entry[name]).split("$link")[0]
    return Property(
        entry[name],
        function,
        entry["description"],
        f"{place.get('file', '?')}:{place.get('line', '?')}",
        holds,
    )


def timed(run: Callable[[], list[Property]], proof: Proof) -> Result:
    """Runs, measures, and turns whatever keeps the tools from an answer into words."""
    started = time.monotonic()
    try:
        found = run()
    except ValueError as error:
        return Result(time.monotonic() - started, trouble=str(error))
    return Result(time.monotonic() - started, found)


def check_properties(proof: Proof, logs: Path) -> Result:
    """Tries to prove every assertion of the harness and every check in the code that it reaches."""

    def prove() -> list[Property]:
        program = compiled(proof, logs, "proof")
        log = logs / "proof.json"
        told = messages(call("cbmc", [*JSON, *CHECKS, *options(proof), str(program)], log, patience(proof)))
        found = entries(told, "result")
        for entry in found:  # of what is meant to wrap: megabytes that nobody reads
            entry.pop("trace", None)
        log.write_text(json.dumps(told, indent=1) + "\n", "utf-8")
        return [property_of(entry, "property", entry["status"] == "SUCCESS") for entry in found]

    return timed(prove, proof)


def check_goals(proof: Proof, logs: Path) -> Result:
    """Tries to reach every cover goal of the harness."""

    def reach() -> list[Property]:
        program = compiled(proof, logs, "cover")
        arguments = [*JSON, "--cover", "cover", *options(proof), str(program)]
        told = messages(call("cbmc", arguments, logs / "cover.json", patience(proof)))
        return [
            property_of(entry, "goal", entry["status"] == "satisfied") for entry in entries(told, "goals")
        ]

    return timed(reach, proof)


def trace(proof: Proof, name: str, logs: Path) -> list[dict]:
    """The steps that lead to a failed property; none when CBMC does not find them again."""
    arguments = [*JSON, *CHECKS, *options(proof), "--trace", "--property", name, str(logs / "proof.goto")]
    try:
        told = messages(call("cbmc", arguments, logs / "trace.json", patience(proof)))
        return next((entry["trace"] for entry in entries(told, "result") if "trace" in entry), [])
    except ValueError:
        return []
