"""Problem ``fluid_tube``: parameters and branches."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from mpi4py import MPI

from weakforms.errors import AbsentError, ConvergenceError, InputError
from weakforms.forms.materials.surface import LAWS
from weakforms.problems.branch_problem import BranchProblem, Family, asked_crossings
from weakforms.problems.liquid_tube.about import FLUID_TUBE
from weakforms.problems.liquid_tube.bent.family import SecondaryFamily, secondary_family
from weakforms.problems.liquid_tube.branch import FluidPath
from weakforms.problems.liquid_tube.parameters import FluidTubeNumerics, FluidTubeParameters
from weakforms.problems.liquid_tube.relaxed import RelaxedBranch, require_relaxed_possible, tube_data
from weakforms.problems.liquid_tube.relaxed_bent import RelaxedSecondaryFamily
from weakforms.problems.material_choice import require_model
from weakforms.problems.meridian.compression import compression
from weakforms.problems.meridian.pre_stretch import has_bounded_force, require_bearable, require_width
from weakforms.problems.problem import End, Progress, Requests, Task, sample_points
from weakforms.results import Absence, Failure, Result
from weakforms.solvers.continuation.pieces import Piece, PiecewiseFamily
from weakforms.solvers.stability.modal import ModalBranch, ModalFamily

CAPS = {"r_mid": 4.0, "r_max": 4.0, **dict.fromkeys(("T1_ring", "T2_ring", "T1_mid", "T2_mid"), 2.0)}
"""Highest assumed orders of convergence at material points of a partially filled tube. Because cells follow
the front, the position of such a point in its cell varies: the error has the order of the elements, but its
size varies."""

MATERIAL = {"r_mid": "r", "r_max": "r", "T1_mid": "T1", "T2_mid": "T2"}
"""The columns at such points, each with the field that it evaluates."""

LONGEST_BENT = 8.0
"""Largest pre-stretch of the secondary branch: at 9 its points under heavy liquids are not all found."""

PARTLY_FILLED = "Z_front", "r_front"
"""Columns that only a partially filled tube has."""


class FluidTube(BranchProblem):
    """A pre-stretched cylindrical membrane filled with a liquid, under level control."""

    about = FLUID_TUBE
    parameters = FluidTubeParameters
    numerics = FluidTubeNumerics

    def check(self, parameters: FluidTubeParameters, requests: Requests) -> None:
        """Refuse what the ranges of single parameters cannot.

        Raises:
            InputError: For a state that cannot exist.
        """
        super().check(parameters, requests)
        require_model(self.name, parameters, tuple(LAWS))
        require_bearable(self.name, parameters.material, parameters.delta, 1.0, "delta")
        require_width(self.name, parameters.material, parameters.delta, "delta")
        if parameters.secondary and parameters.delta > LONGEST_BENT:
            raise InputError(
                f"fluid_tube: delta = {parameters.delta:g} is too large for secondary = true; "
                f"allowed: delta up to {LONGEST_BENT:g}"
            )
        if parameters.secondary and has_bounded_force(parameters.material):
            raise InputError(
                f"fluid_tube: secondary = true: the force of model = {parameters.model!r} is bounded, and a "
                "tube of it gives way while it bends; allowed with this law: secondary = false"
            )
        if parameters.energy == "relaxed":
            require_relaxed_possible(parameters, requests)
        for wanted in requests.states:
            if wanted.name == "zw" and wanted.value < 0:
                raise InputError(f"fluid_tube: zw = {wanted.value:g} is below the tube; allowed: zw >= 0")
            waves = wanted.name.removeprefix("Lambda_n")
            if waves.isdigit() and int(waves) > parameters.n_max:
                raise InputError(
                    f"fluid_tube: {wanted.name} is not computed; allowed: n up to n_max = {parameters.n_max}"
                )
            if wanted.branch == "secondary" and not parameters.secondary:
                raise InputError("fluid_tube: the secondary branch is solved for only with secondary = true")

    def finer(self, parameters: FluidTubeParameters, numerics: FluidTubeNumerics) -> FluidTubeNumerics | None:
        """Finer meshes along the tube, unless the secondary branch, on a surface, is wanted too."""
        return None if parameters.secondary else super().finer(parameters, numerics)

    def ends(self, parameters: FluidTubeParameters, branch: str) -> list[End]:
        """A level below the highest one, or for a law that stiffens its lowest value after that."""
        if branch == "secondary":
            return [End("secondary_end", "zw", None)]
        return [
            End("zw_end", "zw", lambda columns: parameters.zw_end * max(columns["zw"])),
            End("stiffening", "zw", None, "the level rises again, because the law stiffens"),
        ]

    def families(self, task: Task) -> dict[str, Family]:
        """The primary branch on all meshes, and the secondary one if it is requested and there is one."""
        parameters, numerics, comm, progress = task.parameters, task.numerics, task.comm, task.progress
        if parameters.energy == "relaxed":
            progress("primary branch", 0, 1)
            primary, bent = RelaxedBranch(parameters, numerics, comm), RelaxedSecondaryFamily
        else:
            primary, bent = primary_family(parameters, numerics, comm, progress), SecondaryFamily
        if not parameters.secondary:
            return {"primary": primary}
        try:
            secondary = secondary_family(parameters, numerics, comm, progress, bent)
        except AbsentError as error:
            if any(wanted.branch == "secondary" for wanted in task.requests.states):
                raise
            primary.missing.append(Absence("secondary branch", f"fluid_tube: {error}"))
            return {"primary": primary}
        return {"primary": primary, "secondary": secondary}

    def points(self, parameters: FluidTubeParameters) -> np.ndarray:
        """61 points from the lower ring to the upper one."""
        return np.linspace(0, parameters.L / parameters.delta, 61)

    def remarks(
        self, parameters: FluidTubeParameters, numerics: FluidTubeNumerics, families: Mapping[str, Family]
    ) -> list[str]:
        """Where the primary branch of the ordinary tube is compressed."""
        if parameters.energy == "relaxed":
            return []
        where = compression(families["primary"], "Z", numerics.degree)
        try:
            require_relaxed_possible(parameters)
            instead = "energy = relaxed lets it wrinkle"
        except InputError:
            instead = "a real one wrinkles there"
        return [f"the tube {where}; {instead}"] if where else []

    def _answer(self, result: Result, families: dict[str, Family], task: Task) -> None:
        """As for any problem; with the secondary branch, a state is computed on every branch that has it."""
        requests, progress, default_points = task.requests, task.progress, self.points(task.parameters)
        super()._answer(result, families, replace(task, requests=replace(requests, states=())))
        for i, wanted in enumerate(requests.states):
            progress("states", i, len(requests.states))
            points = sample_points(wanted.profile, default_points)
            names = list(families) if wanted.branch == "primary" else [wanted.branch]
            missing = []
            for name in names:
                for crossing, count in asked_crossings(result.branch(name), wanted):
                    try:
                        state = families[name].state(wanted.name, wanted.value, crossing, points)
                        result.states.append(replace(state, crossings=count))
                    except InputError as error:
                        missing.append(f"{name} branch: {error}")
                    except ConvergenceError as error:
                        what = f"state at {wanted.name} = {wanted.value:g}"
                        result.failures.append(Failure(what, f"{name} branch: {error}"))
            if len(missing) == len(names):
                raise self._not_reached(f"fluid_tube: {'; '.join(missing)}", result, wanted.branch)
        for family in families.values():  # those of states
            result.warnings.extend(text for text in family.warnings if text not in result.warnings)


def primary_family(
    parameters: FluidTubeParameters, numerics: FluidTubeNumerics, comm: MPI.Intracomm, progress: Progress
) -> PiecewiseFamily:
    """The primary branch on all meshes: dry, partially filled, full, partially filled again."""
    paths = []
    for level, cells in enumerate(numerics.meshes):
        progress("primary branch", level, numerics.levels)
        data = tube_data(parameters, numerics, cells)
        paths.append(FluidPath(comm, data, parameters.n_max, parameters.zw_end, numerics.step))
    counts = [len(path.pieces) for path in paths]
    if len(set(counts)) > 1:
        raise ConvergenceError(f"fluid_tube: the parts of the primary branch depend on the mesh: {counts}")

    def family(k: int) -> ModalFamily:
        def make(level: int) -> ModalBranch:
            return paths[level].pieces[k]

        still = {name: numerics.degree + float(name.startswith("r")) for name in CAPS}
        caps = CAPS if k % 2 else still  # without a front the mesh does not move
        moving = MATERIAL if k % 2 else {}
        return ModalFamily(
            make, numerics.levels, 2 * numerics.degree, across=("zw", "V"), caps=caps, points_of=moving
        )

    length = parameters.L / parameters.delta
    dry, full = (
        dict(zip(PARTLY_FILLED, (0.0, 1.0), strict=True)),
        dict(zip(PARTLY_FILLED, (length, np.nan), strict=True)),
    )
    fixed = [dry if k == 0 else full if k % 2 == 0 else {} for k in range(counts[0])]
    return PiecewiseFamily([Piece(family(k), given) for k, given in enumerate(fixed)])
