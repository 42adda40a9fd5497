"""Problems ``wrinkled_linear`` and ``wrinkled_bending`` (Paper 5): waves around the cylinder at one level.

Both solve for the axisymmetric state at a level and evaluate its stability over real wave numbers ``n``: by
the linearised theory of the paper's section 2.4, and with a small bending stiffness (not in the paper).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar

import numpy as np
from mpi4py import MPI
from pydantic import Field

from weakforms.errors import AbsentError, ConvergenceError
from weakforms.problems.material_choice import MaterialChoice, require_foldable
from weakforms.problems.meridian.pre_stretch import require_carried, require_held
from weakforms.problems.problem import Problem, Requests, Task
from weakforms.problems.wave_numbers import MOST_WAVES
from weakforms.problems.wrinkled.first_state import first_state
from weakforms.problems.wrinkled.problem import (
    WrinkledNumerics,
    WrinkledParameters,
    wrinkled_membrane,
)
from weakforms.problems.wrinkled.state import ZonedState
from weakforms.problems.wrinkled.waves.about import WRINKLED_BENDING, WRINKLED_LINEAR
from weakforms.problems.wrinkled.waves.bands import Bands
from weakforms.problems.wrinkled.waves.koiter import shell_eigenvalue
from weakforms.problems.wrinkled.waves.trial import trial_form
from weakforms.results import Absence, Failure, Quantity, Result
from weakforms.solvers.equilibrium import constraints as fixed
from weakforms.solvers.uncertainty.refinement import estimate

ROUND_OFF = 1e-10
"""Relative round-off error."""

PLACE = 1e-6
"""Relative error of the position of a flat maximum."""


class LevelParameters(MaterialChoice):
    """The cylinder of Paper 5 and a level."""

    ratio: ClassVar[str] = "c2"

    zw: float = Field(5.0, gt=0, le=30, description="level of the fluid")
    M: float = Field(1.5, gt=0, lt=2, description="thickness at the lower end over its mean")
    delta: float = Field(3.0, gt=1, le=6, description="axial pre-stretch")
    c2: float = Field(0.01, ge=0, le=1, description="C2/C1 of mooney_rivlin; 0 is neo-Hookean")
    L: float = Field(8.0, ge=1, le=40, description="undeformed length L_o/Ao")
    Af: float = Field(0.4362, gt=0, le=3, description="radius of the disks")
    gamma: float | None = Field(None, gt=0, le=10, description="weight of the fluid; by default the paper's")


class LinearParameters(LevelParameters):
    """In addition, the trial function."""

    f: int = Field(1, ge=1, le=2, description="trial function: 1 sin(pi S/S_level), 2 its square")


class BendingParameters(LevelParameters):
    """In addition, bending stiffness and a wave number."""

    beta: float = Field(0.0, ge=0, le=1, description="bending stiffness over H^3 and C1 h Ao^2")
    n: float = Field(10.0, gt=0, le=MOST_WAVES, description="wave number, any real one")


Part = Callable[[list[ZonedState], Any, float], dict[str, Quantity]]
"""Computes quantities from the states on all meshes, the parameters, and the highest order."""


class AtLevel(Problem):
    """Base class of both: states on all meshes, and quantities with uncertainties."""

    numerics = WrinkledNumerics

    def check(self, parameters: Any, requests: Requests) -> None:
        """Refuse requests for states, because there is only one, and laws without a form for waves."""
        super().check(parameters, requests)
        require_foldable(f"{self.name}: waves around the axis", parameters, invariants=True)
        require_carried(self.name, parameters.material, parameters.delta, parameters.M)
        require_held(self.name, parameters.material, parameters.Af)

    def fill(self, result: Result, task: Task) -> None:
        """Solve for the state at the level on all meshes, and compute the quantities."""
        parameters, numerics, comm, progress = task.parameters, task.numerics, task.comm, task.progress
        hint = "; a lower zw, which may be above its limit, or a smaller Af may give a state"
        try:
            progress("state", 0, 1)
            levels = _states(parameters, numerics, comm)
            progress("waves", 0, 1)
            hint = ""
            for part in self._parts:
                try:
                    result.quantities |= part(levels, parameters, 2 * numerics.degree)
                except AbsentError as error:
                    result.absent.append(Absence(error.what, f"{self.name}: {error}"))
        except AbsentError as error:
            result.absent.append(Absence(error.what, f"{self.name}: {error}"))
        except ConvergenceError as error:
            result.failures.append(Failure(f"zw = {parameters.zw:g}", f"{error}{hint}"))

    @property
    def _parts(self) -> tuple[Part, ...]:
        """What computes quantities from the states; each part may be absent on its own."""
        raise NotImplementedError


def _states(parameters: LevelParameters, numerics: WrinkledNumerics, comm: MPI.Intracomm) -> list[ZonedState]:
    given = {name: getattr(parameters, name) for name in ("model", "M", "delta", "L", "Af", "gamma")}
    given |= {"c2": parameters.c2} if parameters.other_law is None else dict(parameters.constants)
    membrane = wrinkled_membrane(WrinkledParameters(**given, n=(1,)), numerics, comm)
    try:
        plain = membrane.plain(membrane.by_homotopy(parameters.zw)[0])
    except ConvergenceError:  # from no load to a high level at once is too far
        plain = first_state(membrane, parameters.zw, "lower zw")
    return membrane.fitted(plain, fixed.Held("zw", parameters.zw))


def _on_all(
    levels: list[ZonedState], value: Callable[[ZonedState], float], cap: float, left: float
) -> Quantity:
    """A number of the state from its values on all meshes."""
    return estimate([value(held) for held in levels], cap).quantity(left)


class WrinkledLinear(AtLevel):
    """The linearised theory: a perturbation without meridional displacement."""

    about = WRINKLED_LINEAR
    parameters = LinearParameters

    @property
    def _parts(self) -> tuple[Part, ...]:
        return (self._quantities,)

    def _quantities(self, levels: list[ZonedState], parameters: Any, cap: float) -> dict[str, Quantity]:
        trials = [trial_form(held, parameters.f) for held in levels]
        names = ("A", "B", "B_exact", "n_star", "curved")
        out = {}
        for name in names:
            out[name] = estimate([trial[name] for trial in trials], cap).quantity(ROUND_OFF)
        whole = Bands(levels[-1]).first_whole(MOST_WAVES)
        if whole is not None:
            out["n_true"] = Quantity(float(whole), 0.0)
            out["n_critical"] = _on_all(
                levels, lambda held: Bands(held).zero(whole - 1.0, float(whole)), cap, ROUND_OFF
            )
        return out


class WrinkledBending(AtLevel):
    """Bending energy of the incremental circumferential curvature, which keeps the equilibrium."""

    about = WRINKLED_BENDING
    parameters = BendingParameters

    @property
    def _parts(self) -> tuple[Part, ...]:
        return self._eigenvalues, self._largest, self._band

    def _eigenvalues(self, levels: list[ZonedState], parameters: Any, cap: float) -> dict[str, Quantity]:
        n, beta = parameters.n, parameters.beta
        out = {}
        for name, stiffness in (("Lambda_membrane", 0.0), ("Lambda_B1", beta)):
            out[name] = _on_all(levels, lambda h, b=stiffness: Bands(h, b).lowest(n), cap, ROUND_OFF)
        if beta:
            out["Lambda_B2"] = _on_all(levels, lambda h: shell_eigenvalue(h, n, beta), cap / 2, ROUND_OFF)
        return out

    def _largest(self, levels: list[ZonedState], _parameters: Any, cap: float) -> dict[str, Quantity]:
        """The stiffness that removes all waves, and the last of them."""
        out = {}
        most = Bands(levels[-1]).most_stiffness(MOST_WAVES)
        if most is not None:
            peaks = [Bands(held).peak(most) for held in levels]
            for name, values, left in zip(
                ("n_c", "beta_c"), np.array(peaks).T.tolist(), (PLACE, 1e-14), strict=True
            ):
                found = estimate(values, cap).quantity()
                # beta_c is small, so that its error is relative to itself.
                spread = found.uncertainty if name == "n_c" else _relative(values, cap)
                out[name] = Quantity(found.value, spread + left * max(1.0, found.value), found.order)
        return out

    def _band(self, levels: list[ZonedState], parameters: Any, cap: float) -> dict[str, Quantity]:
        """Ends of the unstable wave numbers with the bending stiffness."""
        beta, out = parameters.beta, {}
        band = Bands(levels[-1], beta).band(MOST_WAVES) if beta else None
        if band is not None:
            for name, (low, high) in zip(("n_minus", "n_plus"), band, strict=True):
                out[name] = _on_all(
                    levels, lambda h, a=low, b=high: Bands(h, beta).zero(a, b), cap, ROUND_OFF
                )
        return out


def _relative(values: list[float], cap: float) -> float:
    """Uncertainty of a small positive number, from the uncertainty of its logarithm."""
    return float(values[-1] * (estimate([float(np.log(v)) for v in values], cap).uncertainty + ROUND_OFF))
