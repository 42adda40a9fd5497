r"""Critical points of the free tube by piecewise collocation of the full extended system.

Over the fraction s of the unstretched half length, y = (rho, eta, l1, b): radius, axial position, meridional
stretch and slope angle of paper 2 (Euler-Lagrange equations solved for the highest derivatives). Null vectors
are further components v of the same chain: with y' = f(y; p, tube), v' = f_y v. The extended system is

.. math:: y' = f(y), \quad v' = f_y(y) v, \quad \text{conditions of } y \text{ and } v, \quad
          \text{one component of } v(0) = 1,

with p and a parameter of the tube unknown. At the mid-plane a symmetric null vector (a limit point) has
v_eta = v_b = 0, one that is odd under the mirror v_rho = v_l1 = 0; both vanish with rho, eta at the disk.
Waves around the axis have six components, three displacements and three forces, and the linearised equations
of a surface in space (``tube_waves.strong``); even ones have no axial displacement, and none of the other two
forces, at the mid-plane. Two null vectors at once give a coincidence. Where T2 is zero at a front, or at the
disk, wrinkling begins.

The derivative along v is exact, by dual numbers.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from reference_data.solvers.beyond.tube_waves import strong
from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.collocation import Array, Ends, Mesh, Problem, Zone
from reference_data.solvers.core.mooney_rivlin import Tube

MESHES = (Mesh.graded(8, 11, 1.6), Mesh.graded(11, 14, 1.6))


class Dual:
    """A value and its derivative in one direction; both may be complex arrays."""

    __array_ufunc__ = None

    def __init__(self, value: Any, rate: Any = 0.0) -> None:
        self.value, self.rate = value, rate

    @staticmethod
    def of(x: Any) -> Dual:
        """A constant, or a dual number itself."""
        return x if isinstance(x, Dual) else Dual(x)

    def __add__(self, other: Any) -> Dual:
        other = Dual.of(other)
        return Dual(self.value + other.value, self.rate + other.rate)

    __radd__ = __add__

    def __neg__(self) -> Dual:
        return Dual(-self.value, -self.rate)

    def __sub__(self, other: Any) -> Dual:
        return self + (-Dual.of(other))

    def __rsub__(self, other: Any) -> Dual:
        return Dual.of(other) + (-self)

    def __mul__(self, other: Any) -> Dual:
        other = Dual.of(other)
        return Dual(self.value * other.value, self.rate * other.value + self.value * other.rate)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Dual:
        other = Dual.of(other)
        found = self.value / other.value
        return Dual(found, (self.rate - found * other.rate) / other.value)

    def __rtruediv__(self, other: Any) -> Dual:
        return Dual.of(other) / self


def sine(x: Any) -> Any:
    """The sine of a number or a dual number."""
    return Dual(np.sin(x.value), np.cos(x.value) * x.rate) if isinstance(x, Dual) else np.sin(x)


def cosine(x: Any) -> Any:
    """The cosine of a number or a dual number."""
    return Dual(np.cos(x.value), -np.sin(x.value) * x.rate) if isinstance(x, Dual) else np.cos(x)


def slope(l1: Any, l2: Any, a: Any) -> Any:
    """w_1; unlike that of the core, also for an alpha that is unknown."""
    return mat.slope(l1, l2, 0.0) + a * (mat.slope(l1, l2, 1.0) - mat.slope(l1, l2, 0.0))


def curvature(l1: Any, l2: Any, a: Any) -> Any:
    """w_11."""
    return mat.curvature(l1, l2, 0.0) + a * (mat.curvature(l1, l2, 1.0) - mat.curvature(l1, l2, 0.0))


def mixed(l1: Any, l2: Any, a: Any) -> Any:
    """w_12."""
    return mat.mixed(l1, l2, 0.0) + a * (mat.mixed(l1, l2, 1.0) - mat.mixed(l1, l2, 0.0))


def rates(y: list[Any], tube: Tube, p: Any) -> list[Any]:
    """(rho', eta', l1', b') over the unstretched axial coordinate."""
    rho, _, l1, b = y
    r0, a = tube.delta1**0.5, tube.alpha
    l2 = rho / r0
    w1, w2 = slope(l1, l2, a), slope(l2, l1, a)
    w11, w12 = curvature(l1, l2, a), mixed(l1, l2, a)
    s, c = sine(b), cosine(b)
    return [l1 * s, l1 * c, s * (w2 - l1 * w12) / (r0 * w11), (w2 * c - p * rho * l1) / (r0 * w1)]


def along(y: list[Any], v: list[Any], tube: Tube, p: Any) -> list[Any]:
    """Derivative of the rates along v."""
    found = rates([Dual(a, b) for a, b in zip(y, v, strict=True)], tube, p)
    return [value.rate for value in found]


def wave(n: int) -> Callable[[list[Any], list[Any], Tube, Any], list[Any]]:
    """Rates of displacements and forces of n waves around the axis, at a state."""

    def of_wave(y: list[Any], v: list[Any], tube: Tube, p: Any) -> list[Any]:
        base = y[0], y[2], y[3]
        q, m = v[:3], np.stack(np.broadcast_arrays(*v[3:], y[0], p)[:3], axis=-1)
        none = [0 * y[0]] * 3
        by_slope = [strong.forces(tube, n, p, base, none, unit)[0] for unit in np.eye(3)]
        stiff = np.stack(np.broadcast_arrays(*(part for row in by_slope for part in row)), axis=-1)
        stiff = np.swapaxes(stiff.reshape(*stiff.shape[:-1], 3, 3), -1, -2)
        known = strong.forces(tube, n, p, base, q, none)[0]
        rest = m - np.moveaxis(np.broadcast_to(known, (3, *m.shape[:-1])), 0, -1)
        slope = np.moveaxis(np.linalg.solve(stiff, rest[..., None])[..., 0], -1, 0)
        return [*slope, *strong.forces(tube, n, p, base, q, slope)[1]]

    return of_wave


@dataclass(frozen=True)
class Null:
    """A kind of null vector.

    Attributes:
        size: Number of its components.
        one: The component that is 1 at the mid-plane.
        none: Components that vanish there.
        disk: Components that vanish at the disk.
        rates: Its rates at a state.
    """

    size: int
    one: int
    none: tuple[int, ...]
    disk: tuple[int, ...]
    rates: Callable[[list[Any], list[Any], Tube, Any], list[Any]]


NULL = {
    "fold": Null(4, 0, (1, 3), (0, 1), along),
    "mirror": Null(4, 3, (0, 2), (0, 1), along),
    "n1": Null(6, 0, (2, 3, 4), (0, 1, 2), wave(1)),
    "n2": Null(6, 0, (2, 3, 4), (0, 1, 2), wave(2)),
}


def parts_of(kinds: Sequence[str], y: list[Any]) -> list[tuple[Null, list[Any]]]:
    """Each null vector's kind and components, behind the four of the state."""
    found, begin = [], 4
    for kind in kinds:
        found.append((NULL[kind], y[begin : begin + NULL[kind].size]))
        begin += NULL[kind].size
    return found


