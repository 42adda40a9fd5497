"""The catalogue of seeded faults fits the code; scratch copies have a fault that the tree has not."""

import ast
import os
import re
import signal
import subprocess
import sys
import time
from dataclasses import replace

import pytest
from rich.console import Console

from weakforms.errors import EnvironmentLackError, InputError
from weakforms.verification.audit.faults import scratch
from weakforms.verification.audit.faults.catalogue import (
    AREAS,
    SUBJECTS,
    TOPICS,
    Expectation,
    catalogue,
    require_sound,
    select,
)
from weakforms.verification.audit.faults.outcome import print_faults
from weakforms.verification.audit.faults.probe import narrowed
from weakforms.verification.audit.faults.runner import run_faults
from weakforms.verification.cases.discovery import find_cases, get_case
from weakforms.verification.cases.references import ROOT

FAULTS = catalogue()
KNOWN = {fault.name: fault for fault in FAULTS}
QUICK = {found.id for found in find_cases() if found.case.quick}


# -- the catalogue ---------------------------------------------------------------------------------


def test_there_are_enough_of_every_kind():
    assert len(FAULTS) >= 60
    assert len(KNOWN) == len(FAULTS)
    assert {fault.area for fault in FAULTS} == set(AREAS)
    subjects = {fault.subject for fault in FAULTS}
    assert {*TOPICS, "circular", "tube", "fluid_tube", "wrinkled_tube", "hemisphere", "surface"} < subjects
    assert subjects <= set(SUBJECTS)
    assert all(re.fullmatch("[a-z0-9]+(-[a-z0-9]+)*", name) for name in KNOWN)
    assert len({fault.description for fault in FAULTS}) == len(FAULTS)


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name)
def test_a_fault_is_one_change_of_source_that_still_parses(fault):
    text = (ROOT / fault.file).read_text("utf-8")
    changed = fault.applied(text)
    assert text.count(fault.find) == 1
    assert changed != text
    assert ast.dump(ast.parse(changed)) != ast.dump(ast.parse(text)), "not a comment, not white space"
    assert fault.file.startswith(("weakforms/", "reference_data/solvers/"))


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name)
def test_what_is_expected_to_notice_it_is_there(fault):
    for wanted in fault.expected:
        if wanted.is_test:
            tree = ast.parse((ROOT / wanted.case).read_text("utf-8"))
            assert wanted.part in {n.name for n in tree.body if isinstance(n, ast.FunctionDef)}, wanted.text
        else:
            found = narrowed(get_case(wanted.case), wanted.part)
            assert found.case.checks or found.case.panels, f"{wanted.text} names no check"


def test_most_are_noticed_by_the_quick_profile_or_a_test():
    full = {f.name for f in FAULTS if not any(e.is_test or e.case in QUICK for e in f.expected)}
    assert len(full) < len(FAULTS) / 2, full


def test_a_part_of_a_case_keeps_the_names_of_its_checks():
    whole, part = get_case("closed_form.sphere"), narrowed(get_case("closed_form.sphere"), "limits_gent")
    assert not part.case.surfaces
    assert 0 < len(part.case.checks) < len(whole.case.checks)
    assert {n for c in part.case.checks for n in c.names(part.paper)} < {
        n for c in whole.case.checks for n in c.names(whole.paper)
    }


@pytest.mark.parametrize(
    ("entry", "said"),
    [
        ('area = "load"', "wanted are"),
        ('[x]\narea = "weather"', "wanted are"),
        ("= 3", "Invalid"),
    ],
)
def test_a_damaged_catalogue_is_refused(entry, said, tmp_path):
    (tmp_path / "a.toml").write_text(f"[x]\n{entry}\n" if "[x]" not in entry else entry)
    with pytest.raises(InputError, match=said):
        catalogue(tmp_path)


