"""Code size on a Cortex-M and stack of one step, by the compiler's own report, against their limits."""

import re
import shutil
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CORE = ROOT / "kernel/src"
INCLUDES = ["-I", str(ROOT / "kernel/include"), "-I", str(CORE)]
CORTEX_M = ["arm-none-eabi-gcc", "-mcpu=cortex-m4", "-mthumb", "-Os"]
HOST = ["gcc", "-O3"]
LIMITS = {"cortex_m_text_bytes": 16384, "stack_bytes": 1024}


def _run(command: list[str]) -> str:
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def compile_core(compiler: list[str], directory: Path) -> list[Path]:
    """Compiles every file of the core; the compiler leaves its stack report beside each object."""
    shutil.rmtree(directory, ignore_errors=True)
    directory.mkdir(parents=True)
    objects = []
    for source in sorted(CORE.glob("*.c")):
        obj = directory / f"{source.stem}.o"
        _run(
            [
                *compiler,
                "-std=c11",
                "-ffreestanding",
                "-DILK_FRAME_WORDS=32",
                "-fcallgraph-info=su",
                *INCLUDES,
                "-c",
                str(source),
                "-o",
                str(obj),
            ]
        )
        objects.append(obj)
    return objects


def text_bytes(objects: list[Path], size_tool: str) -> int:
    rows = _run([size_tool, *map(str, objects)]).splitlines()[1:]
    return sum(int(row.split()[0]) for row in rows)


def stack_bytes(directory: Path, entry: str) -> int:
    """Deepest chain of calls from `entry`, by the compiler's frame sizes and call graph.

    The core has no recursion and no function pointer; a cycle or a frame of unbounded size is an error.
    """
    frames: dict[str, int] = {}
    calls: dict[str, set[str]] = {}
    for report in directory.glob("*.ci"):
        text = report.read_text()
        for title, label in re.findall(r'node: \{ title: "([^"]+)" label: "([^"]+)"', text):
            frame = re.search(r"(\d+) bytes \((\w+)", label)
            if frame is None:
                frames.setdefault(title, 0)
            elif frame.group(2) != "static":
                raise SystemExit(f"{title}: stack use is {frame.group(2)}, expected static")
            else:
                frames[title] = int(frame.group(1))
        for source, target in re.findall(r'edge: \{ sourcename: "([^"]+)" targetname: "([^"]+)"', text):
            calls.setdefault(source, set()).add(target)

    def deepest(name: str, path: tuple[str, ...]) -> int:
        if name in path:
            raise SystemExit(f"recursion: {' -> '.join((*path, name))}")
        below = [deepest(callee, (*path, name)) for callee in sorted(calls.get(name, ()))]
        return frames.get(name, 0) + max(below, default=0)

    if entry not in frames:
        raise SystemExit(f"{entry}: not in the compiler's call graph")
    return deepest(entry, ())


def measure(directory: Path) -> dict[str, int]:
    """Text size on the Cortex-M, and the deeper stack of Cortex-M and host. Objects stay in `directory`."""
    cortex = compile_core(CORTEX_M, directory / "cortex-m")
    compile_core(HOST, directory / "host")
    return {
        "cortex_m_text_bytes": text_bytes(cortex, "arm-none-eabi-size"),
        "stack_bytes": max(stack_bytes(directory / name, "ilk_step") for name in ("cortex-m", "host")),
    }
