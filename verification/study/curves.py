"""Degradation curves: how homing, tracking and targeting get worse with what the robot's file does not know.

Each point is one or more runs of `thesis_study` with a plant, a robot or a true robot that is changed in one
number.
"""

import concurrent.futures
import json
import os
import random
import re
import subprocess
import tomllib
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
ROBOTS = ("neuro", "prostate")
HOME_ONLY = ("--rounds", "0", "--scattered")
TABLE_ONCE = ("--targeting-only", "--tolerance", "100")
# By how much more than each length the treatment point is off, in each coordinate.
AT_POINT = {"neuro": 1.3, "prostate": 2.2}
FULL_SPEED = {"neuro": 1000, "prostate": 40000}

Row = dict[str, object]


@dataclass
class Point:
    """One point of a curve: what is changed, and by how much."""

    curve: str
    robot: str
    disturbance: str
    size: float
    plant: dict[str, float] = field(default_factory=dict)
    axis: dict[str, float] = field(default_factory=dict)
    robot_file: Callable[[str], str] | None = None
    identified: bool = False
    """Each axis as `interlock identify` measured it on that plant stands in the robot's file."""
    true_robot: Callable[[str, int], str] | None = None
    arguments: tuple[str, ...] = ()
    seeds: int = 1


def with_keys(text: str, table: str, keys: dict[str, float]) -> str:
    """The TOML text with these keys in every table of that header, instead of what the table had."""
    parts = re.split(r"(?m)^(?=\[)", text)
    for place, part in enumerate(parts):
        if part.startswith(table):
            for key, value in keys.items():
                part = re.sub(rf"(?m)^{key} = .*\n", "", part)
                part = part.replace("\n", f"\n{key} = {value}\n", 1)
            parts[place] = part
    return "".join(parts)


def with_tool_play(counts: int) -> Callable[[str], str]:
    """The robot's file that states so much play between encoder and tool, of every axis."""
    return lambda text: re.sub(r"(?m)^(mechanics = \{.*) \}$", rf"\1, tool_play_counts = {counts} }}", text)


def with_calibration(sd_mm: float) -> Callable[[str], str]:
    return lambda text: with_keys(text, "[kinematics]", {"calibration_mm": sd_mm})


def strayed(sd_mm: float) -> Callable[[str, int], str]:
    """The robot's file with each length of its kinematics off by a normal error, but for its window."""

    def stray(text: str, seed: int) -> str:
        chance = random.Random(seed)
        head, kinematics, rest = re.split(r"(?ms)^(\[kinematics\]\n.*?\n)(?=\n)", text, maxsplit=1)

        def off(line: re.Match) -> str:
            return line[1] + re.sub(
                r"-?\d+\.\d+",
                lambda number: str(round(float(number[0]) + chance.gauss(0, sd_mm), 6)),
                line[2],
            )

        lengths = r"(?m)^((?!m(?:in|ax)_)\w+_mm = )(.*)$"
        return head + re.sub(lengths, off, kinematics) + rest

    return stray


def motor_points(curve: str, robot: str, arguments: tuple[str, ...], seeds: int) -> Iterator[Point]:
    """What motors and encoders may do."""
    scale = FULL_SPEED[robot] // 1000

    def point(disturbance: str, size: float, *, identified: bool = False, **plant: float) -> Point:
        name = disturbance + (", as identified" if identified else "")
        return Point(
            curve, robot, name, size, plant, identified=identified, arguments=arguments, seeds=seeds
        )  # fmt: skip

    yield point("none", 0)
    for share in (0.02, 0.05, 0.1, 0.15, 0.25):
        yield point("dead zone, share of full drive (the file says 0.015)", share, dead_zone_fraction=share)
    for share in (0.02, 0.05, 0.1, 0.15):
        yield point("dead zone, share of full drive", share, identified=True, dead_zone_fraction=share)
    for share in (0.1, 0.2, 0.3, 0.4, 0.5, 0.6):
        speed = (1 - share) * FULL_SPEED[robot]
        yield point("motor slower than the file, share", share, full_speed_counts_per_s=speed)
    for share in (0.2, 0.4, 0.5):
        speed = (1 - share) * FULL_SPEED[robot]
        yield point("motor slower, share", share, identified=True, full_speed_counts_per_s=speed)
    for share in (0.05, 0.1, 0.2, 0.3, 0.5):
        yield point("load, share of the speed", share, load_fraction=share)
    for share in (0.05, 0.1, 0.2, 0.3, 0.5):
        yield point("speed lost when warm, share", share, heat_droop_fraction=share, heat_time_s=5)
    for lag_ms in (5, 8, 12, 20, 40):
        yield point("lag, ms (the file covers 5)", lag_ms, lag_ms=lag_ms)
    for counts in (1, 2, 5, 10, 20):
        name = "play before the encoder, counts" + (" times 10" if scale > 1 else "")
        yield point(name, counts, backlash_counts=counts * (10 if scale > 1 else 1))
    for share in (0.1, 0.2, 0.5):
        yield point("encoder dithers by a count, share of readings", share, noise_chance=share)
    if curve == "homing":
        for bounce_ms in (2, 5, 10, 20, 50):
            yield point("bounce of the switch, ms", bounce_ms, switch_bounce_ms=bounce_ms)


