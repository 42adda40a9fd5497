"""What figures reckon about their texts before they are drawn agrees with what is drawn."""

import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from matplotlib.transforms import Bbox

from weakforms.verification.report.figures import canvas, points, svg
from weakforms.verification.report.figures import legend as legends

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
