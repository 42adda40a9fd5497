r"""Paper 1: the phases of the disk against its substrate.

What is frozen at the front of a patch that grows continues the free part with its slopes:

.. math:: \rho_c'(x_f) = \rho'(x_f^+), \qquad F'(x_f) = -\eta'(x_f^+) \qquad \text{for every } x_f

with ``rho_c = x Lc(x)``. ``Lc`` and ``F'/x`` are Chebyshev series in ``x``. Both are even, but they contain a
term ``x^4 log x``, whose coefficients decrease like ``m^-9`` in series in ``x`` and like ``m^-5`` in series
in ``x**2``.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

import numpy as np
from mpi4py import MPI
from numpy.polynomial import chebyshev

from weakforms.problems.contact.guesses import moved
from weakforms.problems.contact.history import History
from weakforms.problems.contact.model import Bond
from weakforms.problems.contact.phases import ContactPhases
from weakforms.problems.disk.model import DiskData, DiskModel
from weakforms.problems.homogeneous.material_point import evaluated
from weakforms.problems.material_choice import Chosen
from weakforms.problems.meridian.limits import limit_of
from weakforms.solvers.continuation.branch import EquilibriumBranch
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State

HIGHEST_P = 50.0
"""Largest pressure at which inflation may end."""

FIRST_T0 = 0.05
"""Pole height of the first state of a disk without tension at rest, whose tangent is singular there."""

TAUT = 1.02
"""Pre-stretch above which the branch starts at ``p = 0``."""

USUAL_LOAD = 10.0
"""Pressure above which steps grow with it: at a large pre-stretch it dominates the arc length."""

THIN = 20.0
"""Largest stretch of a pole thinner than the clamp, over the pre-stretch."""

FREE_FRONT = 0.5
"""Position at which the free membrane's mesh is divided, as a fraction of its radius; it is arbitrary."""


def parabola(x: np.ndarray, law: Chosen, beta: float) -> tuple[np.ndarray, float]:
    """A first state of pole height ``FIRST_T0``, slightly stretched, and the pressure its tension carries.

    Args:
        x: Radius of every degree of freedom, ``lam2`` and ``eta`` in turn.
        law: The membrane's.
        beta: Pre-stretch.
    """
    lam = beta + 0.3 * FIRST_T0**2
    square = (x * beta) ** 2
    u = np.empty_like(x)
    u[0::2] = beta + (lam - beta) * (1 - square[0::2])
    u[1::2] = FIRST_T0 * (1 - square[1::2])
    tension = evaluated(law, lam, lam)["W1"]
    return u, 4 * FIRST_T0 * tension / beta


class DiskHistory(History):
    """Of the stretch ``Lc`` and the steepness ``F'/x`` with which each ring stuck."""

    conditions = ("rho_slope_outside", "steepness")

    def __init__(self, model: DiskModel) -> None:
        count, span = model.bond.terms, model.bond.span
        # Radau points in t = 2 x/span - 1: they include the end, but not the pole, where there is no free
        # part.
        t = np.cos(2 * np.pi * np.arange(count) / (2 * count - 1))
        fronts, basis = span * (1 + t) / 2, chebyshev.chebvander(t, count - 1)
        slopes = np.stack([chebyshev.chebval(t, chebyshev.chebder(e)) for e in np.eye(count)], axis=1)
        slopes = slopes * 2 / span
        radial = basis + fronts[:, None] * slopes  # rho_c' = Lc + x Lc', from the coefficients of Lc
        frozen = np.eye(2 * count)
        frozen[:count, :count] = radial @ np.linalg.inv(basis)
        # The defect of F', not of F'/x, whose round-off at a small front has little effect.
        super().__init__(model, t, frozen, weights=np.append(np.ones(count), fronts))
        self._t = t

    def write(self, x: np.ndarray) -> None:
        """Write the series of ``Lc``, ``F`` and ``I``; the latter two are integrals."""
        half, terms = self.span / 2, self.model.bond.terms
        lam2, q = (chebyshev.chebfit(self._t, values, len(values) - 1) for values in np.split(x, 2))
        falling = chebyshev.chebmul([half, half], q)  # dF/dx
        depth = chebyshev.chebint(falling, lbnd=-1.0) * half
        radius = chebyshev.chebmul([half, half], lam2)
        density = chebyshev.chebmul(falling, chebyshev.chebmul(radius, radius)) / 2  # dI/dx
        moment = chebyshev.chebint(density, lbnd=-1.0) * half
        self.model.series["lam2"].set(lam2)
        self.model.series["depth"].set(_shortened(depth, terms + 1))
        self.model.series["moment"].set(_shortened(moment, 2 * terms))

    def guess(self, slipped: Sequence[Solved]) -> np.ndarray:
        """Hoop stretches and steepness at the front without friction."""
        lam2 = [self.model.at_front(solved) for solved in slipped]
        return np.append(lam2, [solved.values["steepness"] for solved in slipped])


