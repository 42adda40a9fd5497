"""The tube and the disk: the same numbers serially and on two ranks."""

import pytest
from on_ranks import TOLERANCE, start

pytestmark = pytest.mark.mpi
MESH = {"cells": 16, "levels": 2, "step": 0.3}
"""Few points of each branch: what differs on ranks is how a point is solved for."""


@pytest.mark.paper2
def test_tube(same_on_ranks):
    tube = {"problem": "tube", "delta1": 1.1, "u_end": 3.1, "at": [("p", 1.85), ("u_max", 3.0)]}
    fold = {"problem": "tube_fold", "alpha": 0.1}
    same_on_ranks([item | {"numerics": MESH} for item in (tube, fold)])


@pytest.mark.paper2
@pytest.mark.slow
def test_lines_in_two_parameters(same_on_ranks):
    plane = {"problem": "diagram", "alpha": 0.0, "high": 1.2, "u_end": 2.7}
    (found,) = same_on_ranks([plane | {"numerics": {"cells": 48, "levels": 2}}])
    assert {"fold", "mirror", "wrinkling", "contact", "end"} <= {branch.name for branch in found.branches}
    assert [point.kind for point in found.special_points] == ["wrinkling_mirror", "tip_mirror"]


@pytest.mark.slow
@pytest.mark.paper2
def test_lines_of_bending(same_on_ranks):
    plane = {"problem": "diagram", "alpha": 0.0, "x": "lf", "kind": "fold,n1", "low": 7.0, "high": 8.0}
    (found,) = same_on_ranks([plane | {"u_end": 1.0, "numerics": MESH | {"cells": 24}}])
    assert [point.kind for point in found.special_points].count("fold_n1") == 2


@pytest.mark.slow
def test_lines_of_balloons_parts_of_them_and_long_tubes(same_on_ranks):
    tube = {"body": "infinite_tube", "ends": "held", "kind": "localisation,n1", "high": 1.2}
    balloon = {"body": "sphere", "x": "alpha", "kind": "fold", "low": 0.2}
    part = {"body": "hemisphere", "kind": "fold,n1", "low": 1.45, "high": 1.5, "t_end": 2.6, "numerics": MESH}
    found, _, last = same_on_ranks([{"problem": "diagram"} | given for given in (tube, balloon, part)])
    assert [point.kind for point in found.special_points] == ["localisation_n1"] * 2
    assert [point.kind for point in last.special_points] == ["cusp_point"]


@pytest.mark.paper3
@pytest.mark.slow
def test_lines_of_full_and_partially_filled_tubes(same_on_ranks):
    tube = {"problem": "diagram", "body": "fluid_tube", "alpha": 0.0, "numerics": MESH | {"cells": 24}}
    given = (
        {"kind": "fold,n1", "low": 4.4, "high": 4.6},
        {"kind": "n1", "low": 3.0, "high": 3.1, "V_end": 28.0},
    )
    full, brim = same_on_ranks([tube | item for item in given])
    assert [point.kind for point in full.special_points] == ["fold_n1"] * 2
    assert {"n1", "n1_2"} <= {branch.name for branch in brim.branches}


@pytest.mark.paper5
@pytest.mark.slow
def test_lines_of_wrinkled_tubes(same_on_ranks):
    tube = {"problem": "diagram", "body": "wrinkled_tube", "alpha": 0.01, "kind": "fold", "V_end": 17.0}
    plane = {"x": "delta", "delta": 2.0, "Af": 0.7, "low": 1.98, "high": 2.0}
    (found,) = same_on_ranks([tube | plane | {"numerics": MESH | {"cells": 32}}])
    assert [branch.name for branch in found.branches] == ["fold", "end"]


@pytest.mark.paper5
@pytest.mark.slow
def test_lines_of_wrinkled_tubes_filled_in_part(same_on_ranks):
    tube = {"problem": "diagram", "body": "wrinkled_tube", "alpha": 0.01, "kind": "fold", "y": "zw"}
    plane = {"x": "delta", "delta": 2.0, "Af": 0.5, "gamma": 0.3, "low": 1.98, "high": 2.0, "V_end": 30.0}
    (found,) = same_on_ranks([tube | plane | {"numerics": MESH | {"cells": 32}}])
    assert "fold" in {branch.name for branch in found.branches}


