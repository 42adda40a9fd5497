"""Lines of critical points of the wrinkled tube: against its own problem, and what is refused."""

import numpy as np
import pytest
from mpi4py import MPI

from weakforms import solve
from weakforms.errors import InputError
from weakforms.problems.diagram import problem
from weakforms.problems.diagram.bodies.wrinkled import VariedWrinkledTube
from weakforms.problems.diagram.parameters import DiagramParameters
from weakforms.solvers.equilibrium.state import State

TUBE = {"body": "wrinkled_tube", "alpha": 0.01, "delta": 2.0}
MESH = {"cells": 48, "levels": 2, "step": 0.3}


@pytest.fixture(scope="module", autouse=True)
def searched_at_both_ends():
    """Lines are looked for at the ends of these short ranges, not between them too: most of their time."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(problem, "SCANNED", 2)
        yield


@pytest.fixture(scope="module")
def radii(searched_at_both_ends):
    """Limit points about the radius of the disks at which they are about to wrinkle."""
    plane = TUBE | {"x": "Af", "Af": 0.82, "low": 0.81, "high": 0.85, "kind": "fold", "V_end": 18.5}
    return solve("diagram", **plane, numerics=MESH, at={"Af": 0.81}, branch="fold")


def test_the_limit_point_of_one_tube_is_on_the_line(radii):
    tube = solve("wrinkled_tube", M=0.5, delta=2, Af=0.81, load="gas", load_end=0.9, numerics={"levels": 2})
    (limit,) = tube.points("limit_point")
    found = radii.states[0].quantities
    for name in ("p", "V", "Pi"):
        assert found[name].value == pytest.approx(limit.values[name], rel=1e-8), name


def test_lines_of_wrinkled_and_taut_membranes_meet_where_the_disk_is_about_to_wrinkle(radii):
    """The table ``wrinkled_meetings`` has ``Af = 0.835090405643``; the case compares all of it."""
    (point,) = radii.points("wrinkling_fold")
    assert point.values["Af"] == pytest.approx(0.835090405643, abs=1e-8)
    wrinkled, taut = (radii.branch(name).columns for name in ("fold", "fold_2"))
    assert set(wrinkled["wrinkled"]) == {1.0}
    assert wrinkled["Af"].max() == pytest.approx(taut["Af"].min(), abs=5e-3)
    assert any("a zone opens or closes" in item.reason for item in radii.absent)


def test_first_wrinkling_ends_at_the_threshold_without_pressure():
    """The table ``thresholds`` of paper 4 has ``M = 0.735181722207``."""
    plane = TUBE | {"M": 0.7, "low": 0.7, "high": 0.8, "kind": "wrinkling", "V_end": 6.0}
    line = solve("diagram", **plane, numerics=MESH).branch("wrinkling").columns
    assert line["p"].min() == pytest.approx(0.0, abs=1e-12)
    assert line["M"].max() == pytest.approx(0.735181722207, abs=1e-9)


LIQUID = TUBE | {"y": "zw", "V_end": 30.0}


@pytest.mark.parametrize(("gamma", "partly"), [(0.05, False), (0.3, True)])
def test_the_highest_level_of_one_tube_is_on_the_line(gamma, partly):
    """Full, with three fronts or two, and filled in part, where the free surface is one more unknown."""
    given = {"M": 0.5, "delta": 2, "Af": 0.5, "gamma": gamma}
    tube = solve("wrinkled_tube", load="fluid", load_end=25, **given, numerics={"levels": 2})
    (limit,) = tube.points("limit_point")
    assert (limit.values["zw"] < 2 * 8.0) == partly
    plane = LIQUID | given | {"x": "M", "low": 0.49, "high": 0.51, "kind": "fold"}
    found = solve("diagram", **plane, numerics=MESH, at={"M": 0.5}, branch="fold").states[0].quantities
    for name in ("zw", "V", "Pi"):
        assert found[name].value == pytest.approx(limit.values[name], rel=1e-8), name
    assert found["wrinkled"].value == 1


def test_first_wrinkling_comes_to_the_threshold_as_the_tube_is_emptied():
    """The table ``thresholds`` has ``M = 0.735181722207``; the line's last level is 0.004 at the ring."""
    plane = LIQUID | {"gamma": 0.05, "M": 0.7, "low": 0.7, "high": 0.8, "kind": "wrinkling", "V_end": 6.0}
    solution = solve("diagram", **plane, numerics=MESH)
    line = solution.branch("wrinkling").columns
    below = 0.735181722207 - line["M"][line["zw"] < 0.3]
    assert 0 <= below.max() < 2e-5
    assert any("the liquid reaches a ring" in item.reason for item in solution.absent)


