"""The two codes for bent tubes, also with the energy of a tension field."""

import numpy as np
import pytest

from reference_data.solvers.beyond.bent_tube import energy, strong, wrinkled
from reference_data.solvers.beyond.tube_waves.ritz import Basis
from reference_data.solvers.core.collocation import Mesh
from reference_data.solvers.core.mooney_rivlin import Tube

TUBE, AMPLITUDE = Tube(0.0, 1.0, 6.0), 0.1
STIFF = Tube(0.1, 1.2, 6.0)


@pytest.fixture(scope="module")
def bent():
    return energy.beside(TUBE, energy.Series(1, 3, Basis(6, 7)), (4.85, 5.1), 0, AMPLITUDE)


@pytest.fixture(scope="module")
def balanced(bent):
    net = strong.Net(1, 5, Mesh.graded(7, 10, 2.0))
    return strong.solve(strong.on(bent, net), "u_wave", AMPLITUDE)


def test_both_methods_find_the_same_state(bent, balanced):
    for part in ("p", "volume", "u_max"):
        assert getattr(balanced, part) == pytest.approx(getattr(bent, part), abs=2e-5)
    assert bent.amplitude == pytest.approx(AMPLITUDE, abs=1e-12)
    assert balanced.amplitude == pytest.approx(AMPLITUDE, abs=1e-12)


def test_a_state_of_given_volume_is_that_of_its_amplitude(bent, balanced):
    for code, state in ((energy, bent), (strong, balanced)):
        again = code.solve(state, "V", state.volume + 1e-3)
        back = code.solve(again, "u_wave", AMPLITUDE)
        assert again.amplitude > AMPLITUDE
        assert back.volume == pytest.approx(state.volume, abs=1e-9)


def test_the_forces_are_derivatives_of_the_energy():
    tube, h = Tube(0.1, 1.2, 6.0), 1e-6
    a, b = np.array([0.3, 0.1, 1.2]), np.array([0.2, 1.5, -0.1])

    def stored(a, b):
        c = np.cross(a, b)
        t, j = a @ a + b @ b, c @ c
        return t + 1 / j + tube.alpha * (t / j + j)

    for k, force in enumerate(strong.forces(tube, a, b)):
        found = []
        for unit in np.eye(3):
            moved = [(a + s * h * unit, b) if k == 0 else (a, b + s * h * unit) for s in (1, -1)]
            found.append((stored(*moved[0]) - stored(*moved[1])) / (2 * h))
        assert force == pytest.approx(found, abs=1e-8)


def test_another_basis_has_the_same_position(bent):
    finer = energy.on(bent, energy.Series(1, 4, Basis(7, 9)))
    share, theta = np.linspace(0, 1, 7), np.array([0.0, 1.0, 2.5])
    assert finer.position(share, theta) == pytest.approx(bent.position(share, theta), abs=1e-4)


@pytest.fixture(scope="module")
def tangents():
    """Tangents of pieces that are taut, wrinkled in any direction, or slack."""
    rng = np.random.default_rng(3)
    return rng.normal(size=(3, 400)), rng.normal(size=(3, 400))


def test_forces_of_both_codes_are_the_same(tangents):
    a, b = tangents
    _, by_a, by_b = wrinkled.gradient(STIFF, 0.0, 0 * a, a, b)
    f_a, f_b = wrinkled.forces(STIFF, a.T, b.T / STIFF.r0)
    size = np.abs(f_a).max()
    assert np.abs(by_a.T / STIFF.r0 - f_a).max() < 1e-13 * size
    assert np.abs(by_b.T - f_b).max() < 1e-13 * size


def test_no_cut_is_pushed_and_some_bear_nothing(tangents):
    """The smallest principal stress is zero where that of the law is negative."""
    a, b = tangents[0].T, tangents[1].T / STIFF.r0
    forces, of_law = wrinkled.forces(STIFF, a, b), strong.forces(STIFF, a, b)

    def least(pair):
        tangent, force = np.stack([a, b], axis=1), np.stack(pair, axis=1)
        stress = np.linalg.solve(np.einsum("kim,kjm->kij", tangent, tangent), tangent @ force.swapaxes(1, 2))
        return np.linalg.eigvals(stress).real.min(axis=1)

    found, before = least(forces), least(of_law)
    assert 50 < np.sum(before < 0) < 350
    assert found.min() > -1e-9 * np.abs(before).max()
    assert found[before < 0] == pytest.approx(0, abs=1e-9 * np.abs(before).max())
    assert found[before > 0] == pytest.approx(before[before > 0], rel=1e-12)


def test_uniaxial_tension_has_the_force_of_mooney():
    stretch, narrow = 1.7, 0.3
    a, b = np.array([[0.0, 0.0, stretch]]), np.array([[0.0, narrow, 0.0]])
    f_a, f_b = wrinkled.forces(STIFF, a, b)
    assert f_a[0, 2] == pytest.approx(2 * (1 + 0.1 / stretch) * (stretch - stretch**-2), rel=1e-14)
    assert np.abs(f_b).max() == 0
    slack, _ = wrinkled.forces(STIFF, 0.5 * a, b)
    assert np.abs(slack).max() == 0


def test_wrinkles_bend_the_tube_further_by_both_codes():
    at = energy.beside(TUBE, energy.Series(1, 4, Basis(6, 7)), (4.85, 5.1), 0, 0.3)
    for volume in (5.4, 5.8):
        at = energy.solve(at, "V", volume)
    relaxed = wrinkled.ByEnergy(at.tube, at.series, at.x, at.p)
    for volume in (5.9, 6.1):
        at, relaxed = energy.solve(at, "V", volume), energy.solve(relaxed, "V", volume)
    net = strong.Net(1, 7, Mesh.graded(7, 8, 2.0))
    balanced = strong.solve(strong.on(relaxed, net, wrinkled.ByForces), "V", 6.1)
    ordinary = strong.solve(strong.on(at, net), "V", 6.1)
    assert balanced.amplitude == pytest.approx(relaxed.amplitude, abs=2e-3)  # coarse functions and points
    further = relaxed.amplitude - at.amplitude
    assert further > 5e-5
    assert 0.4 < (balanced.amplitude - ordinary.amplitude) / further < 1.6