@pytest.mark.slow
@pytest.mark.paper2
def test_controls_of_inflation(same_on_ranks):
    inflated = {"problem": "controls", "alpha": 0.0, "V_r": 20.0, "numerics": MESH | {"cells": 24}}
    tube, _ = same_on_ranks([inflated | {"u_end": 2.0}, inflated | {"body": "circular"}])
    assert "mass_fold" in {point.kind for point in tube.special_points}


@pytest.mark.paper2
def test_whole_tube_and_eigenvalues(same_on_ranks):
    whole = {"problem": "tube", "extent": "full"}
    free = whole | {"alpha": 0, "u_end": 1.4, "at": [("eigenvalue_1", 0.0)]}
    # The line force of a small patch is a difference of forces, zero but for their round-off.
    touching = whole | {"contact": "frictionless", "p_end": 1.6, "at": [("p", 1.5)]}
    found, _ = same_on_ranks([item | {"numerics": MESH} for item in (free, touching)])
    assert [point.kind for point in found.special_points] == ["limit_point", "bifurcation_point"]


@pytest.mark.paper2
@pytest.mark.slow
def test_lopsided_states_of_a_tube(same_on_ranks):
    whole = {"problem": "tube", "alpha": 0, "u_end": 1.4, "extent": "full", "secondary": True}
    relaxed = whole | {"energy": "relaxed"}
    found, wrinkled = same_on_ranks([item | {"numerics": MESH} for item in (whole, relaxed)])
    assert found.special_points[0].kind == "limit_point"
    assert found.branch("secondary")["w_mid"].max() > 0.3
    assert wrinkled.branch("secondary")["wrinkled_fraction"].max() > 0.02


@pytest.mark.paper2
def test_bent_states_of_a_tube(same_on_ranks):
    surface = {"secondary_cells": 8, "secondary_around": 4, "secondary_degree": 3}
    bent = {"problem": "tube", "alpha": 0, "lf": 10, "u_end": 0.8, "secondary": True, "secondary_n": 1}
    (found,) = same_on_ranks([bent | {"numerics": MESH | surface}])
    assert found.special_points[-1].values["p_2"] < 0 < found.special_points[-1].values["V_2"]
    columns = found.branch("secondary").columns
    assert columns["u_wave"].max() > 0.3
    assert set(columns["n_negative_all_volume"]) == {0}
    assert columns["t_min"][0] > columns["t_min"][-1]


@pytest.mark.paper2
def test_wrinkled_tubes(same_on_ranks):
    wrinkled = {"problem": "tube", "energy": "relaxed", "numerics": MESH | {"cells": 32}}
    given = (
        {"alpha": 0.02, "u_end": 2.6, "at": [("u_max", 2.0)]},
        {"alpha": 0.0, "u_end": 1.7, "extent": "full", "at": [("u_max", 1.65)]},
    )
    half, whole = same_on_ranks([wrinkled | one for one in given], traces=False)
    assert [point.kind for point in half.special_points].count("wrinkling_onset") == 2
    assert [point.kind for point in whole.special_points][-1] == "wrinkling_onset"


@pytest.mark.paper2
@pytest.mark.slow
def test_early_wrinkles(same_on_ranks):
    numerics = MESH | {"cells": 48, "degree": 6, "step": 0.2}
    far = {"problem": "tube", "energy": "relaxed", "contact": "frictionless", "numerics": numerics}
    given = (
        {"alpha": 0.0, "s": 3.0, "p_end": 1.4, "at": [("u_max", 1.8), ("u_max", 2.01)]},
        {"alpha": 0.0, "s": 3.0, "p_end": 1.3, "extent": "full", "at": [("u_max", 1.8), ("u_max", 2.01)]},
    )
    half, whole = same_on_ranks([far | one for one in given], traces=False)
    for found in (half, whole):
        assert "contact_onset" in [point.kind for point in found.special_points]
    for ours, theirs in zip(half.states, whole.states, strict=True):
        for name in ("p", "Z_front", "Z_front_1", "Z_front_2"):
            value = theirs.quantities[name].value  # by the same equations, on a mesh and on its mirror image
            assert ours.quantities[name].value == pytest.approx(value, rel=TOLERANCE)


