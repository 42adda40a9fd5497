"""Second variations in directions outside the unknowns of an equilibrium (a broken symmetry).

A state computed in a symmetric space may lose stability in a mode that breaks the symmetry. The first
variation depends on the state *and* on a displacement ``q`` in the larger space. Its derivative with respect
to ``q`` at ``q = 0`` is the operator that decides on stability: :class:`SecondVariation`. :class:`Singular`
is the condition that this operator, or ``K`` itself (:class:`OwnVariation`), has a null vector.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
import ufl
from dolfinx import fem
from petsc4py import PETSc

from weakforms.errors import ConvergenceError
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.linear import BorderedMatrix, Factorization
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.equilibrium.system import System
from weakforms.solvers.stability.spectra import Mode, Spectrum, Stability

CRITICAL = 1e-6
"""An eigenvalue of uncertain sign below this magnitude counts as the zero eigenvalue of a critical point."""

NO_RATE = 1e-7
"""Relative size below which a rate is zero, where the conjugate of a load has an extremum."""


class SecondVariation(System):
    """Operator ``K(U, λ)`` of a perturbation ``q``, at the state that the base system is lent to.

    Args:
        formulation: Its ``unknown`` is ``q``, which stays zero; its ``residual`` is the first variation at
            the base's state displaced by ``q``; its ``loads`` are the base's. The mass may depend on the
            loads.
        base: The system of the states.
    """

    def __init__(self, formulation: Formulation, base: System) -> None:
        self.base = base
        self._weighed: tuple[float, ...] | None = None
        constants = {*formulation.mass.constants()}
        self._weighing = [
            name
            for name, (value, _) in formulation.loads.items()
            if not isinstance(value, fem.Constant) or value in constants
        ]
        """Loads on which the mass matrix may depend: points of a moving mesh, and constants of its form."""
        super().__init__(formulation)
        self.factor = Factorization(self)
        self.stability = Stability(self)
        self.mode = fem.Function(self.unknown.function_space)
        self._quadratic: ufl.Form | None = None

    @property
    def is_lent(self) -> bool:
        """Whether the base belongs to a state; the perturbation itself is zero."""
        return self.base.is_lent

    @contextmanager
    def at(self, state: State) -> Iterator[None]:
        """Set the perturbation, which is zero again afterwards; the loads are those of the base's state.

        Raises:
            NoStateError: If the base is not lent to a state.
        """
        self.require_lent()
        self._write(state.u, {})
        try:
            yield
        finally:
            self._give_up()

    def _give_up(self) -> None:
        self._everywhere[:] = 0.0

    @property
    def mass(self) -> PETSc.Mat:
        """Mass matrix at the base's loads, assembled again if one of those that it depends on has changed."""
        loads = tuple(map(self.load, self._weighing))
        if self._weighed != loads:
            self._weighed = loads
            self._update_mass()
        return super().mass

    def spectrum(self, count: int = 1) -> Spectrum:
        """The lowest eigenvalues at the state of the base system, and the number of negative ones by inertia.

        An eigenvalue that is zero to round-off (at a critical point) does not count as negative.
        """
        return judged(self.stability, self._at_rest(), count)

    def fixed(self, border: np.ndarray, compliance: float) -> Spectrum:
        """The lowest eigenvalues of ``K + b bᵀ/c``: see :meth:`Stability.bordered`."""
        try:
            return self.stability.bordered(self._at_rest(), border, compliance)
        except ConvergenceError:
            return self.stability.bordered(self._at_rest(), border, compliance, shift=CRITICAL)

    def nearest(self) -> Mode:
        """The eigenvalue nearest to zero at the state of the base system, with its mode."""
        return nearest_to_zero(self.stability, self._at_rest())

    def highest_negative(self) -> Mode:
        """The negative eigenvalue nearest to zero at the state of the base system, with its mode.

        Raises:
            ConvergenceError: If none is found.
        """
        return self.stability.highest_negative(self._at_rest())

    def negative_count(self, shift: float = 0.0) -> int:
        """Number of eigenvalues below ``-shift`` at the state of the base system, by inertia."""
        return counted(self, self.factor, shift)

    def eigenvalue(self, index: int) -> float:
        """One eigenvalue, by its number in ascending order: see :meth:`Stability.nearest_by_index`."""
        return self.stability.nearest_by_index(self._at_rest(), index)

    def lowest_against(self, other: PETSc.Mat) -> float:
        """The lowest eigenvalue relative to another matrix: see :meth:`Stability.lowest_against`."""
        return self.stability.lowest_against(self._at_rest(), other)

    def _at_rest(self) -> State:
        return State(np.zeros(self.size), {})

    def quadratic_gradient(
        self, phi: np.ndarray, loads: Iterable[str]
    ) -> tuple[np.ndarray, dict[str, float]]:
        """Gradient of ``φᵀ K φ`` with respect to the base's unknowns and the loads named, for fixed ``φ``."""
        self.mode.x.array[: self.size] = phi
        self.mode.x.scatter_forward()
        if self._quadratic is None:
            self._quadratic = ufl.action(ufl.action(self._ufl["tangent"], self.mode), self.mode)
        return self.base.scalar_gradient(f"quadratic_{self.unknown.name}", self._quadratic, loads)


