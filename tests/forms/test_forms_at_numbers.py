"""Kinematics, loads and second variations at plain numbers, against vectors in Cartesian coordinates."""

import numpy as np
import pytest
from ufl import as_ufl, as_vector, lt
from ufl.algorithms.apply_algebra_lowering import apply_algebra_lowering
from ufl.algorithms.apply_derivatives import apply_derivatives

from weakforms.forms import fluid, kinematics, loads, revolution
from weakforms.forms.fluid import Surface
from weakforms.forms.materials.surface import mooney_rivlin_surface, surface_law
from weakforms.forms.series import newton_series

A, B, X = np.array([0.9, 0.3, 1.1]), np.array([-0.2, 1.4, 0.5]), np.array([1.2, 0.7, -0.4])
ALPHA = 0.15
YES, NO = lt(as_ufl(0.0), 1.0), lt(as_ufl(1.0), 0.0)
H = 1e-3
"""Step of differences of fourth order."""


def value(expression) -> float:
    return float(apply_derivatives(apply_algebra_lowering(as_ufl(expression)))(()))


def values(*expressions) -> list[float]:
    return [value(e) for e in expressions]


def components(vector) -> np.ndarray:
    return np.array([value(vector[i]) for i in range(3)])


def vector(numbers) -> object:
    return as_vector([as_ufl(float(x)) for x in numbers])


def surface(x=X, a=A, b=B) -> Surface:
    return Surface(vector(x), vector(a), vector(b))


def slope(f, x: float):
    """Derivative by differences of fourth order."""
    return (8 * (f(x + H) - f(x - H)) - f(x + 2 * H) + f(x - 2 * H)) / (12 * H)


# -- kinematics and loads of surfaces of revolution ---------------------------------------------------


def test_stretches_of_a_surface_of_revolution():
    at = kinematics.revolution_stretches(as_ufl(1.7), as_ufl(0.3), as_ufl(0.4))
    assert values(at.lam1, at.lam2, at.cos_beta) == pytest.approx([0.5, 1.7, 0.8], rel=1e-14)
    at = kinematics.revolution_stretches(as_ufl(1.7), as_ufl(0.3), as_ufl(0.4), (2.0, 3.0))
    assert values(at.lam1, at.lam2, at.cos_beta) == pytest.approx([1.0, 5.1, 0.8], rel=1e-14)


def test_metric_of_a_twisted_sheet():
    r, ratio, rate, turn = 1.3, 1.6, 0.8, 0.45
    c = kinematics.polar_metric(*(as_ufl(x) for x in (ratio, r, rate, turn)))
    gradient = np.array([[rate, 0.0], [r * turn, ratio]])  # of (e_r, e_theta) over (E_R, E_Theta)
    found = [[value(c[i, j]) for j in (0, 1)] for i in (0, 1)]
    assert np.allclose(found, gradient.T @ gradient, rtol=1e-14)


def test_potentials_of_loads():
    """A cone with radius 2 and slopes 3 and 0.5; potentials by hand."""
    rho, rise, out, k, s = (as_ufl(x) for x in (2.0, 3.0, 0.5, 7.0, 1.6))
    assert value(loads.enclosed_volume(rho, rise)) == pytest.approx(6.0, rel=1e-14)
    assert value(loads.gas_potential(rho, rise, as_ufl(1.1))) == pytest.approx(-6.6, rel=1e-14)
    assert value(loads.substrate_potential(rho, rise, k, s, as_ufl(0.5))) == pytest.approx(1.68, rel=1e-13)
    assert value(loads.bed_potential(rho, out, as_ufl(-0.4), k, as_ufl(0.5))) == pytest.approx(
        0.28, rel=1e-13
    )
    wet = loads.liquid_potential(rho, out, as_ufl(0.7), as_ufl(1.2), as_ufl(2.4), YES)
    assert value(wet) == pytest.approx(-0.3, rel=1e-13)
    assert value(loads.liquid_potential(rho, out, as_ufl(0.7), as_ufl(1.2), as_ufl(2.4), NO)) == 0


