"""States, fronts and histories that are no answer are refused, problem by problem, on stand-ins."""

from contextlib import nullcontext
from types import SimpleNamespace

import numpy as np
import pytest
from stand_ins import always, bare, raising, refused

from weakforms.errors import AbsentError, ConvergenceError
from weakforms.problems.contact.history import ITERATIONS, History
from weakforms.problems.liquid_tube import coincidence
from weakforms.problems.liquid_tube.bent import bifurcation_point, fitted, slopes
from weakforms.problems.liquid_tube.bent import branch as bent_branch
from weakforms.problems.liquid_tube.bent import problem as whole_surface
from weakforms.problems.liquid_tube.bent.family import SecondaryFamily
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


# -- bent tubes ------------------------------------------------------------------------------------


def beside(eigenvalues, counts, overlap):
    """What is solved for beside a bifurcation: eigenvalues over the volume, negative ones, the mode."""
    solved = [Solved({"zw": 1.0}, State(np.ones(2), {"zw": 1.0})) for _ in eigenvalues]
    mode = np.array([overlap, np.sqrt(1 - overlap**2)])
    return solved, eigenvalues, [mode] * len(eigenvalues), counts


def test_a_bifurcation_that_the_surface_does_not_have(monkeypatch):
    along = bifurcation_point.chebyshev.chebpts1(bifurcation_point.NODES)
    system = SimpleNamespace(dot=np.dot, mass_times=lambda u: u, at=always(nullcontext()))
    model = SimpleNamespace(system=system, interpolated=always(np.array([1.0, 0.0])))
    monkeypatch.setattr(bifurcation_point, "displacement", always(None))
    at = SimpleNamespace(values={"V": 5.0})
    same = [1] * len(along)

    def told(*given):
        monkeypatch.setattr(bifurcation_point, "_neighbouring_states", always(beside(*given)))
        return lambda: bifurcation_point.bifurcation_on(model, None, at)

    found, mode, negative, _ = told(list(along - 0.1), same, 1.0)()
    assert (found.kind, negative) == ("bifurcation_point", 1)
    assert mode == pytest.approx([1.0, 0.0], abs=1e-12)  # SciPy's interpolator shuffles its nodes
    lost = r"no bifurcation on the surface within 0\.1 of V = 5: .*; raise secondary_cells$"
    refused(lost, told(list(along + 2), same, 1.0))

    def shifted(_model, _primary, _at, volume, along):
        return beside(list(volume * (1 + bifurcation_point.SPAN * along) - 5.2), same, 1.0)

    monkeypatch.setattr(bifurcation_point, "_neighbouring_states", shifted)
    trend = bifurcation_point.bifurcation_on(model, None, at)[-1]
    assert trend.volume == pytest.approx(5.2, rel=bifurcation_point.SPAN)
    refused(
        "the null vector on the surface is not the axisymmetric branch's mode", told(list(along), same, 0.8)
    )


@pytest.mark.parametrize(("beside", "others"), [(2e-6, 3), (-2e-6, 4)])
def test_a_mode_that_changes_sign_beside_a_bifurcation_is_counted_there(monkeypatch, beside, others):
    """Three eigenvalues below the target, that of the bifurcation's mode near zero, and another one."""
    near = [SimpleNamespace(eigenvalue=v, vector=u) for v, u in ((-1e-9, [1.0, 0.0]), (beside, [0.0, 1.0]))]
    stability = SimpleNamespace(about=lambda _state, target, _count: (near, 3 if target == -1e-3 else None))
    monkeypatch.setattr(bifurcation_point, "Stability", always(stability))
    system = SimpleNamespace(dot=np.dot, mass_times=lambda u: u, at=always(nullcontext()))
    found = bifurcation_point._others(SimpleNamespace(system=system), None, np.array([1.0, 0.0]), 1e-3)
    assert found == others


def slopes_of(monkeypatch, *given):
    """The search beside another mode, with slopes that are given for each share of the amplitudes."""

    def found(_levels, _cap, share):
        return {"dzw_dV": given[slopes.SMALL.index(share)]}

    monkeypatch.setattr(slopes, "initial_slopes", found)
    return lambda: slopes.slopes_beside_another_mode([], 4.0)


def test_initial_slopes_beside_another_mode_are_those_of_two_sets_of_amplitudes(monkeypatch):
    assert slopes_of(monkeypatch, (1.0, 0.1), (1.1, 0.01))()["dzw_dV"] == pytest.approx((1.1, 0.11))
    assert slopes_of(monkeypatch, (3.0, 0.1), (1.1, 0.01), (1.09, 0.01))()["dzw_dV"] == pytest.approx(
        (1.09, 0.02)
    )
    refused(
        "initial slopes .* change L or delta$", slopes_of(monkeypatch, (3.0, 0.1), (2.0, 0.1), (1.0, 0.1))
    )


