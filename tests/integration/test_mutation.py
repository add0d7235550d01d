"""How `make mutate` draws mutants, remembers verdicts, and shows that a mutant is no fault."""

import contextlib
import json
import os
import select
import sys
from pathlib import Path

import pytest
from bare_kernel import ROOT

sys.path.append(str(ROOT / "verification/mutation"))

import tables
from bounded import output_of
from compiled import TRAPPING_CLANG, is_sound_program
from equal import core_files, is_same, shown_equal, write_sound
from functions import Function, callers_of, function_at, functions_in, functions_of
from operators import Mutant, draw, mutants_of
from probes import TICK_TOLD
from tree import make_tree, seeded
from unit_tests import compile_kernel
from verdicts import Kept, Verdict, kernel_digest

FILES = [f"kernel/{file}" for file in core_files(ROOT / "kernel") if "crc32_table" not in file]

SOURCE = """\
/* f(int a) { */
static bool f(uint32_t a) { return a > 1u; }

uint32_t g(const uint32_t words[4], // {
           uint32_t b) {
  if (f(b)) {
    return words[0];
  }
  return 0u;
}
"""


def test_functions_are_found_by_their_form_and_not_by_their_names() -> None:
    f, g = functions_of("x.c", SOURCE)
    assert (f.name, f.first_line, f.last_line, f.is_static) == ("f", 2, 2, True)
    assert (g.name, g.first_line, g.last_line, g.is_static) == ("g", 4, 10, False)
    assert g.parameters == ("const uint32_t words[4]", "uint32_t b")
    assert callers_of([f, g], "f") == [g]
    assert function_at([f, g], "x.c", 7) is g
    assert function_at([f, g], "x.c", 3) is None


def test_every_function_of_the_core_has_mutants() -> None:
    functions = functions_in(ROOT, FILES)
    assert len(functions) > 80
    mutated = {function_at(functions, mutant.file, mutant.line) for mutant in mutants_of(ROOT, FILES)}
    assert {function.name for function in functions if function not in mutated} == set()


@pytest.mark.parametrize(("fate", "is_known"), [("killed", True), ("equivalent", True), ("survived", False)])
def test_verdicts_are_kept_but_a_survivor_is_judged_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, fate: str, is_known: bool
) -> None:
    monkeypatch.setattr("verdicts.FILE", tmp_path / "verdicts.json")
    verdict = Verdict(fate, () if fate == "survived" else ("tests short: FAILED P1",), 0.1)
    Kept(["tests"], every=False).keep(ROOT, verdict)
    assert Kept(["tests"], every=False).find(ROOT) == (verdict if is_known else None)


def test_the_seed_alone_decides_what_is_drawn() -> None:
    mutants = mutants_of(ROOT, FILES)
    first, again, other = (draw(mutants, 400, seed) for seed in ("one", "one", "two"))
    assert first == again
    assert len(set(first)) == 400
    assert len(set(first) & set(other)) < 100


def test_a_claim_that_fails_over_the_whole_tick_is_heard_and_no_answer_is_not() -> None:
    said = "drive: P1\nstall_drive: 1 of 2 goals\ndrive    {'claims': 3} 1 s\nFAILED: {'claims': 3} in 4 s\n"
    assert TICK_TOLD.findall(said + "drive gave no answer: no such file\n") == [
        "drive: P1",
        "stall_drive: 1 of 2 goals",
    ]


def test_what_a_program_started_dies_with_it_when_its_time_is_over(tmp_path: Path) -> None:
    child = tmp_path / "child"
    script = f"sleep 600 & echo $! > {child}; wait"
    assert output_of(["sh", "-c", script], seconds=2) is None
    with contextlib.suppress(ProcessLookupError):
        end_of_child = os.pidfd_open(int(child.read_text()))
        assert select.select([end_of_child], [], [], 60)[0]
        os.close(end_of_child)
    assert output_of(["sh", "-c", "echo said; echo so >&2"], seconds=60) == "said\n"


