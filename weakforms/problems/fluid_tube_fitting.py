"""Paper 3: solutions on a mesh of the whole surface that follows the free surface of the liquid."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from petsc4py import PETSc
from scipy.interpolate import RectBivariateSpline

from weakforms.errors import ConvergenceError
from weakforms.problems.fluid_tube_front import NAME
from weakforms.problems.fluid_tube_surface import Shape, SurfaceModel
from weakforms.solvers.newton import Constraint, ExtendedNewton, SolveRecord
from weakforms.solvers.sampling import Sampler
from weakforms.solvers.system import State

SUBDIVIDED = 4
"""Intervals of the splines' grid in each cell."""

FITS, FITTED = 8, 1e-9
"""Moves of the mesh, at most, and the last one, over the length: it changes a state by its square, and the
second variation in proportion to it."""

SMALL = 1e-3
"""Move, over the length, after which a factorised tangent still serves."""

LOOKED_AT = 400
"""Points of a meridian among which the free surface is looked for from afar."""


class KeptNewton(ExtendedNewton):
    """Newton's method that can go on with the last factorised tangent."""

    keep = False

    def _jacobian(self, snes: PETSc.SNES, x: PETSc.Vec, mat: PETSc.Mat, p: PETSc.Mat) -> None:
        if self.keep and self.bordered is not None:
            mat.assemble()
        else:
            super()._jacobian(snes, x, mat, p)


