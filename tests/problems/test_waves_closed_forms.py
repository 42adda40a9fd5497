"""The second variation for any wave number, against closed forms of an infinite tube and of a balloon."""

import numpy as np
import pytest
import ufl
from mpi4py import MPI
from scipy.linalg import eigh
from scipy.optimize import brentq

from weakforms.problems.material_choice import Chosen, mooney_rivlin_of
from weakforms.problems.meridian.blocks import Blocks
from weakforms.problems.meridian.body import Body
from weakforms.problems.meridian.model import DRY, TAUT, Marks, MeridianModel
from weakforms.problems.meridian.waves import AXIAL, HOOP, RADIAL, MeridianWaves
from weakforms.problems.wrinkled.model import WrinkledModel
from weakforms.problems.wrinkled.waves.modes import Waves
from weakforms.solvers.equilibrium.state import State

OGDEN = Chosen(
    "ogden",
    (
        ("mu1", 1.491), ("alpha1", 1.3), ("mu2", 0.003), ("alpha2", 5.0), ("mu3", -0.0237), ("alpha3", -2.0)
    ),
)  # fmt: skip
LAWS = {"neo-Hookean": mooney_rivlin_of(0.0), "Mooney-Rivlin": mooney_rivlin_of(0.1), "Ogden": OGDEN}


def energy(law):
    """The law as a function of the squared principal stretches, written here again; any complex numbers."""
    if law.model == "ogden":
        c = dict(law.constants)
        terms = [(c[f"mu{i}"], c[f"alpha{i}"]) for i in (1, 2, 3)]
        return lambda x1, x2: sum(
            m / a * (x1 ** (a / 2) + x2 ** (a / 2) + (x1 * x2) ** (-a / 2) - 3) for m, a in terms
        )
    alpha = dict(law.constants)["alpha"]
    return lambda x1, x2: x1 + x2 + 1 / (x1 * x2) - 3 + alpha * (1 / x1 + 1 / x2 + x1 * x2 - 3)


def derivatives(law, l1, l2, h=5e-3):
    """W_1, W_2, W_11, W_12, W_22 of a law at two stretches, by differences of eighth order."""
    w, steps = energy(law), h * np.array([-4, -3, -2, -1, 0, 1, 2, 3, 4])
    first = np.array([1 / 280, -4 / 105, 1 / 5, -4 / 5, 0, 4 / 5, -1 / 5, 4 / 105, -1 / 280]) / h
    second = np.array([-1 / 560, 8 / 315, -1 / 5, 8 / 5, -205 / 72, 8 / 5, -1 / 5, 8 / 315, -1 / 560]) / h**2
    table = w((l1 + steps[:, None]) ** 2, (l2 + steps[None, :]) ** 2)
    return (
        first @ table[:, 4],
        table[4] @ first,
        second @ table[:, 4],
        first @ table @ first,
        table[4] @ second,
    )


# -- an infinite tube ---------------------------------------------------------------------------------


def straight(law, lz, lt, length):
    """A uniform tube whose ends slide on planes: model, state of equilibrium, and its pressure."""
    body = Body(
        name="straight",
        parameters=(),
        length=lambda _q: length,
        radius=lambda _s, _q: 1.0,
        thickness=lambda _s, _q: 1.0,
        held=((None, 0.0), (None, lz * length)),
    )
    model = MeridianModel(MPI.COMM_SELF, body, {"p": 0.0}, Blocks([0.0, length], 16, 6, 16), material=law)
    _, w2, *_ = derivatives(law, lz, lt)
    p = w2 / (lz * lt)
    x = model.space.tabulate_dof_coordinates()[:, 0]
    state = State(np.column_stack([np.full_like(x, lt), lz * length * x]).ravel(), {"p": p})
    return model, state, p


