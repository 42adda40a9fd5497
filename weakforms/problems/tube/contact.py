"""Paper 2, constrained inflation: the tube against a soft cylindrical substrate, with the front on the mesh.

The front ``z_f`` is a scalar unknown with the equation ``rho(z_f) = s``.

In a stuck patch the axial position is not an unknown: ``eta = E(Z)``, where ``E'`` is a Chebyshev series (see
:mod:`weakforms.problems.tube.phases`). The unknown of the free part is then ``q = eta - E(z_f) (2 - x)`` with
the mesh coordinate ``x``, zero at the front.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import ufl
from dolfinx import fem
from mpi4py import MPI
from ufl.core.expr import Expr

from weakforms.forms.kinematics import revolution_stretches
from weakforms.forms.loads import gas_potential, substrate_potential
from weakforms.problems.contact.model import Bond
from weakforms.problems.contact.series import Series
from weakforms.problems.material_choice import Chosen
from weakforms.problems.meridian.blocks import BREAK, Blocks, both_ends, mirrored, one_end
from weakforms.problems.tube.folds import FRONTS
from weakforms.problems.tube.model import TubeModel
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.equilibrium.formulation import Formulation

CHUNK = 28
"""Stored coefficients of the history: enough for the terms of three meshes."""

FIRST_FRONT = 0.004
"""Smallest front at which contact is followed, as a fraction of the half length."""


@dataclass(frozen=True)
class ContactData:
    """The tube, its substrate and its mesh."""

    law: Chosen
    delta1: float
    lf: float
    k: float
    s: float
    cells: int
    degree: int
    grading: float
    unilateral: bool = False
    """Whether the spring only pushes, so that it lets go of a patch in deflation."""
    letting_go: bool = False
    """Whether the mesh follows the place where the spring lets go of the patch."""
    full: bool = False
    """Whether the tube is the whole one, with a front on either side of the mid-plane."""
    zone: tuple[float, ...] = ()
    """First positions of the ends of a wrinkled zone on half the tube, if the mesh follows them: of both, or
    of one if the zone ends at the disk."""

    @property
    def length(self) -> float:
        """``Z`` at the disk, half the length."""
        return self.lf / 2

    @property
    def touch(self) -> float:
        """Displacement of the mid-plane at first contact."""
        return self.s - 1


class ContactModel(TubeModel):
    """Weak form of the tube with a front-fitted mesh.

    Loads: ``p``, ``front`` (``z_f``), ``k``, ``s`` and ``delta1``; ``k = 0`` is the free tube. Where a spring
    that only pushes lets go of the patch, ``let_go`` is a second front: the spring acts up to it. A whole
    tube has ``front_lower`` and ``let_go_lower`` too, which are negative.
    """

    stuck = 1
    """Component of the unknown that a bond determines: the axial position."""

    def __init__(self, comm: MPI.Intracomm, data: ContactData, bond: Bond | None = None) -> None:
        self.data, self.bond = data, bond
        # On the free part both ends are refined: the front's boundary layer and the disk's.
        grading = [one_end(data.grading), both_ends(data.grading)]
        first = FIRST_FRONT * data.length
        breaks, names = [0.0, first, data.length], ["front"]
        if data.letting_go:
            grading, names = [*grading, grading[-1]], ["let_go", "front"]
            breaks.insert(1, first / 2)
        if data.zone:
            grading += [both_ends(0.0)] * len(data.zone)
            names += FRONTS[: len(data.zone)]
            breaks[-1:-1] = data.zone
        if data.full:
            grading = [*(mirrored(block) for block in reversed(grading)), *grading]
            breaks = [-at for at in breaks[:0:-1]] + breaks
        self.centre = len(names) + 1 if data.full else 0
        sides = {"": 1, "_lower": -1} if data.full else {"": 1}
        ends = {n + side: self.centre + s * k for side, s in sides.items() for k, n in enumerate(names, 1)}
        self.patch, self.pushing = (
            (min(ends.get(f"{name}_lower", 0), self.centre), ends[name]) for name in ("front", names[0])
        )
        gaps = {name + side: (name, side, float(s)) for side, s in sides.items() for name in names}
        self.edges, self.releases = (
            {key: (f"{gap}{side}", s) for key, (name, side, s) in gaps.items() if name == wanted}
            for wanted, gap in (("front", "gap"), ("let_go", "let_go_gap"))
        )
        mesh = Blocks(breaks, data.cells, data.degree, 2 * data.degree + 4, ends, grading)
        values = {"p": 0.0, "k": 0.0, "s": data.s, "delta1": data.delta1}
        energy = "relaxed" if data.zone else "standard"
        super().__init__(comm, data.law, values, data.length, mesh, energy)
        terms, span = (bond.terms, bond.span) if bond else (0, 1.0)
        self._span = fem.Constant(self.mesh, span)
        lengths = {"slope": terms, "position": terms + 1}
        self.series = {name: Series(self.mesh, n, self._span, CHUNK) for name, n in lengths.items()}

    def at_front(self, slipped: Solved) -> float:
        """Axial position of the front of a frictionless state."""
        return slipped.values["contact_length"] / 2

    @property
    def _side(self) -> Expr | float:
        """1 above the mid-plane, -1 below it."""
        if not self.data.full:
            return 1.0
        return ufl.conditional(ufl.gt(self._by_cell["block"], self.centre - 0.5), 1.0, -1.0)

    @property
    def front(self) -> Expr:
        """``S`` at the edge of the patch on the side of each point, from either side of the edge."""
        if not self.data.full:
            return super().front
        left, width, _ = self.block
        lower = self.in_patch(left, left + width)
        return ufl.conditional(ufl.gt(self._by_cell["block"], self.centre - 0.5), super().front, lower)

    def displaced(self, along: Expr, width: Expr) -> tuple[Expr, Expr, Expr, Expr]:
        """``rho`` and ``eta`` with their derivatives; in a stuck patch ``eta`` from the history."""
        rho, rho_z, eta, eta_z = super().displaced(along, width)
        if self.bond is None:
            return rho, rho_z, eta, eta_z
        (_, _, t), side = self.block, self._side
        (at_front, _), (inside, _) = (self.series["position"](side * z) for z in (self.front, along))
        slope, _ = self.series["slope"](side * along)
        to_disk = ufl.conditional(ufl.gt(side, 0.0), 1 - t, t) if self.data.full else 1 - t
        return (
            rho,
            rho_z,
            self.in_patch(side * inside, eta + side * at_front * to_disk),
            self.in_patch(slope, eta_z - at_front / width),
        )

    def touching(self) -> Expr | float:
        """The patch, or the part of it in which a spring that only pushes does so."""
        (low, high), block = self.pushing, self._by_cell["block"]
        pushes = ufl.lt(abs(block - (low + high - 1) / 2), (high - low) / 2)
        return ufl.conditional(pushes, 1.0, 0.0)

    def conditions(self) -> list[fem.DirichletBC]:
        """The clamp, symmetry, and what a bond determines."""
        return super().conditions() + ([] if self.bond is None else [self.frozen(self.stuck)])

    def formulation(self) -> Formulation:
        """The weak form with forces of the substrate, and one-sided values at the front."""
        e, q, given = self.expressions, self.q, super().formulation()
        rho, lam1, lam2, cos_beta, width = (e[n] for n in ("r", "lam1", "lam2", "cos_beta", "width"))
        p, k, s, contact = q["p"], q["k"], q["s"], self.touching()
        t1, t2 = self.resultants
        membrane = self.axial_force()
        spring = (rho - s) + (rho - s) ** 2 / (2 * rho)
        force = membrane - p * rho**2 / 2 + k * contact * rho * (rho - s) ** 2 / 2
        # Per deformed area: the substrate's axial traction on the membrane, and the spring's radial part.
        rate = force.dx(0) / width if self.bond is None else self._force_rate()
        f_t = -q["delta1"] * rate / (rho * lam1)
        f_k = -k * contact * cos_beta * spring
        pressure = p - k * contact * spring
        kappa = (t2 * lam1 * cos_beta - pressure * rho * lam1) / (ufl.sqrt(q["delta1"]) * t1 * lam2 * lam1)
        places = {name: self.inner(BREAK + k - 1) for name, k in self.fronts.items()}
        at, ends = places["front"], {**self.edges, **self.releases}
        gaps = {gap: ufl.avg(rho - s) * places[name] for name, (gap, _) in ends.items()}
        length = 2 * ufl.avg(e["z"]) * at
        if self.data.full:
            length = ufl.avg(e["z"]) * at - ufl.avg(e["z"]) * places["front_lower"]
        return replace(
            given,
            monitors={
                **{n: given.monitors[n] for n in ("u_max", "lam1_mid")},
                "lam2_mid": self.at_middle(lam2),
                **{n: given.monitors[n] for n in ("t1_mid", "V", "Pi", "resistance")},
                "slope_outside": self.beside(e["z_s"], first=False) * at,
                "jump": self._jump(force / rho) * at,
                "membrane_jump": self._jump(membrane / rho) * at,
                "f_t_front": self.beside(f_t, first=True) * at,
                "kappa": self.beside(kappa, first=False) * at,
                "Z_front": ufl.avg(self.front) * at,
                "contact_length": length,
                **gaps,
            },
            maxima={"spring_max": abs(f_k), "t2_max_negative": -t2},
            # |f_t| is largest at the front, where its one-sided value is used.
            derived={
                "traction_max": lambda v: abs(v["f_t_front"]),
                "line_force": lambda v: abs(v["jump"]),
                "line_force_membrane": lambda v: abs(v["membrane_jump"]),
                "traction_front": lambda v: abs(v["f_t_front"]),
                "t2_min": lambda v: -v["t2_max_negative"],
            },
            internal=(
                *ends,
                *gaps,
                "jump",
                "membrane_jump",
                "f_t_front",
                "t2_max_negative",
                "slope_outside",
                "resistance",
            ),
            profile=given.profile | {"f_t": self.in_patch(f_t, 0.0), "f_k": f_k, "F_axial": force},
        )

    def _force_rate(self) -> Expr:
        r"""Derivative in ``Z`` of the axial force :math:`L_{,\eta_Z}` in a stuck patch.

        There the axial position is the history's ``E``. The second derivative of the radius, which elements
        approximate less well, follows from the radial balance of forces:

        .. math:: \frac{\mathrm d}{\mathrm dZ} L_{,\rho_Z}(\rho, \rho_Z, E') = L_{,\rho}
        """
        e, q, side = self.expressions, self.q, self._side
        rho, a, b = (ufl.variable(e[name]) for name in ("r", "r_s", "z_s"))
        stretches = revolution_stretches(rho, a, b, self.body.scales(q))
        density = e["weight"] * self.law(stretches.lam1, stretches.lam2) + gas_potential(rho, b, q["p"])
        density += substrate_potential(rho, b, q["k"], q["s"], self.touching())
        _, bend = self.series["slope"](side * e["S"])
        outwards, upwards = ufl.diff(density, a), ufl.diff(density, b)

        def rate(force: Expr, second: Expr | float) -> Expr:
            return ufl.diff(force, rho) * a + ufl.diff(force, a) * second + ufl.diff(force, b) * side * bend

        second = (ufl.diff(density, rho) - rate(outwards, 0.0)) / ufl.diff(outwards, a)
        return rate(upwards, second)

    def _jump(self, value: Expr) -> Expr:
        """Value before the front minus that behind it."""
        return self.beside(value, first=True) - self.beside(value, first=False)
