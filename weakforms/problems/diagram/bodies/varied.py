r"""Membranes all of whose parameters are loads, so that each may be an unknown.

The material coordinate is a fraction ``S in [0, 1]`` of the meridian, on which the mesh does not depend on
any parameter. The unknowns are the radius over its reference value ``R``, and the displacement along the axis
from a shape that moves with its supports.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cached_property, partial
from typing import ClassVar

import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI

from weakforms.forms.materials import SurfaceLaw, surface_law
from weakforms.problems.branch_problem import from_rest
from weakforms.problems.diagram.followed import PLACE, Part, ended_by_law
from weakforms.problems.disk.phases import FIRST_T0, TAUT, USUAL_LOAD
from weakforms.problems.homogeneous.material_point import evaluated
from weakforms.problems.material_choice import Chosen
from weakforms.problems.meridian.blocks import LOWER, UPPER, Blocks, one_end
from weakforms.problems.meridian.body import Body, EndPosition
from weakforms.problems.meridian.limits import limit_along, limit_of, resistance
from weakforms.problems.meridian.model import MeridianModel
from weakforms.problems.tube.model import free_branch, yielding, yields
from weakforms.problems.tube.waves import AT_MIDDLE, EVEN, ODD, TubeWaves
from weakforms.solvers.continuation.branch import EquilibriumBranch
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, StepControl
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.least import LeastValue
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.modes import SecondVariation

WAVES = re.compile(r"n([1-9])")
"""Kinds of lines at which waves around the axis are neutral."""

Kind = Callable[..., EquilibriumBranch]
"""The class of a curve."""


class VariedModel(MeridianModel):
    """Weak form on ``S in [0, 1]``; loads are ``p``, the parameters of the body and constants of the law.

    Args:
        comm: Ranks.
        material: The law.
        values: First values of the body's parameters, and of constants of the law that vary.
        cells: Cells of the mesh.
        degree: Degree of the elements.
        grading: Concentration of cells at the last end.
    """

    body_of: ClassVar[Body]
    odd: ClassVar[EndPosition | None] = None
    """What holds at ``S = 0`` for displacements that are odd under the mirror there; ``None`` without a
    mirror."""
    parities: ClassVar[tuple[int, ...]] = ()
    """Parities along the axis of waves around it; none if waves are not computed."""
    depth: ClassVar[str]
    """Column of the largest displacement."""

    def __init__(
        self,
        comm: MPI.Intracomm,
        material: Chosen,
        values: Mapping[str, float],
        cells: int,
        degree: int,
        grading: float,
    ) -> None:
        mesh = Blocks([0.0, 1.0], cells, degree, 2 * degree + 2, grading=[one_end(grading)])
        super().__init__(comm, self.body_of, {"p": 0.0, **values}, mesh, material=material)
        self.unknown.interpolate(lambda x: np.vstack([np.ones_like(x[0]), np.zeros_like(x[0])]))

    @cached_property
    def full(self) -> SurfaceLaw:
        """The law, with the constants that vary as loads."""
        given = self.material_law
        constants = {**given.on(self.mesh), **{n: self.q[n] for n, _ in given.constants if n in self.q}}
        return surface_law(given.model, constants)

    def mass(self) -> ufl.Form:
        """``int |dx|^2 R dS``, which depends on no parameter."""
        (u, w), (v, y) = ufl.TrialFunction(self.space), ufl.TestFunction(self.space)
        radius = self.expressions["radius"]
        return (radius**2 * u * v + w * y) * radius * self.dx

    def formulation(self) -> Formulation:
        """The weak form with the least principal resultant."""
        given, (t1, t2) = super().formulation(), self.resultants
        return replace(
            given,
            maxima={"minus_t": ufl.max_value(-t1, -t2)},
            derived={"t_min": lambda v: -v["minus_t"]},
            internal=("minus_t", "resistance"),
            abscissa="S",
        )

    @cached_property
    def least(self) -> LeastValue:
        """The least principal resultant, whose zero is the onset of wrinkling."""
        t1, t2 = self.resultants
        return LeastValue(self.system, ufl.min_value(t1, t2), 2 * self.degree + 1)

    def at_onset(self) -> dict[str, float]:
        """Whether the least resultant is at the end, and where it is."""
        self.least.turn()
        return {"at_end": int(self.least.at_end), PLACE: self.least.place}

    @cached_property
    def limit(self) -> Callable[[State], str]:
        """Why the law takes no more than a state."""
        return limit_along(self)

    @cached_property
    def mirror(self) -> SecondVariation:
        """The second variation in displacements that are odd under the mirror at ``S = 0``."""
        base = self.system.formulation
        perturbation = fem.Function(self.space, name="odd")
        trial = ufl.TrialFunction(self.space)
        form = Formulation(
            unknown=perturbation,
            residual=base.residual,
            tangent=ufl.derivative(base.residual, self.unknown, trial),
            loads=base.loads,
            bcs=self.held_at({LOWER: self.odd, UPPER: self.body.held[1]}),
            mass=base.mass,
            monitors={},
        )
        return SecondVariation(form, self.system)

    def gives_way(self, point: CurvePoint) -> str:
        """Why the law takes no more stretch in the middle of the membrane; empty if it does."""
        raise NotImplementedError

    def operators(self, kind: str) -> dict[int, Callable[[], SecondVariation]]:
        """The second variations whose null vectors break a symmetry, by their parity along the axis.

        Args:
            kind: ``mirror``, or ``n1`` for one wave around the axis, and so on. None for other kinds.

        Returns:
            Functions, because the operators of one parity share their forms.
        """
        return {ODD: lambda: self.mirror} if kind == "mirror" and self.odd is not None else {}

    def part(self, _state: State) -> Part:
        """The whole branch."""
        return Part()

    def held_at(self, ends: Mapping[int, EndPosition]) -> list[fem.DirichletBC]:
        """Conditions that make displacements zero at ends, where they are not free."""
        out = []
        for tag, held in ends.items():
            for component, value in enumerate(held):
                if value is not None:
                    part = self.space.sub(component)
                    dofs = fem.locate_dofs_topological(part, 0, self.tags.find(tag))
                    out.append(fem.dirichletbc(np.array(0.0), dofs, part))
        return out

    def primary(self, end: float, step: float, kind: Kind = EquilibriumBranch) -> EquilibriumBranch:
        """The primary branch over ``p`` at the loads of the initial state.

        Args:
            end: Value of :attr:`depth` at which it ends.
            step: Largest arc-length step.
            kind: The class of the curve.
        """
        raise NotImplementedError


class VariedTube(VariedModel):
    r"""Half of the free tube of paper 2 from its mid-plane, ``Z = S l_f/2``: loads ``p, delta1, lf``.

    .. math:: \frac{\Pi}{2\pi} = \int_0^1 \Big[ \frac{l_f}{2\sqrt{\delta_1}} w(\lambda_1, \lambda_2)
              - \frac p2 \rho^2 \eta_{,S} \Big] \mathrm{d}S, \qquad
              \lambda_1 = \frac{2\delta_1}{l_f}\sqrt{\rho_{,S}^2 + \eta_{,S}^2}
    """

    name = "tube"
    depth = "u_max"
    odd = (0.0, None)
    parities = EVEN, ODD
    body_of = Body(
        name="tube",
        parameters=(),
        length=lambda _q: 1.0,
        radius=lambda _s, _q: 1.0,
        thickness=lambda _s, q: q["lf"] / (2 * ufl.sqrt(q["delta1"])),
        shape=lambda s, q: (0.0, s * q["lf"] / 2),
        held=((None, 0.0), (1.0, 0.0)),
        scales=lambda q: (2 * q["delta1"] / q["lf"], 1 / ufl.sqrt(q["delta1"])),
    )

    def formulation(self) -> Formulation:
        """The weak form with values at the mid-plane."""
        e, given, middle = self.expressions, super().formulation(), self.ends(LOWER)
        own = {
            "u_max": (e["r"] - 1) * middle,
            "lam1_mid": e["lam1"] * middle,
            "resistance": resistance(self.law, e["lam1"], e["lam2"]) * middle,
        }
        return replace(given, monitors=own | dict(given.monitors))

    def gives_way(self, point: CurvePoint) -> str:
        """The law may hardly resist more meridional stretch at the mid-plane."""
        return yielding(point) if yields(point) else ""

    @cached_property
    def _waves(self) -> TubeWaves:
        return TubeWaves(self)

    def operators(self, kind: str) -> dict[int, Callable[[], SecondVariation]]:
        """As for any body, with waves around the axis, even or odd along it."""
        numbered = WAVES.fullmatch(kind)
        if numbered is None:
            return super().operators(kind)
        waves = partial(self._waves.operator, int(numbered[1]))
        return {parity: partial(waves, AT_MIDDLE[parity]) for parity in self.parities}

    def primary(self, end: float, step: float, kind: Kind = EquilibriumBranch) -> EquilibriumBranch:
        """Free inflation up to ``u_max = end``."""
        delta1 = self.system.initial.loads["delta1"]
        return free_branch(self.system, delta1, end, step, kind, self.limit)


class VariedDisk(VariedModel):
    r"""The free disk of paper 1 over ``X = beta x``: loads ``p, beta``.

    .. math:: \frac{\Pi}{2\pi} = \int_0^1 \Big[ \frac{X}{\beta^2} W(\lambda_1, \lambda_2)
              + \frac p2 \rho^2 \eta_{,X} \Big] \mathrm{d}X, \qquad
              \lambda_1 = \beta\sqrt{\rho_{,X}^2 + \eta_{,X}^2}, \quad \lambda_2 = \beta\rho/X
    """

    name = "disk"
    depth = "t0"
    body_of = Body(
        name="disk",
        parameters=(),
        length=lambda _q: 1.0,
        radius=lambda x, _q: x,
        thickness=lambda _x, q: 1 / q["beta"] ** 2,
        held=((None, None), (1.0, 0.0)),
        scales=lambda q: (q["beta"], q["beta"]),
        upwards=-1.0,
        pole=True,
    )

    def formulation(self) -> Formulation:
        """The weak form with values at the pole."""
        e, given, pole = self.expressions, super().formulation(), self.ends(LOWER)
        own = {"t0": e["z"] * pole, "lam_pole": e["lam2"] * pole}
        return replace(given, monitors=own | dict(given.monitors))

    def primary(self, end: float, step: float, kind: Kind = EquilibriumBranch) -> EquilibriumBranch:
        """Free inflation up to ``t0 = end`` or the law's end, from rest or, if slack, from a small height."""
        beta = self.system.initial.loads["beta"]
        if beta >= TAUT:
            ends = {"usual_load": USUAL_LOAD, "kind": kind, "gives_way": self.gives_way}
            return ended_by_law(from_rest(self.system, "p", "t0", end, step, **ends), self)
        stretch, radius = beta + 0.3 * FIRST_T0**2, np.repeat(self.nodes(), 2)
        guess = self.system.initial.copy()
        guess.u[0::2] = (1 + (stretch / beta - 1) * (1 - radius**2))[0::2]
        guess.u[1::2] = (FIRST_T0 * (1 - radius**2))[1::2]
        tension = evaluated(self.material_law, stretch, stretch)["W1"]
        guess.loads["p"] = 4 * FIRST_T0 * tension / beta
        steps = StepControl(first=step / 4, largest=step, usual_load=USUAL_LOAD)
        continuation = Continuation(ExtendedNewton(self.system, ["p"]), control=steps)
        start = continuation.start(guess, Held("t0", FIRST_T0), towards={"t0": 1.0})

        def stop(point: CurvePoint) -> bool:
            return point.monitors["t0"] > end or bool(self.gives_way(point))

        return ended_by_law(kind(continuation, "p", start, stop), self)

    def gives_way(self, point: CurvePoint) -> str:
        """The law may take no more stretch at the pole; its constants may be loads."""
        law, stretch, loads = self.material_law, point.monitors["lam_pole"], point.state.loads
        constants = tuple((name, loads.get(name, value)) for name, value in law.constants)
        return limit_of(replace(law, constants=constants), [(stretch, stretch)])
