"""Problem ``sheet``: parameters, and the branch over the shear, the stretch or the curvature of the edges."""

from __future__ import annotations

from typing import ClassVar, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from weakforms.errors import InputError
from weakforms.problems.branch_problem import BranchProblem, Family, MeshNumerics
from weakforms.problems.material_choice import MaterialChoice, require_foldable
from weakforms.problems.meridian.limits import limit_of
from weakforms.problems.meridian.pre_stretch import require_bearable, require_taut
from weakforms.problems.problem import End, Needs, Requests, Task, TogetherError
from weakforms.problems.sheet.about import SHEET
from weakforms.problems.sheet.bent import BentFamily
from weakforms.problems.sheet.model import Sheet, SheetModel
from weakforms.solvers.continuation.branch import EquilibriumBranch
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, StepControl
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.uncertainty.family import BranchFamily

FEWEST = 2
"""Number of points that a branch keeps."""

SHARE = 0.125
"""Largest step of a bent sheet over its last curvature, which is small if the sheet is hardly stretched."""

INNERMOST = 0.9
"""Largest curvature over the one at which the inner guide has no radius."""

ABSENT: dict[str, set[str]] = {
    "shear": {"M"},
    "stretch": {"M"},
    "strip": {"M", "f_w", "f_s"},
    "bend": {"tau", "T_y"},
}
"""Columns that a loading does not have."""


class SheetNumerics(MeshNumerics):
    """Meshes of the sheet: squares across its width, each cut into four triangles."""

    degree: int = Field(2, ge=1, le=2, description="polynomial degree of the unknowns")
    cells: int = Field(8, ge=2, le=256, description="squares across the width on the finest mesh")
    levels: int = Field(2, ge=2, le=4, description="meshes, each twice as fine as the one before")
    step: float = Field(
        0.04,
        ge=0.005,
        le=0.5,
        description="largest arc-length step; of a bent sheet at most an eighth of kap_end",
    )
    start: float = Field(
        0.02,
        ge=1e-4,
        le=0.1,
        description="gam, lam - 1, or kap/(lam0 - 1) of the first point: without load a sheet may be slack",
    )


class SheetParameters(MaterialChoice):
    """The sheet, its edges and their motion."""

    ratio: ClassVar[str] = "alpha"
    needs: ClassVar[Needs] = {
        **dict.fromkeys(("s", "energy"), ({"loading": ("shear", "stretch", "bend")},)),
        **dict.fromkeys(("lam0", "kap_end"), ({"loading": ("bend",)},)),
        "gam_end": [{"loading": ("shear",)}],
        "lam_end": [{"loading": ("stretch", "strip")}],
    }
    movable: ClassVar = {"gam_end": "le", "lam_end": "le", "kap_end": "le"}

    loading: Literal["shear", "stretch", "strip", "bend"] = Field(
        "shear",
        description="shear: the edge Y = 1 moves along X; stretch: the sheet is pulled in X, its width held; "
        "strip: it is pulled in X and finds its width; bend: it is stretched and then bent in its plane",
    )
    c: float = Field(1.0, ge=0.25, le=8, description="length over width of the stress-free sheet")
    s: float = Field(1.0, ge=0.5, le=3, description="stretch of the edges in Y")
    lam0: float = Field(1.1, ge=1.002, le=3, description="stretch in X before the sheet is bent")
    alpha: float = Field(0.1, ge=0, le=1, description="C2/C1 of mooney_rivlin; 0 is neo-Hookean")
    energy: Literal["relaxed", "full"] = Field(
        "relaxed",
        description="relaxed: the sheet bears no compression; full: it bears compression",
    )
    gam_end: float = Field(1.0, gt=0.1, le=5, description="shear at which the branch ends")
    lam_end: float = Field(2.0, gt=1.1, le=10, description="stretch in X at which the branch ends")
    kap_end: float = Field(0.5, ge=0.01, le=2, description="curvature at which the branch ends")

    @model_validator(mode="after")
    def _in_tension(self) -> Self:
        if self.loading in ("shear", "bend") and self.s < 1:
            raise TogetherError(
                f"s = {self.s:g} with loading = {self.loading!r}: a narrowed sheet is slack at first; "
                "allowed: s from 1, or loading = 'stretch'"
            )
        return self

    @property
    def sheet(self) -> Sheet:
        """The sheet. A strip takes the full energy: at its own width both are equal, and this is smooth."""
        if self.loading == "strip":
            return Sheet(self.material, self.loading, self.c, relaxed=False)
        begin = self.lam0 if self.loading == "bend" else 1.0
        return Sheet(self.material, self.loading, self.c, self.s, begin, self.energy == "relaxed")

    @property
    def end(self) -> tuple[str, float]:
        """Name of the parameter that ends the branch, and its value."""
        name = f"{self.sheet.control}_end"
        return name, getattr(self, name)