def symbol(law, lz, lt, p, n, k):
    """Quadratic form of (u cos kz, b cos kz, w sin kz) on a uniform tube, 3 x 3, by its energy in space.

    The energy of the surface is summed over one period in both directions; its second derivatives are central
    differences with Richardson's extrapolation.
    """
    w = energy(law)
    z, th = np.meshgrid(*(2 * np.pi * (np.arange(16) + 0.5) / 16 / m for m in (k, max(n, 1))), indexing="ij")

    def potential(q):
        u, b, v = q
        cz, sz, cn, sn = np.cos(k * z), np.sin(k * z), np.cos(n * th), np.sin(n * th)
        x = np.array([lt + u * cz * cn, b * cz * (sn if n else 1), lz * z + v * sz * cn])
        a = np.array([-k * u * sz * cn, -k * b * sz * (sn if n else 1), lz + k * v * cz * cn])
        c = np.array([-n * u * cz * sn - x[1], x[0] + n * b * cz * cn, -n * v * sz * sn])
        metric = np.moveaxis(
            np.array([[(a * a).sum(0), (a * c).sum(0)], [(a * c).sum(0), (c * c).sum(0)]]), (0, 1), (2, 3)
        )
        squares = np.linalg.eigvalsh(metric)
        normal = np.cross(c, a, axis=0)
        density = w(squares[..., 1], squares[..., 0]) - p * (x[0] * normal[0] + x[1] * normal[1]) / 2
        return density.mean() * (4 if n else 2)

    def second(i, j, h):
        e = np.eye(3) * h
        return (
            potential(e[i] + e[j]) - potential(e[i] - e[j]) - potential(e[j] - e[i]) + potential(-e[i] - e[j])
        ) / (4 * h * h)

    return np.array([[(4 * second(i, j, 1e-3) - second(i, j, 2e-3)) / 3 for j in range(3)] for i in range(3)])


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
@pytest.mark.parametrize("n", [1, 2, 3])
def test_waves_of_a_uniform_tube_have_the_eigenvalues_of_its_symbol(law, n):
    lz, lt, length = 1.3, 1.9, 2.5
    model, state, p = straight(law, lz, lt, length)
    waves = MeridianWaves(model)
    with model.system.at(state):
        assert np.abs(model.system.residual()).max() < 1e-8
        found = waves.operator(n, (AXIAL,), (AXIAL,)).spectrum(6).eigenvalues
    waves_along = (j * np.pi / length for j in range(1, 9))
    exact = [eigh(symbol(law, lz, lt, p, n, k), eigvals_only=True) for k in waves_along]
    exact.append(eigh(symbol(law, lz, lt, p, n, 1e-6)[:2, :2], eigvals_only=True))
    exact = np.sort(np.concatenate(exact))[:6]
    assert found == pytest.approx(exact, abs=3e-6 * np.abs(exact).max())


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
@pytest.mark.parametrize(("lz", "lt"), [(1.0, 1.2), (1.0, 2.0), (1.6, 1.4)])
def test_a_long_tube_bends_where_its_axial_force_is_compressive(law, lz, lt):
    """The lowest eigenvalue of n = 1 is k^2 N/lz + O(k^4), N the axial force with that of the pressure."""
    w1, *_ = derivatives(law, lz, lt)
    scaled = []
    for length in (120.0, 240.0):
        model, state, p = straight(law, lz, lt, length)
        expected, k = (w1 - p * lt**2 / 2) / lz, np.pi / length
        with model.system.at(state):
            values = np.array(MeridianWaves(model).operator(1, (AXIAL,), (AXIAL,)).spectrum(8).eigenvalues)
        assert np.abs(values).min() < 1e-9  # k = 0 is the translation
        scaled.append(values[np.argmin(np.abs(values - expected * k**2))] / k**2)
    assert (4 * scaled[1] - scaled[0]) / 3 == pytest.approx(expected, rel=1e-4)
    assert scaled[1] == pytest.approx(expected, rel=2e-2)


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_a_bulge_of_a_uniform_tube_has_the_closed_form(law):
    lz, lt, length = 1.2, 1.8, 3.0
    model, state, p = straight(law, lz, lt, length)
    w1, _, w11, w12, w22 = derivatives(law, lz, lt)
    with model.system.at(state):
        found = MeridianWaves(model).operator(0, (AXIAL,), (AXIAL,), (HOOP,)).spectrum(3).eigenvalues
    exact = [w22 - p * lz]
    for j in range(1, 8):
        k = j * np.pi / length
        mixed = k * (w12 - p * lt)
        exact += [*np.linalg.eigvalsh([[k**2 * w1 / lz + w22 - p * lz, mixed], [mixed, k**2 * w11]])]
    assert found[:3] == pytest.approx(np.sort(exact)[:3].tolist(), rel=1e-7, abs=1e-7)


def test_a_tube_with_free_ends_may_be_moved_sideways():
    model, state, _ = straight(LAWS["Mooney-Rivlin"], 1.1, 1.7, 2.0)
    # Any state: here not an equilibrium, and not uniform.
    x = model.space.tabulate_dof_coordinates()[:, 0]
    state.u[0::2] += 0.2 * np.sin(2 * x)
    with model.system.at(state):
        variation = MeridianWaves(model).operator(1, (), ())
        tangent = variation.tangent()
        moved, bent = np.zeros((2, variation.size))
        moved[0::3], moved[1::3] = 1.0, -1.0
        bent[0::3], bent[1::3] = 1.0, -0.99
        forms = [variation.dot(d, variation.multiply(tangent, d)) for d in (moved, bent)]
    assert abs(forms[0]) < 1e-11
    assert abs(forms[1]) > 1e-5


