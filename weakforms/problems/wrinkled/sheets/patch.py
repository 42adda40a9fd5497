r"""Problem ``wrinkled_patch`` (Paper 5, section 2.3): a flat wrinkled patch under pressure, perturbed.

.. math:: x = aX + e\sin nX, \quad y = bY, \quad z = c + e\cos nX, \qquad 0 \le X \le L_x

The lines along ``Y`` keep their stretch ``b`` exactly and stay normal to those along ``X``. The relaxed
energy of a patch with tension along ``Y`` therefore does not change, while the pressure's potential decreases
like ``e^2 n``.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import ClassVar

import numpy as np
import ufl
from dolfinx import fem
from dolfinx import mesh as dmesh
from mpi4py import MPI
from pydantic import Field as Given
from ufl.core.expr import Expr

from weakforms.errors import InputError
from weakforms.forms.materials import mooney_rivlin
from weakforms.forms.wrinkling import metric, principal_stretches, tension_field
from weakforms.problems.branch_problem import BranchProblem, Family, MeshNumerics
from weakforms.problems.material_choice import MaterialChoice, require_foldable
from weakforms.problems.problem import End, Requests, Task
from weakforms.problems.wrinkled.sheets.about import WRINKLED_PATCH
from weakforms.results import Absence, Branch, Failure, Field, Quantity, SpecialPoint, State
from weakforms.solvers.support.provenance import quadrature_degree
from weakforms.solvers.uncertainty.refinement import estimate

POINTS = 21
"""Amplitudes on the branch."""


class PatchParameters(MaterialChoice):
    """The patch and its perturbation; the pressure and the patch's width are 1."""

    ratio: ClassVar[str] = "c2"

    a: float = Given(0.3, gt=0, le=2, description="stretch along X, the wrinkled direction")
    b: float = Given(2.0, gt=0, le=5, description="stretch along Y, the direction of tension")
    c: float = Given(0.1, ge=-10, le=10, description="height of the flat patch")
    n: float = Given(10.0, gt=0, le=100, description="wave number")
    Lx: float = Given(1.0, gt=0, le=100, description="length along X")
    c2: float = Given(0.01, ge=0, le=1, description="C2/C1 of mooney_rivlin")
    e_end: float = Given(0.04, gt=0, le=1, description="amplitude at which the branch ends")


class PatchNumerics(MeshNumerics):
    """Meshes of the patch along ``X``."""

    cells: int = Given(32, ge=8, le=20_000, description="cells on the finest mesh")


class Patch:
    """The energy of the perturbed patch on one mesh, with its derivatives with respect to the amplitude."""

    def __init__(self, parameters: PatchParameters, cells: int, degree: int) -> None:
        given = parameters
        mesh = dmesh.create_interval(MPI.COMM_SELF, cells, [0.0, given.Lx])
        along = ufl.SpatialCoordinate(mesh)[0]
        self._amplitude = fem.Constant(mesh, 0.0)
        e = ufl.variable(self._amplitude)
        x = given.a * along + e * ufl.sin(given.n * along)
        z = given.c + e * ufl.cos(given.n * along)
        tangents = ufl.as_matrix([[x.dx(0), 0], [0, given.b], [z.dx(0), 0]])
        other = given.other_law
        full = other.law(mesh) if other else lambda p, q: mooney_rivlin(p, q, given.c2)
        law = tension_field(full)
        c = metric(tangents, ufl.Identity(2))
        strain, pressure = law(*principal_stretches(c)), -given.b * z * x.dx(0)
        dx = ufl.Measure("dx", mesh, metadata={"quadrature_degree": 2 * degree})
        self.quadrature_degree = quadrature_degree(strain * dx)
        self._forms: dict[str, fem.Form] = {}
        for name, density in (("U", strain), ("W", pressure)):
            self._forms |= _with_derivatives(name, density, e, lambda part: fem.form(part * dx))
        self._forms["shear"] = fem.form(c[0, 1] ** 2 * dx)

    def __call__(self, e: float) -> dict[str, float]:
        """Columns at an amplitude."""
        self._amplitude.value = e
        found = {name: float(fem.assemble_scalar(form)) for name, form in self._forms.items()}
        return {"e": e, **found}