def test_a_verdict_outlives_a_comment_but_not_a_change_of_code(tmp_path: Path) -> None:
    tree = make_tree(tmp_path / "tree")
    code = kernel_digest(tree)
    header = tree / "kernel/src/arith.h"
    header.write_text(header.read_text() + "/* said anew */\n")
    assert kernel_digest(tree) == code
    header.write_text(header.read_text() + "#define SAID 1\n")
    assert kernel_digest(tree) != code


def test_what_did_not_change_is_not_compiled_again(tmp_path: Path) -> None:
    tree = make_tree(tmp_path / "tree")
    objects = tmp_path / "objects"
    compile_kernel(tree / "kernel", objects)
    first = {path.name: path.read_bytes() for path in objects.glob("*.o")}
    times = {path.name: path.stat().st_mtime_ns for path in objects.glob("*.o")}
    function, mutant = small_function()
    with seeded(tree, mutant.file, mutant.line, mutant.before, mutant.after):
        compile_kernel(tree / "kernel", objects)
        again = {path.name for path in objects.glob("*.o") if path.stat().st_mtime_ns != times[path.name]}
        assert again == {Path(function.file).stem + ".o"}
        assert (objects / again.pop()).read_bytes() != first[Path(function.file).stem + ".o"]
    compile_kernel(tree / "kernel", objects)
    assert {path.name: path.read_bytes() for path in objects.glob("*.o")} == first


def test_the_kill_matrix_and_the_survivors_are_left_as_files(tmp_path: Path) -> None:
    functions = functions_of("x.c", SOURCE)
    mutants = [Mutant("x.c", line, "relation", f"  old {line}", f"  new {line}") for line in (2, 6, 7, 8)]
    told = {"tests": "short: red", "cbmc": "gate: red", "tick": ""}
    verdicts = [
        Verdict("killed", ("tests short: red", "cbmc gate: red"), 1.0, told),
        Verdict("killed", ("cbmc gate: red",), 1.0, told | {"tests": ""}),
        Verdict("equivalent", ("g does the same",), 1.0, dict.fromkeys(told, "")),
        Verdict("survived", (), 1.0, dict.fromkeys(told, "")),
    ]
    tables.write(tmp_path, mutants, verdicts, functions, every=True)
    matrix = json.loads((tmp_path / "matrix.json").read_text())
    assert matrix["rungs"]["cbmc"] == {"shown": 4, "killed": 2, "killed_alone": 1}
    assert matrix["rungs"]["tests"] == {"shown": 4, "killed": 1, "killed_alone": 0}
    assert matrix["functions"] == {
        "x.f": {"tests": 1, "cbmc": 1},
        "x.g": {"cbmc": 1, "equivalent": 1, "survived": 1},
    }
    [survivor] = json.loads((tmp_path / "survivors.json").read_text())
    assert (survivor["line"], survivor["function"], survivor["after"]) == (8, "x.g", "  new 8")
    assert "x.c:8\n    - old 8\n    + new 8" in (tmp_path / "survivors.txt").read_text()
    assert len(json.loads((tmp_path / "mutants.json").read_text())) == 4
    header, f, g = (tmp_path / "matrix.txt").read_text().splitlines()
    assert header.split() == ["function", *tables.COLUMNS]
    assert f.split() == ["x.f", "1", "1", "0", "0", "0"]
    assert g.split() == ["x.g", "0", "1", "0", "1", "1"]


def test_without_survivors_the_list_says_so(tmp_path: Path) -> None:
    killed = Verdict("killed", ("tests short: red",), 1.0, {"tests": "short: red"})
    mutant = Mutant("x.c", 2, "relation", "old", "new")
    tables.write(tmp_path, [mutant], [killed], functions_of("x.c", SOURCE), every=False)
    assert (tmp_path / "survivors.txt").read_text() == "none\n"
    assert json.loads((tmp_path / "survivors.json").read_text()) == []


def small_function() -> tuple[Function, Mutant]:
    """One that compares plain numbers, and a mutant of its comparison."""
    functions = functions_in(ROOT, FILES)
    for mutant in draw(mutants_of(ROOT, FILES), 4000, "small"):
        function = function_at(functions, mutant.file, mutant.line)
        if mutant.operator == "relation" and function is not None and function.file.endswith(".c"):
            plain = all(
                part.split()[0] in ("uint32_t", "uint64_t", "int32_t") for part in function.parameters
            )
            # Two multipliers side by side are more than a SAT solver compares in a test.
            if plain and function.returns == "bool" and "*" not in function.body:
                return function, mutant
    raise AssertionError("the core has no small comparison")


