"""What a proof is: the proof.toml beside its harness.c, read and checked.

proves          one sentence: what the harness shows
supports        the properties of the kernel that it carries
sources         the files of kernel/src that are linked to the harness, as shipped
defines         preprocessor symbols with their values, as for a build with other frames
unwind          iterations that close a loop not named in unwindset
unwindset       iterations by loop (`FUNCTION.NUMBER`), where they differ
seconds         processor time that both runs take together on an idle core
properties      how many properties must be proved, no more and no fewer
reachable       cover goals of the harness that must be reachable
contradictions  cover goals of the harness that must be unreachable
[[replaced]]    function, by (a function of the harness), proved_in (the proof that justifies it), because
[[wraps]]       function, because: an unsigned overflow, or a negative number made a word, that is
                meant; each must be shown to happen
solver          "z3" where the built-in solver finds no answer; the built-in one otherwise
[variants.NAME] the same proof once more, as NAME: those of the entries above that differ there
"""

import tomllib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent

ANY = "any"
"""In place of a proof: the stand-in gives back anything, so that nothing has to be shown of the function."""


@dataclass(frozen=True)
class Replacement:
    """A function whose calls go to a stub of the harness."""

    function: str
    by: str
    proved_in: str
    because: str


@dataclass(frozen=True)
class Wrap:
    """A function whose arithmetic is meant to be modulo 2^32."""

    function: str
    because: str


@dataclass(frozen=True)
class Proof:
    """One harness and what it must come to."""

    name: str
    directory: Path
    proves: str
    supports: list[str]
    sources: list[str]
    seconds: float
    properties: int
    reachable: frozenset[str]
    contradictions: frozenset[str]
    unwind: int = 1
    unwindset: dict[str, int] = field(default_factory=dict)
    defines: dict[str, str | int] = field(default_factory=dict)
    solver: str = ""
    replaced: list[Replacement] = field(default_factory=list)
    wraps: list[Wrap] = field(default_factory=list)

    @property
    def harness(self) -> Path:
        """The C file with the function `harness`."""
        return self.directory / "harness.c"


def proof_of(path: Path, name: str, table: dict[str, Any]) -> Proof:
    """The proof of a table. Raises SystemExit naming the file for an entry missing, unknown or empty."""
    try:
        proof = Proof(
            **{
                **table,
                "name": name,
                "directory": path.parent,
                "reachable": frozenset(table["reachable"]),
                "contradictions": frozenset(table["contradictions"]),
                "replaced": [Replacement(**entry) for entry in table.get("replaced", [])],
                "wraps": [Wrap(**entry) for entry in table.get("wraps", [])],
            }
        )
    except (KeyError, TypeError) as error:
        raise SystemExit(f"{path}: {error}; expected the entries that proofs.py describes") from error
    for entry in ("proves", "supports", "reachable", "contradictions"):
        if not getattr(proof, entry):
            raise SystemExit(f"{path}: '{entry}' is empty; a proof says what it shows and that it could fail")
    return proof


def load(path: Path) -> list[Proof]:
    """The proof of one proof.toml and its variants. Raises SystemExit as `proof_of` does."""
    table = tomllib.loads(path.read_text("utf-8"))
    variants = table.pop("variants", {})
    name = path.parent.name
    return [
        proof_of(path, name, table),
        *(proof_of(path, f"{name}-{variant}", table | differs) for variant, differs in variants.items()),
    ]


def load_all() -> list[Proof]:
    """All proofs."""
    return [proof for path in sorted(HERE.glob("*/proof.toml")) for proof in load(path)]


def unjustified(proofs: list[Proof]) -> list[str]:
    """Replacements that rest on a proof which is not among these."""
    names = {proof.name for proof in proofs}
    return [
        f"{proof.name}/proof.toml: {one.function} is replaced by right of {one.proved_in}, which is no proof"
        for proof in proofs
        for one in proof.replaced
        if one.proved_in not in (*names, ANY)
    ]
