"""Problem ``material``: a law at two stretches, its full and its relaxed energy."""

from __future__ import annotations

import time
from typing import ClassVar

import numpy as np
from mpi4py import MPI
from pydantic import Field

from weakforms.errors import InputError
from weakforms.forms.materials import MATERIALS
from weakforms.problems.homogeneous.material_point import NAMES, STATES, evaluated
from weakforms.problems.material_choice import MaterialChoice
from weakforms.problems.problem import Numerics, Progress, Requests, check_requests, registry, silent
from weakforms.results import Quantity, Result
from weakforms.solvers.support.provenance import provenance

ROUND_OFF = 1e-13
"""Relative uncertainty of an expression evaluated at a point, including cancellation in second
derivatives."""


SUFFIXES = {"full": "", "relaxed": "_relaxed", "modified_gradient": "_modified"}
"""Endings of the names of each energy's quantities."""


class MaterialParameters(MaterialChoice):
    """A law and the two principal stretches at which it is evaluated."""

    l1: float = Field(1.5, gt=0, le=100, description="principal stretch 1")
    l2: float = Field(1.5, gt=0, le=100, description="principal stretch 2")


class MaterialNumerics(Numerics):
    """No numerics: nothing is discretised."""


class MaterialProblem:
    """Energy, stresses and tangent of every law of chapter 3."""

    name: ClassVar[str] = "material"
    title: ClassVar[str] = "A material law at two stretches: full and relaxed energy, stresses, tangent"
    paper: ClassVar[str] = "materials"
    source: ClassVar[str] = "Patil (2016), chapter 3"
    energy: ClassVar[str] = (
        "W(l1, l2) of the model; relaxed: W taut, W(l, width(l)) under tension along l, 0 slack, "
        "width(l) = l^(-1/2) for every incompressible law"
    )
    scales: ClassVar[dict[str, str]] = {
        "W": "energy per reference volume over the model's stress S",
        "W1": "its derivative in l1 (and so on): nominal stress over S",
        "W11": "its second derivative in l1 (and so on) over S",
        "W_relaxed": "the same of the relaxed energy (and so on)",
        "W_modified": "the same of the full energy of the modified deformation gradient (and so on)",
        "state": ", ".join(f"{i}: {name}" for i, name in enumerate(STATES)),
        **{name: f"stress S: {material.scale}" for name, material in MATERIALS.items()},
    }
    parameters = MaterialParameters
    numerics = MaterialNumerics
    columns = ()
    special_points = ()
    branches = ("primary",)
    control: ClassVar[str] = "none; the quantities are at l1, l2"
    materials = MATERIALS
    """Text for ``weakforms show``: the laws, their constants and sources."""

    def check(self, parameters: MaterialParameters, requests: Requests) -> None:
        """Refuse requests for states, and stretches at which the law is not defined.

        Raises:
            InputError: If the stretches are beyond a law's full extension, or its thickness would vanish.
        """
        check_requests(self, requests)
        require_defined(self.name, parameters, parameters.l1, parameters.l2, "l1, l2")

    def solve(
        self,
        parameters: MaterialParameters,
        numerics: MaterialNumerics,
        requests: Requests,
        comm: MPI.Intracomm,
        progress: Progress = silent,
    ) -> Result:
        """Evaluate the expressions of the forms."""
        begun = time.perf_counter()
        progress("energy", 0, 1)
        found = {}
        for energy, suffix in SUFFIXES.items():
            values = evaluated(parameters.material, parameters.l1, parameters.l2, energy)
            found |= {name + suffix: values[name] for name in NAMES}
        quantities = {k: Quantity(v, ROUND_OFF * max(1.0, abs(v))) for k, v in found.items()}
        return Result(
            problem=self.name,
            parameters=parameters.model_dump(),
            scales=self.scales,
            numerics=numerics.model_dump(),
            provenance=provenance(comm, time.perf_counter() - begun),
            quantities={**quantities, "state": Quantity(values["state"])},
        )


def require_defined(problem: str, parameters: MaterialChoice, l1: float, l2: float, what: str) -> None:
    """Refuse stretches at which the chosen law is not defined.

    Raises:
        InputError: With a message that names them.
    """
    values = evaluated(parameters.material, l1, l2)
    if not all(np.isfinite(values[name]) for name in NAMES):
        raise InputError(
            f"{problem}: model = {parameters.model!r} is not defined at {what} = {l1:g}, {l2:g} "
            "(beyond full extension, or without thickness); smaller stretches are allowed"
        )


registry.add(MaterialProblem())
