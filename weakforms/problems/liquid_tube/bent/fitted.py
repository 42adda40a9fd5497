"""Paper 3: solutions on a mesh of the whole surface that follows the free surface of the liquid."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.polynomial import chebyshev
from petsc4py import PETSc
from scipy.interpolate import RectBivariateSpline

from weakforms.errors import ConvergenceError
from weakforms.problems.liquid_tube.bent.edge_tangents import lobatto
from weakforms.problems.liquid_tube.bent.front import front_of
from weakforms.problems.liquid_tube.bent.model import SurfaceModel
from weakforms.problems.liquid_tube.bent.surface import Shape
from weakforms.solvers.equilibrium.newton import Constraint, ExtendedNewton
from weakforms.solvers.equilibrium.snes import SolveRecord
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.support.sampling import Sampler

SPLINE = 5
"""Degree of the splines through the nodes of a mesh, if there are enough nodes."""

FITS, FITTED = 8, 1e-9
"""Largest number of moves of the mesh, and the size of the last one relative to the length. A move changes
the state by its square, and the second variation in proportion."""

SMALL = 1e-3
"""Largest move, relative to the length, after which a factorised tangent is still used."""

ALMOST_CONVERGED = 1e-6
"""If a solve does not converge but its residual is below this, the next solve starts from its end."""

LOOKED_AT = 400
"""Number of points of a meridian at which the free surface is first searched."""

PLACES = 49, 25
"""Numbers of material points, along and around, at which two positions are compared."""


class KeptNewton(ExtendedNewton):
    """Newton's method that can continue with the last factorised tangent."""

    keep = False

    def _jacobian(self, snes: PETSc.SNES, x: PETSc.Vec, mat: PETSc.Mat, p: PETSc.Mat) -> None:
        if self.keep and self.bordered is not None:
            mat.assemble()
        else:
            super()._jacobian(snes, x, mat, p)