@dataclass(frozen=True)
class Point:
    """A critical point, or a guess: (y, v, ..) of each zone, and p, the parameter, a front.

    Attributes:
        tube: The tube; its parameter ``vary`` is replaced by the unknown.
        vary: Name of that parameter.
        nulls: Kinds of the null vectors.
        onset: Where T2 = 0: ``front``, ``end``, or nowhere.
    """

    tube: Tube
    vary: str
    nulls: tuple[str, ...]
    onset: str
    y: tuple[Array, ...]
    c: Array

    @property
    def u_max(self) -> float:
        """Displacement of the mid-plane."""
        return float(self.y[0][0, 0, 0]) - 1

    @property
    def numbers(self) -> dict[str, float]:
        """u_max, p, the parameter and, with an onset, its place as a fraction of the half length."""
        found = {"u_max": self.u_max, "p": float(self.c[0]), self.vary: float(self.c[1])}
        if self.onset:
            found["S_least"] = float(self.c[2]) if self.onset == "front" else 1.0
        return found


def problem(at: Point, held: dict[str, float]) -> Problem:
    """The extended system, with numbers that are held: u_max or the parameter."""

    def tube_of(c: list[Any]) -> Tube:
        return replace(at.tube, **{at.vary: c[1]})

    def right(d: int) -> Callable[[list[Any], Array, list[Any]], list[Any]]:
        def f(y: list[Any], _s: Array, c: list[Any]) -> list[Any]:
            tube = tube_of(c)
            share = 1.0 if len(at.y) == 1 else (c[2] if d == 0 else 1 - c[2])
            out = rates(y[:4], tube, c[0])
            for null, v in parts_of(at.nulls, y):
                out = out + null.rates(y[:4], v, tube, c[0])
            length = tube.lf / (2 * tube.delta1) * share
            return [length * value for value in out]

        return f

    def conditions(left: Ends, end: Ends, c: list[Any]) -> list[Any]:
        tube, first, disk = tube_of(c), left[0], end[-1]
        out = [first[1], first[3], disk[0] - 1, disk[1] - tube.lf / 2]
        pairs = zip(parts_of(at.nulls, first), parts_of(at.nulls, disk), strict=True)
        for (null, v), (_, last) in pairs:
            out += [v[i] for i in null.none] + [last[i] for i in null.disk] + [v[null.one] - 1]
        for before, after in zip(end[:-1], left[1:], strict=True):
            out += [a - b for a, b in zip(before, after, strict=True)]
        if at.onset:
            place = disk if at.onset == "end" else left[1]
            out.append(tension(place, tube))
            if at.onset == "front":
                out.append(tension_rate(place, tube, c[0]))
        values = {"u_max": first[0] - 1, at.vary: c[1], "p": c[0]}
        return out + [values[name] - value for name, value in held.items()]

    zones = tuple(Zone(mesh_of(part), right(d)) for d, part in enumerate(at.y))
    return Problem(zones, conditions)


