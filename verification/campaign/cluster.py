"""Parts of the campaign on other machines: the workers of a Dask scheduler, which need Python and Dask alone.

The program goes with the work, so that all run the same one; they must be able to run what this machine runs.
"""

import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

PATIENCE_S = 30


def run_part(program: bytes, options: Sequence[str]) -> tuple[int, str, dict[str, str]]:
    """Exit code, standard output and the files of failing cases, of the program with these options."""
    with tempfile.TemporaryDirectory(prefix="interlock-campaign-") as name:
        file, failures = Path(name) / "kernel_campaign", Path(name) / "failures"
        file.write_bytes(program)
        file.chmod(0o700)
        command = [str(file), *options, "--failures", str(failures)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        cases = {path.name: path.read_text("utf-8") for path in failures.glob("case-*.txt")}
    return done.returncode, done.stdout, cases


def threads_of(address: str) -> int:
    """How many parts the scheduler's workers can run at once."""
    from distributed import Client

    with Client(address, timeout=PATIENCE_S) as client:
        client.wait_for_workers(1, timeout=PATIENCE_S)
        return sum(client.nthreads().values())


def run_parts(
    address: str, program: Path, parts: Sequence[Sequence[str]], folder: Path
) -> list[tuple[int, str]]:
    """Exit code and output of each part, in their order; the files of failing cases come into `folder`."""
    import cloudpickle
    from distributed import Client

    # Workers have no copy of this file.
    cloudpickle.register_pickle_by_value(sys.modules[__name__])
    results = []
    with Client(address, timeout=PATIENCE_S) as client:
        sent = client.scatter(program.read_bytes(), broadcast=True)
        futures = [client.submit(run_part, sent, list(options), pure=False) for options in parts]
        for code, output, cases in client.gather(futures):
            for name, text in cases.items():
                (folder / name).write_text(text, "utf-8")
            results.append((code, output))
    return results
