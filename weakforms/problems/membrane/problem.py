"""Problem ``membrane``: a membrane of any shape, given by its triangles, under gas or a liquid."""

from __future__ import annotations

import numpy as np

from weakforms.errors import InputError
from weakforms.problems.branch_problem import BranchProblem, Family
from weakforms.problems.material_choice import require_foldable
from weakforms.problems.membrane.about import MEMBRANE
from weakforms.problems.membrane.adapted import adapted
from weakforms.problems.membrane.branch import Start, traced
from weakforms.problems.membrane.family import MembraneFamily
from weakforms.problems.membrane.model import Body, MembraneModel
from weakforms.problems.membrane.parameters import MembraneNumerics, MembraneParameters
from weakforms.problems.meridian.pre_stretch import require_low, require_taut
from weakforms.problems.meridian.thickness import require_thickness
from weakforms.problems.problem import End, Requests, Task
from weakforms.problems.triangles.limits import require_light, require_own_load
from weakforms.results import Quantity, Result
from weakforms.solvers.stability.surface_family import FilledBranch

CAPS = dict.fromkeys(("S_least", "X_least", "Y_least", "Z_least", "f_w", "f_s"), 1.0)
"""Highest assumed orders: of a stress and a place among the points of quadrature, of an area."""

KIRCHHOFF = "saint_venant_kirchhoff"
"""A law without resistance to being flattened, for which only the relaxed energy is a problem statement."""

LARGEST = 2_000_000
"""Largest number of unknowns on the finest mesh."""


LOOKED_AT = 64
"""Triangles along the radius or half a side at whose nodes a thickness is looked at; of a file its mesh, once
refined."""

LEVEL = 0.05
"""Least horizontal area that the open edges of a surface under a liquid span, over its area."""


class Membrane(BranchProblem):
    """Inflation of a membrane of any shape."""

    about = MEMBRANE
    parameters = MembraneParameters
    numerics = MembraneNumerics
    surfaces = True

    def check(self, parameters: MembraneParameters, requests: Requests) -> None:
        """Refuse laws without a relaxed form, stretches beyond a law's end, and meshes that are no membrane.

        Raises:
            InputError: With a message that names the value and the allowed ones, or the place in the mesh.
        """
        super().check(parameters, requests)
        require_foldable(self.name, parameters, invariants=True, others=[KIRCHHOFF])
        if parameters.model == KIRCHHOFF and parameters.energy == "full":
            raise InputError(
                f"membrane: model = {KIRCHHOFF!r} with energy = 'full' loses its ellipticity in compression; "
                "allowed: energy = 'relaxed'"
            )
        require_low(self.name, parameters.material, parameters.w_end, parameters.energy == "relaxed")
        require_taut(self.name, parameters.material, parameters.delta, "delta")
        if parameters.is_loose and parameters.delta != 1:
            raise InputError(
                f"membrane: delta = {parameters.delta:g}: no edge is held, and edges that slide keep no "
                "pre-stretch; allowed: delta = 1"
            )
        if parameters.thickness is not None:
            x, y, z = parameters.surface(LOOKED_AT, 2, 1).points.T
            require_thickness(self.name, parameters.own_thickness, x, Y=y, Z=z)
        require_own_load(self.name, parameters.load, requests)
        if parameters.load == "liquid":
            stretches = {"delta": parameters.delta}
            require_light(self.name, parameters.material, parameters.gamma, stretches)
            _require_basin(parameters)

    def computed(self, _parameters: MembraneParameters) -> tuple[str, ...]:
        """The largest deflection, and the least stress, which is zero where the first wrinkle appears."""
        return ("w_max", "S_least")

    def ends(self, parameters: MembraneParameters, _branch: str) -> list[End]:
        """The last of the largest deflections."""
        return [End("w_end", "w_max", parameters.w_end, largest=True)]

    def families(self, task: Task) -> dict[str, Family]:
        """The branch of all states on all meshes.

        Raises:
            InputError: If the finest mesh is too large.
        """
        parameters, numerics = task.parameters, task.numerics
        levels = numerics.levels

        def trace(body: Body, what: str) -> FilledBranch:
            def passed(height: float) -> None:
                share = min(max(height / parameters.w_end, 0.0), 1.0)
                task.progress(f"branch, {what}", round(100 * share), 100)

            passed(0.0)
            start = Start(numerics.start, numerics.p_start)
            model = MembraneModel(task.comm, body)
            return traced(model, start, parameters.w_end, numerics.step, passed, parameters.gas)

        coarse = parameters.body(numerics, 0)
        if parameters.is_file:
            _require_few(parameters, numerics, coarse)
        if numerics.refine:
            coarse = adapted(coarse, numerics.refine, trace)
            _require_few(parameters, numerics, coarse)

        def make(level: int) -> FilledBranch:
            body = coarse.refined(level) if numerics.refine else parameters.body(numerics, level)
            return trace(body, f"mesh {level + 1} of {levels}")

        across = ("p", "V") if parameters.load == "gas" else ("zw", "w_c")
        return {"primary": MembraneFamily(make, levels, 2.0 * numerics.degree, across, caps=CAPS)}

    def fill(self, result: Result, task: Task) -> None:
        """As for any branch; also where the deflection is read."""
        reference = task.parameters.body(task.numerics, 0).reference
        result.quantities |= {
            f"{name}_c": Quantity(float(x))
            for name, x in zip("XYZ", reference.points[reference.centre], strict=True)
        }
        super().fill(result, task)

    def _answer(self, result: Result, families: dict[str, Family], task: Task) -> None:
        """As for any branch; also the number of triangles of each mesh."""
        meshes = families["primary"].levels
        result.numerics["triangles"] = [len(m.modes.model.body.reference.cells) for m in meshes]
        super()._answer(result, families, task)

    def points(self, _parameters: MembraneParameters) -> np.ndarray:
        """None along a line: fields are the corners and triangles of the surface."""
        return np.zeros(1)


