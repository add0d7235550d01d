"""The codes of spec/catalog.toml by name, for the kinds of columns that a table has."""

import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

FRAME = {"GOOD": 0, "MISSING": 1, "CORRUPT": 2, "LATE": 3, "REPEATED": 4}
"""What the model calls a frame of a card."""
DOOR = {"INTACT": 0, "CHECKSUM": 1, "SEQUENCE": 2}
"""What the model says of a request's checksum and number."""
UNKNOWN_REQUEST = {"NONSENSE": 99}
"""Any kind of request that there is not."""
CONTACT = {"OPEN": 0, "CLOSED": 1, "INVALID": 2}
"""What the model calls a contact; any word beyond 1 reads as INVALID."""
PASS = {"NONE": 0, "AGREES": 1, "DIFFERS": 2, "INVALID": 3}
"""What the model calls what the running check of the configuration finds in a tick."""
FLAG = {"FALSE": 0, "TRUE": 1}


def families() -> dict[str, dict[str, int]]:
    """Number by name, by family of the catalog."""
    catalog = tomllib.loads((ROOT / "spec" / "catalog.toml").read_text("utf-8"))
    return {
        family: {entry["name"]: entry["number"] for entry in catalog[family]}
        for family in catalog["family"]
        if family in catalog
    }


class Kind:
    """How a column's tokens in the model relate to a word of the kernel.

    `spelling` names a family of the catalog, or one of `flag` (any word but 0 is TRUE), `contact`, `frame`,
    `door`, `pass` (the tables above), `number`,
    `cap:N` (unsigned; N stands for every value from N on), `clamp:LOW:HIGH` (signed; an end stands for all
    values beyond it), `within` (signed; only the model's range is looked at), `bit:N` (one bit of a word).
    """

    def __init__(self, spelling: str, names: dict[str, dict[str, int]]) -> None:
        self.name, _, argument = spelling.partition(":")
        self.argument = argument
        special = {"flag": FLAG, "bit": FLAG, "contact": CONTACT, "frame": FRAME, "door": DOOR, "pass": PASS}
        self.codes = special.get(self.name) or names.get(self.name) or {}
        if self.name == "request":
            self.codes = self.codes | UNKNOWN_REQUEST

    def code(self, token: str) -> int:
        """The number for a token of TLC. Raises ValueError for one that is neither name nor number."""
        name = token.strip('"')
        return self.codes[name] if name in self.codes else int(name)

    def text(self, code: int) -> str:
        """The name for a number, for people."""
        return next((name for name, number in self.codes.items() if number == code), str(code))

    def read(self, at: str) -> str:
        """C expression for the code, given the C expression of the word."""
        match self.name:
            case "flag":
                return f"(({at}) != 0u ? 1 : 0)"
            case "contact":
                return f"(({at}) > 1u ? 2 : (int32_t)({at}))"
            case "cap":
                return f"(({at}) > {self.argument}u ? {self.argument} : (int32_t)({at}))"
            case "clamp":
                low, high = self.argument.split(":")
                return f"(({at}) < {low} ? {low} : ({at}) > {high} ? {high} : (int32_t)({at}))"
            case "bit":
                return f"((({at}) >> {self.argument}) & 1u ? 1 : 0)"
            case _:
                return f"((int32_t)({at}))"

    def write(self, at: str, value: str) -> str:
        """C statement that gives the word the plainest value with that code."""
        if self.name == "bit":
            return f"{at} |= (uint32_t){value} << {self.argument};"
        return f"{at} = {value};"
