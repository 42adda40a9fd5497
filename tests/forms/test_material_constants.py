"""Constants of the material laws: which are refused, their defaults, and where the laws are from."""

import re

import pytest
from law_numbers import numbers

from weakforms import solve
from weakforms.errors import InputError
from weakforms.forms.materials import MATERIALS
from weakforms.problems import registry
from weakforms.problems.homogeneous.material_point import NAMES
from weakforms.problems.material_choice import Chosen
from weakforms.problems.problem import validated


@pytest.mark.parametrize(
    ("given_", "words"),
    [
        ({"model": "ogden", "mu1": -1.0}, "mu1 alpha1 positive"),
        ({"model": "ogden", "mu1": 0, "mu2": 0, "mu3": 0}, "must not be 0"),
        ({"model": "gent", "jm": 0}, "jm 0 > 0"),
        ({"model": "gent", "alpha": 0.1}, "alpha no constant gent shear jm"),
        ({"model": "biderman", "c20": -1.0}, "c20 negative"),
        ({"model": "rivlin", "c10": 0, "c01": 0}, "c10 c01 positive"),
        ({"model": "rivlin", "c11": -1}, "c11 -1 >= 0"),
        ({"model": "beda_chevalier", "power": 2}, "power 2 > 2"),
        ({"model": "arruda_boyce", "links": 0.5}, "links 0.5 > 1"),
        ({"model": "harmonic", "f2": 0.6}, "f2 0.6 > 0.666667"),
        ({"model": "saint_venant_kirchhoff", "poisson": 0.7}, "poisson 0.7 <= 0.5"),
        ({"model": "rubber"}, "model rubber neo_hookean"),
        ({"model": "gent", "shear": "stiff"}, "shear stiff number"),
        ({"model": "gent", "shear": float("nan")}, "shear nan number"),
        ({"constants": [["a", 1]]}, "constants own names"),
        ({"model": "gent", "l1": 9.0, "l2": 9.0}, "gent not defined l1 9"),
        ({"model": "harmonic", "l1": 4.0, "l2": 0.5}, "harmonic not defined"),
    ],
)
def test_bad_constants_are_refused_in_one_line(given_, words):
    with pytest.raises(InputError) as error:
        solve("material", **given_)
    text = str(error.value)
    assert "\n" not in text
    assert all(re.search(re.escape(word), text) for word in words.split()), text


def test_constants_stand_among_the_parameters_of_a_result_and_solve_it_again():
    first = solve("material", model="ogden", mu1=1.0, l1=1.3, l2=0.7)
    assert first.parameters["mu1"] == 1.0
    assert first.parameters["alpha3"] == -2.0
    assert "constants" not in first.parameters
    again = solve("material", **first.parameters)
    assert again.quantities == first.quantities


def test_the_papers_own_ratio_is_that_laws_constant_only():
    tube = registry.get("tube").parameters
    assert validated(tube, {"alpha": 0.2}, "tube").material == Chosen("mooney_rivlin", (("alpha", 0.2),))
    other = validated(tube, {"model": "gent", "jm": 50}, "tube")
    assert "alpha" not in other.model_dump()
    assert other.material == Chosen("gent", (("shear", 2.0), ("jm", 50.0)))
    with pytest.raises(InputError, match="alpha is not a constant"):
        validated(tube, {"model": "gent", "alpha": 0.2}, "tube")


def test_every_law_says_where_it_is_from():
    for material in MATERIALS.values():
        assert material.source
        assert material.text
        assert material.scale
        for constant in material.constants.values():
            assert constant.contains(constant.default)
            assert constant.meaning
        assert not material.refusal({n: c.default for n, c in material.constants.items()})


DEFAULTS = {
    "neo_hookean": {},
    "mooney_rivlin": {"alpha": 0.1},
    "rivlin": {"c10": 1, "c01": 0.1, "c20": 0.01, "c11": 1e-3, "c02": 0, "c30": 1e-4}
    | dict.fromkeys(("c21", "c12", "c03"), 0),
    "ogden": {"mu1": 1.491, "alpha1": 1.3, "mu2": 0.003, "alpha2": 5, "mu3": -0.023, "alpha3": -2},
    "biderman": {"c10": 1, "c01": 0.1, "c20": -0.01, "c30": 0.002},
    "rivlin_saunders": {"c10": 1, "c01": 0.2, "q": 3},
    "three_chain": {"nkt": 2, "links": 26.5},
    "arruda_boyce": {"nkt": 2, "links": 26.5},
    "beda_chevalier": {"k1": 1, "k2": 2.36, "k3": 1e-3, "power": 5},
    "saint_venant_kirchhoff": {"shear": 2, "poisson": 0.5},
    "varga": {"shear": 2},
    "gent": {"shear": 2, "jm": 97.2},
    "harmonic": {"shear": 2, "f2": 2},
}
"""What a user gets who names a law only: other numbers would change all results."""


def test_the_defaults_of_a_law_are_those_that_stored_results_were_computed_with():
    assert {
        name: {n: c.default for n, c in material.constants.items()} for name, material in MATERIALS.items()
    } == DEFAULTS


@pytest.mark.parametrize("model", [name for name in MATERIALS if name != "saint_venant_kirchhoff"])
def test_the_unit_of_stress_states_the_shear_modulus_of_the_defaults(model):
    e = 1e-3  # pure shear keeps the area, so that a law without incompressibility has no more to say
    shear = numbers(model, 1 + e, 1 / (1 + e))[NAMES.index("W")] / (2 * e**2)
    says_two = "shear modulus 2 S" in MATERIALS[model].scale
    assert says_two == (abs(shear / 2 - 1) < 0.05 and model != "neo_hookean"), shear
    assert ("S = mu" in MATERIALS[model].scale) == (abs(shear - 1) < 0.01), shear


@pytest.mark.parametrize("term", [1, 2, 3])
def test_exponents_of_ogden_have_another_range_than_moduli(term):
    """With an exponent of -1000 no number can be computed; a modulus of -1000 is merely another rubber."""
    constants = MATERIALS["ogden"].constants
    modulus, exponent = constants[f"mu{term}"], constants[f"alpha{term}"]
    assert (exponent.low, exponent.high) == (-100.0, 100.0)
    assert modulus.low < -1000 < 1000 < modulus.high
    with pytest.raises(InputError, match=f"alpha{term}"):
        solve("material", model="ogden", l1=1.1, l2=1.0, **{f"alpha{term}": -1000.0})
