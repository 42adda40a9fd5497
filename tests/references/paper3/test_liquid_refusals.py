"""No table of paper 3 is made of what did not converge: every iteration gives up with its words."""

from types import SimpleNamespace

import numpy as np
import pytest
from led_astray import AWAY, TUBE, StandIn, always, refused

from reference_data.solvers.paper3 import collocation as liquid
from reference_data.solvers.paper3 import galerkin, modes, path
from reference_data.solvers.paper3 import tables_critical as liquid_tables
from reference_data.solvers.paper3 import tables_secondary as bent_tables
from reference_data.solvers.paper3.bent import branch as bent_branch
from reference_data.solvers.paper3.bent import newton as bent
from reference_data.solvers.paper3.bent import states as bent_states
from reference_data.solvers.paper3.data import FluidTube
from reference_data.solvers.paper3.strong import equations as strong
from reference_data.solvers.paper3.strong import states as strong_states

LOST = ": Newton's method does not converge$"

# -- tubes that hold a liquid ----------------------------------------------------------------------


def test_collocation_of_the_liquid_tube():
    mesh = liquid.Mesh.filled(2, 1, 3)
    lost = liquid.State(FluidTube(8, 2), mesh, np.full((3, 4, 5), np.nan), 1.0, 1.0)
    refused(f"^collocation of FluidTube.* at V = 20{LOST}", liquid.solve, lost, 20.0)


@pytest.mark.parametrize("step", AWAY)
def test_galerkins_method(step, monkeypatch):
    guess = StandIn(x=np.zeros((4, 2)), tube=SimpleNamespace(gamma=0.1), volume=always(20.0))
    monkeypatch.setattr(StandIn, "surface_radius", 1.0, raising=False)
    matrices = SimpleNamespace(stiffness=np.eye(4), volume=np.ones(4))
    monkeypatch.setattr(galerkin, "Matrices", always(matrices))
    monkeypatch.setattr(galerkin, "residual", always(np.full(4, step)))
    monkeypatch.setattr(galerkin, "fitted", lambda shape: (shape, 1.0))
    refused(f"^Galerkin's method for .* at V = 25{LOST}", galerkin.solve, guess, 25.0)


def test_zeros_of_waves_that_galerkins_method_does_not_find(monkeypatch):
    state, noise = StandIn(volume=20.0), np.random.default_rng(1)
    monkeypatch.setattr(modes.path, "galerkin", always(StandIn()))
    monkeypatch.setattr(modes.gal, "solve", lambda _near, volume: volume)
    monkeypatch.setattr(modes, "galerkin_mode", lambda *_: (0.1 + noise.random(), None))
    words = "^Galerkin: zero of n = 1 near V = 20 of Tube.*: no root near "
    refused(words, modes.galerkin_critical, state, None, 1)


def test_liquid_tubes_that_are_neither_filled_nor_over_filled(monkeypatch):
    how = SimpleNamespace(partial="partial", full="full")
    liquid_tube = SimpleNamespace(L=8.0, length=4.0)

    class State(StandIn):
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
    refused("^the secant iteration does not converge$", liquid_tables._by_collocation, near, how)
    monkeypatch.setattr(liquid_tables.path, "galerkin", always(near[0]))
    near[0].front = 1.0
    monkeypatch.setattr(liquid_tables, "replace", always(near[0].tube))
    monkeypatch.setattr(liquid_tables.gal, "solve", always(None))
    noise = np.random.default_rng(1)
    monkeypatch.setattr(liquid_tables.modes, "galerkin_mode", lambda *_: (noise.random(), None))
    words = "^Galerkin: coincidence near .*: no root near "
    refused(words, liquid_tables._by_galerkin, near[0], how)


# -- bent tubes ------------------------------------------------------------------------------------


