"""Sheets whose edges are moved in their plane: any law, meshes, and what is refused."""

import numpy as np
import pytest
from mpi4py import MPI

from reference_data.solvers.beyond.bent_sheet.shooting import Sheet as Bent
from reference_data.solvers.beyond.bent_sheet.shooting import bent, onset
from weakforms import InputError, solve
from weakforms.problems.material_choice import mooney_rivlin_of
from weakforms.problems.sheet.model import Sheet, SheetModel
from weakforms.problems.sheet.problem import SheetProblem
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State

SMALL = {"cells": 4, "levels": 2}
LAWS = [{"alpha": 0.3}, {"model": "ogden"}, {"model": "gent"}]


@pytest.mark.parametrize("law", LAWS, ids=str)
def test_a_strip_of_any_law_has_the_width_and_the_force_of_a_test_piece(law):
    to = {"lam_end": 1.55, "at": {"lam": 1.5}, **law}
    (pulled,) = solve("sheet", loading="strip", c=2.0, numerics=SMALL, **to).states
    (piece,) = solve("homogeneous", loading="uniaxial", **to).states
    assert pulled.quantities["lam2"].value == pytest.approx(1.5**-0.5, rel=1e-9)
    assert pulled.quantities["T_x"].value == pytest.approx(piece.quantities["T"].value, rel=1e-9)
    assert abs(pulled.quantities["T_y"].value) < 1e-10
    assert "f_w" not in pulled.quantities


@pytest.mark.parametrize("law", LAWS, ids=str)
def test_a_narrowed_sheet_of_any_law_has_the_force_of_a_strip_where_it_is_wrinkled(law):
    at = [("lam", 1.2), ("lam", 1.8)]
    to = {"lam_end": 1.85, "at": at, "numerics": SMALL, **law}
    folded, taut = solve("sheet", loading="stretch", s=0.8, **to).states
    strip = solve("sheet", loading="strip", **to).states
    assert folded.quantities["f_w"].value == pytest.approx(1.0)
    assert folded.quantities["T_x"].value == pytest.approx(strip[0].quantities["T_x"].value, rel=1e-9)
    assert abs(folded.quantities["T_y"].value) < 1e-10
    assert taut.quantities["f_w"].value == 0.0
    assert taut.quantities["T_y"].value > 0.1


def test_the_length_of_a_sheet_scales_its_energy_only():
    short, long = (
        solve("sheet", c=c, at={"gam": 0.4}, numerics=SMALL).states[0].quantities for c in (1.0, 2.5)
    )
    assert long["Pi"].value == pytest.approx(2.5 * short["Pi"].value, rel=1e-10)
    for name in ("tau", "T_x", "T_y", "lam1", "lam2"):
        assert long[name].value == pytest.approx(short[name].value, rel=1e-10)


@pytest.mark.parametrize("degree", [1, 2])
@pytest.mark.parametrize(
    ("loading", "s", "load"), [("shear", 1.3, 0.4), ("shear", 1.0, 0.4), ("stretch", 0.8, 2.0)]
)
def test_a_disturbed_guess_returns_to_the_homogeneous_state(loading, s, load, degree):
    """Also where the sheet is wrinkled: lines of tension that end at held edges have stiffness."""
    model = SheetModel(MPI.COMM_SELF, Sheet(mooney_rivlin_of(0.1), loading, 1.0, s), 6, degree)
    system, control = model.system, model.sheet.control
    model.unknown.interpolate(lambda x: 0.02 * np.sin(np.pi * x[:2]) * np.sin(np.pi * x[1::-1]))
    guess = State(model.unknown.x.array.copy(), system.initial.loads | {control: load})
    found, _ = ExtendedNewton(system, [control]).solve(guess, [Held(control, load)])
    assert np.abs(guess.u).max() > 0.01
    assert np.abs(found.u).max() < 1e-10


BENT = {"loading": "bend", "c": 0.25, "kap_end": 0.9}


def test_a_bent_sheet_is_the_same_at_every_place_along_it():
    """Its length scales the energy only, and its stress at the inner edge is that of the closed strip."""
    short, long = (
        solve("sheet", **BENT | {"c": c}, at={"kap": 0.8}, numerics={"cells": 8, "levels": 2}).states[0]
        for c in (0.25, 0.5)
    )
    for name in ("T_x", "M", "lam1", "lam2"):
        assert long.quantities[name].value == pytest.approx(short.quantities[name].value, rel=1e-6)
    assert long.quantities["Pi"].value == pytest.approx(2 * short.quantities["Pi"].value, rel=1e-6)


@pytest.mark.parametrize("kap", [0.05, 0.8])
def test_force_and_moment_are_rates_of_the_energy(kap):
    """By differences of the energy of neighbouring sheets, taut and wrinkled."""
    h, numerics = 1e-3, {"cells": 8, "levels": 2}

    def solved(lam0: float = 1.1, at: float = kap) -> dict:
        (state,) = solve("sheet", **BENT, lam0=lam0, at={"kap": at}, numerics=numerics).states
        return {name: q.value for name, q in state.quantities.items()}

    found = solved()
    force = (solved(1.1 + h)["Pi"] - solved(1.1 - h)["Pi"]) / (2 * h * 0.25)
    moment = (solved(at=kap + h)["Pi"] - solved(at=kap - h)["Pi"]) / (2 * h * 0.25)
    assert found["T_x"] == pytest.approx(force, rel=1e-4)
    assert found["M"] == pytest.approx(moment, rel=1e-4)


