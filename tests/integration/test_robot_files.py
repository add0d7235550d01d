"""Robot files: what is accepted, what is refused and how, and that a robot needs no code of its own."""

import contextlib
import hashlib
import json
import re
import subprocess
import tomllib
from collections.abc import Iterator
from pathlib import Path

import jsonschema
import pytest
from bare_kernel import BIN, DEADLINE_S, ROOT
from conftest import StackFactory
from motion import (
    enable,
    motor,
    press,
    propose,
    propose_home,
    to_motion,
    unlock,
    wait_for_mode,
    wait_for_proposal,
    wait_until,
)
from stack import Stack
from test_run import DONE, REFUSED, interlock

FILES = ROOT / "tests/integration/robots"
TRAINER = FILES / "trainer.toml"
UNWORKABLE = tomllib.loads((FILES / "unworkable.toml").read_text())
BROKEN = tomllib.loads((FILES / "broken.toml").read_text()) | UNWORKABLE
ROTATION = 0
DRILL = 0
GRIP = 5
DESK_SLOTS = (0, 2, 3, 4, 5)
SCHEMA = json.loads((ROOT / "models/robots/robot.schema.json").read_text())

# SHA-256 of the compiled configuration. Another value means that the kernel will be told something else: say
# so in the commit that changes it.
COMPILED = {
    "desk": "d51ead7a84cd09cf47e5d91e1182eda98086fc25282e6d62b4f4d9630cd08a31",
    "neuro": "0414233d838ca5a1c127f076ab9591afe480ba42401085497e18ddf78d1c4a56",
    "prostate": "01e54491b77d87b51feece1b6a619f8de6620ad05de1eb6a03a662f40d965567",
}


def robot_file(name: str) -> Path:
    return ROOT / f"models/robots/{name}.toml"


def schema_refuses(text: str) -> bool:
    return not jsonschema.Draft202012Validator(SCHEMA).is_valid(tomllib.loads(text))


def broken_text(case: str) -> str:
    """The trainer's file with the case's edit."""
    text, old = TRAINER.read_text(), BROKEN[case]["from"]
    assert old in text, f"trainer.toml has no {old!r}"
    return text.replace(old, BROKEN[case]["to"], 1)


