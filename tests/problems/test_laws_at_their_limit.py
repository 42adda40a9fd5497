"""Disks stretched to what their law takes: a true reason in terms of the parameters, no internal error."""

import re
from contextlib import nullcontext
from types import SimpleNamespace

import numpy as np
import pytest

from weakforms import solve
from weakforms.errors import ConvergenceError, InputError
from weakforms.forms.materials import MATERIALS
from weakforms.problems import registry
from weakforms.problems.material_choice import Chosen, mooney_rivlin_of
from weakforms.problems.meridian.limits import limit_of
from weakforms.problems.meridian.pre_stretch import require_held, require_low, require_taut
from weakforms.problems.problem import Requests, validated
from weakforms.solvers.equilibrium.system import System

COARSE = {"cells": 8, "degree": 3, "levels": 2}


def law(model, **constants):
    known = {name: c.default for name, c in MATERIALS[model].constants.items()} | constants
    return Chosen(model, tuple(known.items()))


@pytest.mark.parametrize(
    ("given", "stretch", "why"),
    [
        # The chains' stretch is sqrt(2/3) lam at large equal stretches: full extension at sqrt(3/2 links).
        ({"model": "arruda_boyce", "links": 20.0, "beta": 2.0}, np.sqrt(30.0), "beyond its end"),
        # w,11 = 2 mu lam2 (2 - lam2/f2): it is 0.02 w,1/lam at 3.985; the last step may pass that.
        ({"model": "harmonic", "f2": 2.0, "beta": 3.0}, 3.985, "hardly resists"),
    ],
)
def test_a_disk_is_inflated_to_where_its_law_ends_and_says_so(given, stretch, why):
    result = solve("circular", **given, t_end=8.0, numerics=COARSE | {"step": 0.16})
    assert result.failures == []
    (rest,) = result.absent
    assert re.search(rf"followed up to t0 = .*{why}.*lower t_end", rest.reason)
    reached = result.branch().columns["lam_pole"][-1]
    assert 0.97 * stretch < reached < 1.02 * stretch
    assert given["model"] == "harmonic" or reached < stretch


@pytest.mark.parametrize(
    ("chosen", "beta", "why"),
    [
        (law("arruda_boyce", links=1.521), 5.973, "beyond its end"),
        (law("harmonic", f2=2.599), 8.807, "hardly resists"),
        (law("harmonic", f2=1.2), 2.65, "gives no tension|hardly resists"),
    ],
)
def test_a_pre_stretch_that_the_law_does_not_take_is_refused(chosen, beta, why):
    with pytest.raises(InputError, match=rf"circular: beta = {beta:g}: .*({why}).*; lower beta"):
        require_taut("circular", chosen, beta, "beta")
    require_taut("circular", chosen, 1.01, "beta")


def test_a_mooney_rivlin_membrane_takes_any_stretch_and_others_what_is_within_their_limit():
    assert limit_of(mooney_rivlin_of(0.1), [(50.0, 50.0)]) == ""
    gent = law("gent", jm=20.0)  # equal stretches: 2 lam^2 + lam^-4 - 3 = jm at lam = 3.39
    assert limit_of(gent, [(3.3, 3.3)]) == ""
    assert limit_of(gent, [(1.0, 1.0), (3.38, 3.38)])
    assert limit_of(law("varga"), [(2.0, 2.0)]) == ""
    assert "hardly resists" in limit_of(law("varga"), [(8.0, 8.0)])


