"""The material laws: admissibility, derivatives, wrinkling, and agreement with the reference codes."""

import math
from fractions import Fraction
from math import comb, factorial

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from law_numbers import default, numbers

from reference_data.solvers.core import langevin
from reference_data.solvers.core import laws as material_laws
from weakforms.forms.materials import MATERIALS
from weakforms.problems.homogeneous.material_point import NAMES, by_metric, evaluated
from weakforms.problems.material_choice import Chosen

INCOMPRESSIBLE = [name for name, m in MATERIALS.items() if m.incompressible]
COMPRESSIBLE = ["saint_venant_kirchhoff", "harmonic"]
STRETCH = st.floats(0.4, 2.4)
CHECKED = settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))


def defined(model: str, a: float, b: float) -> bool:
    return bool(np.all(np.isfinite(numbers(model, a, b))))


# -- the five conditions of section 3.1.1 -----------------------------------------------------------


@pytest.mark.parametrize("model", INCOMPRESSIBLE)
@CHECKED
@given(a=STRETCH, b=STRETCH)
def test_1_energy_is_not_negative(model, a, b):
    assume(defined(model, a, b))
    w = numbers(model, a, b)[0]
    assert w >= -1e-13
    if max(abs(a - 1), abs(b - 1)) > 1e-3:
        assert w > 0


ANGLE = st.floats(0, math.pi)


@pytest.mark.parametrize("model", MATERIALS)
@CHECKED
@given(a=STRETCH, b=STRETCH, turn=ANGLE, skew=st.floats(-2, 2), tilt=ANGLE)
def test_2_energy_does_not_depend_on_the_frame(model, a, b, turn, skew, tilt):
    """By the metric in turned and skew coordinates, of a sheet turned in space, as the forms compute it."""
    assume(defined(model, a, b))
    found = by_metric(default(model), a, b, (turn, skew, tilt))
    energies = {"W_metric": "full"} | ({"W_metric_relaxed": "relaxed"} if len(found) > 1 else {})
    assert found.keys() == energies.keys()
    for name, energy in energies.items():
        assert found[name] == pytest.approx(numbers(model, a, b, energy)[0], rel=1e-9, abs=1e-11)


@pytest.mark.parametrize("model", INCOMPRESSIBLE)
@CHECKED
@given(a=STRETCH, b=STRETCH)
def test_3_energy_is_symmetric_in_all_three_stretches(model, a, b):
    c = 1 / (a * b)
    pairs = [(a, b), (b, a), (a, c), (c, a), (b, c), (c, b)]
    assume(all(defined(model, *p) for p in pairs))
    energies = [numbers(model, *p)[0] for p in pairs]
    assert np.allclose(energies, energies[0], rtol=1e-10, atol=1e-11)


@pytest.mark.parametrize("model", MATERIALS)
def test_4_rest_has_no_energy_and_no_stress(model):
    w, w1, w2, w11, w12, w22 = numbers(model, 1.0, 1.0)
    assert max(abs(w), abs(w1), abs(w2)) < 1e-13
    assert w11 == pytest.approx(w22, rel=1e-13)
    assert w11 > abs(w12) >= 0


@pytest.mark.parametrize("model", INCOMPRESSIBLE)
def test_5_energy_grows_without_bound(model):
    """For stretches to zero and to infinity the energy grows, or ends at a limit of extension."""
    for towards in (np.geomspace(1, 1e-4, 60), np.geomspace(1, 1e4, 60)):
        w = np.array([numbers(model, x, 1.0)[0] for x in towards])
        finite = np.isfinite(w)
        end = len(w) if finite.all() else int(np.argmin(finite))
        assert np.all(np.diff(w[:end]) > 0)
        if finite.all():
            assert w[-1] > 1e3
        else:
            assert not finite[end:].any()


# -- the laws that fail ------------------------------------------------------------------------------


def test_laws_are_classed_as_in_the_thesis():
    """Section 3.1: what is derived from chains is micro-mechanical; Beda and Chevalier's law is a hybrid."""
    classes = {
        "micro-mechanical": {"neo_hookean", "three_chain", "arruda_boyce"},
        "hybrid": {"beda_chevalier"},
        "other": {"saint_venant_kirchhoff", "harmonic"},
    }
    classes["phenomenological"] = set(MATERIALS) - set().union(*classes.values())
    assert {name: law.kind for name, law in MATERIALS.items()} == {
        name: kind for kind, names in classes.items() for name in names
    }


