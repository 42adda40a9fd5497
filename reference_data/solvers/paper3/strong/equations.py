r"""Collocation for the fluid-loaded tube without axial symmetry: balance of forces, point by point.

The second method of the bent states; :mod:`bent.equations` is the first. With tangents a = x_,Z and
b = x_,Theta, c = a x b, the forces on cuts Z = const and Theta = const, per material length, are the
derivatives of the strain energy (|a|^2 + |b|^2 + 1/|c|^2 - 3)/2 by a and b in Cartesian components,

.. math:: f_a = a - b\times c/|c|^4, \quad f_b = b - c\times a/|c|^4,

and the balance of forces of an element between the material curves s = const and Theta = const is

.. math:: (f_a - Z_{,\Theta} f_b)_{,s} + (Z_{,s} f_b)_{,\Theta} + Z_{,s} \gamma (z_w - z)\, b\times a = 0 ,

collocated at the inner nodes; the force f_a - Z_,Theta f_b is continuous between elements, among them the
free surface, which is the curve s = 1. Unknowns are positions at Chebyshev-Lobatto nodes in s and at
Theta_j = 2 pi j/(2 M + 1), 0 <= j <= M (the other half by mirror symmetry). Nothing is integrated, there
are no test functions, and no formula of the metric is used. The forces of another law are those of
:mod:`strong.principal`, those of a sheet that wrinkles its own.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from reference_data.solvers.core.collocation import lagrange
from reference_data.solvers.core.laws import Law
from reference_data.solvers.core.newton import newton as iterate
from reference_data.solvers.paper3.bent.newton import Factor, Kept
from reference_data.solvers.paper3.data import FluidTube
from reference_data.solvers.paper3.strong import principal
from reference_data.solvers.paper3.strong.net import EVEN, ODD, Array, Net, waves

SYMMETRIC = (EVEN, ODD, EVEN)  # parities of x, y, z about Theta = 0 and pi
BREAKING = (ODD, EVEN, ODD)
CONVERGED = 2e-10  # size of the last step; what is left is at most a tenth of it
CROSS = np.zeros((3, 3, 3))  # CROSS[i, j, k] u_j v_k = (u x v)_i
for _i, _j, _k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
    CROSS[_i, _j, _k], CROSS[_i, _k, _j] = 1, -1


def spun(u: Array) -> Array:
    """Matrix (..., 3, 3) of v -> u x v."""
    return np.einsum("ijk,...j->...ik", CROSS, u)


def forces(a: Array, b: Array, law: Any = None) -> tuple[Array, Array]:
    """Forces on cuts Z = const and Theta = const, per material length, shapes (..., 3)."""
    if law is not None:
        return principal.forces(a, b, law) if isinstance(law, Law) else law.forces(a, b)
    c = np.cross(a, b)
    fourth = np.sum(c * c, axis=-1, keepdims=True) ** 2
    return a - np.cross(b, c) / fourth, b - np.cross(c, a) / fourth


def rates(a: Array, b: Array, law: Any = None) -> Array:
    """Derivative of the forces by (a, b), shape (..., 2, 3, 2, 3)."""
    if law is not None:
        return principal.rates(a, b, law) if isinstance(law, Law) else law.rates(a, b)
    c, one = np.cross(a, b), np.eye(3)
    square = np.sum(c * c, axis=-1)[..., None, None]
    dc = -spun(b), spun(a)  # of c by a and by b
    arms = np.cross(b, c), np.cross(c, a)
    out = np.empty((*a.shape[:-1], 2, 3, 2, 3))
    for i in (0, 1):
        for k in (0, 1):
            turn = spun(b) @ dc[k] if i == 0 else -spun(a) @ dc[k]
            if i != k:  # the arm itself changes as well
                turn = turn + (-spun(c) if i == 0 else spun(c))
            along = np.einsum("...i,...j,...jk->...ik", arms[i], c, dc[k])
            out[..., i, :, k, :] = (i == k) * one - turn / square**2 + 4 * along / square**3
    return out


@dataclass(frozen=True)
class Bent:
    """A membrane: positions (elements, nodes, angles, 3), level, and Z of the free surface at the angles."""

    tube: FluidTube
    net: Net
    x: Array
    zw: float
    front: Array

    def front_at(self, theta: Array) -> tuple[Array, Array]:
        """Z of the free surface and its derivative."""
        return tuple(waves(self.front, self.net.theta, theta, EVEN, k) for k in (0, 1))

    def mapping(self, e: int) -> tuple[Array, Array]:
        """Z_,s and Z_,Theta at fixed s in an element, shapes (nodes, angles)."""
        s, _ = self.net.element(e)
        slope, wet = self.net.turns[EVEN] @ self.front, e < self.net.wet
        z_s = np.tile(self.front if wet else self.tube.length - self.front, (len(s), 1))
        return z_s, np.outer(s if wet else 2 - s, slope)

    def tangents(self, e: int) -> tuple[Array, Array]:
        """x_,Z and x_,Theta at the nodes of an element, shapes (nodes, angles, 3)."""
        _, d = self.net.element(e)
        z_s, z_theta = self.mapping(e)
        a = np.einsum("im,mjc->ijc", d, self.x[e]) / z_s[..., None]
        turned = [self.x[e][..., c] @ self.net.turns[p].T for c, p in enumerate(SYMMETRIC)]
        return a, np.stack(turned, axis=-1) - a * z_theta[..., None]

    def evaluate(self, z_material: Array, theta: Array) -> tuple[Array, Array, Array]:
        """Position and tangents x_,Z, x_,Theta at Z (i,) or (i, j) and Theta (j,): shapes (i, j, 3)."""
        net, length = self.net, self.tube.length
        theta = np.atleast_1d(np.asarray(theta, dtype=float))
        at = np.asarray(z_material, dtype=float)
        at = np.broadcast_to(at if at.ndim == 2 else at[:, None], (len(at), len(theta)))
        front, slope = self.front_at(theta)
        s = at / front
        if net.dry:
            s = np.where(s <= 1, s, 1 + (at - front) / (length - front))
        e = np.clip(np.searchsorted(net.breaks, s, side="right") - 1, 0, net.count - 1)
        width = np.diff(net.breaks)[e]
        rows = lagrange(net.nodes, ((s - net.breaks[e]) / width).ravel()).reshape(*s.shape, -1)
        slopes = rows @ net.slopes / width[..., None]
        values, turned = (
            np.stack(
                [waves(self.x[..., c], net.theta, theta, p, k) for c, p in enumerate(SYMMETRIC)], axis=-1
            )
            for k in (0, 1)
        )
        pick = e, slice(None), np.arange(len(theta))[None, :]
        x = np.einsum("ijm,ijmc->ijc", rows, values[pick])
        dry = e >= net.wet
        z_s = np.where(dry, length - front, front)[..., None]
        a = np.einsum("ijm,ijmc->ijc", slopes, values[pick]) / z_s
        b = np.einsum("ijm,ijmc->ijc", rows, turned[pick])
        return x, a, b - a * (np.where(dry, 2 - s, s) * slope)[..., None]

    def positions(self, front: Array) -> Array:
        """Z at the nodes of all elements for a free surface, shape (elements * nodes, angles)."""
        s = np.concatenate([self.net.element(e)[0] for e in range(self.net.count)])[:, None]
        length = self.tube.length
        wet = np.arange(self.net.count) < self.net.wet
        lower = np.repeat(wet, len(self.net.nodes))[:, None]
        return np.where(lower, s * front, front + (s - 1) * (length - front))


def taken(surface: object, net: Net) -> Bent:
    """A membrane of any code with ``evaluate`` and ``front_at``, sampled on a net as a first guess."""
    front = surface.front_at(net.theta)[0]
    blank = Bent(surface.tube, net, np.zeros(0), surface.zw, front)
    at = np.clip(blank.positions(front), 0, surface.tube.length)
    x = surface.evaluate(at, net.theta)[0].reshape(net.count, net.degree + 1, net.modes + 1, 3)
    ring = np.stack([np.cos(net.theta), np.sin(net.theta), 0 * net.theta], axis=-1)
    x[0, 0], x[-1, -1] = ring, ring + np.array([0, 0, surface.tube.L])
    return replace(blank, x=x)


class Balance:
    """Balance of forces at the nodes, and its derivative, element by element.

    Attributes:
        residual: Force per ds dTheta at inner nodes, jump of the force between elements at their
            ends; shape (nodes, unknowns).
        by_level: Its derivative by the level, likewise.
        matrix: Its derivative by the positions, (elements, n, n), n = (degree + 1) unknowns.
        mass: Z_,s at inner nodes, 0 at ends of elements, shape (nodes, unknowns).
    """

    def __init__(self, bent: Bent, parities: tuple[int, ...] = SYMMETRIC, derivative: bool = True) -> None:
        net = bent.net
        self.keep = net.kept(parities)
        self.unknowns = int(self.keep.sum())
        shape = (net.count * net.degree + 1, self.unknowns)
        self.residual, self.by_level, self.mass = (np.zeros(shape) for _ in range(3))
        self.matrix = []
        for e in range(net.count):
            at = slice(e * net.degree, (e + 1) * net.degree + 1)
            self._vectors(bent, e, at)
            if derivative:
                self.matrix.append(self._matrix(bent, e, parities))

    def _flat(self, values: Array) -> Array:
        return values.reshape(len(values), -1)[:, self.keep]

    def _vectors(self, bent: Bent, e: int, at: slice) -> None:
        net = bent.net
        _, d = net.element(e)
        z_s, z_theta = (m[..., None] for m in bent.mapping(e))
        a, b = bent.tangents(e)
        fa, fb = forces(a, b, bent.tube.law)
        through = fa - z_theta * fb
        normal = np.cross(b, a) * z_s * bent.tube.gamma * (e < net.wet)
        out = np.einsum("im,mjc->ijc", d, through) + (bent.zw - bent.x[e][..., 2:]) * normal
        for c, p in enumerate(SYMMETRIC):
            out[..., c] += (z_s * fb)[..., c] @ net.turns[1 - p].T
        out[0], out[-1] = -through[0], through[-1]
        normal[[0, -1]] = 0
        mass = np.broadcast_to(z_s, out.shape).copy()
        mass[[0, -1]] = 0
        self.residual[at] += self._flat(out)
        self.by_level[at] += self._flat(normal)
        self.mass[at] += self._flat(mass)

    def _matrix(self, bent: Bent, e: int, parities: tuple[int, ...]) -> Array:
        net, gamma = bent.net, bent.tube.gamma * (e < bent.net.wet)
        _, d = net.element(e)
        z_s, z_theta = (m[..., None, None] for m in bent.mapping(e))
        a, b = bent.tangents(e)
        r = rates(a, b, bent.tube.law)
        # by x_,s and x_,Theta at fixed s, of the force through s = const and of Z_,s f_b
        by = lambda f: ((f[..., 0, :] - z_theta * f[..., 1, :]) / z_s, f[..., 1, :])  # noqa: E731
        through = by(r[..., 0, :, :, :] - z_theta[..., None] * r[..., 1, :, :, :])
        beside = by(z_s[..., None] * r[..., 1, :, :, :])
        load = gamma * (bent.zw - bent.x[e][..., 2])[..., None, None] * z_s
        push = by(np.stack([load * spun(b), -load * spun(a)], axis=-2))
        n, m = net.degree + 1, net.modes + 1
        out = np.zeros((n, m, 3, n, m, 3))
        spread = d.copy()
        inner = np.ones(n)
        inner[[0, -1]] = 0
        spread[0], spread[-1] = -np.eye(n)[0], np.eye(n)[-1]
        node, angle = np.arange(n), np.arange(m)
        # numpy puts the axes picked with two index arrays first
        ss = np.einsum("im,mjcd,mk->jicdk", spread, through[0], d, optimize=True)
        ss += np.einsum("i,ijcd,ik->jicdk", inner, push[0], d)
        out[:, angle, :, :, angle, :] += np.moveaxis(ss, (2, 3, 4), (2, 4, 3))
        lower = np.zeros((n, m, 3, 3))
        lower[..., :, 2] = -(gamma * np.cross(b, a) * z_s[..., 0]) * inner[:, None, None]
        out[node[:, None], angle, :, node[:, None], angle, :] += lower
        for k, p in enumerate(parities):
            turn = net.turns[p]
            out[..., k] += np.einsum("ik,kjc,jl->ijckl", spread, through[1][..., k], turn, optimize=True)
            for c, q in enumerate(parities):
                back = net.turns[1 - q]
                bend = np.einsum("jm,im,ml->ijl", back, beside[1][..., c, k], turn, optimize=True)
                bend += push[1][..., c, k][..., None] * turn
                out[node, :, c, node, :, k] += inner[:, None, None] * bend
                out[:, :, c, :, :, k] += np.einsum(
                    "i,jl,il,im->ijml", inner, back, beside[0][..., c, k], d, optimize=True
                )
        flat = out.reshape(n, m * 3, n, m * 3)[:, self.keep][..., self.keep]
        return flat.reshape(n * self.unknowns, n * self.unknowns)


def spread_out(bent: Bent, dx: Array, keep: Array) -> Array:
    """Nodal values (elements, nodes, angles, 3) of unknowns (nodes, unknowns)."""
    net = bent.net
    full = np.zeros((len(dx), len(keep)))
    full[:, keep] = dx
    rows = net.degree * np.arange(net.count)[:, None] + np.arange(net.degree + 1)
    return full[rows].reshape(net.count, net.degree + 1, net.modes + 1, 3)


def fitted(bent: Bent) -> tuple[Bent, float]:
    """The membrane on elements that end at its free surface, and how far that moved."""
    net, length = bent.net, bent.tube.length
    if not net.dry:
        return bent, 0.0
    a, _ = bent.tangents(net.wet - 1)
    move = (bent.zw - bent.x[net.wet - 1, -1, :, 2]) / a[-1, :, 2]
    room = 0.5 * np.minimum(bent.front, length - bent.front)
    front = bent.front + np.clip(move, -room, room)
    at = bent.positions(front)
    x = bent.evaluate(np.clip(at, 0, length), net.theta)[0].reshape(bent.x.shape)
    x[0, 0], x[-1, -1] = bent.x[0, 0], bent.x[-1, -1]
    return replace(bent, x=x, front=front), float(np.abs(front - bent.front).max())


def centroid(bent: Bent) -> Array:
    """Weights (elements, nodes, angles) of the mean of x over the material, the centroid's offset."""
    net, w = bent.net, bent.net.weights()
    widths = np.diff(net.breaks)
    parts = [w[:, None] * widths[e] * bent.mapping(e)[0] * net.around for e in range(net.count)]
    return np.stack(parts) / (2 * np.pi * bent.tube.length)