def model(command: str, folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """`interlock model COMMAND broken.toml` in the folder, so that no path stands in its answer."""
    return subprocess.run(
        [BIN / "interlock", "model", command, "broken.toml", *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=DEADLINE_S,
    )


def test_there_are_broken_files_enough_to_trust_the_reader() -> None:
    assert len(BROKEN) >= 80
    assert len(UNWORKABLE) >= 24


@pytest.mark.parametrize("case", BROKEN)
def test_broken_robot_is_refused_at_its_line_and_key_and_nothing_is_written(
    case: str, tmp_path: Path
) -> None:
    (tmp_path / "broken.toml").write_text(broken_text(case))
    existing = tmp_path / "robot.ilkc"
    existing.write_bytes(b"the configuration of before")
    for run in (model("check", tmp_path), model("compile", tmp_path, "-o", existing.name)):
        assert run.returncode == REFUSED
        assert run.stdout == ""
        assert run.stderr.splitlines() == [f"interlock: {BROKEN[case]['error']}"]
    assert existing.read_bytes() == b"the configuration of before"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["broken.toml", "robot.ilkc"]


@pytest.mark.parametrize("case", [case for case, broken in BROKEN.items() if "schema" in broken])
def test_schema_refuses_what_is_wrong_in_structure_and_leaves_clashes_to_the_program(case: str) -> None:
    assert schema_refuses(broken_text(case)) == BROKEN[case]["schema"]


@pytest.mark.parametrize("file", [*map(robot_file, COMPILED), TRAINER], ids=lambda path: path.stem)
def test_sound_robot_satisfies_the_schema_that_its_first_line_names(file: Path) -> None:
    named = file.read_text().splitlines()[0].removeprefix("#:schema ")
    assert (file.parent / named).resolve() == ROOT / "models/robots/robot.schema.json"
    jsonschema.validate(tomllib.loads(file.read_text()), SCHEMA, cls=jsonschema.Draft202012Validator)


OPTIONAL = ("role", "required")
KEY = re.compile(r"^[a-z_]+ = .*\n", re.MULTILINE)
TABLE = re.compile(r"^\[.*\]\n", re.MULTILINE)


def refused(text: str, folder: Path) -> bool:
    (folder / "broken.toml").write_text(text)
    return model("check", folder).returncode == REFUSED


def test_no_key_may_be_missing_for_the_program_nor_for_the_schema(tmp_path: Path) -> None:
    text = TRAINER.read_text()
    for key in KEY.finditer(text):
        without = text[: key.start()] + text[key.end() :]
        name = key[0].split()[0]
        line = text.count("\n", 0, key.start()) + 1
        # A role that nobody plays is a clash, which only the program sees; "required" may be left out.
        assert refused(without, tmp_path) == (name != "required"), (line, name)
        assert schema_refuses(without) == (name not in OPTIONAL), (line, name)


def test_no_table_may_have_a_key_too_many(tmp_path: Path) -> None:
    text = TRAINER.read_text()
    tables = list(TABLE.finditer(text))
    assert len(tables) > 20
    for table in tables:
        surplus = text[: table.end()] + "surplus = 1\n" + text[table.end() :]
        line = text.count("\n", 0, table.start()) + 2
        assert refused(surplus, tmp_path), line
        assert f"broken.toml:{line}: " in model("check", tmp_path).stderr
        assert schema_refuses(surplus), line


def properties(schema: object, path: str = "") -> Iterator[tuple[str, dict]]:
    """Every property that the schema describes, by its path."""
    if isinstance(schema, dict):
        for name, value in schema.items():
            if name == "properties" and "description" in schema:
                for key, described in value.items():
                    yield f"{path}.{key}", described
            yield from properties(value, f"{path}.{name}")


def test_schema_is_sound_and_tells_what_each_key_means() -> None:
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    said_elsewhere = {"$ref", "const", "enum"}
    silent = [
        path
        for path, described in properties(SCHEMA)
        if "description" not in described and not said_elsewhere & described.keys()
    ]
    assert silent == []


@pytest.mark.parametrize("name", COMPILED)
def test_robot_compiles_to_the_same_bytes_on_every_run(name: str, tmp_path: Path) -> None:
    for run in range(3):
        output = tmp_path / f"{run}.ilkc"
        assert interlock("model", "compile", robot_file(name), "-o", output).returncode == DONE
        assert hashlib.sha256(output.read_bytes()).hexdigest() == COMPILED[name]


def test_model_check_tells_people_what_the_robot_consists_of() -> None:
    checked = interlock("model", "check", robot_file("prostate"))
    assert checked.returncode == DONE
    lines = checked.stdout.splitlines()
    assert lines[0].startswith("prostate: 6 axes, configuration ")
    assert "2     PWM             back_left       40.00 to 187.39 mm      upper" in lines
    assert "3     SENSOR          force           input_force (ADC 2), needle_force (ADC 3)" in lines
    assert "home step right_inward: nudge back_right, front_right" in lines


def test_model_check_tells_programs_the_same() -> None:
    checked = interlock("model", "check", "--json", robot_file("prostate"))
    assert checked.returncode == DONE
    robot = json.loads(checked.stdout)
    assert robot["valid"] is True
    assert robot["kinematics"] == "prostate_trapezoids"
    assert [axis["slot"] for axis in robot["axes"]] == [0, 1, 2, 4, 5, 6]
    assert robot["sensors"][0]["channels"][1] == {"name": "needle_force", "adc": 3, "unit": "unspecified"}
    assert robot["home_steps"][1]["counts"] == {"back_right": 175000, "front_right": 175000}


def test_model_check_tells_programs_what_is_wrong(tmp_path: Path) -> None:
    (tmp_path / "broken.toml").write_text(broken_text("two_axes_in_one_slot"))
    checked = model("check", tmp_path, "--json")
    assert checked.returncode == REFUSED
    assert json.loads(checked.stdout) == {
        "valid": False,
        "file": "broken.toml",
        "line": 117,
        "key": "axis.rear_a.slot",
        "problem": 'slot 0 carries "drill" already',
        "expected": "a slot of its own",
    }


def card(status: dict) -> dict:
    return next((card for card in status["cards"] if card["slot"] == GRIP), {})


def readings(stack: Stack) -> dict[int, int]:
    """What the force sensor's inputs read, without noise, by their numbers."""
    return {adc["adc"]: adc["counts"] for adc in stack.control("status")["sensors"][0]["inputs"]}


def plant_counts(stack: Stack, slot: int) -> float:
    """Where the axis truly stands."""
    return next(axis["position_counts"] for axis in stack.control("status")["axes"] if axis["slot"] == slot)


@pytest.fixture
def trainer(short_tmp_path: Path) -> Iterator[Stack]:
    """The third robot: its file and its plant's file, and nothing else that knows it."""
    arguments = [
        "--robot",
        TRAINER,
        "--plant",
        FILES / "trainer.plant.toml",
        "--clock",
        "sim",
    ]
    with contextlib.closing(
        Stack(short_tmp_path, *arguments, "--sockets", short_tmp_path / "sockets")
    ) as stack:
        stack.connect_control()
        yield stack


def test_robot_of_known_parts_moves_by_its_files_alone(trainer: Stack) -> None:
    assert trainer.status()["robot"] == "trainer"
    to_motion(trainer, DRILL)
    start = plant_counts(trainer, DRILL)
    wait_for_proposal(trainer, propose(trainer, 500, DRILL), "done")
    assert motor(trainer, DRILL)["position_counts"] == pytest.approx(500, abs=2)
    assert plant_counts(trainer, DRILL) - start == pytest.approx(500, abs=3)


def test_robot_of_the_integrators_guide_homes_as_a_whole_and_moves(stack: StackFactory) -> None:
    desk = stack(robot="desk")
    assert desk.status()["robot"] == "desk"
    unlock(desk)
    for slot in DESK_SLOTS:
        enable(desk, slot)
    number = propose_home(desk)
    press(desk)
    wait_for_proposal(desk, number, "done")
    motors = {one["name"]: one for one in (motor(desk, slot) for slot in DESK_SLOTS)}
    assert all(one["homed"] for one in motors.values())
    middle = {"front_left": 1800, "front_right": -1800, "back_left": 1800, "back_right": -1800}
    reached = {name: motors[name]["position_counts"] for name in middle}
    assert reached == pytest.approx(middle, abs=3)
    wait_for_proposal(desk, propose(desk, 1200, DESK_SLOTS[0]), "done")
    assert plant_counts(desk, DESK_SLOTS[0]) == pytest.approx(1200, abs=3)


def test_sensor_card_is_seen_and_is_no_axis(trainer: Stack) -> None:
    trainer.status_when(
        lambda status: {"slot": GRIP, "card": "SENSOR", "detected": True}.items() <= card(status).items()
    )
    assert trainer.api.get(f"/api/motors/{GRIP}").status_code == 404


def test_loss_of_a_required_sensor_ends_motion(trainer: Stack) -> None:
    to_motion(trainer, DRILL)
    trainer.control("card_power", slot=GRIP, on=False)
    wait_for_mode(trainer, "READY")


def test_prostate_robot_runs_and_its_force_sensor_can_be_pressed(stack: StackFactory) -> None:
    prostate = stack(robot="prostate")
    prostate.status_when(lambda status: sum(card["detected"] for card in status["cards"]) == 7)
    prostate.control("force", slot=3, adc=3, counts=-200)
    wait_until("the force to act", lambda: readings(prostate) == {2: 1970, 3: 1580})
    to_motion(prostate, ROTATION)
    wait_for_proposal(prostate, propose(prostate, 400, ROTATION), "done")
    assert motor(prostate, ROTATION)["position_counts"] == pytest.approx(400, abs=3)