def judged(stability: Stability, state: State, count: int) -> Spectrum:
    """The lowest eigenvalues of a state and the number of negative ones by inertia.

    An eigenvalue that is zero to round-off (at a critical point) does not count as negative.

    Raises:
        ConvergenceError: If SLEPc and the inertia disagree on the other eigenvalues.
    """
    try:
        return stability.spectrum(state, count)
    except ConvergenceError:
        return stability.spectrum(state, count, shift=CRITICAL)


def nearest_to_zero(stability: Stability, state: State) -> Mode:
    """The eigenvalue nearest to zero, with its mode; a small matrix may be singular to the last bit."""
    try:
        return stability.modes(state, 1)[0]
    except ConvergenceError:
        return stability.mode_at(state, 0.0)


def counted(system: System, factor: Factorization, shift: float) -> int:
    """Number of eigenvalues below ``-shift`` at the lent state, by inertia."""
    system.tangent()
    if shift:
        system.shift(shift)
    factor.stiffened = None
    factor.refactor()
    return factor.negative_count()


class Rated(NamedTuple):
    """Negative eigenvalues of ``K``, and the rate at which a load's conjugate rises with the load."""

    count: int
    rate: float
    """``V_p = dᵀ K⁻¹ d``."""
    size: float
    """``|d| |K⁻¹ d|``, which bounds the rate."""

    @property
    def count_at_fixed(self) -> int:
        """Negative eigenvalues where the conjugate is given, on ``dᵀ x = 0``; zero does not count."""
        return self.count - int(self.rate < NO_RATE * self.size)


def rated(system: System, factor: Factorization, load: str) -> Rated:
    r"""Inertia of ``K`` at the lent state, and the rate of what is conjugate to a load (of gas: the volume).

    With the conjugate's gradient ``d`` the inertia of :math:`(K, d; d^T, 0)` is that of ``K`` and of
    :math:`-d^T K^{-1} d`; less one negative eigenvalue it is that of ``K`` on :math:`d^T x = 0`. Where ``K``
    is exactly singular, at a limit point, its zero eigenvalue does not count as negative.
    """
    return across(system, factor, system.load_derivative(load))


def across(system: System, factor: Factorization, border: np.ndarray) -> Rated:
    """The same of any vector ``d``, such as the dual of a displacement that needs no energy.

    ``K`` on the displacements normal to that one has neither its zero eigenvalue nor the error of it.
    """
    factor.update()
    if factor.failed:
        system.shift(CRITICAL)
        factor.refactor()
    count, answer = factor.negative_count(), factor.solve(border)
    size = np.sqrt(system.dot(border, border) * system.dot(answer, answer))
    return Rated(count, system.dot(border, answer), float(size))