# -- surfaces in space ---------------------------------------------------------------------------------


def energy(a: np.ndarray, b: np.ndarray) -> float:
    """Mooney-Rivlin energy over mu H, from the principal stretches."""
    squares = np.linalg.eigvalsh([[a @ a, a @ b], [a @ b, b @ b]])
    squares = np.append(squares, 1 / squares.prod())
    return (squares.sum() - 3 + ALPHA * ((1 / squares).sum() - 3)) / 2


def test_energy_and_its_first_variation():
    assert value(fluid.strain_energy(vector(A), vector(B), ALPHA)) == pytest.approx(energy(A, B), rel=1e-13)
    da, db = np.array([0.3, -0.1, 0.2]), np.array([0.1, 0.4, -0.3])
    moved = surface(np.zeros(3), da, db)
    expected = slope(lambda e: energy(A + e * da, B + e * db), 0.0)
    assert value(fluid.membrane_work(surface(), moved, ALPHA)) == pytest.approx(expected, rel=1e-9)


def gent(l1: float, l2: float) -> float:
    """Gent's law over its modulus, ``-(mu J_m/2) ln(1 - (I1 - 3)/J_m)`` with mu = 2 and J_m = 30."""
    return -30 * np.log(1 - (l1**2 + l2**2 + (l1 * l2) ** -2 - 3) / 30)


def test_laws_of_surfaces_by_the_metric():
    """Full energy where taut, that of uniaxial tension elsewhere; a law over S is half as large over mu."""
    l1, l2 = np.sqrt(np.linalg.eigvalsh([[A @ A, A @ B], [A @ B, B @ B]])[::-1])
    law = surface_law("gent", {"shear": as_ufl(2.0), "jm": as_ufl(30.0)})
    assert value(fluid.strain_energy(vector(A), vector(B), law)) == pytest.approx(gent(l1, l2) / 2, rel=1e-12)
    first, second = values(*fluid.principal_resultants(as_ufl(1.4), as_ufl(0.9), law))
    assert first == pytest.approx(slope(lambda x: gent(x, 0.9), 1.4) / 0.9 / 2, rel=1e-8)
    assert second == pytest.approx(slope(lambda x: gent(1.4, x), 0.9) / 1.4 / 2, rel=1e-8)
    c = revolution.gradient_tensor(surface(), as_ufl(1.0), (1.0, 1.0))
    narrow = l1, l1**-0.5
    mooney = mooney_rivlin_surface(as_ufl(ALPHA))
    for given, taut, relaxed in (
        (law, gent(l1, l2), gent(*narrow)),
        (mooney, 2 * energy(A, B), 2 * energy(np.array([narrow[0], 0, 0]), np.array([0, narrow[1], 0]))),
    ):
        assert value(revolution.strain_energy(c, YES, given)) == pytest.approx(taut, rel=1e-12)
        assert value(revolution.strain_energy(c, NO, given)) == pytest.approx(relaxed, rel=1e-12)


def test_principal_stretches_and_resultants():
    squares = np.linalg.eigvalsh([[A @ A, A @ B], [A @ B, B @ B]])[::-1]
    assert values(*fluid.principal_stretches(surface())) == pytest.approx(
        np.sqrt(squares).tolist(), rel=1e-13
    )

    def w(l1, l2):
        return energy(np.array([l1, 0, 0]), np.array([0, l2, 0]))

    found = values(*fluid.principal_resultants(as_ufl(1.4), as_ufl(0.9), ALPHA))
    expected = [slope(lambda x: w(x, 0.9), 1.4) / 0.9, slope(lambda x: w(1.4, x), 0.9) / 1.4]
    assert found == pytest.approx(expected, rel=1e-9)


