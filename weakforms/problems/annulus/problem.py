"""Problem ``annulus``: parameters, and the branch over the angle by which the inner edge is turned."""

from __future__ import annotations

from typing import ClassVar, Literal

import numpy as np
from pydantic import Field

from weakforms.errors import ConvergenceError, InputError
from weakforms.problems.annulus.about import ANNULUS
from weakforms.problems.annulus.model import FRONT, Ring
from weakforms.problems.annulus.phases import AnnulusPhases
from weakforms.problems.branch_problem import BranchProblem, Family, MeshNumerics
from weakforms.problems.material_choice import MaterialChoice, require_foldable
from weakforms.problems.meridian.pre_stretch import require_taut
from weakforms.problems.problem import End, Requests, Task
from weakforms.results import SpecialPoint
from weakforms.solvers.continuation.curve import SolutionCurve
from weakforms.solvers.continuation.pieces import Piece, PiecewiseFamily
from weakforms.solvers.uncertainty.family import BranchFamily
from weakforms.solvers.uncertainty.points import special_point

KIRCHHOFF = "saint_venant_kirchhoff"

EDGES = ("M_in", "M_out", "U_edges", "lam1_in", "lam1_out", "gw_in", "gw_out", FRONT)
"""Columns made of first derivatives at one point: their order is the degree."""


class AnnulusNumerics(MeshNumerics):
    """Meshes of the annulus: ``cells`` over the radius, half of them on either side of a front."""

    cells: int = Field(48, ge=8, le=20_000, description="cells on the finest mesh")
    step: float = Field(0.03, ge=0.005, le=0.5, description="largest arc-length step")
    start: float = Field(
        0.01, ge=1e-4, le=0.1, description="first angle with s = 1 and energy = relaxed: at 0 it is slack"
    )


class AnnulusParameters(MaterialChoice):
    """The sheet, its edges and the angle."""

    ratio: ClassVar[str] = "alpha"
    movable: ClassVar = {"psi_end": "le"}

    a: float = Field(0.4, ge=0.05, le=0.95, description="radius of the inner edge over that of the outer one")
    s: float = Field(1.0, ge=1, le=2, description="ratio in which both radii are stretched before the turn")
    alpha: float = Field(0.1, ge=0, le=1, description="C2/C1 of mooney_rivlin; 0 is neo-Hookean")
    energy: Literal["relaxed", "full"] = Field(
        "relaxed", description="relaxed: the sheet bears no compression; full: it bears compression"
    )
    psi_end: float = Field(0.5, gt=0, le=1, description="angle in radians at which the branch ends")


class Annulus(BranchProblem):
    """A flat annulus in its plane, both edges held, the inner one turned."""

    about, parameters, numerics = ANNULUS, AnnulusParameters, AnnulusNumerics

    def check(self, parameters: AnnulusParameters, requests: Requests) -> None:
        """Refuse laws without a relaxed form, and what has no solution.

        Raises:
            InputError: With a message that names the value and the allowed ones.
        """
        super().check(parameters, requests)
        require_foldable(self.name, parameters, invariants=True, others=[KIRCHHOFF])
        if parameters.model == KIRCHHOFF and parameters.energy == "full":
            raise InputError(
                f"annulus: model = {KIRCHHOFF!r} with energy = 'full' loses its ellipticity in compression; "
                "allowed: energy = 'relaxed'"
            )
        require_taut(self.name, parameters.material, parameters.s, "s")

    def ends(self, parameters: AnnulusParameters, _branch: str) -> list[End]:
        """The last angle."""
        return [End("psi_end", "psi", parameters.psi_end, largest=True)]

    def families(self, task: Task) -> dict[str, Family]:
        """The parts of the branch on all meshes."""
        runs = [_phases(task, level) for level in range(task.numerics.levels)]
        found = []
        for level, run in enumerate(runs):
            task.progress("branch", level, len(runs))
            found.append([part.zones for part in run.parts])
        if any(zones != found[-1] for zones in found):
            raise ConvergenceError(f"annulus: zones depend on the mesh, coarse to fine: {found}; raise cells")
        order = 2.0 * task.numerics.degree
        caps = dict.fromkeys(EDGES, float(task.numerics.degree))

        def piece(k: int, zones: str) -> Piece:
            def make(level: int) -> SolutionCurve:
                return runs[level].parts[k].curve

            family = BranchFamily(make, len(runs), order, across=("psi", "M"), caps=caps)
            fixed = {"taut": {FRONT: task.parameters.a}, "wrinkled": {FRONT: 1.0}}
            return Piece(family, fixed.get(zones, {}))

        def joints() -> list[SpecialPoint]:
            # What selects them is a column at an edge, and its error is in all others.
            same = [[run.parts[k].joint for run in runs] for k in range(len(found[-1]) - 1)]
            return [special_point(one, SHOWN, order / 2, "primary", "psi") for one in same]

        return {"primary": PiecewiseFamily([piece(k, zones) for k, zones in enumerate(found[-1])], joints)}

    def points(self, parameters: AnnulusParameters) -> np.ndarray:
        """41 radii from the inner to the outer edge."""
        return np.linspace(parameters.a, 1.0, 41)


SHOWN = [c.name for c in ANNULUS.columns if c.name not in (FRONT, "n_negative", "residual", "iterations")]


def _phases(task: Task, level: int) -> AnnulusPhases:
    given, numerics = task.parameters, task.numerics
    return AnnulusPhases(
        task.comm,
        Ring(given.material, given.a, given.s),
        given.energy == "relaxed",
        (min(numerics.start, given.psi_end / 2), given.psi_end),
        numerics.meshes[level],
        numerics.degree,
        numerics.step,
        level == numerics.levels - 1,
    )
