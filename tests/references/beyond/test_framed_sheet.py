"""The reference of framed sheets: what both methods share, and small resolutions against the tables."""

import numpy as np
import pytest

from reference_data.solvers.beyond.collocated_sheet import CollocatedSheet, chebyshev
from reference_data.solvers.beyond.framed_sheet import (
    CLASSES,
    Found,
    Framed,
    Kirchhoff,
    derivatives,
    energy,
    follow,
    limit,
    normal,
    normal_rates,
    solve,
    stresses,
)
from reference_data.solvers.beyond.ritz_sheet import RitzSheet
from weakforms.verification.cases import references

RNG = np.random.default_rng(0)


def tangents(count=5):
    x1, x2 = RNG.normal(size=(2, 3, count)) * 0.2
    x1[0] += 1.3
    x2[1] += 1.1
    return x1, x2


def metric(x1, x2):
    return np.array([np.sum(x1 * x1, 0), np.sum(x2 * x2, 0), np.sum(x1 * x2, 0)])


@pytest.mark.parametrize("alpha", [0.0, 0.1, Kirchhoff(0.4)])
def test_gradient_and_hessian_are_those_of_the_energy(alpha):
    c, h = metric(*tangents()), 1e-20
    gradient, hessian = derivatives(c, alpha)
    for i in range(3):
        shifted = c.astype(complex)
        shifted[i] += 1j * h
        np.testing.assert_allclose(energy(shifted, alpha).imag / h, gradient[i], rtol=1e-13)
        for sign in (1e-6, -1e-6):
            moved = c.copy()
            moved[i] += sign
            step = (derivatives(moved, alpha)[0] - gradient) / sign
            np.testing.assert_allclose(step, hessian[:, i], rtol=1e-3, atol=1e-4)


def test_stresses_are_the_derivative_of_the_energy_in_the_tangents():
    x1, x2 = tangents()
    stress, moduli = stresses(x1, x2, 0.1)
    h = 1e-6
    for s in range(2):
        for j in range(3):
            ends = []
            for sign in (1, -1):
                moved = [x1.copy(), x2.copy()]
                moved[s][j] += sign * h
                ends.append((energy(metric(*moved), 0.1), stresses(*moved, 0.1)[0], normal(*moved)))
            up, down = ends
            np.testing.assert_allclose((up[0] - down[0]) / (2 * h), stress[s, j], rtol=1e-7, atol=1e-8)
            np.testing.assert_allclose((up[1] - down[1]) / (2 * h), moduli[:, :, s, j], rtol=1e-6, atol=1e-6)
            turned = normal_rates(x1, x2)[:, s, j]
            np.testing.assert_allclose((up[2] - down[2]) / (2 * h), turned, rtol=1e-7, atol=1e-8)


def test_chebyshev_points_differentiate_and_integrate_polynomials():
    x, d, weights = chebyshev(12)
    np.testing.assert_allclose(d @ x**5, 5 * x**4, atol=1e-12)
    assert weights @ x**8 == pytest.approx(2 / 9, rel=1e-13)


@pytest.mark.parametrize(("code", "size"), [(RitzSheet, 12), (CollocatedSheet, 8)])
def test_a_small_resolution_is_near_the_table(code, size):
    of = code(Framed(0.0), size)
    first = solve(of.equations, of.centre, of.start(0.05, 0.12), 0.05)
    (near,) = follow(of.equations, of.centre, first, np.array([1.3]))
    found = of.columns(limit(of.equations, of.centre, near))
    table = references.load("beyond", "rectangle_gas_limit").columns
    assert found["load"] == pytest.approx(table["p"][0], rel=1e-5)
    assert found["amount"] == pytest.approx(table["V"][0], rel=1e-4)


@pytest.mark.parametrize("code", [RitzSheet, CollocatedSheet])
def test_the_flat_sheet_has_the_energy_of_its_stretch(code):
    of = code(Framed(0.1, delta=1.2), 6)
    flat = of.start(0.0, 0.0)
    assert np.abs(of.equations(flat.u, 0.0)[0]).max() < 1e-12
    t, d = 2 * 1.2**2, 1.2**4
    exact = 4 * (t + 1 / d - 3 + 0.1 * (d + t / d - 3))
    assert of.columns(flat)["U"] == pytest.approx(exact, rel=1e-12)


@pytest.mark.parametrize("code", [CollocatedSheet(Framed(0.0), 9), RitzSheet(Framed(0.0), 14)])
def test_eigenvalues_of_a_flat_sheet_are_those_of_its_waves(code):
    """S (pi/2)^2 (m^2 + n^2) in the class of each wave; in A2 a mode in the plane is lower."""
    flat = Found(np.zeros(len(code.centre)), 0.0, 0.0, 0.0)
    found, stress = {name: code.lowest(flat, name) for name in CLASSES}, 2 * (1 - 1.1**-6)
    for name, squares in {"A1": 1 + 1, "E": 1 + 4, "B2": 4 + 4, "B1": 1 + 9}.items():
        assert found[name] == pytest.approx(stress * (np.pi / 2) ** 2 * squares, rel=1e-6), name
    assert found["A2"] < stress * (np.pi / 2) ** 2 * (4 + 16)


@pytest.mark.parametrize("code", [CollocatedSheet(Framed(0.0), 9), RitzSheet(Framed(0.0), 14)])
def test_eigenvalues_by_class_are_those_of_the_table(code):
    table = references.load("beyond", "rectangle_gas_classes")
    first = solve(code.equations, code.centre, code.start(0.05, 0.12), 0.05)
    (state,) = follow(code.equations, code.centre, first, np.array([0.3]))
    for name in CLASSES:
        assert code.lowest(state, name) == pytest.approx(table.columns[f"eigenvalue_{name}"][0], rel=1e-4), (
            name
        )
