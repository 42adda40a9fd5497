"""Problem ``wrinkled_material``: energy of a sheet at two stretches, and its derivatives (Paper 4)."""

from __future__ import annotations

from typing import ClassVar, Literal

from pydantic import Field

from weakforms.problems.homogeneous.material import require_defined
from weakforms.problems.homogeneous.material_point import NAMES, evaluated
from weakforms.problems.material_choice import MaterialChoice, require_foldable
from weakforms.problems.problem import Numerics, Problem, Requests, Task
from weakforms.problems.wrinkled.sheets.about import WRINKLED_MATERIAL
from weakforms.results import Quantity, Result

ROUND_OFF = 1e-14
"""Relative uncertainty of an expression evaluated at a point."""


class MaterialParameters(MaterialChoice):
    """A sheet under two principal stretches."""

    ratio: ClassVar[str] = "c2"

    l1: float = Field(1.5, gt=0, le=10, description="principal stretch 1")
    l2: float = Field(1.5, gt=0, le=10, description="principal stretch 2")
    c2: float = Field(0.01, ge=0, le=1, description="C2/C1 of mooney_rivlin; 0 is neo-Hookean")
    energy: Literal["relaxed", "modified_gradient", "standard"] = Field(
        "relaxed", description="table of states, modified deformation gradient, or no wrinkling"
    )

    @property
    def form(self) -> str:
        """Name of the energy at a material point."""
        return "full" if self.energy == "standard" else self.energy


class WrinkledMaterial(Problem):
    """Energy, stresses and tangent of a sheet that may wrinkle."""

    about = WRINKLED_MATERIAL
    parameters = MaterialParameters
    numerics = Numerics

    def check(self, parameters: MaterialParameters, requests: Requests) -> None:
        """Refuse requests for states, laws without a natural width, and stretches beyond a law's end.

        Raises:
            InputError: For any of these.
        """
        super().check(parameters, requests)
        require_foldable(self.name, parameters, invariants=False)
        require_defined(self.name, parameters, parameters.l1, parameters.l2, "l1, l2", parameters.form)

    def fill(self, result: Result, task: Task) -> None:
        """Evaluate the expressions of the forms."""
        given = task.parameters
        task.progress("energy", 0, 1)
        found = evaluated(given.material, given.l1, given.l2, given.form)
        values = {name: found[name] for name in NAMES}
        result.quantities |= {k: Quantity(v, ROUND_OFF * max(1.0, abs(v))) for k, v in values.items()}
