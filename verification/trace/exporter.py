"""StrictDoc, run on a folder of documents."""

import os
import shutil
import subprocess
import sys
from pathlib import Path


class RefusedError(Exception):
    """StrictDoc did not take the documents; the text is what it printed last."""


def stage(requirements: Path, source: Path) -> None:
    """Puts the documents of `requirements` and their grammar into an empty folder `source`."""
    shutil.rmtree(source, ignore_errors=True)
    source.mkdir(parents=True)
    for path in sorted(requirements.glob("*.sdoc")):
        shutil.copy(path, source)
    shutil.copy(requirements / "grammar.sgra", source)


def export(source: Path, config: Path, output: Path, formats: str) -> str:
    """Exports the documents in `source` and returns what StrictDoc printed.

    Raises RefusedError when StrictDoc ends with an error: an unknown parent, field, role or value among them.
    """
    program = Path(sys.executable).with_name("strictdoc")
    command = [str(program), "export", str(source), "--config", str(config)]
    command += ["--output-dir", str(output), "--formats", formats]
    done = subprocess.run(
        command,
        cwd=config.parent,
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"},
    )
    printed = done.stdout + done.stderr
    if done.returncode != 0:
        raise RefusedError(printed[-4000:])
    return printed
