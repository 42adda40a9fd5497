r"""PETSc SNES for an equilibrium with some scalar unknowns and as many scalar equations.

.. math:: R(U; \lambda_1..\lambda_m) = 0, \qquad g_i(U; \lambda) = 0, \quad i = 1..m

The scalars are the last entries of SNES's vector. They are stored on the last rank, which broadcasts them at
every evaluation, so that every rank knows them. The linear systems are bordered.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt
from typing import Protocol
from weakref import proxy

import numpy as np
from petsc4py import PETSc

from weakforms.errors import ConvergenceError
from weakforms.solvers.equilibrium.balance import OF_FORCES, OF_TERMS, RESIDUAL_LIMIT, residual_limit
from weakforms.solvers.equilibrium.callbacks import Deferred
from weakforms.solvers.equilibrium.linear import BorderedMatrix, Factorization
from weakforms.solvers.equilibrium.snes import SolveRecord, run_snes, solve_record
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.equilibrium.system import System

KEPT = 1e-3
"""If an iteration reduces the residual norm to less than this fraction, the next one keeps its Jacobian. It
then converges about as fast again, at a small part of the price; the error that is left is this fraction of
the last step."""

NEARLY = 100.0
"""A state whose last step is small is improved by one more run if its residual is below so many limits. A
larger one shows that the Jacobian is not that of the residual, or that there is no state."""

AT_ROUND_OFF = 10, 1e-8
"""Near a bifurcation point, round-off in the forces alone may cause steps above the tolerance. A state is
then accepted if this number of residuals in a row were round-off (the smallest limit), and the last relative
step is below the second number."""

STOPPING = (
    "relative Newton step 1e-10 (1e-8 if the residual is round-off); residual norm below 1e-8, but not below "
    "1e-15 nor above 1e-10 of the nodal forces before they balance, |K| |U|, or "
    "below 1e-15 of the forces of a load; scalar conditions to 1e-8, or to 1e-14 of their terms"
)
"""Text on these tolerances in results."""


class Constraint(Protocol):
    """One scalar equation ``g(U; λ) = 0``."""

    def value(self, solver: ExtendedNewton) -> float:
        """``g`` at the state that the system is lent to."""

    def gradient(self, solver: ExtendedNewton) -> tuple[np.ndarray, dict[str, float]]:
        """``∂g/∂U`` and ``∂g/∂λ``; ``K`` is factorised at the state that the system is lent to."""


class ExtendedNewton:
    """SNES for ``(U, λ)``; one object is used for all solves of a system with the same scalars.

    Args:
        system: The discrete equilibrium equations.
        scalars: Names of the loads that are unknowns; the other loads keep the values of the state.
        stol: Newton step, relative to ``U``, at which a state is converged. The remaining error is the square
            of the step (with a kept factorisation, a small fraction of the step). A limit on the residual
            would have to depend on its round-off, which grows like ``cells^1.5``.
        max_iterations: Largest number of Newton iterations.
        line_search: PETSc's name: ``basic`` takes full steps, ``bt`` backtracks.
        unfolding: A force ``b``, whose amplitude is one more unknown: ``R(U; λ) + μ b = 0``. Where another
            branch crosses, the system is regular with it and one more constraint, and ``μ`` is zero.
        prefix: PETSc options prefix; options such as ``-{prefix}snes_monitor`` work.
    """

    def __init__(
        self,
        system: System,
        scalars: Sequence[str] = (),
        stol: float = 1e-10,
        max_iterations: int = 25,
        line_search: str = "basic",
        unfolding: np.ndarray | None = None,
        prefix: str = "weakforms_",
    ) -> None:
        self.system = system
        self.scalars = tuple(scalars)
        self._forces = [] if unfolding is None else [unfolding]
        self.unfolded: list[float] = []
        """Amplitude of the unfolding force at the last evaluation, if there is one."""
        self.factor = Factorization(system, prefix + "factor_")
        self.constraints: Sequence[Constraint] = ()
        self.bordered: BorderedMatrix | None = None
        self.left = np.inf
        """Norm of the residual at the end of the last solve."""
        self.last: State | None = None
        """The state at which the last solve ended, converged or not."""
        self._callbacks = Deferred()
        self._made_at = -1
        self._size = system.size
        self._root = system.comm.size - 1
        self._rooted = system.comm.rank == self._root
        self._prefix = prefix
        self._tolerances = {"stol": stol, "max_it": max_iterations}
        self._line_search = line_search
        self._renew()

    def _renew(self) -> None:
        extra = len(self.scalars) + len(self._forces) if self._rooted else 0
        self._x = PETSc.Vec().createMPI((self._size + extra, None), comm=self.system.comm)
        self._made: dict[bool, PETSc.SNES] = {}

    def _snes(self, chord: bool) -> PETSc.SNES:
        """The SNES with a new Jacobian in each iteration or, for a chord, in the first one only."""
        if chord not in self._made:
            options = {"snes_linesearch_type": self._line_search}
            if chord:  # petsc4py has no call for it
                options["snes_lag_jacobian"] = self._tolerances["max_it"] + 1
            self._made[chord] = self._make_snes(options)
        return self._made[chord]

    def _make_snes(self, defaults: dict[str, str | int]) -> PETSc.SNES:
        snes = PETSc.SNES().create(self.system.comm)
        snes.setOptionsPrefix(self._prefix)
        snes.setFunction(self._residual, self._x.duplicate())
        # PETSc owns these contexts, which Python's collector does not see: they may not own this object.
        this = proxy(self)
        sizes = (self._x.getSizes(), self._x.getSizes())
        shell = PETSc.Mat().createPython(sizes, comm=self.system.comm)
        shell.setPythonContext(_BorderedOperator(this))
        shell.setUp()
        snes.setJacobian(self._jacobian, shell)
        ksp = snes.getKSP()
        ksp.setType("preonly")
        ksp.getPC().setType("python")
        ksp.getPC().setPythonContext(_BorderedSolve(this))
        snes.setTolerances(rtol=0.0, atol=0.0, **self._tolerances)
        snes.setConvergenceHistory(self._tolerances["max_it"] + 1, reset=True)
        options = PETSc.Options()
        missing = {self._prefix + name: value for name, value in defaults.items()}
        missing = {key: value for key, value in missing.items() if not options.hasName(key)}
        for key, value in missing.items():
            options[key] = value
        snes.setFromOptions()
        for key in missing:
            options.delValue(key)  # the option table is global: leave it as it was found
        return snes

    # -- the extended vector -----------------------------------------------------------------

    def _split(self, x: PETSc.Vec) -> tuple[np.ndarray, list[float]]:
        array = x.array_r
        scalars = array[self._size :].tolist()
        comm = self.system.comm
        if comm.size > 1:
            scalars = comm.bcast(scalars, root=self._root)
        return array[: self._size], scalars

    def _join(self, x: PETSc.Vec, u: np.ndarray, scalars: Sequence[float]) -> None:
        array = x.array_w
        array[: self._size] = u
        if self._rooted:
            array[self._size :] = scalars

    # -- SNES callbacks ----------------------------------------------------------------------

    def _put(self, x: PETSc.Vec) -> None:
        u, scalars = self._split(x)
        count = len(self.scalars)
        self.unfolded = scalars[count:]
        self.system.rewrite(u, dict(zip(self.scalars, scalars[:count], strict=True)))

    def _residual(self, _snes: PETSc.SNES, x: PETSc.Vec, out: PETSc.Vec) -> None:
        def work() -> None:
            self._put(x)
            values = [c.value(self) for c in self.constraints]
            forces = self.system.residual()
            for amplitude, force in zip(self.unfolded, self._forces, strict=True):
                forces += amplitude * force
            self._join(out, forces, values)

        self._callbacks.run(work, lambda: out.set(np.nan))

    def _jacobian(self, snes: PETSc.SNES, x: PETSc.Vec, mat: PETSc.Mat, _p: PETSc.Mat) -> None:
        def work() -> None:
            if self._is_good_still(snes):
                return
            self.bordered = None
            self._put(x)
            self.factor.update()
            self.bordered = self.border(self.constraints)
            self._made_at = self.factor.count

        self._callbacks.run(work, lambda: None)  # the linear solve that follows fails
        mat.assemble()

    def _is_good_still(self, snes: PETSc.SNES) -> bool:
        """Whether the last iteration converged so fast that the next one keeps its Jacobian.

        Some constraints factorise the tangent themselves; then there is nothing to keep.
        """
        if not snes.getIterationNumber() or self.bordered is None or self._made_at != self.factor.count:
            return False
        norms, _ = snes.getConvergenceHistory()
        return bool(norms[-1] < KEPT * norms[-2])

    def border(self, constraints: Sequence[Constraint]) -> BorderedMatrix:
        """Bordered tangent at the state that the system is lent to, with ``K`` factorised already."""
        columns = [self.system.load_derivative(name) for name in self.scalars] + self._forces
        gradients = [c.gradient(self) for c in constraints]
        names = [*self.scalars, *([""] * len(self._forces))]
        corner = np.array([[loads.get(n, 0.0) for n in names] for _, loads in gradients])
        rows = [self._free(row) for row, _ in gradients]
        return BorderedMatrix(self.factor, columns, rows, corner.reshape(len(rows), len(columns)))

    def _free(self, row: np.ndarray) -> np.ndarray:
        row = row.copy()
        row[self.system.bc_dofs] = 0.0
        return row

    # -- solving -----------------------------------------------------------------------------

    def solve(
        self, guess: State, constraints: Sequence[Constraint] = (), chord: bool = False
    ) -> tuple[State, SolveRecord]:
        """Solve from a guess.

        Args:
            guess: First guess; its loads that are not unknowns are kept.
            constraints: One for each scalar unknown, the amplitude of an unfolding force included.
            chord: Keep the first factorisation for all iterations (after a good predictor that converges
                as fast, at the price of one factorisation).

        Raises:
            ConvergenceError: If the solve diverges, needs too many iterations or meets a number that is not
                finite.
        """
        unknowns = len(self.scalars) + len(self._forces)
        if len(constraints) != unknowns:
            raise ValueError(f"{unknowns} scalar unknowns, {len(constraints)} constraints")
        self.constraints = constraints
        with self.system.at(guess):
            return self._solve(guess, chord)

    def _solve(self, guess: State, chord: bool) -> tuple[State, SolveRecord]:
        system, before = self.system, self.factor.count
        scalars = [guess.loads[name] for name in self.scalars] + [0.0] * len(self._forces)
        self._join(self._x, guess.u, scalars)
        snes = self._snes(chord)
        snes.getKSP().getPC().setFailedReason(PETSc.PC.FailedReason.NOERROR)  # it would stay
        record = self._run(snes, before)
        if snes.getConvergedReason() > 0 and not self._is_balanced(snes) and self._is_balanced(snes, NEARLY):
            record = self._run(snes, before)  # of a stiff law; the last step may have kept its Jacobian
        ended = snes.getConvergedReason() > 0 or self._is_at_round_off(snes, record)
        if not ended or not self._is_balanced(snes):
            raise ConvergenceError(
                f"SNES ended with {record.reason} after {record.iterations} iterations, "
                f"residual {self.left:.1e}"
            )
        return system.state(), record

    def _run(self, snes: PETSc.SNES, before: int) -> SolveRecord:
        """One run of SNES from the extended vector, after so many factorisations."""
        try:
            run_snes(snes, self._x, self._callbacks)
        except ConvergenceError:
            self._renew()  # after an error in PETSc, its vectors stay locked
            raise
        finally:
            record = solve_record(snes, self.factor.count - before)
            self.left = record.norms[-1] if record.norms else np.inf
            self.last = self.system.state()
        return record

    def _is_at_round_off(self, snes: PETSc.SNES, record: SolveRecord) -> bool:
        """Whether no iteration can improve the state, and round-off moves it very little."""
        last, step = AT_ROUND_OFF
        if snes.getConvergedReason() != PETSc.SNES.ConvergedReason.DIVERGED_MAX_IT:
            return False
        self._put(self._x)
        low = OF_FORCES[0] * self.system.force_size()
        moved = snes.getSolutionUpdate().norm()
        return max(record.norms[-last:]) <= low and moved <= step * self._x.norm()

    def _round_off_of_loads(self) -> float:
        """Round-off of the loads' own forces: a single unknown has no tangent at its limit point."""
        _, values = self._split(self._x)
        named = zip(self.scalars, values[: len(self.scalars)], strict=True)
        forces = [self.system.load_derivative(name) * value for name, value in named]
        return OF_FORCES[0] * max((sqrt(self.system.dot(f, f)) for f in forces), default=0.0)

    def _is_balanced(self, snes: PETSc.SNES, times: float = 1.0) -> bool:
        """Whether the remaining residuals of forces and constraints are within some times their limits."""
        self._put(self._x)
        forces, missed = self._split(snes.getFunction()[0])
        left = sqrt(self.system.dot(forces, forces))
        within = left <= times * residual_limit(self.system, left / times)
        within = within or left <= times * self._round_off_of_loads()
        pairs = zip(self.constraints, missed, strict=True)
        return within and all(self._is_met(constraint, abs(value) / times) for constraint, value in pairs)

    def _is_met(self, constraint: Constraint, missed: float) -> bool:
        """Whether a constraint is missed by less than its limit, or by the round-off of its own terms."""
        if missed < RESIDUAL_LIMIT:
            return True
        row, rates = constraint.gradient(self)
        size = self.system.dot(abs(row), abs(self.system.owned()))
        size += sum(abs(rate * self.system.load(name)) for name, rate in rates.items())
        return missed <= OF_TERMS * size


class _BorderedOperator:
    """The Jacobian of the whole system as SNES sees it (a backtracking line search multiplies with it)."""

    def __init__(self, newton: ExtendedNewton) -> None:
        self._newton = newton

    def mult(self, _mat: PETSc.Mat, x: PETSc.Vec, out: PETSc.Vec) -> None:
        """``out = J x``."""
        newton = self._newton
        newton._callbacks.run(
            lambda: newton._join(out, *newton.bordered.multiply(*newton._split(x))), lambda: out.set(0.0)
        )


class _BorderedSolve:
    """A preconditioner that solves the bordered system of the current Newton step."""

    def __init__(self, newton: ExtendedNewton) -> None:
        self._newton = newton

    def apply(self, pc: PETSc.PC, rhs: PETSc.Vec, out: PETSc.Vec) -> None:
        """``out = J⁻¹ rhs``."""
        newton = self._newton

        def spoil() -> None:
            out.set(0.0)
            pc.setFailedReason(PETSc.PC.FailedReason.SUBPC_ERROR)

        newton._callbacks.run(lambda: newton._join(out, *newton.bordered.solve(*newton._split(rhs))), spoil)