# -- a balloon ----------------------------------------------------------------------------------------

BALLOON = Body(
    name="balloon",
    parameters=(),
    length=lambda _q: np.pi / 2,
    radius=lambda t, _q: ufl.sin(t),
    thickness=lambda _t, _q: 1.0,
    shape=lambda t, _q: (1.0, -1.02 * ufl.cos(t)),
    held=((None, None), (None, 0.0)),
    pole=True,
)
"""Half of a sphere, symmetric about its equator."""

DEGREES = {0: (2, 4), 1: (1, 3), 2: (2, 4)}
"""Degrees N of spherical harmonics that are even about the equator, by the waves around the axis."""


def balloon(law, lam):
    """The half balloon at a stretch: model, state, and tau = W_1/lam, S = W_11 + W_12 and W_11, W_12."""
    w1, _, w11, w12, _ = derivatives(law, lam, lam)
    values = {"p": 2 * w1 / lam**2, "c2": dict(law.constants).get("alpha", 0.0)}
    material = law if law.model == "ogden" else None
    model = WrinkledModel(MPI.COMM_SELF, BALLOON, values, 2, 8, 6, "standard", material)
    x = model.space.tabulate_dof_coordinates()[:, 0]
    loads = {name: float(c.value) for name, c in model.constants.items()} | {"b1": np.pi / 4}
    t = model.material(x, loads)
    u = np.column_stack([np.full_like(t, lam - 1), (1.02 - lam) * np.cos(t)]).ravel()
    marks = Marks(np.full(2, TAUT), np.full(2, DRY))
    return model, State(u, loads, marks), w1 / lam, w11, w12


def spherical(degree, tau, w11, w12):
    """Eigenvalues of a balloon for a degree of spherical harmonics: normal and tangential displacement."""
    s, n = w11 + w12, degree * (degree + 1)
    form = [[2 * s + tau * (n - 4), -n * (s - tau)], [-n * (s - tau), n * (n * w11 - w11 + w12 - tau)]]
    return eigh(form, np.diag([1.0, n]), eigvals_only=True)


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
@pytest.mark.parametrize("lam", [1.3, 2.5])
@pytest.mark.parametrize("n", [1, 2])
def test_waves_of_a_balloon_have_its_closed_form(law, lam, n):
    """For n = 1 the sphere may be moved sideways, at no cost; the next one, 3 (S - tau), is the pear's."""
    model, state, tau, w11, w12 = balloon(law, lam)
    waves = Waves(model)
    waves._sheared.value = float(n == 1)  # one wave shifts the pole: u + q = 0 is the condition there
    with model.system.at(state):
        lower = (RADIAL, AXIAL) if n == 1 else (RADIAL, HOOP, AXIAL)
        found = np.array(waves.operator(n, lower, (AXIAL,)).spectrum(8).eigenvalues)
    exact = np.concatenate([spherical(degree, tau, w11, w12) for degree in DEGREES[n]])
    for value in exact:
        assert np.abs(found - value).min() < 2e-6 * max(1.0, abs(value)) or value > found.max()
    if n == 1:
        assert np.abs(found).min() < 1e-7
        assert np.abs(found - 3 * (w11 + w12 - tau)).min() < 2e-6 * (1 + abs(tau))


def test_an_ogden_balloon_becomes_a_pear_where_its_tension_is_extreme():
    """There, inside the falling branch of the pressure, one wave has a zero besides the translation."""

    def parts(lam):
        w1, _, w11, w12, _ = derivatives(OGDEN, lam, lam)
        return w1 / lam, w11 + w12

    stretches = np.linspace(1.1, 4.0, 60)
    excess = np.array([np.subtract(*parts(lam)[::-1]) for lam in stretches])
    (changes,) = np.nonzero(excess[:-1] * excess[1:] < 0)
    assert len(changes) == 2
    for i in changes:
        lam = brentq(lambda x: np.subtract(*parts(x)[::-1]), *stretches[i : i + 2])
        tau, s = parts(lam)
        assert s < 2 * tau  # the pressure falls
        model, state, *_ = balloon(OGDEN, lam)
        waves = Waves(model)
        waves._sheared.value = 1.0
        with model.system.at(state):
            found = np.array(waves.operator(1, (RADIAL, AXIAL), (AXIAL,)).spectrum(8).eigenvalues)
        assert np.sort(np.abs(found))[:2] == pytest.approx(0.0, abs=1e-6)
    for law in (LAWS["neo-Hookean"], LAWS["Mooney-Rivlin"]):
        for lam in stretches:
            w1, _, w11, w12, _ = derivatives(law, lam, lam)
            assert w11 + w12 > w1 / lam
