"""The kernel in the console's page on the model's rows: the module that the page loads gives each answer."""

from dataclasses import replace
from pathlib import Path

from emit import case_header
from table import Phase, Table
from tools import HERE, ROOT, ToolError, kernel_sources, run

NODE = ROOT / "build" / "venv" / "bin" / "node"
KERNEL = ROOT / "web" / "kernel"
# The functions that the page asks, and what stands in for each in page_calls.h.
CALLS = {"ilk_request_judge(": "page_request_judge(", "ilk_output_gate(": "page_output_gate("}


def is_asked(phase: Phase) -> bool:
    """Whether the phase compares a function that the page asks."""
    return any(call in phase.call for call in CALLS)


def in_the_page(phase: Phase) -> Phase:
    """The phase with its function in the page's kernel."""
    call = phase.call
    for native, page in CALLS.items():
        call = call.replace(native, page)
    return replace(phase, call=call, includes=[*phase.includes, "page_calls.h"])


def run_rows(phase: Phase, table: Table, rows: Path, model_hash: str) -> str:
    """What the native run prints when the page's kernel answers for the kernel. Raises ToolError."""
    folder = rows.parent / "page"
    folder.mkdir(parents=True, exist_ok=True)
    there = in_the_page(phase)
    (folder / "case.h").write_text(case_header(Table(there, table.rows, table.domains), model_hash), "utf-8")
    flags = ["-std=gnu11", "-O2", "-flto", "-DILK_FRAME_WORDS=32"]
    flags += [f"-I{path}" for path in (folder, HERE, ROOT / "kernel/include", ROOT / "kernel/src")]
    sources = [str(HERE / "run_rows.c"), str(HERE / "page_calls.c"), *kernel_sources(ROOT / "kernel", [])]
    program = folder / "run_rows"
    for command in ([str(KERNEL / "build")], ["gcc", *flags, *sources, "-o", str(program)]):
        status, _ = run(command, folder / "compile.log")
        if status != 0:
            raise ToolError(f"{phase.name} does not compile for the page; log {folder / 'compile.log'}")
    command = [str(NODE), str(HERE / "page_kernel.mjs"), str(KERNEL / "kernel.wasm"), str(program), str(rows)]
    return run(command, folder / "rows.log")[1]
