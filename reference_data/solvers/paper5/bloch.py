r"""The cylinder of paper 5 as a polyhedron of constant-strain triangles, reduced by rotation symmetry.

N_S x N_C quadrilaterals, uniform in (Z, Theta), each cut by the same diagonal; nodes on the unloaded
cylinder joined by straight edges, thickness at the centroids, full or relaxed energy of each triangle
by its principal stretches. Liquid: minus the signed area of the triangle's projection on the (x, y)
plane times the mean of Phi = gamma (zw - z)_+^2/2 over quadrature points. A state that rotation
by 2 pi/N_C maps to itself is given by one node per ring; its tangent splits into Hermitian matrices, one for
every n = 0..N_C/2, with node (i, k) displaced by Rot(2 pi k/N_C) xi_i exp(2 pi i n k/N_C).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.linalg import cholesky_banded, solve_banded

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.newton import newton as iterate
from reference_data.solvers.paper4 import cases as cas
from reference_data.solvers.paper4 import material as wri
from reference_data.solvers.paper4.material import Array, Membrane

STEP = 1e-30
THIRD = 1 / 3
# barycentric coordinates (points, 3), all of equal weight
RULES: dict[str, Array] = {
    "edges": np.array([[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5]]),
    "centroid": np.full((1, 3), THIRD),
    "inside": np.full((3, 3), 1 / 6) + np.eye(3) / 2,
    "nodes": np.eye(3),
}


def moduli(l1: Array, l2: Array, c2: float) -> tuple[Array, Array, Array]:
    """W_1, W_2 and the 6 x 6 second variation over (h11, h22, h12, h21, h31, h32); l1 >= l2."""
    tense = l1 * l2 * l2 > 1
    slack = l1 <= 1
    w1 = np.where(tense, mat.slope(l1, l2, c2), wri.relaxed_slope(l1, c2))
    w2 = np.where(tense, mat.slope(l2, l1, c2), 0.0)
    w1 = np.where(slack & ~tense, 0.0, w1)
    w11 = np.where(tense, mat.curvature(l1, l2, c2), np.where(slack, 0.0, wri.relaxed_curvature(l1, c2)))
    out = np.zeros((len(l1), 6, 6))
    out[:, 0, 0] = w11
    out[:, 1, 1] = np.where(tense, mat.curvature(l2, l1, c2), 0.0)
    out[:, 0, 1] = out[:, 1, 0] = np.where(tense, mat.mixed(l1, l2, c2), 0.0)
    gap = l1 * l1 - l2 * l2
    out[:, 2, 2] = out[:, 3, 3] = (l1 * w1 - l2 * w2) / gap
    out[:, 2, 3] = out[:, 3, 2] = (l2 * w1 - l1 * w2) / gap
    out[:, 4, 4], out[:, 5, 5] = w1 / l1, w2 / l2
    return w1, w2, out


@dataclass
class Polyhedron:
    """Mesh and load.

    Attributes:
        membrane: The cylinder.
        rings: N_S.
        sectors: N_C.
        rule: Quadrature of the load, a name in RULES.
        potential: "area" (Phi times the projected area) or "volume" (p (x, y).(N_x, N_y)/2).
        flipped: Whether the other diagonal cuts the quadrilaterals.
        arc: Whether the unloaded triangles lie in the unrolled cylinder instead of across it.
    """

    membrane: Membrane
    rings: int
    sectors: int
    rule: str = "edges"
    potential: str = "area"
    flipped: bool = False
    arc: bool = False

    @property
    def turn(self) -> Array:
        """Rotation by one sector."""
        a = 2 * np.pi / self.sectors
        return np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])

    @cached_property
    def corners(self) -> tuple[Array, Array]:
        """Ring and sector (0 or 1) of the triangles' corners, (2 N_S, 3); oriented from S to Theta."""
        i = np.arange(self.rings)
        o, p = np.zeros_like(i), np.ones_like(i)
        if self.flipped:
            first, second = ((i, o), (i + 1, o), (i, p)), ((i + 1, o), (i + 1, p), (i, p))
        else:
            first, second = ((i, o), (i + 1, o), (i + 1, p)), ((i, o), (i + 1, p), (i, p))
        pick = lambda c: np.concatenate(  # noqa: E731
            [np.stack([x[c] for x in t], axis=1) for t in (first, second)]
        )
        return pick(0), pick(1)

    @cached_property
    def reference(self) -> tuple[Array, Array, Array]:
        """Inverse edge matrices (triangles, 2, 2), areas, and thickness at the centroids."""
        ring, sector = self.corners
        dz = self.membrane.L / self.rings
        a = 2 * np.pi / self.sectors
        width = a if self.arc else 2 * np.sin(a / 2)
        x = np.stack([ring * dz, sector * width], axis=-1)
        edges = np.stack([x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]], axis=-1)
        return np.linalg.inv(edges), np.linalg.det(edges) / 2, self.membrane.eta(x[..., 0].mean(axis=1))

    def points(self, nodes: Array) -> Array:
        """Corner positions (triangles, 3, 3) from the rings' nodes (N_S + 1, 3)."""
        ring, sector = self.corners
        at = nodes[ring]
        return np.where(sector[..., None] == 1, at @ self.turn.T, at)

    def elastic(self, x: Array) -> tuple[Array, Array]:
        """Gradient (triangles, 9) and Hessian (triangles, 9, 9) of the strain energy."""
        inverse, area, thick = self.reference
        shape = np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])
        grad = shape @ inverse  # (triangles, 3 nodes, 2)
        f = np.einsum("tni,tna->tia", x, grad)
        n, stretches, m = np.linalg.svd(f)  # columns n, falling stretches, rows m
        w1, w2, d = moduli(*stretches.T, self.membrane.c2)
        weight = area * thick
        stress = w1[:, None, None] * n[:, :, 0, None] * m[:, 0, None, :]
        stress += w2[:, None, None] * n[:, :, 1, None] * m[:, 1, None, :]
        gradient = np.einsum("t,tia,tna->tni", weight, stress, grad).reshape(-1, 9)
        pairs = ((0, 0), (1, 1), (0, 1), (1, 0), (2, 0), (2, 1))
        along = np.einsum("tna,tba->tnb", grad, m)
        # h_ib = n_i . dF . N_b, a linear form in the nine displacements
        forms = np.stack([np.einsum("tn,ti->tni", along[:, :, b], n[:, :, i]) for i, b in pairs], axis=1)
        forms = forms.reshape(len(x), 6, 9)
        return gradient, np.einsum("t,tpk,tpq,tql->tkl", weight, forms, d, forms)

    def load_gradient(self, x: Array, level: float) -> Array:
        """Gradient (triangles, 3, 3) of the liquid's energy; x may be complex."""
        gamma, points = self.membrane.gamma, RULES[self.rule]
        z = np.einsum("qn,tn->tq", points, x[:, :, 2])
        depth = np.where(np.real(z) < level, level - z, 0.0)
        weight = 1 / len(points)
        out = np.zeros_like(x)
        if self.potential == "area":
            e = x[:, [1, 2, 0], :2] - x[:, [2, 0, 1], :2]  # edge opposite to each node
            area = ((x[:, 1, 0] - x[:, 0, 0]) * (x[:, 2, 1] - x[:, 0, 1])
                    - (x[:, 2, 0] - x[:, 0, 0]) * (x[:, 1, 1] - x[:, 0, 1])) / 2  # fmt: skip
            phi = weight * gamma * np.sum(depth**2, axis=1) / 2
            out[:, :, 0] = -phi[:, None] * e[:, :, 1] / 2
            out[:, :, 1] = phi[:, None] * e[:, :, 0] / 2
            out[:, :, 2] = weight * gamma * area[:, None] * (depth @ points)
            return out
        normal = -np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]) / 2  # outward
        v = np.einsum("qn,tnc->tqc", points, x)
        v[:, :, 2] = 0
        p = gamma * depth * weight
        slope = np.where(np.real(z) < level, -gamma * weight, 0.0)
        flux = np.einsum("tqc,tc->tq", v, normal)
        flat = normal.copy()
        flat[:, 2] = 0
        out -= np.einsum("tq,qn->tn", p, points)[:, :, None] * flat[:, None, :] / 2
        out[:, :, 2] -= np.einsum("tq,qn->tn", slope * flux, points) / 2
        total = np.einsum("tq,tqc->tc", p, v)
        for k in range(3):
            side = x[:, (k + 1) % 3] - x[:, (k + 2) % 3]
            out[:, k] += np.cross(side, total) / 4
        return out

    def local(self, nodes: Array, level: float) -> tuple[Array, Array]:
        """Gradients and Hessians of all triangles of a sector, in Cartesian components."""
        x = self.points(nodes)
        gradient, hessian = self.elastic(x)
        gradient = gradient + self.load_gradient(x, level).reshape(-1, 9)
        for j in range(9):
            bumped = x.astype(complex).reshape(-1, 9)
            bumped[:, j] += 1j * STEP
            change = np.imag(self.load_gradient(bumped.reshape(-1, 3, 3), level)) / STEP
            hessian[:, :, j] += change.reshape(-1, 9)
        return gradient, (hessian + np.swapaxes(hessian, 1, 2)) / 2

    @cached_property
    def frames(self) -> Array:
        """Rotations of the corners, (triangles, 3, 3, 3)."""
        _, sector = self.corners
        return np.where(sector[..., None, None] == 1, self.turn, np.eye(3))

    def residual(self, gradient: Array) -> Array:
        """Force on the inner rings' nodes."""
        out = np.zeros((self.rings + 1, 3))
        ring, _ = self.corners
        local = np.einsum("tnij,tni->tnj", self.frames, gradient.reshape(-1, 3, 3))
        np.add.at(out, ring, local)
        return out[1:-1].ravel()

    def bands(self, hessian: Array) -> Array:
        """Real lower bands (3, 6, unknowns): the tangent's coefficients of phase^-1, 1 and phase."""
        ring, sector = self.corners
        t = self.frames
        h = hessian.reshape(-1, 3, 3, 3, 3)
        block = np.einsum("tnij,tnimk,tmkl->tnjml", t, h, t)
        size = 3 * (self.rings - 1)
        rows = (3 * (ring - 1))[:, :, None, None, None] + np.arange(3)[None, None, :, None, None]
        columns = (3 * (ring - 1))[:, None, None, :, None] + np.arange(3)
        power = 1 + sector[:, None, None, :, None] - sector[:, :, None, None, None]
        rows, columns, power = np.broadcast_arrays(rows, columns, power)
        keep = (columns >= 0) & (rows < size) & (rows >= columns)
        out = np.zeros((3, 6, size))
        np.add.at(out, (power[keep], rows[keep] - columns[keep], columns[keep]), block[keep])
        return out


