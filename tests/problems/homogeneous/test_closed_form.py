"""Homogeneous bodies: closed forms, limit points and their merging, coexisting states, refused input."""

import re

import numpy as np
import pytest

from weakforms import solve
from weakforms.errors import InputError
from weakforms.problems.homogeneous import body as closed_body
from weakforms.problems.homogeneous.body import system_of
from weakforms.problems.homogeneous.material_point import evaluated
from weakforms.problems.material_choice import Chosen
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State

GENT = Chosen("gent", (("shear", 2.0), ("jm", 97.2)))


def test_balloon_has_its_closed_form_and_its_maximum():
    result = solve("sphere", model="neo_hookean", at={"lam": 2.0})
    (state,) = result.states
    assert state.quantities["P"].value == pytest.approx(4 * (1 / 2 - 2.0**-7), rel=1e-12)
    assert state.quantities["n_negative"].value == 1
    (top,) = result.points("limit_point")
    assert top.values["lam"] == pytest.approx(7 ** (1 / 6), rel=1e-11)
    assert top.values["P"] == pytest.approx(4 * (7 ** (-1 / 6) - 7 ** (-7 / 6)), rel=1e-12)


@pytest.mark.parametrize("problem", ["sphere", "infinite_tube"])
def test_each_mesh_is_announced(problem):
    said = []
    solve(problem, numerics={"levels": 3}, progress=lambda *words: said.append(words))
    assert [word for word in said if word[0] == "branch"] == [("branch", level, 3) for level in range(3)]


def test_limit_points_merge_in_a_constant():
    result = solve("sphere", alpha=0.15, vary="alpha", vary_end=0.3, numerics={"step": 0.1})
    (merged,) = result.points("cusp_point")
    assert merged.branch == "fold"
    assert merged.values["alpha"] == pytest.approx(0.2144583510, abs=5e-11)
    line = result.branch("fold").columns
    assert line["alpha"].max() <= merged.values["alpha"] + 1e-9
    # on either side of it there are two limit points, or none
    assert len(solve("sphere", alpha=0.21).points("limit_point")) == 2
    assert solve("sphere", alpha=0.22).points("limit_point") == []


def test_coexisting_states_are_equilibria_of_one_pressure_and_potential():
    found = {n: q.value for n, q in solve("infinite_tube", model="gent").quantities.items()}
    p, potentials = found["p_maxwell"], []
    for state in ("thin", "thick"):
        a, b = found[f"lam1_{state}"], found[f"lam2_{state}"]
        w = evaluated(GENT, a, b)
        assert w["W1"] == pytest.approx(p * b**2 / 2, rel=1e-10)
        assert w["W2"] == pytest.approx(p * a * b, rel=1e-10)
        potentials.append(w["W"] - p * a * b**2 / 2)
    assert potentials[0] == pytest.approx(potentials[1], rel=1e-10)
    assert solve("infinite_tube", model="neo_hookean", lam_end=3).quantities == {}


def test_an_axial_force_counts():
    result = solve("infinite_tube", model="gent", force=0.5, lam_end=2.0, at={"lam2": 1.5})
    state = {n: q.value for n, q in result.states[0].quantities.items()}
    w1 = evaluated(GENT, state["lam1"], 1.5)["W1"]
    assert w1 == pytest.approx(0.5 + state["p"] * 1.5**2 / 2, rel=1e-10)


@pytest.mark.parametrize(
    ("loading", "stress"),
    [
        ("uniaxial", lambda x: 2 * (x - x**-2)),
        ("equibiaxial", lambda x: 2 * (x - x**-5)),
        ("pure_shear", lambda x: 2 * (x - x**-3)),
    ],
)
@pytest.mark.parametrize("end", [2.0, 0.5])
def test_test_pieces_have_their_closed_forms(loading, stress, end):
    result = solve("homogeneous", model="neo_hookean", loading=loading, lam_end=end, numerics={"step": 0.2})
    columns = result.branch().columns
    inside = slice(0, -1)
    assert np.allclose(columns["T"][inside], stress(columns["lam"][inside]), rtol=1e-9, atol=1e-9)
    assert result.failures == []


def test_a_wrong_potential_would_be_seen():
    """The balloon's residual is not zero if the pressure differs from the closed form's."""
    system = system_of(closed_body.sphere(), Chosen("neo_hookean", ()))
    solver = ExtendedNewton(system)
    state, _ = solver.solve(State(np.array([1.2]), {"P": 4 * (1 / 1.25 - 1.25**-7), "force": 0.0}))
    assert state.u[0] == pytest.approx(1.25, rel=1e-10)


@pytest.mark.parametrize(
    ("problem", "given", "words"),
    [
        ("sphere", {"vary": "jm"}, "vary jm mooney_rivlin alpha"),
        ("sphere", {"vary": "alpha"}, "vary_end None"),
        ("sphere", {"vary": "alpha", "vary_end": 0.1}, "vary_end 0.1 other than"),
        ("sphere", {"vary": "alpha", "vary_end": -1.0}, "vary_end -1 >= 0"),
        ("sphere", {"model": "gent", "lam_end": 9.0}, "gent not defined lam_end 9"),
        ("sphere", {"at": {"cusp_point": 1}}, "cusp_point vary"),
        ("homogeneous", {"lam_end": 1.0}, "lam_end 1 rest"),
        ("homogeneous", {"loading": "torsion"}, "loading torsion uniaxial"),
        ("homogeneous", {"model": "gent", "lam_end": 12.0}, "gent not defined"),
        ("infinite_tube", {"force": 1e3}, "force 1000 100"),
        ("infinite_tube", {"at": {"V2": 1.0}}, "V2 lam2"),
    ],
)
def test_bad_input_is_refused_in_one_line(problem, given, words):
    with pytest.raises(InputError) as error:
        solve(problem, **given)
    text = str(error.value)
    assert "\n" not in text
    assert all(re.search(re.escape(word), text) for word in words.split()), text


@pytest.mark.parametrize(
    ("l1", "l2", "state"),
    [
        (1.5, 0.7, 1),
        (0.7, 1.5, 2),
        (1.2, 1.2, 3),
        (0.9, 0.8, 0),
        (1.005, 0.5, 1),
        (0.5, 1.005, 2),
        (1.5, 0.82, 3),
    ],
)
def test_a_sheet_is_slack_wrinkled_or_taut(l1, l2, state):
    """Wrinkled under tension along ``l`` if the other stretch is below ``l^(-1/2)``."""
    result = solve("material", model="neo_hookean", l1=l1, l2=l2)
    found = {name: quantity.value for name, quantity in result.quantities.items()}
    along = max(l1, l2)
    energy = [0.0, along**2 + 2 / along - 3, along**2 + 2 / along - 3, l1**2 + l2**2 + (l1 * l2) ** -2 - 3][
        state
    ]
    slope = 2 * along - 2 / along**2
    assert found["state"] == state
    assert found["W_relaxed"] == pytest.approx(energy, abs=1e-13)
    if state < 3:
        assert found["W1_relaxed"] == pytest.approx(slope if state == 1 else 0.0, abs=1e-13)
        assert found["W2_relaxed"] == pytest.approx(slope if state == 2 else 0.0, abs=1e-13)
