"""Lets the robot move for half an hour while navigation programs talk to it; writes build/evidence/soak.json.

A whole robot as real processes, on the clock of the wall, with the real kernel before the simulated hardware.
It moves all the time. At first and at last, for a sixth of the time each, nobody else is connected: that is
what this machine does to a robot by itself. Between, four programs send it a pose 60 times a second each and
are told all that it tells, the first of them as its controller, and every five seconds forty others come and
go in five ways.

PASSED asks that no deadline of the kernel is missed because of them (windows of ten seconds have no more
missed ones than without them, by a test of their ranks), that the app's memory does not grow, and that every
message of the four was answered over one connection.
"""

import argparse
import contextlib
import json
import os
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "evidence"))
sys.path.append(str(Path(__file__).resolve().parents[2] / "tests/integration"))

import evidence
from clients import RATE_HZ, Storm
from judgement import SIGNIFICANCE, chance_of_misses, growth_kib, growth_limit_kib
from mover import BROKEN, CLIENTS, Mover, connect, give_role, make_ready
from stack import Stack

WINDOW_S = 10.0
LEAST_WINDOWS = 3
IDLE_SHARE = 1 / 6
ANSWER_LIMIT_MS = 100.0
PLANT_PRIORITY = 90
MOST_ABORTED = 0.05


class Watch:
    """Missed deadlines by window, timing by phase and memory, sampled from outside of what is measured."""

    def __init__(self, robot: Stack) -> None:
        self._robot = robot
        self._begun = time.monotonic()
        self._pid = robot.pid("app")
        self.memory_kib: list[tuple[float, float]] = []

    def rss_kib(self) -> float:
        [line] = [
            line
            for line in Path(f"/proc/{self._pid}/status").read_text().splitlines()
            if line.startswith("VmRSS:")
        ]
        return float(line.split()[1])

    def follow(self, windows: int, what: str, tell: Callable[[int], str]) -> tuple[list[int], dict]:
        """Misses of each window, and what the phases' histograms gained; a line a minute."""
        misses = []
        before = self._robot.status()
        first = before
        deadline = time.monotonic()
        for window in range(windows):
            deadline += WINDOW_S
            time.sleep(max(0.0, deadline - time.monotonic()))
            status = self._robot.status()
            misses.append(status["overruns"] - before["overruns"])
            before = status
            self.memory_kib.append((time.monotonic() - self._begun, self.rss_kib()))
            if (window + 1) % round(60 / WINDOW_S) == 0 or window + 1 == windows:
                minutes = (window + 1) * WINDOW_S / 60
                print(
                    f"soak: {what}, {minutes:.1f} of {windows * WINDOW_S / 60:.1f} min: {sum(misses)} missed "
                    f"deadlines, {self.memory_kib[-1][1] / 1024:.1f} MiB{tell(window)}",
                    flush=True,
                )
        return misses, gained(first["timing"], before["timing"])


def gained(before: dict, after: dict) -> dict[str, list[int]]:
    """Ticks by phase and power of two of nanoseconds."""
    return {
        phase: [
            now - then for now, then in zip(after[phase]["buckets"], before[phase]["buckets"], strict=True)
        ]
        for phase in after
    }


@contextlib.contextmanager
def moving_robot() -> Iterator[tuple[Stack, Mover]]:
    with tempfile.TemporaryDirectory(prefix="interlock-soak-") as folder:
        sockets = Path(folder) / "sockets"
        robot = Stack(
            Path(folder), "--robot", "neuro", "--realtime", "--sockets", sockets, "--igtl-port", "0"
        )
        try:
            robot.connect_control()
            make_ready(robot)
            mover = Mover(robot)
            mover.start()
            yield robot, mover
            mover.end()
        finally:
            robot.close()


def runs_in_time(robot: Stack) -> bool:
    """Whether the simulated hardware could be given a priority above the kernel's: a card on a bus does not
    wait for a processor, and what it is late by would count as missed by the kernel."""
    pid = robot.pid("simulator")
    try:
        for thread in Path(f"/proc/{pid}/task").iterdir():
            os.sched_setscheduler(int(thread.name), os.SCHED_FIFO, os.sched_param(PLANT_PRIORITY))
    except PermissionError:
        return False
    return True