class SingularForm(Protocol):
    """A symmetric operator ``K(U, λ)`` that may become singular along a curve of states ``(U, λ)``."""

    factor: Factorization

    def mass_times(self, u: np.ndarray) -> np.ndarray:
        """``M u``."""

    def negative_count(self, shift: float = 0.0) -> int:
        """Number of eigenvalues below ``-shift``, by inertia."""

    def quadratic_gradient(
        self, phi: np.ndarray, loads: Iterable[str]
    ) -> tuple[np.ndarray, dict[str, float]]:
        """Gradient of ``φᵀ K φ`` in the unknowns and in the loads named, for fixed ``φ``."""


class OwnVariation:
    """The second variation in the directions of the unknowns themselves, singular at limit points.

    It shares matrix and factors with the solver, whose tangent it is.
    """

    def __init__(self, solver: ExtendedNewton) -> None:
        self.system, self.factor = solver.system, solver.factor

    def mass_times(self, u: np.ndarray) -> np.ndarray:
        """``M u``."""
        return self.system.mass_times(u)

    def negative_count(self, shift: float = 0.0) -> int:
        """Number of eigenvalues below ``-shift``, by inertia."""
        return counted(self.system, self.factor, shift)

    def quadratic_gradient(
        self, phi: np.ndarray, loads: Iterable[str]
    ) -> tuple[np.ndarray, dict[str, float]]:
        """Gradient of ``φᵀ K φ`` in the unknowns and in the loads named, for fixed ``φ``."""
        return self.system.quadratic_gradient(phi, loads)


@dataclass
class Singular:
    r"""The condition ``g = 0`` that a second variation ``K`` is singular.

    With a fixed vector ``c`` the bordered system

    .. math:: K \varphi + g\,c = 0, \qquad c^T \varphi = 1

    gives ``g``, which is proportional to the eigenvalue near ``K φ = 0`` and vanishes there. It follows the
    mode that ``c`` selects, not a position in an ordered spectrum. By the symmetry of ``K``,
    :math:`\mathrm{d}g = -\varphi^T \mathrm{d}K\, \varphi` (Griewank & Reddien 1984; Govaerts 2000,
    chapter 3).
    """

    variation: Callable[[], SingularForm]
    """Returns the operator; a function, because one object may be used for several wave numbers."""
    border: np.ndarray

    def vectors(self) -> tuple[np.ndarray, float]:
        """``(φ, g)`` at the state of the base system."""
        factor = self.variation().factor
        factor.update()
        bordered = BorderedMatrix(factor, [self.border], [self.border], np.zeros((1, 1)))
        phi, g = bordered.solve(np.zeros(len(self.border)), np.ones(1))
        return phi, float(g[0])

    def value(self, solver: ExtendedNewton) -> float:
        """The value of ``g``."""
        return self.vectors()[1]

    def gradient(self, solver: ExtendedNewton) -> tuple[np.ndarray, dict[str, float]]:
        """The gradient, from the derivative of ``φᵀ K φ``."""
        row, loads = self.variation().quadratic_gradient(self.vectors()[0], solver.scalars)
        return -row, {name: -value for name, value in loads.items()}

    def turn(self) -> None:
        """Take the null vector at the state of the base system, which is near a singular one, as ``c``.

        It is of unit length in the mass norm and keeps its sense. Newton's method must not meet a change of
        ``c``, but along a line the null vector may turn until it is orthogonal to the first one.
        """
        phi, _ = self.vectors()
        form = self.variation()
        dual = form.mass_times(phi)
        self.border = dual / np.sqrt(form.factor.system.dot(phi, dual))

    def cubic(self) -> float:
        r"""Third variation in the direction of the null vector of a limit point; it is zero at a cusp."""
        phi, _ = self.vectors()
        form = self.variation()
        row, _ = form.quadratic_gradient(phi, ())
        return form.factor.system.dot(row, phi)
