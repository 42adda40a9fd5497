r"""Torsion of a flat annulus in its plane: the weak form over the radius, with the mesh following the front.

Both edges are held: ``r = s R``, and the inner one is turned by ``psi``. A material point at ``(R, Theta)``
moves to the radius ``r(R)`` and the angle ``Theta + w(R)``. Over the outer radius and ``C1 h``

.. math:: \frac{U}{2\pi} = \int_a^1 W(C)\, R\, \mathrm{d}R, \qquad
          C_{11} = r'^2 + r^2 w'^2, \quad C_{12} = r^2 w'/R, \quad C_{22} = r^2/R^2

with the relaxed energy where the sheet is wrinkled: inside of the front, with the sheet taut outside of it.
The torque :math:`M = \partial U/\partial\psi = -2\pi R\, W_{,w'}` is the same at every radius.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI
from ufl.core.expr import Expr

from weakforms.forms.kinematics import polar_metric
from weakforms.forms.revolution import strain_energy
from weakforms.forms.wrinkling import principal_stretches
from weakforms.problems.material_choice import Chosen
from weakforms.problems.meridian.blocks import BREAK, LOWER, UPPER, Blocks
from weakforms.problems.meridian.body import Body, Values
from weakforms.problems.meridian.model import BY_STATE, TAUT, WRINKLED, Marks, MeridianModel
from weakforms.solvers.equilibrium.formulation import Formulation

Zones = Literal["by_state", "taut", "wrinkled", "front"]
"""What a mesh is made for: any state (with kinks inside of cells), one zone, or a front between two."""

BLOCKS = {"by_state": [BY_STATE], "taut": [TAUT], "wrinkled": [WRINKLED], "front": [WRINKLED, TAUT]}
"""Marks of the blocks, from the inner edge outwards."""

FRONT = "R_front"


@dataclass(frozen=True)
class Ring:
    """One annulus: law, radius of the inner edge over that of the outer one, ratio of the radii."""

    law: Chosen
    a: float
    s: float


class AnnulusModel(MeridianModel):
    """Weak form of the annulus; its unknowns are ``r/R`` and the angle beyond a turn linear in ``R``.

    Loads: ``psi``, ``s`` and, on a mesh with a front, ``R_front``.

    Args:
        comm: Ranks.
        ring: The annulus.
        zones: What the mesh is made for.
        cells: Cells over the radius.
        degree: Degree of the elements.

    Attributes:
        marks: Marks of its states.
    """

    name = "annulus"

    def __init__(self, comm: MPI.Intracomm, ring: Ring, zones: Zones, cells: int, degree: int) -> None:
        self.ring, marks = ring, np.array(BLOCKS[zones])
        body = Body(
            name=self.name,
            parameters=(),
            length=lambda _q: 1.0,
            radius=lambda at, _q: at,
            thickness=lambda _s, _q: 1.0,
            shape=self._uniform,
            held=((ring.s, 0.0), (ring.s, 0.0)),
        )
        fronts = {FRONT: 1} if zones == "front" else {}
        breaks = np.linspace(ring.a, 1.0, len(marks) + 1)
        mesh = Blocks(breaks, cells // len(marks), degree, 4 * degree, fronts)
        super().__init__(comm, body, {"psi": 0.0, "s": ring.s}, mesh, material=ring.law)
        # Constants, with which rings of all sizes have the same code.
        self._a, self._s = (fem.Constant(self.mesh, x) for x in (ring.a, ring.s))
        self.marks = Marks(marks, np.zeros(len(marks)))
        self.unknown.interpolate(lambda x: np.vstack([np.full_like(x[0], ring.s), np.zeros_like(x[0])]))

    def _uniform(self, at: Expr, q: Values) -> tuple[Expr, Expr]:
        """``(r/R, w)`` from which the unknowns are measured, so that their values at the edges are fixed."""
        return q["s"] - self._s, q["psi"] * (1 - at) / (1 - self._a)

    def place(self) -> tuple[Expr, Expr]:
        """``R`` and its derivative in the mesh coordinate: geometric, since strains fall as ``1/R^2``."""
        left, width, t = self.block
        growth = ufl.ln((left + width) / left)
        at = left * ufl.exp(t * growth)
        return at, at * growth

    def position(self, s: np.ndarray, loads: Mapping[str, float]) -> np.ndarray:
        """Mesh coordinates of radii for a state's front."""
        breaks = self.breaks_of(loads)
        k = np.clip(np.searchsorted(breaks, s, side="right") - 1, 0, self.blocks - 1)
        return k + np.clip(np.log(s / breaks[k]) / np.log(breaks[k + 1] / breaks[k]), 0.0, 1.0)

    def material(self, x: np.ndarray, loads: Mapping[str, float]) -> np.ndarray:
        """Radii of mesh coordinates, the inverse of :meth:`position`."""
        breaks = self.breaks_of(loads)
        k = np.clip(np.floor(x).astype(int), 0, self.blocks - 1)
        return breaks[k] * (breaks[k + 1] / breaks[k]) ** (x - k)

    @cached_property
    def expressions(self) -> dict[str, Expr]:
        """Radius, angle, and what follows from the metric in polar coordinates."""
        s, width = self.place()
        along = ufl.variable(s)
        ratio, ratio_s, turn, turn_s = self.displaced(along, width)
        r = along * ratio
        r_s, turn_s = ufl.variable(ratio + along * ratio_s), ufl.variable(turn_s)
        c = polar_metric(ratio, r, r_s, turn_s)
        lam1, lam2 = principal_stretches(c)
        law = self.material_law
        natural = law.material.natural_width(law.on(self.mesh))
        gw = lam2 / natural(lam1)
        taut = self.marked("taut", gw - 1)
        energy = along * strain_energy(c, taut, self.full, natural)
        return {
            "S": along,
            "radius": along,
            "weight": along,
            "width": width,
            "r": r,
            "turn": turn,
            "r_s": r_s,
            "turn_s": turn_s,
            "lam1": lam1,
            "lam2": lam2,
            "J": ratio * r_s,
            "gw": gw,
            "wrinkled": ufl.conditional(taut, 0.0, 1.0),
            "energy": energy,
            # Conjugate to r' and w': radial force and moment of the forces, per radian.
            "pull": ufl.diff(energy, r_s),
            "moment": ufl.diff(energy, turn_s),
        }

    @cached_property
    def potential(self) -> Expr:
        """Strain energy per ``S`` and over ``2 pi``; nothing else does work with both edges held."""
        return self.expressions["energy"]

    def mass(self) -> ufl.Form:
        """``int |dx|^2`` over the reference area."""
        e, trial, test = self.expressions, ufl.TrialFunction(self.space), ufl.TestFunction(self.space)
        return ufl.inner(trial, test) * e["radius"] ** 3 * e["width"] * self.dx

    def formulation(self) -> Formulation:
        r"""The weak form with torque, Clapeyron's identity, the front and the lines of tension.

        .. math:: 2U = 2\pi \big[ R\,(R W - r' p_r + w' M/2\pi) + r p_r \big]_a^1, \qquad p_r = R\, W_{,r'}

        holds for every energy in the plane, from the invariance of ``W`` under a change of all lengths. In a
        wrinkled part the tension :math:`T^2 = p_r^2 + (M/2\pi r)^2` is constant, and its lines, at the angle
        :math:`\tan\beta = M/(2\pi r p_r)` to the radius, are straight: :math:`r\sin\beta = c` is constant.
        """
        e, turn = self.expressions, 2 * np.pi
        pull, moment = e["pull"], e["moment"]
        force = ufl.sqrt(pull**2 + (moment / e["r"]) ** 2)
        edge = e["S"] * (e["energy"] - e["r_s"] * pull - e["turn_s"] * moment) + e["r"] * pull
        inner, outer = self.ends(LOWER), self.ends(UPPER)
        width, dx = e["width"], self.dx
        monitors = {
            "M": turn * ufl.diff(e["energy"], self.q["psi"]) * width * dx,
            "U": turn * e["energy"] * width * dx,
            "U_edges": np.pi * edge * outer - np.pi * edge * inner,
            "M_in": -turn * moment * inner,
            "M_out": -turn * moment * outer,
            "f_w": 2 / (1 - self._a**2) * e["wrinkled"] * e["S"] * width * dx,
            "lam1_in": e["lam1"] * inner,
            "lam1_out": e["lam1"] * outer,
            "gw_in": e["gw"] * inner,
            "gw_out": e["gw"] * outer,
            "J_in": e["J"] * inner,
        }
        internal = ("J_in",)
        if self.fronts:
            monitors["gw_front"] = ufl.avg(e["gw"]) * self.inner(BREAK)
            internal = ("J_in", "gw_front")
        return Formulation(
            unknown=self.unknown,
            residual=ufl.derivative(self.functional(), self.unknown, ufl.TestFunction(self.space)),
            loads=self.loads,
            bcs=self.conditions(),
            mass=self.mass(),
            monitors=monitors,
            internal=internal,
            locate=self.position,
            aim=self.aim if self.fronts else None,
            mark=self.mark,
            profile={
                **{name: e[name] for name in ("r", "turn", "lam1", "lam2", "gw")},
                "torque": -turn * moment,
                "tension": force,
                "line": -moment / force,
            },
            abscissa="R",
        )
