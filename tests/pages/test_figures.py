"""Figures show what they are given, and what they reckon about their texts agrees with what is drawn."""

import math
import re
import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest
from canned_run import CurveOutcome, Marker, curve, panel
from hypothesis import example, given
from hypothesis import strategies as st
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

from weakforms.verification.report.figures import canvas, points, residuals, svg
from weakforms.verification.report.figures import legend as legends
from weakforms.verification.report.figures import panel as panels
from weakforms.verification.report.figures.convergence import convergence_figure
from weakforms.verification.report.figures.panel import panel_figure

LABELS = (r"$\lambda_{1,\mathrm{mid}} = 1.5$", "path of a material point", "a", "$p$", "reference (exact)")


@pytest.mark.parametrize("columns", [1, 2, 3, 5])
def test_a_legend_has_the_width_that_was_computed(columns):
    with canvas.drawing("f"):
        keys = [legends.key(label, i) for i, label in enumerate(LABELS)]
        figure, _ = legends.with_legend([keys[:1]], 4.0, 3.0, 0.0)
        pen = canvas.new_ruler(figure)
        handles = legends._by_rows(keys, columns)
        legend = figure.legend(handles=handles, ncols=columns)
        computed = legends._legend_width([legends._key_width(figure, key, pen) for key in keys], columns)
        assert computed == pytest.approx(legend.get_window_extent(pen).width, abs=0.5)


@pytest.mark.parametrize("covered", range(8))
def test_a_label_stands_in_the_box_that_was_chosen(covered):
    with canvas.drawing("f"):
        figure, _ = legends.with_legend([], 4.0, 3.0, 0.5)
        axes = canvas.new_axes(figure, 0.5, 2.0)
        pen = canvas.new_ruler(figure)
        place = axes.transData.transform((0.5, 0.5))
        sides = [side for k, side in enumerate(points.SIDES) if k != covered]
        taken = np.array([place + 14 * np.array(side) for side in sides])
        box = points._label(axes, (0.5, 0.5), "$p_1$", taken, [], pen)
        drawn = axes.texts[-1].get_window_extent(pen).padded(1.5)
        assert np.allclose(Bbox(box).get_points(), drawn.get_points(), atol=1e-6)
        assert not np.any(np.all((taken >= box.min) & (taken <= box.max), axis=1))


def followed(path):
    """The points of a path, one list for each part, in hundredths."""
    parts, here = [], (0, 0)
    for command, numbers in re.findall("([MlLz])([^MlLz]*)", path):
        values = [round(100 * float(text)) for text in re.findall(r"-?(?:\d+\.?\d*|\.\d+)", numbers)]
        for x, y in zip(values[::2], values[1::2], strict=True):
            here = (here[0] + x, here[1] + y) if command == "l" else (x, y)
            if command == "M":
                parts.append([])
            if parts[-1][-1:] != [here] or len(parts[-1]) == 1:
                parts[-1].append(here)
        if command == "z":
            here = parts[-1][0]
            parts[-1].append("closed")
    return parts


@given(
    st.lists(
        st.tuples(
            st.lists(st.tuples(st.floats(-900, 900), st.floats(-900, 900)), min_size=2, max_size=9),
            st.booleans(),
        ),
        min_size=1,
        max_size=3,
    )
)
@example([([(0.0, 0.0), (0.0, 0.0)], False), ([(1.5, -0.01), (1.5, 0.0), (1.5, 0.0), (-2.0, 3.0)], True)])
def test_short_paths_have_the_points_of_the_long_ones(parts):
    text = " ".join(
        "M " + " L ".join(f"{x:.6f} {y:.6f}" for x, y in points) + " z" * closed for points, closed in parts
    )
    short = svg._differences(text)
    assert followed(short) == followed(text)
    assert len(short) < len(text) * 0.8


def test_equal_marks_become_one_path_with_the_same_shape_at_the_same_places():
    places = [(1.0, 2.0), (3.0, 5.0), (4.0, 4.0), (9.0, 1.0)]
    uses = "".join(f'<use href="#m" x="{x}" y="{y}"/>' for x, y in places)
    root = ET.fromstring(
        f'<svg><defs><path id="m" d="M0 0L1 1" style="fill: red"/></defs><g>{uses}</g></svg>'
    )
    svg._with_markers(root)
    assert list(root.iter("use")) == []  # each mark is drawn once
    (marker,) = root.iter("marker")
    (shape,) = marker
    assert shape.attrib == {"d": "M0 0L1 1", "style": "fill: red"}
    (path,) = (path for path in root.iter("path") if "marker-start" in path.attrib)
    assert {path.get(f"marker-{at}") for at in ("start", "mid", "end")} == {f"url(#{marker.get('id')})"}
    assert path.get("d") == "M" + "L".join(f"{x} {y}" for x, y in places)


