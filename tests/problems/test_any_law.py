"""Problems that take any material law: the law of a paper by two names, and limits of a law."""

import pytest

from weakforms import InputError, solve

ALPHA = 0.1
AS_OGDEN = {
    "model": "ogden",
    **{"mu1": 2.0, "alpha1": 2.0, "mu2": -ALPHA, "alpha2": -2.0, "mu3": -ALPHA, "alpha3": -2.0},
}
"""Mooney and Rivlin's law with ``C2/C1 = 0.1`` as Ogden's."""


@pytest.mark.parametrize(
    ("problem", "given", "numerics"),
    [
        ("tube_scheme", {"p_end": 1.9}, {"cells": 32, "steps": 4}),
        ("circular_scheme", {}, {"cells": 32, "steps": 4}),
        pytest.param(
            "fluid_tube_surface", {"extent": "half"}, {"cells": 4, "degree": 3}, marks=pytest.mark.slow
        ),
    ],
)
def test_the_law_of_mooney_and_rivlin_by_two_names_gives_the_same_numbers(problem, given, numerics):
    one, other, without = (
        solve(problem, **given, **law, numerics=numerics)
        for law in ({"alpha": ALPHA}, AS_OGDEN, {"model": "neo_hookean"})
    )
    assert one.failures == other.failures == without.failures == []
    apart = []
    for name, quantity in one.quantities.items():
        # Some are zero: the eigenvalue at the bifurcation, the force that prevents a rotation.
        assert other.quantities[name].value == pytest.approx(quantity.value, rel=1e-8, abs=1e-15), name
        apart.append(abs(without.quantities[name].value - quantity.value))
    assert max(apart) > 1e-2
    assert set(one.quantities) <= set(one.scales), "a number without its scaling"


@pytest.mark.parametrize("energy", ["relaxed", "modified_gradient", "standard"])
def test_a_sheet_of_any_law_has_the_energy_of_the_law(energy):
    given = {"model": "gent", "l1": 1.5, "l2": 0.5}
    suffix = {"relaxed": "_relaxed", "modified_gradient": "_modified", "standard": ""}[energy]
    sheet, law = solve("wrinkled_material", energy=energy, **given), solve("material", **given)
    assert {f"{k}{suffix}": q.value for k, q in sheet.quantities.items()}.items() <= {
        k: q.value for k, q in law.quantities.items()
    }.items()


def test_a_wrinkled_sheet_is_not_refused_where_only_the_full_energy_ends():
    """Across the wrinkles a sheet has its natural width, however narrow it is."""
    narrow = {"model": "gent", "jm": 30.0, "l1": 1.5, "l2": 0.05}
    assert solve("wrinkled_material", **narrow).quantities["W2"].value == 0
    with pytest.raises(InputError, match=r"is not defined at l1, l2 = 1\.5, 0\.05"):
        solve("wrinkled_material", energy="standard", **narrow)


def test_a_sheet_of_a_compressible_material_is_refused():
    with pytest.raises(InputError, match=r"allowed: .*ogden"):
        solve("wrinkled_material", model="saint_venant_kirchhoff")
