#!/usr/bin/env python3
"""Shows that the campaign finds a kernel whose rule for a property is missing, one seeded fault at a time.

Uses the patches of tests/failure that change the kernel (P1 to P13), each in a copy of the tree. A fault
counts as found when the campaign reports something unsafe or late within the seconds given, and the case to
which it shrinks that shows the same when it is run again; a healthy kernel must not.
Prints a table and writes build/evidence/campaign_selftest.json, beside it totals and case of each campaign.
"""

import argparse
import json
import re
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/failure"))
sys.path.insert(0, str(ROOT / "verification/evidence"))
import evidence  # noqa: E402
import run as failure  # noqa: E402

SEED = 1
LAST_PROPERTY = 13
VALUES = re.compile(r"; (axis \d+, )?found -?\d+, bound -?\d+")


# One of two places that keep a rule: without it the other still does, so no output differs. The patch beside
# this file takes the rule from both.
MASKED = {
    "P4_soft_limit_without_coast": "P4_soft_limit_in_both_places",
    "P7_bounds_without_coast": "P7_bounds_in_both_places",
}


def property_of(path: Path) -> int:
    return int(path.stem.partition("_")[0][1:])


def chosen(names: list[str]) -> list[Path]:
    paths = [*(ROOT / "tests/failure").glob("P*.patch"), *Path(__file__).parent.glob("P*.patch")]
    paths = [path for path in paths if property_of(path) <= LAST_PROPERTY and path.stem not in MASKED]
    return sorted((path for path in paths if not names or path.stem in names), key=property_of)


# Prints the totals, and below them what the case shows that the campaign leaves when it found something.
CAMPAIGN = f"""
build/release/bin/kernel_campaign --seed {SEED} --seconds "$0" --failures "$1"
ended=$?
[ $ended -ne 1 ] || build/release/bin/kernel_campaign --replay "$1"/case-{SEED}-*.txt
exit $ended
"""


def campaign(patch: Path | None, seconds: float, work: Path) -> dict:
    """The totals of a campaign of that many processor seconds, with the patch or on the tree as it is.

    When it found something: `replayed`, what its case shows when run again, and `case`, the lines of that.
    """
    command = ["sh", "-c", CAMPAIGN, str(seconds), str(work)]
    done = failure.run_in_copy(ROOT, patch, "kernel_campaign", command)
    if done.returncode not in (0, 1):
        raise failure.UnusableError(f"the campaign did not run: {done.stderr.strip()}")
    printed, _, replayed = done.stdout.partition("\n")
    totals = json.loads(printed)
    if "first_failure" in totals:
        [case] = work.glob("case-*.txt")
        totals |= {"replayed": replayed.strip(), "case": case.read_text("utf-8").splitlines()}
    return totals


def is_shown_again(totals: dict) -> bool:
    """Whether the shrunk case of a campaign fails as the campaign did, be it on another tick, axis and value."""

    def what(text: str) -> str:
        return VALUES.sub("", text.partition(": ")[2])

    return what(totals["replayed"]).startswith(f"{what(totals['first_failure']['text'])} (of ")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", help="patches to seed (default: all of P1 to P13)")
    parser.add_argument("--seconds", type=float, default=60, help="of processor time for each fault")
    arguments = parser.parse_args()
    started = time.monotonic()
    faults, outcomes = chosen(arguments.names), {}
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        healthy = campaign(None, min(arguments.seconds, 20), work)
        if "first_failure" in healthy:
            print(f"the healthy kernel fails: {healthy['first_failure']['text']}")
            return 1
        print(f"{'seeded fault':42} {'found after':>22}   by")
        for path in faults:
            outcomes[path.stem] = totals = campaign(path, arguments.seconds, work / path.stem)
            first = totals.get("first_failure")
            if first:
                after = f"{totals['ticks']:,} ticks {first['seconds']:.1f} s"
                print(f"{path.stem:42} {after:>22}   {first['text'].partition(': ')[2]}", flush=True)
                if not is_shown_again(totals):
                    print(f"{'':42} its case shows something else: {totals['replayed']}", flush=True)
            else:
                print(f"{path.stem:42} {'NOT FOUND':>22}   in {arguments.seconds:.0f} s", flush=True)
    found = [each for each in outcomes.values() if "first_failure" in each]
    seconds = [each["first_failure"]["seconds"] for each in found]
    replayed = sum(map(is_shown_again, found))
    print(f"campaign selftest: {len(faults) - len(found)} not found, {len(found) - replayed} not shown again")
    log = evidence.log_directory("campaign_selftest") / "outcomes.json"
    log.write_text(json.dumps({"healthy": healthy, **outcomes}, indent=1) + "\n", "utf-8")
    figures = {
        "faults": len(faults),
        "found": len(found),
        "not_found": len(faults) - len(found),
        "replayed": replayed,
        "properties": len({property_of(path) for path in faults}),
        "healthy_ticks": healthy["ticks"],
        "seconds_worst": round(max(seconds, default=0), 1),
        "seconds_most": arguments.seconds,
    }
    status = "PASSED" if replayed == len(faults) else "FAILED"
    tools = {"kernel_campaign": evidence.commit()[:12]}
    return evidence.write("campaign_selftest", status, tools, figures, [], started)


if __name__ == "__main__":
    sys.exit(main())
