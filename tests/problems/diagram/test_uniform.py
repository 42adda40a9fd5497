"""Lines of balloons and long tubes: against closed forms, and the problems of one parameter."""

import numpy as np
import pytest

from weakforms import solve
from weakforms.errors import InputError
from weakforms.problems.diagram.bodies.balloon import VariedSphere
from weakforms.problems.diagram.bodies.long_tube import FreeTube, HeldTube
from weakforms.problems.homogeneous.material_point import evaluated
from weakforms.problems.material_choice import Chosen, mooney_rivlin_of
from weakforms.solvers.equilibrium.state import State

OGDEN = Chosen(
    "ogden",
    (("mu1", 1.491), ("alpha1", 1.3), ("mu2", 0.003), ("alpha2", 5.0), ("mu3", -0.023), ("alpha3", -2.0)),
)
HELD = {"body": "infinite_tube", "ends": "held"}


@pytest.fixture(scope="module")
def long_tubes():
    return solve("diagram", **HELD, x="lam1", alpha=0.1, high=1.6, kind="localisation,n1")


@pytest.mark.parametrize("law", [OGDEN, mooney_rivlin_of(0.2)], ids=lambda law: law.model)
@pytest.mark.parametrize("n", [1, 2, 3])
def test_modes_of_a_balloon_have_the_eigenvalues_of_the_closed_form(n, law):
    """``[[2S + tau (N-4), -N (S - tau)], [., N (N w11 - w11 + w12 - tau)]]`` with the mass ``diag(1, N)``."""
    model = VariedSphere(law, {})
    (parity, variation), *others = model.operators(f"n{n}").items()
    assert (parity, others) == ((-1) ** n, [])
    for lam in (1.2, 2.4):
        at = evaluated(law, lam, lam)
        tau, s, big = at["W1"] / lam, at["W11"] + at["W12"], n * (n + 1)
        off = -big * (s - tau)
        last = big * (big * at["W11"] - at["W11"] + at["W12"] - tau)
        form = np.array([[2 * s + tau * (big - 4), off], [off, last]]) / np.sqrt(np.outer([1, big], [1, big]))
        wanted = np.linalg.eigvalsh(form)
        if n == 1:  # the other one is a translation
            assert np.abs(wanted).min() == pytest.approx(0, abs=1e-12)
            wanted = wanted[np.abs(wanted) > 1e-9]
            assert wanted == pytest.approx([3 * (s - tau)])
        with model.system.at(State(np.array([lam]), {"p": 2 * at["W1"] / lam**2})):
            found = variation().spectrum(len(wanted)).eigenvalues
        assert 2 * wanted == pytest.approx(found, rel=1e-10)


def test_long_waves_of_a_held_tube_have_the_eigenvalues_of_the_closed_form():
    """The Hessian of ``w - p lam1 lam2^2/2``, and the axial force over ``lam1``."""
    law, l1, l2, p = OGDEN, 1.3, 1.9, 0.7
    model, at = HeldTube(law, {"lam1": l1}), evaluated(law, l1, l2)
    hessian = np.array([[at["W11"], at["W12"] - p * l2], [at["W12"] - p * l2, at["W22"] - p * l1]])
    with model.system.at(State(np.array([l2]), {"p": p, "lam1": l1})):
        bulge = model.operators("localisation")[0]().spectrum(2).eigenvalues
        bend = model.operators("n1")[0]().spectrum(1).eigenvalues
    assert bulge == pytest.approx(np.linalg.eigvalsh(hessian), rel=1e-10)
    assert bend == pytest.approx([(at["W1"] - p * l2**2 / 2) / l1], rel=1e-10)
    assert model.operators("mirror") == FreeTube(law, {"force": 0.0}).operators("localisation") == {}


def test_a_matrix_that_is_singular_to_the_last_bit_has_its_mode():
    """A tube at rest has no axial force, exactly."""
    model = HeldTube(mooney_rivlin_of(0.0), {"lam1": 1.0})
    with model.system.at(State(np.array([1.0]), {"p": 0.0, "lam1": 1.0})):
        mode = model.operators("n1")[0]().nearest()
    assert mode.eigenvalue == pytest.approx(0, abs=1e-12)
    assert np.abs(mode.vector) == pytest.approx([1.0])


def test_the_cusp_of_a_balloon_is_that_of_its_own_problem():
    law = {"model": "gent", "jm": 20.0, "lam_end": 3.0}
    given = {"body": "sphere", **law, "x": "jm", "low": 17.0, "high": 20.5, "kind": "fold"}
    long_steps = {"step": 0.2}
    (cusp,) = solve("diagram", **given, numerics=long_steps).points("cusp_point")
    (other,) = solve("sphere", **law, vary="jm", vary_end=17.0, numerics=long_steps).points("cusp_point")
    for name, theirs in (("p", "P"), ("jm", "jm"), ("lam", "lam")):
        assert cusp.values[name] == pytest.approx(other.values[theirs], rel=1e-9), name


