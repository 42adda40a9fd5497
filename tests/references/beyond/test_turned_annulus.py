"""The two reference methods of the turned annulus."""

import numpy as np
import pytest

from reference_data.solvers.beyond.annulus.shooting import Ring, Shooting, energy, pulled, slopes, taut
from reference_data.solvers.beyond.annulus.spectral import Pieces, density
from reference_data.solvers.beyond.tables_annulus import STRETCHED_TAUT, WIDE, shot, spectral


@pytest.mark.parametrize("alpha", [0.0, 0.1])
def test_slopes_are_those_of_the_energy(alpha):
    l1, l2, e = 1.3, 0.95, 1e-6
    first, second = slopes(l1, l2, alpha)
    assert first == pytest.approx((energy(l1 + e, l2, alpha) - energy(l1 - e, l2, alpha)) / 2 / e, rel=1e-8)
    assert second == pytest.approx((energy(l1, l2 + e, alpha) - energy(l1, l2 - e, alpha)) / 2 / e, rel=1e-7)
    assert pulled(l1, alpha) == pytest.approx(slopes(l1, l1**-0.5, alpha)[0], rel=1e-14)


def test_taut_point_carries_the_force():
    hoop, force = 1.02, (0.7, 0.2)
    point = taut(hoop, force, 0.1, np.array([1.0, 0.0]))
    w1, w2 = slopes(point.l1, point.l2, 0.1)
    cg, sg, cb, sb = point.frame
    assert w1 * cg * cb + w2 * sg * sb == pytest.approx(force[0], abs=1e-12)
    assert w1 * cg * sb - w2 * sg * cb == pytest.approx(force[1], abs=1e-12)
    assert point.l1 * sg == pytest.approx(hoop * sb, abs=1e-12)
    assert point.l2 * cg == pytest.approx(hoop * cb, abs=1e-12)


def test_energies_of_both_methods_are_the_same_function():
    at = (np.array([0.5]), np.array([0.52]), np.array([1.1]), np.array([0.4]))
    gradient = np.array([[at[2][0], 0], [(at[1] * at[3])[0], (at[1] / at[0])[0]]])
    l1, l2 = np.linalg.svd(gradient, compute_uv=False)
    assert density(at, 0.1, False)[0] == pytest.approx(energy(l1, l2, 0.1), rel=1e-13)
    assert density(at, 0.1, True)[0] == pytest.approx(energy(l1, l1**-0.5, 0.1), rel=1e-13)


def test_both_methods_find_torque_energy_and_front():
    angles = np.array([0.05, 0.1])
    for a, b in zip(shot(WIDE, angles, 1e-10), spectral(WIDE, angles, 20), strict=True):
        for name in ("M", "U", "R_front"):
            assert a[name] == pytest.approx(b[name], abs=1e-6), name
        assert a["M"] == pytest.approx(b["M"], rel=1e-9)


def test_a_front_makes_no_difference_where_the_polynomials_have_it_at_their_break():
    """One polynomial over the front converges slowly."""
    angle = np.array([0.1])
    (exact,) = spectral(WIDE, angle, 24)
    whole = Pieces(WIDE.ring.a, 1.0, 0.0, (True,), 24)
    assert abs(whole.columns(whole.solve(0.1, whole.start(0.1)), 0.1)["M"] - exact["M"]) > 1e-6


def test_onset_of_both_methods():
    a = Shooting(Ring(0.4, 1.05, 0.1), 1e-10).onset(STRETCHED_TAUT.first)
    code = STRETCHED_TAUT.pieces(18)
    _, psi = code.onset(0.1, code.start(0.1))
    assert a["psi"] == pytest.approx(psi, abs=1e-9)