@dataclass
class Ring:
    """A rotation-symmetric equilibrium: one node per ring, and its tangent's bands."""

    mesh: Polyhedron
    nodes: Array
    level: float
    bands: Array

    def band(self, n: int) -> Array:
        """Lower band of the Hermitian matrix of wave number n over the inner rings."""
        phase = np.exp(2j * np.pi * n / self.mesh.sectors)
        return self.bands[0] * phase.conjugate() + self.bands[1] + self.bands[2] * phase

    def stable(self, n: int) -> bool:
        """Whether the matrix of a wave number is positive definite."""
        try:
            cholesky_banded(self.band(n), lower=True)
        except np.linalg.LinAlgError:
            return False
        return True

    def unstable(self) -> list[int]:
        """Wave numbers with a negative eigenvalue."""
        return [n for n in range(self.mesh.sectors // 2 + 1) if not self.stable(n)]

    def dense(self, n: int) -> Array:
        """The Hermitian matrix of a wave number."""
        band = self.band(n)
        size = band.shape[1]
        out = np.zeros((size, size), dtype=complex)
        for k in range(6):
            i = np.arange(size - k)
            out[i + k, i] = band[k, : size - k]
            out[i, i + k] = band[k, : size - k].conj()
        return out


def from_profile(mesh: Polyhedron, level: float) -> Array:
    """Rings' nodes from the smooth state at a level."""
    grid = cas.grid_at(mesh.membrane, level)
    s = np.linspace(0, mesh.membrane.L, mesh.rings + 1)
    nodes = np.linspace(0, mesh.membrane.L, grid.n + 1)
    r, z = np.interp(s, nodes, grid.r), np.interp(s, nodes, grid.z)
    return np.stack([r, 0 * r, z], axis=1)


def newton(mesh: Polyhedron, start: Array, level: float) -> Ring:
    """Rotation-symmetric equilibrium at a level.

    Raises:
        RuntimeError: If Newton's method does not converge.
    """

    def correct(ring: Ring) -> tuple[float, Callable[[float], Ring]]:
        gradient, hessian = mesh.local(ring.nodes, level)
        bands = mesh.bands(hessian)
        band = bands.sum(axis=0)
        size = band.shape[1]
        full = np.zeros((11, size))
        full[5:] = band
        for k in range(1, 6):
            full[5 - k, k:] = band[k, : size - k]
        step = np.zeros_like(ring.nodes)
        step[1:-1] = solve_banded((5, 5), full, -mesh.residual(gradient)).reshape(-1, 3)
        return float(np.abs(step).max()), lambda share: Ring(mesh, ring.nodes + share * step, level, bands)

    what = f"polyhedron {mesh.rings} x {mesh.sectors} at zw = {level:g}"
    found = iterate(Ring(mesh, start, level, np.zeros(0)), correct, what, longest=0.2, close=1e-9, more=0)
    return replace(found, bands=mesh.bands(mesh.local(found.nodes, level)[1]))