def measure(minutes: float) -> dict:
    loaded_windows = max(LEAST_WINDOWS, round(60 * minutes / WINDOW_S))
    idle_windows = max(LEAST_WINDOWS, round(IDLE_SHARE * loaded_windows))
    with moving_robot() as (robot, mover):
        processes = {name: robot.pid(name) for name in ("app", "kernel")}
        plant_in_time = runs_in_time(robot)
        watch = Watch(robot)
        before, timing_idle = watch.follow(idle_windows, "nobody connected", lambda _: "")
        clients = connect(robot)
        storm = Storm(robot.igtl_port)
        storm.start()
        first_sample = len(watch.memory_kib)

        def tell(_: int) -> str:
            sent, answered = (sum(getattr(each, what) for each in clients) for what in ("sent", "answered"))
            return (
                f", {sent} sent, {answered} answered, {storm.connections} came and went, {mover.done} moves"
            )

        loaded, timing_loaded = watch.follow(loaded_windows, "under load", tell)
        memory = watch.memory_kib[first_sample:]
        storm.end()
        # The end of the controller's connection would stop what moves.
        give_role(robot, clients[0], "observer")
        for client in clients:
            client.end()
        after, timing_after = watch.follow(idle_windows, "nobody connected", lambda _: "")
        trouble = [f"{name} was started anew" for name, pid in processes.items() if robot.pid(name) != pid]
    trouble += mover.trouble + [each for client in clients for each in client.trouble]
    return {
        "plant_in_time": plant_in_time,
        "idle": before + after,
        "loaded": loaded,
        "timing_idle": {
            phase: [one + other for one, other in zip(timing_idle[phase], timing_after[phase], strict=True)]
            for phase in timing_idle
        },
        "timing_loaded": timing_loaded,
        "memory_kib": memory,
        "sent": sum(client.sent for client in clients),
        "answered": sum(client.answered for client in clients),
        "heard": sum(client.heard for client in clients),
        "answers_ms": sorted(each for client in clients for each in client.answers_ms),
        "connections": storm.connections,
        "moves": mover.done,
        "aborted": mover.aborted,
        "locks": mover.locks,
        "trouble": trouble,
    }


def judged(seen: dict) -> tuple[dict[str, float], list[str]]:
    """Figures, and what speaks against the soak."""
    chance = chance_of_misses(seen["idle"], seen["loaded"])
    grown, slope = growth_kib(seen["memory_kib"])
    limit = growth_limit_kib(seen["memory_kib"])
    answers = seen["answers_ms"]
    seconds = len(seen["loaded"]) * WINDOW_S
    figures = {
        "plant_in_real_time": int(seen["plant_in_time"]),
        "minutes_loaded": seconds / 60,
        "minutes_idle": len(seen["idle"]) * WINDOW_S / 60,
        "missed_deadlines_loaded": sum(seen["loaded"]),
        "missed_deadlines_idle": sum(seen["idle"]),
        "windows_with_a_miss_loaded": sum(map(bool, seen["loaded"])),
        "windows_with_a_miss_idle": sum(map(bool, seen["idle"])),
        "chance_without_their_doing": round(chance, 4),
        "rss_kib_first": seen["memory_kib"][0][1],
        "rss_kib_last": seen["memory_kib"][-1][1],
        "rss_kib_per_minute": round(slope, 1),
        "rss_kib_gained_in_second_half": round(grown, 1),
        "rss_kib_gained_limit": round(limit, 1),
        "messages_sent": seen["sent"],
        "messages_answered": seen["answered"],
        "messages_heard": seen["heard"],
        "rate_hz_of_each_client": round(seen["sent"] / CLIENTS / seconds, 1),
        "answer_ms_median": round(answers[len(answers) // 2], 2) if answers else 0.0,
        "answer_ms_p99": round(answers[int(0.99 * len(answers))], 2) if answers else 0.0,
        "answer_ms_worst": round(answers[-1], 2) if answers else 0.0,
        "connections_of_the_storm": seen["connections"],
        "moves": seen["moves"],
        "moves_aborted": len(seen["aborted"]),
        "locks": len(seen["locks"]),
    }
    checks = {
        "more deadlines were missed under load": chance < SIGNIFICANCE,
        "the app's memory grows": grown > limit,
        "the robot did not move": seen["moves"] == 0,
        f"more than {MOST_ABORTED:.0%} of the moves were aborted": len(seen["aborted"])
        > MOST_ABORTED * seen["moves"],
        "moves were aborted though no deadline was missed": bool(seen["aborted"])
        and not any(seen["idle"] + seen["loaded"]),
        "messages were not answered": seen["answered"] != seen["sent"],
        f"one answer in a hundred took longer than {ANSWER_LIMIT_MS:.0f} ms": figures["answer_ms_p99"]
        > ANSWER_LIMIT_MS,
        f"the clients did not keep {RATE_HZ} Hz": figures["rate_hz_of_each_client"] < 0.95 * RATE_HZ,
        "no storm came": seen["connections"] == 0,
    }
    return figures, [what for what, is_so in checks.items() if is_so] + seen["trouble"]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--minutes", type=float, default=30.0, help="under load; a third as long besides without"
    )
    arguments = parser.parse_args()
    started = time.monotonic()
    log = evidence.log_directory("soak")
    figures: dict[str, float] = {}
    try:
        seen = measure(arguments.minutes)
        (log / "windows.json").write_text(json.dumps(seen | {"answers_ms": []}, indent=2) + "\n", "utf-8")
        figures, against = judged(seen)
    except BROKEN as error:
        against = [f"it could not be ended: {type(error).__name__}: {error}"]
    (log / "against.txt").write_text("".join(f"{what}\n" for what in against), "utf-8")
    verdict = "FAILED" if against else "PASSED"
    tools = {"interlock": evidence.commit()[:12]}
    result = evidence.write("soak", verdict, tools, figures, [], started)
    for name, value in figures.items():
        print(f"{name:32} {value:>12}")
    for what in against:
        print(f"soak: {what}")
    print(f"soak: {verdict}; build/evidence/soak.json")
    return result


if __name__ == "__main__":
    sys.exit(main())
