"""What a user may set is described: `show PROBLEM` and the pages print these texts."""

import pytest

from weakforms.problems import registry

PROBLEMS = sorted(registry.problems())


@pytest.mark.parametrize("name", PROBLEMS)
@pytest.mark.parametrize("part", ["parameters", "numerics"])
def test_every_parameter_has_a_description(name, part):
    fields = getattr(registry.get(name), part).model_fields
    assert [key for key, field in fields.items() if not field.description] == []


SCALED = {
    "circular": "alpha beta M k l",
    "tube": "alpha delta1 lf k s",
    "fluid_tube": "L delta gamma alpha",
    "wrinkled_tube": "M delta c2 L Af gamma",
    "hemisphere": "gamma c2",
    "surface": "M delta c2 L Af gamma",
    "rectangle": "delta gamma alpha",
    "annulus": "a alpha",
    "sheet": "alpha c s lam0",
    "torus": "b alpha",
}
"""Parameters of the papers and of sheets that results print with their scaling."""


@pytest.mark.parametrize("name", SCALED)
def test_results_say_how_parameters_are_scaled(name):
    assert set(SCALED[name].split()) <= registry.get(name).scales.keys()
