r"""Limit pressures of tubes that are thinner on one side, and the law of Koiter that they tend to.

On the even tube phi is the null vector where it begins to bow, with an offset of one in the middle. A bowed
state has p = p_c + p_2 A^2, A the offset. With A1 the rate of phi.K.phi along free inflation, over its
pressure, and B = phi.F_,eps, the limit pressure of the thickness 1 + eps cos(Theta) is

.. math:: p = p_c + 3 p_2 \Big(\frac{\varepsilon |B|}{2 |A_1 p_2|}\Big)^{2/3} + O(\varepsilon^{4/3}).

The left null vector takes the place of phi where the equations are not the derivative of an energy.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq

from reference_data.solvers.beyond.bowed.collocation import Collocation
from reference_data.solvers.beyond.bowed.galerkin import Galerkin
from reference_data.solvers.core.collocation import Array, lagrange
from reference_data.solvers.core.newton import newton

COARSE = 20, 2
"""Degree and waves of the first axisymmetric state."""
NEAR = 2e-3
"""Difference of radii over which rates along the axisymmetric states are central differences."""
STENCIL = {-2: 1 / 12, -1: -2 / 3, 1: 2 / 3, 2: -1 / 12}
"""Weights of the states beside one, of fourth order."""
OFFSETS = 0.1, 0.2, 0.3, 0.4
"""Offsets of bowed states of the even tube, through which a polynomial of A^2 is fitted."""


BESIDE = 1e-3
"""Part of an offset by which states are apart whose volumes are compared at an extremum."""

AROUND = 0.7, 1.25
"""Offsets over that of the law between which a limit is sought."""


@dataclass(frozen=True)
class State:
    """A state of one method."""

    of: Galerkin | Collocation
    x: Array
    p: float
    uneven: float = 0.0

    @property
    def offset(self) -> float:
        """Mean of x in the middle."""
        return float(self.of.offset @ self.x[self.of.free])

    @property
    def volume(self) -> float:
        """Volume of a quarter beyond that at rest."""
        return self.of.volume(self.x)


def solve(guess: State, row: Array, value: float, bows: bool = True) -> State:
    """The state at which a row reads a value, with unknown pressure.

    Args:
        guess: A state nearby.
        row: The row.
        value: Its value.
        bows: If not, a force that vanishes keeps the offset at zero: the equations are regular also where the
            tube begins to bow.

    Raises:
        RuntimeError: If Newton's method fails.
    """
    of, rows = guess.of, np.array([row] if bows else [row, guess.of.offset])
    wanted = np.array([value, 0.0])[: len(rows)]

    def correct(at: State) -> tuple[float, Callable[[float], State]]:
        f, k, load, _ = of.evaluate(at.x, at.p, at.uneven)
        more = np.column_stack([load, *rows[1:]])
        matrix = np.block([[k, more], [rows, np.zeros((len(rows),) * 2)]])
        step = np.linalg.solve(matrix, np.append(-f, wanted - rows @ at.x[of.free]))

        def advance(share: float) -> State:
            x = at.x.copy()
            x[of.free] += share * step[: len(f)]
            return replace(at, x=x, p=float(at.p + share * step[len(f)]))

        return float(np.abs(step).max()), advance

    return newton(guess, correct, "bowed tube")


def rate(state: State) -> float:
    """Pressure over the offset along the branch of a state."""
    _, k, load, _ = state.of.evaluate(state.x, state.p, state.uneven)
    row = state.of.offset
    out = np.linalg.solve(
        np.block([[k, load[:, None]], [row, np.zeros((1, 1))]]), np.append(np.zeros(len(k)), 1.0)
    )
    return float(out[-1])


@dataclass(frozen=True)
class Law:
    """Where the even tube begins to bow, and the constants of the law."""

    start: State
    mode: Array
    p_2: float
    rate: float
    push: float
    volume_2: float
    """V - V_c over the square of the offset."""
    volume_rate: float
    """dV/dp along the axisymmetric states."""

    @property
    def constant(self) -> float:
        """(p - p_c)/eps^(2/3) as eps vanishes."""
        return 3 * self.p_2 * (abs(self.push) / (2 * abs(self.rate * self.p_2))) ** (2 / 3)

    @property
    def volume_constant(self) -> float:
        """(V - V_c)/eps^(2/3) at the extremum of the volume as eps vanishes."""
        force = abs(self.volume_rate * self.push / (2 * self.rate * self.volume_2))
        return 3 * self.volume_2 * force ** (2 / 3)

    def offset(self, uneven: float, of_volume: bool = False) -> float:
        """Offset at the limit pressure, or at the extremum of the volume, to leading order."""
        second = self.volume_2 / self.volume_rate if of_volume else self.p_2
        return float(np.cbrt(-uneven * self.push / (2 * self.rate * second)))


def straight(of: Galerkin | Collocation, radius: float, guess: State | None = None) -> State:
    """The axisymmetric state with a radius in the middle; the first by steps from a smaller one, coarsely."""
    if guess is None:
        coarse = type(of)(2 * of.half, *COARSE)
        near = State(coarse, coarse.tube(1 + 0.1 * (1 - coarse.nodes**6), of.half * coarse.nodes), 0.6)
        for r in np.linspace(1.1, radius, 6):
            near = solve(near, coarse.radius, float(r), bows=False)
        rows = lagrange(coarse.nodes, of.nodes)
        guess = State(of, of.tube(*(rows @ part for part in coarse.meridian(near.x))), near.p)
    return solve(guess, of.radius, radius, bows=False)


def _bordered(state: State, transposed: bool = False) -> tuple[Array, float]:
    """Vector of offset one that K (or its transpose) takes to a multiple of the offset, and the multiple."""
    _, k, *_ = state.of.evaluate(state.x, state.p, 0.0)
    row = state.of.offset
    matrix = np.block([[k.T if transposed else k, row[:, None]], [row, np.zeros((1, 1))]])
    out = np.linalg.solve(matrix, np.append(np.zeros(len(row)), 1.0))
    return out[:-1], -float(out[-1])


def law(first: State, low: float, high: float, offsets: Sequence[float] = OFFSETS) -> Law:
    """Where the even tube bows, between two radii in its middle, and the constants there.

    Args:
        first: An axisymmetric state near the smaller radius.
        low: The smaller radius.
        high: The larger one.
        offsets: Offsets of bent states, through which a polynomial is fitted.
    """
    of = first.of
    at = brentq(lambda r: _bordered(straight(of, r, first))[1], low, high, xtol=1e-13)
    start = straight(of, at, first)
    mode, left = _bordered(start)[0], _bordered(start, transposed=True)[0]
    beside = [straight(of, at + side * NEAR, start) for side in STENCIL]
    weights = np.array(list(STENCIL.values())) / NEAR
    slope, swelling = (float(weights @ [getattr(s, name) for s in beside]) for name in ("p", "volume"))
    rate_of = float(weights @ [left @ of.evaluate(s.x, s.p, 0.0)[1] @ mode for s in beside]) / slope
    push = float(left @ of.evaluate(start.x, start.p, 0.0)[3])
    states = []
    for offset in offsets:
        guess = states[-1] if states else start
        x = guess.x.copy()
        x[of.free] += (offset - guess.offset) * mode
        states.append(solve(replace(guess, x=x), of.offset, offset))
    squares = np.append(0, np.square(offsets))
    second, volume_2 = (
        float(np.polyfit(squares, [getattr(s, name) for s in (start, *states)], len(offsets))[-2])
        for name in ("p", "volume")
    )
    return Law(start, mode, second, rate_of, push, volume_2, swelling / slope)


def limits(about: Law, uneven: Sequence[float], of_volume: bool = False) -> list[State]:
    """The limits of uneven tubes on their branches from rest, with growing unevenness.

    Args:
        about: Where the even tube bends.
        uneven: The unevennesses.
        of_volume: Whether extrema of the volume are wanted, instead of those of the pressure.
    """
    of, found = about.start.of, []
    for value in uneven:
        size = about.offset(value, of_volume)
        near = found[-1] if found else about.start
        x = near.x.copy()
        if not found:
            x[of.free] += size * about.mode
        begin = size if not found else near.offset
        states = [solve(replace(near, x=x, uneven=value), of.offset, begin)]

        def slope(factor: float, states: list[State] = states, size: float = size) -> float:
            near = min(states, key=lambda s: abs(s.offset - factor * size))
            if of_volume:
                ends = [solve(near, of.offset, (factor + d) * size) for d in (-BESIDE, BESIDE)]
                states.extend(ends)
                return ends[1].volume - ends[0].volume
            states.append(solve(near, of.offset, factor * size))
            return rate(states[-1])

        at = brentq(slope, *AROUND, xtol=1e-9)
        found.append(solve(states[-1], of.offset, at * size))
    return found
