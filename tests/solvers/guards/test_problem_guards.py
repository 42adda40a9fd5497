"""States, fronts and histories that are no answer are refused, problem by problem, on stand-ins."""

from contextlib import nullcontext
from types import SimpleNamespace

import numpy as np
import pytest
from stand_ins import always, bare, raising, refused

from weakforms.errors import AbsentError, ConvergenceError
from weakforms.problems.contact.history import ITERATIONS, History
from weakforms.problems.liquid_tube import coincidence
from weakforms.problems.problem import Task
from weakforms.problems.triangles import branch as triangles
from weakforms.problems.tube import problem as tube_problem
from weakforms.problems.wrinkled import branch as wrinkled_branch
from weakforms.problems.wrinkled import critical as wrinkled_critical
from weakforms.problems.wrinkled import events as wrinkled_events
from weakforms.problems.wrinkled import fields as wrinkled_fields
from weakforms.problems.wrinkled import fitted as wrinkled_fitted
from weakforms.problems.wrinkled.fields import Zones
from weakforms.problems.wrinkled.waves.stability import Sample, StabilityChanges
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.equilibrium.state import State

STALLED = ConvergenceError("Newton stalled")


# -- histories of a stuck patch --------------------------------------------------------------------


@pytest.mark.parametrize(("radial", "axial"), [(1.0, 3.0), (4.0, -1.0), (np.nan, 3.0), (4.0, np.nan)])
def test_a_history_that_does_not_settle_is_refused(radial, axial):
    """What is frozen twice over in the first condition and once in the second; outside it turns round."""
    told = bare(History, fronts=np.ones(1), write=always(None), _weights=np.ones(2))
    told._frozen, told._sensitivity = np.diag([2.0, 1.0]), always(-np.diag([2.0, 1.0]))
    given = [None], np.array([2.0, 3.0])
    told._outside = always(np.array([4.0, 3.0]))
    told.solve(*given)  # nothing is left to mend
    assert told.found == pytest.approx([2.0, 3.0])
    turns = iter(range(ITERATIONS))

    def outside():
        way = (-1.0) ** next(turns)
        return np.array([4.0 + way * (radial - 4.0), 3.0 + way * (axial - 3.0)])

    told._outside = outside
    refused(f"history of the stuck patch: defect .* after {ITERATIONS} iterations", told.solve, *given)


# -- tubes under gas and liquid --------------------------------------------------------------------


def test_a_fold_line_that_finer_meshes_do_not_have(monkeypatch):
    branches = iter(([1], [1], []))
    maker = lambda *_: lambda _level: SimpleNamespace(turns=lambda: next(branches))  # noqa: E731
    monkeypatch.setattr(tube_problem, "branch_maker", maker)
    monkeypatch.setattr(tube_problem, "fold_line_between", always(SimpleNamespace(stalled="")))
    problem = tube_problem.TubeFold()
    task = Task(problem.parameters(), problem.numerics(cells=32, levels=2), None, None, None)
    refused("delta1 = 1: a limit point on 16 cells, but none on 32: raise cells", problem.families, task)


def pieces(*kinds, stalled=""):
    located = [Solved({"V": 1.0, "n": n}, None, kind) for kind, n in kinds]
    piece = SimpleNamespace(special=lambda: located, stalled=stalled)
    return SimpleNamespace(data=SimpleNamespace(delta=2.0), pieces=[piece], zw_end=0.5)


def test_a_coincidence_needs_both_points():
    told = bare(coincidence._Finder)
    found = told._points(pieces(("limit_point", 0), ("bifurcation_point", 1)))
    assert (found[0][1].kind, found[1].kind) == ("limit_point", "bifurcation_point")
    words = "at delta = 2 the branch has 1 limit points and 0 bifurcations with one wave"
    with pytest.raises(AbsentError, match=words):
        told._points(pieces(("limit_point", 0), ("bifurcation_point", 2)))
    words = "at delta = 2 the branch has 0 limit points and 1 bifurcations with one wave"
    with pytest.raises(AbsentError, match=words):
        told._points(pieces(("bifurcation_point", 1)))
    words = "^fluid_tube_coincidence: at delta = 2: Newton stalled$"
    refused(words, told._points, pieces(("bifurcation_point", 1), stalled="Newton stalled"))


