"""Lines of limit points of parts of spheres: against the problems of their ends, and what is refused."""

from math import cos, pi, sin, tan

import numpy as np
import pytest
from mpi4py import MPI

from reference_data.solvers.beyond.caps import energy, waves_ritz
from weakforms import solve
from weakforms.errors import InputError
from weakforms.problems.diagram.bodies import cap
from weakforms.problems.diagram.bodies.cap import VariedCap
from weakforms.problems.diagram.parameters import DiagramParameters
from weakforms.problems.diagram.problem import ROOM
from weakforms.problems.wave_numbers import eigenvalue_names

MESH = {"cells": 16, "levels": 2, "step": 0.2}
FOLDS = {"body": "hemisphere", "kind": "fold", "numerics": MESH}
AT = {"alpha": 0.02}


def model(angle: float) -> VariedCap:
    law = DiagramParameters(body="hemisphere", alpha=0.0).material
    return VariedCap(MPI.COMM_WORLD, law, {"angle": angle}, 8, 6, 0.6)


@pytest.mark.parametrize("angle", [0.3, pi / 2, 2.4])
def test_a_part_of_a_sphere_at_rest_has_its_volume_and_no_tension(angle):
    found = model(angle)
    with found.system.at(found.system.initial):
        at = found.system.monitors()
    volume = (2 + cos(angle)) * (1 - cos(angle)) ** 2 / (6 * sin(angle) ** 3)
    assert at["V"] == pytest.approx(volume, rel=1e-10)
    assert at["t0"] == pytest.approx(tan(angle / 2), rel=1e-12) == cap.rest_height(angle)
    assert at["lam_pole"] == 1.0
    assert at["t_min"] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("angle", [0.3, 2.4])
def test_the_mass_is_that_of_the_flat_disk_at_every_angle(angle):
    """``int (S^2 u^2 + w^2) S dS`` with ``1 - S^2`` for either displacement."""
    found = model(angle).system
    shape = 1 - np.repeat(model(angle).nodes(), 2) ** 2
    for first, exact in ((0, 1 / 24), (1, 1 / 6)):
        moved = np.zeros_like(shape)
        moved[first::2] = shape[first::2]
        assert moved @ found.mass_times(moved) == pytest.approx(exact, rel=1e-12)


def test_lines_of_hemispheres_are_those_of_the_problem_hemisphere(monkeypatch):
    """Wherever the branches begin."""
    (limit,) = solve("hemisphere", load="gas", c2=0.02, numerics={"levels": 2, "step": 0.2}).points(
        "limit_point"
    )
    for first in (cap.FIRST_P, 1.0):
        monkeypatch.setattr(cap, "FIRST_P", first)
        (state,) = solve("diagram", x="alpha", low=0.01, high=0.03, **FOLDS, at=AT, branch="fold").states
        for name in ("p", "V", "Pi", "lam_pole"):
            assert state.quantities[name].value == pytest.approx(limit.values[name], abs=1e-8), name
        assert state.quantities["t0"].value == pytest.approx(-limit.values["z_pole"], abs=1e-8)
        assert state.quantities["eigenvalue_1"].value == pytest.approx(0.0, abs=1e-8)


def test_shallow_parts_differ_from_the_flat_disk_by_the_square_of_their_angle():
    (flat,) = solve("circular", alpha=0.0, t_end=1.4, numerics={"levels": 2}).points("limit_point")
    line = solve("diagram", angle=0.2, alpha=0.0, low=0.2, high=0.4, **FOLDS).branch("fold").columns
    assert line["angle"][[0, -1]] == pytest.approx([0.2, 0.4], abs=1e-12)
    less = flat.values["p"] - line["p"][[0, -1]]
    assert less[0] > 0
    assert less[1] / less[0] == pytest.approx(4.0, rel=0.05)


def test_deep_parts_approach_the_whole_balloon():
    """Its largest pressure ``4 (1/lam - 1/lam^7)`` is at ``lam = 7^(1/6)``, over the radius of the sphere."""
    lam = 7 ** (1 / 6)
    line = solve("diagram", alpha=0.0, low=2.5, high=2.6, t_end=6.0, **FOLDS).branch("fold").columns
    over = line["p"] / np.sin(line["angle"]) - 4 * (1 / lam - 1 / lam**7)
    assert line["angle"][[0, -1]] == pytest.approx([2.5, 2.6], abs=1e-12)
    assert 0 < over[-1] < over[0] < 0.15


