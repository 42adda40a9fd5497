"""Material laws on surfaces: by invariants of the metric, refused if unsound, the papers' own law."""

import re

import numpy as np
import pytest
import ufl
from dolfinx import fem
from dolfinx import mesh as dmesh
from mpi4py import MPI

from reference_data.solvers.core import law_metric
from reference_data.solvers.core.contour import derivative
from reference_data.solvers.core.laws import BUILDERS, CONSTANTS, Law, law
from reference_data.solvers.paper5.waves import second_variation as relaxed_second
from reference_data.solvers.paper5.waves import transfer as relaxed_transfer
from weakforms import solve
from weakforms.errors import InputError
from weakforms.forms.materials import MATERIALS, surface_law
from weakforms.forms.materials.surface import LAWS, pair_of_powers
from weakforms.forms.relaxed_surface import state
from weakforms.forms.wrinkling import surface_tension_field, tension_field
from weakforms.problems.liquid_tube.branch import FluidPath
from weakforms.problems.liquid_tube.model import TubeData
from weakforms.problems.material_choice import Chosen
from weakforms.problems.wrinkled.body import CYLINDER
from weakforms.problems.wrinkled.membrane import Membrane
from weakforms.problems.wrinkled.problem import NEAR_FRONTS, PAPER_GAMMA
from weakforms.problems.wrinkled.waves.modes import waves_at
from weakforms.solvers.equilibrium.constraints import Held

MESH = dmesh.create_unit_interval(MPI.COMM_SELF, 1)

STATES = ((1.5, 1.5), (1.0, 1.0), (2.3, 1.1), (1.1, 2.3), (1.5, 1.5 * 1.22), (1.5, 1.5 * 1.225), (0.8, 2.0))
"""Principal stretches: equal, apart, and to both sides of where the series is left."""


def evaluated(expression, unknown, at):
    found = fem.Expression(expression, np.array([[0.5]]))
    out = []
    for values in at:
        unknown.value[:] = values
        out.append(found.eval(MESH, np.array([0], dtype=np.int32)).ravel().copy())
    return np.array(out)


def jet(energy, at):
    """Value, gradient and Hessian in ``(C11, C22, C12)``, ``C12 = C21``."""
    c = fem.Constant(MESH, np.ones(3))
    v = ufl.variable(c)
    w = energy(v[0] + v[1], v[0] * v[1] - v[2] ** 2)
    first = ufl.diff(w, v)
    second = ufl.diff(first, v)
    parts = [w, *(first[i] for i in range(3)), *(second[i, j] for i in range(3) for j in range(3))]
    return evaluated(ufl.as_vector(parts), c, at)


def by_stretches(model, l1, l2):
    """The same at ``C12 = 0`` from the reference's law in the principal stretches."""
    m = law(model)
    w1, w2 = m.slope(l1, l2), m.slope(l2, l1)
    f11 = (m.curvature(l1, l2) - w1 / l1) / (4 * l1**2)
    f22 = (m.curvature(l2, l1) - w2 / l2) / (4 * l2**2)
    f12, f1, f2 = m.mixed(l1, l2) / (4 * l1 * l2), w1 / (2 * l1), w2 / (2 * l2)
    fy = f11 - f12 if l1 == l2 else (f1 - f2) / (l1**2 - l2**2)
    return np.array([m.energy(l1, l2), f1, f2, 0, f11, f12, 0, f12, f22, 0, 0, 0, 2 * fy])


def of_defaults(model):
    return surface_law(model, {n: fem.Constant(MESH, float(v)) for n, v in constants(model).items()})


def constants(model):
    """The tables' constants; those a table leaves out are zero."""
    return {n: CONSTANTS[model].get(n, 0.0) for n in MATERIALS[model].constants}


@pytest.mark.parametrize("model", LAWS)
def test_a_law_in_the_invariants_is_the_law_in_the_stretches(model):
    states = [s for s in STATES if model not in ("harmonic",) or max(s) < 2.2]
    found = jet(of_defaults(model).invariants, [(a**2, b**2, 0.0) for a, b in states])
    for values, (a, b) in zip(found, states, strict=True):
        expected = by_stretches(model, a, b)
        assert values == pytest.approx(expected, abs=1e-11 * max(1.0, abs(expected).max()))


