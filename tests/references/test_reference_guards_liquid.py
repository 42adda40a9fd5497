"""No table of papers 3 to 5 is made of what did not converge: every iteration gives up with its words."""

from types import SimpleNamespace

import numpy as np
import pytest
from led_astray import AWAY, GAS, TUBE, Held, always, refused

from reference_data.solvers.paper3 import collocation as liquid
from reference_data.solvers.paper3 import galerkin, modes, path
from reference_data.solvers.paper3 import tables_critical as liquid_tables
from reference_data.solvers.paper3 import tables_secondary as bent_tables
from reference_data.solvers.paper3.bent import branch as bent_branch
from reference_data.solvers.paper3.bent import newton as bent
from reference_data.solvers.paper3.bent import states as bent_states
from reference_data.solvers.paper3.data import FluidTube
from reference_data.solvers.paper3.strong import equations as strong
from reference_data.solvers.paper4 import events, limits
from reference_data.solvers.paper4 import tables_branches as branches
from reference_data.solvers.paper4.methods import differences as wrinkled_fd
from reference_data.solvers.paper4.methods import shooting as wrinkled_shooting
from reference_data.solvers.paper4.methods import shooting_newton
from reference_data.solvers.paper4.methods import states as wrinkled
from reference_data.solvers.paper5 import bloch, tables_surface
from reference_data.solvers.paper5.hemisphere import collocation as hemisphere
from reference_data.solvers.paper5.hemisphere import differences as hemisphere_fd
from reference_data.solvers.paper5.hemisphere import shooting as hemisphere_shooting
from reference_data.solvers.paper5.hemisphere import states as hemisphere_states
from reference_data.solvers.paper5.waves import koiter
from reference_data.solvers.paper5.waves.bending import Bent
from reference_data.solvers.paper5.waves.cylinder import FLUID

# -- tubes that hold a liquid ----------------------------------------------------------------------


@pytest.mark.parametrize("step", [*AWAY, None])
def test_collocation_of_the_liquid_tube(step):
    def correction(*_):
        if step is None:
            raise np.linalg.LinAlgError
        return np.full(2, step), np.zeros(1)

    given = SimpleNamespace(step=correction), np.zeros(2), np.zeros(1), "V = 20"
    refused("^collocation: no convergence for V = 20$", liquid.System.newton, *given)


@pytest.mark.parametrize("step", AWAY)
def test_galerkins_method(step, monkeypatch):
    guess = Held(x=np.zeros((4, 2)), tube=SimpleNamespace(gamma=0.1), volume=always(20.0))
    monkeypatch.setattr(Held, "surface_radius", 1.0, raising=False)
    matrices = SimpleNamespace(stiffness=np.eye(4), volume=np.ones(4))
    monkeypatch.setattr(galerkin, "Matrices", always(matrices))
    monkeypatch.setattr(galerkin, "residual", always(np.full(4, step)))
    monkeypatch.setattr(galerkin, "fitted", lambda shape: (shape, 1.0))
    refused("^Galerkin: no convergence at V = 25 for ", galerkin.solve, guess, 25.0)


def test_zeros_of_waves_that_galerkins_method_does_not_find(monkeypatch):
    state = Held(volume=20.0)
    monkeypatch.setattr(modes.path, "galerkin", always(Held()))
    monkeypatch.setattr(modes.gal, "solve", lambda _near, volume: volume)
    monkeypatch.setattr(
        modes, "galerkin_mode", lambda volume, _: (np.sign(volume - 20.3) + 1e-3 * volume, None)
    )
    refused("^Galerkin: no zero of n = 1 near V = 20 of Tube", modes.galerkin_critical, state, None, 1)