def resonance_points() -> Iterator[Point]:
    """Of the axis that is driven by frequency, while a hand pushes its needle."""
    for hz in (0, -50, -100, -200, -400):
        yield Point(
            "rotation", "prostate", "resonance below the published map, Hz", -hz, axis={"resonance_hz": hz}
        )
    for hz in (-100, -200, -400):
        name = "resonance below the published map, Hz, as identified"
        changed = {"resonance_hz": hz}
        yield Point("rotation", "prostate", name, -hz, axis=changed, identified=True)
    for hz in (50, 100, 200, 400):
        changed = {"resonance_drift_hz": hz, "heat_time_s": 5}
        yield Point("rotation", "prostate", "resonance lost when warm, Hz", hz, axis=changed)


def targeting_points(robot: str) -> Iterator[Point]:
    scale = 10 if robot == "prostate" else 1
    times = " times 10" if scale > 1 else ""

    def point(disturbance: str, size: float, **more: object) -> Point:
        rounds = ("--rounds", str(more.pop("rounds", 1)))
        return Point("targeting", robot, disturbance, size, arguments=(*TABLE_ONCE, *rounds), **more)

    yield point("none", 0, rounds=4)
    for counts in (1, 2, 5, 10, 20):
        plant = {"tool_play_counts": counts * scale}
        yield point(f"play behind the encoder, counts{times}, not in the file", counts, plant=plant, rounds=4)
        yield point(
            f"play behind the encoder, counts{times}, stated", counts, plant=plant, rounds=4,
            robot_file=with_tool_play(counts * scale),
        )  # fmt: skip
    for sd_mm in (0.05, 0.1, 0.2, 0.5):
        yield point(
            "lengths of the kinematics off, mm; calibration_mm as at the point", sd_mm,
            seeds=24,
            robot_file=with_calibration(round(AT_POINT[robot] * sd_mm, 3)), true_robot=strayed(sd_mm),
        )  # fmt: skip
    for sd_mm in (0.1, 0.2, 0.5, 1.0):
        yield Point(
            "targeting", robot, "fiducials seen off, deviation in mm", sd_mm,
            arguments=(*TABLE_ONCE, "--rounds", "24", "--fiducials", str(sd_mm)),
        )  # fmt: skip


def thesis_points() -> Iterator[Point]:
    """Believable errors together: what may explain the thesis' tables. The sizes are assumed."""
    for robot, play, lengths_mm, fiducials_mm in (("neuro", 5, 0.7, 0.5), ("prostate", 100, 0.3, 0.3)):
        yield Point(
            "thesis", robot,
            f"play of {play} counts, lengths off by {lengths_mm} mm, fiducials by {fiducials_mm} mm", 1,
            plant={"tool_play_counts": play}, robot_file=with_calibration(AT_POINT[robot] * lengths_mm),
            true_robot=strayed(lengths_mm), seeds=20,
            arguments=(*TABLE_ONCE, "--rounds", "1", "--fiducials", str(fiducials_mm)),
        )  # fmt: skip


def points() -> list[Point]:
    found = [*resonance_points(), *thesis_points()]
    for robot in ROBOTS:
        found += [*motor_points("homing", robot, HOME_ONLY, seeds=5), *targeting_points(robot)]
        found += motor_points("tracking", robot, (*TABLE_ONCE, "--rounds", "1"), seeds=1)
    return sorted(found, key=lambda point: (point.curve, point.robot))


def write(folder: Path, name: str, text: str) -> str:
    path = folder / name
    path.write_text(text)
    return str(path)