class SheetProblem(BranchProblem):
    """A flat sheet in its plane, sheared, stretched or bent."""

    about, parameters, numerics = SHEET, SheetParameters, SheetNumerics
    surfaces = True

    def check(self, parameters: SheetParameters, requests: Requests) -> None:
        """Refuse laws without a relaxed form, stretches beyond a law's limit, and states of another loading.

        Raises:
            InputError: With a message that names the value and the allowed ones.
        """
        super().check(parameters, requests)
        require_foldable(self.name, parameters, invariants=True)
        require_taut(self.name, parameters.material, max(parameters.s, 1.0), "s")
        loading, control = parameters.loading, parameters.sheet.control
        if loading == "bend":
            require_bearable(self.name, parameters.material, parameters.lam0, parameters.s, "lam0")
            largest = INNERMOST * 2 * parameters.lam0 / parameters.s
            if parameters.kap_end > largest:
                raise InputError(
                    f"sheet: kap_end = {parameters.kap_end:g} leaves the inner guide nearly no radius; "
                    f"allowed: up to {largest:.4g} with these lam0 and s"
                )
        absent = ({"gam", "lam", "kap"} - {control}) | ABSENT[loading]
        for wanted in requests.states:
            if wanted.name in absent:
                raise InputError(
                    f"sheet: with loading = {loading!r} there is no column {wanted.name}; its load is "
                    f"{control}"
                )

    def ends(self, parameters: SheetParameters, _branch: str) -> list[End]:
        """The last shear, stretch or curvature."""
        name, value = parameters.end
        return [End(name, parameters.sheet.control, value, largest=True)]

    def families(self, task: Task) -> dict[str, Family]:
        """The branch on all meshes."""
        given, numerics = task.parameters, task.numerics

        def make(level: int) -> EquilibriumBranch:
            task.progress("branch", level, numerics.levels)
            model = SheetModel(task.comm, given.sheet, numerics.meshes[level], numerics.degree)
            return traced(model, numerics, *given.end)

        across = (given.sheet.control, "Pi")
        about = make, numerics.levels, 2.0 * numerics.degree, across
        front = given.loading == "bend" and given.sheet.relaxed
        return {"primary": BentFamily(*about, numerics.cells) if front else BranchFamily(*about)}

    def points(self, parameters: SheetParameters) -> np.ndarray:
        """21 points of the diagonal, by their ``X``."""
        return np.linspace(0.0, parameters.c, 21)


def traced(model: SheetModel, numerics: SheetNumerics, by: str, end: float) -> EquilibriumBranch:
    """The branch from a small shear or stretch, or a small curvature, to its end or to the limit of the law.

    Args:
        model: The sheet on one mesh.
        numerics: Its largest step and its start.
        by: The parameter that ends the branch.
        end: Its value.
    """
    system, control, law = model.system, model.sheet.control, model.sheet.law
    small = numerics.start * (model.sheet.lam0 - 1 if control == "kap" else 1.0)
    start = small + (control == "lam")
    step = min(numerics.step, SHARE * end) if control == "kap" else numerics.step
    steps = StepControl(first=step / 4, largest=step)
    continuation = Continuation(ExtendedNewton(system, [control]), control=steps)
    homogeneous = State(system.initial.u, system.initial.loads | {control: start})

    def limit(point: CurvePoint) -> str:
        l1, l2 = point.monitors["lam1"], point.monitors["lam2"]
        outer = model.sheet.lam0 + point.state.loads["kap"] * model.sheet.s / 2
        return limit_of(law, [(max(l1, outer), l2)])

    def necks(point: CurvePoint) -> bool:
        return model.sheet.loading == "strip" and point.n_negative > 0

    def stop(point: CurvePoint) -> bool:
        return point.state.loads[control] > end or necks(point) or bool(limit(point))

    begin = continuation.start(homogeneous, Held(control, start), towards={control: 1.0})
    branch = EquilibriumBranch(continuation, control, begin, stop)
    while necks(branch.points[-1]) and len(branch.points) > FEWEST:
        at = branch.points.pop().state.loads[control]
        branch.ended = (
            f"sheet: before {control} = {at:.6g} the force of the strip is largest; from there on it necks "
            f"at one place; lower {by}"
        )
    last = branch.points[-1]
    if branch.stalled is branch.ended is None and (why := limit(last)):
        branch.ended = f"sheet: at {control} = {last.state.loads[control]:.6g} {why}; lower {by}"
    return branch
