"""Reference codes of paper 5: second variations, the hemisphere, and physical identities."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.collocation import differentiation, lagrange
from reference_data.solvers.paper4 import cases as cas
from reference_data.solvers.paper4 import material as wri
from reference_data.solvers.paper5 import cases as rel
from reference_data.solvers.paper5.hemisphere import limit as lim
from reference_data.solvers.paper5.hemisphere import states as hem
from reference_data.solvers.paper5.waves import bending as ben
from reference_data.solvers.paper5.waves import koiter as koi
from reference_data.solvers.paper5.waves import linearised as lin
from reference_data.solvers.paper5.waves import second_variation as sec
from reference_data.solvers.paper5.waves.cylinder import FLUID, GAS, quadratic
from reference_data.solvers.paper5.waves.transfer import Transfer

pytestmark = pytest.mark.paper5
STEP = 1e-30


def relaxed(l1, c2):
    """U_R, written out."""
    return l1**2 + 2 / l1 - 3 + c2 * (2 * l1 + 1 / l1**2 - 3)


@cache
def form(load: float, gas: bool = False) -> sec.Quadratic:
    return rel.cylinder(GAS if gas else FLUID, load).forms[0]


@pytest.mark.parametrize(
    ("x1", "x2", "tense"),
    [(1.7, 1.2, True), (4.0, 0.6, True), (1.3, 1.3, True), (1.7, 0.7, False), (4.0, 0.3, False)],
)
def test_derivatives_of_the_energy_in_invariants(x1, x2, tense):
    """f1..f22 agree with complex steps of U(x1, x2); f_y agrees with its quotient."""

    def slopes(a, b):
        h = 1j * STEP
        energy = (
            (lambda a, b: mat.energy(a**0.5, b**0.5, 0.1)) if tense else (lambda a, b: relaxed(a**0.5, 0.1))
        )
        return np.imag(energy(a + h, b)) / STEP, np.imag(energy(a, b + h)) / STEP

    f1, f2, fy, f11, f12, f22 = (
        float(f) for f in sec.derivatives(np.array(x1), np.array(x2), np.array(tense), 0.1)
    )
    assert (f1, f2) == pytest.approx(slopes(x1, x2), rel=1e-12, abs=1e-14)
    if x1 != x2:
        assert fy == pytest.approx((f1 - f2) / (x1 - x2), rel=1e-11)
    e = 1e-5
    by_1 = np.subtract(slopes(x1 + e, x2), slopes(x1 - e, x2)) / (2 * e)
    by_2 = np.subtract(slopes(x1, x2 + e), slopes(x1, x2 - e)) / (2 * e)
    assert (f11, f12) == pytest.approx(tuple(by_1), rel=1e-7, abs=1e-9)
    assert (f12, f22) == pytest.approx(tuple(by_2), rel=1e-7, abs=1e-9)


@pytest.mark.parametrize(
    ("membrane", "load", "n"),
    [(FLUID, 3.0, 1), (FLUID, 3.0, 20), (FLUID, 6.6, 6), (FLUID, 6.73, 8), (GAS, 0.2, 15)],
)
def test_both_methods_find_the_same_eigenvalues(membrane, load, n):
    a, b = rel.cylinder(membrane, load).lowest(n)
    assert np.all(np.abs(a.fine - b.fine) <= np.hypot(a.uncertainty, b.uncertainty))
    assert np.abs(a.fine - b.fine).max() < 1e-8


def test_both_methods_agree_on_the_hemisphere():
    found = rel.hemisphere(-0.8)
    assert np.abs(found.tracked[1].pattern.fronts - found.shots[1].shot.fronts).max() < 1e-10
    assert found.tracked[1].volume == pytest.approx(found.shots[1].volume, abs=1e-10)
    a, b = found.spectrum.lowest(10)
    assert np.abs(a.fine - b.fine).max() < 1e-8


def energy(
    f: sec.Quadratic, field: np.ndarray, slope: np.ndarray, n: int, e: float, level: float
) -> np.ndarray:
    """Integrand of the complete two-dimensional energy, summed over Theta, at the Gauss points.

    Each point uses the energy of its own state; the liquid enters by Phi and the projected area.
    """
    membrane, points = FLUID, 64
    theta = np.arange(points) * 2 * np.pi / n / points
    c, s = np.cos(n * theta), np.sin(n * theta)
    u, q, w = (e * field[..., i, None] for i in range(3))
    du, dq, dw = (e * slope[..., i, None] for i in range(3))
    r, dr, dz = (a[..., None] for a in (f.r, f.dr, f.dz))
    z = f.z[..., None] + w * c
    xs = dr + du * c, dq * s, dz + dw * c
    xt = -n * u * s - q * s, r + u * c + n * q * c, -n * w * s
    g11, g12, g22 = (sum(a * b for a, b in zip(*p, strict=True)) for p in ((xs, xs), (xs, xt), (xt, xt)))
    mean, gap = (g11 + g22) / 2, np.sqrt((g11 - g22) ** 2 / 4 + g12**2)
    l1, l2 = np.sqrt(mean + gap), np.sqrt(mean - gap)
    assert np.all(l1 > 1)
    strain = np.where(l2 * l2 * l1 > 1, mat.energy(l1, l2, membrane.c2), relaxed(l1, membrane.c2))
    phi = membrane.gamma * np.maximum(level - z, 0) ** 2 / 2
    area = xs[0] * xt[1] - xs[1] * xt[0]
    return np.sum(f.H[..., None] * strain - phi * area, axis=-1) * 2 * np.pi / points


@pytest.mark.parametrize(("load", "n", "rel_error"), [(3.0, 10, 3e-8), (6.6, 10, 2e-3)])
def test_second_variation_is_that_of_the_complete_energy(load, n, rel_error):
    """Differences of the energy in two dimensions; of first order in the amplitude at a moving front."""
    f = form(load)
    x = f.state.edges[:-1, None] + np.diff(f.state.edges)[:, None] * f.nodes
    shape = np.sin(np.pi * x / 8)
    nodal = np.stack([shape, -0.6 * np.sin(2 * np.pi * x / 8), 0.4 * shape * x / 8], axis=-1)
    d = np.zeros(f.size)
    d[f.index] = nodal.reshape(len(nodal), -1)
    k = f.stiffness
    expected = float(d @ ((k[0] + n * k[1] + n * n * k[2]) @ d))
    gauss = np.polynomial.legendre.leggauss(f.s.shape[1])[0] / 2 + 0.5
    value = lagrange(f.nodes, gauss)
    field = np.einsum("gm,kmc->kgc", value, nodal)
    slope = np.einsum("gm,kmc->kgc", value @ differentiation(f.nodes), nodal) / f.width[..., None]

    def difference(e: float) -> float:
        parts = [energy(f, field, slope, n, s * e, load) for s in (1, -1, 0)]
        return float(np.sum(f.weights * (parts[0] + parts[1] - 2 * parts[2]))) / e**2 / np.pi

    # where all is smooth the error is even in e
    found = (4 * difference(5e-4) - difference(1e-3)) / 3 if load < 6 else difference(3e-5)
    assert found == pytest.approx(expected, rel=rel_error)


def test_flat_patch():
    """For x = a X + e sin nX, y = b Y, z = c + e cos nX: the printed pressure energy; b is constant."""
    a, b, c, n, P, Lx, Ly = 0.6, 1.8, 0.1, 10, 0.3, 1.3, 0.7
    X, w = np.polynomial.legendre.leggauss(200)
    X, w = Lx * (X + 1) / 2, w * Lx / 2
    for e in (0.0, 0.004, -0.01):
        dx, z, dz = a + e * n * np.cos(n * X), c + e * np.cos(n * X), -e * n * np.sin(n * X)
        found = -P * b * Ly * np.sum(w * z * dx)
        first, second = a / n * np.sin(n * Lx) + c * np.sin(n * Lx), n * Lx / 2 + np.sin(2 * n * Lx) / 4
        assert found == pytest.approx(-P * b * Ly * (a * Lx * c + e * first + e**2 * second), rel=1e-13)
        across = np.sqrt(dx**2 + dz**2)  # g_XY = 0, so the stretches are b and this
        assert np.all(across < b**-0.5)
        assert np.all(across <= a + abs(e) * n + 1e-15)


def test_zero_pressure_is_stable_and_blind_to_n():
    f = form(0.0)
    values = [f.first(n) for n in (1, 7, 30, 300)]
    assert values[0] > 0.2
    assert np.ptp(values) < 1e-10


def test_printed_crossings():
    """For n = 20 at about 3.6, n = 50 at about 2.6 (it is 2.6498)."""
    for n, low, high in ((20, 3.55, 3.65), (50, 2.55, 2.65)):
        assert form(low).first(n) > 0 > form(high).first(n)
    assert min(form(x).first(1) for x in (0.0, 2.0, 4.0, 5.73)) > 0


@pytest.mark.parametrize(
    ("p", "n", "stable"), [(0.02, 1, 1), (0.2, 5, 1), (0.05, 15, 0), (0.3, 15, 1), (0.38, 20, 0)]
)
def test_signs_under_gas(p, n, stable):
    assert (form(p, gas=True).first(n) > 0) == bool(stable)


def test_lowest_eigenvalue_falls_with_n_while_wrinkled_and_tends_to_the_local_rate():
    """Lambda/n tends to -max p lam1/(H R) from above."""
    f = form(4.0)
    numbers = [0, 1, 5, 20, 100, 400, 1600]
    values = [f.first(n) for n in numbers[1:]]
    assert np.all(np.diff(values) < 0)
    rate = float(np.max(f.p * f.l1 / f.H))
    ratios = [-v / n / rate for v, n in zip(values[-3:], numbers[-3:], strict=True)]
    assert np.all(np.diff(ratios) > 0)
    assert ratios[-1] < 1
    gaps = 1 - np.array(ratios)
    assert gaps[0] / gaps[1] == pytest.approx(2, rel=0.25)  # order n^(-1/2)


def test_a_tense_membrane_of_the_full_energy_is_unstable_at_zero_pressure_for_large_n():
    """With the full energy in the wrinkled state the form is quadratic in n, as hoops are compressed."""
    state = cas.solved(FLUID, 0.0).tracked[0]
    full = quadratic(state, all_tense=True)
    assert abs(full.stiffness[2]).max() > 1
    assert full.first(30) < 0


def test_linearised_theory():
    """Linear in n, B by its closed form, negative eigenvalues beyond n*; both computations of A agree."""
    f = form(4.5)
    level = f.state.edges[np.nonzero(np.diff(f.state.wet.astype(int)))[0][0] + 1]
    for power in (1, 2):
        a, b = lin.by_matrices(f, level, power), lin.by_principal_axes(f, level, power)
        assert abs(a.square) < 1e-9
        found, other = (a.A, a.B), (b.A, b.B)
        assert found[1] == pytest.approx(a.closed, rel=1e-10)
        assert found == pytest.approx(other, rel=1e-9)
        for n in (int(np.ceil(a.n_star)), int(2 * a.n_star)):
            assert f.first(n) < 0


def test_hemisphere_first_integrals():
    """Constant tension in wrinkled zones, a straight meridian in dry ones; a front near the equator."""
    state = hem.levels().at(-0.9)
    t, y = state.s, state.y
    tension = np.sin(t) * wri.relaxed_slope(y[..., 2], 0.0)
    for zone, (tense, wet) in enumerate(zip(state.pattern.tense, state.pattern.wet, strict=True)):
        inside = state.zone == zone
        if not tense:
            assert np.ptp(tension[inside]) < 1e-10
            if not wet:
                assert np.ptp(y[inside][..., 3]) < 1e-9
    assert state.pattern.signature == (True, False, True)
    assert state.pattern.breaks[-2] > 1.55


def test_hemisphere_at_high_levels_is_tense_and_stable():
    found = hem.levels().at(-0.52)
    assert found.pattern.signature == (True,)
    f = quadratic(found)
    assert min(f.first(n) for n in (0, 1, 2, 10, 50)) > 0
    low = quadratic(hem.levels().at(-0.9))
    assert low.first(10) > 0 > low.first(50)


def test_bending():
    """Without beta nothing changes, larger beta stiffens, the unstable n are bounded; both methods agree."""
    bent, f = ben.Bent(form(5.73)), form(5.73)
    assert bent.first(10, 0.0)[0] == pytest.approx(f.first(10), rel=1e-12)
    values = [bent.first(10, b)[0] for b in (0.0, 1e-5, 1e-4, 1e-3)]
    assert np.all(np.diff(values) > 0)
    beta = ben.koiter(0.01, 0.01)
    assert f.first(300) < 0 < bent.first(300, beta)[0]
    shot = Transfer(rel.cylinder(FLUID, 5.73).parts(10)[1], 10, beta)
    assert shot.lowest(1)[0] == pytest.approx(bent.first(10, beta)[0], abs=1e-9)


def test_a_rigid_motion_bends_nothing():
    """Koiter's changes of curvature of a sideways and an upward shift, on a cylinder, a cone and a bulge."""
    base = {"r": [1.0, 1.2, 1.5], "dr": [0.0, 0.4, 0.3], "dz": [1.0, 0.9, 1.1], "dj": [0.0, 0.0, 0.2]}
    base = {name: np.array(values) for name, values in base.items()} | {"R": np.array([1.0, 1.1, 0.9])}
    base["j"] = np.hypot(base["dr"], base["dz"])
    sideways, upwards = np.zeros(9), np.zeros(9)
    sideways[[koi.U0, koi.Q0]] = 1.0, -1.0
    upwards[koi.W0] = 1.0
    for n, shift in ((1, sideways), (0, upwards)):
        for change in koi.curvatures(base, n):
            assert np.abs(change @ shift).max() < 1e-14


