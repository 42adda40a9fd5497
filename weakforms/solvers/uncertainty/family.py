"""The same branch on a family of meshes: numbers with their uncertainties."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import ClassVar

import numpy as np

from weakforms.errors import ConvergenceError, InputError
from weakforms.results import Absence, Branch, Failure, Field, Quantity, SpecialPoint, State
from weakforms.results.model import COUNTS, KINDS
from weakforms.solvers.continuation.continuation import CurvePoint
from weakforms.solvers.continuation.curve import DIAGNOSTICS, SolutionCurve, Solved
from weakforms.solvers.stability.agreement import same_count
from weakforms.solvers.stability.spectra import Spectrum, spectrum_of
from weakforms.solvers.support.provenance import quadrature_degree
from weakforms.solvers.support.sampling import Sampler
from weakforms.solvers.uncertainty.points import point_of
from weakforms.solvers.uncertainty.refinement import (
    Slow,
    doubt,
    estimate,
    estimate_in_norm,
    order_in_mean,
    widened,
)

NOT_LOCATED = ("contact_onset", "front", "stability_change", "zone_opening", "zone_closing")
"""Kinds of special points that are found by other means."""

LOCATED = tuple(kind for kind in KINDS if kind not in NOT_LOCATED)
"""Kinds of special points that are located on a curve; a state can be requested at one."""

CRITICAL = 1e-6
"""An eigenvalue below this magnitude at a special point is the zero eigenvalue of that point."""

SAMPLED = 1.5
"""Factor for columns of a profile, because differences depend on where points lie in their cells."""

PLACES = 101
"""Number of places on a meridian at which the orders of its fields are observed."""

Compared = tuple[Sequence[Mapping[str, float]], Mapping[str, float]]
"""A point of a branch: its columns on every mesh, coarse to fine, and on the finest one with diagnostics."""


class BranchFamily:
    """A branch that is traced on several meshes from coarse to fine.

    Every number comes from the finest mesh; the other meshes give its uncertainty.

    Args:
        make: Builds the branch on the mesh of a level.
        levels: Number of meshes, at least two.
        cap: Highest order of convergence that is assumed ...
        across: Columns of the plane in which branches of two meshes are compared.
        caps: ... and a lower one for some columns (one-sided limits of derivatives).
        points_of: Columns that are values of a profile's column at a point; their observed order may be
            accidental, because the point moves through the cells or a difference changes its sign.
        slow: A part of all errors that converges more slowly.
        name: Name of the branch.
    """

    traced_on_finest = True
    """Whether the points of the branch are those of the finest mesh's trace; else of the coarsest one's."""

    judges_points = True
    """Whether stability is also computed for a state without a profile."""

    located_by: ClassVar[Mapping[str, str]] = {}
    """Kinds of special points that are extrema of a column; there all columns have the error order of that
    column."""

    least: ClassVar[Mapping[str, float]] = {}
    """Smallest orders of quantities; a lower observed order is accidental."""

    progress: Callable[[str, int, int], None] = staticmethod(lambda _what, _done, _total: None)
    """Called for each point of the trace by :meth:`branch`: what is done, the point's number, of how many."""

    def __init__(
        self,
        make: Callable[[int], SolutionCurve],
        levels: int,
        cap: float,
        across: tuple[str, ...],
        name: str = "primary",
        caps: Mapping[str, float] | None = None,
        points_of: Mapping[str, str] | None = None,
        slow: Slow | None = None,
    ) -> None:
        self.caps = dict(caps or {})
        self.points_of = dict(points_of or {})
        self.slow = slow
        self.levels = [make(level) for level in range(levels)]
        self.fine = self.levels[-1]
        self.cap, self.across, self.name = cap, across, name
        self.failures: list[Failure] = []
        self.warnings: list[str] = []
        ended = (self.fine if self.traced_on_finest else self.levels[0]).ended
        self.absent: list[Absence] = [Absence(f"rest of branch {name}", ended)] if ended else []
        self._located: list[tuple[Solved, ...]] | None = None
        self._samplers: dict[tuple[int, bytes], Sampler] = {}
        stalled = [level.stalled for level in self.levels if level.stalled]
        if stalled:
            self.failures.append(Failure(f"branch {name}", stalled[-1]))

    @property
    def quadrature_degree(self) -> int:
        """Quadrature degree of the residual."""
        return quadrature_degree(self.fine.system.formulation.residual)

    def branch(self, with_uncertainty: bool = True) -> Branch:
        """All columns, with uncertainties if requested.

        A point that cannot be compared with the other meshes is left out and listed as a failure.

        Raises:
            ConvergenceError: If no point can be compared.
        """
        names, control = self.fine.shown, self.fine.control
        if not with_uncertainty and self.traced_on_finest:
            return Branch(self.name, control, self._trace())
        kept, missed, places = [], [], []
        for i, compared in enumerate(points := list(self._comparisons())):
            self.progress(f"uncertainty of the {self.name} branch", i, len(points))
            try:
                kept.append(compared())
                places.append(i)
            except ConvergenceError as error:
                missed.append((i, str(error)))
        if missed:
            left_out = f"points {missed[0][0]} to {missed[-1][0]}, {len(missed)} of them left out"
            self.failures.append(Failure(f"branch {self.name}, {left_out}", missed[0][1]))
        if not kept:
            raise ConvergenceError(f"branch {self.name}: no point could be solved for on all meshes")
        columns = {name: np.array([row[name] for _, row in kept]) for name in kept[0][1]}
        if not with_uncertainty:
            return Branch(self.name, control, columns)
        table = np.array([[[values[n] for n in names] for values in levels] for levels, _ in kept])
        caps = np.array([[*self._caps_at(levels[-1], *self.across).values()] for levels, _ in kept])
        found = estimate([table[:, k] for k in range(table.shape[1])], caps, slow=self.slow).uncertainty
        spread = widened(found) if self.traced_on_finest else found
        uncertainty = dict(zip(names, spread.T, strict=True))
        for row, i in enumerate(places):
            for name, more in self.left_by_round_off(i).items():
                uncertainty[name][row] += more
        return Branch(self.name, control, columns, uncertainty)

    def left_by_round_off(self, _index: int) -> Mapping[str, float]:
        """What round-off adds to the uncertainty of columns at a point of the trace; usually nothing."""
        return {}

    def _trace(self) -> dict[str, np.ndarray]:
        """Columns of the finest mesh's trace."""
        return {n: v for n, v in self.fine.columns().items() if n in (*self.fine.shown, *DIAGNOSTICS)}

    def _comparisons(self) -> Iterator[Callable[[], Compared]]:
        """For each point of the branch a function that solves for it on all meshes."""
        columns, total = self._trace(), self.fine.points[-1].arclength or 1.0
        for i, point in enumerate(self.fine.points):
            row = {name: values[i] for name, values in columns.items()}
            yield partial(self._compared, point, point.arclength / total, row)

    def _compared(self, point: CurvePoint, near: float, row: dict[str, float]) -> Compared:
        rates = self.fine.direction(point, self.across)
        others = [level.at_position(point, rates, near).values for level in self.levels[:-1]]
        return [*others, row], row

    # -- points ------------------------------------------------------------------------------

    def special_points(self) -> list[SpecialPoint]:
        """Special points that are located on every mesh; all meshes must agree on their kinds and order.

        Raises:
            ConvergenceError: If they do not.
        """
        return [self._special_point(same) for same in self._special()]

    def _special_point(self, same: Sequence[Solved]) -> SpecialPoint:
        """One special point; if a column locates it, no error has twice its fields' order (``doubt``)."""
        orders = self._orders_in_mean(same)
        held = self.located_by.get(same[-1].kind, "")
        columns = self._columns(same, held, orders)
        found = columns if held else self._widened_if_unresolved(columns, orders)
        return point_of(same[-1].kind, self.name, self.fine.control, found)

    def _special(self) -> list[tuple[Solved, ...]]:
        """Each special point on all meshes; they are located once."""
        if self._located is None:
            self._located = self._locate()
        return self._located

    def _locate(self) -> list[tuple[Solved, ...]]:
        if self.levels[0].tell_apart():  # on the coarsest mesh, which is cheap
            for level in self.levels[1:]:
                level.tell_apart()
        found = self._found()
        kinds = [[solved.kind for solved in item] for item in found]
        if any(item != kinds[-1] for item in kinds):
            counts = [dict(Counter(item)) for item in kinds]
            raise ConvergenceError(f"special points depend on the mesh, coarse to fine: {counts}")
        return list(zip(*found, strict=True))

    def _found(self) -> list[list[Solved]]:
        return [level.special() for level in self.levels]

    def state(self, name: str, value: float, crossing: int = 1, profile: np.ndarray | None = None) -> State:
        """Solve for the state at which a column has exactly a value, with its profile if points are given.

        If the name is a kind of special point, this is the state at the ``value``-th of them.

        Raises:
            InputError: If the branch has no such state.
        """
        special = name in LOCATED
        if special:
            points = [same for same in self._special() if same[-1].kind == name]
            if not 1 <= value <= len(points):
                number = f"only {len(points)}" if points else "none"
                raise InputError(f"{name} = {value:g}: this branch has {number}")
            solved = points[int(value) - 1]
        else:
            solved = self._at(name, value, crossing)
        orders = self._orders_in_mean(solved)
        held = self.located_by.get(name, "") if special else name
        quantities = self._columns(solved, held, orders)
        if profile is not None or self.judges_points:
            zero = name in self.fine.computed and abs(value) < CRITICAL
            quantities |= self._diagnostics(solved, CRITICAL if special or zero else 0.0)
        quantities = self._widened_if_unresolved(quantities, orders)
        fields = () if profile is None else (self._profile(solved, profile),)
        return State({name: value}, self.name, quantities, fields, crossing)

    def _columns(
        self, solved: Sequence[Solved], held: str, orders: Mapping[str, float]
    ) -> dict[str, Quantity]:
        """The finest mesh's columns with uncertainties; an error of the column ``held`` is in all of them."""
        most = self.smooth_order(solved[-1].values)
        in_mean = {name: orders.get(self.points_of.get(name, ""), 0.0) for name in self.fine.shown}
        return {
            name: self._quantity([s.values[name] for s in solved], name, held, in_mean[name], most)
            for name in self.fine.shown
        }

    def _widened_if_unresolved(
        self, quantities: dict[str, Quantity], orders: Mapping[str, float]
    ) -> dict[str, Quantity]:
        """The same with larger uncertainties, if the coarse meshes do not resolve the state's fields."""
        element = self.fine.system.unknown.function_space.ufl_element()
        wider = doubt(orders.values(), element.embedded_superdegree + 1)
        return {
            name: replace(q, uncertainty=wider * q.uncertainty) if q.uncertainty else q
            for name, q in quantities.items()
        }

    def _at(self, name: str, value: float, crossing: int) -> list[Solved]:
        """The state on every mesh, coarse to fine."""
        return [level.at(name, value, crossing) for level in self.levels]

    def _diagnostics(self, solved: Sequence[Solved], critical: float) -> dict[str, Quantity]:
        """Lowest eigenvalue and number of negative ones, by SLEPc and by inertia.

        At a special point the critical eigenvalue is zero up to round-off and does not count as negative.
        """
        spectra = [_spectrum(level, s, critical) for level, s in zip(self.levels, solved, strict=True)]
        return {
            "n_negative": Quantity(same_count(spectrum.n_negative for spectrum in spectra)),
            "eigenvalue_1": self._quantity([s.eigenvalues[0] for s in spectra], "eigenvalue_1"),
        }

    def _profile(self, solved: Sequence[Solved], points: np.ndarray) -> Field:
        samples = []
        for k, (level, s) in enumerate(zip(self.levels, solved, strict=True)):
            locate = level.system.formulation.locate
            places = points if locate is None else locate(points, s.state.loads)
            samples.append(self._sample(k, s, places))
        abscissa = self.fine.system.formulation.abscissa
        columns: dict[str, np.ndarray] = {abscissa: points}
        uncertainty = {abscissa: 0.0}
        order = min(self.cap, self.cap / 2 + 1)  # at any point of a cell: the degree plus one
        for name in samples[-1]:
            cap = min(order, self.caps.get(name, order))
            columns[name] = samples[-1][name]
            uncertainty[name] = SAMPLED * estimate_in_norm(
                [sample[name] for sample in samples], cap, slow=self.slow
            )
        return Field("profile", columns, uncertainty)

    def _orders_in_mean(self, solved: Sequence[Solved]) -> dict[str, float]:
        """Orders of the profile's columns over the whole meridian, independent of the requested points."""
        mesh = self.fine.system.unknown.function_space.mesh
        if mesh.topology.dim > 1 or len(solved) < 3:
            return {}
        ends = mesh.comm.allgather((mesh.geometry.x[:, 0].min(), mesh.geometry.x[:, 0].max()))
        places = np.linspace(np.min(ends), np.max(ends), PLACES)
        samples = [self._sample(k, s, places) for k, s in enumerate(solved)]
        return {name: order_in_mean([sample[name] for sample in samples]) for name in samples[-1]}

    def _sample(self, k: int, solved: Solved, places: np.ndarray) -> dict[str, np.ndarray]:
        """Columns of the profile at given positions on one mesh."""
        system = self.levels[k].system
        with system.at(solved.state):
            return self._sampler(k, places)()

    def _sampler(self, k: int, points: np.ndarray) -> Sampler:
        """Sampler on one mesh; it is kept, because locating points costs more than evaluation."""
        key = (k, points.tobytes())
        if key not in self._samplers:
            formulation = self.levels[k].system.formulation
            self._samplers[key] = Sampler(formulation.unknown, formulation.profile, points)
        return self._samplers[key]

    # -- estimates ---------------------------------------------------------------------------

    def _cap(self, *names: str) -> float:
        """Highest assumed order for a number that contains the errors of some columns."""
        return min(self.caps.get(name, self.cap) for name in names)

    def smooth_order(self, _values: Mapping[str, float]) -> float:
        """Highest order of any number at a state: lower if the solution has a kink inside of elements."""
        return np.inf

    def _caps_at(self, values: Mapping[str, float], *held: str) -> dict[str, float]:
        """Highest assumed order of each column at a state."""
        most = self.smooth_order(values)
        return {name: min(self._cap(name, *held), most) for name in self.fine.shown}

    def _quantity(
        self, values: list[float], name: str = "", held: str = "", in_mean: float = 0.0, most: float = np.inf
    ) -> Quantity:
        """A number with its uncertainty; a count that is the same on all meshes has none.

        At a point of a cell the observed order is accidental; the field's, ``in_mean``, is used if higher.
        """
        if name.startswith(COUNTS) and len(set(values)) == 1:
            return Quantity(values[-1])
        cap = min(self._cap(name, held), most)
        found = estimate(values, cap, least=self.least.get(name, 0.0), slow=self.slow).quantity()
        if not in_mean:
            return found
        by_field = SAMPLED * float(estimate(values, cap, None, in_mean, self.slow).uncertainty)
        return replace(found, uncertainty=min(found.uncertainty, by_field))


def _spectrum(level: SolutionCurve, solved: Solved, critical: float) -> Spectrum:
    return spectrum_of(level.system, solved.state, max(critical, level.continuation.shift))
