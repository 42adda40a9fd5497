r"""The inflated torus: the weak form over the angle of its cross-section.

Upper half of a torus symmetric about its equatorial plane, ``0 <= t <= pi``:

.. math:: R = 1 + b\cos t, \qquad Z = b\sin t, \qquad
          \frac{\Pi}{4\pi} = \int_0^\pi \Big[ b R\, W(\lambda_1, \lambda_2) - \tfrac12 p\, r^2 z' \Big]\,
          \mathrm{d}t
"""

from __future__ import annotations

from dataclasses import replace
from math import pi

import ufl
from dolfinx import fem
from mpi4py import MPI

from weakforms.problems.material_choice import Chosen
from weakforms.problems.meridian.blocks import LOWER, UPPER, Blocks
from weakforms.problems.meridian.body import Body
from weakforms.problems.meridian.model import MeridianModel
from weakforms.solvers.equilibrium.formulation import Formulation

WHOLE = 4 * pi
"""Both halves, and all around the axis."""


def stress_free_volume(b: float) -> float:
    """Volume of a torus with the radius ``b`` of its cross-section."""
    return 2 * pi**2 * b**2


class TorusModel(MeridianModel):
    """Weak form of the torus; its unknowns are ``r/R - 1`` and ``z - Z``.

    Args:
        comm: Ranks.
        law: The law.
        b: Radius of the cross-section.
        cells: Cells of half a cross-section.
        degree: Degree of the elements.
    """

    name = "torus"

    def __init__(self, comm: MPI.Intracomm, law: Chosen, b: float, cells: int, degree: int) -> None:
        body = Body(
            name=self.name,
            parameters=(),
            length=lambda _q: pi,
            radius=lambda t, _q: 1 + self._b * ufl.cos(t),
            thickness=lambda _t, _q: self._b,
            shape=lambda t, _q: (1.0, self._b * ufl.sin(t)),
            held=((None, 0.0), (None, 0.0)),
            scales=lambda _q: (1 / self._b, 1.0),
        )
        mesh = Blocks([0.0, pi], cells, degree, 4 * degree)
        super().__init__(comm, body, {"p": 0.0}, mesh, material=law)
        # Constants, with which tori of all sizes have the same code.
        self._b, self._stress_free = (fem.Constant(self.mesh, x) for x in (b, stress_free_volume(b)))

    def formulation(self) -> Formulation:
        r"""The weak form with the columns of the whole torus.

        If all lengths are multiplied by a factor, the stretches are too, and the volume by its cube. In
        equilibrium therefore :math:`\int (\lambda_1 W_{,1} + \lambda_2 W_{,2})\,\mathrm{d}A = 3 p V`.
        """
        given, e, (t1, t2) = super().formulation(), self.expressions, self.resultants
        dt, whole = self.dx, WHOLE * e["width"]
        monitors = {
            "V": whole * e["volume"] * dt,
            "v": whole / self._stress_free * e["volume"] * dt,
            "Pi": whole * self.potential * dt,
            "U": whole * self.strain * dt,
            "virial": whole * e["weight"] * (t1 + t2) * e["lam1"] * e["lam2"] * dt,
            "r_out": e["r"] * self.ends(LOWER),
            "r_in": e["r"] * self.ends(UPPER),
        }
        profile = {name: e[name] for name in ("r", "z", "lam1", "lam2")} | {"t1": t1, "t2": t2}
        return replace(given, monitors=monitors, profile=profile, maxima={"z_top": e["z"]}, abscissa="t")
