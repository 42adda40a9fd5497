"""Waves around wrinkled membranes: second variation, spectra and modes."""

from itertools import pairwise

import numpy as np
import pytest
import ufl
from dolfinx import fem
from mpi4py import MPI

from weakforms import reference
from weakforms.errors import ConvergenceError
from weakforms.forms import revolution
from weakforms.forms.fluid import axisymmetric
from weakforms.problems.meridian.fields import Meridian
from weakforms.problems.wrinkled import hemisphere
from weakforms.problems.wrinkled import state as wrinkled_state
from weakforms.problems.wrinkled.body import CYLINDER, HEMISPHERE
from weakforms.problems.wrinkled.membrane import Membrane
from weakforms.problems.wrinkled.problem import NEAR_FRONTS, PAPER_GAMMA
from weakforms.problems.wrinkled.waves import modes as wrinkled_modes
from weakforms.problems.wrinkled.waves.bands import Bands
from weakforms.problems.wrinkled.waves.koiter import shell_eigenvalue
from weakforms.problems.wrinkled.waves.modes import waves_at
from weakforms.solvers.equilibrium.constraints import Held

pytestmark = pytest.mark.paper5
COARSE = {"cells": 6, "levels": 2}
PAPER = {"M": 1.5, "delta": 3.0, "Af": 0.4362}
VALUES = {**PAPER, "c2": 0.01, "L": 8.0}
CELLS = (3, 6)


@pytest.fixture(autouse=True)
def fresh_models():
    """Models are kept between solves: no test may see a form that another test has changed."""
    wrinkled_state.model_on.cache_clear()
    yield
    wrinkled_state.model_on.cache_clear()


def cylinder(load, liquid=True, energy="relaxed"):
    """A fitted state of the paper's cylinder on the finer mesh."""
    values = VALUES | ({"gamma": PAPER_GAMMA} if liquid else {})
    tube = Membrane(MPI.COMM_SELF, CYLINDER, values, liquid, CELLS, 6, energy, NEAR_FRONTS)
    state, _ = tube.by_homotopy(load)
    return tube.fitted(tube.plain(state), Held(tube.control, load))[-1]


def bowl(level):
    """A fitted state of the paper's hemisphere on the finer mesh."""
    values = {"c2": 0.0, "gamma": hemisphere.GAMMA}
    membrane = Membrane(MPI.COMM_SELF, HEMISPHERE, values, True, CELLS, 6, "relaxed", hemisphere.NEAR_FRONTS)
    held = membrane.plain(membrane.by_gas(hemisphere.START))
    for zw in np.linspace(hemisphere.START, level, 6):
        held = membrane.fitted(held, Held("zw", float(zw)))[-1]
    return held


STATES = {
    "liquid, wrinkled all over": (lambda: cylinder(3.0), VALUES | {"gamma": PAPER_GAMMA, "zw": 3.0}),
    "liquid, taut zone": (lambda: cylinder(8.0), VALUES | {"gamma": PAPER_GAMMA, "zw": 8.0}),
    "gas, taut zone": (lambda: cylinder(0.2, liquid=False), VALUES | {"p": 0.2}),
    "hemisphere": (lambda: bowl(-0.9), {"c2": 0.0, "gamma": hemisphere.GAMMA, "zw": -0.9}),
}


# -- the whole energy, by quadrature of its own ---------------------------------------------------------


def shapes(t):
    """Three smooth functions of ``t`` in [0, 1] with triple zeros at both ends, and their derivatives."""
    bump, bump_t = (t * (1 - t)) ** 3, 3 * (t * (1 - t)) ** 2 * (1 - 2 * t)
    parts = []
    for k, shift in ((3.0, 0.3), (2.0, 1.1), (4.0, 0.7)):
        wave, wave_t = np.cos(k * t + shift), -k * np.sin(k * t + shift)
        parts.append((64 * bump * wave, 64 * (bump_t * wave + bump * wave_t)))
    return parts


def base_at(held, s):
    """``r, z`` and their derivatives at material points."""
    e = held.model.expressions
    fields = Meridian(held.model, {k: e[k] for k in ("r", "z", "r_s", "z_s")})
    with held.lent():
        return fields.sampled(s, held.state.loads)


