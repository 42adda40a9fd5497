"""Problems ``tube`` and ``tube_fold``: parameters and branches."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

import numpy as np
from mpi4py import MPI

from weakforms.errors import AbsentError, ConvergenceError, InputError
from weakforms.forms.materials.surface import LAWS
from weakforms.problems.branch_problem import BranchProblem, Family
from weakforms.problems.material_choice import MOONEY_RIVLIN, Chosen, require_model
from weakforms.problems.meridian.compression import compression
from weakforms.problems.meridian.limits import limit_along
from weakforms.problems.meridian.pre_stretch import require_stretched
from weakforms.problems.problem import End, Progress, Requests, Task
from weakforms.problems.tube.about import TUBE, TUBE_FOLD
from weakforms.problems.tube.contact_family import contact_family
from weakforms.problems.tube.model import FIRST_U, TubeMesh, TubeModel, fold_line_between, free_branch
from weakforms.problems.tube.parameters import (
    LONGEST_WHOLE,
    SecondaryNumerics,
    TubeFoldParameters,
    TubeNumerics,
    TubeParameters,
    resolving,
)
from weakforms.problems.tube.relaxed_family import (
    relaxed_contact_family,
    relaxed_family,
    require_relaxed_possible,
)
from weakforms.problems.tube.secondary import lopsided, surface
from weakforms.problems.tube.secondary.bent import bent_family
from weakforms.problems.tube.secondary.crossed import require_secondary_possible
from weakforms.problems.tube.secondary.imperfect import LEAST, detached_family, largest_step
from weakforms.problems.tube.secondary.lopsided import WholeTube, lopsided_family
from weakforms.problems.tube.secondary.lopsided_relaxed import relaxed_lopsided_family
from weakforms.problems.tube.secondary.wrinkled import wrinkled_family
from weakforms.problems.tube.stability import TubeBranch, TubeFamily
from weakforms.problems.tube.waves import EXTREMES, TubeModes
from weakforms.problems.wave_numbers import eigenvalue_names, require_waves
from weakforms.results import Absence, Failure
from weakforms.solvers.continuation.branch import EquilibriumBranch
from weakforms.solvers.continuation.curve import SolutionCurve
from weakforms.solvers.uncertainty.family import BranchFamily

SCANNED = 17
"""Number of pre-stretches at which a limit point is searched."""

MIDDLE = ("lam1_mid", "t1_mid")
"""Columns with first derivatives at the mid-plane."""


def order_at_middle(degree: int) -> float:
    """Order of stretches at the mid-plane: of the first even power that polynomials of a degree less miss.

    A stretch is an even function of the distance from the mid-plane, which is a vertex of the mesh.
    """
    return 2.0 * ((degree + 1) // 2)


class Tube(BranchProblem):
    """Inflation of a pre-stretched cylindrical membrane, free or constrained by a substrate."""

    about = TUBE
    parameters = TubeParameters
    numerics = SecondaryNumerics

    def check(self, parameters: TubeParameters, requests: Requests) -> None:
        """Refuse wrong combinations of parameters and requests.

        Raises:
            InputError: If phase or extent do not fit the contact, or a state cannot exist.
        """
        require_waves(self.name, parameters.n, (wanted.name for wanted in requests.states))
        super().check(parameters, requests)
        require_stretched(self.name, parameters.material, parameters.delta1, "delta1")
        if parameters.n or parameters.secondary_n:
            _require_waves_possible(parameters)
        require_secondary_possible(parameters, requests)
        if parameters.energy == "relaxed":
            require_relaxed_possible(parameters)
        if parameters.contact == "none" and parameters.phase == "deflation":
            raise InputError(
                "tube: phase = 'deflation' needs an inflation history; allowed with contact = 'adhesive'"
            )
        if parameters.contact == "frictionless" and parameters.phase == "deflation":
            raise InputError(
                "tube: frictionless contact has no history, it deflates as it inflates; "
                "phase = 'deflation' is allowed with contact = 'adhesive'"
            )
        if parameters.uneven and (parameters.contact != "none" or parameters.extent == "half"):
            raise InputError(
                f"tube: uneven = {parameters.uneven:g} with extent = {parameters.extent!r}, contact = "
                f"{parameters.contact!r}: allowed in free inflation of the whole tube; set extent = 'full', "
                "contact = 'none'"
            )
        if 0 < abs(parameters.uneven) < LEAST:
            raise InputError(
                f"tube: uneven = {parameters.uneven:g} is too small for its branches to be told apart; "
                f"allowed: 0, or a magnitude from {LEAST:g} to 0.5"
            )
        if parameters.extent == "full" and parameters.lf > LONGEST_WHOLE:
            raise InputError(
                f"tube: lf = {parameters.lf:g} with extent = 'full': nothing that can be computed holds a "
                f"bulge in the middle of so long a tube; allowed: lf up to {LONGEST_WHOLE:g}, or "
                "extent = 'half'"
            )

    def computed(self, parameters: TubeParameters) -> tuple[str, ...]:
        """The lowest eigenvalues."""
        return ("eigenvalue_1", *(name for n in parameters.stability for name in eigenvalue_names(n)))

    def ends(self, parameters: TubeParameters, branch: str) -> list[End]:
        """Where free inflation, its lopsided states, contact and deflation end."""
        if branch == "secondary" and parameters.uneven:
            return [
                End("u_end", "V", None, "its volume is that at which free inflation of an even tube ends")
            ]
        if branch == "secondary":
            amplitude = surface.AMPLITUDE if parameters.secondary_n else lopsided.AMPLITUDE
            joined = End("primary", amplitude, 0.0, "it joins free inflation again")
            return [joined, End("u_end", "V", None, "its volume is that at the end of free inflation")]
        if parameters.contact == "none":
            return [End("u_end", "u_max", parameters.u_end, largest=True)]
        begins = parameters.phase == "deflation"
        highest = End("p_end", "p", parameters.p_end, largest=True, begins=begins)
        if not begins:
            return [highest]
        empty = End("unloaded", "p", 0.0, "deflation ends without pressure")
        return [empty, End("slack", "u_max", FIRST_U, "the tube is slack"), highest]

    def families(self, task: Task) -> dict[str, Family]:
        """The branch on all meshes: free, or in contact."""
        parameters, numerics, comm, progress = task.parameters, task.numerics, task.comm, task.progress
        if parameters.contact != "none":
            made = relaxed_contact_family if parameters.energy == "relaxed" else contact_family
            return {"primary": made(parameters, numerics, comm, progress)}
        if parameters.secondary:
            return self._with_secondary(task)
        caps = dict.fromkeys(MIDDLE, order_at_middle(numerics.degree))
        if parameters.energy == "relaxed":
            return {"primary": relaxed_family(parameters, numerics, comm, progress, caps)}
        make, order = branch_maker(parameters, numerics, comm, progress), 2 * numerics.degree
        if not parameters.n:
            return {"primary": BranchFamily(make, numerics.levels, order, across=("p", "u_max"), caps=caps)}
        return {"primary": _with_stability(make, numerics)}

    def _with_secondary(self, task: Task) -> dict[str, Family]:
        """Free inflation, of the law's energy with its stability, and a secondary branch if there is one."""
        parameters, numerics, progress = task.parameters, task.numerics, task.progress
        given = parameters, numerics, task.comm, progress
        primary = crossed = _with_stability(branch_maker(*given), numerics)
        told, number, step = primary, parameters.secondary_from, numerics.step
        if parameters.energy == "relaxed":
            primary = relaxed_family(*given, dict.fromkeys(MIDDLE, order_at_middle(numerics.degree)))
            told = primary.pieces[-1].family
        try:
            if parameters.uneven:
                even = parameters.model_copy(update={"uneven": 0.0})
                crossed = _with_stability(branch_maker(even, numerics, task.comm, progress), numerics)
                secondary = detached_family(crossed, parameters.uneven, number, step, progress)
            elif parameters.energy == "relaxed":
                made = wrinkled_family if parameters.secondary_n else relaxed_lopsided_family
                secondary = made(parameters, numerics, crossed, primary, task.comm, progress)
            elif parameters.secondary_n:
                secondary = bent_family(parameters, numerics, primary, task.comm, progress)
            else:
                secondary = lopsided_family(primary, number, step, progress)
        except (AbsentError, ConvergenceError) as error:
            if any(wanted.branch == "secondary" for wanted in task.requests.states):
                raise
            if isinstance(error, AbsentError):
                told.absent.append(Absence(error.what, str(error)))
            else:
                told.failures.append(Failure("secondary branch", str(error)))
            return {"primary": primary}
        return {"primary": primary, "secondary": secondary}

    def remarks(
        self, parameters: TubeParameters, numerics: TubeNumerics, families: Mapping[str, Family]
    ) -> list[str]:
        """Where the ordinary tube is compressed; with wave numbers special points say it."""
        if parameters.energy == "relaxed" or parameters.stability:
            return []
        end = ("u_max", parameters.u_end, 1) if parameters.contact == "none" else None
        if parameters.phase == "deflation":
            end = "p", 0.0, -1
        place = "Z" if parameters.extent == "half" else "|Z|"
        where = compression(families["primary"], place, numerics.degree, end)
        try:
            require_relaxed_possible(parameters)
            instead = "energy = relaxed lets it wrinkle"
        except InputError:
            instead = "a real one wrinkles there"
        return [f"the tube {where}; {instead}"] if where else []

    def resolving(self, parameters: TubeParameters, numerics: TubeNumerics) -> TubeNumerics:
        """More cells for long tubes."""
        return resolving(parameters.lf, numerics)

    def points(self, parameters: TubeParameters) -> np.ndarray:
        """61 points over the body; 241 with the relaxed energy, whose resultants have kinks at the fronts."""
        half, count = parameters.lf / 2, 241 if parameters.energy == "relaxed" else 61
        return np.linspace(-half if parameters.extent == "full" else 0.0, half, count)


