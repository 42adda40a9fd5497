"""Forces and laws of homogeneous bodies for which an audit once got no answer."""

import pytest

from weakforms import solve
from weakforms.api import solve_requests
from weakforms.errors import InputError
from weakforms.forms.materials.catalogue import MATERIALS
from weakforms.problems.material_choice import Chosen
from weakforms.problems.meridian.pre_stretch import has_bounded_force


def test_a_stiff_balloon_is_inflated_to_its_end():
    """``P`` exceeds 1000: with steps of 0.05 the trace would have too many points."""
    given = {"alpha": 8.995, "lam_end": 31.7}
    result = solve_requests("sphere", given, {}, [], branch_uncertainty=False)
    assert result.failures == []
    columns = result.branches[0].columns
    assert columns["lam"][-1] > 31.7
    assert columns["P"].max() > 1000
    assert len(columns["lam"]) < 1500


@pytest.mark.parametrize("force", [57.53, -3.0])
def test_a_tube_under_a_large_force_begins_as_a_strip_in_tension(force):
    """``F = 2 (lam - lam^-2)(1 + alpha/lam)`` without pressure, with ``lam2 = lam^(-1/2)``."""
    alpha = 0.265
    columns = solve("infinite_tube", force=force, alpha=alpha, lam_end=1.01).branches[0].columns
    lam, across = columns["lam1"][0], columns["lam2"][0]
    assert columns["p"][0] == pytest.approx(0, abs=1e-12)
    assert across == pytest.approx(lam**-0.5, rel=1e-10)
    assert 2 * (lam - lam**-2) * (1 + alpha / lam) == pytest.approx(force, rel=1e-10)


@pytest.mark.slow
def test_a_stiffening_tube_under_a_force_is_not_turned_inside_out():
    given = {"model": "three_chain", "force": 55.43, "nkt": 0.9659, "links": 209600.0}
    columns = solve("infinite_tube", **given, lam_end=1.05).branches[0].columns
    assert min(columns["lam1"].min(), columns["lam2"].min()) > 0


@pytest.mark.parametrize(
    ("law", "force", "limit"),
    [
        ({"model": "harmonic", "shear": 4.183, "f2": 3.217}, 58.34, "6.298 in tension"),
        ({"model": "varga", "shear": 0.3}, 0.61, "0.5994 in tension"),
        ({"model": "saint_venant_kirchhoff", "shear": 1.0, "poisson": 0.5}, -1.2, "-0.5773 in compression"),
        ({"model": "saint_venant_kirchhoff", "shear": 1.0, "poisson": 0.1}, 94.0, "35.32 in tension"),
    ],
)
def test_a_force_that_a_law_does_not_bear_is_refused_with_the_largest_one(law, force, limit):
    """Largest forces of a strip, of three kinds.

    Varga's is ``2 mu (1 - lam^(-3/2))``. Kirchhoff's ``mu (1 + nu) lam (lam^2 - 1)`` has a least value, and
    its width ``sqrt(1 - nu (lam^2 - 1))`` vanishes, for ``nu = 0.1`` at a force of 36.5; the last of the
    stretches that are tried before that has a force of 35.32.
    """
    with pytest.raises(InputError, match=rf"force = {force:g}: .* no more than {limit}; choose a force near"):
        solve("infinite_tube", **law, force=force, lam_end=1.2)
    within = solve("infinite_tube", **law, force=0.5 * float(limit.split()[0]), lam_end=1.2)
    assert within.failures == []


@pytest.mark.parametrize(
    ("law", "bounded"),
    [(Chosen("varga", (("shear", 2.0),)), True), (Chosen("ogden", ()), False), (Chosen("gent", ()), False)],
)
def test_only_the_force_of_vargas_law_is_bounded(law, bounded):
    known = {name: c.default for name, c in MATERIALS[law.model].constants.items()} | dict(law.constants)
    assert has_bounded_force(Chosen(law.model, tuple(known.items()))) is bounded