def test_a_coincidence_far_from_where_it_was_looked_for(monkeypatch):
    variation = SimpleNamespace(mass_times=always(None), nearest=always(SimpleNamespace(vector=None)))
    system = SimpleNamespace(at=always(nullcontext()), monitors=lambda: {"V": 1.0})
    path = SimpleNamespace(
        model=SimpleNamespace(system=system),
        modes=SimpleNamespace(variation=always(variation), observe=dict),
    )
    limit = SimpleNamespace(state=State(np.zeros(1), {}))
    told = bare(coincidence._Finder, _path=always(path))
    told._points = always(((SimpleNamespace(loads=()), limit), None))
    solver = SimpleNamespace(solve=lambda *_: (State(np.zeros(1), {"delta": 2.5}), None))
    monkeypatch.setattr(coincidence, "ExtendedNewton", always(solver))
    assert told.exactly(0, 2.5)["V"] == 1.0
    refused(r"converged to delta = 2\.5, far from 2$", told.exactly, 0, 2.0)


# -- triangles -------------------------------------------------------------------------------------


@pytest.mark.parametrize("residual", [1e-3, np.nan])
def test_a_ring_periodic_state_that_is_none_of_the_whole_surface(residual, monkeypatch):
    monkeypatch.setattr(triangles, "residual_limit", always(1e-8))
    told = bare(triangles.SurfaceRun, rings=True, control="zw")
    told._subspace = SimpleNamespace(solve=always((None, None)), negative_count=always(0))
    told.system = SimpleNamespace(residual=lambda: np.array([residual]), dot=np.dot, at=always(nullcontext()))
    words = (
        "zw = 2: the ring-periodic equilibrium is not one of the whole surface, "
        f"its residual is {residual:.1e}"
    )
    refused(words, told._point, 2.0, None)


# -- wrinkled tubes --------------------------------------------------------------------------------


def test_a_wrinkled_branch_without_a_single_state():
    told = bare(wrinkled_branch.WrinkledBranch, name="primary", _failures=[])
    told._prescribed, told._fine_state = lambda: [(None, "zw")] * 2, raising(STALLED)
    refused("^branch primary: no point could be solved for on fitted meshes$", lambda: told._fine)
    assert [f.what for f in told._failures] == ["branch primary, point 0", "branch primary, point 1"]


@pytest.mark.parametrize("limits", [0, 2])
def test_a_limit_load_that_is_not_one(limits, monkeypatch):
    continuation = SimpleNamespace(start=always(SimpleNamespace(tangent=SimpleNamespace(loads={"p": 1.0}))))
    monkeypatch.setattr(wrinkled_fitted, "Continuation", always(continuation))
    monkeypatch.setattr(wrinkled_fitted, "solver_of", always(None))
    found = SimpleNamespace(special=always([None] * limits))
    monkeypatch.setattr(wrinkled_fitted, "FittedBranch", always(found))
    model = SimpleNamespace(system=SimpleNamespace(weighed_here=nullcontext))
    held = SimpleNamespace(model=model, lent=nullcontext, scalars=("p",), constraints=(), state=None)
    told = bare(wrinkled_fitted.FittedMembrane, control="p")
    words = f"^{limits} limit loads between V = 4 and 6 on a fitted mesh$"
    refused(words, told.limit, held, 4.0, 6.0)


def unloaded(gw):
    """A membrane whose least ``gw`` without a load is a function of the thickness ratio."""
    membrane = SimpleNamespace(values={"M": 1.0, "Af": 0.7, "delta": 2.0})
    state = SimpleNamespace(extreme=lambda *_: gw(membrane.values["M"]))
    membrane.unloaded_from = always(state)
    return membrane


def test_a_threshold_of_the_thickness_ratio_that_does_not_exist():
    first = wrinkled_critical._first_wrinkled
    membrane = unloaded(lambda M: 0.8 + M / 2)
    _, clear = first(membrane, 0, -1)
    assert membrane.values["M"] == pytest.approx(0.4, abs=0.051)
    assert 0.4 < clear < 0.46
    words = "^the membrane of uniform thickness is not taut: there is no threshold$"
    refused(words, first, unloaded(always(0.9)), 0, -1)
    membrane.unloaded_from = raising(STALLED)
    refused("^Newton stalled$", first, membrane, 0, -1)


def at_load(load, touched=2.0):
    return SimpleNamespace(state=SimpleNamespace(loads={"p": load}), touched=touched, zones=None)


