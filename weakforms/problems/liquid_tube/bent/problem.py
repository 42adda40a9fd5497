"""Problem ``fluid_tube_surface``: the whole surface near its bifurcation, half or full circumference.

This problem shows the effect of a mesh on the symmetry of the circle. On the full circumference the critical
eigenvalue is double, because its mode can be rotated. On the mirror-symmetric half it is single, with the
same zero and the same secondary branch. A mesh that is not uniform around splits the pair.
"""

from __future__ import annotations

from typing import ClassVar, Literal, Self

import numpy as np
from mpi4py import MPI
from numpy.polynomial import chebyshev
from pydantic import Field, model_validator

from weakforms.errors import AbsentError, ConvergenceError, InputError
from weakforms.forms.materials.surface import LAWS
from weakforms.problems.liquid_tube.bent.about import FLUID_TUBE_SURFACE
from weakforms.problems.liquid_tube.bent.bifurcation_point import READINGS, displacement, position, turned
from weakforms.problems.liquid_tube.bent.model import SurfaceModel
from weakforms.problems.liquid_tube.bent.surface import SurfaceData
from weakforms.problems.liquid_tube.critical import AxisymmetricState, PrimaryBranch
from weakforms.problems.material_choice import MaterialChoice, require_model
from weakforms.problems.meridian.pre_stretch import require_bearable, require_width
from weakforms.problems.problem import Numerics, Problem, Requests, Task
from weakforms.results import Absence, Failure, Quantity, Result
from weakforms.solvers.continuation.walk import walk
from weakforms.solvers.equilibrium.constraints import Held, Plane
from weakforms.solvers.equilibrium.newton import STOPPING, ExtendedNewton
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.spectra import Stability
from weakforms.solvers.support.provenance import quadrature_degree
from weakforms.solvers.support.roots import root

NODES, SPAN = 6, 0.01
"""Number of volumes over which the zero is interpolated, and the relative half width of their Chebyshev
grid."""

FARTHEST = 0.1
"""The bifurcation of a mesh is sought up to this relative difference of its volume from that of the
axisymmetric branch's bifurcation."""

LOOKED_AT = 12
"""Number of eigenvalues near zero among which those of the ``n = 1`` modes are searched."""


SMALLEST = 0.02
"""Smallest displacement of a bent state; below, the bifurcation is too near for Newton's method."""


class WholeNumerics(Numerics):
    """One mesh only, because the problem shows effects of the mesh."""

    cells: int = Field(16, ge=4, le=64, description="cells along the tube; as many around the circumference")
    degree: int = Field(3, ge=2, le=5, description="polynomial degree of the unknowns")

    @model_validator(mode="after")
    def _quarters(self) -> Self:
        if self.cells % 4:
            raise ValueError("cells must be a multiple of 4")
        return self


class WholeParameters(MaterialChoice):
    """The tube, its liquid, and how much of the circumference is modelled."""

    ratio: ClassVar[str] = "alpha"

    L: float = Field(8.0, ge=2, le=40, description="stretched length over the radius")
    delta: float = Field(2.0, gt=1, le=10, description="axial pre-stretch")
    gamma: float = Field(0.116, gt=0, le=2, description="rho g A^2/(mu H)")
    alpha: float = Field(0.0, ge=0, le=1, description="C2/C1 of mooney_rivlin; 0 is neo-Hookean")
    extent: Literal["half", "full"] = Field(
        "full", description="mirror-symmetric half, or the full circumference"
    )
    uneven: float = Field(0.0, ge=0, le=0.5, description="unevenness of the mesh around the axis (full only)")
    amplitude: float = Field(
        0.1,
        ge=-0.2,
        le=0.2,
        description="root mean square displacement of the bent state; negative: to the other side",
    )

    @model_validator(mode="after")
    def _bent(self) -> Self:
        if abs(self.amplitude) < SMALLEST:
            raise ValueError(f"amplitude must be at least {SMALLEST:g}, to either side")
        return self