def _require_waves_possible(parameters: TubeParameters) -> None:
    """Refuse waves around a tube in contact, or of a law without a form for them."""
    if parameters.contact != "none":
        raise InputError(
            f"tube: n = {','.join(map(str, parameters.n))} with contact = {parameters.contact!r}: stability "
            "against waves is computed for free inflation; set contact = 'none', or n = ()"
        )
    require_model("tube: waves around the axis", parameters, tuple(LAWS))


def _with_stability(make: Callable[[int], SolutionCurve], numerics: TubeNumerics) -> TubeFamily:
    """Free inflation with its stability on all meshes."""
    # Resultants are derivatives: inside of a cell they have the order of the degree.
    caps = dict.fromkeys(EXTREMES, float(numerics.degree))
    caps |= dict.fromkeys(MIDDLE, order_at_middle(numerics.degree))
    return TubeFamily(make, numerics.levels, 2 * numerics.degree, ("p", "u_max"), caps=caps)


def branch_maker(
    parameters: TubeParameters, numerics: TubeNumerics, comm: MPI.Intracomm, progress: Progress
) -> Callable[[int], SolutionCurve]:
    """The branch of free inflation on the mesh of a level, with its stability if wave numbers are given."""

    def make(level: int) -> SolutionCurve:
        progress("branch", level, numerics.levels)
        at = TubeMesh(
            numerics.meshes[level],
            numerics.degree,
            numerics.grading,
            full=parameters.extent == "full",
        )
        whole = parameters.extent == "full" and (parameters.secondary or parameters.uneven)
        tube, uneven = (WholeTube, parameters.uneven) if whole else (TubeModel, None)
        model = tube.free(comm, parameters.material, parameters.delta1, parameters.lf, at, uneven)
        kind: Callable[..., SolutionCurve] = EquilibriumBranch
        if parameters.stability:
            modes = TubeModes(model, parameters.stability, at.full)
            hidden = () if parameters.uneven else tube.hidden
            kind = partial(TubeBranch, modes=modes, hidden=hidden)
        limit = limit_along(model)
        step = largest_step(numerics.step, parameters.uneven)
        branch = free_branch(model.system, parameters.delta1, parameters.u_end, step, kind, limit)
        if isinstance(branch, TubeBranch):
            branch.end, branch.limit = parameters.u_end, limit
        if branch.ended is not None:
            branch.ended = f"tube: {branch.ended}; lower u_end"
        if branch.stalled is not None:
            branch.stalled += f" (on {at.cells} cells); lower u_end, or raise cells if a solve failed"
        return branch

    return make