@pytest.mark.parametrize("model", ["ogden", "gent"])
def test_the_frame_does_not_matter_where_the_stretches_coincide(model):
    """Nearly equal stretches in turned directions: the stress turns with them, and so does the tangent."""
    energy, gap = of_defaults(model).invariants, 1e-5
    for angle in (0.3, 1.1):
        c, s = np.cos(angle), np.sin(angle)
        a, b = 1.44 * (1 + gap), 1.44 * (1 - gap)
        turned = (a * c * c + b * s * s, a * s * s + b * c * c, (a - b) * c * s)
        one, other = jet(energy, [turned, (a, b, 0.0)])
        stress = np.array([[one[1], one[3] / 2], [one[3] / 2, one[2]]])
        back = np.array([[c, s], [-s, c]]) @ stress @ np.array([[c, -s], [s, c]])
        assert back == pytest.approx(np.diag(other[1:3]), abs=1e-12)
        # The second derivative along a turn of equal stretches: f11 - f12 - 2 fy = 0 there, and of the order
        # of their gap beside it.
        assert one[4] - one[5] - one[12] / 2 == pytest.approx(0, abs=gap)


@pytest.mark.parametrize("p", [0.65, 2.5, -1.0, 0.5, 7.3, -8.0, 25.0, -30.0])
def test_a_pair_of_powers_has_two_right_derivatives_on_both_branches(p):
    mesh_s = fem.Constant(MESH, np.array([0.5]))
    v = ufl.variable(mesh_s)
    value = pair_of_powers(2.0 + 0 * v[0], 1 - v[0], fem.Constant(MESH, p))
    first = ufl.diff(value, v)
    second = ufl.diff(first[0], v)
    edge = min(0.04, 0.36 / p**2)
    at = [0.0, edge / 2, edge * 0.999, edge * 1.001, 3 * edge]
    found = evaluated(ufl.as_vector([value, first[0], second[0]]), mesh_s, [[s] for s in at])

    def sum_of_powers(s):
        root = np.sqrt(s)
        return (1 + root) ** p + (1 - root) ** p

    for s, values in zip(at, found, strict=True):
        r = max(3 * edge, 0.02)
        angles = 2 * np.pi * (np.arange(64) + 0.5) / 64
        ring = sum_of_powers(s + r * np.exp(1j * angles))
        for k, factor in enumerate((1, 1, 2)):
            expected = float(np.mean(ring * np.exp(-1j * k * angles)).real * factor / r**k)
            assert values[k] == pytest.approx(expected, rel=1e-8, abs=1e-10)


def test_what_is_not_used_stays_finite():
    """Gent's rubber beyond its limit, where another branch of the form is used: all values are 0."""
    gent = surface_law("gent", {"shear": fem.Constant(MESH, 2.0), "jm": fem.Constant(MESH, 5.0)})
    c = fem.Constant(MESH, np.array([4.0, 0.01]))
    v = ufl.variable(c)
    taut = ufl.gt(v[1], 1.0)
    w = ufl.conditional(taut, gent.where(taut, v[0] + v[1], v[0] * v[1]), 0.0)
    first = ufl.diff(w, v)
    second = ufl.diff(first, v)
    parts = ufl.as_vector([w, first[0], first[1], second[0, 0], second[0, 1], second[1, 1]])
    assert np.all(evaluated(parts, c, [(4.0, 0.01)]) == 0.0)
    assert not np.isfinite(evaluated(gent.invariants(v[0] + v[1], v[0] * v[1]), c, [(4.0, 0.01)]))


# -- problems --------------------------------------------------------------------------------------


def test_the_neo_hookean_law_of_the_catalogue_is_the_papers_tube():
    """State, eigenvalue and functionals of both forms, on a coarse mesh, to round-off."""
    found = []
    for material in (None, Chosen("neo_hookean", ())):
        path = FluidPath(MPI.COMM_SELF, TubeData(8.0, 2.0, 0.116, 0.0, 8, 4, material=material), 1)
        state = path.dry()
        with path.model.system.at(state), path.model.system.weighed_here():
            found.append([*path.model.system.monitors().values(), *path.modes.observe().values()])
    assert found[0] == pytest.approx(found[1], rel=1e-10, abs=1e-10)


@pytest.mark.parametrize(("load", "zw"), [(3.0, "wrinkled all over"), (8.0, "with a taut zone")])
def test_waves_around_a_tube_of_rivlins_series_are_those_of_the_papers_law(load, zw):
    values = {"M": 1.5, "delta": 3.0, "Af": 0.4362, "c2": 0.01, "L": 8.0, "gamma": PAPER_GAMMA}
    series = {n: 0.0 for n in MATERIALS["rivlin"].constants} | {"c10": 1.0, "c01": 0.01}
    eigenvalues = []
    for material in (None, Chosen("rivlin", tuple(series.items()))):
        tube = Membrane(MPI.COMM_SELF, CYLINDER, values, True, (3,), 6, "relaxed", NEAR_FRONTS, material)
        state, _ = tube.by_homotopy(load)
        held = tube.fitted(tube.plain(state), Held("zw", load))[-1]
        with waves_at(held) as waves:
            eigenvalues.append([waves.spectrum(n).eigenvalues[0] for n in (1, 12)])
    assert eigenvalues[0] == pytest.approx(eigenvalues[1], rel=1e-7), zw


