"""The stream's binary message, read by `x-stream` of spec/openapi.yaml, shows what the paths show."""

import struct
import tomllib
from pathlib import Path

from conftest import StackFactory
from interface import spec
from motion import LATERAL, open_stream, propose, to_motion, wait_for_proposal

CATALOG = tomllib.loads((Path(__file__).resolve().parents[2] / "spec/catalog.toml").read_text())


def name_of(family: str, number: int) -> str:
    return next(code["name"] for code in CATALOG[family] if code["number"] == number)


def decode(message: bytes) -> tuple[dict[str, int], list[dict[str, int]]]:
    """Header and slots by field name; the message must be exactly as long as described."""
    layout = spec()["components"]["x-stream"]

    def block(fields: list[dict], offset: int) -> dict[str, int]:
        codes = "".join("i" if field.get("signed") else "I" for field in fields)
        values = struct.unpack_from(f"<{codes}", message, offset)
        return {field["name"]: value for field, value in zip(fields, values, strict=True)}

    header_bytes, slot_bytes = 4 * len(layout["header"]), 4 * len(layout["slot"])
    header = block(layout["header"], 0)
    for field in layout["header"]:
        if "value" in field:
            assert header[field["name"]] == field["value"], field
    state_bytes = 4 * layout["state_words"]
    assert len(message) == header_bytes + header["slots"] * slot_bytes + state_bytes
    slots = [block(layout["slot"], header_bytes + slot * slot_bytes) for slot in range(header["slots"])]
    return header, slots


def test_the_stream_shows_what_the_paths_show(stack: StackFactory) -> None:
    robot = stack()
    to_motion(robot)
    wait_for_proposal(robot, propose(robot, -300), "done")
    robot.control("pedal", pressed=False)
    propose(robot, -200)
    with open_stream(robot) as stream:
        before = robot.status()
        header, slots = next(
            decoded
            for message in stream
            if isinstance(message, bytes) and (decoded := decode(message))[0]["tick"] > before["tick"]
        )
        status, motors = robot.status(), robot.api.get("/api/motors").json()

    assert header["connected"] == 1
    assert before["tick"] < header["tick"] <= status["tick"]
    assert name_of("mode", header["mode"]) == status["mode"]
    assert name_of("cause", header["cause"]) == status["cause"]
    assert header["cause_tick"] == status["cause_tick"]
    assert header["cause_value"] == status["cause_value"]
    assert header["causes_seen"] == sum(
        1 << code["number"] for code in CATALOG["cause"] if code["name"] in status["causes_seen"]
    )
    assert name_of("pedal", header["pedal"]) == status["pedal"]
    assert bool(header["pedal_armed"]) == status["pedal_armed"]
    assert bool(header["estop"]) == status["estop"]
    assert bool(header["app_alive"]) == status["app_alive"]
    assert header["holder"] == status["holder"]
    assert header["overruns"] == status["overruns"]
    power = (status["power"] != "off") << 4 | (status["power"] == "on") << 5
    host = status["simulated"] | status["degraded"] << 1 | (status["clock"] == "sim") << 2
    assert header["flags"] == host | power
    assert f"{header['config_crc']:08x}" == status["config_crc"]
    lamps = header["lamps"].to_bytes(4, "little")
    assert {name_of("lamp", lamp): name_of("colour", colour) for lamp, colour in enumerate(lamps)} == status[
        "lamps"
    ]

    cards = {card["slot"]: card for card in status["cards"]}
    for motor in motors:
        slot = slots[motor["slot"]]
        assert name_of("axis_state", slot["state"]) == motor["state"]
        assert name_of("fault", slot["fault"]) == motor["fault"]
        assert slot["fault_value"] == motor["fault_value"]
        assert bool(slot["flags"] & 1) == motor["homed"] == (motor["homed_by"] != "NOT")
        assert bool(slot["flags"] & 32) == (motor["homed_by"] == "BY_HAND")
        assert slot["home_difference_counts"] == motor["home_difference_counts"]
        assert bool(slot["flags"] & 2) == motor["switch"]
        assert slot["flags"] & 12 == 12
        assert name_of("gate", slot["gate"]) == motor["gate"]
        assert abs(slot["position_counts"] - motor["position_counts"]) <= 1
        assert slot["drive"] == motor["drive"]
        assert slot["checksum_failures"] == cards[motor["slot"]]["checksum_failures"]
        is_open = bool(slot["flags"] & 16)
        assert (slot["setpoint_counts"] if is_open else None) == motor["setpoint_counts"]
        if motor["homed"]:
            assert (slot["min_counts"], slot["max_counts"]) == (motor["min_counts"], motor["max_counts"])
    assert slots[LATERAL]["flags"] & 16
    assert slots[LATERAL]["setpoint_counts"] == -200
