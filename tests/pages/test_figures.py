"""What figures reckon about their texts before they are drawn agrees with what is drawn."""

import numpy as np
import pytest
from matplotlib.transforms import Bbox

from weakforms.verification.report import figures

LABELS = (r"$\lambda_{1,\mathrm{mid}} = 1.5$", "path of a material point", "a", "$p$", "reference (exact)")


@pytest.mark.parametrize("columns", [1, 2, 3, 5])
def test_a_legend_has_the_width_that_was_reckoned(columns):
    with figures.drawing("f"):
        keys = [figures._key(label, i) for i, label in enumerate(LABELS)]
        figure, _ = figures._with_legend([keys[:1]], 4.0, 3.0, 0.0)
        pen = figures._ruler(figure)
        handles = figures._by_rows(keys, columns)
        legend = figure.legend(handles=handles, ncols=columns)
        reckoned = figures._legend_width([figures._key_width(figure, key, pen) for key in keys], columns)
        assert reckoned == pytest.approx(legend.get_window_extent(pen).width, abs=0.5)


@pytest.mark.parametrize("covered", range(8))
def test_a_label_stands_in_the_box_that_was_chosen(covered):
    with figures.drawing("f"):
        figure, _ = figures._with_legend([], 4.0, 3.0, 0.5)
        axes = figures._axes(figure, 0.5, 2.0)
        pen = figures._ruler(figure)
        place = axes.transData.transform((0.5, 0.5))
        sides = [side for k, side in enumerate(figures.SIDES) if k != covered]
        taken = np.array([place + 14 * np.array(side) for side in sides])
        box = figures._label(axes, (0.5, 0.5), "$p_1$", taken, [], pen)
        drawn = axes.texts[-1].get_window_extent(pen).padded(1.5)
        assert np.allclose(Bbox(box).get_points(), drawn.get_points(), atol=1e-6)
        assert not np.any(np.all((taken >= box.min) & (taken <= box.max), axis=1))
