"""Points of lines on several meshes: near a side of the window, located by a resultant, on too few cells."""

import pytest

from weakforms import solve
from weakforms.errors import ConvergenceError
from weakforms.problems.diagram.window import MARGIN, Window

BENDING = {"kind": "n1", "x": "lf", "alpha": 0.03, "u_end": 1.5}
"""Its second line begins at the lower side of the window, and is wrinkled from about ``lf = 7.11``."""


def onsets(**given):
    found = solve("diagram", **BENDING, **given)
    assert not found.failures
    return found.points("wrinkling_n1")


@pytest.mark.slow
def test_a_point_outside_of_the_window_on_the_coarsest_mesh_is_found():
    """On 8 cells the least resultant is too small by 0.04: the tube is wrinkled at ``lf = 7`` already."""
    (point,) = onsets(low=7.0, high=8.5, numerics={"degree": 3, "cells": 32, "step": 0.3})
    (fine,) = onsets(low=7.0, high=7.2, numerics={"degree": 6, "cells": 32, "levels": 2, "step": 0.3})
    for name in ("p", "lf", "u_max"):
        error = abs(point.values[name] - fine.values[name])
        assert error <= 2 * point.uncertainty[name] + fine.uncertainty[name], name


def test_a_point_inside_of_the_window_on_the_coarser_mesh_alone_is_left_out():
    numerics = {"degree": 3, "cells": 32, "levels": 2, "step": 0.3}
    (point,) = onsets(low=7.0, high=7.5, numerics=numerics)
    between = point.values["lf"] + point.uncertainty["lf"] / 6  # a half of the difference of both meshes
    assert onsets(low=between, high=7.5, numerics=numerics) == []


def test_a_window_with_its_margin():
    window = Window("lf", 7.0, 10.0, 0.0, 2.0, 1.5)
    assert window.wider() == Window(
        "lf", 7 - 3 * MARGIN, 10 + 3 * MARGIN, 0.0, 2 * (1 + MARGIN), 1.5 * (1 + MARGIN)
    )
    inside = {"lf": 7.0, "p": 2.0, "u_max": 1.5}
    assert window.outside(inside, "u_max") == []
    for name, side, beyond in (
        ("lf", 7.0, 6.99),
        ("lf", 10.0, 10.01),
        ("p", 2.0, 2.01),
        ("u_max", 1.5, 1.51),
    ):
        assert window.outside(inside | {name: beyond}, "u_max") == [(name, side)]


@pytest.mark.slow
def test_a_point_located_by_a_resultant_has_the_order_of_the_resultant():
    """``delta1`` turns near the second onset, so that its last difference is small by accident."""
    given = {"kind": "mirror", "alpha": 0.0, "lf": 5.60665696579963, "u_end": 3.0}
    coarse = solve("diagram", **given, numerics={"degree": 3, "cells": 16, "step": 0.3}).points(
        "wrinkling_mirror"
    )[1]
    fine = solve("diagram", **given, numerics={"degree": 5, "cells": 48, "levels": 2, "step": 0.3})
    truth = fine.points("wrinkling_mirror")[1]
    error = abs(coarse.values["delta1"] - truth.values["delta1"])
    assert error <= 2 * coarse.uncertainty["delta1"] <= 1e-3


def test_too_few_cells_for_the_critical_points_are_said_to_be_too_few():
    """On one of the meshes Newton's method does not find one that no finer mesh has."""
    given = {"kind": "mirror", "alpha": 0.0, "lf": 7.858983834274113}
    with pytest.raises(ConvergenceError, match=r"delta1 = 1: .*of kind mirror.*: raise cells"):
        solve("diagram", **given, numerics={"degree": 3, "cells": 16})


def test_an_order_that_is_low_by_accident_does_not_widen_a_column():
    """On these meshes ``u_max`` of the second point has errors of -5.9e-5, -2.8e-5 and -8.0e-7."""
    given = {"kind": "fold", "alpha": 0.10087719056755304, "lf": 7.514857112430036, "high": 1.4, "u_end": 3.5}
    (point,) = solve("diagram", **given, numerics={"degree": 3, "cells": 16}).points("fold_mirror")
    assert 8.0e-7 <= point.uncertainty["u_max"] <= 30 * 8.0e-7