def test_koiters_bending_energy_by_two_ways_is_the_committed_table():
    """Polynomials with continuous slopes, and Hermite elements, at the first row of ``bending_models``."""
    rows = (Path(__file__).parents[3] / "reference_data/paper5/bending_models.csv").read_text().splitlines()
    row = dict(zip(rows[0].split(","), map(float, rows[1].split(",")), strict=True))
    solved = cas.solved(FLUID, row["zw"])
    spectral = koi.spectral(quadratic(solved.tracked[0]), row["n"], row["beta"])
    hermite = koi.hermitian(form(row["zw"]), row["n"], row["beta"], 150)
    assert spectral == pytest.approx(row["Lambda_B2"], abs=2e-7)
    assert hermite == pytest.approx(row["Lambda_B2"], abs=2e-7)


def test_mass_scales_eigenvalues_only():
    """The sign of the lowest eigenvalue depends on the stiffness only."""
    f = form(3.75)
    k, m, _ = f.matrices(20)
    heavy = np.linalg.eigvalsh(k.toarray())
    assert np.sum(heavy < 0) == np.sum(f.lowest(20, 6)[0] < 0) == 1
    assert abs(k - k.T).max() < 1e-9
    assert abs(m - m.T).max() < 1e-12


def test_profiles_keep_their_values_when_elements_are_cut():
    f = form(3.0)
    cut = replace(f.state).split(3)
    assert cut.edges[::3] == pytest.approx(f.state.edges, abs=1e-14)
    assert np.array_equal(cut.y[::3, 0], f.state.y[:, 0])
    assert cut.y[2::3, -1] == pytest.approx(f.state.y[:, -1], abs=1e-12)


def test_limit_point_of_the_hemisphere_has_a_vanishing_axisymmetric_eigenvalue():
    state = lim.held(-1.5694031544)[0]
    assert state.load == pytest.approx(-0.478346253715, abs=1e-9)
    assert abs(quadratic(state).first(0)) < 1e-4
