"""Watches the loop of one set-up for an hour, as the thesis did, beside cyclictest.

Usage: watch.py [--setup before_idle|before_loaded|shipped_idle|shipped_loaded] [--duration SECONDS].

The same measurement as one row of `make bench` (wakeups.py), long enough for its rare ticks. Prints what was
reached each minute, then a table; writes build/bench/SETUP.json (watch.schema.json says what its figures are)
and, in build/bench/pictures, the loop time over the hour and its histograms. Nothing has a limit here: those
of `make bench` hold.
"""

import argparse
import datetime
import json
import sys
import threading
import time
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "evidence"))

import evidence
import jsonschema
import pictures
import wakeups

FOLDER = evidence.ROOT / "build/bench"
SCHEMA = Path(__file__).with_name("watch.schema.json")
BY_NAME = {arrangement.name: arrangement for arrangement in wakeups.ARRANGEMENTS}
TELL_EVERY_S = 60


def tell_progress(duration: int, ended: threading.Event) -> None:
    """A line each minute, until it is over."""
    started = time.monotonic()
    while not ended.wait(TELL_EVERY_S):
        minutes = (time.monotonic() - started) / 60
        print(f"watch: {minutes:.0f} of {duration / 60:.0f} minutes", file=sys.stderr, flush=True)


def watch(arrangement: wakeups.Arrangement, duration: int, binaries: Path) -> dict:
    """What was seen, without the notes of single ticks, which are drawn."""
    ended = threading.Event()
    teller = threading.Thread(target=tell_progress, args=(duration, ended))
    teller.start()
    try:
        seen = wakeups.measure(arrangement, duration, binaries, FOLDER)
    finally:
        ended.set()
        teller.join()
    notes = seen.pop("notes")["main"]
    title = f"{arrangement.name.replace('_', ', ')}, {duration} s"
    pictures.draw(
        pictures.of_loop(notes, arrangement, title, wakeups.PERIOD_US), binaries, FOLDER / "pictures"
    )
    return seen


def record_of(arrangement: wakeups.Arrangement, seen: dict) -> dict:
    date = datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds")
    return {"setup": arrangement.name, "commit": evidence.commit(), "date": date, **seen}


def table(seen: dict) -> str:
    main, beside = seen["loops"]["main"], seen["cyclictest"]
    lines = [f"{'us':<12}" + "".join(f"{name:>10}" for name in (*wakeups.SHARES, "max"))]
    for title, times in (("wake-up", main["wake"]), ("cyclictest", beside), ("loop", main["loop"])):
        lines.append(
            f"{title:<12}" + "".join(f"{times[f'{name}_us']:>10}" for name in (*wakeups.SHARES, "max"))
        )
    ratios = seen["wake_to_cyclictest"]
    lines.append(f"{'ratio':<12}" + "".join(f"{ratios[name]:>10}" for name in wakeups.SHARES))
    lines.append(
        f"missed deadlines {main['missed_deadlines']}, held up {main['held_up']}, load {seen['load']}"
    )
    return "\n".join(lines)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--bin", type=Path, default=evidence.ROOT / "build/release/bin")
    parser.add_argument("--setup", choices=sorted(BY_NAME), default="shipped_loaded")
    parser.add_argument("--duration", type=int, default=3600, help="seconds (3600)")
    arguments = parser.parse_args()
    FOLDER.mkdir(parents=True, exist_ok=True)
    arrangement = BY_NAME[arguments.setup]
    seen = watch(arrangement, arguments.duration, arguments.bin)
    record = record_of(arrangement, seen)
    jsonschema.validate(record, json.loads(SCHEMA.read_text("utf-8")))
    path = FOLDER / f"{arrangement.name}.json"
    path.write_text(json.dumps(record, indent=2) + "\n", "utf-8")
    print(table(seen))
    print(f"watch: {path.relative_to(evidence.ROOT)}, pictures in build/bench/pictures")
    return 0


if __name__ == "__main__":
    sys.exit(main())
