"""A law at a point: energy, stresses and tangent at two stretches, by the expressions of the forms."""

from __future__ import annotations

from functools import cached_property, lru_cache

import numpy as np
import ufl
from dolfinx import fem
from dolfinx import mesh as dmesh
from mpi4py import MPI

from weakforms.forms.materials import MATERIALS
from weakforms.forms.materials.surface import LAWS, surface_law
from weakforms.forms.wrinkling import (
    metric,
    modified_gradient,
    principal_stretches,
    surface_tension_field,
    taut_state,
    tension_field,
)
from weakforms.problems.material_choice import Chosen

NAMES = ("W", "W1", "W2", "W11", "W12", "W22")

LARGEST = 1e6
"""Largest stress, relative to the stiffness at rest, up to which a law is followed. No rubber comes near it,
and the number of steps along a branch grows with the logarithm of the load."""

Coordinates = tuple[float, float, float]
"""Angle of a sheet's coordinates with the principal directions, their skew, and the sheet's tilt in space."""

STATES = ("slack", "tension along 1", "tension along 2", "taut")
"""States of a sheet by number."""


class MaterialPoint:
    """One law, compiled once; constants and stretches are data."""

    def __init__(self, model: str) -> None:
        self.model = model
        self._mesh = dmesh.create_unit_interval(MPI.COMM_SELF, 1)
        material = MATERIALS[model]
        self._constants = {n: fem.Constant(self._mesh, c.default) for n, c in material.constants.items()}
        self._stretches = fem.Constant(self._mesh, np.ones(2))
        law, width = material.energy(self._constants), material.natural_width(self._constants)
        l1, l2 = (ufl.variable(self._stretches[i]) for i in range(2))
        self._energies = {
            "full": law(l1, l2),
            "relaxed": tension_field(law, width)(l1, l2),
            "modified_gradient": modified_gradient(law, width)(l1, l2),
        }
        state = ufl.conditional(ufl.gt(l2, 1), 2.0, 0.0)
        state = ufl.conditional(ufl.gt(l1, 1), 1.0, state)
        self._state = ufl.conditional(taut_state(l1, l2, width), 3.0, state)
        self._variables = l1, l2
        self._coordinates = fem.Constant(self._mesh, np.zeros(3))
        self._compiled: dict[str, fem.Expression] = {}

    def _expression(self, energy: str) -> fem.Expression:
        if energy not in self._compiled:
            l1, l2 = self._variables
            w = self._energies[energy]
            first = [ufl.diff(w, l1), ufl.diff(w, l2)]
            second = [ufl.diff(first[0], l1), ufl.diff(first[0], l2), ufl.diff(first[1], l2)]
            values = [w, *first, *second, self._state]
            self._compiled[energy] = fem.Expression(ufl.as_vector(values), np.array([[0.5]]))
        return self._compiled[energy]

    def __call__(
        self, constants: tuple[tuple[str, float], ...], l1: float, l2: float, energy: str = "full"
    ) -> dict[str, float]:
        """Energy, first and second derivatives, and the state's number.

        Args:
            constants: All constants of the law.
            l1: Principal stretch 1.
            l2: Principal stretch 2.
            energy: ``full``, ``relaxed`` or ``modified_gradient``.
        """
        for name, value in constants:
            self._constants[name].value = value
        self._stretches.value[:] = l1, l2
        values = self._expression(energy).eval(self._mesh, np.array([0], dtype=np.int32)).ravel()
        return dict(zip((*NAMES, "state"), values.tolist(), strict=True))

    def by_metric(
        self, constants: tuple[tuple[str, float], ...], l1: float, l2: float, coordinates: Coordinates
    ) -> dict[str, float]:
        r"""Energy of the same sheet from the metric of other coordinates, on a sheet turned in space.

        The coordinates :math:`\xi` of the sheet at rest are :math:`X = R(\varphi) A\, \xi` with the skew
        ``A = [[1, a], [0, 1]]``, and the sheet lies at :math:`x = Q(\psi)\, \mathrm{diag}(l_1, l_2) X`. The
        energy is that of the forms for a membrane in space, which know neither ``R`` nor ``Q``:

        .. math:: C = A^{-T} F^T F A^{-1}, \qquad F = \partial x/\partial \xi

        Args:
            constants: All constants of the law.
            l1: Principal stretch 1.
            l2: Principal stretch 2.
            coordinates: ``(phi, a, psi)``.

        Returns:
            ``W_metric``, by the invariants of ``C`` if the law has such a form, else by its eigenvalues, and
            ``W_metric_relaxed``, if an incompressible law has that form.
        """
        for name, value in constants:
            self._constants[name].value = value
        self._stretches.value[:] = l1, l2
        self._coordinates.value[:] = coordinates
        if "metric" not in self._compiled:
            values = ufl.as_vector(list(self._of_metric.values()))
            self._compiled["metric"] = fem.Expression(values, np.array([[0.5]]))
        found = self._compiled["metric"].eval(self._mesh, np.array([0], dtype=np.int32)).ravel()
        return dict(zip(self._of_metric, found.tolist(), strict=True))

    @cached_property
    def _of_metric(self) -> dict[str, ufl.core.expr.Expr]:
        turn, skew, tilt = (self._coordinates[i] for i in range(3))
        at_rest = ufl.as_matrix([[1.0, skew], [0.0, 1.0]])
        turned = ufl.as_matrix([[ufl.cos(turn), -ufl.sin(turn)], [ufl.sin(turn), ufl.cos(turn)]])
        flat = ufl.diag(self._stretches) * turned * at_rest
        # Turned in space about the third axis and then about the first.
        c, s = ufl.cos(tilt), ufl.sin(tilt)
        in_space = ufl.as_matrix([[c, -s], [c * s, c * c], [s * s, s * c]]) * flat
        c = metric(in_space, at_rest)
        law = surface_law(self.model, self._constants)
        if self.model not in LAWS:
            return {"W_metric": law.stretches(*principal_stretches(c))}
        full = {"W_metric": law.invariants(ufl.tr(c), ufl.det(c))}
        if not MATERIALS[self.model].incompressible:
            return full
        return full | {"W_metric_relaxed": surface_tension_field(c, law)}