def test_a_bifurcation_point_that_is_no_equilibrium(monkeypatch):
    monkeypatch.setattr(bent_branch, "BorderedMatrix", always(bordered := SimpleNamespace()))
    bordered.solve = lambda rhs, _: (np.ones(1), None)
    monkeypatch.setattr(bent_branch, "residual_limit", always(1e-8))
    left = [1e-3]
    system = SimpleNamespace(
        size=1,
        dot=np.dot,
        mass_times=lambda u: u,
        at=always(nullcontext()),
        residual=lambda: np.array(left),
        monitors=dict,
    )
    told = bare(bent_branch.SecondaryBranch, model=SimpleNamespace(system=system), mode=np.ones(1))
    told.bifurcation = Solved({}, State(np.ones(1), {"zw": 1.0}), "bifurcation_point")
    factor = SimpleNamespace(update=always(None))
    refused(r"^the bifurcation point has a residual of 1\.0e-03$", told._first, factor, 1)
    left[0] = np.nan
    refused(r"^the bifurcation point has a residual of nan$", told._first, factor, 1)
    left[0] = 1e-12
    assert told._first(factor, 1).n_negative == 1


def test_a_bent_state_that_is_not_another_meshs():
    gaps = iter((0.01, 0.2))
    state = State(np.ones(1), {})
    fitting = SimpleNamespace(shape=always(None), solve=always(state), apart=lambda *_: next(gaps))
    told = bare(bent_branch.SecondaryBranch, fitting=fitting)
    told._values = always({"zw": 1.0})
    assert told.at_guess(state, None).state is state
    refused(r"^converged 0\.2 away from another mesh's state$", told.at_guess, state, None)


def test_a_bent_branch_of_which_no_point_is_on_all_meshes():
    told = bare(SecondaryFamily, name="secondary", failures=[])
    told.fine = SimpleNamespace(shown=["zw"], control="zw")
    told.levels, told._on_all = [SimpleNamespace(points=[1, 2])], raising(STALLED)
    refused("^branch secondary: no point could be solved for on all meshes$", told.branch)
    (failure,) = told.failures
    assert failure.what == "branch secondary, points 0 to 1, 2 of them left out"
    assert failure.reason == "Newton stalled"


def test_a_mesh_that_never_comes_to_rest_on_the_free_surface():
    moves = []
    told = bare(fitted.Fitting, on_its_front=lambda state: state)
    told.model = SimpleNamespace(data=SimpleNamespace(length=8.0))
    told._refitted, told._solved = always(None), always("state")
    told._with_front = lambda *of: moves.append(of)
    told.move = always(0.0)
    assert told.solve(State(np.zeros(1), {}), []) == "state"
    told.move = always(1.0)
    refused("^the mesh does not come to rest on the free surface$", told.solve, State(np.zeros(1), {}), [])
    assert len(moves) == fitted.FITS


def test_a_level_that_does_not_reach_a_meridian():
    """At the second of two angles the guess lies above the level as a whole."""
    told = bare(fitted.Fitting, shape=lambda _state: lambda z, t: np.stack([z, z, z + 9.0 * t]))
    told.model = SimpleNamespace(data=SimpleNamespace(L=8.0, length=8.0))
    told.front = SimpleNamespace(angles=np.array([0.0, 0.125]), fitted=lambda wanted: wanted)
    told._with_front = lambda _state, wanted: wanted
    state = State(np.zeros(1), {"zw": 2.0})
    np.testing.assert_allclose(told.on_its_front(state), [2.0, 0.875], atol=1e-12)
    told.front.angles = np.array([0.0, 1.0])
    refused(r"^the liquid at zw = 2 does not reach the meridian at 1$", told.on_its_front, state)


def test_a_bifurcation_of_the_whole_surface_that_is_not_near():
    told = bare(whole_surface.WholeRun, full=False, begin=SimpleNamespace(values={"V": 5.0}))
    told._near = lambda volume: (volume, np.array([volume - 5.001]), 1.0)
    assert told.critical()["V_bifurcation"] == pytest.approx(5.001)
    told._near = lambda volume: (volume, np.array([volume**2 - 5.2**2]), 1.0)
    assert told.critical()["V_bifurcation"] == pytest.approx(5.2)
    for far in (lambda volume: volume, lambda volume: volume - 6, lambda _volume: 1.0):
        told._near = lambda volume, far=far: (volume, np.array([far(volume)]), 1.0)
        refused(r"^the n = 1 eigenvalue is not zero within 0\.1 of V = 5$", told.critical)


@pytest.mark.parametrize(("overlaps", "fits"), [((0.9, 0.1), True), ((0.4, 0.4), False)])
def test_modes_of_one_wave_that_are_not_among_those_found(overlaps, fits, monkeypatch):
    modes = [SimpleNamespace(eigenvalue=i + 1.0, vector=np.sqrt(x)) for i, x in enumerate(overlaps)]
    monkeypatch.setattr(whole_surface, "Stability", always(SimpleNamespace(modes=always(modes))))
    solver = SimpleNamespace(solve=always((State(None, {"zw": 2.0}), None)))
    monkeypatch.setattr(whole_surface, "ExtendedNewton", always(solver))
    told = bare(whole_surface.WholeRun, rows=[1.0], system=SimpleNamespace(dot=lambda a, b: a * b))
    told.primary, told.begin = SimpleNamespace(at=always(None)), SimpleNamespace(Z=None)
    told._guess = always(None)
    if fits:
        assert told._near(5.0) == (2.0, [1.0], 2.0)
    else:
        refused("the n = 1 modes are not among the eigenvalues nearest to zero", told._near, 5.0)


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
