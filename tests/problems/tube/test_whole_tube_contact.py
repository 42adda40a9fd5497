"""The whole tube in contact: the states of the half one, both fronts, and broken symmetry."""

from dataclasses import replace

import pytest
from mpi4py import MPI
from tube_data import LONG_STEPS, data

from weakforms import solve
from weakforms.problems.tube.phases import TubePhases

pytestmark = pytest.mark.paper2
PHASES = (
    {"contact": "frictionless"},
    pytest.param({"contact": "adhesive"}, marks=pytest.mark.slow),
    {"contact": "adhesive", "phase": "deflation"},
    pytest.param(
        {"contact": "adhesive", "phase": "deflation", "spring": "unilateral"}, marks=pytest.mark.slow
    ),
)


@pytest.mark.parametrize("phase", PHASES, ids=lambda phase: "_".join(phase.values()))
def test_the_whole_tube_has_the_states_of_the_half_one(phase):
    given = {**phase, "delta1": 1.2, "p_end": 2.2, "at": {"p": 2.0}, "numerics": LONG_STEPS}
    half, whole = (solve("tube", extent=extent, **given) for extent in ("half", "full"))
    assert whole.failures == []
    assert [point.kind for point in whole.special_points] == [point.kind for point in half.special_points]
    doubled = {"V", "Pi"}
    modal = {"eigenvalue_1", "n_negative"}
    of_half, of_whole = (found.states[0].quantities for found in (half, whole))
    assert of_half.keys() == of_whole.keys()
    for name in of_half.keys() - modal:
        factor = 2 if name in doubled else 1
        allowed = factor * of_half[name].uncertainty + of_whole[name].uncertainty
        assert abs(factor * of_half[name].value - of_whole[name].value) <= allowed
    assert of_whole["eigenvalue_1"].value <= of_half["eigenvalue_1"].value + 1e-9
    upper, profile = half.states[0].fields[0].columns, whole.states[0].fields[0].columns
    middle = len(profile["Z"]) // 2
    for name, parity in {"rho": 1, "eta": -1, "lam1": 1, "t2": 1, "f_k": 1}.items():
        values = profile[name]
        assert values[middle:][::2] == pytest.approx(upper[name][::4], abs=1e-8)
        assert values == pytest.approx(parity * values[::-1], abs=1e-8)


def test_both_fronts_of_the_whole_tube_touch():
    run = TubePhases(MPI.COMM_SELF, replace(data(), full=True), p_end=1.8, step=0.08, terms=14)
    for branch in (run.frictionless, run.adhesive):
        for point in branch.points:
            assert abs(point.monitors["gap"]) + abs(point.monitors["gap_lower"]) < 1e-11
            # The slope at the edge of the first, tiny patch is 2e-5: a gap of round-off moves it by 1e-7.
            fronts = point.state.loads["front"], point.state.loads["front_lower"]
            assert fronts[0] == pytest.approx(-fronts[1], abs=1e-6 if point is branch.points[0] else 1e-9)


def test_a_substrate_behind_the_limit_point_breaks_the_symmetry_in_contact():
    given = {"alpha": 0.0, "contact": "frictionless", "s": 2.2, "p_end": 1.8, "numerics": LONG_STEPS}
    whole = solve("tube", extent="full", **given)
    (point,) = whole.points("bifurcation_point")
    half = solve("tube", extent="half", **given, at={"u_max": point.values["u_max"]})
    kinds = ["limit_point", "contact_onset", "limit_point"]
    assert [point.kind for point in half.special_points] == kinds
    assert [point.kind for point in whole.special_points] == [*kinds, "bifurcation_point"]
    assert half.branch().columns["n_negative"][-1] == 0
    assert whole.branch().columns["n_negative"][-1] == 1
    assert point.values["Z_front"] > 0
    allowed = 2 * point.uncertainty["p"]
    (same,) = half.states
    assert same.quantities["p"].value == pytest.approx(point.values["p"], abs=allowed)
