"""Regions of a two-parameter diagram: the parts of a branch between the lines that it crosses."""

import numpy as np
import pytest
from matplotlib import pyplot

from weakforms.results import Branch, Result, SpecialPoint
from weakforms.results.diagram import LOOKS, Crossing, draw_diagram, states_between

FIRST = Crossing("fold", 1.0, 1.9, 0)
END = Crossing("end", 3.0, 2.5, 0)


def test_no_two_kinds_of_line_look_alike():
    assert len({(str(style), colour) for style, colour in LOOKS.values()}) == len(LOOKS)


def test_a_limit_point_adds_a_negative_eigenvalue_and_the_next_one_takes_it_away():
    last = Crossing("fold", 2.0, 1.5, 0)
    assert states_between([FIRST, last, END], 0.1) == [(0.1, 1.9, 0), (1.9, 1.5, 1), (1.5, 2.5, 0)]


def test_mirror_breaking_counts_besides_limit_points():
    mirror = Crossing("mirror", 1.5, 1.7, 0)
    found = states_between([FIRST, mirror, END], 0.1)
    assert [count for *_, count in found] == [0, 1, 2]


@pytest.mark.parametrize(
    "crossings",
    [
        [Crossing("fold", 1.0, 1.9, 2), END],  # two others before the first: lines are missing
        [FIRST],  # where the branch ends is not known
    ],
)
def test_a_missing_line_leaves_the_regions_open(crossings):
    assert states_between(crossings, 0.1) == []


# -- the picture -------------------------------------------------------------------------------------------


@pytest.fixture
def plane():
    """Two lines of limit points that exist up to alpha = 0.6 and end in a cusp, and the end of branches."""
    alpha = np.linspace(0.0, 1.0, 21)
    part, nothing = alpha[alpha < 0.61], np.zeros(13)
    top, bottom = 2.0 + nothing, 1.0 + 1.6 * part
    lines = {
        "fold": (part, top, 1 + nothing),
        "fold_2": (part, bottom, 2 + nothing),
        "end": (alpha, 3.0 + 0 * alpha, 3 + 0 * alpha),
    }
    branches = [
        Branch(
            name,
            "alpha",
            {"alpha": along, "p": p, "u_max": depth, "n_negative": np.zeros(len(p))},
            dict.fromkeys(("p", "u_max"), np.zeros(len(p))),
        )
        for name, (along, p, depth) in lines.items()
    ]
    cusp = SpecialPoint("cusp_point", "fold", "alpha", {"alpha": 0.6, "p": 1.96, "u_max": 1.5}, {})
    given = {"body": "tube", "vary": "alpha", "low": 0.0, "high": 1.0, "p_low": 0.1}
    return Result("diagram", given, {"p": "P R_f/(C1 h_o)"}, {}, {}, branches, [cusp])


def texts(plane, x, y):
    figure = draw_diagram(plane, x, y)
    axes = figure.axes[0]
    found = {text.get_text(): text.get_position() for text in axes.texts}
    regions = len(axes.collections)
    names = [text.get_text() for text in axes.get_legend().get_texts()]
    pyplot.close(figure)
    return found, regions, names


def test_a_result_with_a_diagram_draws_it_in_its_plane(plane):
    """``plot r.json`` as the verb ``diagram`` does: not the parameter over the pressure, and with regions."""
    plane.parameters |= {"x": "alpha", "y": "p"}
    axes = plane.plot().axes[0]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("alpha", "p:  P R_f/(C1 h_o)")
    assert len(axes.collections) >= 2
    assert plane.plot("u_max", "p").axes[0].get_xlabel() == "u_max"
    assert plane.plot("u_max").axes[0].get_xlabel() == "u_max"
    assert plane.plot(y="u_max").axes[0].get_ylabel() == "u_max"
    plane.parameters |= {"x": "beta"}  # of a file that was changed: no such column
    assert plane.plot().axes[0].get_ylabel() == "alpha"


def test_a_region_is_named_by_its_negative_eigenvalues_where_it_is(plane):
    found, regions, names = texts(plane, "alpha", "p")
    assert names == ["fold", "end", "cusp point"]
    assert set(found) == {"0", "0, 1, 0"}
    assert regions >= 2, "each region has its own colour"
    alpha, p = found["0, 1, 0"]  # between the lines of limit points, where they are farthest apart
    assert 0 < alpha < 0.2
    assert 1.0 + 1.6 * alpha < p < 2.0
    alpha, p = found["0"]
    assert alpha > 0.6 or not 1.0 + 1.6 * alpha < p < 2.0


@pytest.mark.parametrize(("x", "y"), [("p", "alpha"), ("alpha", "u_max")])
def test_regions_are_those_of_the_parameter_and_the_pressure(plane, x, y):
    assert texts(plane, x, y)[:2] == ({}, 0)
