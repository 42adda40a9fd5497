"""Reference codes of the fluid-loaded tube: both axisymmetric methods and their states."""

import numpy as np
import pytest

from reference_data.solvers.core.laws import law
from reference_data.solvers.core.tables import DisagreementError
from reference_data.solvers.paper3 import canonical as can
from reference_data.solvers.paper3 import common, modes, path, weak
from reference_data.solvers.paper3 import galerkin as gal
from reference_data.solvers.paper3.collocation import resultants
from reference_data.solvers.paper3.data import FluidTube

STEP = 1e-30
HOW = path.RESOLUTIONS[0]
TUBE = FluidTube(8, 2)


@pytest.fixture(scope="module")
def line():
    """Primary branch of L = 8, delta = 2, beyond both crossings of the brim."""
    out = path.Path(TUBE, HOW)
    out.reach(134.0, 2.0)
    return out


def random_point(rng):
    """An axisymmetric point with tangents, pressure and slope of the pressure."""
    r, l1, psi, load, slope = 1 + rng.random(), 1 + rng.random(), rng.random(), rng.random(), -rng.random()
    a = np.array([l1 * np.cos(psi), 0.0, l1 * np.sin(psi)])
    return (r, l1, psi, load, slope), a, np.array([0.0, r, 0.0])


def test_tangent_is_the_derivative_of_the_residual():
    rng = np.random.default_rng(1)
    a, b, z, zw, gamma = rng.standard_normal(3), rng.standard_normal(3), 0.3, 1.1, 0.7
    exact = np.empty((9, 9))
    for j in range(9):
        bump = 1j * STEP * np.eye(9)[j]
        load = np.array(gamma * (zw - z - bump[8]))
        exact[:, j] = np.imag(weak.residual(a + bump[:3], b + bump[3:6], load)) / STEP
    tangent = weak.tangent(a, b, np.array(gamma * (zw - z)), np.array(-gamma))
    assert np.abs(tangent - exact).max() < 1e-13 * np.abs(exact).max()


def test_strain_energy_has_the_fluxes_as_its_gradient():
    rng = np.random.default_rng(2)
    a, b = rng.standard_normal(3), rng.standard_normal(3)
    f = np.concatenate(weak.fluxes(a, b))
    for j, e in enumerate(1j * STEP * np.eye(6)):
        derivative = np.imag(weak.energy_density(a + e[:3], b + e[3:])) / STEP
        assert f[j] == pytest.approx(derivative, rel=1e-12)


@pytest.mark.parametrize("n", [0, 1, 2, 5])
def test_second_variation_of_both_methods_is_one_quadratic_form(n):
    """The form printed in the paper agrees with the average of the Cartesian tangent."""
    rng = np.random.default_rng(n)
    at, a, b = random_point(rng)
    d = weak.tangent(a, b, np.array(at[3]), np.array(at[4]))
    cos, sin = gal.parts(n)
    q = np.array(can.form(*(np.array(x) for x in at), n))
    for x in rng.standard_normal((5, 6)):
        if n == 0:  # torsion apart from the rest
            x = np.where(np.arange(6) % 3 == 1, 0, x)  # noqa: PLW2901
        c, s = cos @ x, sin @ x
        assert x @ q @ x == pytest.approx(c @ d @ c + s @ d @ s, rel=1e-11)
    assert np.abs(q - q.T).max() < 1e-14


@pytest.mark.parametrize("model", [None, "ogden", "gent", "arruda_boyce"])
def test_resultants_of_the_axisymmetric_methods_share_no_formula_and_agree(model):
    """Tensions of the first-order system agree with complex steps of the energy."""
    rng = np.random.default_rng(4)
    l1, r, psi = 1 + rng.random(9), 1 + rng.random(9), rng.random(9)
    a = np.stack([l1 * np.cos(psi), 0 * psi, l1 * np.sin(psi)], -1)
    b = np.stack([0 * r, r, 0 * r], -1)
    own = law(model) if model else None
    for one, two in zip(resultants(l1, r, own), weak.cut_resultants(a, b, own), strict=True):
        assert two == pytest.approx(one, rel=1e-12)


def test_sideways_translation_costs_nothing():
    at, _, _ = random_point(np.random.default_rng(3))
    shift = np.array([0, 0, 0, 1.0, -1.0, 0])
    q = np.array(can.form(*(np.array(x) for x in at), 1))
    assert abs(shift @ q @ shift) < 1e-14


@pytest.mark.parametrize("volume", [6.0, 30.0, 60.0, 126.0])
def test_both_methods_find_the_same_state_and_spectrum(line, volume):
    state = line.at(volume)
    shape = path.galerkin(state, HOW)
    assert state.partial == (state.zw < TUBE.L)
    own, other = modes.quantities(state), modes.galerkin_quantities(shape)
    for name, value in own.items():
        assert other[name] == pytest.approx(value, abs=2e-10), name
    for name, (a, b) in modes.spectrum(state, HOW).items():
        assert a == pytest.approx(b, abs=1e-10), name