def test_limit_points_of_free_tubes_are_those_of_a_single_tube():
    given = {"body": "infinite_tube", "alpha": 0.05, "x": "force", "kind": "fold"}
    (state,) = solve("diagram", **given, low=0.2, high=0.8, at={"force": 0.5}, branch="fold").states
    (limit,) = solve("infinite_tube", force=0.5, alpha=0.05, lam_end=3.0).points("limit_point")
    for name in ("p", "lam1", "lam2"):
        assert state.quantities[name].value == pytest.approx(limit.values[name], abs=1e-8), name
    assert state.quantities["n_negative"].value == 0


def test_a_held_tube_bends_in_the_states_of_a_closed_tube(long_tubes):
    """Without axial force the ends need not be held."""
    line = long_tubes.branch("n1").columns
    i = len(line["p"]) // 2
    hoop = float(line["lam2"][i])
    (state,) = solve("infinite_tube", alpha=0.1, lam_end=hoop + 0.1, at={"lam2": hoop}).states
    assert state.quantities["lam1"].value == pytest.approx(line["lam1"][i], abs=1e-9)
    assert state.quantities["p"].value == pytest.approx(line["p"][i], abs=1e-9)


def test_tubes_with_little_stretch_bend_first_and_others_bulge_first(long_tubes):
    both = long_tubes.points("localisation_n1")[0].values["lam1"]
    bulging, bending = (long_tubes.branch(name).columns for name in ("localisation", "n1"))
    for line, counts, low, high in (
        (bulging, "n_negative_n1", 1, 0),
        (bending, "n_localisation", 0, 1),
    ):
        assert set(line[counts][line["lam1"] < both]) == {low}
        assert set(line[counts][line["lam1"] > both]) == {high}
    assert 1.15 < both < 1.25
    assert long_tubes.failures == []


def test_a_free_tube_under_compression_is_taut_from_a_line_on():
    """``w,1 = 0``, so that the pressure on the ends bears the force alone: ``F = -p lam2^2/2``."""
    given = {"body": "infinite_tube", "x": "force", "low": -0.6, "high": -0.2, "alpha": 0.1}
    line = solve("diagram", **given, kind="wrinkling", lam_end=1.5).branch("wrinkling").columns
    assert line["force"] == pytest.approx(-line["p"] * line["lam2"] ** 2 / 2, abs=1e-9)
    assert line["lam1"] == pytest.approx(line["lam2"] ** -0.5, abs=1e-9)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"body": "sphere", "model": "neo_hookean"}, "sphere with model = 'neo_hookean' has no parameter"),
        ({"body": "sphere", "x": "force"}, "x = 'force' is no parameter of sphere"),
        ({"body": "sphere", "x": "p"}, "x = y = 'p'"),
        ({"body": "sphere", "kind": "n4"}, "kind = 'n4'"),
        ({"body": "sphere", "kind": "wrinkling"}, "is in tension at any pressure"),
        ({"body": "sphere", "kind": "localisation"}, "is not long; allowed with body = 'infinite_tube'"),
        ({"body": "tube", "kind": "localisation"}, "is not long; allowed with body = 'infinite_tube'"),
        ({"body": "infinite_tube", "x": "lam1"}, "x = 'lam1' is no parameter of infinite_tube"),
        ({"body": "infinite_tube", "kind": "localisation"}, "at its limit points (kind = 'fold')"),
        ({"body": "infinite_tube", "kind": "n1"}, "bends where force = 0; allowed with ends = 'held'"),
        ({**HELD, "kind": "n2"}, "has long waves of n1 only"),
        ({**HELD, "x": "force"}, "x = 'force' is no parameter"),
        ({**HELD, "low": 0.9}, "between 1 and 10"),
        ({"body": "infinite_tube", "high": 5.0, "model": "varga"}, "force = 5: model = 'varga'"),
        ({"body": "infinite_tube", "lam_end": 1.0}, "lam_end = 1.0"),
    ],
)
def test_bad_input_is_refused_in_one_line_before_anything_is_solved(given, message):
    with pytest.raises(InputError, match="diagram") as refused:
        solve("diagram", **given)
    assert message in str(refused.value)
    assert "\n" not in str(refused.value)


def test_a_plane_without_a_pear_says_what_was_searched():
    """The tension of a Mooney-Rivlin balloon has no extremum."""
    result = solve("diagram", body="sphere", x="alpha", kind="n1", high=0.2)
    assert result.branches == []
    (absence,) = result.absent
    assert "no point of kind n1" in absence.reason
    assert "up to lam = 4" in absence.reason
