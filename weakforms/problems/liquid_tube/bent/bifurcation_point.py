"""Paper 3: the start of the secondary branch, the first ``n = 1`` bifurcation, on a mesh of the surface.

The axisymmetric problem gives only guesses (a state and a mode as columns over ``Z``). Eigenvalue and null
vector are computed on the mesh of the surface.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev
from scipy.interpolate import CubicSpline

from weakforms.errors import ConvergenceError
from weakforms.problems.liquid_tube.bent.fitted import Fitting, KeptNewton
from weakforms.problems.liquid_tube.bent.model import SurfaceModel
from weakforms.problems.liquid_tube.bent.surface import Shape
from weakforms.problems.liquid_tube.critical import AxisymmetricState, PrimaryBranch
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.spectra import Stability
from weakforms.solvers.support.roots import polynomial_through, root

NODES, SPAN = 6, 0.005
"""Number of volumes over which the coarsest mesh's bifurcation is interpolated: a Chebyshev grid within the
fraction :data:`SPAN` of the axisymmetric bifurcation's volume."""

BESIDE = tuple(chebyshev.chebpts1(4)), (0.4, 0.2)
"""Volumes, over :data:`SPAN`, at which the second mesh is compared with the coarsest one, and any further
mesh with the next coarser one. The difference is as small as the error of the coarser mesh, so that fewer
nodes suffice. Both volumes lie on one side of the bifurcation, so that the tangent of the first serves for
both."""

FARTHEST = 0.1
"""Relative difference of volumes within which the bifurcation of the coarsest mesh is sought beyond that: a
chord of the eigenvalue leads to it."""

CLOSE = 1e-12
"""Newton step, relative to the state, at which the solves for these states stop."""

LOOKED_AT = 3
"""Number of eigenvalues near zero among which the one with the axisymmetric branch's mode is searched."""

READINGS = 121
"""Material points ``Z`` of the splines for axisymmetric guesses."""

CLOSER = 1e-3
"""Share of the largest critical eigenvalue beside a bifurcation; at the bifurcation it is closer to zero."""

LIKENESS = 0.9
"""Smallest accepted overlap of the surface's null vector with the axisymmetric branch's mode."""


def position(of: AxisymmetricState) -> Shape:
    """An axisymmetric state as a surface."""
    r, z = CubicSpline(of.Z, of.r), CubicSpline(of.Z, of.z)
    return lambda s, theta: np.vstack([r(s) * np.cos(theta), r(s) * np.sin(theta), z(s)])


def displacement(of: AxisymmetricState) -> Shape:
    """The mode at a bifurcation point as a displacement, outward at ``Theta = 0``."""
    u, beta, w = (CubicSpline(of.Z, part) for part in of.mode)
    n = of.n

    def mode(s: np.ndarray, theta: np.ndarray) -> np.ndarray:
        c, sn = np.cos(n * theta), np.sin(n * theta)
        out, around = u(s) * c, beta(s) * sn
        return np.vstack(
            [
                out * np.cos(theta) - around * np.sin(theta),
                out * np.sin(theta) + around * np.cos(theta),
                w(s) * c,
            ]
        )

    return mode


def turned(shape: Shape) -> Shape:
    """The same displacement rotated by a quarter turn: the other mode of a double eigenvalue."""

    def mode(s: np.ndarray, theta: np.ndarray) -> np.ndarray:
        x, y, z = shape(s, theta - np.pi / 2)
        return np.vstack([-y, x, z])

    return mode


class Trend(NamedTuple):
    """Polynomials through axisymmetric states of a mesh near its bifurcation."""

    row: Callable[[float], np.ndarray]
    """Critical eigenvalue, columns and loads over the volume, from -1 to 1 within :data:`SPAN`. The
    coefficients of the front are the last loads; finer meshes have more of them."""
    finer: tuple[float, ...]
    """Points at which the next finer mesh is compared with this one."""
    volume: float
    """The volume that they are near."""
    alone: bool
    """Whether all states near the bifurcation have the same number of other negative eigenvalues."""


