"""Equilibria of a triangulated membrane over its load, and the loads at which its stability changes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np

from weakforms.errors import ConvergenceError
from weakforms.problems.triangles.model import SurfaceModel
from weakforms.results import SpecialPoint
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, StepControl, hermite
from weakforms.solvers.equilibrium.balance import residual_limit
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.snes import SolveRecord
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.equilibrium.system import System
from weakforms.solvers.stability.lowest import Lowest
from weakforms.solvers.stability.spectra import Mode, Stability

LARGEST, PREDICTOR = 1.0, 2e-2
"""Largest step along a branch that is followed by arc length, and target distance of its predictor (tangents
jump when triangles change their state)."""

HALVINGS = 8
"""Largest number of times that a step of the load is halved."""

ONTO, OFF = 1.0, -1.0
"""Values that say whether a stability change along the branch is to unstable or back to stable."""

SOLVED = 1e-9
"""Error of an eigenvalue."""

BINS = 24
"""Number of bands along the meridian in which waves of a mode are counted on an unstructured mesh."""


@dataclass
class Point:
    """An equilibrium of the whole discrete surface."""

    load: float
    state: State
    record: SolveRecord
    symmetric: State
    """The equilibrium among surfaces of revolution; on a structured tube it is the equilibrium itself."""
    residual: float
    """Norm of the residual of the whole surface."""
    departure: float
    """Largest distance of a node from its position in the symmetric equilibrium."""
    n_negative: int = -1
    lowest: Mode | None = None
    """The lowest mode, if it has been computed."""
    values: dict[str, float] = field(default_factory=dict)


class SurfaceRun:
    """Equilibria of one discrete membrane over its load.

    On a structured tube the equilibrium is found among ring-periodic positions, and the residual of the whole
    surface is checked at every state. It is stable among them up to a limit load. An equilibrium that is not
    (pinched, or turned inside out, after a long step) belongs to another branch, and is approached in shorter
    steps. On any other mesh, SNES starts from the equilibrium among surfaces of
    revolution and finds the equilibrium of the whole discrete surface.

    Args:
        model: The discrete equations.
        control: Name of the load, ``zw`` or ``p``.
        loads: First values of the loads.
    """

    def __init__(self, model: SurfaceModel, control: str, loads: dict[str, float]) -> None:
        self.model, self.system, self.control = model, model.system, control
        self.rings = model.body.triangles.rings
        self.stability = Stability(model.system)
        self._lowest = Lowest(model.system, factor=self.stability.factor)
        self._subspace = model.symmetric()
        self._newton: ExtendedNewton | None = None
        self._begin = dict(loads)
        self._known: list[Point] = []
        self._limit: float | None = None

    # -- equilibria ------------------------------------------------------------------------------

    def at(self, load: float) -> Point:
        """Equilibrium at a load, reached from the nearest known one, with its number of negative eigenvalues.

        Raises:
            ConvergenceError: If it is not reached, or is not an equilibrium of the whole surface.
        """
        if not self._known:
            return self._keep(self._first(load))
        nearest = min(self._known, key=lambda point: abs(point.load - load))
        if nearest.load == load:
            return nearest
        return self._keep(self._towards(load, nearest, HALVINGS))

    @property
    def first(self) -> float:
        """Load of the first known state."""
        return self._known[0].load

    def is_beyond(self, load: float) -> bool:
        """Whether a load is beyond the limit load that :meth:`turn` found."""
        return self._limit is not None and (load - self._limit) * (self._limit - self.first) > 0

    def turn(self, towards: float) -> float | None:
        """The limit load at which the branch turns back on the way from the first known state to a load.

        The branch is followed by arc length. Known states beyond the turn belong to another branch and are
        forgotten. Under a liquid the printed potential has a force that jumps where the level passes an
        integration point, and cannot be followed in this way; its limit load is that of the vertical
        potential, from which it differs by the quadrature of the load only.

        Returns:
            The extreme of a cubic between the points about the turn; ``None`` if the branch reaches the load.

        Raises:
            ConvergenceError: If the branch cannot be followed.
        """
        name, first, sign = self.control, self._known[0], np.sign(towards - self.first)
        system = self._smooth_system()
        solver = ExtendedNewton(system, (name,), prefix="weakforms_surface_")
        solver.factor.use_pivoting()
        continuation = Continuation(solver, control=StepControl(largest=LARGEST, predictor_error=PREDICTOR))

        def ended(point: CurvePoint) -> bool:
            return sign * (point.state.loads[name] - towards) > 0 or sign * point.tangent.loads[name] < 0

        with system.at(first.symmetric), system.weighed_here():
            begin = continuation.start(first.symmetric, Held(name, first.load), towards={name: sign})
            *_, a, b = begin, *continuation.trace(begin, ended)
        if sign * b.tangent.loads[name] >= 0:
            return None
        h = b.arclength - a.arclength
        parts = a.state.loads[name], h * a.tangent.loads[name], b.state.loads[name], h * b.tangent.loads[name]
        between = np.array([np.dot(hermite(float(x)), parts) for x in np.linspace(0, 1, 101)])
        self._limit = float(sign * (sign * between).max())
        self._known = [point for point in self._known if not self.is_beyond(point.load)]
        return self._limit

    def _smooth_system(self) -> System:
        """The equations with a force that is continuous in positions and level."""
        body = self.model.body
        if body.potential == "vertical" or not body.gamma:
            return self.system
        return SurfaceModel(self.model.mesh.comm, replace(body, potential="vertical")).system

    def _first(self, load: float) -> Point:
        """Equilibrium from the body's first guesses, in their order."""
        for guess in self.model.body.starts():
            try:
                return self._point(load, State(self.model.owned_of(guess), self._begin))
            except ConvergenceError as error:
                failed = error
        raise failed

    def _towards(self, load: float, start: Point, left: int) -> Point:
        try:
            return self._point(load, start.symmetric)
        except ConvergenceError:
            if not left:
                raise
        middle = self._towards((start.load + load) / 2, start, left - 1)
        return self._towards(load, middle, left - 1)

    def _point(self, load: float, guess: State) -> Point:
        symmetric, record = self._subspace.solve(guess, {self.control: load})
        state = symmetric
        if self.rings and self._subspace.negative_count(symmetric):
            raise ConvergenceError(
                f"{self.control} = {load:g}: the equilibrium is unstable among surfaces of revolution and "
                "belongs to another branch"
            )
        if not self.rings:
            self._newton = self._newton or self._solver()
            state, record = self._newton.solve(symmetric)
        with self.system.at(state):
            r = self.system.residual()
            limit = residual_limit(self.system)
        residual = float(np.sqrt(self.system.dot(r, r)))
        if not residual <= limit:
            raise ConvergenceError(
                f"{self.control} = {load:g}: the ring-periodic equilibrium is not one of the whole surface, "
                f"its residual is {residual:.1e}"
            )
        away = np.linalg.norm(self.model.nodal(state.u - symmetric.u), axis=1).max()
        return Point(load, state, record, symmetric, residual, float(away))

    def _solver(self) -> ExtendedNewton:
        solver = ExtendedNewton(self.system, prefix="weakforms_surface_")
        solver.factor.use_pivoting()
        return solver

    def _keep(self, point: Point) -> Point:
        if point.n_negative < 0:
            with self.system.at(point.state):
                self.stability.factor.update()
            point.n_negative = self.stability.factor.negative_count()
        self._known.append(point)
        return point

    # -- columns of a state ----------------------------------------------------------------------

    def columns(self, point: Point, count: int) -> dict[str, float]:
        """Columns of a state, with its ``count`` lowest eigenvalues, complete according to the inertia.

        Raises:
            ConvergenceError: If SLEPc does not find as many as the inertia counts.
        """
        if not point.values:
            radius = np.hypot(*self.model.nodal(point.state.u)[:, :2].T)
            with self.system.at(point.state):
                monitors = self.system.monitors()
            point.values = {
                self.control: point.load,
                **monitors,
                "r_max": float(radius.max()),
                "departure": point.departure,
                "n_negative": point.n_negative,
                "residual": point.residual,
                "iterations": point.record.iterations,
            }
        if count and f"Lambda_{count}" not in point.values:
            modes = self._lowest(point.state, count, point.n_negative)
            point.lowest = modes[0]
            point.values |= {f"Lambda_{i}": mode.eigenvalue for i, mode in enumerate(modes, 1)}
        return point.values

    def lowest_mode(self, point: Point) -> Mode:
        """The lowest mode, of unit length in the mass norm."""
        if point.lowest is None:
            self.columns(point, 1)
        return point.lowest

    def waves(self, vector: np.ndarray) -> int:
        """The dominant number of waves around the axis in a displacement."""
        given = self.model.body.triangles
        x, y, z = self.model.nodal(vector).T
        c, s = np.cos(given.angle), np.sin(given.angle)
        height = given.points[:, 2]
        if self.rings:
            band, bands = np.rint(height / height.max() * self.rings[0]).astype(int), self.rings[0] + 1
            most = self.rings[1] // 2
        else:
            band = np.minimum((BINS * (height - height.min()) / np.ptp(height)).astype(int), BINS - 1)
            bands, most = BINS, int(np.pi * given.radius.max() / given.size)
        power = []
        for n in range(most + 1):
            turn = np.exp(-1j * n * given.angle)
            parts = [
                np.bincount(band, v * turn.real, bands) + 1j * np.bincount(band, v * turn.imag, bands)
                for v in (c * x + s * y, c * y - s * x, z)
            ]
            power.append(float(np.sum(np.abs(parts) ** 2)))
        return int(np.argmax(power))

    # -- stability changes -----------------------------------------------------------------------

    def changes(self, loads: Sequence[float], tolerance: float) -> Iterator[SpecialPoint]:
        """Loads between given ones where the first negative eigenvalue appears or the last disappears.

        They are bracketed by the inertia of the whole tangent, and the interval is halved down to
        ``tolerance``; the uncertainty is half of the last interval. The lowest eigenvalue passes through
        zero, or it jumps, because the second derivative of the relaxed energy jumps when a ring of triangles
        changes its state.

        Args:
            loads: Loads in their order along the branch.
            tolerance: Width of the last interval.

        Raises:
            ConvergenceError: If a state in an interval is not reached.
        """
        for before, after in pairwise(self.at(load) for load in loads):
            if (before.n_negative > 0) != (after.n_negative > 0):
                yield self._located(before, after, tolerance)

    def _located(self, before: Point, after: Point, tolerance: float) -> SpecialPoint:
        low, high = before, after
        low_before, high_before = after, before  # the last points given up on either side, once there are any
        while abs(high.load - low.load) > tolerance:
            middle = self.at((low.load + high.load) / 2)
            if (middle.n_negative > 0) == (low.n_negative > 0):
                low, low_before = middle, low
            else:
                high, high_before = middle, high
        onto = high.n_negative > 0
        width = abs(high.load - low.load)
        changes = [self._rate(low, low_before) * width, self._rate(high, high_before) * width]
        unstable, stable = (high, low) if onto else (low, high)
        mode = self.lowest_mode(unstable)
        last = self.lowest_mode(stable).eigenvalue
        sides = [self.columns(point, 0) for point in (low, high)]
        shown = {name: [side[name] for side in sides] for name in (self.control, "V", "r_max")}
        values = {name: (a + b) / 2 for name, (a, b) in shown.items()}
        spread = {name: abs(b - a) / 2 for name, (a, b) in shown.items()}
        values |= {
            "direction": ONTO if onto else OFF,
            "n": float(self.waves(mode.vector)),
            "Lambda_1": mode.eigenvalue,
            "Lambda_1_stable": last,
        }
        # Either eigenvalue is that at an end of the bracket; the change lies up to a bracket further.
        left = dict(zip(("Lambda_1", "Lambda_1_stable"), changes[::-1] if onto else changes, strict=True))
        spread |= {"direction": 0.0, "n": 0.0, **{name: SOLVED + moved for name, moved in left.items()}}
        return SpecialPoint("stability_change", "primary", self.control, values, spread)

    def _rate(self, point: Point, beside: Point) -> float:
        """Change of the lowest eigenvalue between two points, over that of the load."""
        values = [self.lowest_mode(one).eigenvalue for one in (point, beside)]
        return abs((values[1] - values[0]) / (beside.load - point.load))