@pytest.mark.parametrize(("load", "touched"), [(3.5, 2.0), (0.5, 2.0), (1.5, -0.1), (1.5, 4.1)])
def test_an_event_of_a_zone_outside_its_bracket(load, touched):
    membrane = SimpleNamespace(length=4.0, control="p", touching=always([at_load(1.5)] * 2))
    located = wrinkled_events._located
    given = membrane, at_load(1.0), at_load(3.0), (1.0, 3.0, 1.0), 0, "p", True
    assert located(*given)[0].kind == "zone_opening"
    membrane.touching = always([at_load(load, touched)] * 2)
    refused(rf"^a zone's event was found at p = {load:g}, outside \[1, 3\]$", located, *given)


@pytest.mark.parametrize(("radius", "inside_out"), [(1.0, False), (-0.1, True)])
def test_an_equilibrium_that_is_turned_inside_out(radius, inside_out):
    model = SimpleNamespace(breaks_of=always(np.array([0.0, 4.0])), blocks=1, cells=2)
    model.material = lambda x, _: 4 * x
    sampled = lambda s, _: {"r": np.full_like(s, radius), "gw": np.full_like(s, 2.0)}  # noqa: E731
    meridian = SimpleNamespace(model=model, sampled=sampled)
    given = meridian, {}, 1e-9, False
    if inside_out:
        refused("^the equilibrium is turned inside out$", wrinkled_fields.zones, *given)
    else:
        assert wrinkled_fields.zones(*given).fronts == ()


def test_a_pattern_of_zones_that_its_solution_never_shows():
    """Solved for with a front it shows none, and solved for without one it does."""
    front, none = Zones(1.0, (2.0,)), Zones(1.0, ())
    told = bare(wrinkled_fitted.FittedMembrane, length=4.0, meshes=[8], liquid=False, near_fronts=())
    shown = iter([front, *[none, front] * wrinkled_fitted.ATTEMPTS])
    told.fit = lambda _level, _start, wanted, _constraints: SimpleNamespace(
        zones=wanted, shown_zones=lambda *_: next(shown)
    )
    given = SimpleNamespace(zones=front), None, 1e-3, False
    assert told._pattern(*given).zones == front
    refused(r"^no pattern of zones agrees with its own solution \(none tried\)$", told._pattern, *given)
    told.fit = raising(STALLED)
    refused("^Newton stalled$", told._pattern, SimpleNamespace(zones=none), None, 1e-3, False)


def test_fronts_that_pass_each_other(monkeypatch):
    told = bare(
        wrinkled_fitted.FittedMembrane, length=4.0, meshes=[8], near_fronts=(), on_meshes=[{}], control="p"
    )
    told.moved = always(SimpleNamespace(loads={}))
    model = SimpleNamespace(breaks_of=always(np.array([0.0, 3.0, 2.0, 4.0])))
    monkeypatch.setattr(wrinkled_fitted, "model_on", always(model))
    solver = SimpleNamespace(solve=always((SimpleNamespace(loads={}), None)))
    monkeypatch.setattr(wrinkled_fitted, "solver_of", always(solver))
    wanted = Zones(1.0, (), None, True)
    refused("^fronts changed their order$", told.fit, 0, None, wanted, ())
    model.breaks_of = always(np.array([0.0, 2.0, 3.0, 4.0]))
    assert told.fit(0, None, wanted, ()).zones == wanted


def test_an_eigenvalue_that_leaps_where_no_zone_does():
    told = bare(StabilityChanges, n=20)
    sides = Sample(1.25, None, -0.5), Sample(1.25, None, 0.25)
    words = r"^Lambda for n = 20 jumps from -0\.5 to 0\.25 at zw = 1\.25, where no zone opens or closes$"
    refused(words, told._on_all, [], "zw", sides)


def test_a_root_that_a_coarser_mesh_does_not_have():
    told = bare(StabilityChanges, n=20, membrane=SimpleNamespace(fit=always(SimpleNamespace(zones=None))))
    told.lowest = always(1.0)
    start = SimpleNamespace(zones=None)
    refused(
        "^the root of Lambda for n = 20 was not found on mesh 1$", told._on_mesh, 1, start, "zw", 2.0, 1.0
    )
    told.lowest = always(0.0)
    assert told._on_mesh(1, start, "zw", 2.0, 1.0) is start
