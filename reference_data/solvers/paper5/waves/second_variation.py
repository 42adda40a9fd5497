r"""Second variation of the relaxed energy for wave number n, by spectral elements fitted to the zones.

Displacement (u cos n Theta, q sin n Theta, w cos n Theta) in the directions (r, theta, z) about an
axisymmetric state r(s), z(s) of a surface of revolution R(s); metric form of Patil, Nordmark &
Eriksson, "Pressure driven instability of wrinkled membranes" (thesis, paper 5), section 2, with
x1 = lam1^2, x2 = lam2^2, f_i = dU/dx_i and f_y = (f1 - f2)/(x1 - x2):

.. math::
   2\Pi_2/\pi = \int 2 H R \{ f_1 (u'^2 + q'^2 + w'^2)
     + (f_2/R^2) [n^2 (u^2 + q^2 + w^2) + u^2 + q^2 + 4 n u q] + f_y \gamma^2/R^2
     + f_{11} a^2/2 + f_{12} a b/R^2 + f_{22} b^2/(2 R^4) \}\, ds
     + \int \{ -p z' (u^2 + q^2) - 2 p r u w' - 2 p_z z' r u w + p_z r r' w^2
     - 2 n p q (z' u - r' w) \}\, ds,

a = 2 (r' u' + z' w'), b = 2 r (u + n q), gamma = r q' - r' q - n (r' u + z' w). The mass is
int H R (u^2 + q^2 + w^2) ds (density C1/(Ao g), time in units of sqrt(Ao/g)). In a wrinkled zone
U = U_R(lam1): f2 = f12 = f22 = 0. The matrix is K0 + n K1 + n^2 K2.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy import sparse
from scipy.linalg import cholesky_banded
from scipy.sparse.linalg import eigsh

from reference_data.solvers.core.collocation import differentiation, lagrange, lobatto
from reference_data.solvers.core.law_metric import metric
from reference_data.solvers.core.laws import Law
from reference_data.solvers.paper4.material import Body, relaxed_curvature, relaxed_slope

Array = np.ndarray
MORE = 8  # Gauss points beyond the degree
U, DU, Q, DQ, W, DW = range(6)


@dataclass
class Profile:
    """An axisymmetric state by polynomials: (elements, nodes, 4) of (r, z, lam1, slope angle b).

    Attributes:
        surface: The body: its unloaded radius R, thickness H, law c2 and liquid.
        edges: Element boundaries, fronts and the level among them.
        nodes: Their nodes on [0, 1].
        y: Values.
        tense: Whether each element is taut.
        wet: By element.
        load: Its load.
    """

    surface: Body
    edges: Array
    nodes: Array
    y: Array
    tense: Array
    wet: Array
    load: float

    def split(self, parts: int) -> Profile:
        """The same polynomials on elements cut into equal parts."""
        cuts = np.arange(parts) / parts
        edges = (self.edges[:-1, None] + np.diff(self.edges)[:, None] * cuts).ravel()
        rows = [lagrange(self.nodes, c + self.nodes / parts) for c in cuts]
        y = np.stack([np.einsum("im,kmc->kic", a, self.y) for a in rows], axis=1)
        return replace(
            self,
            edges=np.concatenate([edges, self.edges[-1:]]),
            y=y.reshape(-1, *self.y.shape[1:]),
            tense=np.repeat(self.tense, parts),
            wet=np.repeat(self.wet, parts),
        )


def derivatives(x1: Array, x2: Array, tense: Array, a: float) -> tuple[Array, ...]:
    """f1, f2, f_y, f11, f12, f22 of the energy U(x1, x2) over C1; no division by x1 - x2 where taut.

    ``a`` is C2/C1, or another law.
    """
    if not isinstance(a, float | int):
        return derivatives_of_law(x1, x2, tense, a)
    d, s = x1 * x2, x1 + x2
    fd, ft = -1 / d**2 + a * (1 - s / d**2), 1 + a / d
    fdd, ftd = 2 / d**3 + 2 * a * s / d**3, -a / d**2
    slope = 1 - x1**-1.5 + a * (x1**-0.5 - x1**-2)
    bend = 1.5 * x1**-2.5 + a * (2 * x1**-3 - 0.5 * x1**-1.5)
    relaxed = (slope, 0 * d, slope / np.where(tense, 1.0, x1 - x2), bend, 0 * d, 0 * d)
    taut = (
        ft + x2 * fd,
        ft + x1 * fd,
        -fd,
        2 * x2 * ftd + x2**2 * fdd,
        s * ftd + d * fdd + fd,
        2 * x1 * ftd + x1**2 * fdd,
    )
    return tuple(np.where(tense, t, r) for t, r in zip(taut, relaxed, strict=True))


def derivatives_of_law(x1: Array, x2: Array, tense: Array, law: Law) -> tuple[Array, ...]:
    """The same of another law; ``U(x1)`` where wrinkled has ``W_r' = 2 l U'``."""
    l1, l2 = np.sqrt(x1), np.sqrt(x2)
    with np.errstate(all="ignore"):  # where the sheet is wrinkled the law may not be defined
        m = metric(law, l1, l2)
    first, second = relaxed_slope(l1, law), relaxed_curvature(l1, law)
    slope, bend = first / (2 * l1), (second - first / l1) / (4 * x1)
    relaxed = (slope, 0 * x1, slope / np.where(tense, 1.0, x1 - x2), bend, 0 * x1, 0 * x1)
    taut = (m.f1, m.f2, m.fy, m.f11, m.f12, m.f22)
    return tuple(np.where(tense, t, r) for t, r in zip(taut, relaxed, strict=True))


class Quadratic:
    """The form's matrices at a state, on polynomials of a degree in the state's elements."""

    def __init__(self, state: Profile, degree: int, split: int = 1, all_tense: bool = False) -> None:
        state = state if split == 1 else state.split(split)
        self.state, self.degree = state, degree
        surface, k = state.surface, len(state.edges) - 1
        x, weights = np.polynomial.legendre.leggauss(degree + MORE)
        x, weights = (x + 1) / 2, weights / 2
        rows = lagrange(state.nodes, x)
        r, z, l1, b = np.moveaxis(np.einsum("gm,kmc->kgc", rows, state.y), -1, 0)
        self.z = z
        self.width = np.diff(state.edges)[:, None]
        self.s = s = state.edges[:-1, None] + self.width * x
        self.tense = np.broadcast_to(state.tense[:, None] | all_tense, s.shape)
        wet = state.wet[:, None]
        self.r, self.dr, self.dz, self.l1 = r, l1 * np.sin(b), l1 * np.cos(b), l1
        self.R, self.H = surface.unloaded(s), surface.eta(s)
        self.p = np.where(wet, surface.pressure(z, state.load, True), 0.0)
        self.pz = np.where(wet, -surface.weight, 0.0) + 0 * s
        self.nodes = lobatto(degree)
        value = lagrange(self.nodes, x)
        slope = value @ differentiation(self.nodes)
        # basis values at the Gauss points: (elements, points, 6 entries, nodes, 3 fields)
        basis = np.zeros((k, len(x), 6, degree + 1, 3))
        for field in range(3):
            basis[:, :, 2 * field, :, field] = value
            basis[:, :, 2 * field + 1, :, field] = slope / self.width[:, :, None]
        self.basis = basis.reshape(k, len(x), 6, -1)
        self.weights = self.width * weights
        local = np.arange(k)[:, None] * degree + np.arange(degree + 1)
        self.index = (3 * local[:, :, None] + np.arange(3)).reshape(k, -1)
        self.size = 3 * (k * degree + 1)

    def forms(self) -> Array:
        """The integrand's symmetric matrices of (u, u', q, q', w, w') by powers of n: (3, k, g, 6, 6)."""
        r, dr, dz, R, H, p, pz = self.r, self.dr, self.dz, self.R, self.H, self.p, self.pz
        one = np.ones_like(r)
        f1, f2, fy, f11, f12, f22 = derivatives(self.l1**2, (r / R) ** 2, self.tense, self.state.surface.c2)
        out = np.zeros((3, *r.shape, 6, 6))

        def add(factor: Array, left: list[dict[int, Array]], right: list[dict[int, Array]]) -> None:
            # left[i], right[j]: coefficients of n^i, n^j of two linear forms
            for i, a in enumerate(left):
                for j, c in enumerate(right):
                    for m, x in a.items():
                        for n, y in c.items():
                            out[i + j, ..., m, n] += factor * x * y / 2
                            out[i + j, ..., n, m] += factor * x * y / 2

        a = [{DU: 2 * dr, DW: 2 * dz}]
        b = [{U: 2 * r}, {Q: 2 * r}]
        gamma = [{DQ: r, Q: -dr}, {U: -dr, W: -dz}]
        for field in (U, Q, W):
            add(2 * H * R * f1, [{field + 1: one}], [{field + 1: one}])
            add(2 * H / R * f2, [{}, {field: one}], [{}, {field: one}])
        for field in (U, Q):
            add(2 * H / R * f2, [{field: one}], [{field: one}])
        add(8 * H / R * f2, [{}, {U: one}], [{Q: one}])
        add(2 * H / R * fy, gamma, gamma)
        add(H * R * f11, a, a)
        add(2 * H / R * f12, a, b)
        add(H / R**3 * f22, b, b)
        add(-p * dz, [{U: one}], [{U: one}])
        add(-p * dz, [{Q: one}], [{Q: one}])
        add(-2 * p * r, [{U: one}], [{DW: one}])
        add(-2 * pz * dz * r, [{U: one}], [{W: one}])
        add(pz * r * dr, [{W: one}], [{W: one}])
        add(-2 * p, [{}, {Q: one}], [{U: dz, W: -dr}])
        return out

    def assembled(self, forms: Array) -> sparse.csc_matrix:
        """Global matrix of an integrand (k, g, 6, 6)."""
        scaled = forms * self.weights[..., None, None]
        block = np.einsum("kgam,kgab,kgbn->kmn", self.basis, scaled, self.basis, optimize=True)
        rows = np.repeat(self.index[:, :, None], self.index.shape[1], axis=2)
        columns = np.swapaxes(rows, 1, 2)
        return sparse.coo_matrix(
            (block.ravel(), (rows.ravel(), columns.ravel())), (self.size, self.size)
        ).tocsc()

    @cached_property
    def stiffness(self) -> list[sparse.csc_matrix]:
        """The matrices K0, K1, K2."""
        return [self.assembled(f) for f in self.forms()]

    @cached_property
    def mass(self) -> sparse.csc_matrix:
        """The mass matrix."""
        forms = np.zeros((*self.r.shape, 6, 6))
        for field in (U, Q, W):
            forms[..., field, field] = self.H * self.R
        return self.assembled(forms)

    def free(self, n: float) -> sparse.csc_matrix:
        """Columns: free unknowns. Clamped edges; regular at a pole; q left out for n = 0."""
        keep = np.ones(self.size, bool)
        keep[-3:] = False
        columns = sparse.identity(self.size, format="lil")
        keep[:3] = False
        if self.state.surface.pole and n == 1:
            columns[1, 0] = -1.0
            keep[0] = True
        if n == 0:
            keep[1::3] = False
            keep[2] = self.state.surface.pole
        return columns.tocsc()[:, np.nonzero(keep)[0]]

    def matrices(self, n: float) -> tuple[sparse.csc_matrix, sparse.csc_matrix, sparse.csc_matrix]:
        """Stiffness, mass, and the columns of the free unknowns."""
        p = self.free(n)
        k = self.stiffness
        return p.T @ (k[0] + n * k[1] + n * n * k[2]) @ p, p.T @ self.mass @ p, p

    def floor(self, n: float, k: sparse.csc_matrix, m: sparse.csc_matrix) -> float:
        """A value below every eigenvalue, certified by Cholesky's factors of K - value M.

        The first trial is the density -n p lam1/(H R) of the pressure without hoop tension.
        """
        slack = np.where(self.tense, 0.0, self.p * self.l1 / (self.H * self.R))
        value = -0.2 - 1.1 * n * float(slack.max())
        while True:
            shifted = (k - value * m).tocoo()
            wide = int(np.max(shifted.row - shifted.col))
            band = np.zeros((wide + 1, k.shape[0]))
            below = shifted.row >= shifted.col
            band[(shifted.row - shifted.col)[below], shifted.col[below]] = shifted.data[below]
            try:
                cholesky_banded(band, lower=True)
                return value
            except np.linalg.LinAlgError:
                value *= 2

    def lowest(self, n: float, count: int = 3, extra: sparse.csc_matrix | None = None) -> tuple[Array, Array]:
        """Lowest eigenvalues, and the modes (size, count), of K d = Lambda M d.

        Args:
            n: Wave number, real.
            count: How many.
            extra: A further stiffness matrix, for example of bending.
        """
        k, m, p = self.matrices(n)
        if extra is not None:
            k = k + p.T @ extra @ p
        k, m = k.tocsc(), m.tocsc()
        shift, start = self.floor(n, k, m), np.sin(1.0 + np.arange(k.shape[0]))
        for tol in (1e-6, 1e-13):  # from the safe shift to a closer one
            values, vectors = eigsh(k, count, m, sigma=shift, which="LM", v0=start, tol=tol)
            order = np.argsort(values)
            values, vectors = values[order], vectors[:, order]
            shift, start = values[0] - 0.02 * (1 + abs(values[0])), vectors.sum(axis=1)
        return values, p @ vectors

    def first(self, n: float) -> float:
        """Lowest eigenvalue."""
        return float(self.lowest(n, 1)[0][0])