@pytest.fixture(scope="module")
def wrinkled_at_both_disks():
    """States with two fronts, under gas, and with the free surface between them, under a liquid."""
    found = {}
    for load, of_liquid in (("p", {}), ("zw", {"gamma": 0.3})):
        values = {"M": 0.5, "delta": 2.0, "L": 6.0, "Af": 0.5} | of_liquid
        law = DiagramParameters(body="wrinkled_tube", alpha=0.1).material
        model = VariedWrinkledTube(MPI.COMM_WORLD, law, values, 16, 4)
        parts = [part for part in model.primary(8.0, 0.5) if len(part.points) > 2]
        part = next(p for p in parts if len(model.part(p.points[0].state).fronts) == 2 + len(of_liquid))
        found[load] = model, min(part.points, key=lambda point: point.monitors["crowded"]).state
    return found


@pytest.mark.parametrize(
    ("load", "name"),
    [
        *(("p", name) for name in ("M", "delta", "L", "Af", "alpha", "b3", "b5")),
        *(("zw", name) for name in ("zw", "gamma", "delta", "L", "b2", "b4", "b6")),
    ],
)
def test_every_parameter_is_a_load(wrinkled_at_both_disks, load, name):
    """The derivative of the forces by a parameter, a front or the surface is that of differences."""
    model, state = wrinkled_at_both_disks[load]
    system, step = model.system, 1e-5

    def forces(by: float) -> np.ndarray:
        with system.at(State(state.u, {**state.loads, name: state.loads[name] + by}, state.marks)):
            return system.residual()

    with system.at(state):
        exact = system.load_derivative(name)
    differences = (forces(step) - forces(-step)) / (2 * step)
    assert np.abs(exact - differences).max() < 1e-6 * np.abs(exact).max()


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"x": "p", "y": "zw"}, "x = 'p' is no parameter of wrinkled_tube"),
        ({"x": "gamma"}, "x = 'gamma' is no parameter of wrinkled_tube"),
        ({"kind": "n2"}, "body = 'wrinkled_tube' has no lines of waves around its axis"),
        ({"kind": "mirror"}, "body = 'wrinkled_tube' has no mirror"),
        ({"kind": "contact"}, "body = 'wrinkled_tube' touches nothing"),
        ({"M": 0.5, "low": 0.05}, "the range of M must be increasing and between 0.1 and 1.9"),
        ({"model": "harmonic"}, "body = 'wrinkled_tube': model = 'harmonic'"),
    ],
)
def test_bad_input_is_refused_in_one_line(given, message):
    with pytest.raises(InputError, match="diagram") as refused:
        solve("diagram", **({"body": "wrinkled_tube"} | given))
    assert message in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("given", [{"gamma": 0.1}, {"y": "zw", "p_high": 1.0}])
def test_what_has_no_effect_without_its_load_is_named(given):
    name = list(given)[-1]
    plane = TUBE | {"M": 0.9, "low": 0.88, "high": 0.92, "kind": "fold", "V_end": 12.0} | given
    with pytest.warns(UserWarning, match=f"{name} = .* has no effect here"):
        solve("diagram", **plane, numerics=MESH)