@lru_cache(maxsize=len(MATERIALS))
def point_of(model: str) -> MaterialPoint:
    """The compiled law of that name."""
    return MaterialPoint(model)


def evaluated(chosen: Chosen, l1: float, l2: float, energy: str = "full") -> dict[str, float]:
    """A law with its constants at two stretches (see :class:`MaterialPoint`)."""
    return point_of(chosen.model)(chosen.constants, l1, l2, energy)


def by_metric(chosen: Chosen, l1: float, l2: float, coordinates: Coordinates) -> dict[str, float]:
    """A law with its constants from the metric of other coordinates (see :meth:`MaterialPoint.by_metric`)."""
    return point_of(chosen.model).by_metric(chosen.constants, l1, l2, coordinates)


def first_derivatives(chosen: Chosen, l1: np.ndarray | float, l2: np.ndarray | float) -> np.ndarray:
    """``w,1`` and ``w,2`` of a law at many pairs of stretches, shape ``(2, ...)``."""
    pairs = np.broadcast(l1, l2)
    found = [evaluated(chosen, float(a), float(b)) for a, b in pairs]
    return np.array([[at[name] for at in found] for name in ("W1", "W2")]).reshape(2, *pairs.shape)


def stressed(chosen: Chosen, l1: float, l2: float) -> float:
    """The larger of ``|w,1|`` and ``|w,2|`` at two stretches, relative to ``w,11`` at rest."""
    here, rest = evaluated(chosen, l1, l2), evaluated(chosen, 1.0, 1.0)
    return max(abs(here["W1"]), abs(here["W2"])) / rest["W11"]