def test_liquid_tubes_that_are_neither_filled_nor_over_filled(monkeypatch):
    how = SimpleNamespace(partial="partial", full="full")
    liquid_tube = SimpleNamespace(L=8.0, length=4.0)

    class State(Held):
        mesh, partial, moved_to = "partial", True, lambda self, *_: self

    monkeypatch.setattr(path, "_filled", always(None))
    low = State(tube=liquid_tube, zw=7.0, front=5.0)
    monkeypatch.setattr(path, "solve", always(low))
    words = "^collocation: neither filled nor over-filled at V = 20$"
    refused(words, path.at_volume, low, 20.0, how)

    class Full(State):
        mesh, partial = "full", False

    low = Full(tube=liquid_tube, zw=7.0, front=5.0, y=np.ones((1, 1, 4)))
    monkeypatch.setattr(path, "solve", always(low))
    refused(words, path.at_volume, low, 20.0, how)


@pytest.mark.parametrize(("r", "l1", "z"), [(-0.1, 1.0, 1.0), (1.0, -0.1, 1.0), (1.0, 1.0, 9.0)])
def test_states_of_the_liquid_tube_that_are_no_tube(r, l1, z):
    mesh = SimpleNamespace(dampness=np.ones((1, 1)))
    make = lambda *y: SimpleNamespace(y=np.array([[y]]), mesh=mesh, zw=5.0, volume=20.0, tube=TUBE)  # noqa: E731
    good = make(1.0, 2.0, 1.0, 0.0)
    assert path.checked(good) is good
    words = "^collocation: no admissible state at V = 20 of Tube"
    refused(words, path.checked, make(r, z, l1, 0.0))


def test_coincidences_that_are_not_found(monkeypatch):
    near = {
        n: SimpleNamespace(tube=FluidTube(8, 2), mesh=SimpleNamespace(degree=3), volume=20.0) for n in (0, 1)
    }
    how = SimpleNamespace(partial=SimpleNamespace(degree=3))
    turns = iter(range(10**6))
    volumes = lambda *_: {0: SimpleNamespace(volume=0.0), 1: SimpleNamespace(volume=np.cos(next(turns) ** 2))}  # noqa: E731
    monkeypatch.setattr(liquid_tables, "_volumes", volumes)
    refused("^collocation: no coincidence near ", liquid_tables._by_collocation, near, how)
    monkeypatch.setattr(liquid_tables.path, "galerkin", always(near[0]))
    near[0].front = 1.0
    monkeypatch.setattr(liquid_tables, "replace", always(near[0].tube))
    monkeypatch.setattr(liquid_tables.gal, "solve", always(None))
    noise = np.random.default_rng(1)
    monkeypatch.setattr(liquid_tables.modes, "galerkin_mode", lambda *_: (noise.random(), None))
    refused("^Galerkin: no coincidence near ", liquid_tables._by_galerkin, near[0], how)


# -- bent tubes ------------------------------------------------------------------------------------


@pytest.mark.parametrize("offset", [None, 0.1])
@pytest.mark.parametrize("step", AWAY)
def test_bent_tubes(step, offset, monkeypatch):
    guess = Held(tube=SimpleNamespace(gamma=0.1, L=8), x=np.zeros((2, 1)))
    now = SimpleNamespace(
        stiffness=None, functions=None, residual=np.zeros((2, 1)), volume=np.zeros((2, 1)),
        offset=np.ones((2, 1)),
    )  # fmt: skip
    monkeypatch.setattr(bent, "Assembly", always(now))
    monkeypatch.setattr(bent, "Factor", always(SimpleNamespace(solve=lambda b: np.full(b.shape, step))))
    monkeypatch.setattr(bent, "fitted", lambda surface: (surface, 0.0))
    refused("^surface: no convergence at z_w = 1 for ", bent.newton, guess, offset)
    now = SimpleNamespace(
        matrix=None, unknowns=None, residual=np.zeros((2, 1)), by_level=np.zeros((2, 1)), keep=None
    )
    monkeypatch.setattr(strong, "Balance", always(now))
    monkeypatch.setattr(strong, "Factor", always(SimpleNamespace(solve=lambda b: np.full(b.shape, step))))
    monkeypatch.setattr(strong, "spread_out", lambda _bent, values, _keep: values)
    monkeypatch.setattr(strong, "centroid", always(np.ones(2)))
    monkeypatch.setattr(strong, "fitted", lambda bent: (bent, 0.0))
    words = "^collocation of the bent tube: no convergence at z_w = 1 for "
    refused(words, strong.newton, guess, offset)


