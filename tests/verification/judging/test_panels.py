"""What a panel shows is what was solved: lines, dashes, reference marks, special points, profiles."""

import numpy as np
import pytest

from weakforms.cases import Axis, Curve, Panel, Path, circular, reference, tube
from weakforms.results import Branch, Field, Quantity, Result, SpecialPoint, State
from weakforms.verification.cases.panels import Dashed, Line, Surface
from weakforms.verification.cases.specs import At
from weakforms.verification.judging import panels, surfaces
from weakforms.verification.judging.panels import draw_panel
from weakforms.verification.run.solutions import Solutions

TUBE = tube(alpha=0.1, delta1=1.1)
NAME = "fig03a_delta1_1.1"
TABLE = reference(2, NAME)
TRACE = {
    "u_max": np.array([0.0, 0.5, 1.0, 1.5, 2.0]),
    "p": np.array([0.0, 1.0, 1.5, 1.25, 1.75]),
    "n_negative": np.array([0, 0, 1, 2, 0]),
    "n_other": np.array([0, 0, 0, 1, 1]),
}
X, Y = Axis("u_max", 0.0, 4.0), Axis("p", 0.5, 2.5, "P")


def solutions(states=(), points=(), fields=(), columns=None):
    result = Result("tube", {}, {}, {}, {}, [Branch("primary", "p", dict(columns or TRACE))])
    result.states = [
        State({name: value}, "primary", {n: Quantity(v, 1e-3) for n, v in numbers.items()}, fields)
        for name, value, numbers in states
    ]
    result.special_points = list(points)
    return Solutions({TUBE: result})


def panel(*curves, **more):
    return Panel("a", X, Y, curves, **more)


def test_a_branch_without_a_table_is_its_trace():
    drawn = draw_panel(2, panel(Curve(TUBE, "this one"), title="A", level=1.5, note="why"), solutions())
    assert (drawn.name, drawn.title, drawn.level, drawn.note, drawn.drawn) == (
        "a",
        "A",
        1.5,
        "why",
        "weak form",
    )
    assert (drawn.x, drawn.y, drawn.x_range, drawn.y_range) == ("u_max", "p", (0.0, 4.0), (0.5, 2.5))
    assert (drawn.x_label, drawn.y_label) == ("$u_{max}$", "P")
    (curve,) = drawn.curves
    assert (curve.label, curve.x, curve.y) == ("this one", [*TRACE["u_max"]], [*TRACE["p"]])
    assert curve.unstable == [False, False, True, True, False]
    assert curve.reference_x == curve.residual == []


def test_negative_eigenvalues_are_counted_over_several_columns():
    drawn = draw_panel(2, panel(Curve(TUBE, ""), counted=("n_negative", "n_other")), solutions())
    assert drawn.curves[0].unstable == [0, 0, 1, 3, 1]
    assert (drawn.dashed, drawn.dotted) == ("one negative eigenvalue", "more of them")


def test_states_lie_between_the_points_of_the_trace_and_the_table_beside_them():
    rows = TABLE.columns["u_max"]
    states = [("u_max", float(u), {"u_max": u, "p": 10 + u}) for u in rows[::-1] if u < 2]
    curve = Curve(TUBE, "", NAME, asked={"p": 1e-6})
    (drawn,) = draw_panel(2, panel(curve), solutions(states)).curves
    known = np.array([[u, 10 + u] for u in rows if u < 2])
    line = np.array([drawn.x, drawn.y]).T
    assert len(line) == len(TRACE["p"]) + len(known)
    assert (np.diff(line[:, 0]) >= 0).all()
    kept = line[line[:, 1] > 5]
    np.testing.assert_array_equal(kept, known)
    after = {u: n for (u, p), n in zip(line, drawn.unstable, strict=True) if p > 5}
    assert [after[u] for u in (0.25, 0.75, 1.25, 1.75)] == [False, False, True, True]
    assert (drawn.reference_name, drawn.reference_kind) == (NAME, "independent")
    assert (drawn.reference_x, drawn.reference_y) == ([*rows], [*TABLE.columns["p"]])
    assert drawn.residual == [], "states are missing, so nothing can be compared"


def test_the_residual_is_that_of_the_drawn_column():
    numbers = {name: TABLE.columns[name] for name in ("u_max", "p", "V")}
    states = [
        ("u_max", float(u), {"u_max": u, "p": 1.01 * p, "V": v})
        for u, p, v in zip(*numbers.values(), strict=True)
    ]
    curve = Curve(TUBE, "", NAME, asked={"V": 1e-3, "p": 1e-3})
    (drawn,) = draw_panel(2, panel(curve), solutions(states)).curves
    size = np.abs(TABLE.columns["p"]).max()
    np.testing.assert_allclose(drawn.residual, 0.01 * TABLE.columns["p"] / size, rtol=1e-9)
    np.testing.assert_allclose(drawn.residual_bound, 2e-3 / size, rtol=1e-6)
    assert (drawn.residual_abscissa, drawn.residual_x) == ("$u_{max}$", [*TABLE.columns["u_max"]])


