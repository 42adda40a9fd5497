r"""Bodies that deform homogeneously: their stretches are the only unknowns.

They are weak forms too, with one cell, constant unknowns, an energy and a load, so that the solvers of the
boundary-value problems compute branches, folds and cusps. Every rank solves the whole problem.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import basix.ufl
import ufl
from dolfinx import fem
from dolfinx import mesh as dmesh
from mpi4py import MPI
from ufl.core.expr import Expr

from weakforms.problems.material_choice import Chosen
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.system import System

Law = Callable[[Expr, Expr], Expr]


@dataclass(frozen=True)
class Body:
    """The definition of a body: the energy of its unknowns under a load, and its columns.

    Attributes:
        unknowns: Names of the unknown stretches, all 1 at rest.
        load: Name of the load.
        potential: ``(law, unknowns, load) -> Pi`` per reference volume over the law's stress.
        stretches: ``unknowns -> (lam1, lam2)``.
        extra: Additional columns, ``(law, unknowns, load) -> {name: expression}``.
        force: A dead force on the first unknown, constant while the load changes; a separate load ``force``.
    """

    unknowns: tuple[str, ...]
    load: str
    potential: Callable[[Law, tuple[Expr, ...], Expr], Expr]
    stretches: Callable[[tuple[Expr, ...]], tuple[Expr, Expr]]
    extra: Callable[[Law, tuple[Expr, ...], Expr], Mapping[str, Expr]] = lambda _w, _u, _p: {}
    force: float = 0.0


def system_of(body: Body, chosen: Chosen, vary: str = "", copies: int = 1) -> System:
    """Equilibrium equations of a body.

    Args:
        body: The body.
        chosen: Its material law.
        vary: A constant of the law that becomes a load too, for a fold line.
        copies: Number of states solved together under one load; names of columns of the second one end in
            ``_2``, and ``Pi_difference`` is the difference of the potentials of the first two.
    """
    mesh = dmesh.create_unit_interval(MPI.COMM_SELF, 1)
    count = len(body.unknowns)
    space = fem.functionspace(mesh, basix.ufl.element("DG", "interval", 0, shape=(copies * count,)))
    unknown = fem.Function(space, name="stretches")
    unknown.x.array[:] = 1.0
    constants: dict[str, Expr] = dict(chosen.on(mesh))
    given = {body.load: fem.Constant(mesh, 0.0), "force": fem.Constant(mesh, float(body.force))}
    loads = {name: (constant, ufl.variable(constant)) for name, constant in given.items()}
    if vary:
        constant = constants[vary]
        loads[vary] = (constant, ufl.variable(constant))
        constants[vary] = loads[vary][1]
    law, p, force = chosen.material.energy(constants), loads[body.load][1], loads["force"][1]
    states = [tuple(unknown[k * count + i] for i in range(count)) for k in range(copies)]
    potentials = [body.potential(law, u, p) - force * u[0] for u in states]
    monitors: dict[str, Expr] = {}
    for k, u in enumerate(states):
        lam1, lam2 = body.stretches(u)
        columns = {**dict(zip(body.unknowns, u, strict=True)), "lam1": lam1, "lam2": lam2}
        columns |= {**body.extra(law, u, p), "Pi": potentials[k]}
        monitors |= {name + (f"_{k + 1}" if k else ""): value for name, value in columns.items()}
    if copies > 1:
        monitors["Pi_difference"] = potentials[1] - potentials[0]
    dx = ufl.Measure("dx", mesh, metadata={"quadrature_degree": 0})
    return System(
        Formulation(
            unknown=unknown,
            residual=ufl.derivative(sum(potentials) * dx, unknown, ufl.TestFunction(space)),
            loads=loads,
            bcs=[],
            mass=ufl.inner(ufl.TrialFunction(space), ufl.TestFunction(space)) * dx,
            monitors={name: ufl.as_ufl(value) * dx for name, value in monitors.items()},
            profile={name: monitors[name] for name in ("lam1", "lam2")},
            abscissa="x",
        )
    )


def sphere() -> Body:
    r"""A thin spherical balloon, per reference area of its wall, over ``S h_o``.

    .. math:: \Pi = w(\lambda, \lambda) - \tfrac13 P \lambda^3, \qquad P = p\,r_o/(S h_o)

    so that :math:`P = 2 w_{,1}(\lambda, \lambda)/\lambda^2`.
    """
    return Body(
        unknowns=("lam",),
        load="P",
        potential=lambda w, u, p: w(u[0], u[0]) - p * u[0] ** 3 / 3,
        stretches=lambda u: (u[0], u[0]),
    )


def infinite_tube(force: float) -> Body:
    r"""A long thin tube that stays a cylinder, per reference area of its wall, over ``S h_o``.

    .. math:: \Pi = w(\lambda_1, \lambda_2) - \tfrac12 p\,\lambda_1\lambda_2^2 - F\lambda_1,
              \qquad p = P R_o/(S h_o)

    ``F`` is the axial force on its ends in addition to the pressure, over :math:`2\pi R_o h_o S`; without it
    the ends are closed and free.
    """
    return Body(
        unknowns=("lam1", "lam2"),
        load="p",
        potential=lambda w, u, p: w(*u) - p * u[0] * u[1] ** 2 / 2,
        stretches=lambda u: (u[0], u[1]),
        extra=lambda _w, u, _p: {"V": u[0] * u[1] ** 2},
        force=force,
    )


def coupon(loading: str) -> Body:
    r"""A test piece under a nominal stress ``T`` over ``S``.

    .. math:: \Pi = w(\lambda_1, \lambda_2) - T\lambda_1,\quad w(\lambda, \lambda) - 2T\lambda,\quad
              w(\lambda, 1) - T\lambda

    for ``uniaxial``, ``equibiaxial`` and ``pure_shear`` loading.
    """
    if loading == "uniaxial":
        return Body(
            unknowns=("lam", "lam_across"),
            load="T",
            potential=lambda w, u, t: w(*u) - t * u[0],
            stretches=lambda u: (u[0], u[1]),
        )
    biaxial = loading == "equibiaxial"
    return Body(
        unknowns=("lam",),
        load="T",
        potential=lambda w, u, t: w(u[0], u[0] if biaxial else 1.0) - (2 if biaxial else 1) * t * u[0],
        stretches=lambda u: (u[0], u[0] if biaxial else 1.0),
    )