def test_kirchhoff_fails_condition_5_and_3():
    near = [numbers("saint_venant_kirchhoff", x, 1.0)[0] for x in (1e-2, 1e-4)]
    assert near[1] - near[0] < 1e-3
    assert near[1] < 1.01
    a, b = 1.4, 0.9
    assert numbers("saint_venant_kirchhoff", a, b)[0] != pytest.approx(
        numbers("saint_venant_kirchhoff", a, 1 / (a * b))[0], rel=1e-2
    )


def test_harmonic_fails_conditions_1_and_5():
    assert numbers("harmonic", 7.0, 7.0)[0] < 0
    near = [numbers("harmonic", x, 1.0)[0] for x in (1e-3, 1e-4)]
    assert near[1] == pytest.approx(3.0, abs=1e-3)  # 2 mu f(5/2), by hand: it does not grow
    assert abs(near[1] - near[0]) < 1e-2


@pytest.mark.parametrize("model", COMPRESSIBLE)
@CHECKED
@given(a=st.floats(0.8, 1.5), b=st.floats(0.8, 1.5))
def test_they_are_sound_in_moderate_stretches(model, a, b):
    assert numbers(model, a, b)[0] >= -1e-14
    assert numbers(model, a, b)[0] == pytest.approx(numbers(model, b, a)[0], abs=1e-13)


# -- against the references --------------------------------------------------------------------------


def drawn(model: str, data: st.DataObject) -> dict[str, float]:
    """Constants near the defaults, of any allowed sign."""
    out = {}
    for name, c in MATERIALS[model].constants.items():
        out[name] = c.default * data.draw(st.floats(0.7, 1.3), label=name)
    if "poisson" in out:
        out["poisson"] = min(out["poisson"], 0.49)
    return out


@pytest.mark.parametrize("model", MATERIALS)
@CHECKED
@given(data=st.data(), a=st.floats(0.6, 2.0), b=st.floats(0.6, 2.0))
def test_energy_and_derivatives_are_the_references(model, data, a, b):
    constants = drawn(model, data)
    assume(not MATERIALS[model].refusal(constants))
    law = material_laws.BUILDERS[model](**constants)
    with np.errstate(invalid="ignore"):
        expected = np.array(
            [
                law.energy(a, b),
                law.slope(a, b),
                law.slope(b, a),
                law.curvature(a, b),
                law.mixed(a, b),
                law.curvature(b, a),
            ]
        )
    values = evaluated(Chosen(model, tuple(constants.items())), a, b)
    found = np.array([values[n] for n in NAMES])
    if model == "harmonic" and not np.isfinite(found).all():
        assert a + b > 3 + (a * b - 1) / constants["f2"]
        return
    assert np.allclose(found, expected, rtol=1e-10, atol=1e-11)


# -- inverse Langevin function -----------------------------------------------------------------------


@CHECKED
@given(x=st.floats(1e-6, 0.9999))
def test_inverse_langevin(x):
    """Value and derivative of the chain in Gauss's limit of one stretch: epsilon' and epsilon''."""
    from weakforms.forms.materials.chains import NUMERATOR

    assert len(NUMERATOR) == 8
    value, slope = chain(x)
    y = langevin.inverse(np.array(x))
    assert value == pytest.approx(float(y), rel=1e-12)
    assert slope == pytest.approx(float(1 / langevin.langevin_slope(y)), rel=3e-12)


def chain(x: float) -> tuple[float, float]:
    import ufl
    from dolfinx import fem, mesh
    from mpi4py import MPI

    from weakforms.forms.materials.chains import chain_energy, inverse_langevin

    if not hasattr(chain, "compiled"):
        line = mesh.create_unit_interval(MPI.COMM_SELF, 1)
        constant = fem.Constant(line, 0.5)
        at = ufl.variable(constant)
        second = ufl.diff(ufl.diff(chain_energy(at), at), at)
        values = ufl.as_vector([inverse_langevin(constant), second])
        chain.compiled = line, constant, fem.Expression(values, np.array([[0.5]]))
    line, constant, expression = chain.compiled
    constant.value = x
    return tuple(expression.eval(line, np.array([0], dtype=np.int32)).ravel())


def test_beyond_full_extension_there_is_no_number():
    assert all(math.isnan(v) for v in chain(1.0001))
    assert not defined("gent", 8.0, 8.0)
    assert not defined("arruda_boyce", 8.0, 8.0)
    assert not defined("three_chain", 5.2, 1.0)


