"""Reference codes of the fluid-loaded tube without axial symmetry: the secondary branch."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reference_data.solvers.paper3 import modes, path
from reference_data.solvers.paper3.bent import branch, states
from reference_data.solvers.paper3.bent.equations import SYMMETRIC, Assembly, Grid
from reference_data.solvers.paper3.bent.newton import newton
from reference_data.solvers.paper3.data import FluidTube
from reference_data.solvers.paper3.galerkin import Elements

TUBE = FluidTube(8, 2)
HOW = path.RESOLUTIONS[0]
GRID = Grid(Elements(7, 3, 6, 1.0), 10, 32)
OFFSET = 0.1


@pytest.fixture(scope="module")
def critical():
    """The first n = 1 bifurcation, by collocation and by Galerkin's method."""
    line = path.Path(TUBE, HOW)
    state = modes.critical_point(line.reach(131.0, 2.0), HOW, 1).state
    return state, modes.galerkin_critical(state, HOW, 1)


@pytest.fixture(scope="module")
def bent(critical):
    """A state on the secondary branch."""
    return newton(branch.injected(critical[1], OFFSET, GRID), OFFSET)


def test_spectrum_about_an_axisymmetric_state_is_the_union_of_the_fourier_spectra(critical):
    state, shape = critical
    grid = Grid(Elements(9, 4, 8, 1.0), 6, 24)
    flat = branch.axisymmetric(shape, grid)
    volume, potential = states.integrals(flat)
    assert volume == pytest.approx(state.volume, abs=1e-8)
    assert potential == pytest.approx(modes.potential(state), abs=1e-8)
    expected = {k: v[0] for k, v in modes.spectrum(state, HOW).items()}
    found = states.stability(flat)
    assert found.symmetric[0] == pytest.approx(expected["Lambda_n0"], abs=1e-8)
    assert found.symmetric[1] == pytest.approx(0, abs=1e-8)
    assert found.volume_held == pytest.approx(0, abs=1e-8)
    broken = sorted((found.breaking, found.rotation))
    # the sine partner of n = 1, and torsion
    assert broken == pytest.approx([0, expected["Lambda_torsion"]], abs=1e-8)


def test_state_is_on_the_prescribed_offset_and_its_front_on_the_level(bent):
    assert branch.offset_of(bent) == pytest.approx(OFFSET, abs=1e-9)
    front, _ = bent.front_at(GRID.theta)
    height = bent.evaluate(front[None, :], GRID.theta)[0][0, :, 2]
    assert GRID.project(height - bent.zw, 0) == pytest.approx(0, abs=1e-8)


def test_level_and_volume_fall_away_from_the_bifurcation(critical, bent):
    assert bent.zw < critical[0].zw
    assert states.integrals(bent)[0] < critical[0].volume
    x = bent.evaluate(np.array([TUBE.length / 2]), np.array([0.0, np.pi]))[0][0]
    assert np.hypot(*x[0, :2]) > np.hypot(*x[1, :2])  # the bulge is at Theta = 0
    assert states.lowest_point(bent) < 0


def test_potential_is_stationary(bent):
    """The weak form follows from Pi in polar terms, which is never integrated by parts."""
    rng = np.random.default_rng(0)
    el = GRID.elements
    z = np.concatenate([el.positions(TUBE, bent.front[0])]) / TUBE.length
    v = (z * (1 - z))[:, None] * rng.standard_normal((len(z), 1)) * rng.standard_normal(bent.x.shape[1])
    assembly = Assembly(bent, tangent=False)
    assert np.abs(assembly.residual[1:-1]).max() < 1e-8
    h = 1e-4
    at = [states.integrals(replace(bent, x=bent.x + k * h * v))[1] for k in (-2, -1, 1, 2)]
    slope = (8 * (at[2] - at[1]) - (at[3] - at[0])) / (12 * h)
    # the kink moves with the perturbation: its part of the difference quotient is of order h^2
    assert abs(slope) < 1e-5 * np.abs(v).max()
    assert abs(at[1] + at[2] - 2 * states.integrals(bent)[1]) > 1e-9  # the quotient sees v at all


def test_level_is_conjugate_to_the_volume(bent):
    """dPi/dz_w = -gamma V between neighbouring states of the branch."""
    h = 2e-3
    pair = [newton(replace(bent, zw=bent.zw + k * h)) for k in (-1, 1)]
    pi = [states.integrals(s)[1] for s in pair]
    volume = states.integrals(bent)[0]
    assert (pi[1] - pi[0]) / (2 * h) == pytest.approx(-TUBE.gamma * volume, rel=1e-4)


def test_stability_of_the_secondary_branch(bent):
    found = states.stability(bent)
    assert found.symmetric[0] < 0 < found.symmetric[1]
    assert found.volume_held < 0
    assert abs(found.rotation) < 1e-7
    assert found.breaking > 0


def test_matrix_is_symmetric_and_exact(bent):
    """Pressure is a follower load, yet its matrix is symmetric and is the residual's derivative."""
    assembly = Assembly(bent)
    el = GRID.elements
    size = assembly.functions * (el.count * el.degree + 1)
    full = np.zeros((size, size))
    for e, at in enumerate(el.joined):
        index = (at[:, None] * assembly.functions + np.arange(assembly.functions)).ravel()
        full[np.ix_(index, index)] += assembly.stiffness[e]
    inner = slice(assembly.functions, -assembly.functions)
    core = full[inner, inner]
    assert np.abs(core - core.T).max() < 1e-6 * np.abs(core).max()
    rng = np.random.default_rng(1)
    v = np.zeros_like(bent.x)
    v[1:-1] = rng.standard_normal(v[1:-1].shape) / (1 + np.arange(v.shape[1])) ** 2
    h = 1e-6
    up, down = (Assembly(replace(bent, x=bent.x + s * h * v), tangent=False).residual for s in (1, -1))
    product = (full @ v.ravel()).reshape(v.shape)
    assert np.abs((up - down) / (2 * h) - product).max() < 1e-5 * np.abs(product).max()
    assert GRID.sizes(SYMMETRIC) == [11, 10, 11]


def test_interpolation_to_a_finer_grid_keeps_the_state(bent):
    finer = bent.moved_to(Grid(Elements(8, 4, 8, 1.0), 14, 44))
    at, theta = np.linspace(0, TUBE.length, 9), np.linspace(0, np.pi, 5)
    assert np.abs(finer.evaluate(at, theta)[0] - bent.evaluate(at, theta)[0]).max() < 1e-4


def test_an_over_filled_tube_has_no_free_surface():
    assert states.surface_area(SimpleNamespace(partial=False)) == 0.0