def _require_few(parameters: MembraneParameters, numerics: MembraneNumerics, coarse: Body) -> None:
    """Refuse meshes with too many unknowns.

    Raises:
        InputError: With what to change.
    """
    finer = numerics.levels - 1
    unknowns = round(1.5 * numerics.degree**2 * len(coarse.reference.cells) * 4**finer)
    if unknowns > LARGEST:
        again = f" and refine = {numerics.refine}" if numerics.refine else ""
        raise InputError(
            f"membrane: mesh = {parameters.mesh} has about {unknowns} unknowns after {finer} "
            f"refinements{again}; allowed: {LARGEST}; choose a coarser mesh, or numerics levels = 2"
        )


def _require_basin(parameters: MembraneParameters) -> None:
    """Refuse surfaces on which a liquid has no potential, or of which no side is the upper one.

    Raises:
        InputError: With what to change.
    """
    if parameters.is_loose:
        raise InputError(
            f"membrane: load = 'liquid': no edge of mesh = {parameters.mesh} is held; allowed: a surface "
            "with held edges, or load = 'gas'"
        )
    given, up = parameters.surface(MembraneNumerics().cells, 1, 0), parameters.up
    if "Z" in given.mirrors:
        raise InputError(
            "membrane: load = 'liquid': a horizontal plane is no plane of symmetry of a liquid, whose "
            "pressure grows with depth; allowed: a file with that group in slide or held, or load = 'gas'"
        )
    moving = "".join(sorted({*given.mirrors, *given.slides} - {"Y"}))
    if parameters.tilt and moving:
        raise InputError(
            f"membrane: tilt = {parameters.tilt:g}: edges of mesh = {parameters.mesh} move in a plane "
            f"{moving[0]} = constant, which is not vertical; allowed: planes Y = constant, or tilt = 0"
        )
    if abs(span := given.slope(up)) < LEVEL:
        raise InputError(
            f"membrane: load = 'liquid': the open edges of mesh = {parameters.mesh} span a horizontal area "
            f"of {abs(span):.1g} times that of the surface, so that no side of it is the upper one; "
            f"allowed: from {LEVEL:g} on, such as sheets and bowls"
        )