def test_pressure_on_a_surface():
    normal = np.cross(B, A)
    assert np.allclose(components(fluid.normal(surface())), normal, rtol=1e-14)
    v = np.array([0.2, -0.5, 0.9])
    moved = surface(v, np.zeros(3), np.zeros(3))
    assert value(fluid.pressure_work(surface(), moved, as_ufl(1.3))) == pytest.approx(-1.3 * v @ normal)
    pressure = fluid.hydrostatic(as_ufl(0.2), as_ufl(0.9), as_ufl(0.3), 1.0)
    assert value(pressure) == pytest.approx(0.21, rel=1e-14)
    depth = 1.5 + 0.4  # X[2] = -0.4
    for power in (1, 2):
        expected = depth**power / power * normal[2]
        assert value(fluid.submerged_flux(surface(), as_ufl(1.5), power)) == pytest.approx(
            expected, rel=1e-14
        )
        assert value(fluid.submerged_flux(surface(), as_ufl(-0.5), power)) == 0


def test_potentials_of_gas_and_liquid_on_a_surface():
    normal = np.cross(B, A)
    gas = -0.7 * X[:2] @ normal[:2] / 2
    assert value(revolution.gas_energy(surface(), as_ufl(0.7))) == pytest.approx(gas, rel=1e-14)
    liquid = 0.6 * (1.5 + 0.4) ** 2 / 2 * normal[2]
    given = surface(), as_ufl(1.5), as_ufl(0.6)
    assert value(revolution.liquid_energy(*given, YES)) == pytest.approx(liquid, rel=1e-14)
    assert value(revolution.liquid_energy(*given, NO)) == 0


def test_metric_over_a_scaled_reference():
    c = revolution.gradient_tensor(surface(), as_ufl(1.6), (1.2, 0.8))
    a, b = 1.2 * A, 0.8 * B / 1.6
    found = [[value(c[i, j]) for j in (0, 1)] for i in (0, 1)]
    assert np.allclose(found, [[a @ a, a @ b], [a @ b, b @ b]], rtol=1e-14)


def test_second_derivative_along_a_perturbation():
    found = revolution.second_order(lambda e: 5 - 2 * e + 3 * e**2 + 7 * e**3, as_ufl(0.0))
    assert value(found) == pytest.approx(6.0, rel=1e-14)


# -- harmonic displacements, differentiated in Cartesian coordinates -------------------------------------

N, S0 = 3.0, 0.4
BASE = np.polynomial.Polynomial([1.1, 0.5, -0.3]), np.polynomial.Polynomial([0.2, 0.9, 0.25])
PARTS = [np.polynomial.Polynomial(c) for c in ([0.3, -0.4, 0.7], [-0.2, 0.6, 0.1], [0.5, 0.2, -0.6])]


def frame(t: float) -> np.ndarray:
    """Rows e_r, e_theta, e_z."""
    return np.array([[np.cos(t), np.sin(t), 0], [-np.sin(t), np.cos(t), 0], [0, 0, 1]])


def base_at(s: float, t: float) -> np.ndarray:
    return np.array([BASE[0](s), 0.0, BASE[1](s)]) @ frame(t)


def moved_at(s: float, t: float) -> np.ndarray:
    u, q, w = (p(s) for p in PARTS)
    return np.array([u * np.cos(N * t), q * np.sin(N * t), w * np.cos(N * t)]) @ frame(t)


def derivatives(f, t: float) -> dict[str, np.ndarray]:
    """Position and derivatives of a surface at S0 and an angle."""

    def along(y):
        return slope(lambda x: f(x, y), S0)

    def twice(g, x):
        return slope(lambda y: slope(g, y), x)

    out = {"x": f(S0, t), "s": along(t), "t": slope(lambda y: f(S0, y), t), "st": slope(along, t)}
    return out | {"ss": twice(lambda x: f(x, t), S0), "tt": twice(lambda y: f(S0, y), t)}


