r"""The polyhedral cylinder a second time: energies of metrics and bilinear forms, eigenvalues by wave number.

Shares the description of the mesh with :mod:`.bloch` and nothing else. A triangle's strain energy is a
function of T = tr C and D = det C, which follow from the products of its edges, g now and G unloaded (edges
in space, or in the unrolled cylinder),

.. math:: T = G^{ab} g_{ab}, \quad D = \det g/\det G .

The liquid's energy is a product of two quadratic forms of nodal coordinates, d . M d of the depths and
x . K y/2, the projected area (or d . M x and y . K z/2), with M = (1 + I)/12 in closed form where the rule
of quadrature is exact and all of the triangle is wet, and a sum over wet points elsewhere. Second
derivatives are written out. What is unstable is told by the lowest eigenvalue of a band matrix, whose sign
is bisected.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import eig_banded

from reference_data.solvers.core.newton import newton
from reference_data.solvers.paper4.material import Array
from reference_data.solvers.paper5.bloch import RULES, Polyhedron

CYCLE = np.array([[0.0, 1.0, -1.0], [-1.0, 0.0, 1.0], [1.0, -1.0, 0.0]])  # y . CYCLE z: twice an area
EDGES = np.array([[-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]])
MOMENTS = {
    "edges": (np.ones((3, 3)) + np.eye(3)) / 12,
    "inside": (np.ones((3, 3)) + np.eye(3)) / 12,
    "centroid": np.ones((3, 3)) / 9,
    "nodes": np.eye(3) / 3,
}
NEAR = 3  # wave numbers to either side of those unstable that are followed while a bracket is halved


def turned(nodes: Array, angle: float) -> Array:
    """Points turned about the axis."""
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * nodes[..., 0] - s * nodes[..., 1], s * nodes[..., 0] + c * nodes[..., 1],
                     nodes[..., 2]], axis=-1)  # fmt: skip


def invariants(t: Array, d: Array, c2: float) -> tuple[Array, Array, Array, Array, Array]:
    """First and second derivatives of the relaxed energy by T and D: W_T, W_D, W_TT, W_TD, W_DD."""
    root = np.sqrt(t * t - 4 * d)
    x = (t + root) / 2  # the larger squared stretch
    taut, slack = d * (t - x) > 1, x <= 1
    w1 = 1 - x**-1.5 + c2 * (x**-0.5 - x**-2)
    w2 = 1.5 * x**-2.5 + c2 * (2 * x**-3 - x**-1.5 / 2)
    xt, xd = x / root, -1 / root
    xtt, xtd, xdd = -2 * d / root**3, t / root**3, -2 / root**3
    wrinkled = w1 * xt, w1 * xd, w2 * xt**2 + w1 * xtt, w2 * xt * xd + w1 * xtd, w2 * xd**2 + w1 * xdd
    full = 1 + c2 / d, -(d**-2) + c2 * (1 - t / d**2), 0 * t, -c2 / d**2, 2 * d**-3 + 2 * c2 * t / d**3
    return tuple(np.where(taut, a, np.where(slack, 0.0, b)) for a, b in zip(full, wrinkled, strict=True))


@dataclass
class Sector:
    """Triangles of one sector: rings and turns of their corners, unloaded metric, volume of material."""

    mesh: Polyhedron

    def __post_init__(self) -> None:
        mesh, i = self.mesh, np.arange(self.mesh.rings)
        low, up = (i, 0), (i + 1, 0)
        low_next, up_next = (i, 1), (i + 1, 1)
        cut = (
            ((low, up, low_next), (up, up_next, low_next))
            if mesh.flipped
            else ((low, up, up_next), (low, up_next, low_next))
        )
        self.ring = np.concatenate([np.stack([c[0] for c in t], axis=-1) for t in cut])
        self.next = np.concatenate([np.tile([c[1] for c in t], (len(i), 1)) for t in cut])
        height = self.ring * mesh.membrane.L / mesh.rings
        angle = 2 * np.pi / mesh.sectors * self.next
        flat = np.stack([angle, 0 * angle, height], axis=-1)
        round_ = np.stack([np.cos(angle), np.sin(angle), height], axis=-1)
        edges = EDGES @ (flat if mesh.arc else round_)
        metric = edges @ np.swapaxes(edges, 1, 2)
        self.inverse, self.det = np.linalg.inv(metric), np.linalg.det(metric)
        self.volume = np.sqrt(self.det) / 2 * mesh.membrane.eta(height.mean(axis=1))

    def corners(self, nodes: Array) -> Array:
        """Corners in space from the rings' nodes."""
        at = nodes[self.ring]
        beside = turned(at, 2 * np.pi / self.mesh.sectors)
        return np.where(self.next[..., None] == 1, beside, at)

    def elastic(self, x: Array) -> tuple[Array, Array]:
        """Gradient (triangles, 2, 3) and second derivative (triangles, 2, 3, 2, 3) by the two edges."""
        e = EDGES @ x
        g = e @ np.swapaxes(e, 1, 2)
        t, d = np.sum(self.inverse * g, axis=(1, 2)), np.linalg.det(g) / self.det
        w = invariants(t, d, float(self.mesh.membrane.c2))
        wt, wd, wtt, wtd, wdd = (v * self.volume for v in w)
        by_t = 2 * np.einsum("tab,tbi->tai", self.inverse, e)
        normal = np.cross(e[:, 0], e[:, 1])
        spun = np.zeros((len(x), 2, 3, 3))  # derivative of the normal by the edges
        for k, unit in enumerate(np.eye(3)):
            spun[:, 0, :, k], spun[:, 1, :, k] = np.cross(unit, e[:, 1]), np.cross(e[:, 0], unit)
        by_d = 2 * np.einsum("tj,tajk->tak", normal, spun) / self.det[:, None, None]
        hess = np.einsum("t,tab,ik->taibk", 2 * wt, self.inverse, np.eye(3))
        curved = 2 * np.einsum("tajk,tbjl->takbl", spun, spun)
        cross = np.zeros((3, 3, 3))
        for k, unit in enumerate(np.eye(3)):
            cross[:, k] = np.cross(unit, np.eye(3)).T  # (unit_k x v)_j = cross[j, k, l] v_l
        pair = 2 * np.einsum("tj,jkl->tkl", normal, cross)
        curved[:, 0, :, 1] += pair
        curved[:, 1, :, 0] += np.swapaxes(pair, 1, 2)
        hess += (wd / self.det)[:, None, None, None, None] * curved
        for weight, a, b in ((wtt, by_t, by_t), (wtd, by_t, by_d), (wtd, by_d, by_t), (wdd, by_d, by_d)):
            hess += np.einsum("t,tai,tbk->taibk", weight, a, b)
        return wt[:, None, None] * by_t + wd[:, None, None] * by_d, hess

    def moments(self, depth: Array) -> Array:
        """M of the wet part of each triangle, (triangles, 3, 3)."""
        points = RULES[self.mesh.rule]
        wet = (depth @ points.T > 0) / len(points)
        sums = np.einsum("tq,qn,qm->tnm", wet, points, points)
        return np.where((depth > 0).all(axis=1)[:, None, None], MOMENTS[self.mesh.rule], sums)

    def load(self, x: Array, level: float) -> tuple[Array, Array]:
        """Gradient (triangles, 3, 3) and second derivative (triangles, 3, 3, 3, 3) of the liquid's energy."""
        depth = level - x[:, :, 2]
        m, gamma = self.moments(depth), self.mesh.membrane.gamma
        md = np.einsum("tnm,tm->tn", m, depth)
        grad, hess = np.zeros_like(x), np.zeros((len(x), 3, 3, 3, 3))
        if self.mesh.potential == "area":
            # gamma d.Md/2 times minus the area, whose sign is that of the normal
            self._product(grad, hess, -gamma / 4, (2, md * -2, 2 * m, depth, 2), (0, 1), x)
        else:
            for c, (a, b) in ((0, (1, 2)), (1, (2, 0))):
                self._product(grad, hess, gamma / 4, (c, md, -m, depth, 2), (a, b), x)
        return grad, hess

    @staticmethod
    def _product(
        grad: Array, hess: Array, factor: float, form: tuple[int, Array, Array, Array, int],
        plane: tuple[int, int], x: Array,
    ) -> None:  # fmt: skip
        """Adds factor times (depth form) times (x_a . CYCLE x_b).

        The depth form is d.Md, with component c = 2, or d.M x_c: ``form`` holds c, its gradient by x_c, its
        mixed second derivative by z and x_c (for c = 2: by z twice), the depths, and 2 for z.
        """
        c, by_c, mixed, depth, z = form
        a, b = plane
        n = len(x)
        value = -np.einsum("tn,tn->t", by_c, depth) / 2 if c == z else np.einsum("tn,tn->t", by_c, x[:, :, c])
        first, second = np.zeros((n, 3, 3)), np.zeros((n, 3, 3, 3, 3))
        first[:, :, c] += by_c
        if c == z:
            second[:, :, z, :, z] += mixed
        else:
            first[:, :, z] += np.einsum("tnm,tm->tn", mixed, x[:, :, c])
            second[:, :, z, :, c] += mixed
            second[:, :, c, :, z] += mixed
        area = np.einsum("tn,nm,tm->t", x[:, :, a], CYCLE, x[:, :, b])
        slope, bend = np.zeros((n, 3, 3)), np.zeros((3, 3, 3, 3))
        slope[:, :, a], slope[:, :, b] = x[:, :, b] @ CYCLE.T, x[:, :, a] @ CYCLE
        bend[:, a, :, b], bend[:, b, :, a] = CYCLE, CYCLE.T
        grad += factor * (value[:, None, None] * slope + area[:, None, None] * first)
        both = np.einsum("tni,tmk->tnimk", first, slope)
        hess += factor * (
            value[:, None, None, None, None] * bend
            + area[:, None, None, None, None] * second
            + both
            + np.transpose(both, (0, 3, 4, 1, 2))
        )

    def assembled(self, nodes: Array, level: float) -> tuple[Array, Array]:
        """Force on the inner rings, and bands (3, 6, unknowns): coefficients of phase^-1, 1 and phase."""
        x = self.corners(nodes)
        gradient, hessian = self.load(x, level)
        inner, bend = self.elastic(x)
        gradient = gradient + np.einsum("an,tai->tni", EDGES, inner)
        hessian = hessian + np.einsum("an,taibk,bm->tnimk", EDGES, bend, EDGES, optimize=True)
        angle = 2 * np.pi / self.mesh.sectors * self.next
        frame = np.zeros((*angle.shape, 3, 3))
        frame[..., 0, 0] = frame[..., 1, 1] = np.cos(angle)
        frame[..., 1, 0], frame[..., 0, 1], frame[..., 2, 2] = np.sin(angle), -np.sin(angle), 1
        gradient = np.einsum("tnij,tni->tnj", frame, gradient)
        hessian = np.einsum("tnij,tnimk,tmkl->tnjml", frame, hessian, frame, optimize=True)
        force, size = np.zeros((self.mesh.rings + 1, 3)), 3 * (self.mesh.rings + 1)
        np.add.at(force, self.ring, gradient)
        bands = np.zeros((3, 6, size))
        for n in range(3):
            for m in range(3):
                rows = 3 * self.ring[:, n, None, None] + np.arange(3)[:, None]
                columns = 3 * self.ring[:, m, None, None] + np.arange(3)
                power = np.broadcast_to(
                    1 + (self.next[:, m] - self.next[:, n])[:, None, None], (len(x), 3, 3)
                )
                rows, columns = np.broadcast_arrays(rows, columns)
                lower = rows >= columns
                where = power[lower], (rows - columns)[lower], columns[lower]
                np.add.at(bands, where, hessian[:, n, :, m][lower])
        bands = bands[:, :, 3:-3].copy()
        for k in range(1, 6):
            bands[:, k, bands.shape[2] - k :] = 0
        return force[1:-1].ravel(), bands