def test_a_bent_sheet_lies_on_arcs_about_one_centre():
    (state,) = solve("sheet", **BENT | {"c": 1.0}, at={"kap": 0.8}, numerics={"cells": 8, "levels": 2}).states
    profile = state.fields[0].columns
    centre = -1.1 / 0.8
    radius, angle = np.hypot(profile["x"], profile["y"] - centre), profile["X"] * 0.8
    assert np.arctan2(profile["x"], profile["y"] - centre) == pytest.approx(angle, abs=1e-4)
    assert radius[[0, -1]] == pytest.approx([-centre - 0.5, -centre + 0.5], abs=1e-12)
    assert np.all(np.diff(radius) > 0)


@pytest.mark.parametrize("share", [0.99, 1.002])
def test_a_band_that_no_mesh_sees_is_in_the_uncertainty(share):
    """Just before and after the first wrinkle every mesh is taut; the band is 0.0004 wide at most."""
    at = Bent(0.1, 1.1, 1.0)
    kap = share * onset(at, 1e-10)
    (state,) = solve("sheet", **BENT, at={"kap": kap}, numerics={"cells": 16, "levels": 2}).states
    exact = bent(at, kap, 1e-12)
    assert state.quantities["f_w"].value == 0.0
    for name, value in (("T_x", exact.force), ("M", exact.moment), ("f_w", exact.wrinkled)):
        found = state.quantities[name]
        assert abs(found.value - value) < found.uncertainty
        assert (found.uncertainty > 1e-6) is (share > 1)


def test_a_sheet_that_bears_compression_has_no_front():
    (state,) = solve(
        "sheet", **BENT, energy="full", at={"kap": 0.8}, numerics={"cells": 8, "levels": 3}
    ).states
    assert state.quantities["S_least"].value < -0.1
    assert state.quantities["M"].order > 3.5
    assert state.quantities["M"].uncertainty < 1e-5


def test_a_law_of_bounded_stretch_ends_the_branch():
    result = solve("sheet", model="gent", jm=5.0, gam_end=3.0, numerics=SMALL)
    (rest,) = result.absent
    assert "sheet: at gam = 2." in rest.reason
    assert rest.reason.endswith("lower gam_end")
    assert result.branch().columns["gam"][-1] < 2.4


def test_a_strip_is_followed_to_its_largest_force():
    """A law whose force falls from lam = 2.46 on, where a strip of any length necks."""
    law = {"model": "biderman", "c10": 1.241, "c01": 0.03202, "c20": -0.0655, "c30": 0.001862}
    result = solve("sheet", loading="strip", lam_end=2.8, numerics=SMALL, **law)
    force, (rest,) = result.branch().columns["T_x"], result.absent
    assert not result.failures
    assert "the force of the strip is largest; from there on it necks" in rest.reason
    assert np.all(np.diff(force) > 0)
    assert result.branch().columns["lam"][-1] == pytest.approx(2.45, abs=0.05)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"s": 0.9}, r"s = 0\.9 with loading = 'shear': .* allowed: s from 1, or loading = 'stretch'"),
        ({"model": "gent", "jm": 2.0, "s": 2.0}, r"sheet: s = 2: .*lower s"),
        (
            {"loading": "strip", "at": {"gam": 0.1}},
            "loading = 'strip' there is no column gam; its load is lam",
        ),
        ({"loading": "strip", "at": {"f_w": 0.5}}, "loading = 'strip' there is no column f_w"),
        ({"at": {"lam": 1.2}}, "loading = 'shear' there is no column lam; its load is gam"),
        ({"at": {"gam": 7.0}}, "gam = 7 lies beyond"),
        ({"loading": "bend", "s": 0.9}, r"s = 0\.9 with loading = 'bend'"),
        ({"loading": "bend", "at": {"T_y": 1.0}}, "loading = 'bend' there is no column T_y; its load is kap"),
        ({"at": {"M": 1.0}}, "loading = 'shear' there is no column M"),
        (
            {"loading": "bend", "s": 2.0, "kap_end": 1.5},
            r"kap_end = 1\.5 leaves the inner guide nearly no radius; allowed: up to 0\.99 with",
        ),
        ({"loading": "bend", "at": {"kap": 2.5}}, "kap = 2.5 lies beyond kap_end"),
        ({"loading": "bend", "model": "gent", "jm": 2.0, "lam0": 2.5}, "lam0 = 2.5"),
    ],
)
def test_what_has_no_state_is_refused_before_anything_is_solved(given, said, monkeypatch):
    monkeypatch.setattr(SheetProblem, "families", lambda *_: pytest.fail("it was solved"))
    with pytest.raises(InputError, match=said):
        solve("sheet", **given)


def test_parameters_of_another_loading_are_told():
    with pytest.warns(UserWarning, match="s = 1.1 has no effect"):
        solve("sheet", loading="strip", s=1.1, lam_end=1.2, numerics=SMALL)


def test_a_law_without_a_relaxed_form_is_refused():
    with pytest.raises(InputError, match="model = 'saint_venant_kirchhoff'"):
        solve("sheet", model="saint_venant_kirchhoff", shear=1.0, poisson=0.3)