def _shortened(series: np.ndarray, terms: int) -> np.ndarray:
    """A series of fewer terms that interpolates a longer one at Chebyshev points with both ends."""
    t = np.cos(np.pi * np.arange(terms) / (terms - 1))
    return chebyshev.chebfit(t, chebyshev.chebval(t, series), terms - 1)


class DiskPhases(ContactPhases):
    """All phases of the disk on one mesh.

    Args:
        comm: Ranks.
        data: Membrane, substrate and mesh.
        adhesion: ``locked`` (both stretches stick) or ``radial`` (only the radius does).
        p_end: Pressure at which inflation against the substrate ends.
        step: Largest arc-length step.
        terms: Number of terms of the stuck patch's series.
    """

    name = "circular"
    depth = "t0"
    place: ClassVar[tuple[str, float]] = ("l", 0.0)
    nearer = "choose a smaller l or beta"
    whole = "radius"
    highest_p = HIGHEST_P
    first_front, last_front = 0.02, 0.97
    usual_load = USUAL_LOAD

    def __init__(
        self, comm: MPI.Intracomm, data: DiskData, adhesion: str, p_end: float, step: float, terms: int
    ) -> None:
        super().__init__(DiskModel(comm, data), p_end, step, terms)
        self._rigid = adhesion == "locked"

    def inflate(self, depth: float) -> EquilibriumBranch:
        """Free inflation up to a pole height."""
        solver = ExtendedNewton(self.slip.system, ["p"])
        front = FREE_FRONT * self.data.length
        flat = self.slip.system.initial
        state = State(flat.u.copy(), flat.loads | {"front": front})
        held = Held("p", 0.0)
        if self.data.beta < TAUT:
            x = np.repeat(self.slip.material(self.slip.nodes(), state.loads), 2)
            u, p = parabola(x, self.data.law, self.data.beta)
            state, held = State(u, state.loads | {"p": p}), Held("t0", FIRST_T0)
        continuation = Continuation(solver, control=self.steps(8))
        start = continuation.start(state, held, towards={"t0": 1.0})
        branch = EquilibriumBranch(
            continuation, "p", start, lambda q: q.monitors["t0"] > depth or bool(self.gives_way(q))
        )
        last = branch.points[-1]
        if last.monitors["t0"] < depth:
            at = f"t0 = {last.monitors['t0']:.6g}, p = {last.state.loads['p']:.6g}"
            followed, why = f"free inflation was followed up to {at}", self.gives_way(last)
            branch.ended = f"{followed}: {why}" if why else None
            branch.stalled = None if why else f"{followed}: {branch.stalled}"
        return branch

    def gives_way(self, point: CurvePoint) -> str:
        """The law may take no more stretch at the pole, beside the front, or at the clamp.

        A thin pole may stretch without limit, so that no mesh resolves it.
        """
        at, x = point.monitors, point.state.loads["front"]
        if at["lam_pole"] > THIN * self.data.beta and self.data.M < 1:
            return f"the thin pole, M = {self.data.M:g}, is stretched to more than {THIN:g} times beta"
        beside = [(at[name], at["rho_contact"] / x) for name in ("lam1_contact", "lam1_contact_outer")]
        return limit_of(
            self.data.law, [(at["lam_pole"], at["lam_pole"]), *beside, (at["lam1_rim"], self.data.beta)]
        )

    def small_patch(self) -> State:
        """The membrane at first touch, on the mesh of a small patch, with springs."""
        solver = ExtendedNewton(self.slip.system, ["p"])
        guess = moved(self.slip, self.onset.state, self.first_front * self.data.length)
        state, _ = solver.solve(guess, [Held("t0", self.data.touch)])
        state.loads["k"] = self.data.k
        return state

    def bonded(self, span: float) -> DiskHistory:
        """A patch that keeps both its stretches, or its radius."""
        return DiskHistory(
            DiskModel(self.slip.mesh.comm, self.data, Bond(self.terms, span, rigid=self._rigid))
        )

    @property
    def slack(self) -> float:
        """Without pre-stretch, the height of the first state."""
        return FIRST_T0 if self.data.beta < TAUT else super().slack