@dataclass
class Cell:
    """A rotation-symmetric equilibrium and the bands of its second derivative."""

    sector: Sector
    nodes: Array
    level: float
    bands: Array

    def lowest(self, n: int) -> float:
        """Lowest eigenvalue of a wave number."""
        phase = np.exp(2j * np.pi * n / self.sector.mesh.sectors)
        band = self.bands[0] / phase + self.bands[1] + self.bands[2] * phase
        return float(eig_banded(band, lower=True, eigvals_only=True, select="i", select_range=(0, 0))[0])

    def unstable(self, among: Iterable[int] | None = None) -> list[int]:
        """Wave numbers with a negative eigenvalue."""
        numbers = range(self.sector.mesh.sectors // 2 + 1) if among is None else among
        return [n for n in numbers if self.lowest(n) < 0]


def equilibrium(sector: Sector, start: Array, level: float) -> Cell:
    """Rotation-symmetric equilibrium at a level, by Newton's method with dense matrices.

    Raises:
        RuntimeError: If it does not converge.
    """

    def correct(nodes: Array) -> tuple[float, Callable[[float], Array]]:
        force, bands = sector.assembled(nodes, level)
        whole = bands.sum(axis=0)
        size = whole.shape[1]
        matrix = np.zeros((size, size))
        for k in range(6):
            at = np.arange(size - k)
            matrix[at + k, at] = matrix[at, at + k] = whole[k, : size - k]
        step = np.zeros_like(nodes)
        step[1:-1] = -np.linalg.solve(matrix, force).reshape(-1, 3)
        return float(np.abs(step).max()), lambda share: nodes + share * step

    what = f"{sector.mesh.rings} x {sector.mesh.sectors} by the metric at zw = {level:g}"
    nodes = newton(start, correct, what, longest=0.2, close=1e-9, more=0)
    return Cell(sector, nodes, level, sector.assembled(nodes, level)[1])


def change(sector: Sector, start: Array, stable: float, unstable: float, width: float) -> tuple[float, int]:
    """Level between a stable and an unstable one where the first wave number turns, and that number.

    Raises:
        RuntimeError: If the ends are not what they are said to be, or other wave numbers turn first.
    """
    here = equilibrium(sector, start, stable)
    there = equilibrium(sector, here.nodes, unstable)
    turning = there.unstable()
    if here.unstable() or not turning:
        raise RuntimeError(f"{sector.mesh}: no change of stability between {stable:.10g} and {unstable:.10g}")
    among = sorted(
        {n + k for n in turning for k in range(-NEAR, NEAR + 1)} & set(range(sector.mesh.sectors // 2 + 1))
    )
    while abs(there.level - here.level) > width:
        middle = equilibrium(sector, there.nodes, (here.level + there.level) / 2)
        if middle.unstable(among):
            there = middle
        else:
            here = middle
    left = there.unstable()
    if here.unstable():
        raise RuntimeError(f"{sector.mesh}: other wave numbers turn beside {here.level:.10g}")
    return (here.level + there.level) / 2, left[len(left) // 2]
