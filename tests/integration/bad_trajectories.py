"""Trajectories of the NeuroRobot that no robot can follow, and where each of them is wrong."""

from dataclasses import dataclass


def rows_of(count: int, wrong: dict[int, str] | None = None) -> str:
    """A trajectory of so many rows; some lines, the header being line 1, are others."""
    header = "time [s],yaw [rad],insertion [mm]\n"
    lines = (f"{row * 0.01:.2f},-0.2,5" for row in range(count))
    return header + "".join((wrong or {}).get(row + 2, line) + "\n" for row, line in enumerate(lines))


@dataclass(frozen=True)
class Bad:
    text: str
    code: str
    line: int
    column: str | None
    """None: the line as a whole."""

    @property
    def place(self) -> str:
        """How a message for people names it."""
        return f"line {self.line}" + (f", {self.column}: " if self.column else ": ")


A_MILLION_ROWS = "time [s],yaw [rad]\n" + "".join(f"{row},-0.1\n" for row in range(1_000_000))
BAD_TRAJECTORIES = {
    "unsorted times": Bad(rows_of(50, {30: "0.05,-0.2,5"}), "UNSORTED_TIMES", 30, "time [s]"),
    "too few columns": Bad(rows_of(50, {12: "0.10,-0.2"}), "WRONG_COLUMNS", 12, "insertion [mm]"),
    "too many columns": Bad(rows_of(50, {12: "0.10,-0.2,5,0"}), "WRONG_COLUMNS", 12, "column 4"),
    "unknown column": Bad("time [s],elbow [rad]\n0,0\n", "UNKNOWN_AXIS", 1, "elbow [rad]"),
    "no number": Bad(rows_of(50, {20: "0.18,nan,5"}), "NOT_FINITE", 20, "yaw [rad]"),
    "a word": Bad(rows_of(50, {20: "0.18,-0.2,deep"}), "NOT_A_NUMBER", 20, "insertion [mm]"),
    "beyond a limit": Bad(rows_of(2000, {977: "9.75,-0.2,5000"}), "OUT_OF_RANGE", 977, "insertion [mm]"),
    "a reversal in an instant": Bad(
        rows_of(50, {20: "0.18,-0.3,5"}), "TOO_MUCH_ACCELERATION", 20, "yaw [rad]"
    ),
    "a million rows": Bad(A_MILLION_ROWS, "TOO_LARGE", 100_002, None),
    "empty": Bad("", "EMPTY", 1, "time [s]"),
    "a header alone": Bad(rows_of(0), "EMPTY", 2, "time [s]"),
}
