r"""Paper 1: a flat circular membrane inflated against a bed of springs on a plane, front on the mesh.

Patil, DasGupta & Eriksson (2015), Int. J. Solids Struct. 67-68, 250-262. Lengths are divided by the clamped
radius ``R_f = beta R_0``, stresses by ``C1 h``; ``x in [0, 1/beta]`` is the radius in the unstretched disk.

.. math:: \Pi/2\pi = \int_0^{1/\beta} \Big[ W x + \frac p2 \rho^2\eta'
          + \frac k2\,\chi\,(\eta - l)^2 \rho\rho' \Big] \mathrm{d}x

The unknowns are ``lam2`` and ``eta`` (``rho = x lam2``). Where points have touched and stick, the shape is
known: see :class:`DiskModel`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar

import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI
from ufl.core.expr import Expr

from weakforms.forms.loads import bed_potential
from weakforms.problems.contact.model import Bond
from weakforms.problems.contact.series import Series
from weakforms.problems.material_choice import Chosen
from weakforms.problems.meridian.blocks import BREAK, LOWER, UPPER, Blocks
from weakforms.problems.meridian.body import Body, Values
from weakforms.problems.meridian.model import MeridianModel
from weakforms.problems.meridian.thickness import Thickness
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.equilibrium.formulation import Formulation

UNEQUAL = 1e-4
"""Difference of both stretches at which a state is no longer equibiaxial."""


@dataclass(frozen=True)
class DiskData:
    """The membrane, its substrate and its mesh."""

    law: Chosen
    beta: float
    k: float
    l: float  # noqa: E741  (the paper's symbol)
    cells: int
    degree: int
    M: float = 1.0
    """Thickness at the pole over the mean of pole and clamp."""
    given: Thickness | None = None
    """Thickness given as text, instead of ``M``."""

    def thickness(self, x: Expr, q: Values) -> Expr | float:
        """Thickness over ``h``."""
        if self.given is not None:
            return self.given(self.beta * x, q)
        return 1.0 if self.M == 1 else self.M + 2 * (1 - self.M) * self.beta * x

    @property
    def length(self) -> float:
        """``x`` at the clamp, 1/beta."""
        return 1 / self.beta

    @property
    def touch(self) -> float:
        """Height of the pole at first contact."""
        return self.l


class FreeDisk(MeridianModel):
    """Weak form of the disk on a mesh of its radius, with springs where it passes the plane.

    Loads: ``p`` and, with a substrate, ``k`` and ``l``.
    """

    name = "disk"

    def __init__(
        self,
        comm: MPI.Intracomm,
        material: Chosen,
        values: Mapping[str, float],
        beta: float,
        mesh: Blocks,
        energy: str = "standard",
        thickness: Callable[[Expr, Values], Expr | float] = lambda _x, _q: 1.0,
    ) -> None:
        body = Body(
            name="disk",
            parameters=(),
            length=lambda _q: 1 / beta,
            radius=lambda x, _q: x,
            thickness=thickness,
            held=((None, None), (beta, 0.0)),
            upwards=-1.0,
            pole=True,
        )
        super().__init__(comm, body, values, mesh, energy, material)
        self.unknown.interpolate(lambda s: np.vstack([np.full_like(s[0], beta), np.zeros_like(s[0])]))

    def touching(self) -> Expr:
        """Indicator of contact with the substrate."""
        return ufl.conditional(ufl.gt(self.expressions["z"], self.q["l"]), 1.0, 0.0)

    @cached_property
    def resultants(self) -> tuple[Expr, Expr]:
        """Cauchy resultants ``t1, t2`` over ``C1 h``, of the local thickness."""
        thickness = self.body.thickness(self.expressions["S"], self.q)
        t1, t2 = super().resultants
        return thickness * t1, thickness * t2

    def foundation(self) -> Expr:
        """The bed of springs."""
        e, q = self.expressions, self.q
        return bed_potential(e["r"], e["r_s"], e["z"] - q["l"], q["k"], self.touching())

    def formulation(self) -> Formulation:
        """The weak form with the height of the pole."""
        given = super().formulation()
        pole = {"t0": self.expressions["z"] * self.ends(LOWER)}
        return replace(given, monitors={**pole, **given.monitors}, abscissa="X")


class DiskModel(FreeDisk):
    """Weak form of the disk on the front-fitted mesh.

    Loads: ``p``, ``front`` (``x_f``), ``k`` and ``l``; ``k = 0`` is the free membrane. The free part ``s in
    [1, 2]`` is mapped to ``x = x_f (x_e/x_f)^(s - 1)``, ``x_e = 1/beta``. This power resolves the boundary
    layer ``~ x^-2`` around a small patch.

    In a stuck patch ``lam2`` is locked at ``Lc(x)``. With a rigid bond ``lam1`` is locked too, and the patch
    only moves up and down as a whole: ``eta = e + F(x_f) - F(x)``, where ``e`` is the height of its edge. All
    are Chebyshev series in ``x``; ``I(x_f) = int (F(x_f) - F) rho_c rho_c' dx`` is the moment that occurs in
    the sum over the springs.
    """

    edges: ClassVar[Mapping[str, tuple[str, float]]] = {"front": ("gap", 1.0)}
    centre = 0
    stuck = 0
    """Component of the unknown that a bond determines: the circumferential stretch."""

    def __init__(self, comm: MPI.Intracomm, data: DiskData, bond: Bond | None = None) -> None:
        self.data, self.bond, self.rigid = data, bond, bond is not None and bond.rigid
        values = {"p": 0.0, "k": 0.0, "l": data.l}
        breaks, quadrature = [0.0, data.length / 2, data.length], 2 * data.degree + 4
        mesh = Blocks(breaks, data.cells, data.degree, quadrature, fronts={"front": 1})
        super().__init__(comm, data.law, values, data.beta, mesh, thickness=data.thickness)
        terms, span = (bond.terms, bond.span) if bond else (1, 1.0)
        # The moment is a product of the other two series.
        lengths = {"lam2": terms + 1, "depth": terms + 1, "moment": 2 * terms}
        span = fem.Constant(self.mesh, span)
        self.series = {name: Series(self.mesh, n, span) for name, n in lengths.items()}

    # -- geometry ------------------------------------------------------------------------------

    def place(self) -> tuple[Expr, Expr]:
        """``x`` and its derivative in the mesh coordinate: linear in the patch, a power outside."""
        inside, width = super().place()
        left, _, t = self.block
        ratio = ufl.ln((left + width) / self.in_patch(1.0, left))
        outside = left * ufl.exp(t * ratio)
        return self.in_patch(inside, outside), self.in_patch(width, outside * ratio)

    def position(self, s: np.ndarray, loads: Mapping[str, float]) -> np.ndarray:
        """Mesh coordinates of ``X = beta x`` for a state's front."""
        front, x, end = loads["front"], np.asarray(s) * self.data.length, self.data.length
        outside = 1 + np.log(np.maximum(x, front) / front) / np.log(end / front)
        return np.where(x <= front, x / front, outside)

    def material(self, x: np.ndarray, loads: Mapping[str, float]) -> np.ndarray:
        """``x`` of mesh coordinates."""
        front, end = loads["front"], self.data.length
        return np.where(x <= 1, front * x, front * (end / front) ** (x - 1))

    def at_front(self, slipped: Solved) -> float:
        """Circumferential stretch at the front of a frictionless state."""
        return slipped.values["rho_contact"] / slipped.state.loads["front"]

    def displaced(self, along: Expr, width: Expr) -> tuple[Expr, Expr, Expr, Expr]:
        """``lam2`` and ``eta`` with their derivatives; in a stuck patch from the series."""
        lam2, lam2_x, eta, eta_x = super().displaced(along, width)
        if self.bond is None:
            return lam2, lam2_x, eta, eta_x
        _, _, t = self.block
        locked, locked_slope = self.series["lam2"](along)
        at_front, _ = self.series["lam2"](self.front)
        if self.rigid:
            depth, depth_slope = self.series["depth"](along)
            deepest, _ = self.series["depth"](self.front)
            eta = self.in_patch(eta + deepest - depth, eta)
            eta_x = self.in_patch(-depth_slope, eta_x)
        return (
            self.in_patch(locked, lam2 + at_front * (1 - t)),
            self.in_patch(locked_slope, lam2_x - at_front / width),
            eta,
            eta_x,
        )

    # -- the form ------------------------------------------------------------------------------

    def touching(self) -> Expr:
        """The patch."""
        return self.in_patch(1.0, 0.0)

    def functional(self) -> ufl.Form:
        """The functional that is made stationary.

        In a rigid patch the unknown height is the height of the edge, and a Laplacian makes it constant; the
        springs under it are summed at its edge, up to a constant.
        """
        if not self.rigid:
            return super().functional()
        eta, q = self.unknown[1], self.q
        potential = self.potential * self.expressions["width"]
        at_front, moment = (ufl.avg(self.series[name](self.front)[0]) for name in ("lam2", "moment"))
        above, front = ufl.avg(eta) - q["l"], ufl.avg(self.front)
        springs = q["k"] * ((front * at_front) ** 2 * above**2 / 4 + moment * above)
        return self.in_patch(eta.dx(0) ** 2 / 2, potential) * self.dx + springs * self.inner(BREAK)

    def mass(self) -> ufl.Form:
        """``int |dx|^2 x dx``; a rigid patch has the mass of its area at its edge."""
        if not self.rigid:
            return super().mass()
        (u, w), (v, y) = ufl.TrialFunction(self.space), ufl.TestFunction(self.space)
        x, width = self.expressions["radius"], self.expressions["width"]
        outside = (x**2 * u * v + w * y) * x * width
        vertex = ufl.avg(w) * ufl.avg(y) * ufl.avg(self.front) ** 2 / 2
        return self.in_patch(0.0, outside) * self.dx + vertex * self.inner(BREAK)

    def conditions(self) -> list[fem.DirichletBC]:
        """The clamp, and what a bond determines."""
        return super().conditions() + ([] if self.bond is None else [self.frozen(self.stuck)])

    def formulation(self) -> Formulation:
        """The weak form with contact stresses, and values at the front."""
        e, ends, given = self.expressions, self.ends, super().formulation()
        lam1, lam2 = e["lam1"], e["lam2"]
        t1, t2 = self.resultants
        sigma = self.in_patch(-self.q["k"] * (e["z"] - self.q["l"]), 0.0)
        return replace(
            given,
            monitors={
                "t0": given.monitors["t0"],
                "lam_pole": lam2 * ends(LOWER),
                "lam1_rim": lam1 * ends(UPPER),
                **{n: given.monitors[n] for n in ("V", "Pi")},
                "sigma_pole": sigma * ends(LOWER),
                **self._front_monitors(t1, t2, sigma),
            },
            maxima={"minus_t": ufl.max_value(-t1, -t2)},
            derived={"t_min": lambda v: -v["minus_t"]},
            levels={"X_iso": (lam1 - lam2, UNEQUAL)},
            coordinate=e["S"] * self.data.beta,
            internal=("front", "k", "minus_t", "gap", "steepness", "rho_slope_outside"),
            profile={**given.profile, "sigma": sigma},
        )

    def _front_monitors(self, t1: Expr, t2: Expr, sigma: Expr) -> dict[str, ufl.Form]:
        """One-sided values at the front."""
        e, at = self.expressions, self.inner(BREAK)
        # x W1 theta' = p rho lam1 - W2 sin(theta), theta the angle below the horizontal
        curvature = (self.q["p"] * e["r"] - t2 * e["cos_beta"]) / (e["S"] * t1 * e["lam2"])
        return {
            "X_contact": ufl.avg(self.front) * self.data.beta * at,
            "rho_contact": self.beside(e["r"], first=False) * at,
            "lam1_contact": self.beside(e["lam1"], first=True) * at,
            "lam1_contact_outer": self.beside(e["lam1"], first=False) * at,
            "sigma_contact": self.beside(sigma, first=True) * at,
            "kappa": self.beside(curvature, first=False) * at,
            "gap": (self.beside(e["z"], first=False) - self.q["l"]) * at,
            "steepness": self._steepness(t1) * at,
            "rho_slope_outside": self.beside(e["r_s"], first=False) * at,
            "G": self._energy_release_rate(t1) * at,
        }

    def _steepness(self, t1: Expr) -> Expr:
        r"""``-eta'/x`` outside the front.

        Next to a rigid patch it comes from the vertical balance, ``x W1 eta'/lam1 + p rho^2/2 - k I = 0`` at
        ``eta = l``, because at a small front the derivative is dominated by round-off.
        """
        e = self.expressions
        if not self.rigid:
            return self.beside(-e["z_s"] / e["S"], first=False)
        moment, _ = self.series["moment"](self.front)
        force = self.q["p"] * e["r"] ** 2 / 2 - self.q["k"] * moment
        return self.beside(force * e["lam1"] / (e["S"] ** 2 * t1 * e["lam2"]), first=False)

    def _energy_release_rate(self, t1: Expr) -> Expr:
        r"""Energy released per deformed area when the edge of the patch peels, in closed form.

        .. math:: G = \frac{W_c - W_o - W_{1o}[\lambda_{1c}\cos\Delta\theta - \lambda_{1o}]}
                           {\lambda_{1c}\lambda_2}
                  + \frac k2 (e - l)^2 \cos\theta_c

        with ``c`` for the side of the patch and ``o`` for the free side. These are the jump of the
        Hamiltonian of the meridian (Long, Shull & Hui 2010) and the energy of the released springs.
        """
        e, k = self.expressions, self.q["k"]
        energy = self.law(e["lam1"], e["lam2"])
        (w_c, l1_c, r_c, e_c), (w_o, l1_o, r_o, e_o) = (
            [self.beside(v, first) for v in (energy, e["lam1"], e["r_s"], e["z_s"])]
            for first in (True, False)
        )
        lam2 = self.beside(e["lam2"], first=False)
        w1_o = self.beside(t1, first=False) * lam2
        along = (r_c * r_o + e_c * e_o) / l1_o  # lam1_c cos(Delta theta)
        gap = self.beside(e["z"], first=False) - self.q["l"]
        return (w_c - w_o - w1_o * (along - l1_o)) / (l1_c * lam2) + k * gap**2 / 2 * r_c / l1_c