def gauss(held):
    """Points and weights in ``S``, with break points between them."""
    x, w = np.polynomial.legendre.leggauss(10)
    breaks = held.model.breaks_of(held.state.loads)
    edges = np.concatenate([np.linspace(a, b, 9)[:-1] for a, b in pairwise(breaks)])
    edges = np.append(edges, breaks[-1])
    half = np.diff(edges) / 2
    points = ((edges[:-1] + half)[:, None] + half[:, None] * x).ravel()
    return points, (half[:, None] * w).ravel()


def whole_energy(held, q, n, e, angles=48):
    """Energy over ``2 pi`` waves of the surface displaced by ``e`` times the shapes, over ``pi``.

    Principal stretches are eigenvalues by numpy; each point uses the energy of its own state.
    """
    s, weights = gauss(held)
    base, length = base_at(held, s), held.model.breaks_of(held.state.loads)[-1]
    (u, u_t), (v, v_t), (w, w_t) = shapes(s / length)
    u_s, v_s, w_s = u_t / length, v_t / length, w_t / length
    pole = held.model.body.pole
    radius = np.sin(s) if pole else np.ones_like(s)
    thickness = np.ones_like(s) if pole else q["M"] + 2 * (1 - q["M"]) * s / q["L"]
    total = 0.0
    for theta in 2 * np.pi * np.arange(angles) / angles:
        c, k = np.cos(n * theta), np.sin(n * theta)
        # In the frame e_r, e_theta, e_z at theta.
        x = np.array([base["r"] + e * u * c, e * v * k, base["z"] + e * w * c])
        a = np.array([base["r_s"] + e * u_s * c, e * v_s * k, base["z_s"] + e * w_s * c])
        b = np.array([-n * e * u * k - x[1], x[0] + n * e * v * c, -n * e * w * k])
        metric = np.array([[(a * a).sum(0), (a * b).sum(0) / radius], [(a * b).sum(0) / radius, 0 * s]])
        metric[1, 1] = (b * b).sum(0) / radius**2
        squares = np.linalg.eigvalsh(np.moveaxis(metric, 2, 0))
        total += weights @ (thickness * radius * relaxed_energy(*squares.T[::-1], q["c2"]))
        normal = np.cross(b.T, a.T).T
        if "zw" in q:
            total += weights @ (q["gamma"] * np.maximum(q["zw"] - x[2], 0) ** 2 / 2 * normal[2])
        else:
            total -= weights @ (q["p"] * (x * normal).sum(0) / 3)
    return 2 * total / angles


def relaxed_energy(x1, x2, c2):
    """Relaxed energy as a function of the squared principal stretches, the larger first."""
    full = x1 + x2 + 1 / (x1 * x2) - 3 + c2 * (1 / x1 + 1 / x2 + x1 * x2 - 3)
    lam = np.sqrt(x1)
    folded = lam**2 + 2 / lam - 3 + c2 * (2 * lam + 1 / lam**2 - 3)
    return np.where(x2 * lam > 1, full, folded)


def quadratic_form(held, n):
    """``d^T K d`` of the compiled second variation for the same shapes."""
    with waves_at(held) as waves:
        variation = waves.variation(n)
        tangent = variation.tangent()
    space = variation.unknown.function_space
    x = space.tabulate_dof_coordinates()[:, 0]
    t = held.model.material(x, held.state.loads) / held.model.breaks_of(held.state.loads)[-1]
    d = np.column_stack([part for part, _ in shapes(t)]).ravel()
    d[variation.bc_dofs] = 0.0
    return variation.dot(d, variation.multiply(tangent, d))


def lowest(held, n, beta=0.0):
    with waves_at(held) as waves:
        return waves.spectrum(n, 1, beta).eigenvalues[0]


