"""The picture of a judged column shows what was judged."""

import numpy as np
import pytest

from weakforms.verification.cases import references
from weakforms.verification.cases.panels import Axis, Panel
from weakforms.verification.crosscheck.pictures import picture
from weakforms.verification.crosscheck.rows import ColumnVerdict, JudgedColumn

ROWS = np.array([1.0, 2.0, 3.0])


@pytest.mark.parametrize("of_paper", [True, False])
def test_a_panel_has_the_curve_the_table_and_the_error_of_every_judged_row(of_paper):
    table = references.load(2, "fig03a_delta1_1.1")
    over = table.abscissa
    own = {over: ROWS, "p": 2 * ROWS}
    error = np.array([1e-9, -2e-9, 3e-9])
    judged = JudgedColumn(
        ColumnVerdict("p", "independent", True, "it agrees", column="p"),
        ROWS[::-1],
        ROWS,
        error,
        np.full(3, 1e-8),
    )
    panels = [Panel("a", Axis(over, 0, 9), Axis("p", 1, 4), ())] if of_paper else []
    shown = picture(table, own, judged, panels)
    (curve,) = shown.curves
    assert (curve.x, curve.y) == ([1, 2, 3], [2, 4, 6])
    assert (curve.name, curve.reference_name, curve.reference_kind) == (table.name, table.name, table.kind)
    assert curve.reference_x == table.columns[over].tolist()
    assert curve.reference_y == table.columns["p"].tolist()
    assert (curve.residual_abscissa, curve.residual_x) == (over, [3, 2, 1])
    assert curve.residual == pytest.approx([1e-9, 2e-9, 3e-9])
    assert curve.residual_bound == [1e-8] * 3
    if of_paper:
        assert (shown.x_range, shown.y_range) == ((0, 9), (1, 4))
    else:
        for column, found in ((over, shown.x_range), ("p", shown.y_range)):
            values = np.concatenate([table.columns[column], own[column]])
            margin = 0.03 * (values.max() - values.min())
            assert found == pytest.approx((values.min() - margin, values.max() + margin), rel=1e-12)