def test_figures_are_valid_deterministic_and_themed(run):
    picture = run.cases[0].panels[0]
    first = panel_figure(picture, "f1", run.cases[0].verdicts)
    assert first == panel_figure(picture, "f1", run.cases[0].verdicts)
    root = ET.fromstring(first)
    assert root.find("{*}title").text == "Limit points"
    assert "u_max from 0 to 5" in root.find("{*}desc").text
    assert "var(--f-c0,#0b62a4)" in first
    assert all(item.get("id", "f1--").startswith("f1--") for item in root.iter())
    assert "matplotlib" not in first
    assert "stroke-dasharray" in first
    ET.fromstring(convergence_figure(run.cases[0].convergence, "f2"))
    ET.fromstring(convergence_figure([], "f3"))


def test_rows_out_of_bound_are_drawn_filled():
    one = CurveOutcome("one", "", [1.0, 2.0], [1.0, 2.0])
    one.residual_x, one.residual = [1.0, 2.0, 3.0, 4.0], [1e-9, 3e-8, 2e-9, 5e-8]
    one.residual_bound = [1e-8, 1e-8, 1e-8, 1e-8]
    axes = Figure().subplots()
    residuals.draw_residuals(axes, panel([one]), [])
    marked = [line for line in axes.lines if line.get_linestyle() == "None"]
    drawn = {line.get_markerfacecolor() == "none": line.get_xydata().tolist() for line in marked}
    assert drawn[True] == [[1.0, 1e-9], [3.0, 2e-9]]
    assert drawn[False] == [[2.0, 3e-8], [4.0, 5e-8]]


def test_of_many_rows_the_worst_of_each_group_are_drawn():
    one = CurveOutcome("one", "", [0.0, 1.0], [0.0, 1.0])
    one.residual_x = [float(k) for k in range(400)][::-1]
    one.residual = [2e-9 if k % 10 == 3 else 1e-9 for k in range(400)][::-1]
    one.residual[-215 - 1] = 5e-8
    one.residual_bound = [1e-8] * 400
    axes = Figure().subplots()
    residuals.draw_residuals(axes, panel([one]), [])
    marked = [line for line in axes.lines if line.get_linestyle() == "None"]
    drawn = {line.get_markerfacecolor() == "none": line.get_xydata().tolist() for line in marked}
    assert drawn[False] == [[215.0, 5e-8]]
    assert drawn[True] == [[10.0 * k + 3, 2e-9] for k in range(40) if k != 21]
    assert "worst of neighbouring rows" in axes.texts[0].get_text()


def test_what_is_unstable_is_drawn_dashed():
    x = [0.0, 1.0, 2.0, 3.0, 4.0]
    one = CurveOutcome("one", "", x, x, unstable=[False, False, False, True, True])
    axes = Figure().subplots()
    panels._draw_curve(axes, one, 0)
    drawn = {line.get_linestyle(): line.get_xdata().tolist() for line in axes.lines if len(line.get_xdata())}
    assert drawn == {"-": [0.0, 1.0, 2.0], "--": [2.0, 3.0, 4.0]}


def test_reference_rows_outside_the_axes_are_left_out():
    one = CurveOutcome(
        "one", "", reference_x=[0.0, 1.0, 2.0, 3.0], reference_y=[10.0, 11.0, 12.0, 13.0], x=[], y=[]
    )
    axes = Figure().subplots()
    axes.set(xlim=(0.5, 2.5), ylim=(9.0, 14.0))
    panels._draw_curve(axes, one, 0)
    assert axes.lines[-1].get_xydata().tolist() == [[1.0, 11.0], [2.0, 12.0]]


def test_odd_panels_are_drawn():
    one = CurveOutcome("one", "one point", [1.8], [2.0], residual_x=[1.0], residual=[0.0])
    odd = replace(panel([one, curve("two", 1.1)]), x_range=(0.0, 0.0), y_range=(math.nan, 1.0))
    odd.markers = [Marker("front", "lost", math.nan, 1.0)]
    ET.fromstring(panel_figure(odd, "odd"))
    many = panel([replace(curve(f"c{i}", 1.0 + i / 30), reference_x=[]) for i in range(20)])
    ET.fromstring(panel_figure(many, "many"))