def newton(guess: Bent, offset: float | None = None) -> Bent:
    """Equilibrium at the guess's level or, with the level free, at a given centroid offset in x.

    Raises:
        RuntimeError: If the iteration does not converge.
    """
    kept = Kept()

    def correct(bent: Bent) -> tuple[float, Callable[[float], Bent]]:
        bent, move = fitted(bent)
        now = Balance(bent, derivative=kept.factor is None)
        kept.factor = kept.factor or Factor(now.matrix, now.unknowns)
        both = kept.factor.solve(np.stack([-now.residual, -now.by_level], axis=-1))
        both = [spread_out(bent, both[..., i], now.keep) for i in (0, 1)]
        dzw = 0.0
        if offset is not None:
            weight = centroid(bent)
            mean = [float(np.sum(weight * v[..., 0])) for v in (bent.x, *both)]
            dzw = (offset - mean[0] - mean[1]) / mean[2]
        dx = both[0] + dzw * both[1]
        size = max(float(np.abs(dx).max()), abs(dzw), move)
        kept.next(size)
        return size, lambda share: replace(bent, x=bent.x + share * dx, zw=bent.zw + share * dzw)

    what = f"bent tube by collocation at z_w = {guess.zw:g} for {guess.tube}"
    return fitted(iterate(guess, correct, what, longest=0.5, close=CONVERGED, more=0))[0]