@pytest.mark.parametrize("angle", [0.0, np.pi / (2 * N), 0.3])
def test_harmonic_displacement_and_its_derivatives(angle):
    known = derivatives(moved_at, angle)
    q, rates = ([as_ufl(float(p(S0))) for p in parts] for parts in (PARTS, [p.deriv() for p in PARTS]))
    c, s = np.cos(N * angle), np.sin(N * angle)
    found = fluid.harmonic(vector([p(S0) for p in PARTS]), vector([p.deriv()(S0) for p in PARTS]), N, c, s)
    for vectors, key in ((found.x, "x"), (found.a, "s"), (found.b, "t")):
        assert np.allclose(components(vectors), frame(angle) @ known[key], atol=1e-9)
    base = fluid.axisymmetric(
        *(as_ufl(float(p(S0))) for p in BASE), [as_ufl(float(p.deriv()(S0))) for p in BASE]
    )
    still = derivatives(base_at, angle)
    for vectors, key in ((base.x, "x"), (base.a, "s"), (base.b, "t")):
        assert np.allclose(components(vectors), frame(angle) @ still[key], atol=1e-9)
    both = revolution.around(base, tuple(q), tuple(rates), as_ufl(N))
    assert len(both) == 2
    for part, t in zip(both, (0.0, np.pi / (2 * N)), strict=True):
        expected = frame(t) @ (base_at(S0, t) + moved_at(S0, t))
        assert np.allclose(components(part.x), expected, atol=1e-12)


def test_incremental_curvatures():
    """``k_ab = m . (d_,ab - Gamma^c_ab d_,c)`` with the normal m of the base, by differences in space."""
    q, rates = (tuple(as_ufl(float(p(S0))) for p in parts) for parts in (PARTS, [p.deriv() for p in PARTS]))
    base = fluid.axisymmetric(
        *(as_ufl(float(p(S0))) for p in BASE), [as_ufl(float(p.deriv()(S0))) for p in BASE]
    )
    second = tuple(as_ufl(float(p.deriv(2)(S0))) for p in (*BASE, PARTS[0], PARTS[2]))
    hoop = value(revolution.hoop_bending(base, q, rates, as_ufl(N)))
    along, twist, turn = values(*revolution.meridional_bending(base, q, rates, second, as_ufl(N)))

    def changed(pair: str, t: float) -> float:
        x, d = derivatives(base_at, t), derivatives(moved_at, t)
        m = np.cross(x["t"], x["s"])
        m /= np.linalg.norm(m)
        gammas = {c: x[pair] @ x[c] / (x[c] @ x[c]) for c in "st"}
        return float(m @ (d[pair] - gammas["s"] * d["s"] - gammas["t"] * d["t"]))

    quarter = np.pi / (2 * N)
    assert hoop == pytest.approx(changed("tt", 0.0), rel=1e-6)
    assert along == pytest.approx(changed("ss", 0.0), rel=1e-6)
    assert twist == pytest.approx(changed("st", quarter), rel=1e-6)
    x, d = derivatives(base_at, 0.0), derivatives(moved_at, 0.0)
    m = np.cross(x["t"], x["s"])
    assert turn == pytest.approx(float(m @ d["s"]) / np.linalg.norm(m), rel=1e-9)


def test_polynomial_in_newtons_form():
    coefficients, nodes, span, x = [0.7, -0.3, 0.2, 0.05], [2.0, -2.0, 0.5, -1.0], 3.0, 1.1
    t = np.polynomial.Polynomial([-2.0, 4 / span])
    expected = sum(
        c * np.prod([t - node for node in nodes[:k]] or [np.polynomial.Polynomial([1.0])])
        for k, c in enumerate(coefficients)
    )
    found = newton_series([as_ufl(c) for c in coefficients], nodes, as_ufl(x), span)
    assert values(*found) == pytest.approx([expected(x), expected.deriv()(x)], rel=1e-13)
