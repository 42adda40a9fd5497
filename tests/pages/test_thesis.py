"""The thesis panel by panel, as the report lists it."""

from dataclasses import replace

import pytest
from canned_run import sample, verdict

from weakforms.verification.cases.discovery import find_cases
from weakforms.verification.judging.outcome import (
    CaseOutcome,
    CurveOutcome,
    PanelOutcome,
    PathOutcome,
    Verdict,
)
from weakforms.verification.report import thesis

CLAIM = Verdict("claim:c", "claim", True, "the tube grows")


def panel(*references, name="profiles"):
    curves = [
        CurveOutcome(f"curve {i}", f"label {i}", [0.0], [0.0], reference_name=r)
        for i, r in enumerate(references)
    ]
    return PanelOutcome(name, "", "x", "y", "$x$", "$y$", (0, 1), (0, 1), curves)


def row_of(case, paper=2, name="5"):
    rows = thesis.panels(sample(case))
    (row,) = (row for row in rows if (row.paper, row.name) == (paper, name))
    return row


def outcome(ident, verdicts, *panels):
    return CaseOutcome(ident, "T", "S", "", "passed", list(verdicts), list(panels))


def checks(*names, **more):
    return [replace(verdict(f"{name}:rho", **more), reference=name) for name in names]


def test_every_row_names_a_case_and_its_panels():
    cases = {found.id: found.case for found in find_cases()}
    rows = thesis.panels(sample())
    assert len(rows) == len({(row.paper, row.name) for row in rows}) == 92
    for line in thesis.THESIS.strip().splitlines():
        for item in line.split(";"):
            paper, *words = item.split(" ")
            words = words[1:] if words[0] not in ("table", "section") else words[2:]
            prefix = " ".join(words[1:])
            names = [p.name for p in cases[f"paper{paper}.{words[0]}"].panels]
            found = [n for n in names if (n.startswith(prefix) if len(prefix) > 1 else n == prefix)]
            assert prefix in "-@" or found, item


def test_a_panel_is_held_if_all_its_curves_agree():
    row = row_of(outcome("paper2.fig05", checks("a", "b"), panel("a", "b")))
    assert (row.drawn, row.compared, row.held) == (2, 2, True)
    assert row.asked == (1e-7, 1e-7)


@pytest.mark.parametrize(
    ("verdicts", "references"),
    [
        (checks("a"), ("a", "")),
        (checks("a") + checks("b", passed=False), ("a", "b")),
        ([], ("", "")),
        (checks("a"), ("a", "b")),
    ],
)
def test_a_panel_with_a_curve_that_is_not_compared_is_not_held(verdicts, references):
    assert not row_of(outcome("paper2.fig05", verdicts, panel(*references))).held


def test_a_table_is_held_by_its_statements():
    assert row_of(outcome("paper2.table1", [CLAIM]), name="table 1").held
    broken = [CLAIM, replace(CLAIM, check="claim:d", passed=False)]
    assert not row_of(outcome("paper2.table1", broken), name="table 1").held


def test_a_panel_that_was_not_run_is_not_held_and_remarks_are_shown():
    assert not any(row.held for row in thesis.panels(sample()))
    full = outcome("paper3.fig02", checks("a"), panel("a", name="b"))
    row = row_of(full, 3, "2b")
    assert row.held
    assert "coarse mesh" in row.remark


def test_statements_are_listed_with_their_verdicts():
    false = replace(CLAIM, check="claim:d", passed=False)
    run = sample(outcome("paper2.fig05", [CLAIM, *checks("a")]), outcome("paper2.fig06", [false]))
    assert [(case.id, v.passed) for case, v in thesis.statements(run)] == [
        ("paper2.fig05", True),
        ("paper2.fig06", False),
    ]


@pytest.mark.parametrize("check", ["paths_a_0.25:rho", "states_a_0.5"])
def test_a_path_counts_only_by_the_checks_of_its_point(check):
    """Point 0.5 of the material is drawn; a check of another point or of a state says nothing about it."""
    drawn = replace(panel("a"), paths=[PathOutcome(0.5, [0.0], [1.0])])
    own = replace(verdict("paths_a_0.5"), reference="paths_profiles")
    other = replace(verdict(check), reference="paths_profiles")
    for found, compared in (([own, other], 2), ([other], 1)):
        row = row_of(outcome("paper2.fig05", [*checks("a"), *found], drawn))
        assert (row.drawn, row.compared) == (2, compared)


def test_nothing_is_drawn_or_compared_for_a_case_that_was_not_run():
    rows = thesis.panels(sample())
    assert {(row.drawn, row.compared, row.statements, row.failed, row.run, row.held) for row in rows} == {
        (0, 0, 0, 0, False, False)
    }
