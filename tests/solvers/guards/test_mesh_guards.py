"""If meshes disagree on whether a state or branch exists, no number of it is returned."""

from contextlib import nullcontext
from types import SimpleNamespace

import numpy as np
import pytest
from stand_ins import bare, refused

from weakforms.errors import ConvergenceError, InputError
from weakforms.problems.liquid_tube import problem as fluid_tube_problem
from weakforms.problems.liquid_tube.bent.family import SecondaryFamily
from weakforms.problems.liquid_tube.problem import FluidTubeNumerics, FluidTubeParameters
from weakforms.problems.triangles import problem as surface
from weakforms.problems.wrinkled import readings as wrinkled_readings
from weakforms.problems.wrinkled.readings import Readings
from weakforms.results import Branch, Quantity, State
from weakforms.solvers.continuation.pieces import Piece, PiecewiseFamily
from weakforms.solvers.stability.modal import ModalFamily
from weakforms.solvers.uncertainty import family
from weakforms.solvers.uncertainty.family import BranchFamily

ANY = SimpleNamespace(state=SimpleNamespace(u=None, loads=None))
"""A state that only stands for one."""


@pytest.mark.parametrize("counts", [(0, 1, 1), (0, 0, 1), (1, 0, 0)])
def test_a_branch_whose_states_are_stable_on_some_meshes_only(counts, monkeypatch):
    monkeypatch.setattr(
        family, "_spectrum", lambda level, *_: SimpleNamespace(n_negative=level, eigenvalues=[1.0])
    )
    told = bare(BranchFamily, levels=list(counts))
    refused("stability depends on the mesh: negative counts", told._diagnostics, [ANY] * 3, 0.0)
    told.levels, told._quantity = [1, 1, 1], lambda *_: Quantity(1.0)
    assert told._diagnostics([ANY] * 3, 0.0)["n_negative"].value == 1


def branch(*kinds, n=None):
    points = [SimpleNamespace(kind=kind, values={} if n is None else {"n": n}) for kind in kinds]
    return SimpleNamespace(special=lambda: points, tell_apart=lambda: False)


def test_special_points_that_only_some_meshes_have():
    two, one = branch("limit_point", "cusp_point"), branch("limit_point")
    for levels in ([two, two, one], [one, two, two], [branch("cusp_point"), one, one]):
        refused("special points depend on the mesh", bare(BranchFamily, levels=levels)._locate)
    assert len(bare(BranchFamily, levels=[two, two])._locate()) == 2


def test_bifurcations_in_another_order():
    levels = [branch("bifurcation_point", n=1.0), branch("bifurcation_point", n=2.0)]
    refused("order of the bifurcation points", bare(ModalFamily, levels=levels)._locate)
    assert len(bare(ModalFamily, levels=levels[:1] * 2)._locate()) == 1


def modal(*eigenvalues):
    spectrum = SimpleNamespace(eigenvalues=eigenvalues)
    return SimpleNamespace(
        system=SimpleNamespace(at=lambda _: nullcontext()),
        modes=SimpleNamespace(variation=lambda _: SimpleNamespace(spectrum=lambda _: spectrum)),
    )


def test_symmetric_states_that_are_stable_on_some_meshes_only():
    levels = [modal(-0.1, 0.2), modal(1e-9, 0.2)]
    told = bare(ModalFamily, levels=levels)
    refused("stability depends on the mesh", told._diagnostics, [ANY] * 2, 1e-6)
    told.levels = [modal(-0.1, 0.2), modal(-0.2, 0.3)]
    assert told._diagnostics([ANY] * 2, 1e-6) == {"n_negative": Quantity(1)}


def bent(**counts):
    stability = SimpleNamespace(
        spectra=lambda *_: {name: float(value) for name, value in counts.items()}, lowest=lambda *_: -2.0
    )
    solver = SimpleNamespace(factor=SimpleNamespace(release=lambda: None))
    return SimpleNamespace(stability=stability, solver=solver)


@pytest.mark.parametrize("name", ["n_negative", "n_negative_odd"])
def test_bent_states_whose_two_finest_meshes_count_differently(name):
    told = bare(SecondaryFamily, levels=[bent(**{name: k}) for k in (1, 1, 2)])
    told._lowest = lambda _: {"T_min": Quantity(1.0, 0.0)}
    refused(f"stability depends on the mesh: {name}", told._diagnostics, [ANY] * 3, 0.0)
    told.levels = [bent(**{name: k}) for k in (1, 2, 2)]  # the coarsest one is there for the order only
    assert told._diagnostics([ANY] * 3, 0.0)[name].value == 2


@pytest.mark.parametrize(("least", "spread"), [(-1e-4, 2e-3), (1e-4, 2e-3), (-1e-2, 1e-3)])
def test_bent_states_that_may_be_compressed_have_their_lowest_eigenvalue_only(least, spread):
    """Wrinkles as fine as the mesh: their number depends on it, as it must not of a taut tube."""
    told = bare(SecondaryFamily, levels=[bent(n_negative=k) for k in (1, 2, 9)], caps={}, cap=4.0, slow=None)
    told.warnings = []
    told._lowest = lambda _: {"T_min": Quantity(least, spread)}
    state = SimpleNamespace(state=ANY, values={"zw": 7.9})
    found = told._diagnostics([state] * 3, 0.0)
    assert found["Lambda_1"].value == -2.0
    assert "n_negative" not in found
    assert ["zw = 7.9" in warning for warning in told.warnings] == [True]
    told._lowest = lambda _: {"T_min": Quantity(abs(least), abs(least) / 2)}
    refused("stability depends on the mesh", told._diagnostics, [state] * 3, 0.0)