@pytest.mark.parametrize("name", STATES)
def test_second_variation_is_that_of_the_whole_energy(name):
    """The step is so small that the quadrature does not notice the motion of a front."""
    make, q = STATES[name]
    held = make()
    for n, e in ((2, 1e-4), (7, 3e-5), (30, 1e-5)):
        values = [whole_energy(held, q, n, a) for a in (-e, 0.0, e)]
        second = (values[0] - 2 * values[1] + values[2]) / e**2
        assert second == pytest.approx(quadratic_form(held, n), rel=1e-5), n


@pytest.mark.parametrize("name", STATES)
def test_operator_is_symmetric(name):
    held = STATES[name][0]()
    with waves_at(held) as waves:
        variation = waves.variation(13)
        tangent = variation.tangent()
    a, b = np.random.default_rng(3).standard_normal((2, variation.size))
    a[variation.bc_dofs] = b[variation.bc_dofs] = 0.0
    left, right = (variation.dot(p, variation.multiply(tangent, r)) for p, r in ((a, b), (b, a)))
    assert left == pytest.approx(right, rel=1e-11)


# -- spectra ------------------------------------------------------------------------------------------


def test_axisymmetric_spectrum_is_part_of_that_for_no_waves():
    """Without waves the angle decouples: torsion, and the tangent of the equilibrium."""
    held = cylinder(8.0)
    with waves_at(held) as waves:
        own = waves.spectrum(0, 4).eigenvalues
        whole = np.array(waves.variation(0.0).spectrum(12).eigenvalues)
    for value in own[:4]:
        assert np.abs(whole - value).min() < 1e-9 * max(1.0, abs(value))


def test_without_pressure_the_lowest_eigenvalue_is_positive_and_the_same_for_all_waves():
    held = cylinder(0.0)
    found = [lowest(held, n) for n in (1, 2, 10, 50, 200)]
    assert found[0] > 0.1
    assert np.ptp(found) < 1e-9


def test_the_full_energy_is_unstable_to_short_waves_even_without_pressure():
    """Compression makes an ordinary membrane unstable as ``n^2``, but not the relaxed one."""
    held = cylinder(0.0, energy="standard")
    found = [lowest(held, n) for n in (20, 40, 80)]
    assert found[2] < found[1] < 0
    assert found[2] / found[1] > 3


def test_short_waves_follow_the_local_limit():
    r"""``Lambda_1/n`` tends to ``-max p lam1/(H R)`` from above, with a correction in ``n^(-1/2)``."""
    held = cylinder(3.0)
    s = np.linspace(0, 8, 4001)
    found = held.sampled(s)
    pressure = PAPER_GAMMA * np.maximum(3.0 - found["z"], 0)
    mu = (pressure * found["lam1"] / (1.5 - s / 8)).max()
    rates = {n: lowest(held, n) / n for n in (50, 100, 200, 400)}
    gaps = np.array([rates[n] + mu for n in rates])
    assert np.all(gaps > 0)
    assert np.all(np.diff(gaps) < 0)
    assert gaps[-1] < 0.5 * mu


def test_a_mode_has_unit_length_and_no_meridional_part():
    held = cylinder(3.0)
    s, weights = gauss(held)
    with waves_at(held) as waves:
        mode = waves.sampled(waves.lowest_mode(100), s, held.state.loads)
    square = sum(mode[name] ** 2 for name in wrinkled_modes.MODE)
    assert weights @ ((1.5 - s / 8) * square) == pytest.approx(1.0, rel=1e-6)
    assert np.abs(mode["meridional"]).max() < 0.02 * mode["normal"].max()
    assert mode["normal"].max() >= -mode["normal"].min()


def test_one_wave_may_shift_the_pole_and_more_may_not():
    held = bowl(-0.8)
    place = np.array([0.0])
    for n, moves in ((1, True), (2, False)):
        with waves_at(held) as waves:
            mode = waves.sampled(waves.lowest_mode(n), place, held.state.loads)
        assert (abs(mode["circumferential"][0]) > 1e-3) == moves


def test_bending_stiffness_never_lowers_an_eigenvalue():
    held = cylinder(6.0)
    for n in (5, 10, 40):
        found = [lowest(held, n, beta) for beta in (0.0, 1e-6, 1e-5, 1e-4)]
        assert np.all(np.diff(found) > 0)


