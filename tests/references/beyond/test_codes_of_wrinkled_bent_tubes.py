"""The two codes for bent tubes with the energy of a tension field."""

import numpy as np
import pytest

from reference_data.solvers.beyond.bent_tube import energy, strong, wrinkled
from reference_data.solvers.beyond.tube_waves.ritz import Basis
from reference_data.solvers.core.collocation import Mesh
from reference_data.solvers.core.mooney_rivlin import Tube

TUBE = Tube(0.1, 1.2, 6.0)


@pytest.fixture(scope="module")
def tangents():
    """Tangents of pieces that are taut, wrinkled in any direction, or slack."""
    rng = np.random.default_rng(3)
    return rng.normal(size=(3, 400)), rng.normal(size=(3, 400))


def test_forces_of_both_codes_are_the_same(tangents):
    a, b = tangents
    _, by_a, by_b = wrinkled.gradient(TUBE, 0.0, 0 * a, a, b)
    f_a, f_b = wrinkled.forces(TUBE, a.T, b.T / TUBE.r0)
    size = np.abs(f_a).max()
    assert np.abs(by_a.T / TUBE.r0 - f_a).max() < 1e-13 * size
    assert np.abs(by_b.T - f_b).max() < 1e-13 * size


def test_no_cut_is_pushed_and_some_bear_nothing(tangents):
    """The smallest principal stress is zero where that of the law is negative."""
    a, b = tangents[0].T, tangents[1].T / TUBE.r0
    forces, of_law = wrinkled.forces(TUBE, a, b), strong.forces(TUBE, a, b)

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
    f_a, f_b = wrinkled.forces(TUBE, a, b)
    assert f_a[0, 2] == pytest.approx(2 * (1 + 0.1 / stretch) * (stretch - stretch**-2), rel=1e-14)
    assert np.abs(f_b).max() == 0
    slack, _ = wrinkled.forces(TUBE, 0.5 * a, b)
    assert np.abs(slack).max() == 0


def test_wrinkles_bend_the_tube_further_by_both_codes():
    tube = Tube(0.0, 1.0, 6.0)
    at = energy.beside(tube, energy.Series(1, 4, Basis(6, 7)), (4.85, 5.1), 0, 0.3)
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
