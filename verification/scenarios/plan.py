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
"""Each kind in turn, so that as many scenarios as there are kinds have them all."""

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
    """In which the processes are killed, by `restart_in_order`."""
    start_order: tuple[str, ...]
    gaps_s: tuple[float, ...]
    """Before each of those kills and starts."""
    noise: int
    """Seed of what the fault itself draws: bytes, places, lengths."""


def plan(seed: int, number: int) -> Plan:
    """The scenario of that number. Its kind follows from its place in the seed's shuffle of all kinds."""
    turn, place = divmod(number, len(FAULTS))
    order = random.Random(f"{seed}/turn {turn}").sample(FAULTS, len(FAULTS))
    dice = random.Random(f"{seed}/{number}")
    orders = list(itertools.permutations(PROCESSES))
    return Plan(
        seed=seed,
        number=number,
        fault=order[place],
        instant_s=dice.uniform(0, LONGEST_MOVE_S),
        lasts_s=dice.uniform(*FAULT_S),
        stop=dice.choice(("pedal", "estop", "request")),
        clock_step_s=dice.choice(CLOCK_STEPS_S),
        end_order=dice.choice(orders),
        start_order=dice.choice(orders),
        gaps_s=tuple(dice.uniform(0, LONGEST_GAP_S) for _ in range(2 * len(PROCESSES))),
        noise=dice.getrandbits(32),
    )