class Fitting:
    """Solves, and moves the mesh to the free surface found, until it stays.

    On a mesh that follows nothing it only solves.

    Args:
        model: The surface on half its circumference.
        solver: With ``zw`` for the unknown load.
    """

    def __init__(self, model: SurfaceModel, solver: KeptNewton) -> None:
        self.model, self.system, self.solver, self.front = model, model.system, solver, model.front
        self.record: SolveRecord | None = None
        """Of the last solve."""
        self._grid: Sampler | None = None
        self._row: Sampler | None = None

    def solve(
        self, guess: State, constraints: Sequence[Constraint], near: bool = False, chord: bool = False
    ) -> State:
        """The solution on the mesh fitted to it; the system holds it afterwards.

        Args:
            guess: Start.
            constraints: One a scalar unknown.
            near: The guess's mesh is almost fitted.
            chord: One factorisation is tried first.

        Raises:
            ConvergenceError: When it does not converge, or the mesh does not come to rest.
        """
        self.system.set_state(guess.u, guess.loads)
        if not near:
            self.find_front()
        state = self._solved(constraints, chord)
        for _ in range(FITS):
            move = self.refit()
            if move < FITTED * self.model.data.length:
                self.system.set_state(state.u, state.loads)
                return state
            self.solver.keep = move < SMALL * self.model.data.length
            try:
                state = self._solved(constraints, chord=True)
            finally:
                self.solver.keep = False
        raise ConvergenceError("the mesh does not come to rest on the free surface")

    def _solved(self, constraints: Sequence[Constraint], chord: bool) -> State:
        """From the state held: with the tangent at hand if that converges, else by Newton's method."""
        guess = self.system.state()
        if chord or self.solver.keep:
            try:
                state, self.record = self.solver.solve(guess, constraints, chord=True)
                return state
            except ConvergenceError:
                self.solver.keep = False
        state, self.record = self.solver.solve(guess, constraints)
        return state

    # -- moves of the mesh -----------------------------------------------------------------------

    def refit(self) -> float:
        """Hold the state on the mesh moved to its free surface, by one step of Newton's method.

        Returns how far that moved.
        """
        if self.front is None:
            return 0.0
        zw = self.system.load("zw")
        if zw >= self.model.data.L:
            return self._move(np.array([self.front.row]))
        angles = self.front.angles
        if self._row is None:
            at = self.model.surface(self.model.unknown)
            places = np.column_stack([np.full_like(angles, self.front.row), angles])
            self._row = Sampler(self.model.unknown, {"z": at.x[2], "rate": at.a[2]}, places)
        found = self._row()
        return self._move(self.front.fitted(self.front.at(angles) + (zw - found["z"]) / found["rate"]))

    def find_front(self) -> float:
        """The same from afar: where meridians, followed down from the upper ring, meet the level."""
        if self.front is None:
            return 0.0
        zw = self.system.load("zw")
        if zw >= self.model.data.L:
            return self._move(np.array([self.front.row]))
        shape, z = self.shape(), np.linspace(0, self.model.data.length, LOOKED_AT)
        wanted = []
        for theta in self.front.angles:
            height = shape(z, np.full_like(z, theta))[2] - zw
            i = int(np.flatnonzero(height[:-1] <= 0)[-1])
            wanted.append(z[i] - height[i] * (z[i + 1] - z[i]) / (height[i + 1] - height[i]))
        return self._move(self.front.fitted(np.array(wanted)))

    def moved(self, state: State, like: State) -> State:
        """A state on the mesh of another one."""
        self.system.set_state(state.u, state.loads)
        if self.front is not None:
            self._move(np.array([v for k, v in like.loads.items() if k.startswith(NAME)]))
        return State(self.system.owned().copy(), dict(like.loads) | {"zw": state.loads["zw"]})

    def taken(self, other: Fitting) -> State:
        """The state another mesh's system holds, on this one fitted alike."""
        shape, loads = other.shape(), other.system.state().loads
        self.system.set_loads(loads)
        return State(self.model.interpolated(shape), loads)

    def _move(self, coefficients: np.ndarray) -> float:
        before, shape = self.front.at(self.front.angles), self.shape()
        zw, moves = self.system.load("zw"), self.front.moves
        self.front.put(coefficients)
        if self.front.moves == moves:
            return 0.0
        self.system.set_state(self.model.interpolated(shape), {"zw": zw})
        return float(np.abs(self.front.at(self.front.angles) - before).max())

    # -- the position over material points -------------------------------------------------------

    def shape(self) -> Shape:
        """The position held, as splines: a guess for another mesh."""
        pieces = self._splines()
        to_mesh = None if self.front is None else self.front.frozen()

        def position(s: np.ndarray, t: np.ndarray) -> np.ndarray:
            x = s if to_mesh is None else to_mesh(s, t)
            out = np.zeros((3, len(x)))
            for k, (low, high, parts) in enumerate(pieces):
                here = ((x >= low) | (k == 0)) & ((x < high) | (k == len(pieces) - 1))
                out[:, here] = [part.ev(x[here], t[here]) for part in parts]
            return out

        return position

    def _splines(self) -> list[tuple[float, float, list[RectBivariateSpline]]]:
        """Of the position over the mesh, from row to row where the mesh bends: only between it is smooth."""
        nodes = self.model.nodes
        theta = np.linspace(0, np.pi, SUBDIVIDED * self.model.data.around + 1)
        t = np.arange(SUBDIVIDED) / SUBDIVIDED
        x = np.append((nodes[:-1, None] + np.diff(nodes)[:, None] * t).ravel(), nodes[-1])
        if self._grid is None:
            places = np.column_stack([part.ravel() for part in np.meshgrid(x, theta, indexing="ij")])
            position = {name: self.model.unknown[i] for i, name in enumerate("xyz")}
            self._grid = Sampler(self.model.unknown, position, places)
        found = {name: values.reshape(len(x), -1) for name, values in self._grid().items()}
        ends = [0.0, nodes[-1]]
        if self.front is not None:
            ends = sorted({*ends, *self.front.between, self.front.row})
        out = []
        for low, high in pairwise(ends):
            here = (x > low - 1e-9) & (x < high + 1e-9)
            parts = [RectBivariateSpline(x[here], theta, found[name][here]) for name in "xyz"]
            out.append((low, high, parts))
        return out