@pytest.mark.parametrize("angle", [0.2, 2.0])
def test_first_states_are_lower_than_the_least_end(angle):
    rest = cap.rest_height(angle)
    first = model(angle).primary(rest + ROOM * max(1.0, rest), 0.1).points
    assert first[0].monitors["t0"] < rest + 0.8 * ROOM * max(1.0, rest)
    assert first[-1].monitors["t0"] >= rest + ROOM * max(1.0, rest)
    assert first[0].n_negative == 0


def test_waves_around_a_hemisphere_are_those_of_the_problem_hemisphere():
    """It hangs, and a part of a sphere stands: gas acts on the other side of the meridian."""
    given = {"load": "gas", "c2": 0.0, "n": "1,2,3", "numerics": {"levels": 2, "step": 0.2}}
    (state,) = solve("hemisphere", at={"p": 2.0}, **given).states
    found = model(pi / 2)
    with found.system.at(found.primary(1.3, 0.2).at("p", 2.0).state):
        for n in (1, 2, 3):
            (form,) = found.operators(f"n{n}").values()
            exact = [state.quantities[name].value for name in eigenvalue_names(n)]
            assert form().spectrum(3).eigenvalues == pytest.approx(exact, rel=1e-6)


@pytest.mark.parametrize(("angle", "height"), [(0.6, 0.8), (2.2, 2.6)])
def test_waves_around_other_parts_of_spheres_are_those_of_their_energy_in_space(angle, height):
    """By the reference code, which shares nothing with the weak form."""
    found = model(angle)
    state = found.primary(height + 0.1, 0.2).at("t0", height).state
    exact = energy.start("angle", 0.0, angle, height, energy.DEGREES[1])
    assert state.loads["p"] == pytest.approx(exact.p, rel=1e-7)
    with found.system.at(state):
        for n in (1, 2, 3):
            (form,) = found.operators(f"n{n}").values()
            assert form().spectrum(1).eigenvalues[0] == pytest.approx(waves_ritz.lowest(exact, n), rel=1e-6)


def test_at_limit_points_of_parts_of_spheres_no_wave_is_unstable():
    kinds = {**FOLDS, "kind": "fold,n1,n2,n3"}
    found = solve("diagram", alpha=0.0, low=1.2, high=2.0, t_end=3.2, **kinds)
    line = found.branch("fold").columns
    assert line["angle"][[0, -1]] == pytest.approx([1.2, 2.0], abs=1e-12)
    for n in (1, 2, 3):
        assert not line[f"n_negative_n{n}"].any()
    assert [item.what for item in found.absent] == [f"lines of kind n{n}" for n in (1, 2, 3)]


def test_the_clamp_keeps_an_ogden_balloon_from_a_pear_that_points_sideways():
    """The whole balloon has two neutral pears; the part of a sphere has none, but comes near to one."""
    law = DiagramParameters(body="hemisphere", model="ogden").material
    found = VariedCap(MPI.COMM_WORLD, law, {"angle": 2.4}, 16, 6, 0.6)
    (form,) = found.operators("n1").values()
    lowest = []
    for point in found.primary(8.0, 0.3).points[::2]:
        with found.system.at(point.state):
            lowest.append(form().spectrum(1).eigenvalues[0])
    least = int(np.argmin(lowest))
    assert 0 < lowest[least] < 0.3 * max(lowest[:least])


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"kind": "contact"}, "body = 'hemisphere' touches nothing"),
        ({"kind": "mirror"}, "body = 'hemisphere' has no mirror"),
        ({"kind": "localisation"}, "body = 'hemisphere' is not long"),
        ({"x": "beta"}, "x = 'beta' is no parameter of hemisphere"),
        ({"high": 2.7}, "between 0.2 and 2.6"),
        ({"angle": 3.0}, "angle = 3.0"),
        ({"high": 2.6}, "high = 2.6: t_end = 3 must be at least 3.962, because t0 is 3.602 at rest"),
        ({"high": 1.2, "t_end": 0.7}, "high = 1.2: t_end = 0.7 must be at least 0.7841"),
        ({"angle": 2.5, "x": "alpha"}, "angle = 2.5: t_end = 3 must be at least 3.311"),
    ],
)
def test_bad_input_is_refused_in_one_line(given, message):
    with pytest.raises(InputError, match="diagram") as refused:
        solve("diagram", body="hemisphere", **given)
    assert message in str(refused.value)
    assert "\n" not in str(refused.value)
