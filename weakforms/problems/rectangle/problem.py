"""Problem ``rectangle``: a framed rectangular membrane under gas or liquid, and its stability."""

from __future__ import annotations

import numpy as np

from weakforms.problems.branch_problem import BranchProblem, Family
from weakforms.problems.material_choice import require_foldable
from weakforms.problems.meridian.pre_stretch import require_low, require_taut
from weakforms.problems.problem import End, Requests, Task
from weakforms.problems.rectangle.about import RECTANGLE
from weakforms.problems.rectangle.branch import traced
from weakforms.problems.rectangle.family import RectangleFamily
from weakforms.problems.rectangle.model import RectangleModel
from weakforms.problems.rectangle.parameters import RectangleNumerics, RectangleParameters
from weakforms.problems.triangles.limits import MEDIA, require_light, require_own_load
from weakforms.problems.triangles.start import begins
from weakforms.solvers.stability.surface_family import FilledBranch

CAPS = {"lam1_c": 2.0, **dict.fromkeys(("lam1", "lam2", "S_least", "X_least", "Y_least", "f_w", "f_s"), 1.0)}
"""Highest assumed orders of derivatives: at the centre, and over the diagonal with the corner, where the
deflection contains ``r^2 ln r``; of a place among the points of quadrature; of an area."""


class Rectangle(BranchProblem):
    """A clamped rectangular membrane under gas from below or under a liquid on top."""

    about = RECTANGLE
    parameters = RectangleParameters
    numerics = RectangleNumerics
    surfaces = True

    def check(self, parameters: RectangleParameters, requests: Requests) -> None:
        """Refuse laws without a relaxed form, stretches beyond a law's end, and states of the other load.

        Raises:
            InputError: With a message that names the value and the allowed ones.
        """
        super().check(parameters, requests)
        require_foldable(self.name, parameters, invariants=True)
        require_low(self.name, parameters.material, parameters.w_end, parameters.energy == "relaxed")
        for name, value in (("delta", parameters.delta), ("delta_y", parameters.stretch_y)):
            require_taut(self.name, parameters.material, value, name)
        if parameters.load == "liquid":
            stretches = {"delta": parameters.delta, "delta_y": parameters.stretch_y}
            require_light(self.name, parameters.material, parameters.gamma, stretches)
        require_own_load(self.name, parameters.load, requests)

    def computed(self, _parameters: RectangleParameters) -> tuple[str, ...]:
        """The least stress, which is zero where the first wrinkle appears."""
        return ("S_least",)

    def ends(self, parameters: RectangleParameters, _branch: str) -> list[End]:
        """The last height of the centre."""
        return [End("w_end", "w_c", parameters.w_end, largest=True)]

    def families(self, task: Task) -> dict[str, Family]:
        """The branch of states with both mirrors, on all meshes."""
        parameters, numerics = task.parameters, task.numerics

        def make(level: int) -> FilledBranch:
            task.progress("branch", level, numerics.levels)
            sheet = parameters.sheet(numerics.meshes[level], numerics.degree)
            model = RectangleModel(task.comm, sheet)
            slackest = min(parameters.delta, parameters.stretch_y)
            start = begins(numerics.start, slackest, parameters.load)
            return traced(model, start, parameters.w_end, numerics.step, gas=parameters.gas)

        across = MEDIA[parameters.load][0], "w_c"
        return {"primary": RectangleFamily(make, numerics.levels, 2.0 * numerics.degree, across, caps=CAPS)}

    def points(self, _parameters: RectangleParameters) -> np.ndarray:
        """41 points of the diagonal, from the centre to the corner, by their ``X``."""
        return np.linspace(0.0, 1.0, 41)