def test_a_falling_branch_takes_states_in_its_own_order():
    falling = {name: values[::-1] for name, values in TRACE.items()}
    states = [("u_max", float(u), {"u_max": u, "p": 10 + u}) for u in TABLE.columns["u_max"] if u < 2]
    curve = Curve(TUBE, "", NAME, asked={"p": 1e-6})
    (drawn,) = draw_panel(2, panel(curve), solutions(states, columns=falling)).curves
    assert (np.diff(drawn.x) <= 0).all()


def test_what_was_not_solved_is_missing_and_the_rest_is_drawn():
    lost = Curve(tube(alpha=0.2), "lost")
    drawn = draw_panel(2, panel(lost, Curve(TUBE, "kept")), solutions())
    assert [curve.label for curve in drawn.curves] == ["kept"]


@pytest.mark.parametrize(("with_curve", "says"), [(False, "exact"), (True, "weak form")])
def test_exact_lines_come_first(with_curve, says):
    line = Line("exact", (0.0, 1.0), (2.0, 3.0))
    curves = [Curve(TUBE, "solved")] if with_curve else []
    drawn = draw_panel(2, panel(*curves, lines=(line,)), solutions())
    assert [c.label for c in drawn.curves] == ["exact", *(c.label for c in curves)]
    assert (drawn.curves[0].name, drawn.curves[0].x, drawn.curves[0].y) == ("exact", [0.0, 1.0], [2.0, 3.0])
    assert drawn.drawn == says


@pytest.mark.parametrize("kinds", ["limit_point", ("bifurcation_n1", "limit_point")])
def test_special_points_of_the_drawn_branch_are_marked(kinds):
    points = [
        SpecialPoint("limit_point", "primary", "p", {"u_max": 0.8, "p": 1.6}, {}),
        SpecialPoint("limit_point", "secondary", "p", {"u_max": 0.9, "p": 1.7}, {}),
        SpecialPoint("bifurcation_n1", "primary", "p", {"u_max": 1.1, "p": 1.4, "n": 1.0}, {}),
    ]
    marks = draw_panel(2, panel(Curve(TUBE, ""), markers=kinds), solutions(points=points)).markers
    found = {m.kind: (m.label, m.x, m.y) for m in marks}
    assert len(marks) == len(found) == (1 if isinstance(kinds, str) else 2)
    assert found["limit_point"][1:] == (0.8, 1.6)
    assert found["limit_point"][0] == "limit point"
    assert found.get("bifurcation_n1", ("n = 1", 1.1, 1.4)) == ("n = 1", 1.1, 1.4)


def test_a_branch_in_long_steps_passes_through_its_marked_points():
    """The peak of a parabola of three points; a count is that before it, and ends are not passed.

    A point without a value, as of contact before there is any, is next to nothing.
    """
    columns = {"u_max": [np.nan, 0.0, 1.0, 2.0], "p": [0.0, 0.0, 1.5, 0.0], "n_negative": [0, 0, 0, 1]}
    points = [
        SpecialPoint("limit_point", "primary", "p", {"u_max": u, "p": p}, {})
        for u, p in ((1.25, 1.6), (2.2, -1))
    ]
    given = solutions(points=points, columns={name: np.array(v) for name, v in columns.items()})
    (drawn,) = draw_panel(2, panel(Curve(TUBE, ""), markers="limit_point"), given).curves
    assert (drawn.x[1:], drawn.y[1:]) == ([0.0, 1.0, 1.25, 2.0], [0.0, 1.5, 1.6, 0.0])
    assert drawn.unstable == [False, False, False, False, True]
    (bare,) = draw_panel(2, panel(Curve(TUBE, "")), given).curves
    assert bare.x[1:] == [0.0, 1.0, 2.0], "no points are marked in this panel"


# -- profiles ----------------------------------------------------------------------------------------

PROFILE = Field(
    "profile",
    {"Z": np.array([0.0, 1.0, 3.0]), "rho": np.array([2.0, 1.5, 1.0]), "t2": np.array([0.5, -0.5, 0.1])},
    {"Z": 0.0, "rho": 1e-9, "t2": 1e-9},
)
SHAPE = Curve(TUBE, "", at=At("p", 1.5))


def profile(**more):
    given = Panel("b", Axis("Z", 0.0, 8.0), Axis("rho", 0.0, 3.0), (SHAPE,), **more)
    return draw_panel(2, given, solutions([("p", 1.5, {"Z_front": 2.0})], fields=(PROFILE,)))


def test_a_profile_is_that_of_its_state():
    (drawn,) = profile().curves
    assert (drawn.x, drawn.y, drawn.unstable) == ([0.0, 1.0, 3.0], [2.0, 1.5, 1.0], [])


def test_a_profile_is_dashed_where_a_column_is_below_a_value():
    shown = profile(dashed=Dashed("t2", 0.1, "taut", "compressed"))
    assert shown.curves[0].unstable == [False, True, False]
    assert (shown.full, shown.dashed) == ("taut", "compressed")


