r"""Second variation for wave number n as a canonical system, by transfer matrices between base states.

With the displacement gradient h in the principal frame (meridian 1, hoop 2, normal 3) of an
isotropic membrane of energy W(l1, l2), the second variation of the energy is

.. math::
   W_{11} h_{11}^2 + 2 W_{12} h_{11} h_{22} + W_{22} h_{22}^2
   + \frac{W_1}{l_1} h_{31}^2 + \frac{W_2}{l_2} h_{32}^2
   + \frac{l_1 W_1 - l_2 W_2}{l_1^2 - l_2^2} (h_{12}^2 + h_{21}^2)
   + 2 \frac{l_2 W_1 - l_1 W_2}{l_1^2 - l_2^2} h_{12} h_{21},

and the second variation of the pressure is minus int p_z w (a . u) + p u . (u_Theta x x_s + x_Theta x u_s)
with the normal area a = x_Theta x x_s (no potential is differentiated twice). The Lagrangian y'Ay'/2 + y'By +
yCy/2 - Lambda H R y.y/2 in y = (u, q, w) gives, with momenta m = A y' + B y,

.. math:: y' = A^{-1} (m - B y),\qquad m' = B^T y' + (C - \Lambda H R) y,

integrated with the base state (r, z and the tension's components) by the eighth-order formula of
Dormand and Prince over every smooth part of a shot at once. The transfer matrices become dynamic
stiffnesses, assembled over the parts' ends; a zero of that matrix is an eigenvalue (parts are so
short that none of them has one of its own nearby). Newton's method on Lambda finds it.

This shares with :mod:`waves.second_variation` neither the metric form, nor the pressure's, nor the base
state.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.integrate import DOP853
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import eigsh

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.law_metric import shear_modulus
from reference_data.solvers.paper4 import material as wri
from reference_data.solvers.paper4.material import Body
from reference_data.solvers.paper4.methods.shooting import stretch

Array = np.ndarray
A, B, C = DOP853.A[:12, :12], DOP853.B, DOP853.C[:12]
STEP = 1e-30


@dataclass
class Parts:
    """Smooth pieces of a base state, from s = 0 up.

    Attributes:
        surface: The body: its unloaded radius R, thickness H, law c2 and liquid.
        s: Where they start.
        h: Their lengths.
        tense: Whether each is taut.
        wet: Whether each is under pressure.
        y: Their first values of (r, z, A, F).
        load: Its load.
    """

    surface: Body
    s: Array
    h: Array
    tense: Array
    wet: Array
    y: Array
    load: float


def gradients(dr: Array, dz: Array, l1: Array, R: Array, n: float) -> tuple[Array, Array]:
    """E1, E0 with h = E1 y' + E0 y; rows h11, h31, h21, h22, h12, h32, over (u, q, w)."""
    first, zeroth = np.zeros((len(dr), 6, 3)), np.zeros((len(dr), 6, 3))
    first[:, 0, 0], first[:, 0, 2] = dr / l1, dz / l1
    first[:, 1, 0], first[:, 1, 2] = dz / l1, -dr / l1
    first[:, 2, 1] = 1.0
    zeroth[:, 3, 0], zeroth[:, 3, 1] = 1 / R, n / R
    # radial part of the hoop derivative -(n u + q), axial part -n w
    for row, er, ez in ((4, dr / l1, dz / l1), (5, dz / l1, -dr / l1)):
        zeroth[:, row, 0], zeroth[:, row, 1], zeroth[:, row, 2] = -n * er / R, -er / R, -n * ez / R
    return first, zeroth


def moduli(l1: Array, l2: Array, tense: Array, c2: float) -> Array:
    """The energy's second variation as a 6 x 6 matrix over the rows of :func:`gradients`."""
    w1 = np.where(tense, mat.slope(l1, l2, c2), wri.relaxed_slope(l1, c2))
    w2 = np.where(tense, mat.slope(l2, l1, c2), 0.0)
    out = np.zeros((len(l1), 6, 6))
    out[:, 0, 0] = np.where(tense, mat.curvature(l1, l2, c2), wri.relaxed_curvature(l1, c2))
    out[:, 0, 3] = out[:, 3, 0] = np.where(tense, mat.mixed(l1, l2, c2), 0.0)
    out[:, 3, 3] = np.where(tense, mat.curvature(l2, l1, c2), 0.0)
    out[:, 1, 1], out[:, 5, 5] = w1 / l1, w2 / l2
    d, gap = l1 * l2, l1 * l1 - l2 * l2
    # the quotients of the taut energy in closed form: equal stretches need no special treatment
    if isinstance(c2, float | int):
        even = 2 + 2 * c2 / d**2
        odd = 2 / d**3 + 2 * c2 * ((l1 * l1 + l2 * l2) / d**3 - d)
    else:  # W_i = 2 l_i f_i, f1 - f2 = (x1 - x2) f_y
        fy = shear_modulus(c2, l1, l2)
        even, odd = w1 / l1 + 2 * l2 * l2 * fy, 2 * d * fy
    gap = np.where(tense, 1.0, gap)
    out[:, 2, 2] = out[:, 4, 4] = np.where(tense, even, l1 * w1 / gap)
    out[:, 2, 4] = out[:, 4, 2] = np.where(tense, odd, l2 * w1 / gap)
    return out


