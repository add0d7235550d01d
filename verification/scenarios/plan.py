"""What a scenario does, drawn from a seed and its number: equal ones are equal plans on every machine."""

import itertools
import random
from dataclasses import dataclass

PROCESSES = ("simulator", "recorder", "kernel", "app")

FAULTS = (
    "kill_app",
    "freeze_app",
    "kill_kernel",
    "freeze_kernel",
    "kill_simulator",
    "freeze_simulator",
    "kill_recorder",
    "freeze_recorder",
    "kill_supervisor",
    "freeze_supervisor",
    "full_disk",
    "read_only_disk",
    "clock_step",
    "processor_load",
    "memory_limit",
    "stream_flood",
    "navigation_flood",
    "link_damage",
    "restart_in_order",
)
TURN = (*FAULTS, "restart_in_order", "restart_in_order")
"""What a turn of scenarios has, in an order drawn for it: every kind once, and what has orders to go through
three times, so that eight turns have each of the 24 orders."""

ORDERS = tuple(itertools.permutations(PROCESSES))

AS_SERVICES = frozenset({"kill_kernel", "kill_simulator", "restart_in_order"})
"""Those in which the others live on without what `interlock run` would stop them for."""

LONGEST_MOVE_S = 0.6
FAULT_S = (0.4, 1.2)
CLOCK_STEPS_S = (-86_400 * 400, -3_600, -1, 1, 3_600, 86_400 * 400)
LONGEST_GAP_S = 0.15


@dataclass(frozen=True)
class Plan:
    """One scenario."""

    seed: int
    number: int
    fault: str
    instant_s: float
    """From the first driven tick to the fault, which then waits for the next one."""
    lasts_s: float
    """From the fault to the stop that is demanded, or that came by itself."""
    stop: str
    """How the stop is demanded of a robot that goes on: pedal, estop or request."""
    clock_step_s: int
    end_order: tuple[str, ...]
    """In which the processes are killed, by `restart_in_order`; both orders are the next of the seed's."""
    start_order: tuple[str, ...]
    gaps_s: tuple[float, ...]
    """Before each of those kills and starts."""
    noise: int
    """Seed of what the fault itself draws: bytes, places, lengths."""


def kinds_within(seed: int, count: int) -> int:
    """How many kinds of fault the first scenarios of a seed have."""
    return len({plan(seed, number).fault for number in range(count)})


def order_of(seed: int, what: str, restart: int) -> tuple[str, ...]:
    """The order of that restart, counted from 0: in 24 of them each order comes once."""
    turn, place = divmod(restart, len(ORDERS))
    return random.Random(f"{seed}/{what} {turn}").sample(ORDERS, len(ORDERS))[place]


def plan(seed: int, number: int) -> Plan:
    """The scenario of that number. Its kind follows from its place in the seed's shuffle of a turn."""
    turn, place = divmod(number, len(TURN))
    kinds = random.Random(f"{seed}/turn {turn}").sample(TURN, len(TURN))
    restart = turn * TURN.count("restart_in_order") + kinds[:place].count("restart_in_order")
    dice = random.Random(f"{seed}/{number}")
    return Plan(
        seed=seed,
        number=number,
        fault=kinds[place],
        instant_s=dice.uniform(0, LONGEST_MOVE_S),
        lasts_s=dice.uniform(*FAULT_S),
        stop=dice.choice(("pedal", "estop", "request")),
        clock_step_s=dice.choice(CLOCK_STEPS_S),
        end_order=order_of(seed, "end", restart),
        start_order=order_of(seed, "start", restart),
        gaps_s=tuple(dice.uniform(0, LONGEST_GAP_S) for _ in range(2 * len(PROCESSES))),
        noise=dice.getrandbits(32),
    )