def test_a_law_is_not_followed_to_stresses_without_measure():
    """With an exponent of 38 a stretch of 13.87 gives 1e40; the trace did not end within 3000 points."""
    steep = {
        "mu1": 3.243,
        "alpha1": 13.09,
        "mu2": 0.0005517,
        "alpha2": 38.64,
        "mu3": -0.03626,
        "alpha3": -65.32,
    }
    for problem, end in (
        ("infinite_tube", 13.87),
        ("sphere", 8.0),
        ("homogeneous", 20.0),
        ("homogeneous", 0.2),
    ):
        with pytest.raises(InputError, match=rf"{problem}: .* more than 1e\+06 times .*lam_end nearer to 1"):
            solve(problem, model="ogden", **steep, lam_end=end)
    assert "stresses of more than" in limit_of(law("ogden", **steep), [(1.0, 13.87)])
    thick = {"alpha": 0.0, "loading": "equibiaxial", "lam_end": 0.06}
    assert solve("homogeneous", **thick, numerics={"step": 0.5}).failures == []


@pytest.mark.parametrize("problem", ["tube", "wrinkled_tube", "fluid_tube"])
def test_an_axial_pre_stretch_with_stresses_without_measure_is_refused(problem):
    name = "delta1" if problem == "tube" else "delta"
    steep = {"alpha2": 64.0, "mu2": 0.01}
    with pytest.raises(InputError, match=rf"{problem}: {name} = 4: .* more than 1e\+06 times .*lower {name}"):
        solve(problem, model="ogden", **steep, **{name: 4.0})
    chosen = registry.get(problem)
    parameters = validated(chosen.parameters, {"model": "ogden", name: 4.0}, problem)
    chosen.check(parameters, Requests())


def test_the_pre_stretch_is_refused_before_anything_is_solved():
    with pytest.raises(InputError, match=r"beta = 9: .*lower beta"):
        solve("circular", model="gent", jm=5.0, beta=9.0)


def test_stretches_at_which_the_law_is_not_defined_are_no_state():
    """A converged residual does not see nodes beyond full extension; the largest values of columns do."""
    held = SimpleNamespace(formulation=SimpleNamespace(maxima={"t": 0}), _peaks={"t": lambda: np.inf})
    held._interpolant = SimpleNamespace(update=lambda: None)
    with pytest.raises(ConvergenceError, match="stretches at which the law is not defined"):
        System._maxima(held)
    held._peaks = {"t": lambda: 2.0}
    assert System._maxima(held) == {"t": 2.0}


def test_a_law_that_hardly_gives_is_not_advised_a_substrate_inside_of_the_tube():
    law = {"model": "beda_chevalier", "k1": 0.8082, "k2": 21.58, "k3": 0.00424, "power": 16.8}
    given = law | {"delta1": 3.375, "lf": 27.88, "s": 1.343, "contact": "adhesive", "phase": "deflation"}
    with pytest.raises(
        InputError, match="all but inextensible; choose less pre-stretch, or constants of the law"
    ):
        solve("tube", **given, numerics={"cells": 32, "levels": 2})


@pytest.mark.parametrize(
    ("refuse", "given", "words"),
    [(require_held, (), "Af = 1.005: .* up to 1$"), (require_low, (False,), "w_end = 1.005: .* up to 1$")],
)
def test_a_bounded_force_holds_up_to_the_stated_size_and_no_further(refuse, given, words):
    refuse("a problem", law("varga"), 1.0, *given)
    with pytest.raises(InputError, match=words):
        refuse("a problem", law("varga"), 1.005, *given)
    refuse("a problem", law("neo_hookean"), 1.005, *given)


@pytest.mark.parametrize(
    ("problem", "given"),
    [("homogeneous", {"loading": "equibiaxial"}), ("sphere", {}), ("controls", {"body": "sphere"})],
)
def test_stretches_beyond_those_at_which_a_law_has_no_thickness_are_refused(problem, given):
    """``lam3 = 3 + (lam^2 - 1)/f2 - 2 lam`` is negative between two stretches, and 27.7 is beyond both."""
    f2 = 9.162
    most = f2 * (1 - np.sqrt(1 - (3 - 1 / f2) / f2))
    law = {"model": "harmonic", "f2": f2, **given}
    with pytest.raises(InputError, match=rf"{problem}: .* between rest and lam_end .* beyond {most:.4g}$"):
        solve(problem, **law, lam_end=27.7)
    assert solve(problem, **law, lam_end=0.999 * most).failures == []


