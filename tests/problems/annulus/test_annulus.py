"""The turned annulus: zones, torque and energy of single states, and what is refused."""

import numpy as np
import pytest
from mpi4py import MPI

from weakforms import InputError, solve
from weakforms.problems.annulus.model import AnnulusModel, Ring
from weakforms.problems.material_choice import Chosen, mooney_rivlin_of
from weakforms.problems.meridian.fields import Meridian
from weakforms.solvers.equilibrium.state import State

COARSE = {"cells": 16, "levels": 2}
KIRCHHOFF = {"model": "saint_venant_kirchhoff", "shear": 1.0, "poisson": 0.3}


@pytest.fixture(scope="module")
def stretched():
    return solve("annulus", a=0.4, s=1.05, psi_end=0.3, at={"psi": 0.2}, numerics={"cells": 32})


def test_without_a_turn_the_energy_is_that_of_equal_stretches():
    alpha, s, a = 0.1, 1.2, 0.5
    found = solve("annulus", a=a, s=s, psi_end=0.05, alpha=alpha, numerics=COARSE).branch()
    density = 2 * s**2 + s**-4 - 3 + alpha * (s**4 + 2 / s**2 - 3)
    assert found["psi"][0] == 0
    assert found["U"][0] == pytest.approx(np.pi * (1 - a**2) * density, rel=1e-12)
    assert abs(found["M"][0]) < 1e-12


def test_a_stretched_annulus_is_taut_and_then_wrinkles_from_the_inner_edge(stretched):
    (onset,) = stretched.special_points
    assert onset.kind == "wrinkling_onset"
    assert onset.values["gw_in"] == pytest.approx(1, abs=1e-12)
    branch = stretched.branch()
    before = branch["psi"] <= onset.values["psi"] + 1e-9
    assert (branch["R_front"][before] == 0.4).all()
    assert not branch["f_w"][before].any()
    assert (np.diff(branch["R_front"][~before]) > 0).all()
    assert (branch["gw_in"][before] >= 1 - 1e-12).all()
    assert (branch["gw_in"][~before][1:] < 1).all()
    assert not branch["n_negative"].any()


def test_the_mesh_follows_the_front(stretched):
    (state,) = stretched.states
    field = state.fields[0].columns
    front = state.quantities["R_front"].value
    inside = field["R"] < front
    assert (field["gw"][inside] < 1).all()
    assert (field["gw"][~inside] > 1).all()
    share = (front**2 - 0.4**2) / (1 - 0.4**2)
    assert state.quantities["f_w"].value == pytest.approx(share, rel=1e-10)


@pytest.mark.slow
def test_the_torque_has_twice_the_order_of_the_elements_although_a_front_is_inside():
    runs = [
        solve(
            "annulus",
            alpha=0.0,
            psi_end=0.15,
            at={"psi": 0.1},
            numerics={"degree": 2, "cells": n, "levels": 2},
        )
        for n in (8, 16, 32, 64)
    ]
    torque = [run.states[0].quantities["M"].value for run in runs]
    first, second = np.abs(np.diff(torque))[:2] / np.abs(np.diff(torque))[1:]
    assert first > 2**3.5
    assert second > 2**3.5


def test_a_taut_ring_at_the_outer_edge_may_appear_later():
    """A sheet of Poisson's ratio 0.3, a = 0.6, wrinkles all over first; its hoops are held at the edge."""
    found = solve("annulus", a=0.6, psi_end=0.3, numerics=COARSE, **KIRCHHOFF)
    (point,) = found.special_points
    assert point.kind == "zone_opening"
    assert point.values["gw_out"] == pytest.approx(1, abs=1e-10)
    branch = found.branch()
    assert branch["R_front"][0] == 1
    assert branch["R_front"][-1] < 1


def test_a_sheet_that_bears_compression_has_no_front_and_more_torque():
    given = {"alpha": 0.0, "psi_end": 0.2, "at": {"psi": 0.15}, "numerics": COARSE}
    full, relaxed = (solve("annulus", energy=e, **given).states[0].quantities for e in ("full", "relaxed"))
    assert full["f_w"].value == 0
    assert full["gw_in"].value < 1
    assert full["M"].value > 1.2 * relaxed["M"].value


def test_a_stiffening_sheet_is_answered_up_to_large_torques():
    """Its torque grows by 18 000 per radian, so that round-off of a plane across the branch was too large."""
    stiff = {"model": "biderman", "c10": 0.1307, "c01": 0.9178, "c20": -0.04998, "c30": 0.01435}
    result = solve("annulus", a=0.8633, s=1.517, energy="full", psi_end=0.7229, **stiff)
    assert result.failures == []
    assert result.branch().columns["psi"][-1] > 0.7


def test_the_branch_ends_where_the_sheet_folds_over():
    found = solve("annulus", a=0.05, psi_end=0.6, numerics={"cells": 32, "levels": 2})
    last = found.branch()["psi"][-1]
    assert last == pytest.approx(0.4729, abs=1e-3)
    assert "folds over at the inner edge" in found.branch().ended.reason


