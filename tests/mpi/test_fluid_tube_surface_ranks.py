"""The surface of the fluid-loaded tube serially and on two ranks: full circle and secondary branch."""

import pytest

pytestmark = [pytest.mark.mpi, pytest.mark.paper3]


def test_full_circle(same_on_ranks):
    full = {"problem": "fluid_tube_surface", "numerics": {"cells": 8, "degree": 3}}
    (found,) = same_on_ranks([full])
    values = {name: q.value for name, q in found.quantities.items()}
    assert values["multiplicity"] == 2
    assert abs(values["Lambda_split"]) < 1e-10


SURFACE = {"secondary_cells": 12, "secondary_levels": 2, "secondary_degree": 3, "secondary_step": 0.3}
BENT = {"problem": "fluid_tube", "secondary": True, "n_max": 1, "branch": "secondary"}


def test_secondary_branch(same_on_ranks):
    coarse = SURFACE | {"cells": 24, "levels": 2, "step": 1, "secondary_end": 0.97}
    (found,) = same_on_ranks([BENT | {"zw_end": 0.93, "at": [("zw", 7.75)], "numerics": coarse}])
    kinds = [point.kind for point in found.special_points]
    assert kinds == ["limit_point", "bifurcation_point", "bifurcation_point"]
    (state,) = found.states
    assert state.branch == "secondary"
    assert state.quantities["n_negative"].value == 1
    assert state.quantities["n_negative_breaking"].value == 0


@pytest.mark.slow
def test_secondary_branch_of_a_wrinkled_tube(same_on_ranks):
    full = {"L": 12.0, "delta": 1.4, "gamma": 0.03, "zw_end": 0.9, "at": [("zw", 17.2)], "energy": "relaxed"}
    end = SURFACE | {"cells": 32, "levels": 2, "secondary_end": 0.8, "secondary_step": 0.4}
    # Least certain are the slopes: differences of states that lie 0.02 apart.
    (wrinkled,) = same_on_ranks([BENT | full | {"numerics": end}])
    assert wrinkled.states[0].quantities["wrinkled_fraction"].value > 0