def _with_derivatives(
    name: str, density: Expr, e: Expr, compiled: Callable[[Expr], fem.Form]
) -> dict[str, fem.Form]:
    """A functional with its first and second derivative with respect to the amplitude."""
    first = ufl.diff(density, e)
    second = ufl.diff(first, e)
    return {
        name: compiled(density),
        f"{name}_e": compiled(first),
        f"{name}_ee": compiled(second),
    }


class PatchFamily:
    """All amplitudes up to an end, on a family of meshes."""

    name = "primary"
    failures: Sequence[Failure] = ()
    absent: Sequence[Absence] = ()
    warnings: Sequence[str] = ()

    def __init__(self, parameters: PatchParameters, numerics: PatchNumerics) -> None:
        self._given, self._cap = parameters, 2 * numerics.degree
        self._levels = [Patch(parameters, cells, numerics.degree) for cells in numerics.meshes]
        self.quadrature_degree = self._levels[-1].quadrature_degree

    def _quantities(self, e: float) -> dict[str, Quantity]:
        rows = [level(e) for level in self._levels]
        out = {}
        for name in rows[-1]:
            found = estimate([row[name] for row in rows], self._cap)
            out[name] = Quantity(float(found.value), float(found.uncertainty))
        return out

    def branch(self, with_uncertainty: bool = True) -> Branch:
        """Columns over the amplitude."""
        rows = [self._quantities(float(e)) for e in np.linspace(0, self._given.e_end, POINTS)]
        columns = {name: np.array([row[name].value for row in rows]) for name in rows[0]}
        spread = {name: np.array([row[name].uncertainty for row in rows]) for name in rows[0]}
        return Branch(self.name, "e", columns, spread if with_uncertainty else {})

    def special_points(self) -> list[SpecialPoint]:
        """None: a patch has no special points."""
        return []

    def state(self, name: str, value: float, crossing: int = 1, profile: np.ndarray | None = None) -> State:
        """The patch at an amplitude, and its shape.

        Raises:
            InputError: If the request does not give an amplitude.
        """
        if name != "e" or crossing != 1:
            raise InputError(f"wrinkled_patch: request a state by its amplitude e, not by {name}")
        fields: tuple[Field, ...] = ()
        if profile is not None:
            given = self._given
            x = given.a * profile + value * np.sin(given.n * profile)
            z = given.c + value * np.cos(given.n * profile)
            fields = (Field("profile", {"X": profile, "x": x, "z": z}, {"X": 0.0, "x": 1e-15, "z": 1e-15}),)
        return State({name: value}, self.name, self._quantities(value), fields)


class WrinkledPatch(BranchProblem):
    """A flat wrinkled patch, perturbed so that the direction of tension keeps its stretch."""

    about = WRINKLED_PATCH
    parameters = PatchParameters
    numerics = PatchNumerics
    surfaces = True

    def check(self, parameters: PatchParameters, requests: Requests) -> None:
        """Refuse requests for states without a solution.

        Raises:
            InputError: For a column that cannot be prescribed.
        """
        super().check(parameters, requests)
        require_foldable(self.name, parameters, invariants=False)
        for wanted in requests.states:
            if not 0 <= wanted.value <= 1:
                raise InputError(f"wrinkled_patch: e = {wanted.value:g}; allowed: from 0 to 1")

    def ends(self, parameters: PatchParameters, _branch: str) -> list[End]:
        """The largest amplitude."""
        return [End("e_end", "e", parameters.e_end)]

    def families(self, task: Task) -> dict[str, Family]:
        """The only branch, which every rank solves completely."""
        parameters, numerics = task.parameters, task.numerics
        return {"primary": PatchFamily(parameters, numerics)}

    def points(self, parameters: PatchParameters) -> np.ndarray:
        """20 points for each wave."""
        waves = math.ceil(parameters.n * parameters.Lx / (2 * math.pi))
        return np.linspace(0.0, parameters.Lx, 20 * waves + 1)
