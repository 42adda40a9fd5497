r"""Lowest eigenvalues of a second variation whose spectrum is crowded or degenerate.

:math:`K x = \mu M x` by SLEPc about a target just below the lowest eigenvalue. Sylvester's law proves that no
eigenvalue lies below the target, and that none is missing up to the last one returned. A Krylov method may
find only one copy of a multiple eigenvalue; missing copies are then searched for beside those found.
"""

from __future__ import annotations

import numpy as np
from petsc4py import PETSc

from weakforms.errors import ConvergenceError
from weakforms.solvers.equilibrium.callbacks import Deferred
from weakforms.solvers.equilibrium.linear import Factorization
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.equilibrium.system import System
from weakforms.solvers.stability.eigensolver import by_inverse, give_back, shift_and_invert
from weakforms.solvers.stability.spectra import LOWEST, Mode
from weakforms.solvers.support.compat import PETSC_ERRORS

ROUGH, SHARP = 1e-2, 1e-11
"""Relative residuals of the first search and of the returned modes."""

CLOSE = 1e-3
"""Distance of the target below the lowest eigenvalue, relative to its magnitude: the eigenvalues next to the
lowest are as close to it, and only a target that is as near separates them."""

SHARES = (0.01, 0.1)
"""Distances of a nearer target below the estimate of the lowest eigenvalue, relative to that of the last one.
The first is several times the error of the estimate; the second is tried if eigenvalues lie below it."""

ESTIMATES = 3
"""Largest number of estimates of the lowest eigenvalue."""

APART = 1e-8
"""Eigenvalues closer together than this relative distance are copies of one."""

BEYOND, REACH = 1.25, 1.5
"""Ratio of a target to the last lowest eigenvalue, if that was negative, and of its distance from the target
before to where the counts at both would let the lowest one be."""

STRIDES = (2.0, 16.0)
"""Smallest and largest ratio of a target to the one before, while eigenvalues lie below."""

ATTEMPTS = 6
"""Number of searches for missing copies."""


