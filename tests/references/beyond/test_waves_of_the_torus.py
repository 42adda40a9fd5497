"""The two reference methods of waves around the inflated torus, and what the table says."""

import csv
from pathlib import Path

import numpy as np
import pytest

from reference_data.solvers.beyond.torus.family import EVEN, ODD, Family, families
from reference_data.solvers.beyond.torus.fourier import Series
from reference_data.solvers.beyond.torus.shooting import Shooting
from reference_data.solvers.beyond.torus.tables import SLENDER
from reference_data.solvers.beyond.torus.waves_energy import Waves
from reference_data.solvers.beyond.torus.waves_shooting import Jacobi
from reference_data.solvers.beyond.tube_waves.ritz import Basis

DATA = Path(__file__).parents[3] / "reference_data" / "beyond"
VOLUME = np.array([2.0 * SLENDER.volume])


@pytest.fixture(scope="module")
def state():
    """A slender Mooney-Rivlin torus by both methods."""
    ((_, found),), ((_, x),) = SLENDER.shot(VOLUME, 1e-10), SLENDER.fourier(VOLUME, 28)
    return found, x


def by_energy():
    return Waves(Series(SLENDER.b, SLENDER.alpha, 28), Basis(4, 9, 1.0))


@pytest.mark.parametrize("family", families(2), ids=str)
def test_both_methods_find_the_same_lowest_eigenvalues(state, family):
    found, x = state
    code = Jacobi(Shooting(SLENDER.b, SLENDER.alpha, 1e-10), family)
    for near in by_energy().eigenvalues(x, family, 2):
        assert code.eigenvalue(found, near, 1e-3) == pytest.approx(near, abs=1e-7)


def test_rigid_motions_are_neutral_for_the_energy(state):
    _, x = state
    code = by_energy()
    t = np.pi * code.basis.nodes
    r, z, *_ = code.series._meridian(x, code.series._at(t))
    one, none = np.ones_like(r), np.zeros_like(r)
    motions = {
        Family(0, ODD): (none, none, one),
        Family(1, EVEN): (one, -one, none),
        Family(1, ODD): (z, -z, -r),
    }
    for family, motion in motions.items():
        k, _ = code.matrices(x, family.n)
        forces = (k @ np.concatenate(motion)).reshape(3, -1)
        forces[np.ix_(family.zero, (0, -1))] = 0.0  # where the equators are held
        assert np.abs(forces).max() < 1e-8 * np.abs(k).max(), family


@pytest.mark.parametrize("n", [0, 1, 3])
def test_the_second_variation_is_that_of_the_energy_in_space(state, n):
    """By differences of the energy of the displaced surface, in Cartesian components."""
    _, x = state
    code = by_energy()
    b, alpha, p = code.series.b, code.series.alpha, x[-1]
    points, weights, phi, dphi = code.basis.rule
    t, angle = np.pi * points, 2 * np.pi * (np.arange(4 * n + 4) + 0.5) / (4 * n + 4)
    r, z, r_t, z_t = code.series._meridian(x, code.series._at(t))
    s = np.pi * code.basis.nodes
    parts = np.array([np.cos(2 * s), (0.3 + s**2) * (n > 0), np.sin(3 * s)])
    (u, q, w), (u_t, q_t, w_t) = parts @ phi.T, parts @ dphi.T / np.pi
    cn, sn = np.cos(n * angle)[:, None], np.sin(n * angle)[:, None]
    e_r, e_th = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])

    def total(e):
        def vector(radial, hoop, axial):
            flat = e_r[:, :, None] * radial + e_th[:, :, None] * hoop
            return np.concatenate([flat, (axial + 0 * radial)[None]])

        place = vector(r + e * u * cn, e * q * sn, z + e * w * cn)
        along = vector(r_t + e * u_t * cn, e * q_t * sn, z_t + e * w_t * cn)
        around = vector(-e * (n * u + q) * sn, r + e * (u + n * q) * cn, -e * n * w * sn)
        radius = 1 + b * np.cos(t)
        g, h = (along**2).sum(0) / b**2, (around**2).sum(0) / radius**2
        shear = (along * around).sum(0) / (b * radius)
        trace, det = g + h, g * h - shear**2
        strain = trace + 1 / det + alpha * (det + trace / det)
        # The rims stay in the plane of symmetry, so that half of the volume lies below the surface.
        outwards = np.cross(around, along, axis=0)
        density = b * radius * strain - p * (place * outwards).sum(0) / 3
        return 2 * (np.pi * weights * density).sum(1).mean() / (1 if n else 2)

    e = 1e-3
    steps = (total(e) - 2 * total(0) + total(-e)) / e**2
    finer = (total(e / 2) - 2 * total(0) + total(-e / 2)) / (e / 2) ** 2
    d = parts.ravel()
    assert d @ code.matrices(x, n)[0] @ d == pytest.approx((4 * finer - steps) / 3, rel=1e-6)


def test_the_table_has_even_waves_beyond_the_limit_point():
    with (DATA / "torus_waves.csv").open() as file:
        rows = [{k: float(v) for k, v in row.items()} for row in csv.DictReader(file)]
    assert {row["parity"] for row in rows} == {EVEN}
    assert {row["direction"] for row in rows} == {1}
    assert [(row["b"], row["alpha"], row["n"]) for row in rows] == [
        (0.4, 0.0, 1), (0.4, 0.0, 2), (0.2, 0.1, 1), (0.2, 0.1, 2), (0.2, 0.1, 3), (0.4, 0.1, 1)
    ]  # fmt: skip


def test_families_of_rigid_motions_are_held():
    held = [family for family in families(3) if family.pinned]
    assert held == [Family(0, ODD), Family(1, EVEN), Family(1, ODD)]
