"""Contact of the tube on a fixed mesh tends to contact with a tracked front."""

from types import SimpleNamespace

import numpy as np
import pytest

from weakforms import solve
from weakforms.problems.tube.schemes import FixedMesh
from weakforms.solvers.equilibrium.state import State

LAW = {"semismooth": "frictionless", "pressure_steps": "adhesive", "front_nodes": "adhesive"}
"""The law of contact of a scheme's limit."""


@pytest.fixture(scope="module")
def tracked():
    """The state at ``p = 3`` by the law of contact."""
    coarse = {"cells": 32, "levels": 2, "step": 0.3}
    return {
        law: solve("tube", alpha=0.1, contact=law, at={"p": 3.0}, numerics=coarse).states[0].quantities
        for law in set(LAW.values())
    }


@pytest.mark.parametrize("scheme", LAW)
def test_a_scheme_tends_to_its_law_of_contact(scheme, tracked):
    own, other = (tracked[law] for law in sorted(set(LAW.values()), key=lambda law: law != LAW[scheme]))
    found = {}
    for cells in (48, 96):
        numerics = {"cells": cells, "steps": cells // 3 * 2}
        found[cells] = solve("tube_scheme", scheme=scheme, alpha=0.1, numerics=numerics).quantities
    for name in ("u_max", "contact_length"):
        exact, error = own[name].value, {n: abs(q[name].value - own[name].value) for n, q in found.items()}
        assert error[96] <= 2 * found[96][name].uncertainty + 1e-9 * exact, name
        assert 10 * error[96] < abs(exact - other[name].value), name
        assert found[96][name].uncertainty < 0.01 * exact


def test_the_front_lies_between_two_nodes_where_the_radius_is_that_of_the_substrate():
    given = SimpleNamespace(radial=np.array([4, 0, 2]), parameters=SimpleNamespace(s=1.3))
    state = State(np.array([1.34, 1.0, 1.14, 3.0, 1.5, 0.0]), {})
    found = FixedMesh.outcome(given, state)
    assert found["u_max"] == pytest.approx(0.5)
    assert found["contact_length"] == pytest.approx(2 * (1.0 + 0.2 * 2.0))
    assert FixedMesh.untouched(given, state) == {"u_max": 0.5, "contact_length": 0.0}


def test_a_node_of_a_steep_flank_approaches_the_substrate_in_steps():
    """A long tube bulges to ten radii: from node to node of its flank Newton's method does not converge."""
    law = {"model": "three_chain", "nkt": 6.504, "links": 132800.0}
    given = {"delta1": 1.917, "lf": 42.63, "k": 24.27, "s": 10.34, "p_end": 1.32, "scheme": "front_nodes"}
    result = solve("tube_scheme", **law, **given, numerics={"cells": 100, "steps": 8})
    found = {name: quantity.value for name, quantity in result.quantities.items()}
    assert result.absent == []
    assert found["u_max"] == pytest.approx(9.368, abs=2e-3)
    assert found["contact_length"] > 0
