"""Wrinkled membranes and surfaces near the largest load or pre-stretch that they have."""

import re

import numpy as np
import pytest
from mpi4py import MPI

from weakforms import solve
from weakforms.errors import ConvergenceError, InputError
from weakforms.forms.materials import MATERIALS
from weakforms.problems.material_choice import Chosen
from weakforms.problems.meridian.pre_stretch import mean_stretch_limit, require_width
from weakforms.problems.wrinkled.membrane import Membrane
from weakforms.problems.wrinkled.problem import WrinkledNumerics, WrinkledParameters, wrinkled_membrane

COARSE = {"cells": 6, "levels": 2}
NUMERICS = WrinkledNumerics(**COARSE)


def chosen(model):
    return Chosen(model, tuple((name, c.default) for name, c in MATERIALS[model].constants.items()))


def membrane(**given):
    return wrinkled_membrane(WrinkledParameters(**given), NUMERICS, MPI.COMM_WORLD)


# -- pre-stretches that no force gives ----------------------------------------------------------------


@pytest.mark.parametrize("M", [0.3, 1.344])
def test_the_largest_mean_stretch_of_a_law_whose_force_is_bounded(M):
    """Varga's force per thickness is ``2 mu (1 - lam^(-3/2))``: the stretch is ``(1 - h_min/h)^(-2/3)``."""
    thin, thick = sorted((M, 2 - M))
    s = (np.arange(20000) + 0.5) / 20000
    stretch = (1 - thin / (thin + (thick - thin) * s**3)) ** (-2 / 3)
    assert mean_stretch_limit(chosen("varga"), M) == pytest.approx(np.mean(3 * s**2 * stretch), rel=1e-3)


def test_other_laws_bear_any_pre_stretch_that_is_allowed():
    foldable = [name for name, material in MATERIALS.items() if material.incompressible and name != "varga"]
    assert len(foldable) > 5
    for model in foldable:
        assert mean_stretch_limit(chosen(model), 0.1) > 6


def test_the_membrane_is_found_up_to_its_largest_mean_stretch_and_not_far_beyond():
    most = mean_stretch_limit(chosen("varga"), 0.6)
    given = {"model": "varga", "M": 0.6, "L": 6.0, "Af": 0.4, "load": "gas", "energy": "relaxed"}
    membrane(**given, delta=0.95 * most).by_homotopy(0.0)
    with pytest.raises(ConvergenceError):
        membrane(**given, delta=1.2 * most).by_homotopy(0.0)


GIVES_WAY = {"model": "varga", "M": 1.344, "delta": 4.88}


@pytest.mark.parametrize(
    "problem", ["wrinkled_tube", "wrinkled_sheet", "wrinkled_linear", "wrinkled_bending", "surface"]
)
def test_a_pre_stretch_that_no_force_gives_is_refused_with_the_largest_one(problem):
    """The solve of ``wrinkled_sheet`` ended with a singular matrix."""
    with pytest.raises(
        InputError, match=rf"{problem}: delta = 4\.88: .* by more than 3\.37.*; lower delta, or"
    ):
        solve(problem, **GIVES_WAY)


# -- levels that are far --------------------------------------------------------------------------------

FAR = {"M": 0.9627, "delta": 4.232, "c2": 0.4285, "L": 9.682, "Af": 2.381}


def test_a_level_that_newtons_method_does_not_reach_at_once_is_reached_along_the_branch(monkeypatch):
    """Whether it reaches the level of ``FAR`` at once depends on round-off: here it never does."""
    at_once = solve("wrinkled_linear", zw=3.0, numerics=COARSE).quantities
    reach = Membrane.by_homotopy

    def unloaded_only(self, load):
        if load:
            raise ConvergenceError("the equilibrium is turned inside out")
        return reach(self, load)

    monkeypatch.setattr(Membrane, "by_homotopy", unloaded_only)
    result = solve("wrinkled_linear", zw=3.0, numerics=COARSE)
    assert (result.failures, result.absent) == ([], [])
    for name, quantity in result.quantities.items():
        assert quantity.value == pytest.approx(at_once[name].value, rel=1e-7)


def test_a_wet_end_that_is_taut_is_an_answer_at_any_level():
    result = solve("wrinkled_linear", **FAR, zw=18.02, f=2, numerics=COARSE)
    assert (result.failures, result.quantities) == ([], {})
    (part,) = result.absent
    assert part.what == "wrinkled wet part"
    assert part.reason.startswith("wrinkled_linear: the lower end is dry or taut")