class Lowest:
    """Computes the lowest eigenvalues and modes at states of one system.

    One factorisation at a target gives the inertia there and the inverse for SLEPc, with an ordering that is
    found once for all targets and states.

    Args:
        system: The discrete equilibrium equations.
        prefix: SLEPc options prefix.
        factor: Factorisation that is shared with others, because on large meshes it dominates the memory.
    """

    def __init__(
        self, system: System, prefix: str = "weakforms_lowest_", factor: Factorization | None = None
    ) -> None:
        self.system = system
        self.factor = factor or Factorization(system, prefix + "factor_")
        self.factor.use_pivoting()
        self._prefix = prefix
        self._generic = _generic(system)
        self._callbacks = Deferred()
        self._target, self._count = 0.0, 0
        self._last: float | None = None
        """The last lowest eigenvalue; the next one is searched near it first."""

    def __call__(self, state: State, count: int, n_negative: int = 0) -> list[Mode]:
        """The ``count`` lowest eigenvalues in ascending order, multiple ones repeated, with their modes.

        ``n_negative`` is the number of negative ones, if it is known and not zero.

        The first mode is the same on any number of ranks, also in sign and, for a multiple eigenvalue, in
        direction: it is the projection of a generic displacement.

        Raises:
            ConvergenceError: If SLEPc finds fewer than the inertia counts.
        """
        with self.system.at(state):
            self.system.tangent()
            self._target, self._count = 0.0, n_negative
            if not n_negative:
                self._factorise(0.0, anew=True)
            try:
                modes = self._lowest(count)
            finally:
                self._shift(0.0)  # the matrix is the tangent again
        self._last = modes[0].eigenvalue
        return modes

    def _lowest(self, count: int) -> list[Mode]:
        target = self._nearest_target()
        found = self._solve(count + 1, target, SHARP, [])  # one more often is a copy
        for _ in range(ATTEMPTS):
            found = sorted(found, key=lambda pair: pair[0])
            last = found[count - 1][0]
            edge = last + APART * max(1.0, abs(last))
            if self._below(edge) <= sum(value < edge for value, _ in found):
                return self._directed([self._mode(*pair) for pair in found])[:count]
            found += self._solve(count, target, SHARP, [vector for _, vector in found])
        raise ConvergenceError("stability: SLEPc finds fewer lowest eigenvalues than the inertia counts")

    def _nearest_target(self) -> float:
        """A target just below the lowest eigenvalue, estimated anew from nearer ones while that helps."""
        self._go_below()
        target = self._target
        for _ in range(ESTIMATES):
            lowest = self._solve(1, target, ROUGH, [])[0][0]
            close = CLOSE * max(abs(lowest), 1e-3)
            near = [lowest - max(close, share * (lowest - target)) for share in SHARES]
            nearer = next((one for one in near if one > target and not self._below(one)), None)
            if nearer is None:
                break
            target = nearer
            if lowest - target < 4 * close:
                break
        return target

    def _shift(self, target: float) -> None:
        """Make the matrix ``K - target M``."""
        if target != self._target:
            self.system.shift(self._target - target)
            self._target = target

    def _factorise(self, target: float, anew: bool = False) -> None:
        """Factorise ``K - target M``, unless that was the last matrix and ``K`` is not new."""
        if target != self._target or anew:
            self._shift(target)
            self.factor.refactor()
            self._count = self.factor.negative_count()

    def _below(self, target: float) -> int:
        """Number of eigenvalues below a target, at which the matrix is factorised then."""
        self._factorise(target)
        return self._count

    def _go_below(self) -> None:
        """Factorise at zero, or at the first target of a growing series, below all eigenvalues.

        The counts at the last two targets say where none would be left if they fell evenly.
        """
        if not self._count:
            return
        before, higher = self._count, 0.0
        target = BEYOND * self._last if self._last is not None and self._last < 0 else -1.0
        while count := self._below(target):
            reach = REACH * count * (higher - target) / max(before - count, 1)
            least, most = (ratio * target for ratio in STRIDES)
            before, higher, target = count, target, min(least, max(most, target - reach))
            if target < LOWEST:
                raise ConvergenceError(f"stability: there are eigenvalues below {LOWEST:g}")

    def _solve(
        self, wanted: int, target: float, tolerance: float, apart_from: list[PETSc.Vec]
    ) -> list[tuple[float, PETSc.Vec]]:
        """Eigenvalues nearest to a target, with their vectors; apart from given ones."""
        self._factorise(target)
        eps = shift_and_invert(self.system.comm, self._prefix)
        eps.setOperators(self.system.matrix, self.system.mass)
        eps.setTarget(0.0)  # the matrix is shifted
        eps.setDimensions(nev=wanted)
        eps.setTolerances(tol=tolerance, max_it=300)
        # A search finds the part of its start in each eigenspace: further copies need another start.
        eps.setInitialSpace([self._start(len(apart_from))])
        if apart_from:
            eps.setDeflationSpace(apart_from)
        by_inverse(eps, self._callbacks).solve = self.factor.solve
        eps.setFromOptions()
        try:
            try:
                eps.solve()
            finally:
                self._callbacks.release()
            if eps.getConverged() < wanted:
                raise ConvergenceError(f"SLEPc converged {eps.getConverged()} of {wanted} eigenvalues")
            out = []
            for i in range(eps.getConverged()):
                vector = self.system.matrix.createVecRight()
                out.append((float(eps.getEigenpair(i, vector).real) + target, vector))
            return out
        except PETSC_ERRORS as error:
            raise ConvergenceError(f"SLEPc failed: {error}") from error
        finally:
            give_back(eps)

    def _start(self, seed: int) -> PETSc.Vec:
        """A random vector, another one for each seed."""
        vector = self.system.matrix.createVecRight()
        vector.array_w[:] = np.random.default_rng((seed, self.system.comm.rank)).standard_normal(
            self.system.size
        )
        return vector

    def _mode(self, eigenvalue: float, vector: PETSc.Vec) -> Mode:
        array = vector.array.copy()
        length = np.sqrt(self.system.dot(array, self.system.mass_times(array)))
        return Mode(eigenvalue, array / length)

    def _directed(self, modes: list[Mode]) -> list[Mode]:
        """Modes of the lowest eigenvalue, the first of them the projection of a generic displacement."""
        lowest = modes[0].eigenvalue
        copies = [m for m in modes if m.eigenvalue < lowest + APART * max(1.0, abs(lowest))]
        weighed = self.system.mass_times(self._generic)
        parts = np.array([self.system.dot(mode.vector, weighed) for mode in copies])
        turn, _ = np.linalg.qr(np.column_stack([parts, np.eye(len(parts))]))
        turn[:, 0] *= np.sign(turn[:, 0] @ parts)
        vectors = np.column_stack([mode.vector for mode in copies]) @ turn
        turned = [Mode(m.eigenvalue, vector) for m, vector in zip(copies, vectors.T, strict=True)]
        return turned + modes[len(copies) :]


def _generic(system: System) -> np.ndarray:
    """A displacement without symmetry that depends on position and component, not on the numbering."""
    space = system.unknown.function_space
    blocks = space.dofmap.index_map_bs
    places = space.tabulate_dof_coordinates()[: system.size // blocks]
    phases = places @ np.array([2.0, 3.0, 5.0])
    return np.cos(1.0 + phases[:, None] + 7.0 * np.arange(blocks)).ravel()