def test_a_mirrored_profile_goes_from_end_to_end():
    (drawn,) = profile(mirrored=True, dashed=Dashed("t2", 0.1, "", "")).curves
    assert drawn.x == [1.0, 3.0, 4.0, 5.0, 7.0]
    assert drawn.y == [1.0, 1.5, 2.0, 1.5, 1.0]
    assert drawn.unstable == []


def test_the_edge_of_contact_lies_on_the_profile():
    (mark,) = profile(edge="Z_front").markers
    assert (mark.kind, mark.label, mark.x, mark.y) == ("contact_edge", "", 2.0, 1.25)
    assert profile().markers == []


# -- paths of material points ------------------------------------------------------------------------

DISK = circular(alpha=0.1, beta=1, contact="frictionless")
POINTS = (0.1, 0.9)
STATES = reference(1, "paths_fig03a").columns["p"]


class Sampled:
    """Coordinates of material points that tell state, point and axis apart."""

    def sampled(self, _spec, at, name):
        """``rho = X + p`` and ``eta = 10 X + p``."""
        return np.array(POINTS) * (1 if name == "rho" else 10) + at.value, 0.0


@pytest.mark.parametrize("mirrored", [False, True])
def test_paths_follow_their_points_through_the_states(mirrored):
    path = Path(DISK, "paths_fig03a", POINTS, {"rho": 1e-8, "eta": 1e-8})
    given = Panel("c", Axis("rho", 0.0, 1.0), Axis("eta", 0.0, 6.0), (), (path,), mirrored=mirrored)
    drawn = draw_panel(1, given, Sampled()).paths
    expected = []
    for point in POINTS:
        rho, eta = (point + STATES).tolist(), 10 * point + STATES
        for side in (1, -1) if mirrored else (0,):
            expected.append((point, rho, (eta if not side else 3.0 + side * eta).tolist()))
    assert [(p.point, p.x, p.y) for p in drawn] == expected


def test_where_a_branch_passes_a_value_first():
    along = np.array([0.0, 1.0, 2.0, 1.0, 3.0])
    assert [panels._passed(along, v) for v in (0.0, 0.5, 1.0, 1.5, 2.5, 3.0, 3.5)] == [
        0,
        0,
        0,
        1,
        3,
        3,
        None,
    ]


# -- surfaces in space -------------------------------------------------------------------------------

AXES = (Axis("x", -3.0, 3.0), Axis("y", -3.0, 3.0), Axis("z", 0.0, 2.0, "h"))


def shown(field, **more):
    given = Surface("s", TUBE, At("p", 1.5, profile=(0.5,)), AXES, title="T", note="N", **more)
    assert surfaces.surface_wants(given) == [(TUBE, At("p", 1.5, profile=(0.5,)))]
    return surfaces.draw_surface(
        given, type("Known", (), {"profile": staticmethod(lambda _spec, _at: field)})()
    )


def test_a_meridian_is_turned_about_the_axis():
    meridian = Field(
        "profile",
        {
            "Z": np.array([0.0, 1.0, 2.0]),
            "r": np.array([1.0, 2.0, 3.0]),
            "z": np.array([0.0, 2.0, 2.1]),
            "lam1": np.array([1.0, 1.23456789012, 1.5]),
        },
        {},
    )
    drawn = shown(meridian)
    x, y, z = (np.array(part) for part in drawn.position)
    assert x.shape == (2, 49), "the row above the axis is left out"
    np.testing.assert_allclose(np.hypot(x, y), [[1.0] * 49, [2.0] * 49])
    np.testing.assert_allclose(np.arctan2(y[1], x[1])[12:25:12], [np.pi / 2, np.pi])
    np.testing.assert_allclose([x[1, -1], y[1, -1]], [2.0, 0.0], atol=1e-12)
    np.testing.assert_array_equal(z, [[0.0] * 49, [2.0] * 49])
    assert drawn.fields["lam1"][1] == [1.23456789] * 49
    assert set(drawn.fields) == {"Z", "r", "lam1"}
    assert (drawn.ranges[2], drawn.labels[2]) == ((0.0, 2.0), "h")
    assert (drawn.name, drawn.title, drawn.note) == ("s", "T", "N")


@pytest.mark.parametrize("by", [0.0, 0.5])
def test_a_field_is_put_on_its_grid_and_displaced_by_its_mode(by):
    z, theta = (v.ravel() for v in np.meshgrid([0.0, 1.0], [0.0, 1.0, 2.0], indexing="ij"))
    mixed = np.array([4, 0, 5, 2, 1, 3])
    columns = {"Z": z, "Theta": theta, "x": 10 * z + theta, "y": theta, "z": z}
    columns |= {"u_x": 0 * z + 2.0, "u_y": 0 * z, "u_z": theta, "T2": z - theta}
    drawn = shown(Field("surface", {n: v[mixed] for n, v in columns.items()}, {}), displaced=by)
    grid = np.arange(3.0)
    np.testing.assert_array_equal(drawn.position[0], [grid + 2 * by, 10 + grid + 2 * by])
    np.testing.assert_array_equal(drawn.position[1], [grid, grid])
    np.testing.assert_array_equal(drawn.position[2], [by * grid, 1 + by * grid])
    np.testing.assert_array_equal(drawn.fields["T2"], [-grid, 1 - grid])