_KNOWN: dict[tuple[int, int], Mesh] = {}


def mesh_of(part: Array) -> Mesh:
    """The mesh of nodal values."""
    return _KNOWN[part.shape[0], part.shape[1]]


def tension(y: list[Any], tube: Tube) -> Any:
    """T2 over C1 h_o, times l1."""
    return slope(y[0] / tube.delta1**0.5, y[2], tube.alpha)


def tension_rate(y: list[Any], tube: Tube, p: Any) -> Any:
    """Derivative of that along the tube."""
    f = rates(y[:4], tube, p)
    l1, l2 = y[2], y[0] / tube.delta1**0.5
    return curvature(l2, l1, tube.alpha) * f[0] / tube.delta1**0.5 + mixed(l1, l2, tube.alpha) * f[2]


def solve(at: Point, **held: float) -> Point:
    """The critical point at which numbers are held, from a guess.

    Raises:
        RuntimeError: If Newton's method does not converge.
    """
    y, c = problem(at, held).solve(at.y, at.c, f"critical point of {at.tube} at {held}", close=1e-9)
    return replace(at, y=y, c=c)


def equilibrium(tube: Tube, vary: str, mesh: Mesh, u: float) -> Point:
    """The state of free inflation with u_max = u, by steps from a small one."""
    _KNOWN[mesh.elements, mesh.degree + 1] = mesh
    x, length = mesh.x, tube.lf / (2 * tube.delta1)
    begin = min(u, 0.3)
    bend = -6 * begin * x**5 / length
    stretch, angle = np.hypot(tube.delta1, bend), np.arctan2(bend, tube.delta1 + 0 * x)
    y = [1 + begin * (1 - x**6), x * tube.lf / 2, stretch, angle]
    value = float(getattr(tube, vary))
    here = Point(tube, vary, (), "", (np.stack(y, axis=-1),), np.array([0.5, value]))
    for now in np.append(np.arange(begin, u, 0.1), u):
        here = solve(here, u_max=float(now), **{vary: value})
    return here


def with_nulls(state: Point, kinds: Sequence[str]) -> Point:
    """A guess of a critical point near a state: null vectors from the linear problem without one condition.

    The condition that is left out of each is that on its first component at the disk.
    """
    parts = [state.y[0]]
    mesh = mesh_of(state.y[0])
    tube, p = replace(state.tube, **{state.vary: float(state.c[1])}), float(state.c[0])
    length = tube.lf / (2 * tube.delta1)
    for kind in kinds:
        null = NULL[kind]

        def f(v: list[Any], s: Array, _c: list[Any], null: Null = null) -> list[Any]:
            y = list(np.moveaxis(mesh.rule.value @ state.y[0], -1, 0))
            return [length * value for value in null.rates(y, v, tube, p)]

        def conditions(left: Ends, end: Ends, c: list[Any], null: Null = null) -> list[Any]:
            first, disk = left[0], end[0]
            held = [first[i] for i in null.none] + [disk[i] for i in null.disk[1:]]
            return [*held, first[null.one] - 1, c[0]]

        linear = Problem((Zone(mesh, f),), conditions)
        zero = np.zeros((*state.y[0].shape[:-1], null.size))
        y, _ = linear.solve((zero,), np.array([0.0]), f"null vector of {kind}", longest=1e9)
        parts.append(y[0])
    return replace(state, nulls=tuple(kinds), y=(np.concatenate(parts, axis=-1),))


def recut(point: Point, mesh: Mesh) -> Point:
    """The same point on another mesh, as a guess."""
    _KNOWN[mesh.elements, mesh.degree + 1] = mesh
    return replace(point, y=tuple(mesh_of(part).evaluate(part, mesh.x) for part in point.y))


def cut_at(point: Point, share: float, mesh: Mesh) -> Point:
    """The same state in two zones with a front, as a guess of the onset of wrinkling inside."""
    _KNOWN[mesh.elements, mesh.degree + 1] = mesh
    (part,) = point.y
    zones = tuple(mesh_of(part).evaluate(part, x) for x in (share * mesh.x, share + (1 - share) * mesh.x))
    return replace(point, onset="front", y=zones, c=np.append(point.c[:2], share))


def turn_rate(at: Point) -> float:
    """Derivative of the parameter by u_max along the line, exactly."""
    _, dc = problem(at, {"u_max": at.u_max}).linearised(at.y, at.c).response()
    return float(dc[1])
