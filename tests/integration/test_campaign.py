"""What `make campaign` concludes, and that a cluster comes to the same totals as one machine."""

import importlib.util
import json
import subprocess
import sys
from pathlib import Path

import distributed
import pytest
from bare_kernel import BIN, ROOT

CAMPAIGN = ROOT / "verification/campaign"
TICKS = 60_000
SAME = ("ticks", "faults_injected", "bit_flips", "configurations_refused", "digest")
SWEPT = ("state_bits", "config_bits", "estop_ticks", "pedal_ticks")


@pytest.fixture(scope="module")
def campaign() -> object:
    sys.path.append(str(CAMPAIGN))
    specification = importlib.util.spec_from_file_location("campaign_run", CAMPAIGN / "run.py")
    assert specification is not None
    assert specification.loader is not None
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


def figures(campaign: object, **others: int) -> dict[str, int]:
    """Of a full campaign in which all happened and nothing went wrong."""
    sound = dict.fromkeys(("unsafe", "late", "bit_flips_unsafe"), 0)
    whole = campaign.SWEEPS | campaign.KINDS
    swept = dict.fromkeys((*whole, *whole.values()), 7)
    return sound | swept | dict.fromkeys(campaign.HAPPENED, 1) | campaign.FULL | others


def test_a_campaign_in_which_all_happened_and_nothing_went_wrong_passes(campaign: object) -> None:
    assert campaign.status_of(figures(campaign), failed=False) == "PASSED"
    assert campaign.status_of(figures(campaign), failed=True) == "FAILED"


@pytest.mark.parametrize("what", ["ticks", "faults_injected"])
def test_a_run_shorter_than_a_full_one_is_bounded(campaign: object, what: str) -> None:
    assert campaign.FULL == {"ticks": 100_000_000, "faults_injected": 1_000_000}
    seen = figures(campaign, **{what: campaign.FULL[what] - 1})
    assert campaign.status_of(seen, failed=False) == "BOUNDED"
    assert campaign.status_of(seen | {"late": 1}, failed=False) == "FAILED"


@pytest.mark.parametrize("kind", ["axis_faults", "causes"])
def test_a_full_run_in_which_the_kernel_never_found_a_fault_does_not_pass(
    campaign: object, kind: str
) -> None:
    name = campaign.KINDS[kind]
    seen = figures(campaign, **{name: 6})
    assert campaign.left_out(seen) == [f"{name}: 6 of 7"]
    assert campaign.status_of(seen, failed=False) == "VACUOUS"


@pytest.mark.parametrize("sweep", SWEPT)
def test_a_full_run_that_left_out_a_part_of_a_sweep_does_not_pass(campaign: object, sweep: str) -> None:
    name = campaign.SWEEPS[sweep]
    seen = figures(campaign, **{name: 6})
    assert campaign.left_out(seen) == [f"{name}: 6 of 7"]
    assert campaign.status_of(seen, failed=False) == "VACUOUS"
    assert campaign.status_of(figures(campaign, **{name: 0, sweep: 0}), failed=False) == "VACUOUS"


@pytest.mark.parametrize("what", ["unsafe", "late", "bit_flips_unsafe"])
def test_what_is_unsafe_fails_every_campaign(campaign: object, what: str) -> None:
    assert campaign.status_of(figures(campaign, **{what: 1}), failed=False) == "FAILED"


def test_a_campaign_without_refused_configurations_is_vacuous(campaign: object) -> None:
    seen = figures(campaign, configurations_refused=0)
    assert campaign.status_of(seen, failed=False) == "VACUOUS"


def totals(*options: str) -> dict[str, int]:
    """Of the program itself, which a part of the campaign runs."""
    command = [BIN / "kernel_campaign", "--seed", "5", *options]
    return json.loads(subprocess.run(command, check=True, capture_output=True).stdout)


def test_each_rule_that_is_taken_out_stands_in_the_kernel_once(campaign: object, tmp_path: Path) -> None:
    selftest = importlib.import_module("selftest")
    rules = selftest.read_rules([])
    for rule in rules:
        sources = selftest.edited(rule, tmp_path / rule["name"])
        assert any(
            file.read_bytes() != (selftest.KERNEL / "src" / file.name).read_bytes()
            for file in sources.iterdir()
        ), rule["name"]
    assert len(rules) > 100


def test_a_cluster_comes_to_the_same_totals(campaign: object, tmp_path: Path) -> None:
    whole = totals("--first", "2", "--cases", "3", "--failures", str(tmp_path))
    parts = [["--seed", "5", "--first", str(number), "--cases", "1"] for number in (2, 3, 4)]
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, host="127.0.0.1"
    ) as cluster:
        assert campaign.cluster.threads_of(cluster.scheduler_address) == 2
        done = campaign.cluster.run_parts(cluster.scheduler_address, BIN / "kernel_campaign", parts, tmp_path)
    assert [code for code, _ in done] == [0, 0, 0]
    merged = campaign.merge([json.loads(output) for _, output in done])
    assert merged["ticks"] == TICKS
    assert {key: merged[key] for key in SAME if key != "digest"} == {
        key: whole[key] for key in SAME if key != "digest"
    }
    assert merged["digest"] == whole["digest"] % 2**53
    for sweep in SWEPT:
        assert merged[campaign.SWEEPS[sweep]] == int(whole[sweep], 16).bit_count() > 0
