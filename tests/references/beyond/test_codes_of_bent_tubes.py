"""The two codes for bent tubes."""

import numpy as np
import pytest

from reference_data.solvers.beyond.bent_tube import energy, strong
from reference_data.solvers.beyond.tube_waves.ritz import Basis
from reference_data.solvers.core.collocation import Mesh
from reference_data.solvers.core.mooney_rivlin import Tube

TUBE, AMPLITUDE = Tube(0.0, 1.0, 6.0), 0.1


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