@pytest.mark.parametrize(
    ("problem", "given_", "words"),
    [
        ("fluid_tube", {"model": "three_chain"}, "fluid_tube model three_chain allowed ogden gent"),
        ("fluid_tube", {"model": "gent", "alpha": 0.1}, "alpha is not a constant"),
        ("wrinkled_tube", {"model": "harmonic"}, "wrinkled_tube model harmonic allowed three_chain"),
        ("wrinkled_tube", {"model": "three_chain", "n": (5,)}, "waves around model three_chain allowed gent"),
        ("wrinkled_tube_threshold", {"model": "saint_venant_kirchhoff"}, "saint_venant_kirchhoff allowed"),
        ("wrinkled_sheet", {"model": "three_chain"}, "wrinkled_sheet three_chain allowed ogden"),
        ("hemisphere", {"model": "gent", "c2": 0.1}, "c2 is not a constant of model"),
        ("hemisphere", {"model": "harmonic"}, "hemisphere harmonic allowed"),
        ("surface", {"model": "three_chain"}, "surface three_chain allowed gent"),
        ("hemisphere", {"model": "gent", "jm": -1.0}, "jm -1"),
    ],
)
def test_a_law_without_a_sound_form_is_refused_in_one_line(problem, given_, words):
    with pytest.raises(InputError) as error:
        solve(problem, **given_)
    text = str(error.value)
    assert "\n" not in text
    assert all(re.search(re.escape(word), text) for word in words.split()), text


# -- the reference's own derivatives ----------------------------------------------------------------


@pytest.mark.parametrize("model", [m for m in BUILDERS if isinstance(law(m), Law)])
def test_the_references_metric_derivatives_come_from_its_energy(model):
    """f_i by contour integrals around the stretches, and f_y as the slope of f between equal stretches."""
    m = law(model)
    for a, b in ((1.6, 1.2), (1.3, 1.3), (1.3, 1.30001), (0.9, 2.1)):
        found = law_metric.metric(m, a, b)
        f1 = derivative(lambda x, b=b: m.energy(x, b), a, 1) / (2 * a)
        assert found.f1 == pytest.approx(f1, rel=1e-9)
        if abs(a - b) > 0.1:
            f2 = derivative(lambda x, a=a: m.energy(a, x), b, 1) / (2 * b)
            assert found.fy == pytest.approx((f1 - f2) / (a * a - b * b), rel=1e-8)
        elif a == b:
            assert found.fy == pytest.approx(found.f11 - found.f12, rel=1e-9)


def test_the_reference_codes_take_the_papers_law_either_way():
    l1, l2 = np.array([1.5, 2.0, 1.3, 1.4]), np.array([1.5, 1.2, 2.2, 0.5])
    taut = np.array([True, True, True, False])
    same = law("mooney_rivlin", alpha=0.1)
    one, other = (relaxed_transfer.moduli(l1, l2, taut, c2) for c2 in (0.1, same))
    assert one == pytest.approx(other, abs=1e-13)
    pairs = zip(*(relaxed_second.derivatives(l1**2, l2**2, taut, c2) for c2 in (0.1, same)), strict=True)
    assert all(x == pytest.approx(y, abs=1e-13) for x, y in pairs)


# -- relaxed energies on surfaces -------------------------------------------------------------------


@pytest.mark.parametrize("model", ["ogden", "gent", "arruda_boyce", "varga"])
def test_the_relaxed_energy_by_the_metric_is_the_state_table(model):
    """Energy and stress of any law in taut, wrinkled and slack states, in rotated directions."""
    given_ = {n: fem.Constant(MESH, float(v)) for n, v in constants(model).items()}
    surface, pair = surface_law(model, given_), fem.Constant(MESH, np.ones(2))
    stretch = ufl.variable(pair)
    plain = tension_field(MATERIALS[model].energy(given_))(stretch[0], stretch[1])
    slope = ufl.diff(plain, stretch)
    states = [(1.5, 1.2), (2.0, 0.5), (0.6, 1.8), (0.9, 0.8), (1.4, 1.4)]
    expected = evaluated(ufl.as_vector([plain, slope[0], slope[1]]), pair, states)
    c = fem.Constant(MESH, np.eye(2))
    tensor = ufl.variable(ufl.as_tensor([[c[0, 0], c[0, 1]], [c[1, 0], c[1, 1]]]))
    energy = surface_tension_field(tensor, surface)
    stress = ufl.diff(energy, tensor)
    parts = ufl.as_vector([energy, *(stress[i, j] for i in (0, 1) for j in (0, 1))])
    for angle in (0.0, 0.7):
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        found = evaluated(parts, c, [turn @ np.diag([a**2, b**2]) @ turn.T for a, b in states])
        for values, wanted, (a, b) in zip(found, expected, states, strict=True):
            turned = turn.T @ values[1:].reshape(2, 2) @ turn
            assert values[0] == pytest.approx(wanted[0], abs=1e-12)
            assert np.diag(turned) == pytest.approx([wanted[1] / (2 * a), wanted[2] / (2 * b)], abs=1e-6)