class Fitting:
    """Solves, and moves the mesh to the free surface of the solution, until the mesh does not move.

    On a mesh that does not follow a front it only solves.

    Args:
        model: The surface on half its circumference.
        solver: Solver with ``zw`` as the unknown load.
    """

    def __init__(self, model: SurfaceModel, solver: KeptNewton) -> None:
        self.model, self.system, self.solver, self.front = model, model.system, solver, model.front
        self.record: SolveRecord | None = None
        """Record of the last solve."""
        self._row: Sampler | None = None

    def solve(
        self,
        guess: State,
        constraints: Sequence[Constraint],
        near: bool = False,
        chord: bool = False,
        kept: bool = False,
    ) -> State:
        """Solve on the mesh fitted to the solution.

        Args:
            guess: First guess.
            constraints: One for each scalar unknown.
            near: Whether the guess's mesh is almost fitted.
            chord: Whether one factorisation for all iterations is tried first.
            kept: Whether the factorisation of the last solve, at a neighbouring state, is tried first.

        Raises:
            ConvergenceError: If it does not converge, or the mesh continues to move.
        """
        state = self._solved(guess if near else self.on_its_front(guess), constraints, chord, kept)
        for _ in range(FITS):
            wanted = self._refitted(state)
            move = self.move(state, wanted)
            if move < FITTED * self.model.data.length:
                return state
            near_enough = move < SMALL * self.model.data.length
            state = self._solved(self._with_front(state, wanted), constraints, True, near_enough)
        raise ConvergenceError("the mesh does not come to rest on the free surface")

    def _solved(self, guess: State, constraints: Sequence[Constraint], chord: bool, kept: bool) -> State:
        """Solve on the guess's mesh, with the factorised tangent if that converges, else by Newton."""
        if chord or kept:
            self.solver.keep = kept
            try:
                state, self.record = self.solver.solve(guess, constraints, chord=True)
                return state
            except ConvergenceError:
                if self.solver.left < ALMOST_CONVERGED:
                    guess = self.solver.last
            finally:
                self.solver.keep = False
        state, self.record = self.solver.solve(guess, constraints)
        return state

    # -- moves of the mesh -----------------------------------------------------------------------

    def refitted(self, state: State) -> State:
        """The state on the mesh moved to its free surface, by one step of Newton's method."""
        return self._with_front(state, self._refitted(state))

    def _refitted(self, state: State) -> np.ndarray:
        """The coefficients of the front after that step."""
        if self.front is None:
            return np.zeros(0)
        zw = state.loads["zw"]
        if zw >= self.model.data.L:
            return np.array([self.front.row])
        angles = self.front.angles
        if self._row is None:
            at = self.model.surface(self.model.unknown)
            places = np.column_stack([np.full_like(angles, self.front.row), angles])
            self._row = Sampler(self.model.unknown, {"z": at.x[2], "rate": at.a[2]}, places)
        with self.system.at(state):
            found = self._row()
            return self.front.fitted(self.front.at(angles) + (zw - found["z"]) / found["rate"])

    def on_its_front(self, state: State) -> State:
        """A state on the mesh of its front, which may be anywhere.

        The front is where meridians, from the upper ring down, meet the level.

        Raises:
            ConvergenceError: If one of them lies above the level as a whole.
        """
        zw = state.loads["zw"]
        if self.front is None or zw >= self.model.data.L:
            return self.refitted(state)
        shape, z = self.shape(state), np.linspace(0, self.model.data.length, LOOKED_AT)
        wanted = []
        for theta in self.front.angles:
            height = shape(z, np.full_like(z, theta))[2] - zw
            below = np.flatnonzero(height[:-1] <= 0)
            if not len(below):
                raise ConvergenceError(
                    f"the liquid at zw = {zw:.6g} does not reach the meridian at {theta:.3g}"
                )
            i = int(below[-1])
            wanted.append(z[i] - height[i] * (z[i + 1] - z[i]) / (height[i + 1] - height[i]))
        return self._with_front(state, self.front.fitted(np.array(wanted)))

    def moved(self, state: State, like: State) -> State:
        """A state interpolated to the mesh of another one."""
        found = self._with_front(state, front_of(like.loads))
        return State(found.u, dict(like.loads) | {"zw": state.loads["zw"]})

    def taken(self, other: Fitting, state: State) -> State:
        """A state of another mesh on this mesh, with the same front."""
        return self.model.state_of(other.shape(state), state.loads)

    def move(self, state: State, coefficients: np.ndarray) -> float:
        """Largest distance by which the mesh of a state would move to a front."""
        if self.front is None:
            return 0.0
        angles = self.front.angles
        wanted = chebyshev.chebval(np.cos(angles), coefficients)
        with self.system.at(state):
            return float(np.abs(wanted - self.front.at(angles)).max())

    def _with_front(self, state: State, coefficients: np.ndarray) -> State:
        """A state interpolated to the mesh of a front."""
        if not self.move(state, coefficients):
            return state
        return self.model.state_of(self.shape(state), state.loads | self.front.loads(coefficients))

    # -- the position over material points -------------------------------------------------------

    def shape(self, state: State) -> Shape:
        """The position of a state as splines: a guess for another mesh."""
        with self.system.at(state):
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

    def apart(self, state: State, other: Shape) -> float:
        """Root mean square distance of a state's position from another one."""
        ends = self.model.data.length, np.pi
        lines = [np.linspace(0, end, count) for end, count in zip(ends, PLACES, strict=True)]
        z, theta = (part.ravel() for part in np.meshgrid(*lines))
        return float(np.sqrt(np.mean(np.sum((self.shape(state)(z, theta) - other(z, theta)) ** 2, axis=0))))

    @cached_property
    def _nodes(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Nodes along and around the half circumference, and the grid positions of this rank's own nodes."""
        space, t = self.model.space, lobatto(self.model.data.degree)
        edges = self.model.nodes, np.linspace(0, np.pi, self.model.data.around + 1)
        lines = [np.append((e[:-1, None] + np.diff(e)[:, None] * t[:-1]).ravel(), e[-1]) for e in edges]
        owned = space.tabulate_dof_coordinates()[: space.dofmap.index_map.size_local]
        places = [np.searchsorted((x[1:] + x[:-1]) / 2, owned[:, i]) for i, x in enumerate(lines)]
        return *lines, *places

    def _splines(self) -> list[tuple[float, float, list[RectBivariateSpline]]]:
        """Splines of the position, separate between rows at which the mesh map has kinks."""
        x, theta, i, j = self._nodes
        found = np.zeros((len(x), len(theta), 3))
        found[i, j] = self.system.owned().reshape(-1, 3)
        found = self.system.sum(found)
        ends = [0.0, x[-1]]
        if self.front is not None:
            ends = sorted({*ends, *self.front.between, self.front.row})
        out = []
        for low, high in pairwise(ends):
            here = (x > low - 1e-9) & (x < high + 1e-9)
            degrees = {"kx": min(SPLINE, here.sum() - 1), "ky": min(SPLINE, len(theta) - 1)}
            parts = [RectBivariateSpline(x[here], theta, found[here, :, k], **degrees) for k in range(3)]
            out.append((low, high, parts))
        return out
