"""Memory of each process of a robot that runs: its own, and its share of what it shares with others (PSS).

The thesis' board has 512 MB in all. Resident memory would count a library, or the black box, in each process.
"""

import json
import re
import signal
import subprocess
import sys
import tempfile
from pathlib import Path


def share_kib(process: int) -> dict[str, int]:
    """KiB of a process and of each that it started, by name."""
    folder = Path(f"/proc/{process}")
    share = re.search(r"^Pss:\s+(\d+)", (folder / "smaps_rollup").read_text("ascii"), re.MULTILINE)
    found = {(folder / "comm").read_text("utf-8").strip(): int(share[1]) if share else 0}
    for child in (folder / f"task/{process}/children").read_text("ascii").split():
        found |= share_kib(int(child))
    return found


def measure(binaries: Path) -> dict[str, int]:
    """KiB of each process of `interlock run`, once all are ready and the first tick was shown."""
    with tempfile.TemporaryDirectory(prefix="interlock-bench-") as folder:
        command = [str(binaries / "interlock"), "run", "--port", "0", "--state", f"{folder}/state"]
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as run:
            assert run.stdout is not None
            try:
                if not any("attached to the kernel" in line for line in run.stdout):
                    raise SystemExit("interlock run did not start")
                return share_kib(run.pid)
            finally:
                run.send_signal(signal.SIGINT)
                run.stdout.read()


if __name__ == "__main__":
    print(json.dumps(measure(Path(sys.argv[1])), indent=2))