def test_spectra_of_bent_tubes(monkeypatch):
    def singular(*_, **__):
        raise np.linalg.LinAlgError

    monkeypatch.setattr(bent_states, "Factor", singular)
    assembly = SimpleNamespace(functions=None, stiffness=0.0, mass=0.0)
    monkeypatch.setattr(bent_states, "Assembly", always(assembly))
    elements = SimpleNamespace(joined=None, count=1, degree=2)
    surface = SimpleNamespace(grid=SimpleNamespace(elements=elements), tube=TUBE)
    refused("^surface: no shift below the spectrum of Tube", bent_states.Pencil, surface, (0,), -0.1)


def test_a_branch_of_bent_tubes_that_is_lost(monkeypatch):
    run = bent_branch.Secondary.__new__(bent_branch.Secondary)
    run.level, run._ahead = 0, always(None)
    run.states = [SimpleNamespace(zw=5.0, tube=SimpleNamespace(L=8.0), partial=True, x=0.1)]
    monkeypatch.setattr(bent_branch, "offset_of", always(0.1))
    monkeypatch.setattr(bent_branch, "on_grid_for", always(None))
    monkeypatch.setattr(
        bent_branch, "newton", always(SimpleNamespace(zw=5.5, tube=SimpleNamespace(L=8.0), partial=True))
    )
    refused("^surface: the level does not fall at offset 0.3$", run.to_level, 4.0, 0.2)
    rows = [{"zw": x, "V": x, "r_mid": x} for x in (0.1, 0.2, 0.3, 0.4)]
    words = "^r_mid has 0 stationary points where one was expected$"
    refused(words, bent_tables._top, np.array([0.1, 0.2, 0.3, 0.4]), rows)
    rows = [{"zw": x, "V": x, "r_mid": -((x - 0.26) ** 2)} for x in (0.1, 0.2, 0.3, 0.4)]
    bent_tables._top(np.array([0.1, 0.2, 0.3, 0.4]), rows)


# -- wrinkled membranes ----------------------------------------------------------------------------


@pytest.mark.parametrize("step", AWAY)
def test_collocation_of_wrinkled_tubes(step, monkeypatch):
    pattern = SimpleNamespace(breaks=(0.0, 8.0))
    pattern.moved = always(pattern)
    start = Held(pattern=pattern)
    system = SimpleNamespace(
        conditions=always((None, None)), defect=np.zeros(1), volume=1.0,
        solve=always((np.full(2, step), np.zeros(0), 0.0)),
    )  # fmt: skip
    monkeypatch.setattr(wrinkled, "Linearised", always(system))
    monkeypatch.setattr(wrinkled, "State", always(start))
    refused("^collocation: no convergence at V = 30 for Membrane", wrinkled.newton, start, "V", 30.0)
    monkeypatch.setattr(wrinkled, "newton", always((start, None)))
    monkeypatch.setattr(wrinkled, "mended", always(start))
    refused("^collocation: zones do not settle at V = 30, Membrane", wrinkled.polished, start, "V", 30.0)


@pytest.mark.parametrize("module", [wrinkled, hemisphere])
def test_a_zone_that_shrinks_to_nothing_is_named(module, monkeypatch):
    short = 0.1 * module.SHORTEST
    pattern = SimpleNamespace(breaks=(0.0, 1.0, 1.0 + short, 2.0), kinds=("front", "front"))
    moves = np.array([0.0, -1e3 * short])
    if module is wrinkled:
        system = SimpleNamespace(
            conditions=always((None, None)), defect=np.zeros(1), volume=1.0,
            solve=always((np.full(2, 0.1), moves, 0.0)),
        )  # fmt: skip
        monkeypatch.setattr(module, "Linearised", always(system))
        start = Held(pattern=pattern)
    else:
        monkeypatch.setattr(module, "linearised", always((np.eye(7), np.array([0.1] * 4 + [*moves, 0.0]))))
        start = Held(pattern=pattern, rule=SimpleNamespace(degree=1))
    refused("^zone 1 vanished$", module.newton, start, "zw", 1.0, error=module.VanishedZoneError)


