"""Over-filled tubes with an imperfection: forces, coefficients, branches, refusals."""

import numpy as np
import pytest
import ufl
from dolfinx import fem
from mpi4py import MPI
from scipy.interpolate import make_interp_spline

from weakforms import InputError, solve
from weakforms.forms.fluid import Surface, membrane_work, normal
from weakforms.problems.liquid_tube.critical import PrimaryBranch
from weakforms.problems.liquid_tube.imperfect.branch import Axisymmetric, Window, expanded, natural
from weakforms.problems.liquid_tube.imperfect.model import IMPERFECTIONS, Liquid, LiquidSector
from weakforms.problems.meridian.sector import SectorMesh
from weakforms.solvers.equilibrium.state import State

TUBE = Liquid(8.0, 5.0, 0.116, 0.0)
MESH = SectorMesh(8, 4, 5, 0.5)
COARSE = {"cells": 8, "around": 4, "levels": 2, "degree": 4}
NAME = "fluid_tube_imperfect"


@pytest.fixture(scope="module")
def about():
    primary = PrimaryBranch(MPI.COMM_SELF, TUBE.L, TUBE.delta, TUBE.gamma)
    return Axisymmetric.of(primary, 1, 0.9)


@pytest.fixture(scope="module")
def even(about):
    volume = about.bifurcation.values["V"]
    window = Window(0.9 * volume, 1.05 * volume, 0.3, 0.1)
    model = LiquidSector(MPI.COMM_SELF, TUBE, 1, MESH)
    return natural(model, about, dict.fromkeys(IMPERFECTIONS, 0.0), window)


def test_the_potential_has_the_pressure_as_its_force():
    """``-P v.N`` and the work of the membrane, with the thickness, at a state without any symmetry."""
    model = LiquidSector(MPI.COMM_SELF, TUBE, 1, SectorMesh(6, 4, 3, 0.5))

    def shape(s, t):
        swell = np.sin(np.pi * s / TUBE.length)
        r = 1 + swell * (1 + 0.2 * np.cos(t))
        return np.vstack([r, 0.1 * swell * np.sin(t), TUBE.delta * s + 0.1 * swell * np.cos(2 * t)])

    loads = {"zw": 9.0, "tilt": 7.0, "uneven": 0.2}
    with model.system.at(State(model.interpolated(shape), loads)):
        own = model.system.residual()
        test, at = ufl.TestFunction(model.space), model.surface()
        along = test.dx(1)
        turned = ufl.as_vector([along[0] - test[1], along[1] + test[0], along[2]])
        v = Surface(ufl.as_vector(list(test)), test.dx(0), turned)
        theta, tau = ufl.SpatialCoordinate(model.mesh)[1], np.radians(7.0)
        x = at.x[0] * ufl.cos(theta) - at.x[1] * ufl.sin(theta)
        pressure = TUBE.gamma * (9.0 - at.x[2] * np.cos(tau) - x * np.sin(tau))
        work = (1 + 0.2 * ufl.cos(theta)) * membrane_work(at, v, 0.0)
        form = 2 * (work - pressure * ufl.dot(v.x, normal(at)))
        dx = ufl.Measure("dx", model.mesh, metadata={"quadrature_degree": 20})
        direct = fem.assemble_vector(fem.form(form * dx)).array
    direct[model.system.bc_dofs] = 0.0
    own = own.copy()
    own[model.system.bc_dofs] = 0.0
    assert np.abs(direct).max() > 0.1
    assert own == pytest.approx(direct, abs=2e-4 * np.abs(direct).max())


def test_the_bifurcation_is_that_of_the_axisymmetric_problem(about, even):
    (found,) = [s for s in even.special() if s.kind == "bifurcation_point"]
    for name in ("zw", "V"):
        assert found.values[name] == pytest.approx(about.bifurcation.values[name], rel=1e-8)