def tree_to_compare(folder: Path) -> tuple[Path, Path]:
    """A tree to seed, and a folder with the sound kernel to stand beside it."""
    (folder / "equal").mkdir()
    write_sound(ROOT / "kernel", folder / "equal")
    return make_tree(folder / "tree"), folder / "equal"


def line_with(path: Path, wanted: str) -> int:
    """The number of the one line that has the text."""
    [line] = [n for n, text in enumerate(path.read_text("utf-8").splitlines(), 1) if wanted in text]
    return line


@pytest.mark.provers
def test_the_sound_function_is_shown_equal_to_itself_and_a_fault_is_not(tmp_path: Path) -> None:
    function, mutant = small_function()
    tree, folder = tree_to_compare(tmp_path)
    assert is_same(function, tree, folder)
    with seeded(tree, mutant.file, mutant.line, mutant.before, mutant.after):
        assert not is_same(function, tree, folder)


@pytest.mark.provers
def test_products_of_equal_numbers_are_seen_to_be_equal(tmp_path: Path) -> None:
    file, least = "kernel/src/config.c", "(ticks >= lowest) && (((uint64_t)ticks * period_us)"
    [function] = [each for each in functions_in(ROOT, [file]) if each.name == "lasts"]
    tree, folder = tree_to_compare(tmp_path)
    line = line_with(tree / file, least)
    with seeded(tree, file, line, "(ticks >= lowest)", "!(ticks < lowest)"):
        assert is_same(function, tree, folder)
    with seeded(tree, file, line, "(ticks >= lowest)", "(ticks > lowest)"):
        assert not is_same(function, tree, folder)


def test_a_spelling_of_the_sound_program_is_the_sound_program_and_a_fault_is_not(tmp_path: Path) -> None:
    tree = make_tree(tmp_path / "tree")
    file, bound = "kernel/src/crc32.c", "word < words"
    line = line_with(tree / file, bound)
    with seeded(tree, file, line, bound, "word != words"):
        assert is_sound_program(tree, file)
    with seeded(tree, file, line, bound, "word <= words"):
        assert not is_sound_program(tree, file)
    with seeded(tree, file, line, bound, "no_such_name"):
        assert not is_sound_program(tree, file)


def test_what_traps_for_undefined_behaviour_is_no_spelling_of_what_does_not(tmp_path: Path) -> None:
    tree = make_tree(tmp_path / "tree")
    file, before = "kernel/src/request.c", "axis->state == (uint32_t)state;"
    line = line_with(tree / file, before)
    with seeded(tree, file, line, "axis->state ==", "(uint32_t)state == axis->state && axis->state =="):
        assert is_sound_program(tree, file, TRAPPING_CLANG)
    with seeded(tree, file, line, "==", "!="):
        assert not is_sound_program(tree, file, TRAPPING_CLANG)
    # A sum that overflows is undefined: to clang it never does, unless it has to trap.
    overflowing = "return ((int32_t)axis->fault_tick + 1 > (int32_t)axis->fault_tick) && axis"
    with seeded(tree, file, line, "return axis", overflowing):
        assert is_sound_program(tree, file)
        assert not is_sound_program(tree, file, TRAPPING_CLANG)


def test_a_fault_in_a_header_is_seen_in_the_files_that_take_it_in(tmp_path: Path) -> None:
    mutant = next(each for each in draw(mutants_of(ROOT, FILES), 4000, "header") if each.file.endswith(".h"))
    tree = make_tree(tmp_path / "tree")
    assert is_sound_program(tree, mutant.file)
    with seeded(tree, mutant.file, mutant.line, mutant.before, mutant.after):
        assert not is_sound_program(tree, mutant.file)


@pytest.mark.provers
def test_a_mutant_outside_of_every_function_is_never_called_equal(tmp_path: Path) -> None:
    assert shown_equal(make_tree(tmp_path / "tree"), "kernel/src/arith.h", 1) == ""
