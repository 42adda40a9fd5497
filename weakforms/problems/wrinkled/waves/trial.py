r"""The trial perturbation of the linearised theory, and the second variation of the energy along it.

.. math:: u = f z_0',\quad v = f,\quad w = -f r_0' \qquad (q = r_0 v)

has no meridional displacement, so that the second variation is linear in ``n``:
:math:`\Pi_2/\pi = A + nB` (Patil, Nordmark & Eriksson 2016, section 2.4).
"""

from __future__ import annotations

import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI
from ufl.core.expr import Expr

from weakforms.errors import AbsentError
from weakforms.forms.revolution import second_order
from weakforms.problems.meridian.model import TAUT
from weakforms.problems.wrinkled.model import WrinkledModel, kept_with_model
from weakforms.problems.wrinkled.state import ZonedState
from weakforms.problems.wrinkled.waves.modes import waves_of

PROBES = (10.0, 20.0, 30.0)
"""Wave numbers at which the second variation is evaluated."""


class Trial:
    """The compiled second variation along the trial perturbation, for any state of a model."""

    def __init__(self, model: WrinkledModel, power: int) -> None:
        self.waves, self.model = waves_of(model), model
        e = model.expressions
        self.surface = fem.Constant(model.mesh, 1.0)
        along = ufl.variable(e["S"])
        f = ufl.conditional(ufl.lt(along, self.surface), ufl.sin(ufl.pi * along / self.surface) ** power, 0.0)
        width, amplitude = e["width"], fem.Constant(model.mesh, 0.0)

        def slope(part: Expr) -> Expr:
            return part.dx(0) / width

        f_s = ufl.diff(f, along)
        r_ss, z_ss = slope(e["r_s"]), slope(e["z_s"])
        parts = (f * e["z_s"], f * e["r"], -f * e["r_s"])
        slopes = (
            f_s * e["z_s"] + f * z_ss,
            f_s * e["r"] + f * e["r_s"],
            -f_s * e["r_s"] - f * r_ss,
        )

        def energy(a: Expr) -> Expr:
            return self.waves.energy(tuple(a * p for p in parts), tuple(a * s for s in slopes))

        dx = ufl.Measure("dx", model.mesh, metadata={"quadrature_degree": 4 * model.degree})
        self._second = fem.form(second_order(energy, amplitude) * width * dx)
        rate = -e["pressure"] * e["r"] * f**2 * e["lam1"] ** 2
        self._rate = fem.form(rate * width * dx)

    def second(self, n: float) -> float:
        """``Pi2/pi`` at the current state."""
        self.waves.wave_number.value, self.waves.bending.value = n, 0.0
        return self._sum(self._second) / 2

    def rate(self) -> float:
        """``B`` in closed form."""
        return self._sum(self._rate)

    def _sum(self, form: fem.Form) -> float:
        return float(self.model.mesh.comm.allreduce(fem.assemble_scalar(form), op=MPI.SUM))


@kept_with_model
def _trial_of(model: WrinkledModel, power: int) -> Trial:
    return Trial(model, power)


def trial_form(held: ZonedState, power: int) -> dict[str, float]:
    """``A``, ``B`` (fitted and in closed form), ``n_star = A/(-B)``, and how nonlinear ``n`` enters.

    Args:
        held: A state; the perturbation is zero above the liquid and above the lowest front.
        power: Power of the sine.

    Raises:
        AbsentError: If there is no wrinkled wet part.
    """
    if held.zones.first == TAUT or (held.zones.surface is None and not held.zones.wet):
        raise AbsentError(
            "wrinkled wet part",
            "the lower end is dry or taut, there is no wrinkled wet part to be perturbed; a smaller Af or a "
            "larger M or delta wrinkles it, a higher zw wets it",
        )
    trial = _trial_of(held.model, power)
    ends = [float(held.model.breaks_of(held.state.loads)[-1]), *held.zones.fronts[:1]]
    if held.zones.surface is not None:
        ends.append(held.zones.surface)
    with held.lent():
        trial.surface.value = min(ends)
        values, rate = [trial.second(n) for n in PROBES], trial.rate()
    b = (values[2] - values[0]) / (PROBES[2] - PROBES[0])
    a = values[0] - PROBES[0] * b
    curved = (values[0] - 2 * values[1] + values[2]) / np.abs(values).max()
    return {"A": a, "B": b, "B_exact": rate, "n_star": a / -b, "curved": curved}
