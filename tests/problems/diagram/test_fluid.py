"""Lines of critical points of the tube filled by a liquid: against its own problem, and what is refused."""

from math import pi

import numpy as np
import pytest
from mpi4py import MPI

from weakforms import solve
from weakforms.errors import InputError
from weakforms.problems.diagram.bodies.liquid import VariedFluidTube
from weakforms.problems.diagram.parameters import DiagramParameters
from weakforms.solvers.equilibrium.state import State

MESH = {"cells": 32, "levels": 2}
FILLED = {"body": "fluid_tube", "alpha": 0.0}


@pytest.fixture(scope="module")
def full():
    """Where a state is both limit point and neutral to one wave, over a full tube."""
    given = FILLED | {"low": 4.3, "high": 5.0, "kind": "fold,n1", "numerics": MESH}
    return solve("diagram", **given, at={"delta": 5.0}, branch="n1")


@pytest.fixture(scope="module")
def brim():
    """The line of one wave about the pre-stretch at which its level is at the upper ring."""
    return solve("diagram", **FILLED, low=2.8, high=3.3, kind="n1", V_end=30, numerics=MESH)


def test_the_critical_points_of_one_tube_are_on_the_lines(full):
    own = {"cells": 64, "levels": 2}
    tube = solve("fluid_tube", L=8.0, delta=5.0, gamma=0.116, n_max=1, numerics=own)
    (limit,) = tube.points("limit_point")
    bends = next(point for point in tube.points("bifurcation_point") if point.values["n"] == 1)
    line = full.branch("fold").columns
    assert line["delta"][-1] == pytest.approx(5.0, abs=1e-12)
    for name, scale in (("zw", 1.0), ("V", 1 / (2 * pi)), ("Pi", 1 / pi)):
        assert line[name][-1] == pytest.approx(limit.values[name] * scale, rel=1e-8), name
        found = full.states[0].quantities[name].value
        assert found == pytest.approx(bends.values[name] * scale, rel=1e-8), name


def test_both_lines_have_the_point_of_the_other_problem(full):
    """The table ``coincidence`` of paper 3 has ``delta = 4.46867454656``; the case compares all of it."""
    one, two = full.points("fold_n1")
    assert {one.branch, two.branch} == {"fold", "n1"}
    for point in (one, two):
        assert point.values["delta"] == pytest.approx(4.46867454656, abs=1e-8)
        assert point.values["wrinkled"] == 0


def test_a_full_tube_bends_first_if_its_pre_stretch_is_large(full):
    both = full.points("fold_n1")[0].values["delta"]
    line = full.branch("fold").columns
    assert np.all((line["n_negative_n1"] == 1) == (line["delta"] > both))


def test_lines_end_where_the_liquid_is_at_the_ring_and_go_on_as_others(brim):
    """The line is continuous there, in the unknowns of a full tube and of a partially filled one."""
    ends = []
    for name in ("n1", "n1_2"):
        line = brim.branch(name).columns
        ends.append(min((abs(line["zw"][k] - 8.0), line["delta"][k], line["V"][k]) for k in (0, -1)))
    assert sorted(gap for gap, *_ in ends) == pytest.approx([0.0, 7.5e-4], abs=1e-4)
    assert ends[0][1:] == pytest.approx(ends[1][1:], rel=2e-3)
    partly = min((brim.branch(name) for name in ("n1", "n1_2")), key=lambda b: b.columns["zw"].min())
    assert partly.columns["zw"].max() < 8.0
    assert brim.failures == []
    assert any("the liquid reaches a ring" in item.reason for item in brim.absent)


@pytest.mark.parametrize("name", ["L", "delta", "gamma", "alpha"])
def test_every_parameter_is_a_load(name):
    """The derivative of the forces by a parameter is that of differences; also where the tube is not full."""
    values = {"delta": 2.0, "L": 6.0, "gamma": 0.2}
    law = DiagramParameters(body="fluid_tube", alpha=0.1).material
    model = VariedFluidTube(MPI.COMM_WORLD, law, values, 8, 4)
    system, step = model.system, 1e-5
    for piece in model.primary(4.0, 0.5)[:2]:
        state = piece.points[len(piece.points) // 2].state

        def forces(by: float, state: State = state) -> np.ndarray:
            with system.at(State(state.u, {**state.loads, name: state.loads[name] + by})):
                return system.residual()

        with system.at(state):
            exact = system.load_derivative(name)
        differences = (forces(step) - forces(-step)) / (2 * step)
        assert np.abs(exact - differences).max() < 1e-6 * np.abs(exact).max()


@pytest.mark.parametrize(("name", "value"), [("L", 8.2), ("gamma", 0.118), ("alpha", 0.02)])
def test_lines_over_other_parameters_pass_the_limit_points_of_single_tubes(name, value):
    tube = solve("fluid_tube", **{"alpha": 0.0, "delta": 4.0, name: value}, numerics=MESH)
    (limit,) = tube.points("limit_point")
    low = 0.98 * value  # where the line starts
    plane = {"body": "fluid_tube", "alpha": 0.0, "x": name, name: low, "low": low, "high": value}
    line = solve("diagram", **plane, kind="fold", numerics=MESH).branch("fold").columns
    here = int(np.argmax(line[name]))
    assert line[name][here] == pytest.approx(value, abs=1e-12)
    for column, scale in (("zw", 1.0), ("V", 1 / (2 * pi)), ("Pi", 1 / pi)):
        assert line[column][here] == pytest.approx(limit.values[column] * scale, rel=1e-8), column


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"y": "p"}, "y = 'p' is no parameter of fluid_tube"),
        ({"x": "delta1"}, "x = 'delta1' is no parameter of fluid_tube"),
        ({"x": "L", "y": "gamma"}, "one of both must be zw; set x or y to zw"),
        ({"kind": "mirror"}, "body = 'fluid_tube' has no mirror"),
        ({"kind": "contact"}, "body = 'fluid_tube' touches nothing"),
        ({"low": 1.0}, "the range of delta must be increasing and between 1.05 and 9"),
        ({"zw_low": 9.0, "zw_high": 8.0}, "zw_low = 9 must be less than zw_high = 8"),
        ({"model": "three_chain"}, "body = 'fluid_tube': model = 'three_chain'"),
        ({"model": "gent", "jm": 5.0, "low": 3.0, "high": 8.0}, "beyond what model = 'gent'"),
        ({"gamma": -1.0}, "gamma = -1.0"),
    ],
)
def test_bad_input_is_refused_in_one_line(given, message):
    with pytest.raises(InputError, match="diagram") as refused:
        solve("diagram", body="fluid_tube", **given)
    assert message in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("body", "given"),
    [("tube", {"zw_high": 9.0}), ("tube", {"V_end": 9.0}), ("fluid_tube", {"p_high": 2.0})],
)
def test_a_level_is_of_the_liquid_alone_and_a_pressure_of_the_gas(body, given):
    (said,) = DiagramParameters(body=body, **given).without_effect()
    assert "has no effect here" in said
