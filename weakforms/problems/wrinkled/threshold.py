"""Problem ``wrinkled_tube_threshold``: thickness ratio at which the unloaded cylinder of Paper 4 wrinkles."""

from __future__ import annotations

from typing import ClassVar

from pydantic import Field

from weakforms.errors import ConvergenceError, InputError
from weakforms.problems.material_choice import MaterialChoice, require_foldable
from weakforms.problems.problem import Problem, Requests, Task
from weakforms.problems.wrinkled.about import WRINKLED_TUBE_THRESHOLD
from weakforms.problems.wrinkled.critical import threshold
from weakforms.problems.wrinkled.membrane import natural_radius
from weakforms.problems.wrinkled.problem import WIDEST, WrinkledNumerics
from weakforms.results import Failure, Result


class ThresholdParameters(MaterialChoice):
    """Unloaded membrane whose disks were attached before it was stretched.

    Disks no wider than the natural radius of the stretched membrane, ``Af <= delta^(-1/2)``, hold none that
    is taut at uniform thickness; there is no threshold to look for then.
    """

    ratio: ClassVar[str] = "c2"

    delta: float = Field(2.0, gt=1, le=6, description="axial pre-stretch")
    c2: float = Field(0.01, ge=0, le=1, description="C2/C1 of mooney_rivlin; 0 is neo-Hookean")
    L: float = Field(8.0, ge=1, le=40, description="undeformed length L_o/Ao")
    Af: float = Field(1.0, gt=0, le=WIDEST, description="radius of the disks; 1 is Case 2")
    upper: bool = Field(False, description="which threshold: above the uniform thickness, not below it")


class WrinkledTubeThreshold(Problem):
    """Thickness ratio beyond which the unloaded membrane wrinkles."""

    about = WRINKLED_TUBE_THRESHOLD
    parameters = ThresholdParameters
    numerics = WrinkledNumerics

    def check(self, parameters: ThresholdParameters, requests: Requests) -> None:
        """Refuse states (there is only the unloaded one), and disks between which no membrane is taut.

        Raises:
            InputError: For these, or a law without a form.
        """
        super().check(parameters, requests)
        require_foldable(self.name, parameters, invariants=False)
        natural = natural_radius(parameters.delta)
        if parameters.Af <= natural:
            raise InputError(
                f"{self.name}: Af = {parameters.Af:g} with delta = {parameters.delta:g}: the membrane of "
                "uniform thickness is not taut, and there is no threshold; allowed: Af above "
                f"delta^(-1/2) = {natural:.6g}"
            )

    def fill(self, result: Result, task: Task) -> None:
        """The threshold ``M`` and the place ``Z`` where the membrane wrinkles first.

        Where it wrinkles at no ratio: the last one looked at, ``M_taut``, and the least ``gw`` there,
        ``gw_min``.
        """
        parameters, numerics, comm, progress = task.parameters, task.numerics, task.comm, task.progress
        progress("threshold", 0, 1)
        values = {name: getattr(parameters, name) for name in ("delta", "c2", "L", "Af")}
        side = 1 if parameters.upper else -1
        mesh = numerics.meshes, numerics.degree
        try:
            found = threshold(comm, values, *mesh, side, parameters.other_law)
        except ConvergenceError as error:
            result.failures.append(Failure("threshold", f"{error}; choose a smaller Af, or another law"))
        else:
            result.quantities |= {name: one.quantity() for name, one in found.items()}