@pytest.mark.parametrize("step", AWAY)
def test_other_methods_for_wrinkled_tubes(step, monkeypatch):
    guess = wrinkled_fd.unloaded(GAS, 8)
    monkeypatch.setattr(wrinkled_fd, "solve_banded", lambda _bands, _matrix, rhs: np.full(len(rhs), step))
    refused("^finite differences: no convergence at p = 0.1 for Membrane", wrinkled_fd.newton, guess, 0.1)
    monkeypatch.setattr(shooting_newton, "Shot", always(None))
    monkeypatch.setattr(shooting_newton, "matrix_of", always(np.eye(5)))
    monkeypatch.setattr(shooting_newton, "defects", always(np.full(5, step)))
    given = GAS, np.zeros((1, 4)), 0.1, "V", 30.0, 4
    refused("^shooting: no convergence at V = 30 for Membrane", shooting_newton.solve, *given)
    coarse = SimpleNamespace(membrane=GAS, starts=np.zeros((1, 4)), load=0.1, matrix=np.eye(5), control="V")
    words = "^shooting: no convergence with 8 steps for Membrane"
    refused(words, shooting_newton.refined, coarse, 30.0, 8)


def test_shots_that_meet_an_event_after_every_bit(monkeypatch):
    shot = wrinkled_shooting.Shot.__new__(wrinkled_shooting.Shot)
    vars(shot).update(membrane=GAS, h=1.0, advance=lambda _s, y, *_: y)
    shot.crossed, shot.event = lambda s, *_: np.ones(len(s), int), lambda *_: (1e-3, 1)
    one = np.zeros(1), np.zeros((1, 1, 5)), np.ones(1, bool), np.ones(1, bool), [], []
    refused("^shooting: too many events in one step for Membrane", shot.step, *one)


def test_points_of_wrinkled_tubes_that_are_not_there(monkeypatch):
    touch = SimpleNamespace(field="gw", near=2.0, membrane=GAS, maximum=True)
    assert events.pick([(1.9, 1.0, -1.0)], touch) == (1.9, 1.0)
    refused("^no stationary gw near Z = 2: Membrane", events.pick, [(1.9, 1.0, 1.0)], touch)
    noise = iter(np.cos(np.arange(99.0) ** 2))
    words = "^collocation: secant iteration did not converge$"
    refused(words, events.secant, lambda _: next(noise), 0.0, 1.0)
    assert events.secant(lambda x: x - 0.25, 0.0, 0.1) == pytest.approx((0.25, 1.0))
    monkeypatch.setattr(limits.sta, "from_grid", always(None))
    monkeypatch.setattr(limits, "grid_at", always(None))
    monkeypatch.setattr(limits.sta, "polished", always((None, SimpleNamespace(volume=1.0))))
    monkeypatch.setattr(limits, "rate", always(1.0))
    refused("^collocation: no limit load of Membrane", limits.climbed, GAS, 0.1, 0.5, 3)


# -- waves, hemispheres and polyhedra --------------------------------------------------------------