def test_the_force_of_a_tilt_is_that_of_the_meridian(about, even):
    """``B = gamma pi int r (r z' u - r r' w) dZ`` by state and mode of the axisymmetric problem."""
    at, (u, _, w) = about.bifurcation, about.bifurcation.mode
    r, z, u, w = (make_interp_spline(at.Z, values, 5) for values in (at.r, at.z, u, w))
    density = at.r**2 * (z.derivative()(at.Z) * u(at.Z) - r.derivative()(at.Z) * w(at.Z))
    whole = make_interp_spline(at.Z, density, 5).integrate(0, TUBE.length)
    force = TUBE.gamma * np.pi * float(whole / u(TUBE.length / 2)) * np.pi / 180
    assert expanded(even, "tilt").push == pytest.approx(force, rel=1e-5)


@pytest.mark.slow
def test_an_opposite_tilt_bends_to_the_opposite_side():
    one, other = (solve(NAME, tilt=tilt, v_start=0.9, u_end=0.3, numerics=COARSE) for tilt in (0.1, -0.1))
    for kind in ("limit_point", "volume_fold"):
        (a,), (b,) = one.points(kind), other.points(kind)
        assert a.values["u_wave"] < 0
        assert a.values["u_wave"] == pytest.approx(-b.values["u_wave"], rel=1e-6)
        assert a.values["zw"] == pytest.approx(b.values["zw"], rel=1e-10)
    # by two other methods: beyond.imperfect_fluid_tube
    limit = one.points("limit_point")[0]
    assert abs(limit.values["zw"] - 8.916744) < min(limit.uncertainty["zw"], 2e-5)


def test_detached_states_of_an_uneven_tube_have_a_smallest_volume():
    given = {"delta": 7, "n": 2, "v_start": 0.9, "v_end": 1.1, "secondary": True, "numerics": COARSE}
    found = solve(NAME, uneven=0.003, **given)
    assert found.failures == []
    kinds = [(point.kind, point.branch) for point in found.special_points]
    assert kinds == [("limit_point", "primary"), ("volume_fold", "secondary")]
    assert found.points("limit_point")[0].values["zw"] == pytest.approx(9.689846, abs=1e-4)
    natural_side, detached_side = (found.branch(name)["u_wave"][-1] for name in ("primary", "secondary"))
    assert natural_side < 0 < detached_side


@pytest.mark.slow
def test_forces_of_tilt_and_thickness_add_up(even):
    """A tube that is tilted and uneven has nearly the limit of one whose tilt has the same force."""
    tilt, forces = 0.05, {name: expanded(even, name).push for name in IMPERFECTIONS}
    uneven = tilt * forces["tilt"] / forces["uneven"]
    given = {"v_start": 0.9, "u_end": 0.4, "numerics": COARSE}
    twice = solve(NAME, tilt=2 * tilt, **given)
    both = solve(NAME, tilt=tilt, uneven=uneven, secondary=True, **given)
    (wanted,), (limit,) = (found.points("limit_point") for found in (twice, both))
    start = next(s.values["zw"] for s in even.special() if s.kind == "bifurcation_point")
    assert limit.values["zw"] - start == pytest.approx(wanted.values["zw"] - start, rel=0.03)
    assert limit.values["u_wave"] * both.branch("secondary")["u_wave"][0] < 0
    opposite = solve(NAME, tilt=tilt, uneven=-0.9 * uneven, **given).points("limit_point")[0]
    assert abs(opposite.values["zw"] - start) < 0.3 * abs(limit.values["zw"] - start)


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"tilt": 1.0, "n": 2}, r"tilt = 1 with n = 2.*allowed: n = 1, or tilt = 0"),
        ({"tilt": 1e-4}, r"tilt = 0.0001.*allowed: 0, or a magnitude of at least 0.001"),
        ({"uneven": 1e-6}, r"uneven = 1e-06.*at least 1e-05"),
    ],
)
def test_what_has_no_branch_is_refused(given, says):
    with pytest.raises(InputError, match=says):
        solve(NAME, **given)


def test_a_tube_that_is_not_full_is_absent():
    (absent,) = solve(NAME, delta=1.5, v_start=0.3, numerics=COARSE).absent
    assert "below the upper disk; choose a larger v_start" in str(absent)