class Transfer:
    """Transfer matrices of the parts for one wave number; beta stiffens the hoops' curvature."""

    def __init__(self, parts: Parts, n: float, beta: float = 0.0) -> None:
        self.parts, self.n, self.beta = parts, n, beta

    def system(self, s: Array, y: Array, start: Array | None) -> tuple[Array, Array, Array, Array]:
        """Base rates, the canonical matrix at Lambda = 0, H R, and the stretch."""
        parts, surface = self.parts, self.parts.surface
        R, H, tense = surface.unloaded(s), surface.eta(s), parts.tense
        r, z = y[:, 0], y[:, 1]
        tension = np.hypot(y[:, 2], y[:, 3])
        force = (tension / (H * R))[:, None]
        l1 = stretch(force, (r / R)[:, None], tense[:, None], surface.c2, start)
        w2 = np.where(tense, mat.slope(r / R, l1[:, 0], surface.c2), 0.0)
        first = l1[:, :1]
        l1 = l1[:, 0]
        dr, dz = l1 * y[:, 2] / tension, l1 * y[:, 3] / tension
        p = np.where(parts.wet, surface.pressure(z, parts.load, True), 0.0)
        base = np.stack([dr, dz, H * w2 - p * r * dz, p * r * dr], axis=-1)
        e1, e0 = gradients(dr, dz, l1, R, self.n)
        d = moduli(l1, r / R, tense, surface.c2) * (H * R)[:, None, None]
        a = np.einsum("kai,kab,kbj->kij", e1, d, e1)
        b = np.einsum("kai,kab,kbj->kij", e1, d, e0)
        c = np.einsum("kai,kab,kbj->kij", e0, d, e0)
        if self.beta:
            # change of hoop curvature N . u_ThetaTheta + (r r'/l1^2) N . u_s, N = (z', -r')/l1, over R^2
            normal = np.stack([dz, 0 * dz, -dr], axis=-1) / l1[:, None]
            k1 = normal * (r * dr / l1**2)[:, None]
            k0 = normal * np.array([-(self.n**2) - 1, 0.0, -(self.n**2)])
            k0[:, 1] = -2 * self.n * normal[:, 0]
            stiff = (self.beta * H**3 / R**3)[:, None, None]
            a = a + stiff * k1[:, :, None] * k1[:, None, :]
            b = b + stiff * k1[:, :, None] * k0[:, None, :]
            c = c + stiff * k0[:, :, None] * k0[:, None, :]
        pz = np.where(parts.wet, -surface.weight, 0.0)
        n = self.n
        # minus p [z'(u^2 + q^2) + 2 n q (z' u - r' w) - r' u w + r (u w' - w u')] - p_z r w (z' u - r' w)
        c[:, 0, 0] -= p * dz
        c[:, 1, 1] -= p * dz
        for i, j, x in (
            (0, 1, -p * n * dz),
            (1, 2, p * n * dr),
            (0, 2, (p * dr - pz * r * dz) / 2),
        ):
            c[:, i, j] += x
            c[:, j, i] += x
        c[:, 2, 2] += pz * r * dr
        b[:, 2, 0] -= p * r / 2
        b[:, 0, 2] += p * r / 2
        inverse = np.linalg.inv(a)
        ab = inverse @ b
        out = np.empty((len(s), 6, 6))
        out[:, :3, :3], out[:, :3, 3:] = -ab, inverse
        out[:, 3:, :3], out[:, 3:, 3:] = c - np.swapaxes(b, 1, 2) @ ab, np.swapaxes(ab, 1, 2)
        return base, out, H * R, first

    def middles(self) -> Array:
        """Base values at the parts' middles."""
        parts, first = self.parts, None
        y, h = parts.y, parts.h / 2
        stages: list[Array] = []
        for i in range(12):
            at = y
            for j in range(i):
                if A[i, j]:
                    at = at + (h * A[i, j])[:, None] * stages[j]
            base, _, _, first = self.system(parts.s + C[i] * h, at, first)
            stages.append(base)
        return y + h[:, None] * sum(b * k for b, k in zip(B, stages, strict=True) if b)

    def matrices(self, value: complex) -> Array:
        """Transfer matrices (parts, 6, 6) at an eigenvalue."""
        parts = self.parts
        y, x = parts.y, np.broadcast_to(np.eye(6), (len(parts.s), 6, 6)).astype(type(value))
        h, first = parts.h, None
        stages: list[tuple[Array, Array]] = []
        for i in range(12):
            at, xt = y, x
            for j in range(i):
                if A[i, j]:
                    at = at + (h * A[i, j])[:, None] * stages[j][0]
                    xt = xt + (h * A[i, j])[:, None, None] * stages[j][1]
            base, canonical, density, first = self.system(parts.s + C[i] * h, at, first)
            rate = canonical @ xt
            rate[:, 3:] -= value * density[:, None, None] * xt[:, :3]
            stages.append((base, rate))
        return x + h[:, None, None] * sum(b * k[1] for b, k in zip(B, stages, strict=True) if b)

    @property
    def leaders(self) -> Array:
        """Parts that start a piece; a part much shorter than its neighbours joins the one before."""
        h = self.parts.h
        padded = np.concatenate([h[1:2], h, h[-2:-1]])
        short = h < 0.3 * np.maximum(padded[:-2], padded[2:])
        lead = ~short
        lead[0], lead[1] = True, lead[1] and not short[0]
        return lead

    @property
    def ends(self) -> Array:
        """Positions of the inner ends of the pieces."""
        return self.parts.s[self.leaders][1:]

    def merged(self, x: Array) -> Array:
        """Products of the parts' matrices over the pieces."""
        out: list[Array] = []
        for lead, t in zip(self.leaders, x, strict=True):
            if lead:
                out.append(t)
            else:
                out[-1] = t @ out[-1]
        return np.array(out)

    def dynamic(self, value: complex) -> Any:
        """Dynamic stiffness over the inner ends of the pieces, both edges clamped."""
        x = self.merged(self.matrices(value))
        p, q, r, t = x[:, :3, :3], x[:, :3, 3:], x[:, 3:, :3], x[:, 3:, 3:]
        inverse = np.linalg.inv(q)
        block = np.empty((len(x), 6, 6), dtype=x.dtype)
        block[:, :3, :3], block[:, :3, 3:] = inverse @ p, -inverse
        block[:, 3:, :3], block[:, 3:, 3:] = r - t @ inverse @ p, t @ inverse
        block = (block + np.swapaxes(block, 1, 2)) / 2
        rows = 3 * np.arange(len(x))[:, None, None] + np.arange(6)[None, :, None] - 3
        rows, columns = np.broadcast_arrays(rows, np.swapaxes(rows, 1, 2))
        size = 3 * (len(x) - 1)
        keep = (rows >= 0) & (columns >= 0) & (rows < size) & (columns < size)
        return coo_matrix((block[keep], (rows[keep], columns[keep])), (size, size)).tocsc()

    def near(self, value: float, count: int) -> tuple[Array, Array]:
        """Eigenvalues of the system linearised at a value, lowest first, and their vectors.

        The dynamic stiffness decreases with Lambda, so that D + mu D' has as many zeros below.
        """
        d = self.dynamic(complex(value, STEP))
        slope = (-d.imag / STEP).tocsc()
        start = np.sin(1.0 + np.arange(d.shape[0]))
        shift = min(0.0, value) - 20.0
        values, vectors = eigsh(d.real.tocsc(), count, slope, sigma=shift - value, v0=start, tol=1e-13)
        order = np.argsort(values)
        return values[order] + value, vectors[:, order]

    def lowest(self, count: int = 3) -> Array:
        """Lowest eigenvalues, each by Newton's method from the linearisation at 0."""
        out = []
        for k, value in enumerate(self.near(0.0, count)[0]):
            at = float(value)
            for _ in range(20):
                now = float(self.near(at, count)[0][k])
                done = abs(now - at) < 1e-9 * max(1.0, abs(now))
                at = now
                if done:
                    break
            out.append(at)
        return np.array(out)

    def mode(self) -> tuple[Array, Array]:
        """Positions of the inner ends, and the lowest mode (ends, 3) of mass 1."""
        value = float(self.lowest(1)[0])
        vector = self.near(value, 1)[1][:, 0]  # eigsh norms it by -D', which is the mass
        return self.ends, vector.reshape(-1, 3)


def halved(parts: Parts) -> Parts:
    """The same base state on parts half as long."""
    middle = Transfer(parts, 0).middles()
    return replace(
        parts,
        s=np.stack([parts.s, parts.s + parts.h / 2], axis=1).ravel(),
        h=np.repeat(parts.h / 2, 2),
        tense=np.repeat(parts.tense, 2),
        wet=np.repeat(parts.wet, 2),
        y=np.stack([parts.y, middle], axis=1).reshape(-1, 4),
    )