def runs_of(point: Point, study: Path, folder: Path) -> Iterator[dict | str]:
    """What each run answered, or why it ended."""
    robot = (ROOT / f"models/robots/{point.robot}.toml").read_text()
    plant = (ROOT / f"models/plant/{point.robot}.toml").read_text()
    stem = f"{abs(hash((point.curve, point.robot, point.disturbance, point.size)))}"
    plant = with_keys(plant, "[defaults]", point.plant)
    plant = with_keys(plant, "[[axis]]\nslot = 0\n", point.axis)
    command = [str(study), point.robot, "--json", "--random-targets", "0", *point.arguments]
    measured_on = write(folder, f"{stem}.plant.toml", plant)
    command += ["--plant", measured_on]
    if point.robot_file:
        changed = point.robot_file(robot)
        assert changed != robot, f"{point.disturbance} changes nothing in {point.robot}.toml"
        command[1] = write(folder, f"{stem}.toml", changed)
    names = [axis["name"] for axis in tomllib.loads(robot)["axis"]]
    for axis in names if point.identified else ():
        written = f"{folder}/{stem}.{axis}.toml"
        identify = [study.with_name("interlock"), "identify", "--robot", command[1], "--axis", axis]
        identify += ["--plant", measured_on, "--write", written]
        done = subprocess.run(identify, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            yield done.stderr.strip().splitlines()[-1]
            return
        command[1] = written
    for seed in range(1, point.seeds + 1):
        more = ["--seed", str(seed)]
        if point.true_robot:
            true = point.true_robot(robot, seed)
            assert true != robot
            more += ["--true-robot", write(folder, f"{stem}.true.toml", true)]
        done = subprocess.run([*command, *more], capture_output=True, text=True, check=False)
        yield json.loads(done.stdout) if done.returncode == 0 else done.stderr.strip().splitlines()[-1]


def row_of(point: Point, study: Path, folder: Path) -> Row:
    answers = list(runs_of(point, study, folder))
    done = [answer for answer in answers if isinstance(answer, dict)]
    ended = Counter(answer.removeprefix("thesis_study: ") for answer in answers if isinstance(answer, str))
    row: Row = {
        "curve": point.curve, "robot": point.robot, "disturbance": point.disturbance, "size": point.size,
        "runs": len(answers), "done": len(done), "ended": dict(ended),
    }  # fmt: skip
    trials = [trial for answer in done for trial in answer["trials"] if trial["refused"] is None]
    if done and point.curve == "homing":
        row["worst_counts"] = max(answer["homing_counts"] for answer in done)
    if trials and point.curve in ("tracking", "rotation"):
        axes = [answer["tracking"] for answer in done]
        chosen = [
            each[name] for each in axes for name in each if point.curve == "tracking" or name == "rotation"
        ]
        row["rms_counts"] = round(max(axis["rms_counts"] for axis in chosen), 2)
        row["worst_counts"] = round(max(axis["worst_counts"] for axis in chosen), 2)
        row["time_s"] = round(sum(trial["time_s"] for trial in trials), 1)
    if trials and point.curve in ("targeting", "thesis", "rotation"):
        errors = sorted(sum(part**2 for part in trial["first_error_mm"]) ** 0.5 for trial in trials)
        mean = sum(errors) / len(errors)
        row["insertions"] = len(errors)
        row["mean_mm"] = round(mean, 3)
        row["deviation_mm"] = round((sum((error - mean) ** 2 for error in errors) / len(errors)) ** 0.5, 3)
        row["p95_mm"] = round(errors[int(0.95 * (len(errors) - 1))], 3)
        if point.curve != "rotation":
            row["within_claim"] = round(sum(trial["within_claim"] for trial in trials) / len(trials), 3)
            row["claimed_mm"] = round(max(trial["claimed_mm"] for trial in trials), 3)
    return row


def measure(study: Path, folder: Path) -> list[Row]:
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(lambda point: row_of(point, study, folder), points()))


def worse(rows: list[Row], kept: list[Row]) -> list[str]:
    """Points that are worse than those that are kept, by more than another mathematics library makes."""
    by_name = {(row["curve"], row["robot"], row["disturbance"], row["size"]): row for row in rows}
    found = []
    for old in kept:
        name = (old["curve"], old["robot"], old["disturbance"], old["size"])
        where = f"{old['curve']}, {old['robot']}, {old['disturbance']} {old['size']:g}"
        new = by_name.get(name)
        if new is None or new["done"] < old["done"]:
            found.append(f"{where}: {new and new['done']} of {old['done']} runs done")
            continue
        for figure in ("worst_counts", "rms_counts", "time_s", "mean_mm", "p95_mm"):
            if figure in old and new[figure] > 1.25 * old[figure] + 0.05:
                found.append(f"{where}: {figure} {new[figure]}, was {old[figure]}")
        if "within_claim" in old and new["within_claim"] < old["within_claim"] - 0.1:
            found.append(f"{where}: {new['within_claim']} within the claim, was {old['within_claim']}")
    return found
