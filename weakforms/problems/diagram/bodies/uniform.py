r"""Bodies of one state all over, with all their parameters as loads.

Their stretches are the only unknowns. Displacements that break the symmetry of the state have a second
variation of their own, from the same energy: spherical harmonics of a balloon, long waves of a tube. They are
integrated over the meridian, on which the integrand is a polynomial, so that nothing is approximated. Every
rank solves the whole problem.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import ClassVar

import basix.ufl
import ufl
from dolfinx import fem
from dolfinx import mesh as dmesh
from mpi4py import MPI
from ufl.core.expr import Expr

from weakforms.forms.materials import stress_resultants
from weakforms.problems.branch_problem import from_rest
from weakforms.problems.diagram.followed import Part, ended_by_law
from weakforms.problems.homogeneous.body import Law
from weakforms.problems.homogeneous.problem import USUAL
from weakforms.problems.material_choice import Chosen
from weakforms.problems.meridian.limits import limit_of
from weakforms.solvers.continuation.branch import EquilibriumBranch
from weakforms.solvers.continuation.continuation import CurvePoint
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.equilibrium.system import System
from weakforms.solvers.stability.modes import SecondVariation

Pair = tuple[Expr, Expr]


@dataclass(frozen=True)
class Perturbation:
    """Displacements that a state does not have, with a few amplitudes.

    Attributes:
        size: Number of amplitudes ``a``.
        potential: ``a -> `` density of the potential on the mesh, up to terms of first order in ``a``.
        mass: ``(a, b) -> `` density of the mass.
        degree: Quadrature degree that integrates the second derivatives at ``a = 0``.
    """

    size: int
    potential: Callable[[tuple[Expr, ...]], Expr]
    mass: Callable[[tuple[Expr, ...], tuple[Expr, ...]], Expr]
    degree: int = 0


class VariedUniform:
    """Weak form of stretches that are the same everywhere; loads are ``p``, parameters, constants of the law.

    Args:
        material: The law.
        values: First values of the body's parameters, and of constants of the law that vary.
    """

    name: ClassVar[str]
    unknowns: ClassVar[tuple[str, ...]]
    """Names of the unknown stretches."""
    depth: ClassVar[str]

    def __init__(self, material: Chosen, values: Mapping[str, float]) -> None:
        self.material_law = material
        self.mesh = dmesh.create_unit_interval(MPI.COMM_SELF, 1)
        self.unknown = fem.Function(self._amplitudes(len(self.unknowns)), name=self.name)
        self.unknown.x.array[:] = 1.0
        constants = {n: fem.Constant(self.mesh, float(v)) for n, v in {"p": 0.0, **values}.items()}
        self.loads = {name: (constant, ufl.variable(constant)) for name, constant in constants.items()}
        self.q = {name: variable for name, (_, variable) in self.loads.items()}

    def _amplitudes(self, count: int) -> fem.FunctionSpace:
        element = basix.ufl.element("DG", "interval", 0, shape=(count,))
        return fem.functionspace(self.mesh, element)

    @cached_property
    def law(self) -> Law:
        """The law, with the constants that vary as loads."""
        given = self.material_law
        varied = {name: self.q[name] for name, _ in given.constants if name in self.q}
        return given.material.energy({**given.on(self.mesh), **varied})

    # -- what a body defines -------------------------------------------------------------------

    def stretches(self) -> Pair:
        """Both principal stretches."""
        raise NotImplementedError

    def potential(self, lam1: Expr, lam2: Expr) -> Expr:
        """The total potential at given pressure over ``2 pi``."""
        raise NotImplementedError

    def columns(self) -> dict[str, Expr]:
        """Further columns."""
        raise NotImplementedError

    def stretched(self, columns: Mapping[str, float]) -> tuple[float, float]:
        """Both stretches of a state, from its columns and loads."""
        raise NotImplementedError

    def perturbations(self, kind: str) -> dict[int, Perturbation]:
        """Displacements of a kind that break the symmetry, by their parity; 0 if they have none."""
        raise NotImplementedError

    def begin(self) -> State:
        """A guess of the state without pressure, at the loads of the initial state."""
        return self.system.initial.copy()

    # -- the discrete equations ----------------------------------------------------------------

    @cached_property
    def system(self) -> System:
        """The equilibrium equations."""
        unknown, (l1, l2) = self.unknown, self.stretches()
        dx = ufl.Measure("dx", self.mesh, metadata={"quadrature_degree": 0})
        t1, t2 = stress_resultants(self.law, l1, l2)
        total = self.potential(l1, l2)
        shown = {name: unknown[i] for i, name in enumerate(self.unknowns)} | self.columns() | {"Pi": total}
        space = unknown.function_space
        return System(
            Formulation(
                unknown=unknown,
                residual=ufl.derivative(total * dx, unknown, ufl.TestFunction(space)),
                loads=self.loads,
                bcs=[],
                mass=ufl.inner(ufl.TrialFunction(space), ufl.TestFunction(space)) * dx,
                monitors={n: ufl.as_ufl(v) * dx for n, v in (shown | {"t1": t1, "t2": t2}).items()},
                profile={"lam1": l1, "lam2": l2, "t1": t1, "t2": t2},
                abscissa="S",
                derived={"t_min": lambda values: min(values["t1"], values["t2"])},
                internal=("t1", "t2"),
            )
        )

    @cached_property
    def _variations(self) -> dict[str, dict[int, SecondVariation]]:
        return {}

    def operators(self, kind: str) -> dict[int, Callable[[], SecondVariation]]:
        """The second variations whose null vectors break a symmetry, by their parity."""
        return {parity: partial(self._variation, kind, parity) for parity in self.perturbations(kind)}

    def _variation(self, kind: str, parity: int) -> SecondVariation:
        known = self._variations.setdefault(kind, {})
        if parity not in known:
            given = self.perturbations(kind)[parity]
            space = self._amplitudes(given.size)
            unknown = fem.Function(space, name=f"{self.name}_{kind}")
            dx = ufl.Measure("dx", self.mesh, metadata={"quadrature_degree": given.degree})
            trial, test = (
                tuple(f[i] for i in range(given.size))
                for f in (ufl.TrialFunction(space), ufl.TestFunction(space))
            )
            total = given.potential(tuple(unknown[i] for i in range(given.size))) * dx
            residual = ufl.derivative(total, unknown, ufl.TestFunction(space))
            form = Formulation(
                unknown=unknown,
                residual=residual,
                tangent=ufl.derivative(residual, unknown, ufl.TrialFunction(space)),
                loads=self.loads,
                bcs=[],
                mass=given.mass(trial, test) * dx,
                monitors={},
            )
            known[parity] = SecondVariation(form, self.system)
        return known[parity]

    # -- how far the law goes ------------------------------------------------------------------

    @cached_property
    def least(self) -> Held:
        """Tension along the axis is zero; around it, the pressure is balanced by tension."""
        return Held("t1", 0.0)

    def at_onset(self) -> dict[str, float]:
        """Nothing, because all places are alike."""
        return {}

    def limit(self, state: State) -> str:
        """Why the law takes no more than a state."""
        with self.system.at(state):
            return self._limit_at(self.system.monitors(), state.loads)

    def gives_way(self, point: CurvePoint) -> str:
        """Why the law takes no more stretch beyond a point; empty if it does."""
        return self._limit_at(point.monitors, point.state.loads)

    def _limit_at(self, monitors: Mapping[str, float], loads: Mapping[str, float]) -> str:
        given = self.material_law
        constants = tuple((name, loads.get(name, value)) for name, value in given.constants)
        return limit_of(replace(given, constants=constants), [self.stretched({**monitors, **loads})])

    def part(self, _state: State) -> Part:
        """The whole branch."""
        return Part()

    def primary(self, end: float, step: float) -> EquilibriumBranch:
        """The primary branch over ``p`` at the loads of the initial state.

        Args:
            end: Value of the largest stretch at which it ends.
            step: Largest arc-length step.
        """
        ends = {"usual_load": USUAL, "gives_way": self.gives_way}
        return ended_by_law(from_rest(self.system, "p", self.depth, end, step, self.begin(), **ends), self)
