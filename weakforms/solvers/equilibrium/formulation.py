"""The weak form of an equilibrium problem, as a problem provides it to the solvers."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np
import ufl
from dolfinx import fem
from ufl.core.expr import Expr


class Tension(Protocol):
    """Principal resultants of the state that a system is lent to; a negative one is compression."""

    def at_nodes(self) -> tuple[float, float]:
        """The smallest one, and the largest magnitude, at the nodes."""

    def least(self, near: float | None = None) -> tuple[float, float, str]:
        """The smallest one anywhere or near a mesh coordinate, its mesh coordinate and its direction."""

    def place(self, x: float, loads: Mapping[str, float]) -> float:
        """Magnitude of the material coordinate at a mesh coordinate."""


@dataclass
class Formulation:
    """Weak form of an equilibrium problem, as a problem provides it to the solvers.

    The second variation must be symmetric (the loads have a potential).
    """

    unknown: fem.Function
    residual: ufl.Form
    """First variation; linear in the test function."""
    loads: Mapping[str, tuple[fem.Constant, Expr]]
    """Scalars that may become unknowns: the constant, and the ``ufl.variable`` by which it enters the
    forms."""
    bcs: list[fem.DirichletBC]
    mass: ufl.Form
    """Bilinear form; gives the norm of the continuation and the right-hand side of the eigenproblem."""
    monitors: Mapping[str, ufl.Form]
    """Scalar functionals, the columns of a branch."""
    profile: Mapping[str, Expr] = field(default_factory=dict)
    """Expressions that are sampled along the body for fields."""
    abscissa: str = "Z"
    """Name of the material coordinate of the samples."""
    derived: Mapping[str, Callable[[Mapping[str, float]], float]] = field(default_factory=dict)
    """Columns computed from the functionals' values; they cannot be prescribed."""
    maxima: Mapping[str, Expr] = field(default_factory=dict)
    """Columns that are the largest value of an expression anywhere on the body."""
    levels: Mapping[str, tuple[Expr, float]] = field(default_factory=dict)
    """Columns that are the smallest ``coordinate`` at which an expression's magnitude reaches a level (the
    largest one where it never does)."""
    coordinate: Expr | None = None
    """Material coordinate that ``levels`` are given in."""
    internal: tuple[str, ...] = ()
    """Functionals that the solvers need and results do not show."""
    locate: Callable[[np.ndarray, Mapping[str, float]], np.ndarray] | None = None
    """Mesh coordinates of material points at given loads, if the mesh moves with the loads."""
    tangent: ufl.Form | None = None
    """Second variation; by default the derivative of ``residual``."""
    aim: Callable[[str], None] | None = None
    """Called with a load's name before a derivative with respect to it is assembled. Loads that enter by the
    same ``ufl.variable`` (points of a moving mesh) share compiled derivatives; this call selects one of
    them."""
    mark: Callable[[Any], None] | None = None
    """Writes the ``marks`` of a state into the forms, if states have them."""
    tension: Tension | None = None
    """Resultants of a membrane of revolution, if its results say where it is compressed."""
