"""Problem ``controls``: inflation with its stability at given pressure, mass of gas, and volume."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import ClassVar, Literal

import numpy as np
from pydantic import Field

from weakforms.problems.branch_problem import BranchProblem, MeshNumerics, from_rest
from weakforms.problems.branch_problem import Family as AnyFamily
from weakforms.problems.controls.about import CONTROLS
from weakforms.problems.controls.branch import ControlledBranch, ControlledFamily
from weakforms.problems.diagram.bodies.varied import VariedDisk, VariedTube
from weakforms.problems.diagram.family import POINTS_OF, orders_of
from weakforms.problems.diagram.subjects import GRADING
from weakforms.problems.gas import GasChoice
from weakforms.problems.homogeneous.body import Body, sphere, system_of
from weakforms.problems.homogeneous.material import require_reachable
from weakforms.problems.homogeneous.problem import USUAL
from weakforms.problems.meridian.pre_stretch import require_stretched, require_taut
from weakforms.problems.problem import End, Needs, Requests, Task
from weakforms.solvers.continuation.curve import SolutionCurve

ENDS = {"tube": ("u_end", "u_max"), "circular": ("t_end", "t0"), "sphere": ("lam_end", "lam")}
"""Of each membrane the parameter that ends inflation, and the column that it is a value of."""


class ControlsNumerics(MeshNumerics):
    """Meshes; a sphere has no mesh, and its solutions differ by round-off."""

    degree: int = Field(6, ge=2, le=6, description="polynomial degree of the unknowns")


class ControlsParameters(GasChoice):
    """The membrane, and the gas."""

    ratio: ClassVar[str] = "alpha"
    needs: ClassVar[Needs] = {
        **dict.fromkeys(("delta1", "lf", "u_end"), ({"body": ("tube",)},)),
        **dict.fromkeys(("beta", "t_end"), ({"body": ("circular",)},)),
        "lam_end": [{"body": ("sphere",)}],
    }
    movable: ClassVar = {"u_end": "le", "t_end": "le", "lam_end": "le"}

    body: Literal["tube", "circular", "sphere"] = Field("tube", description="membrane")
    alpha: float = Field(0.1, ge=0, le=1, description="C2/C1 of mooney_rivlin; 0 is neo-Hookean")
    delta1: float = Field(1.0, ge=1, le=5, description="axial pre-stretch of the tube")
    lf: float = Field(6.0, ge=1, le=30, description="stretched length L_f/R_f of the tube")
    beta: float = Field(1.0, ge=1, le=10, description="uniform pre-stretch of the disk")
    u_end: float = Field(4.0, gt=0.05, le=10, description="largest u_max of the tube")
    t_end: float = Field(2.0, gt=0.06, le=10, description="largest pole height of the disk")
    lam_end: float = Field(4.0, gt=1.001, le=50, description="largest stretch of the sphere")

    @property
    def end(self) -> tuple[str, str, float]:
        """The parameter that ends inflation, its column, and its value."""
        return *ENDS[self.body], getattr(self, ENDS[self.body][0])


class Controls(BranchProblem):
    """Inflation of a tube, a disk or a sphere, and which controls keep its states stable."""

    about, parameters, numerics = CONTROLS, ControlsParameters, ControlsNumerics

    def check(self, parameters: ControlsParameters, requests: Requests) -> None:
        """Refuse states that cannot exist.

        Raises:
            InputError: For a pre-stretch or a stretch that the law does not take.
        """
        super().check(parameters, requests)
        material, end = parameters.material, parameters.lam_end
        if parameters.body == "tube":
            require_stretched(self.name, material, parameters.delta1, "delta1")
        elif parameters.body == "circular":
            require_taut(self.name, material, parameters.beta, "beta")
        else:
            require_reachable(self.name, parameters, end, end, "lam_end")

    def ends(self, parameters: ControlsParameters, _branch: str) -> list[End]:
        """The largest displacement, or stretch."""
        return [End(*parameters.end, largest=True)]

    def families(self, task: Task) -> dict[str, AnyFamily]:
        """The branch on all meshes."""
        given, numerics = task.parameters, task.numerics
        gas, (_, along, end) = given.gas, given.end
        kind = partial(ControlledBranch, gas=gas, along=along)

        def make(level: int) -> SolutionCurve:
            task.progress("branch", level, numerics.levels)
            if given.body == "sphere":
                system = system_of(_balloon(), given.material)
                return from_rest(system, "p", along, end, numerics.step, usual_load=USUAL, kind=kind)
            cells, degree = numerics.meshes[level], numerics.degree
            if given.body == "tube":
                values = {"delta1": given.delta1, "lf": given.lf}
                model = VariedTube(task.comm, given.material, values, cells, degree, GRADING)
            else:
                model = VariedDisk(task.comm, given.material, {"beta": given.beta}, cells, degree, 0.0)
            branch = model.primary(end, numerics.step, kind)
            if branch.ended:
                branch.ended = f"controls: {branch.ended}; lower {given.end[0]}"
            return branch

        caps, order = orders_of(numerics.degree, given.body == "circular"), 2.0 * numerics.degree
        about = "primary", caps, POINTS_OF
        return {"primary": ControlledFamily(make, numerics.levels, order, ("p", along), *about)}

    def points(self, parameters: ControlsParameters) -> np.ndarray:
        """61 fractions of the meridian; one point of a sphere."""
        return np.array([0.5]) if parameters.body == "sphere" else np.linspace(0.0, 1.0, 61)


def _balloon() -> Body:
    r"""A sphere by its volume over ``2 pi``.

    .. math:: \frac{\Pi}{2\pi} = 2\,w(\lambda, \lambda) - p V, \qquad V = \tfrac23\lambda^3
    """
    return replace(
        sphere(),
        load="p",
        potential=lambda w, u, p: 2 * w(u[0], u[0]) - p * 2 * u[0] ** 3 / 3,
        extra=lambda _w, u, _p: {"V": 2 * u[0] ** 3 / 3},
    )