@pytest.mark.paper2
@pytest.mark.slow
def test_a_bent_tube_that_wrinkles(same_on_ranks):
    surface = {"secondary_cells": 8, "secondary_around": 4, "secondary_degree": 3}
    bent = {"problem": "tube", "alpha": 0, "lf": 10, "u_end": 1.1, "secondary": True, "secondary_n": 1}
    relaxed = bent | {"energy": "relaxed", "numerics": MESH | surface, "branch": "secondary"}
    (found,) = same_on_ranks([relaxed | {"at": [("V", 7.3)]}], traces=False)
    assert found.states[0].quantities["wrinkled_fraction"].value > 5e-4
    assert found.states[0].quantities["t_min"].value == pytest.approx(0, abs=1e-12)


@pytest.mark.paper2
@pytest.mark.slow
def test_states_of_an_uneven_tube(same_on_ranks):
    whole = {"problem": "tube", "alpha": 0, "u_end": 1.6, "extent": "full", "secondary": True}
    (found,) = same_on_ranks([whole | {"uneven": 0.01, "numerics": MESH}])
    kinds = [point.kind for point in found.special_points if point.branch == "secondary"]
    assert kinds[:2] == ["limit_point", "volume_fold"]


@pytest.mark.slow
@pytest.mark.paper2
def test_tube_with_waves_around(same_on_ranks):
    half = {"problem": "tube", "alpha": 0, "u_end": 1.6, "n": [0, 2], "at": [("u_max", 1.2)]}
    whole = {"problem": "tube", "alpha": 0, "u_end": 1.2, "n": [1], "extent": "full"}
    found = same_on_ranks([item | {"numerics": MESH} for item in (half, whole)])
    kinds = [[point.kind for point in result.special_points] for result in found]
    assert kinds == [["limit_point", "mirror_breaking", "wrinkling_onset"], ["limit_point", "bifurcation_n1"]]


@pytest.mark.paper2
@pytest.mark.slow
def test_tube_whose_spring_lets_go(same_on_ranks):
    pushing = {"problem": "tube", "contact": "adhesive", "phase": "deflation", "spring": "unilateral"}
    same_on_ranks([pushing | {"delta1": 2.0, "at": [("p", 2.0), ("p", 0.5)], "numerics": MESH}])


@pytest.mark.paper1
def test_disk(same_on_ranks):
    free = {"problem": "circular", "alpha": 0, "t_end": 1.4, "at": [("p", 2.0), ("t0", 1.2)]}
    stuck = {"problem": "circular", "contact": "adhesive", "at": [("p", 1.0), ("p", 3.0)]}
    peeled = {"problem": "circular", "phase": "peeling", "at": [("p", 1.4)]}
    # The stuck patch's history is a fixed point, known to 2e-11; derivatives at its edge multiply that.
    same_on_ranks([free | {"numerics": MESH}])
    same_on_ranks([item | {"numerics": MESH} for item in (stuck, peeled)])


LEAST = """
import numpy as np
from mpi4py import MPI
from tests.solvers.continuation.test_lines import bowed
from weakforms.solvers.equilibrium.state import State
comm = MPI.COMM_WORLD
system, least = bowed(8, comm)
for s in (0.1, 0.9):
    with system.at(State(np.full(system.size, 0.45), {"load": 0.45, "s": s})):
        least.turn()
    places = comm.allgather(least.place)
    if comm.rank == 0:
        print("PLACES", *places)
"""


def test_all_ranks_know_the_place_of_a_least_value(launcher):
    lines = [line.split()[1:] for line in start(["-c", LEAST], 2).splitlines() if line.startswith("PLACES")]
    assert [[float(text) for text in line] for line in lines] == [
        pytest.approx([place, place], abs=1e-9) for place in (0.1, 0.9)
    ]