def mooney_rivlin(l1, l2, alpha=0.2):
    area = (l1 * l2) ** 2
    return l1**2 + l2**2 + 1 / area - 3 + alpha * (area + 1 / l1**2 + 1 / l2**2 - 3)


def kirchhoff(l1, l2, nu=0.3):
    """With ``shear = 1``, so that ``E = 2 (1 + nu)``."""
    e1, e2 = (l1**2 - 1) / 2, (l2**2 - 1) / 2
    return (e1**2 + e2**2 + 2 * nu * e1 * e2) / (1 - nu)


LAWS = {
    "mooney_rivlin": (mooney_rivlin_of(0.2), mooney_rivlin, lambda x: x**-0.5),
    # The hoop stress e2 + nu e1 is zero at its natural width.
    "kirchhoff": (
        Chosen("saint_venant_kirchhoff", (("shear", 1.0), ("poisson", 0.3))),
        kirchhoff,
        lambda x: np.sqrt(1 - 0.3 * (x**2 - 1)),
    ),
}


@pytest.mark.parametrize("zones", ["taut", "wrinkled", "front"])
@pytest.mark.parametrize("name", LAWS)
def test_the_energy_of_any_state_is_that_of_its_principal_stretches(name, zones):
    """By singular values of the gradient, whose slopes are differences of the sampled position."""
    law, energy, width = LAWS[name]
    a, s, front = 0.4, 1.1, 0.63
    model = AnnulusModel(MPI.COMM_SELF, Ring(law, a, s), zones, 8, 4)
    system = model.system
    loads = system.initial.loads | {"psi": 0.25} | ({"R_front": front} if zones == "front" else {})
    hump = np.sin(np.pi * (model.material(model.nodes(), loads) - a) / (1 - a))
    shape = np.column_stack([-0.05 * hump, 0.04 * hump]).ravel()
    shape[system.bc_dofs] = 0.0
    state = State(system.initial.u + shape, loads, model.marks)
    nodes, weights = np.polynomial.legendre.leggauss(12)
    cells, step = 8 // model.blocks, 1e-5
    x = (np.arange(8)[:, None] + (nodes + 1) / 2) / cells
    fields = Meridian(model, {key: model.expressions[key] for key in ("r", "turn", "gw")})

    def sampled(by):
        with system.at(state):
            return {n: v.reshape(x.shape) for n, v in fields.at((x + by).ravel()).items()}

    here, above, below = (sampled(by) for by in (0.0, step, -step))
    place, up, down = (model.material((x + by).ravel(), loads).reshape(x.shape) for by in (0.0, step, -step))
    slopes = [(above[n] - below[n]) / (up - down) for n in ("r", "turn")]
    hoop, zero = here["r"] / place, np.zeros_like(place)
    gradient = np.array([[slopes[0], zero], [here["r"] * slopes[1], hoop]]).transpose(2, 3, 0, 1)
    l1, l2 = np.moveaxis(np.linalg.svd(gradient, compute_uv=False), -1, 0)
    wrinkled = {"taut": place < 0, "wrinkled": place > 0, "front": place < front}[zones]
    density = energy(l1, np.where(wrinkled, width(l1), l2))
    measure = 2 * np.pi * place * (up - down) / (2 * step) * weights / (2 * cells)
    assert here["gw"] == pytest.approx(l2 / width(l1), rel=1e-5)
    with system.at(state):
        found = system.monitors()
        forces = system.residual()
    assert found["U"] == pytest.approx(np.sum(density * measure), rel=1e-8)

    def energy_at(u, loads):
        with system.at(State(u, loads, model.marks)):
            return system.monitor("U")

    by = 1e-6
    up, down = (energy_at(state.u + sign * by * shape, loads) for sign in (1, -1))
    assert (up - down) / (2 * by) == pytest.approx(2 * np.pi * (forces @ shape), rel=1e-5)
    up, down = (energy_at(state.u, loads | {"psi": 0.25 + sign * by}) for sign in (1, -1))
    assert (up - down) / (2 * by) == pytest.approx(found["M"], rel=1e-7)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"a": 1.0}, "a = 1.0"),
        ({"s": 0.9}, "s = 0.9"),
        ({"psi_end": 1.5}, "psi_end = 1.5"),
        ({"model": "harmonic"}, "model = 'harmonic'; allowed: neo_hookean"),
        ({"model": "harmonic"}, "gent, saint_venant_kirchhoff"),
        ({**KIRCHHOFF, "energy": "full"}, "allowed: energy = 'relaxed'"),
        ({"model": "gent", "jm": 0.5, "s": 1.5}, "lower s"),
        ({"at": {"torque": 1.0}}, "cannot ask for a state at 'torque'"),
    ],
)
def test_wrong_input_is_refused_in_one_line(given, said):
    with pytest.raises(InputError) as error:
        solve("annulus", **given)
    assert said in str(error.value)
    assert "\n" not in str(error.value)
