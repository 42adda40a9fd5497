"""Every table passes its own comparison, and no wrong row does."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from curves_of_tables import TUBE, columns_of, verdict_on
from hypothesis import given, settings
from hypothesis import strategies as st

from weakforms import InputError, compare
from weakforms.verification.cases import references
from weakforms.verification.cases.discovery import find_cases
from weakforms.verification.crosscheck.rows import JudgedColumn, judge_column
from weakforms.verification.crosscheck.targets import tables_of


def tables():
    for found in find_cases():
        for name in tables_of(found):
            curves = [c for p in found.case.panels for c in p.curves if c.reference == name]
            yield found, name, {k: v for c in curves for k, v in c.asked.items()}


ALL = list(tables())


@settings(max_examples=20, deadline=None)
@given(st.data())
def test_every_table_passes_itself_and_no_wrong_row_does(data):
    found, name, asked = ALL[data.draw(st.integers(0, len(ALL) - 1))]
    table = references.load_curve(found.paper, name)
    verdicts = compare(found.id, table.columns, name)
    too_coarse = (found.id, name) == ("paper5.fig06", "mode_n_100_zw_3")
    assert verdicts.status == ("not judged" if too_coarse else "passed")
    assert not verdicts.missing
    column = data.draw(st.sampled_from([v.column for v in verdicts.verdicts if v.status == "passed"]))
    row = data.draw(st.integers(0, len(table) - 1))
    size = np.abs(table.columns[column]).max()
    wrong = table.columns[column].copy()
    away = 3 * max(asked[column], 2 * table.uncertainty[column] / (size or 1)) * (size or 1)
    wrong[row] += data.draw(st.sampled_from([-1, 1])) * away
    judged = compare(found.id, {**table.columns, column: wrong}, name, asked[column])
    assert judged.status == "failed"
    (bad,) = [v for v in judged.verdicts if v.status == "failed"]
    assert (bad.column, bad.row) == (column, row + 1)


def test_hardly_a_table_is_too_coarse_for_its_own_case():
    """At the tables' own rows, only these columns are not known accurately enough."""
    left = set()
    for found, name, _ in ALL:
        table = references.load_curve(found.paper, name)
        for verdict in compare(found.id, table.columns, name).verdicts:
            assert verdict.status != "failed"
            if verdict.status == "not judged":
                left.add((found.id, verdict.check))
    assert left == {("paper5.fig06", "mode_n_100_zw_3:meridional")}


def test_a_table_of_few_rows_is_judged_at_them_only():
    which = ("closed_form.test_pieces", "uniaxial_saint_venant_kirchhoff")
    assert len(columns_of(which)["lam"]) == 5
    assert verdict_on(which, columns_of(which)).passed
    with pytest.raises(InputError, match=r"too short to interpolate: give the curve at its own, 1\.1, 1\.2"):
        compare(which[0], columns_of(which, lam=1.001), which[1])


def test_numbers_without_measure_fail_and_leave_no_infinity():
    curve = columns_of(TUBE)
    curve["p"][3] = 1e308
    curve["V"][4] = -1e308
    verdicts = verdict_on(TUBE, curve)
    assert [v.status for v in verdicts.verdicts] == ["failed", "passed", "passed", "failed"]


def test_one_row_beyond_a_wide_bound_is_a_judged_row():
    table = replace(references.load(2, TUBE[1]), uncertainty={"u_max": 0.0, "p": 1.0})
    x = table.columns["u_max"]
    right, wrong = table.columns["p"], table.columns["p"] + 2.5
    numbers = np.arange(1, len(x) + 1)
    assert judge_column(table, "p", x, right, 1e-8, numbers).verdict.status == "not judged"
    assert judge_column(table, "p", x, wrong, 1e-8, numbers).verdict.status == "failed"


def test_a_difference_at_a_zero_of_the_column_is_relative_to_its_floor():
    judged = JudgedColumn(
        SimpleNamespace(scale_floor=0.2), expected=np.array([0.0, 4.0]), error=np.array([0.5, 0.01])
    )
    assert judged.difference == pytest.approx([0.1, 0.04])
