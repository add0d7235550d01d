"""The rung of whole ticks: its steps are an induction, and the document shows what they claim."""

import importlib.util
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SPEC = importlib.util.spec_from_file_location("tick_run", ROOT / "verification/tick/run.py")
assert SPEC is not None
assert SPEC.loader is not None
tick = importlib.util.module_from_spec(SPEC)
sys.modules["tick_run"] = tick
SPEC.loader.exec_module(tick)


def test_document_shows_the_claims_of_the_rung() -> None:
    document = tick.DOCUMENT.read_text("utf-8")
    assert tick.with_table(document, tick.load()[1]) == document


def test_what_a_step_takes_for_granted_is_shown() -> None:
    steps = tick.load()[0]
    assert not list(tick.gaps(steps))
    assert list(tick.gaps([step for step in steps if step.name != "observation"]))


def test_a_property_is_claimed_whole_or_says_what_is_exempt() -> None:
    steps, properties = tick.load()
    claimed = {claim for step in steps for claim in (*step.claims, *step.supports)}
    parts = {claim for claim in claimed if "_" in claim}
    exempt = {name for name, entry in properties.items() if "exempt" in entry}
    assert claimed - parts == set(properties) - exempt
    assert {part.split("_")[0] for part in parts} <= exempt


def test_the_core_keeps_nothing_outside_of_its_state(tmp_path: Path) -> None:
    """The proofs look at one tick: what a static variable would remember of the one before, none can see."""
    sources = sorted((ROOT / "kernel/src").glob("*.c"))
    compiling = ["gcc", "-std=c11", "-O0", f"-I{ROOT}/kernel/include", "-DILK_FRAME_WORDS=32", "-c", *sources]
    subprocess.run(compiling, cwd=tmp_path, check=True)
    objects = [tmp_path / f"{source.stem}.o" for source in sources]
    told = subprocess.run(["size", *objects], capture_output=True, text=True, check=True).stdout
    sizes = [
        dict(zip(("text", "data", "bss"), line.split()[:3], strict=True)) for line in told.splitlines()[1:]
    ]
    assert len(sizes) == len(sources)
    assert all(size["text"] != "0" and size["data"] == size["bss"] == "0" for size in sizes), told
