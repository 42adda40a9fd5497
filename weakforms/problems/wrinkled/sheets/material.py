"""Problem ``wrinkled_material``: energy of a sheet at two stretches, and its derivatives (Paper 4)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

import numpy as np
import ufl
from dolfinx import fem
from dolfinx import mesh as dmesh
from mpi4py import MPI
from pydantic import Field

from weakforms.forms.materials import mooney_rivlin
from weakforms.forms.wrinkling import Law, modified_gradient, tension_field
from weakforms.problems.problem import Numerics, Parameters, Problem, Task
from weakforms.problems.wrinkled.sheets.about import WRINKLED_MATERIAL
from weakforms.results import Quantity, Result

ROUND_OFF = 1e-14
"""Relative uncertainty of an expression evaluated at a point."""

FORMS: dict[str, Callable[[Law], Law]] = {
    "relaxed": tension_field,
    "modified_gradient": modified_gradient,
    "standard": lambda law: law,
}


class MaterialParameters(Parameters):
    """A sheet under two principal stretches."""

    l1: float = Field(1.5, gt=0, le=10, description="principal stretch 1")
    l2: float = Field(1.5, gt=0, le=10, description="principal stretch 2")
    c2: float = Field(0.01, ge=0, le=1, description="C2/C1; 0 is neo-Hookean")
    energy: Literal["relaxed", "modified_gradient", "standard"] = Field(
        "relaxed", description="table of states, modified deformation gradient, or no wrinkling"
    )


class WrinkledMaterial(Problem):
    """Energy, stresses and tangent of a sheet that may wrinkle."""

    about = WRINKLED_MATERIAL
    parameters = MaterialParameters
    numerics = Numerics

    def fill(self, result: Result, task: Task) -> None:
        """Evaluate the expressions of the forms."""
        parameters, progress = task.parameters, task.progress
        progress("energy", 0, 1)
        law = derivatives(lambda a, b: mooney_rivlin(a, b, parameters.c2), FORMS[parameters.energy])
        found = law(parameters.l1, parameters.l2)
        result.quantities |= {k: Quantity(v, ROUND_OFF * max(1.0, abs(v))) for k, v in found.items()}


def derivatives(law: Law, form: Callable[[Law], Law]) -> Callable[[float, float], dict[str, float]]:
    """Energy ``W``, stresses ``W1, W2`` and tangent ``W11, W12, W22`` by UFL, as functions of two stretches.

    Args:
        law: Full energy of two principal stretches.
        form: Function that makes it an energy with wrinkling.
    """
    mesh = dmesh.create_unit_interval(MPI.COMM_SELF, 1)
    stretches = fem.Constant(mesh, np.ones(2))
    l1, l2 = ufl.variable(stretches[0]), ufl.variable(stretches[1])
    w = form(law)(l1, l2)
    first = [ufl.diff(w, l1), ufl.diff(w, l2)]
    second = [ufl.diff(first[0], l1), ufl.diff(first[0], l2), ufl.diff(first[1], l2)]
    expression = fem.Expression(ufl.as_vector([w, *first, *second]), np.array([[0.5]]))

    def at(a: float, b: float) -> dict[str, float]:
        stretches.value[:] = a, b
        values = expression.eval(mesh, np.array([0], dtype=np.int32)).ravel()
        return dict(zip(("W", "W1", "W2", "W11", "W12", "W22"), values.tolist(), strict=True))

    return at