@pytest.mark.parametrize("offset", [None, 0.1])
@pytest.mark.parametrize("step", AWAY)
def test_bent_tubes(step, offset, monkeypatch):
    guess = StandIn(tube=SimpleNamespace(gamma=0.1, L=8), x=np.zeros((2, 1)))
    now = SimpleNamespace(
        stiffness=None, functions=None, residual=np.zeros((2, 1)), volume=np.zeros((2, 1)),
        offset=np.ones((2, 1)),
    )  # fmt: skip
    monkeypatch.setattr(bent, "Assembly", always(now))
    monkeypatch.setattr(bent, "Factor", always(SimpleNamespace(solve=lambda b: np.full(b.shape, step))))
    monkeypatch.setattr(bent, "fitted", lambda surface: (surface, 0.0))
    refused(f"^bent tube by Galerkin's method at z_w = 1 for .*{LOST}", bent.newton, guess, offset)
    now = SimpleNamespace(
        matrix=None, unknowns=None, residual=np.zeros((2, 1)), by_level=np.zeros((2, 1)), keep=None
    )
    monkeypatch.setattr(strong, "Balance", always(now))
    monkeypatch.setattr(strong, "Factor", always(SimpleNamespace(solve=lambda b: np.full(b.shape, step))))
    monkeypatch.setattr(strong, "spread_out", lambda _bent, values, _keep: values)
    monkeypatch.setattr(strong, "centroid", always(np.ones(2)))
    monkeypatch.setattr(strong, "fitted", lambda bent: (bent, 0.0))
    words = f"^bent tube by collocation at z_w = 1 for .*{LOST}"
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


def test_complex_eigenvalues_of_the_balance_of_forces(monkeypatch):
    system = strong_states.Linearised.__new__(strong_states.Linearised)
    system.bent = SimpleNamespace(tube=SimpleNamespace(gamma=0.1))
    system.now = SimpleNamespace(mass=np.ones((6, 2)), by_level=np.ones((6, 2)))
    system.solved = lambda v: v
    monkeypatch.setattr(strong_states, "volume_gradient", always(np.ones((6, 2))))
    monkeypatch.setattr(strong_states, "surface_area", always(1.0))
    found = np.array([0.5 + 0.1j, 0.5 - 0.1j, *np.linspace(0.1, 0.4, 6)])
    monkeypatch.setattr(strong_states.sla, "eigs", always((found, np.ones((8, 8)))))
    refused("^collocation of the bent tube: complex eigenvalues ", system.lowest)


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
    passed = [SimpleNamespace(zw=x, partial=True, tube=SimpleNamespace(L=8.0)) for x in (7.5, 7.0)]
    run.start, run.states = SimpleNamespace(zw=8.0), passed
    run._ahead = always(SimpleNamespace())
    monkeypatch.setattr(bent_branch, "replace", always(None))
    offsets = iter([0.4, 0.6, 0.01])
    monkeypatch.setattr(bent_branch, "offset_of", lambda *_: next(offsets))
    refused("^surface: not on the secondary branch at z_w = 7.2$", run.at_level, 7.2)
    rows = [{"zw": x, "V": x, "r_mid": x} for x in (0.1, 0.2, 0.3, 0.4)]
    words = "^r_mid has 0 stationary points where one was expected$"
    refused(words, bent_tables._top, np.array([0.1, 0.2, 0.3, 0.4]), rows)
    rows = [{"zw": x, "V": x, "r_mid": -((x - 0.26) ** 2)} for x in (0.1, 0.2, 0.3, 0.4)]
    bent_tables._top(np.array([0.1, 0.2, 0.3, 0.4]), rows)


def test_critical_points_that_are_not_all_found(monkeypatch):
    tube = FluidTube(8, 2)
    monkeypatch.setattr(liquid_tables, "SEARCH", {tube: (131.0, (0, 1))})
    monkeypatch.setattr(liquid_tables, "critical", always({0: None}))
    refused(r"^table t: FluidTube.*: zeros of n = \[0\] only$", liquid_tables.points, "t")
