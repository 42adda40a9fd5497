"""States, fronts and modes of bent tubes of liquid that are no answer are refused, on stand-ins."""

from contextlib import nullcontext
from types import SimpleNamespace

import numpy as np
import pytest
from stand_ins import always, bare, raising, refused

from weakforms.errors import ConvergenceError
from weakforms.problems.liquid_tube.bent import bifurcation_point, fitted, slopes
from weakforms.problems.liquid_tube.bent import branch as bent_branch
from weakforms.problems.liquid_tube.bent import problem as whole_surface
from weakforms.problems.liquid_tube.bent.family import SecondaryFamily
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.equilibrium.state import State

STALLED = ConvergenceError("Newton stalled")


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