@pytest.mark.parametrize("volume", [6.0, 60.0, 126.0])
def test_first_integral_and_rings(line, volume):
    """W - lambda1 s_1 is constant along the tube; the rings carry the same stresses."""
    state = line.at(volume)
    r, _, l1, _, _ = np.moveaxis(state.y, -1, 0)
    energy = (l1**2 + r**2 + 1 / (l1 * r) ** 2 - 3) / 2
    constant = energy - l1 * (l1 - 1 / (l1**3 * r**2))
    assert np.ptp(constant) < 1e-11
    assert l1[0, 0] == pytest.approx(l1[-1, -1], abs=1e-12)


@pytest.mark.parametrize("volume", [20.0, 66.0, 126.0])
def test_potential_falls_with_the_level_by_the_weight_of_the_fluid(line, volume):
    """dPi/dz_w = -gamma V, here along the branch: dPi/dV = -gamma V dz_w/dV."""
    h = 0.01
    near = [modes.quantities(line.at(volume + k * h)) for k in (-2, -1, 1, 2)]
    pi, zw = (
        (8 * (q[2] - q[1]) - (q[3] - q[0])) / (12 * h) for q in ([x[k] for x in near] for k in ("Pi", "zw"))
    )
    assert pi == pytest.approx(-TUBE.gamma * volume * zw, abs=1e-8)


def test_volume_has_a_kink_at_the_brim(line):
    """dV/dz_w drops by the area pi of the free surface when the tube is full; the shape stays smooth."""
    states = line.states
    switches = [i for i in range(1, len(states)) if states[i].partial != states[i - 1].partial]
    assert len(switches) == 2
    low, high = states[switches[0] - 1].volume, states[switches[0]].volume
    brim = common.root(lambda v: line.at(v).zw - TUBE.L, low, high)
    h = 1e-4
    partly, over = line.at(brim - h), line.at(brim + h)
    assert partly.partial
    assert not over.partial
    assert h / (TUBE.L - partly.zw) - h / (over.zw - TUBE.L) == pytest.approx(np.pi, rel=1e-3)


def test_volume_rises_and_level_has_one_maximum(line):
    volumes, levels = (np.array([getattr(s, k) for s in line.states]) for k in ("volume", "zw"))
    assert np.all(np.diff(volumes) > 0)
    assert np.sum(np.diff(np.sign(np.diff(levels))) != 0) == 1


def test_limit_point_is_the_maximum_of_the_level(line):
    found = modes.critical_point(line.at(66.0), HOW, 0)
    h = 0.05
    levels = [line.at(found.state.volume + k * h).zw for k in (-2, -1, 1, 2)]
    assert max(levels) < found.state.zw
    assert abs((8 * (levels[2] - levels[1]) - (levels[3] - levels[0])) / (12 * h)) < 1e-9
    shape = modes.galerkin_critical(found.state, HOW, 0)
    assert shape.volume() == pytest.approx(found.state.volume, abs=1e-9)


def test_bifurcation_by_both_methods(line):
    found = modes.critical_point(line.at(131.0), HOW, 1)
    shape = modes.galerkin_critical(found.state, HOW, 1)
    assert shape.zw == pytest.approx(found.state.zw, abs=1e-10)
    assert modes.spectrum(found.state, HOW)["Lambda_n1"][0] == pytest.approx(0, abs=1e-10)


def test_search_finds_the_critical_points_in_their_order():
    near = modes.zeros(TUBE, 140.0, 10.0, (0, 1))
    assert near[0].volume < near[1].volume
    assert near[1].volume == pytest.approx(131.57, abs=0.5)


def test_dry_tube_necks():
    for L, delta in ((8, 2), (24, 2), (24, 3)):
        state = path.dry(FluidTube(L, delta), HOW.partial)
        r, _, l1, _, _ = np.moveaxis(state.y, -1, 0)
        mid = state.evaluate(np.array(state.tube.length / 2))[0]
        assert np.all(weak.resultants(l1, r)[1] > 0)
        assert mid < 1
        if L == 24:
            assert mid == pytest.approx(delta**-0.5, rel=5e-3)


def test_disagreement_names_table_column_and_row():
    good, off = np.array([1.0, 2.0, 3.0]), np.array([1.0, 2.001, 3.0])
    a, b = common.resolved(good, good, "collocation"), common.resolved(off, off, "galerkin")
    with pytest.raises(DisagreementError, match=r"table T, column zw, row 1:"):
        common.compared("T", "zw", a, b)


def test_level_that_does_not_occur_is_refused():
    with pytest.raises(ValueError, match="does not occur before"):
        common.state_at_level(TUBE, 9.0, post=False, stop=140.0)