@pytest.mark.slow
def test_a_hemisphere_of_gents_rubber_that_hardly_stiffens_is_the_papers():
    """With a large limit Gent's law gives the neo-Hookean results."""
    found = [
        solve("hemisphere", **law_, numerics={"cells": 4, "levels": 2}, at=[("zw", -0.8)])
        for law_ in ({}, {"model": "gent", "shear": 2.0, "jm": 1e8})
    ]
    one, other = (r.states[0].quantities for r in found)
    for name in ("V", "N", "z_pole", "lam_pole", "wrinkled_fraction"):
        assert one[name].value == pytest.approx(other[name].value, rel=1e-6, abs=1e-7)


@pytest.mark.parametrize("model", ["neo_hookean", "gent"])
def test_an_energy_that_is_not_used_is_that_of_rest_if_the_law_is_not_finite_everywhere(model):
    """Gent's energy is infinite at the stretch taken here; UFL multiplies an unused value by zero."""
    constants = {name: ufl.as_ufl(c.default) for name, c in MATERIALS[model].constants.items()}
    of, c = surface_law(model, constants), fem.Constant(MESH, np.ones(2))
    energy = of.where(ufl.lt(c[0], 1.0e4), c[0], c[1])
    (used, far) = evaluated(ufl.as_vector([energy]), c, [(4.0, 3.0), (1.0e6, 2.0e5)])
    (there, rest) = evaluated(ufl.as_vector([of.invariants(c[0], c[1])]), c, [(4.0, 3.0), (2.0, 1.0)])
    assert used == pytest.approx(there)
    assert np.isfinite(far).all()
    assert (far == pytest.approx(rest)) == (model == "gent")


def test_a_compressible_sheet_wrinkles_below_its_own_width():
    """Saint Venant-Kirchhoff: taut where e2 > -nu e1, wrinkled with E e1^2/2, slack without tension."""
    shear, nu = 0.7, 0.4
    law = surface_law(
        "saint_venant_kirchhoff",
        {"shear": fem.Constant(MESH, shear), "poisson": fem.Constant(MESH, nu)},
    )
    c = fem.Constant(MESH, np.eye(2))
    tensor = ufl.variable(ufl.as_tensor([[c[0, 0], c[0, 1]], [c[1, 0], c[1, 1]]]))
    energy = surface_tension_field(tensor, law)
    stress = ufl.diff(energy, tensor)
    parts = ufl.as_vector([energy, *(stress[i, j] for i in (0, 1) for j in (0, 1)), state(tensor, law)])
    young = 2 * (1 + nu) * shear
    # Narrower by less and by more than nu e1: with the width of an incompressible sheet all would be taut.
    strains = {(0.1, 0.05): 1, (0.1, -0.039): 1, (0.1, -0.041): 0, (-0.2, 0.1): 0, (-0.01, -0.1): -1}
    turn = np.array([[np.cos(0.7), -np.sin(0.7)], [np.sin(0.7), np.cos(0.7)]])
    found = evaluated(parts, c, [turn @ np.diag([1 + 2 * a, 1 + 2 * b]) @ turn.T for a, b in strains])
    for values, ((a, b), kind) in zip(found, strains.items(), strict=True):
        if kind == 1:
            energy_ = young / (1 - nu**2) * (a**2 + b**2 + 2 * nu * a * b) / 2
            principal = np.array([a + nu * b, b + nu * a]) * young / (1 - nu**2)
        else:
            top = max(a, b, 0.0)
            energy_, principal = young * top**2 / 2, young * np.array([a, b]).clip(0) * (kind == 0)
        assert values[5] == kind
        assert values[0] == pytest.approx(energy_, abs=1e-14)
        turned = 2 * turn.T @ values[1:5].reshape(2, 2) @ turn
        assert np.diag(turned) == pytest.approx(principal, abs=1e-12)