class FluidTubeSurface(Problem):
    """Numbers of the whole surface at and near its ``n = 1`` bifurcation, on one mesh."""

    about = FLUID_TUBE_SURFACE
    parameters = WholeParameters
    numerics = WholeNumerics

    def check(self, parameters: WholeParameters, requests: Requests) -> None:
        """Refuse requests for states, which do not exist, and what the ranges of single parameters cannot.

        Raises:
            InputError: For any of these.
        """
        require_model(self.name, parameters, tuple(LAWS))
        require_bearable(self.name, parameters.material, parameters.delta, 1.0, "delta")
        require_width(self.name, parameters.material, parameters.delta, "delta")
        if requests.states:
            raise InputError("fluid_tube_surface: it has no states; its numbers are quantities of any solve")
        if parameters.uneven and parameters.extent == "half":
            raise InputError(
                f"fluid_tube_surface: uneven = {parameters.uneven:g} needs extent = 'full'; "
                "allowed on the half: 0"
            )

    def finer(self, _parameters: WholeParameters, numerics: WholeNumerics) -> WholeNumerics | None:
        """A mesh with half as many cells more, unless their number was asked for."""
        given = "cells" in numerics.model_fields_set
        return None if given else WholeNumerics(cells=numerics.cells * 3 // 2, degree=numerics.degree)

    def fill(self, result: Result, task: Task) -> None:
        """Locate the bifurcation on the surface's mesh and solve for a state of the branch that starts there.

        The numbers belong to the mesh and have no uncertainty.
        """
        parameters, numerics, comm, progress = task.parameters, task.numerics, task.comm, task.progress
        try:
            run = WholeRun(parameters, numerics, comm)
        except AbsentError as error:
            result.absent.append(Absence(error.what, f"fluid_tube_surface: {error}"))
            return
        degree = quadrature_degree(run.system.formulation.residual)
        result.numerics |= {"stopping": STOPPING, "quadrature_degree": degree}
        for i, (what, part) in enumerate({"bifurcation": run.critical, "bent state": run.bent}.items()):
            progress(what, i, 2)
            try:
                result.quantities |= {name: Quantity(value) for name, value in part().items()}
            except ConvergenceError as error:
                result.failures.append(Failure(what, str(error)))


class WholeRun:
    """The surface on one mesh, started from the axisymmetric branch."""

    def __init__(self, parameters: WholeParameters, numerics: WholeNumerics, comm: MPI.Intracomm) -> None:
        self.amplitude = parameters.amplitude
        self.full = parameters.extent == "full"
        given = parameters.L, parameters.delta, parameters.gamma, parameters.alpha
        self.primary = PrimaryBranch(comm, *given, parameters.other_law)
        given = (*given, numerics.cells, numerics.cells // 2, numerics.degree)
        data = SurfaceData(*given, self.full, parameters.uneven, material=parameters.other_law)
        self.model = SurfaceModel(comm, data)
        self.system = self.model.system
        self.begin = self.primary.bifurcation(np.linspace(0, data.length, READINGS))
        mode = displacement(self.begin)
        shapes = [mode, turned(mode)] if self.full else [mode]
        self.modes = [self._unit(self.model.interpolated(shape)) for shape in shapes]
        self.rows = [self.system.mass_times(mode) for mode in self.modes]
        self.size = float(np.sqrt(2 * np.pi * data.length))
        scalars = ["zw", "phase"] if self.full else ["zw"]
        self.solver = ExtendedNewton(self.system, scalars)
        if self.full:
            self.model.partner.x.array[: self.system.size] = self.modes[1]
            self.model.partner.x.scatter_forward()

    def _unit(self, mode: np.ndarray) -> np.ndarray:
        mode[self.system.bc_dofs] = 0.0
        return mode / np.sqrt(self.system.dot(mode, self.system.mass_times(mode)))

    def _guess(self, at: AxisymmetricState) -> State:
        loads = {"zw": at.values["zw"]} | ({"phase": 0.0} if self.full else {})
        return self.model.state_of(position(at), loads)

    def _no_rotation(self) -> list[Plane]:
        """Condition of no displacement along the rotated mode, so that a bent state cannot rotate."""
        return [Plane(self.rows[1], {}, 0.0)] if self.full else []

    def critical(self) -> dict[str, float]:
        """The point where the (mean) eigenvalue of the ``n = 1`` modes is zero, and the pair there."""
        at_zero, rows = self._around_zero()
        x = chebyshev.chebpts1(NODES)
        fits = {
            "mean": chebyshev.chebfit(x, [np.mean(row[1]) for row in rows], NODES - 1),
            "zw": chebyshev.chebfit(x, [row[0] for row in rows], NODES - 1),
            "pair": chebyshev.chebfit(x, np.array([row[1] for row in rows]), NODES - 1),
            "next": chebyshev.chebfit(x, [row[2] for row in rows], NODES - 1),
        }
        zero = root(lambda s: chebyshev.chebval(s, fits["mean"]), -1, 1, "the bifurcation", xtol=1e-14)
        pair = np.sort(np.atleast_1d(chebyshev.chebval(zero, fits["pair"])))
        other = float(chebyshev.chebval(zero, fits["next"]))
        out = {
            "zw_bifurcation": float(chebyshev.chebval(zero, fits["zw"])),
            "V_bifurcation": at_zero * (1 + SPAN * zero),
            "Lambda_pair_1": float(pair[0]),
            "multiplicity": float(np.sum(np.abs(pair) < 1e-9 * other)),
        }
        if self.full:
            out |= {"Lambda_pair_2": float(pair[1]), "Lambda_split": float(pair[1] - pair[0])}
        return out

    def _around_zero(self) -> tuple[float, list[tuple[float, np.ndarray, float]]]:
        """A volume, and states within :data:`SPAN` of it, among which the eigenvalue changes sign.

        The bifurcation of a coarse mesh is sought from the axisymmetric one; a chord leads to it.
        """
        begin = centre = self.begin.values["V"]
        while abs(centre / begin - 1) < FARTHEST:
            rows = [self._near(centre * (1 + SPAN * s)) for s in chebyshev.chebpts1(NODES)]
            first, last = (float(np.mean(rows[k][1])) for k in (0, -1))
            if np.sign(first) != np.sign(last):
                return centre, rows
            centre *= 1 + SPAN * (first + last) / (first - last) if first != last else 2
        raise ConvergenceError(f"the n = 1 eigenvalue is not zero within {FARTHEST:g} of V = {begin:g}")

    def _near(self, volume: float) -> tuple[float, np.ndarray, float]:
        """At an axisymmetric state: ``zw``, eigenvalues of the ``n = 1`` modes, magnitude of the next one."""
        guess = self._guess(self.primary.at("V", volume, self.begin.Z))
        solver = ExtendedNewton(self.system, ["zw"])
        state, _ = solver.solve(guess, [Held("V", volume)])
        found = Stability(self.system).modes(state, LOOKED_AT)
        alike = [sum(self.system.dot(row, mode.vector) ** 2 for row in self.rows) for mode in found]
        order = np.argsort(alike)[::-1]
        count = len(self.rows)
        if alike[order[count - 1]] < 0.5:
            raise ConvergenceError("the n = 1 modes are not among the eigenvalues nearest to zero")
        values = np.array([mode.eigenvalue for mode in found])[order]
        return state.loads["zw"], np.sort(values[:count]), float(np.abs(values[count:]).min())

    def bent(self) -> dict[str, float]:
        """The secondary state with the prescribed displacement along the axisymmetric mode."""
        start = self._guess(self.begin)
        along = self.system.dot(self.rows[0], start.u)

        def solve(before: State, amplitude: float) -> State:
            target = along + amplitude * self.size
            guess, left = before.copy(), target - self.system.dot(self.rows[0], before.u)
            guess.u = guess.u + left * self.modes[0]
            return self.solver.solve(guess, [*self._no_rotation(), Plane(self.rows[0], {}, target)])[0]

        state = walk(solve, start, 0.0, self.amplitude, abs(self.amplitude))
        with self.system.at(state):
            values = self.system.monitors()
        nearest = Stability(self.system).modes(state, 1)[0]
        return {
            "zw_bent": state.loads["zw"],
            "V_bent": values["V"],
            "Pi_bent": values["Pi"],
            "Lambda_bent_1": nearest.eigenvalue,
            "phase": state.loads.get("phase", 0.0),
        }
