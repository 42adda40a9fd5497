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
from weakforms.problems.liquid_tube.bent.front import NAME
from weakforms.problems.liquid_tube.bent.model import Shape, SurfaceModel
from weakforms.solvers.equilibrium.newton import Constraint, ExtendedNewton, SolveRecord
from weakforms.solvers.equilibrium.system import State
from weakforms.solvers.support.sampling import Sampler

SPLINE = 5
"""Degree of the splines through the nodes of a mesh, where these are enough."""

FITS, FITTED = 8, 1e-9
"""Moves of the mesh, at most, and the last one, over the length: it changes a state by its square, and the
second variation in proportion to it."""

SMALL = 1e-3
"""Move, over the length, after which a factorised tangent still serves."""

CAME_NEAR = 1e-6
"""Residual of a solve that did not converge, below which the next one goes on from where it ended."""

LOOKED_AT = 400
"""Points of a meridian among which the free surface is looked for from afar."""

PLACES = 49, 25
"""Material points along and around at which two positions are compared."""


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
        self._row: Sampler | None = None

    def solve(
        self,
        guess: State,
        constraints: Sequence[Constraint],
        near: bool = False,
        chord: bool = False,
        kept: bool = False,
    ) -> State:
        """The solution on the mesh fitted to it; the system holds it afterwards.

        Args:
            guess: Start.
            constraints: One a scalar unknown.
            near: The guess's mesh is almost fitted.
            chord: One factorisation is tried first.
            kept: The last solve's factorisation is, that of a neighbour.

        Raises:
            ConvergenceError: When it does not converge, or the mesh does not come to rest.
        """
        self.system.set_state(guess.u, guess.loads)
        if not near:
            self.find_front()
        state = self._solved(constraints, chord, kept)
        for _ in range(FITS):
            wanted = self._refitted()
            move = self._length_of(wanted)
            if move < FITTED * self.model.data.length:
                return state
            self._move(wanted)
            state = self._solved(constraints, True, move < SMALL * self.model.data.length)
        raise ConvergenceError("the mesh does not come to rest on the free surface")

    def _solved(self, constraints: Sequence[Constraint], chord: bool, kept: bool) -> State:
        """From the state held: with the tangent at hand if that converges, else by Newton's method."""
        guess = self.system.state()
        if chord or kept:
            self.solver.keep = kept
            try:
                state, self.record = self.solver.solve(guess, constraints, chord=True)
                return state
            except ConvergenceError:
                if self.solver.left < CAME_NEAR:
                    guess = self.system.state()
            finally:
                self.solver.keep = False
        state, self.record = self.solver.solve(guess, constraints)
        return state

    # -- moves of the mesh -----------------------------------------------------------------------

    def refit(self) -> float:
        """Hold the state on the mesh moved to its free surface, by one step of Newton's method.

        Returns how far that moved.
        """
        return self._move(self._refitted())

    def _refitted(self) -> np.ndarray:
        """The front's coefficients after that step."""
        if self.front is None:
            return np.zeros(0)
        zw = self.system.load("zw")
        if zw >= self.model.data.L:
            return np.array([self.front.row])
        angles = self.front.angles
        if self._row is None:
            at = self.model.surface(self.model.unknown)
            places = np.column_stack([np.full_like(angles, self.front.row), angles])
            self._row = Sampler(self.model.unknown, {"z": at.x[2], "rate": at.a[2]}, places)
        found = self._row()
        return self.front.fitted(self.front.at(angles) + (zw - found["z"]) / found["rate"])

    def find_front(self) -> float:
        """The same from afar: where meridians, followed down from the upper ring, meet the level."""
        zw = self.system.load("zw")
        if self.front is None or zw >= self.model.data.L:
            return self.refit()
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

    def _length_of(self, coefficients: np.ndarray) -> float:
        """How far a move to a front is."""
        if self.front is None:
            return 0.0
        angles = self.front.angles
        return float(np.abs(chebyshev.chebval(np.cos(angles), coefficients) - self.front.at(angles)).max())

    def _move(self, coefficients: np.ndarray) -> float:
        length = self._length_of(coefficients)
        if length:
            shape, zw = self.shape(), self.system.load("zw")
            self.front.put(coefficients)
            self.system.set_state(self.model.interpolated(shape), {"zw": zw})
        return length

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

    def apart(self, other: Shape) -> float:
        """Root mean square distance of the position held from another one."""
        ends = self.model.data.length, np.pi
        lines = [np.linspace(0, end, count) for end, count in zip(ends, PLACES, strict=True)]
        z, theta = (part.ravel() for part in np.meshgrid(*lines))
        return float(np.sqrt(np.mean(np.sum((self.shape()(z, theta) - other(z, theta)) ** 2, axis=0))))

    @cached_property
    def _nodes(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Nodes along and around of the half circumference, and where on that grid this rank's own lie."""
        space, t = self.model.space, lobatto(self.model.data.degree)
        edges = self.model.nodes, np.linspace(0, np.pi, self.model.data.around + 1)
        lines = [np.append((e[:-1, None] + np.diff(e)[:, None] * t[:-1]).ravel(), e[-1]) for e in edges]
        owned = space.tabulate_dof_coordinates()[: space.dofmap.index_map.size_local]
        places = [np.searchsorted((x[1:] + x[:-1]) / 2, owned[:, i]) for i, x in enumerate(lines)]
        return *lines, *places

    def _splines(self) -> list[tuple[float, float, list[RectBivariateSpline]]]:
        """Of the position over the mesh, from row to row where the mesh bends: only between it is smooth."""
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