def test_the_shells_bending_energy_is_near_that_of_hoops_alone_and_starts_from_the_membrane():
    held = cylinder(6.0)
    plain, hoops = (lowest(held, 10, beta) for beta in (0.0, 6.7e-5))
    assert shell_eigenvalue(held, 10, 0.0) == pytest.approx(plain, rel=1e-9)
    assert 1.0 < (shell_eigenvalue(held, 10, 6.7e-5) - plain) / (hoops - plain) < 1.05


def test_the_shells_bending_energy_is_koiters():
    """First rows of the committed table, on which two other discretisations agree; the mesh leaves 1e-9."""
    rows = reference(5, "bending_models").columns
    for n, zw, beta, expected in zip(*(rows[k][:2] for k in ("n", "zw", "beta", "Lambda_B2")), strict=True):
        assert shell_eigenvalue(cylinder(zw), n, beta) == pytest.approx(expected, abs=2e-8)


@pytest.mark.parametrize("n", [1, 2, 3, 7])
def test_a_ring_bends_by_what_is_known(n):
    """Inextensible waves change a unit ring's curvature by ``(n^2 - 1) u``; one wave is a translation."""
    ring = axisymmetric(1.0, 0.0, (0.0, 1.0))
    bent = revolution.hoop_bending(ring, (1.0, -1.0 / n, 0.0), (0.0, 0.0, 0.0), n)
    assert float(bent) == pytest.approx(-(n**2 - 1), abs=1e-14)


def test_a_tilted_shell_is_rotated_and_not_bent():
    """A rotation about a horizontal axis is one wave; on a curved, tapered meridian every term takes part."""
    r, z, (r_s, z_s), (r_ss, z_ss) = 1.3, 0.7, (0.4, 0.9), (0.2, -0.3)
    shell = axisymmetric(r, z, (r_s, z_s))
    parts, slopes = (z, -z, -r), (z_s, -z_s, -r_s)
    bent = revolution.meridional_bending(shell, parts, slopes, (r_ss, z_ss, z_ss, -r_ss), 1)
    assert [float(k) for k in bent] == pytest.approx([0, 0, np.hypot(r_s, z_s)], abs=1e-14)
    assert float(revolution.hoop_bending(shell, parts, slopes, 1)) == pytest.approx(0, abs=1e-14)


def test_axisymmetric_eigenvalues_are_the_limit_of_very_long_waves():
    """The second variation in waves, with torsion, agrees with the equilibrium's tangent and mass."""
    with waves_at(cylinder(6.0)) as waves:
        short, long = (np.array(waves.spectrum(n, 6).eigenvalues) for n in (2e-3, 1e-3))
        symmetric = waves.spectrum(0, 4).eigenvalues
    limits = (4 * long - short) / 3  # what n adds is of order n^2
    for eigenvalue in symmetric:
        assert np.abs(limits - eigenvalue).min() < 1e-9


def test_eigenvalues_scale_with_the_mass_and_keep_their_sign():
    held = cylinder(3.0)
    with waves_at(held) as waves:
        variation = waves.variation(50)
        light = variation.spectrum(2).eigenvalues
        heavy = ufl.replace(variation.formulation.mass, {})
        variation._forms["mass"], variation._weighed = fem.form(4 * heavy), None
        slow = variation.spectrum(2).eigenvalues
    try:
        assert np.array(slow) == pytest.approx(np.array(light) / 4, rel=1e-8)
    finally:
        variation._forms["mass"], variation._weighed = fem.form(heavy), None


@pytest.mark.parametrize("n", [6, 9.5])
def test_the_stabilising_stiffness_makes_the_lowest_eigenvalue_zero(n):
    bands = Bands(cylinder(6.0))
    beta = bands.stiffness(n)
    assert bands.lowest(n, 0.99 * beta) < -1e-6 < 1e-6 < bands.lowest(n, 1.01 * beta)
    assert abs(bands.lowest(n, beta)) < 1e-9
    with waves_at(bands.held) as waves, pytest.raises(ConvergenceError, match="not positive"):
        waves.stiffness(n, 0.5 * beta)