@pytest.mark.parametrize("step", AWAY)
def test_hemispheres(step, monkeypatch):
    pattern = SimpleNamespace(breaks=(0.0, 1.5), kinds=())
    pattern.moved = always(pattern)
    start = Held(pattern=pattern, rule=SimpleNamespace(degree=1), y=np.zeros((1, 2, 4)))
    b = np.full(9, step)
    monkeypatch.setattr(hemisphere, "linearised", always((np.eye(9), b)))
    refused("^hemisphere: no convergence at zw = -0.7$", hemisphere.newton, start, "zw", -0.7)
    monkeypatch.setattr(hemisphere_states, "newton", always(start))
    monkeypatch.setattr(hemisphere_states, "mended", always(start))
    refused("^hemisphere: zones do not settle at zw = -0.7$", hemisphere_states.polished, start, "zw", -0.7)
    monkeypatch.setattr(hemisphere_fd, "residual", lambda y, *_: 1e-3 * np.ones_like(y) + y * step)
    words = "^hemisphere: differences do not converge at zw = -0.7$"
    monkeypatch.setattr(hemisphere_fd.np.linalg, "solve", always(np.full(8, step)))
    refused(words, hemisphere_fd.newton, np.zeros((4, 2)), -0.7, 1.0, max_iter=3)


def test_shots_over_the_hemisphere(monkeypatch):
    noise = np.random.default_rng(1)
    shots = lambda *_: ([], 1 + noise.random(2))  # noqa: E731
    monkeypatch.setattr(hemisphere_shooting, "shot", shots)
    words = "^hemisphere, shooting: no convergence at zw = -0.7$"
    refused(words, hemisphere_shooting.solve, 1.2, -1.0, "zw", -0.7, None)
    monkeypatch.undo()
    out = SimpleNamespace(success=False, message="the step is too small")
    monkeypatch.setattr(hemisphere_shooting, "solve_ivp", always(out))
    given = 1.2, -1.2, -0.7, hemisphere_shooting.TOLERANCES[0]
    refused("^hemisphere, shooting: the step is too small$", hemisphere_shooting.shot, *given)


@pytest.mark.parametrize("step", AWAY)
def test_polyhedra(step, monkeypatch):
    mesh = bloch.Polyhedron(FLUID, 4, 6)
    start = np.ones((5, 3))
    monkeypatch.setattr(bloch, "solve_banded", always(np.full(9, step)))
    refused("^polyhedron 4 x 6: no convergence at zw = 5$", bloch.newton, mesh, start, 5.0, 3)


def test_windows_without_a_change_of_stability(monkeypatch):
    unstable = [False]
    monkeypatch.setattr(tables_surface, "state", always(SimpleNamespace(unstable=lambda: unstable[0])))
    mesh = bloch.Polyhedron(FLUID, 4, 6)
    refused(r"^polyhedron .*: no unstable level in \(5.0, 6.0\)$", tables_surface.end, mesh, (5.0, 6.0), True)
    unstable[0] = True
    refused("^polyhedron .*: unstable already at 5$", tables_surface.end, mesh, (5.0, 6.0), True)


def test_stiffnesses_that_are_not_found():
    told = Bent(None)
    turns = iter(range(10**6))
    told.first = lambda *_: (-np.exp(np.cos(next(turns))), 1.0)
    refused("^bending: no beta found for n = 20$", told.needed, 20.0)
    told.needed = lambda n: n
    refused("^bending: no maximum of beta about n = 20$", told.critical, 20.0)


# -- tables ----------------------------------------------------------------------------------------


def test_critical_points_that_are_not_all_found(monkeypatch):
    tube = FluidTube(8, 2)
    monkeypatch.setattr(liquid_tables, "SEARCH", {tube: (131.0, (0, 1))})
    monkeypatch.setattr(liquid_tables, "critical", always({0: None}))
    refused(r"^table t: FluidTube.*: zeros of n = \[0\] only$", liquid_tables.points, "t")


def test_fronts_of_other_patterns(monkeypatch):
    monkeypatch.setattr(branches.cas, "solved", lambda _, load: SimpleNamespace(zones=f"zones {load:g}"))
    words = "^table t: patterns zones 1; zones 2$"
    refused(words, branches.fronts, "t", GAS, np.array([1.0, 2.0]), "")


def test_hermite_elements_on_a_taut_state():
    taut = SimpleNamespace(state=SimpleNamespace(tense=np.array([False, True])))
    refused("^Hermite elements: the state is not wholly wrinkled$", koiter.hermitian, taut, 20.0, 0.0, 10)