def bifurcation_on(
    model: SurfaceModel, primary: PrimaryBranch, at: AxisymmetricState, below: Trend | None = None
) -> tuple[Solved, np.ndarray, int, Trend]:
    """The bifurcation on the surface's mesh: state, null vector, number of other negative eigenvalues.

    At the point even the bordered matrix is singular, because the null vector breaks the symmetry of the
    branch. Eigenvalue, columns and state are therefore interpolated from axisymmetric states around it at
    given volumes. The caller must correct state and null vector, which are only as accurate as the
    interpolation.

    Args:
        model: The surface.
        primary: The axisymmetric branch.
        at: Bifurcation of that branch.
        below: Trend on the next coarser mesh.

    Raises:
        ConvergenceError: If the mode's eigenvalue has no zero near it, or the null vector is not that mode.
    """
    system, begin = model.system, at.values["V"]
    volume = begin if below is None else below.volume
    along = chebyshev.chebpts1(NODES) if below is None else np.array(below.finer)
    while True:
        solved, eigenvalues, modes, counts = _neighbouring_states(model, primary, at, volume, along)
        rows = [
            [eigenvalue, *s.values.values(), *s.state.loads.values()]
            for eigenvalue, s in zip(eigenvalues, solved, strict=True)
        ]
        trend = _trend(along, np.array(rows), below, len(set(counts)) == 1, volume)
        first, last = (float(trend.row(s)[0]) for s in (-1.0, 1.0))
        if first * last <= 0:
            break
        if below is not None:  # too far from that of the coarser mesh: sought for itself
            return bifurcation_on(model, primary, at)
        volume *= 1 + SPAN * (first + last) / (first - last) if first != last else 2.0
        if not abs(volume / begin - 1) < FARTHEST:
            raise ConvergenceError(
                f"no bifurcation on the surface within {FARTHEST:g} of V = {begin:g}: eigenvalues "
                f"{eigenvalues}, other negative ones {counts}; raise secondary_cells"
            )
    zero = root(lambda s: trend.row(s)[0], -1.0, 1.0, "the bifurcation on the surface", xtol=1e-14)
    _, *found = trend.row(zero).tolist()
    u, mode = (polynomial_through(along, np.array(v))(zero) for v in ([s.state.u for s in solved], modes))
    last = solved[-1].state
    like = model.interpolated(displacement(at), last.loads)
    with system.at(last):
        across, weighed = system.mass_times(mode), system.mass_times(like)
    if system.dot(like, across) < LIKENESS * np.sqrt(system.dot(like, weighed)):
        raise ConvergenceError("the null vector on the surface is not the axisymmetric branch's mode")
    names = solved[0].values
    state = State(u, dict(zip(solved[0].state.loads, found[len(names) :], strict=True)))
    values = dict(zip(names, found[: len(names)], strict=True))
    others = counts[0] if trend.alone else _others(model, state, like, CLOSER * max(map(abs, eigenvalues)))
    return Solved(values, state, "bifurcation_point"), mode, others, trend


def _others(model: SurfaceModel, state: State, like: np.ndarray, zero: float) -> int:
    """Number of negative eigenvalues of a state besides that of a mode, whose magnitude is below ``zero``.

    It is needed where another mode changes sign beside the bifurcation, so that the number at neighbouring
    states depends on their side of that point.
    """
    system = model.system
    modes, below = Stability(system).about(state, -zero, LOOKED_AT)
    with system.at(state):
        row = system.mass_times(like)
    critical = max(modes, key=lambda mode: abs(system.dot(row, mode.vector)))
    return below + sum(-zero < mode.eigenvalue < 0 for mode in modes if mode is not critical)


def _neighbouring_states(
    model: SurfaceModel, primary: PrimaryBranch, at: AxisymmetricState, volume: float, along: np.ndarray
) -> tuple[list[Solved], list[float], list[np.ndarray], list[int]]:
    """States near a bifurcation, their critical eigenvalues and modes, and the others below zero."""
    system, stability = model.system, Stability(model.system)
    fitting, usual = (Fitting(model, KeptNewton(system, ["zw"], *close)) for close in ((CLOSE,), ()))
    like, loads = model.interpolated(displacement(at)), system.initial.loads
    states, eigenvalues, vectors, counts = [], [], [], []
    for i, s in enumerate(along):
        begin = primary.at("V", volume * (1 + SPAN * s), at.Z)
        guess = model.state_of(position(begin), loads | {"zw": begin.values["zw"]})
        kept = i > 0 and min(along) > 0
        held = [Held("V", begin.values["V"])]
        try:
            state = fitting.solve(guess, held, chord=True, kept=kept)
        except ConvergenceError:  # under a very light liquid, round-off causes larger steps
            state = usual.solve(guess, held, chord=True)
        with system.at(state):
            states.append(Solved({"zw": state.loads["zw"], **system.monitors()}, state))
            modes, negative = stability.about(state, 0.0, LOOKED_AT)
            row = system.mass_times(like)
        loads = state.loads
        overlaps = [system.dot(row, mode.vector) for mode in modes]
        k = int(np.argmax(np.abs(overlaps)))
        eigenvalues.append(modes[k].eigenvalue)
        vectors.append(np.sign(overlaps[k]) * modes[k].vector)
        counts.append(negative - int(modes[k].eigenvalue < 0))
    for factor in (stability.factor, *(each.solver.factor for each in (fitting, usual))):
        factor.release()
    return states, eigenvalues, vectors, counts


def _trend(along: np.ndarray, rows: np.ndarray, below: Trend | None, alone: bool, volume: float) -> Trend:
    """Polynomials through rows of numbers, or through their differences from another mesh's trend."""
    size = rows.shape[1]

    def coarser(s: float) -> np.ndarray:
        known = np.zeros(0) if below is None else below.row(s)
        return np.append(known, np.zeros(size - len(known)))

    difference = polynomial_through(along, rows - [coarser(s) for s in along])
    alone = alone and (below is None or below.alone)
    return Trend(lambda s: coarser(s) + difference(s), BESIDE[below is not None], volume, alone)