class TubeFold(BranchProblem):
    """Limit points of free inflation over the pre-stretch, through the cusp in which they merge."""

    about = TUBE_FOLD
    parameters = TubeFoldParameters
    numerics = TubeNumerics

    def check(self, parameters: TubeFoldParameters, requests: Requests) -> None:
        """Refuse a pre-stretch that the law does not take.

        Raises:
            InputError: With a message that names ``delta1_end``.
        """
        super().check(parameters, requests)
        end = parameters.delta1_end
        require_stretched(self.name, parameters.material, end, "delta1_end")

    def ends(self, parameters: TubeFoldParameters, _branch: str) -> list[End]:
        """The ends of the range of pre-stretches."""
        start = End("unstretched", "delta1", 1.0, "the line returns to a tube without pre-stretch")
        return [End("delta1_end", "delta1", parameters.delta1_end, largest=True), start]

    def families(self, task: Task) -> dict[str, Family]:
        """The first limit point at one end of the pre-stretches, followed on all meshes."""
        parameters, numerics, comm, progress = task.parameters, task.numerics, task.comm, task.progress
        given = {n: v for n, v in parameters.model_dump().items() if n != "delta1_end"}
        ends = 1.0, parameters.delta1_end

        def branch(delta1: float, level: int) -> EquilibriumBranch:
            tube = TubeParameters(**given, delta1=delta1)
            return branch_maker(tube, numerics, comm, progress)(level)

        start = _fold_start(parameters, lambda delta1: bool(len(branch(delta1, 0).turns())))

        def make(level: int) -> SolutionCurve:
            equilibria = branch(start, level)
            if not len(equilibria.turns()):
                raise ConvergenceError(
                    f"tube_fold: delta1 = {start:g}: a limit point on {numerics.meshes[0]} cells, but "
                    f"none on {numerics.meshes[level]}: raise cells"
                )
            return fold_line_between(equilibria, ends, numerics.step)

        return {
            "primary": BranchFamily(make, numerics.levels, 2 * numerics.degree, across=("delta1", "u_max"))
        }

    def resolving(self, parameters: TubeFoldParameters, numerics: TubeNumerics) -> TubeNumerics:
        """More cells for long tubes."""
        return resolving(parameters.lf, numerics)

    def points(self, parameters: TubeFoldParameters) -> np.ndarray:
        """61 points from the mid-plane to the disk."""
        return np.linspace(0, parameters.lf / 2, 61)


