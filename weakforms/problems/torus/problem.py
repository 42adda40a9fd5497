"""Problem ``torus``: parameters, and the branch of a torus inflated by a gas."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Annotated, ClassVar

import numpy as np
from pydantic import Field

from weakforms.forms.materials.surface import LAWS
from weakforms.problems.branch_problem import BranchProblem, Family, MeshNumerics, from_rest
from weakforms.problems.material_choice import MaterialChoice, require_model
from weakforms.problems.meridian.families import WaveFamily
from weakforms.problems.meridian.limits import limit_along, relative_stiffness
from weakforms.problems.problem import End, Requests, Task
from weakforms.problems.torus.about import MOST_WAVES, TORUS
from weakforms.problems.torus.model import TorusModel
from weakforms.problems.torus.waves import TorusBranch, TorusModes
from weakforms.problems.wave_numbers import eigenvalue_names, require_waves, wave_numbers
from weakforms.solvers.continuation.branch import EquilibriumBranch
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.uncertainty.family import BranchFamily

USUAL_LOAD = 4.0
"""Pressure, times b and over the stiffness of the law, above which steps grow with it: two to three times the
limit point of a neo-Hookean torus."""


class TorusNumerics(MeshNumerics):
    """Meshes of the torus: ``cells`` from the outer to the inner equator."""

    start: float = Field(
        0.1,
        ge=0.01,
        le=1,
        description="pressure of the first state, times b and over the stiffness of the law; without "
        "pressure the membrane bends freely along the circles t = pi/2 and -pi/2",
    )


class TorusParameters(MaterialChoice):
    """The torus, its law, and where inflation ends."""

    ratio: ClassVar[str] = "alpha"
    movable: ClassVar = {"v_end": "le"}

    b: float = Field(
        0.4, ge=0.1, le=0.6, description="radius of the cross-section over that of the centre line"
    )
    alpha: float = Field(0.1, ge=0, le=1, description="C2/C1 of mooney_rivlin; 0 is neo-Hookean")
    v_end: float = Field(
        4.0, ge=1.5, le=20, description="volume over that of the stress-free torus at which the branch ends"
    )
    n: Annotated[tuple[int, ...], wave_numbers(MOST_WAVES)] = Field(
        (),
        description="wave numbers for which stability is computed, such as 0,1,2; 0: axisymmetric, also "
        "without the equatorial plane of symmetry",
    )


class Torus(BranchProblem):
    """Inflation of a torus, symmetric about its equatorial plane."""

    about, parameters, numerics = TORUS, TorusParameters, TorusNumerics

    def check(self, parameters: TorusParameters, requests: Requests) -> None:
        """Refuse eigenvalues of other wave numbers, and waves of a law without a form for them.

        Raises:
            InputError: For either.
        """
        require_waves(self.name, parameters.n, (wanted.name for wanted in requests.states))
        super().check(parameters, requests)
        if parameters.n:
            require_model("torus: waves around the axis", parameters, tuple(LAWS))

    def computed(self, parameters: TorusParameters) -> tuple[str, ...]:
        """The lowest eigenvalues."""
        return ("eigenvalue_1", *(name for n in parameters.n for name in eigenvalue_names(n)))

    def ends(self, parameters: TorusParameters, _branch: str) -> list[End]:
        """The last volume."""
        return [End("v_end", "v", parameters.v_end, largest=True)]

    def families(self, task: Task) -> dict[str, Family]:
        """The branch on all meshes."""
        given, numerics = task.parameters, task.numerics

        def make(level: int) -> EquilibriumBranch:
            task.progress("branch", level, numerics.levels)
            cells, degree = numerics.meshes[level], numerics.degree
            model = TorusModel(task.comm, given.material, given.b, cells, degree)
            limit = limit_along(model)
            kind: Callable[..., EquilibriumBranch] = EquilibriumBranch
            if given.n:
                kind = partial(TorusBranch, modes=TorusModes(model, given.n))
            usual = relative_stiffness(given.material) / given.b
            branch = from_rest(
                model.system,
                "p",
                "v",
                given.v_end,
                numerics.step,
                begin=State(model.system.initial.u, {"p": numerics.start * usual}),
                usual_load=USUAL_LOAD * usual,
                kind=kind,
                gives_way=lambda point: limit(point.state),
            )
            if isinstance(branch, TorusBranch):
                branch.end = given.v_end
            last = branch.points[-1]
            if branch.stalled is None and (why := limit(last.state)):
                branch.ended = (
                    f"torus: at v = {last.monitors['v']:.6g} {why}; lower v_end, or choose another law"
                )
            return branch

        order = 2.0 * numerics.degree
        caps = dict.fromkeys(("z_top",), numerics.degree + 1.0)
        family = WaveFamily if given.n else BranchFamily
        return {"primary": family(make, numerics.levels, order, ("p", "V"), caps=caps)}

    def points(self, _parameters: TorusParameters) -> np.ndarray:
        """41 angles from the outer to the inner equator."""
        return np.linspace(0.0, np.pi, 41)
