"""What the simulated hardware saw, held against what the kernel promises. Knows nothing of the processes.

An entry is one exchange on the bus as the plant recorded it (models/plant/README.md). Ticks of the plant
follow the clock of the wall; those of the kernel count its own decisions, and the stated times are in them.
"""

from collections.abc import Sequence
from itertools import pairwise

WIRE_TICKS = 2
"""From a contact's edge to zero drive on the wire."""
CARD_WATCHDOG_TICKS = 5
"""From the last valid frame to an amplifier that is off, in periods of the plant."""
MOVING_TICKS = 50
APP_TIMEOUT_TICKS = 100
"""From the app's last heartbeat to the end of MOTION."""


def is_driven(entry: dict) -> bool:
    return any(entry["drive"])


def consents(entry: dict) -> bool:
    """Pedal pressed on both channels, E-stop loop closed, as the contacts were read in this exchange."""
    return entry["pedal_no"] and not entry["pedal_nc"] and entry["estop_loop"]


def driven_without_consent(entries: Sequence[dict]) -> list[str]:
    """Each exchange that drives although none of the ones within the wire's latency before it consented."""
    found = []
    for place, entry in enumerate(entries):
        before = entries[max(0, place - WIRE_TICKS) : place]
        if is_driven(entry) and not any(consents(one) for one in before):
            found.append(
                f"tick {entry['tick']}: driven, but pedal or E-stop forbid it since {WIRE_TICKS} ticks"
            )
    return found


def last_driven(entries: Sequence[dict], after: int) -> dict | None:
    """The newest exchange that drives, of those after that tick of the plant."""
    return next((one for one in reversed(entries) if one["tick"] > after and is_driven(one)), None)


def was_moving(entries: Sequence[dict], tick: int) -> bool:
    """Whether something was driven just before that tick of the plant: a stop of what rests shows nothing."""
    return any(is_driven(one) for one in entries if tick - MOVING_TICKS < one["tick"] <= tick)


def stop_ticks(entries: Sequence[dict], fault: int) -> int:
    """Kernel ticks from the first exchange after the plant's tick `fault` to the last one that drives."""
    after = [one for one in entries if one["tick"] > fault]
    last = last_driven(entries, fault)
    return 0 if last is None else last["kernel_tick"] - after[0]["kernel_tick"] + 1


def driven_later_than(entries: Sequence[dict], fault: int, limit: int) -> list[str]:
    """Drive more than `limit` of the kernel's ticks after the fault."""
    took = stop_ticks(entries, fault)
    return (
        [f"driven {took} ticks after the fault at tick {fault}, {limit} are allowed"] if took > limit else []
    )


def amplifier_outlives_silence(last_exchange: int, amplifiers_off: int | None) -> list[str]:
    """Amplifiers that were on at the last exchange have to be off within the watchdog of the cards."""
    if amplifiers_off is None:
        return [f"amplifiers still on after the last exchange at tick {last_exchange}"]
    late = amplifiers_off - last_exchange
    return [f"amplifiers off {late} ticks after the last exchange"] if late > CARD_WATCHDOG_TICKS else []


def silences(entries: Sequence[dict]) -> list[tuple[int, int]]:
    """Each gap between two exchanges that is longer than the cards' watchdog, by its last and first tick."""
    return [
        (one["tick"], other["tick"])
        for one, other in pairwise(entries)
        if other["tick"] - one["tick"] > CARD_WATCHDOG_TICKS
    ]


def lost_records(acknowledged: Sequence[list[int]], audited: Sequence[list[int]]) -> list[str]:
    """What somebody was told is kept, and is not."""
    kept = {tuple(point) for point in audited}
    return [
        f"acknowledged, but not in the audit: {point}" for point in acknowledged if tuple(point) not in kept
    ]