def _fold_start(parameters: TubeFoldParameters, has_limit_point: Callable[[float], bool]) -> float:
    """Pre-stretch at which a fold line starts: 1, or else ``delta1_end``.

    Raises:
        AbsentError: When no limit point is anywhere between; says what was searched.
        InputError: When there is one between only.
    """
    low, high = 1.0, parameters.delta1_end
    for delta1 in (low, high):
        if has_limit_point(delta1):
            return delta1
    scanned = np.linspace(low, high, SCANNED)
    inside = [float(delta1) for delta1 in scanned[1:-1] if has_limit_point(float(delta1))]
    if inside:
        raise InputError(
            f"tube_fold: no limit point at delta1 = 1 or delta1_end = {high:g}, where a fold line is begun; "
            f"there are some from delta1 = {inside[0]:.4g} to {inside[-1]:.4g}: set delta1_end to one"
        )
    raise AbsentError(
        "fold line",
        f"tube_fold: no limit point of {_named(parameters.material)}, lf = {parameters.lf:g} up to "
        f"u_max = {parameters.u_end:g} at any of {SCANNED} pre-stretches from 1 to delta1_end = {high:g}: no "
        f"fold line to follow; change the law or lf, or raise u_end or delta1_end (allowed: up to 10 and 5)",
    )


def _named(chosen: Chosen) -> str:
    """A law and its constants as text."""
    model = () if chosen.model == MOONEY_RIVLIN else (f"model = {chosen.model}",)
    return ", ".join((*model, *(f"{name} = {value:g}" for name, value in chosen.constants)))
