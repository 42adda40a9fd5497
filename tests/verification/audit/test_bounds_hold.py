"""The stated uncertainties bound the true errors, over sets of parameters with a known solution.

The claimed rate is defined in :mod:`weakforms.verification.audit.coverage`. By default only the first few
sets are solved; ``-m slow`` solves them all.
"""

from dataclasses import replace

import numpy as np
import pytest

from weakforms import solve
from weakforms.api import solve_requests
from weakforms.problems.about import Family
from weakforms.problems.problem import StateRequest
from weakforms.problems.tube import contact_family
from weakforms.problems.wrinkled import fitted
from weakforms.verification.audit.coverage.families import FAMILIES, QUICK, WIDE
from weakforms.verification.audit.coverage.judged import Judged, judged, solved, statistics
from weakforms.verification.audit.coverage.outcome import MOST, RATE
from weakforms.verification.audit.same import numbers


def checked(found: list[Judged]) -> None:
    assert found
    outside = [
        f"{j.family}, {j.place}: {j.error:.1e} > 2 x {j.uncertainty:.1e}" for j in found if not j.bounded
    ]
    assert outside == []
    assert np.mean([item.within for item in found]) >= RATE
    wide = {
        f"{row.family}, {row.kind}": row.largest for row in statistics(found) if (row.largest or 0) > MOST
    }
    assert wide == {}


@pytest.mark.parametrize("name", QUICK)
def test_first_sets(name):
    family = named(name)
    checked([item for given in family.sets(QUICK[name]) for item in judged(family, given)])


@pytest.mark.slow
@pytest.mark.parametrize("name", [family.name for family in FAMILIES])
def test_many_sets(name):
    family = named(name)
    checked([item for given in family.sets(WIDE) for item in judged(family, given)])


def named(name: str) -> Family:
    return next(family for family in FAMILIES if family.name == name)


def test_sets_are_the_same_in_every_run():
    tube = named("tube")
    assert tube.sets(4) == tube.sets(8)[:4]
    assert len({tuple(given.values()) for given in tube.sets(8)}) == 8


def test_what_is_within_and_how_much_too_wide():
    """Errors of 1, 1.9, 3 and 2 uncertainties; uncertainties 5 and 40 times as large as the errors."""
    item = Judged("tube", (), "quantity p", "quantity", "p", 1.0, 1.0, 0.0, 1e-10)
    found = [replace(item, error=error) for error in (1.0, 1.9, 3.0, 2.0)]
    assert [one.within for one in found] == [True, False, False, False]
    assert [one.bounded for one in found] == [True, True, False, True]
    columns = [replace(item, name="p", uncertainty=5.0), replace(item, name="V", error=0.0, floor=1 / 40)]
    (row,) = statistics(columns)
    assert (row.count, row.within, row.bounded) == (2, 1.0, 1.0)
    assert (row.median, row.largest) == pytest.approx((22.5, 40.0))


def test_an_uncertainty_does_not_depend_on_what_else_is_asked():
    family = named("tube")
    given = family.sets(WIDE)[14]  # the one whose coarse meshes do not resolve it
    bare, full = (StateRequest("u_max", 1.5, profile=profile) for profile in (None, (0.3,)))
    states = solve_requests("tube", given, family.coarse, [bare, full], branch_uncertainty=False).states
    assert states[0].quantities["p"] == states[1].quantities["p"]


# -- constants: what is left where no mesh shows it (docs/reference-methods.md) --------------------


def moved(name: str, numerics: dict, module: object, constant: str, value: float) -> dict[str, float]:
    """How far each number is moved, of itself or of 1, when a constant of the method has another value."""
    family, found = named(name), []
    given = family.sets(1)[0]
    for one in (getattr(module, constant), value):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(module, constant, one)
            found.append(numbers(solved(family, given, numerics)))
    out: dict[str, float] = {}
    for place, number in found[0].items():
        if not place.startswith("branch") and number.name not in ("n_negative",):
            size = max(1.0, float(np.abs(number.values).max()))
            change = float(np.abs(number.values - found[1][place].values).max()) / size
            out[number.name] = max(change, out.get(number.name, 0.0))
    return out


@pytest.mark.slow
@pytest.mark.parametrize("name", ["tube, adhesive", "tube, deflation", "tube, unilateral"])
def test_terms_left_out_of_the_stuck_patchs_series(name):
    """Eight terms more on every mesh; ``f_t`` is a second derivative beside the front."""
    change = moved(name, named(name).coarse, contact_family, "FIRST_TERMS", contact_family.FIRST_TERMS + 8)
    assert change.pop("f_t") <= 5e-6
    assert max(change.values()) <= contact_family.SERIES.size


@pytest.mark.parametrize("name", ["wrinkled_tube, fluid", "hemisphere"])
def test_place_of_a_minimum_where_newtons_method_stops(name):
    """With a thousandth of the step that is accepted."""
    change = moved(name, named(name).coarse, fitted, "FLAT", fitted.FLAT / 1000)
    assert max(change.values()) <= fitted.PLACE / 100


# -- closed forms: all that is left is round-off and Newton's stopping rule ------------------------

EXACT = np.random.default_rng(2016).uniform((1.1, 0.0), (2.5, 0.3), (5, 2)).tolist()
FEW = {"step": 0.5}
"""Few points of the branch: a state is solved for by itself."""


@pytest.mark.parametrize(("lam", "alpha"), EXACT)
def test_balloon(lam, alpha):
    """``P = 4 (1/lam - lam^-7)(1 + alpha lam^2)`` of a Mooney-Rivlin balloon."""
    (state,) = solve("sphere", alpha=alpha, lam_end=3.0, at={"lam": lam}, numerics=FEW).states
    exact = 4 * (1 / lam - lam**-7) * (1 + alpha * lam**2)
    found = state.quantities["P"]
    assert abs(found.value - exact) <= found.uncertainty <= 1e-9


@pytest.mark.parametrize(("lam", "alpha"), EXACT)
def test_uniaxial_piece(lam, alpha):
    """``T = 2 (lam - lam^-2)(1 + alpha/lam)`` of a Mooney-Rivlin strip."""
    given = {"loading": "uniaxial", "alpha": alpha, "lam_end": 3.0}
    (state,) = solve("homogeneous", **given, at={"lam": lam}, numerics=FEW).states
    found = state.quantities["T"]
    assert abs(found.value - 2 * (lam - lam**-2) * (1 + alpha / lam)) <= found.uncertainty <= 1e-9