def test_a_text_that_is_gone_or_there_twice_is_refused():
    fault = FAULTS[0]
    for text in ("nothing of it", 2 * (fault.find + "\n")):
        with pytest.raises(InputError, match="the catalogue is to follow the source"):
            fault.applied(text)
    with pytest.raises(InputError, match=r"there is no weakforms/gone\.py"):
        require_sound([replace(fault, file="weakforms/gone.py")])
    with pytest.raises(InputError, match="unknown case"):
        require_sound([replace(fault, expected=(Expectation("paper2.fig99"),))])


def test_selection():
    assert [f.name for f in select(["follower-load-sign"])] == ["follower-load-sign"]
    chosen = select(expression="load and fluid_tube")
    assert {"load-stiffness-dropped"} < {f.name for f in chosen}
    with pytest.raises(
        InputError, match="unknown fault 'follower-load-sing'; close to it: follower-load-sign"
    ):
        select(["follower-load-sing"])
    with pytest.raises(InputError, match="no fault matches"):
        select(expression="no_such_word")


# -- scratch copies --------------------------------------------------------------------------------


def test_a_copy_has_the_fault_and_the_tree_has_not(tmp_path):
    fault, before = KNOWN["bound-too-wide"], scratch.tree_digest()
    (tmp_path / "copy").mkdir()
    root = scratch.copy_tree(tmp_path / "copy", fault)
    assert fault.replace in (root / fault.file).read_text("utf-8")
    assert not list((root / fault.file).parent.glob("__pycache__/bounds.*.pyc"))
    assert scratch.tree_digest() == before
    assert scratch.tree_digest(root) != before


@pytest.mark.parametrize("error", [None, KeyboardInterrupt, RuntimeError])
def test_the_scratch_folder_always_goes(error):
    try:
        with scratch.scratch_folder() as folder:
            (folder / "deep").mkdir()
            (folder / "deep" / "file").write_text("x")
            if error:
                raise error
    except (KeyboardInterrupt, RuntimeError):
        pass
    assert not folder.exists()


def test_without_space_it_is_the_environments_fault(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(EnvironmentLackError, match="TMPDIR"):
        scratch.copy_tree(tmp_path / "file" / "copy")


@pytest.mark.parametrize("ending", [signal.SIGTERM, signal.SIGINT])
def test_a_run_that_is_ended_leaves_nothing_behind(ending, tmp_path):
    before, place = scratch.tree_digest(), tmp_path / "scratch"
    place.mkdir()
    words = ["faults", "--only", "follower-load-sign", "--out", str(tmp_path / "out")]
    run = subprocess.Popen(
        [sys.executable, "-m", "weakforms", *words],
        cwd=ROOT,
        env={**os.environ, "TMPDIR": str(place)},
        stderr=subprocess.PIPE,
        text=True,
    )
    until = time.monotonic() + 60
    while not list(place.glob(f"{scratch.PREFIX}*/*/log")) and time.monotonic() < until:
        time.sleep(0.05)
    run.send_signal(ending)
    _, said = run.communicate(timeout=60)
    assert run.returncode == 130, said
    assert "--resume" in said
    assert list(place.glob(f"{scratch.PREFIX}*")) == []
    assert scratch.tree_digest() == before


# -- for real ----------------------------------------------------------------------------------------


def test_two_faults_are_really_caught(tmp_path):
    """One fault is caught by a comparison of a case, one by a test, with processes and scratch copies."""
    before = scratch.tree_digest()
    run = run_faults(select(["thickness-stretch-cubed", "accuracy-not-asked-for"]), tmp_path, jobs=2)
    first, second = run.faults
    assert run.status == "caught", run.to_json()
    assert all(found.passed and found.checks for found in run.baseline)
    assert first.caught_by.check.startswith("law_neo_hookean:")
    assert first.caught_by.error > first.caught_by.bound
    assert (
        second.caught_by.check
        == "tests/verification/judging/test_bounds.py::test_one_wide_bar_among_many_fails"
    )
    assert scratch.tree_digest() == before
    screen = Console(width=160, file=open(os.devnull, "w"), record=True)  # noqa: SIM115
    print_faults(run, screen)
    text = screen.export_text()
    assert "2 of 2 seeded faults caught" in text
    assert "materials.laws" in text
