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
    """Of a campaign in which all happened and nothing went wrong."""
    sound = dict.fromkeys(("unsafe", "late", "bit_flips_unsafe"), 0)
    return sound | dict.fromkeys(campaign.HAPPENED, 1) | others


def test_a_campaign_in_which_all_happened_and_nothing_went_wrong_passes(campaign: object) -> None:
    assert campaign.status_of(figures(campaign), failed=False) == "PASSED"
    assert campaign.status_of(figures(campaign), failed=True) == "FAILED"


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


def test_a_cluster_comes_to_the_same_totals(campaign: object, tmp_path: Path) -> None:
    whole = totals("--cases", "3", "--failures", str(tmp_path))
    parts = [["--seed", "5", "--first", str(job), "--stride", "3", "--cases", "1"] for job in range(3)]
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