def test_wrinkled_states_that_are_stable_on_some_meshes_only(monkeypatch):
    def held(count):
        return SimpleNamespace(state=None, model=SimpleNamespace(system=count))

    def spectrum_of(count, _state, _shift):
        return SimpleNamespace(n_negative=count, eigenvalues=[1.0])

    monkeypatch.setattr(wrinkled_readings, "spectrum_of", spectrum_of)
    monkeypatch.setattr(Readings, "quantity", lambda *_: Quantity(1.0))
    told = bare(Readings)
    refused("stability depends on the mesh", told._spectrum, [held(0), held(1)], 0.0)
    assert told._spectrum([held(1), held(1)], 0.0)["n_negative"].value == 1


def test_wrinkled_states_with_more_fronts_on_some_meshes():
    told = bare(Readings, columns=lambda held: dict.fromkeys(held, 1.0))
    refused("the number of fronts depends on the mesh", told.quantities, [("p",), ("p", "Z_front_1")], 0.0)


def test_pieces_of_the_primary_branch_that_only_some_meshes_have(monkeypatch):
    pieces = iter(([1, 2, 3], [1, 2, 3], [1, 2]))
    monkeypatch.setattr(fluid_tube_problem, "FluidPath", lambda *_: SimpleNamespace(pieces=next(pieces)))
    given = FluidTubeParameters(), FluidTubeNumerics(), None, lambda *_: None
    refused("the parts of the primary branch depend on the mesh", fluid_tube_problem.primary_family, *given)


def part(name, values, **fixed):
    """A part of a branch: where its column has a value, and the state there."""
    columns = {"u": np.array(values)}
    crossings = lambda _name, x: np.flatnonzero(np.diff(np.sign(columns["u"] - x)))  # noqa: E731
    family = SimpleNamespace(
        name="primary",
        failures=[],
        branch=lambda _: Branch("primary", "p", {**columns, "front": columns["u"]}, {}),
        special_points=list,
        fine=SimpleNamespace(columns=lambda: columns, crossings=crossings, over_points=columns.get),
        state=lambda wanted, value, crossing, _: State(
            {wanted: value}, name, {"front": Quantity(9.0), "own": Quantity(crossing)}, (), crossing
        ),
    )
    return Piece(family, fixed)


def test_pieces_are_one_branch_and_count_crossings_together():
    """Up, down and up again past u = 1.5: once in the first part, twice in the second."""
    whole = PiecewiseFamily([part("a", [0.0, 1.0, 2.0], front=7.0), part("b", [2.0, 1.0, 2.0])])
    branch = whole.branch(with_uncertainty=False)
    assert branch.columns["u"].tolist() == [0.0, 1.0, 2.0, 2.0, 1.0, 2.0]
    assert branch.columns["front"].tolist() == [7.0, 7.0, 7.0, 2.0, 1.0, 2.0]
    found = [whole.state("u", 1.5, crossing) for crossing in (1, 2, 3)]
    assert [(s.branch, s.crossing) for s in found] == [("a", 1), ("b", 2), ("b", 3)]
    assert [s.quantities["own"].value for s in found] == [1, 1, 2]
    assert [s.quantities["front"].value for s in found] == [7.0, 9.0, 9.0]
    with pytest.raises(InputError, match=r"not taken 4 times on this branch; u ranges over \[0, 2\]"):
        whole.state("u", 1.5, 4)


# -- walks that stop short -------------------------------------------------------------------------


class Walk:
    """A trace of triangles that does not get beyond a load."""

    control = "zw"
    first = 1.0

    def __init__(self, last, without=(), limit=None):
        self.last, self.without, self.limit = last, without, limit

    def is_beyond(self, load):
        """Whether a load lies beyond the limit load, once that is known."""
        return self.limit is not None and load > self.limit

    def turn(self, _load):
        """The limit load, if there is one."""
        return self.limit

    def at(self, load):
        """The state at a load."""
        if load > self.last:
            raise ConvergenceError("Newton stalled")
        return SimpleNamespace(load=load)

    def columns(self, point, _count):
        """Its columns."""
        if point.load in self.without:
            raise ConvergenceError("no eigenvalues")
        return {"zw": point.load, "n_negative": 0, "iterations": 3}


def test_a_walk_that_stops_short_is_reported():
    result = SimpleNamespace(failures=[], absent=[])
    reached = surface._walk(Walk(2.0), np.arange(1.0, 5.0), result, lambda *_: None)
    assert [point.load for point in reached] == [1.0, 2.0]
    (failure,) = result.failures
    assert failure.what == "branch primary, from zw = 3"
    assert failure.reason.startswith("Newton stalled; choose load_start and load_end up to 2, where")
    refused("Newton stalled", surface._walk, Walk(0.0), np.array([1.0]), result, lambda *_: None)


def test_a_point_without_eigenvalues_is_reported_and_left_out():
    result = SimpleNamespace(failures=[], branches=[])
    points = [SimpleNamespace(load=load) for load in (1.0, 2.0, 3.0)]
    numerics = SimpleNamespace(shown=1, eigenvalues=3)
    surface._branch(Walk(9.0, without=(2.0,)), points, numerics, result, lambda *_: None)
    assert result.branches[0].columns["zw"].tolist() == [1.0, 3.0]
    assert [(f.what, f.reason) for f in result.failures] == [("eigenvalues at zw = 2", "no eigenvalues")]