@pytest.mark.parametrize(
    ("name", "given", "allowed"),
    [
        ("tube_fold", {"delta1_end": 3.451}, {"delta1_end": 1.6}),
        ("tube", {"delta1": 3.451}, {"delta1": 1.6}),
        ("tube_scheme", {"delta1": 3.451}, {"delta1": 1.6}),
        ("controls", {"body": "tube", "delta1": 3.451}, {"body": "tube", "delta1": 1.6}),
        ("diagram", {"low": 1.0, "high": 3.451}, {"low": 1.0, "high": 1.6}),
    ],
)
def test_a_stretched_tube_that_the_law_does_not_take_is_refused_before_anything_is_solved(
    name, given, allowed
):
    """At ``lam2 = 1`` the law is defined; on disks of the contracted radius the thickness is negative."""
    problem, law = registry.get(name), {"model": "harmonic", "f2": 1.3}
    *_, changed = given
    with pytest.raises(InputError, match=rf"{name}: {changed} = 3\.451 .*harmonic.*lower {changed}"):
        problem.check(validated(problem.parameters, law | given, name), Requests())
    problem.check(validated(problem.parameters, law | allowed, name), Requests())


@pytest.mark.parametrize(("stretch", "borne"), [(1.9, True), (2.1, False)])
def test_a_tube_beyond_the_largest_force_of_a_strip_is_refused(stretch, borne):
    """``F = 2 mu w (lam - w)`` with the width ``w`` of uniaxial tension is largest at ``lam`` = 2.0."""

    def force(lam, f2=5.235):
        width = (3 - 1 / f2 - lam) / (2 - lam / f2)
        return width * (lam - width)

    assert (force(stretch + 1e-3) > force(stretch)) == borne
    law, problem = {"model": "harmonic", "f2": 5.235, "delta1": stretch}, registry.get("tube")
    with nullcontext() if borne else pytest.raises(InputError, match=r"delta1 = 2\.1: .* necks at one place"):
        problem.check(validated(problem.parameters, law, "tube"), Requests())


@pytest.mark.parametrize(("problem", "given"), [("controls", {"body": "tube"}), ("tube", {})])
def test_a_tube_is_inflated_to_where_its_law_has_no_thickness_and_says_so(problem, given):
    delta1, f2 = 1.143, 47.51
    law = {"model": "harmonic", "f2": f2, "delta1": delta1, "lf": 8.0}
    result = solve(problem, **law, **given, u_end=2.4, numerics=COARSE)
    assert result.failures == []
    (rest,) = result.absent
    assert re.search(rf"{problem}: free inflation .* within 1% of it; lower u_end", rest.reason)
    last = {name: float(values[-1]) for name, values in result.branch().columns.items()}
    l1, l2 = last["lam1_mid"], (1 + last["u_max"]) / np.sqrt(delta1)
    thickness, more = (3 + (k * k * l1 * l2 - 1) / f2 - k * (l1 + l2) for k in (1.0, 1.05))
    assert more < 0 < thickness


def test_a_scheme_on_a_fixed_mesh_ends_where_the_law_gives_way():
    """Beyond a stretch of 4.75 at the pole (``circular`` ends there too) each mesh has another stretch."""
    given = {"model": "varga", "shear": 6.0, "beta": 2.5, "k": 10.0, "l": 0.8, "t_end": 1.0}
    result = solve("circular_scheme", **given, numerics={"cells": 64, "steps": 8})
    (rest,) = result.absent
    assert re.search(r"followed up to t0 = 0\.3.*hardly resists .*lower l and t_end", rest.reason)
    assert result.quantities == {}
    assert result.failures == []
    within = solve("circular_scheme", **given | {"l": 0.2, "t_end": 0.25}, numerics={"cells": 64, "steps": 8})
    assert within.quantities
    assert within.absent == []