# -- wrinkling ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("model", INCOMPRESSIBLE)
@CHECKED
@given(a=st.floats(0.5, 2.2), b=st.floats(0.5, 2.2))
def test_modified_gradient_is_the_relaxed_energy(model, a, b):
    # Where states meet, second derivatives jump and rounding decides on which side one stands.
    near = [a - b**-0.5, b - a**-0.5, a - 1, b - 1, a - b]
    assume(min(abs(x) for x in near) > 1e-9)
    assume(defined(model, max(a, b), max(min(a, b), max(a, b) ** -0.5)))
    relaxed, modified = (numbers(model, a, b, e) for e in ("relaxed", "modified_gradient"))
    assert np.allclose(relaxed, modified, rtol=1e-12, atol=1e-12)
    assert relaxed[0] <= numbers(model, a, b)[0] + 1e-12 or not defined(model, a, b)


@pytest.mark.parametrize("model", MATERIALS)
@pytest.mark.parametrize("stretch", [1.05, 1.2, 1.5])
def test_natural_width_leaves_no_stress_across(model, stretch):
    chosen = default(model)
    width = chosen.material.natural_width({n: c for n, c in chosen.constants})(stretch)
    width = float(width(()) if hasattr(width, "ufl_shape") else width)
    assert abs(numbers(model, stretch, width)[2]) < 1e-12
    if chosen.material.incompressible:
        assert width == pytest.approx(stretch**-0.5, rel=1e-15)


# -- the two theories of membranes -------------------------------------------------------------------


def test_elimination_of_the_thickness_is_the_theory_in_space():
    """Naghdi & Tang: with lam3 from zero normal stress both theories have the same stresses."""
    law = material_laws.law("harmonic")
    mu, f2 = law.shear, law.f2
    for a, b in ((1.1, 1.2), (1.5, 1.3), (0.9, 1.4)):
        l3 = 3 + (a * b - 1) / f2 - a - b
        rate = 1 + f2 * (a + b + l3 - 3)  # f'
        assert 2 * mu * (rate - a * b) == pytest.approx(0, abs=1e-13)  # no normal stress
        in_space = [2 * mu * (rate - b * l3), 2 * mu * (rate - a * l3)]
        assert numbers("harmonic", a, b)[1:3] == pytest.approx(in_space, rel=1e-13)


def test_the_harmonic_sheet_is_no_harmonic_material_in_space():
    """W11 - W12 is constant for equation 3.26 with any g, but not for the reduced material of 3.25."""
    differences = []
    for a, b in ((1.1, 1.2), (1.5, 1.3), (0.9, 1.4)):
        _, _, _, w11, w12, _ = numbers("harmonic", a, b)
        differences.append(w11 - w12)
    assert np.ptp(differences) > 0.1


def test_the_incompressible_elimination_is_the_papers():
    a, b = 1.3, 1.1
    l3 = 1 / (a * b)
    in_space = a**2 + b**2 + l3**2 - 3
    assert numbers("neo_hookean", a, b)[0] == pytest.approx(in_space, rel=1e-14)
    pressure = 2 * l3**2  # from sigma_33 = 0
    assert numbers("neo_hookean", a, b)[1] * a == pytest.approx(2 * a**2 - pressure, rel=1e-14)


@pytest.mark.parametrize("term", [1, 2, 3])
def test_one_term_of_ogden_is_a_law(term):
    constants = {f"mu{i}": float(i == term) for i in (1, 2, 3)} | {f"alpha{i}": 2.0 for i in (1, 2, 3)}
    assert MATERIALS["ogden"].refusal(constants) == ""
    assert "must not be 0" in MATERIALS["ogden"].refusal(constants | {f"mu{term}": 0.0})


# -- parameters --------------------------------------------------------------------------------------


def test_the_series_of_chains_has_the_coefficients_of_bernoullis_numbers():
    """ln(sinh y/y) = sum 2^(2k - 1) B_2k / (k (2k)!) y^(2k)."""
    from weakforms.forms.materials.chains import SERIES

    bernoulli = [Fraction(1)]
    for n in range(1, 2 * len(SERIES) + 1):
        bernoulli.append(-sum(comb(n + 1, k) * bernoulli[k] for k in range(n)) / (n + 1))
    exact = [
        Fraction(2 ** (2 * k - 1), k * factorial(2 * k)) * bernoulli[2 * k] for k in range(1, len(SERIES) + 1)
    ]
    assert [float(value) for value in exact] == pytest.approx(list(SERIES), rel=1e-15, abs=0)