def test_a_level_above_the_limit_is_not_there():
    result = solve("wrinkled_bending", zw=29.0, gamma=9.0, numerics=COARSE)
    assert (result.failures, result.quantities) == ([], {})
    (part,) = result.absent
    found = re.search(r"zw = 29 is not taken .* over \[0, (.*)\], up to 30 times .*; lower zw", part.reason)
    below = solve("wrinkled_bending", zw=0.8 * float(found[1]), gamma=9.0, n=5.0, numerics=COARSE)
    assert (below.failures, below.absent) == ([], [])


# -- surfaces ---------------------------------------------------------------------------------------------

HEAVY = {"delta": 3.395, "c2": 0.05432, "L": 3.846, "gamma": 9.0, "load_end": 6.0}


@pytest.fixture(scope="module")
def limit_level():
    """The level at the limit point of the same membrane, on a meridian."""
    given = {name: value for name, value in HEAVY.items() if name != "load_end"}
    (point,) = solve("wrinkled_tube", M=1.5, Af=0.4362, **given, numerics=COARSE).points("limit_point")
    return point.values["zw"]


@pytest.mark.parametrize(
    ("meridional", "circumferential", "off", "potential"),
    [(30, 12, 0.04, "vertical"), (60, 24, 0.012, "vertical"), (30, 12, 0.04, "horizontal")],
)
def test_a_surface_is_followed_to_its_limit_load(meridional, circumferential, off, potential, limit_level):
    """States of another branch, at higher loads, once followed. The limit converges at second order.

    The force of the horizontal potential jumps with the level: "the step leads to another curve".
    """
    result = solve(
        "surface",
        **HEAVY,
        potential=potential,
        meridional=meridional,
        circumferential=circumferential,
        numerics={"scan": 6, "shown": 1, "eigenvalues": 1},
    )
    assert result.failures == []
    (rest,) = result.absent
    said = r"turns back at its limit load, about zw = ([\d.]+); choose load_start and load_end below it"
    limit = float(re.search(said, rest.reason)[1])
    assert 0 < limit / limit_level - 1 < off
    columns = result.branch().columns
    assert columns["zw"].tolist() == pytest.approx([0.5, 0.5 + 5.5 / 6])
    assert np.all(np.diff(columns["V"]) > 0)


def test_levels_of_a_hemisphere_are_followed_from_its_limit_load_on():
    """A heavier liquid than the paper's has no state at the usual first level, nor at the first guess."""
    result = solve("surface", geometry="hemisphere", size=0.25, gamma=6.0, numerics={"scan": 10, "shown": 1})
    assert result.failures == []
    assert re.search(r"limit load, about zw = -0\.62\d?; choose .* below it", result.absent[0].reason)
    assert result.branch().columns["zw"] == pytest.approx(np.linspace(-0.5, -0.95, 11)[3:])


STIFF = {"model": "rivlin", "c10": 7.0, "c01": 0.0, "c20": 0.0, "c11": 0.0, "c30": 0.0}


@pytest.mark.parametrize(
    ("gamma", "law", "low", "high"),
    [(1.9, {}, 2, 6), (6.1, {}, 2, 6), (13.9, STIFF, 14, 42), (42.1, STIFF, 14, 42)],
)
def test_a_liquid_too_light_or_too_heavy_for_a_hemisphere_is_refused(gamma, law, low, high):
    """A light one ended with DIVERGED_MAX_IT."""
    with pytest.raises(InputError, match=rf"gamma = {gamma:g}: allowed with .*: {low} to {high}$"):
        solve("surface", geometry="hemisphere", gamma=gamma, **law)


@pytest.mark.parametrize(
    ("f2", "delta", "why"),
    [
        (2.0, 2.0, "bears less force the more it is stretched, and a tube of it necks"),
        (0.9657, 2.406, "does not resist a change of its width where that is 1 of the width at rest"),
        (2.0, 2.6, "does not resist a change of its width"),
    ],
)
@pytest.mark.parametrize("problem", ["fluid_tube", "fluid_tube_surface"])
def test_a_compressible_tube_without_a_stable_width_is_refused(problem, f2, delta, why):
    """With ``f2 = 2`` a strip has its largest force near the stretch 1.9."""
    with pytest.raises(InputError, match=f"delta = {delta:g}: .*{why}.*; lower delta"):
        solve(problem, model="harmonic", f2=f2, delta=delta)


def test_a_compressible_tube_below_its_largest_force_is_not():
    law = Chosen("harmonic", (("shear", 2.0), ("f2", 2.0)))
    assert require_width("fluid_tube", law, 1.8, "delta") is None
    assert require_width("fluid_tube", Chosen("varga", (("shear", 2.0),)), 8.0, "delta") is None
