r"""Koiter's bending energy of the incremental curvature, model B2, by two discretisations.

With the first-order changes of curvature k22 of :mod:`waves.bending` and

.. math::
   k_{11} = [z' (u'' - (j'/j) u') - r' (w'' - (j'/j) w')]/j,\quad
   k_{12} = [z' (-n u' - q' + (r'/r)(n u + q)) - r' (-n w' + (r'/r) n w)]/(j R),

2 Pi2_b/pi = int D R [k11^2 + k22^2 + k11 k22 + k12^2] ds (Poisson's ratio 1/2), D = beta H^3, edges
simply supported. u' and w' must be continuous: (a) the polynomials of :mod:`waves.second_variation` with that
constraint, dense; (b) cubic Hermite elements for u, q and w with the second variation in principal
axes, for wholly wrinkled states (whose modes are smooth).
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from scipy import sparse
from scipy.linalg import eigh
from scipy.sparse.linalg import eigsh

from reference_data.solvers.core.collocation import differentiation, lagrange
from reference_data.solvers.paper5.waves.second_variation import Quadratic
from reference_data.solvers.paper5.waves.transfer import gradients, moduli

Array = np.ndarray
U0, U1, U2, Q0, Q1, Q2, W0, W1, W2 = range(9)


def curvatures(base: dict[str, Array], n: float) -> tuple[Array, Array, Array]:
    """k11, k22, k12 as linear forms (points, 9) in (u, u', u'', q, q', q'', w, w', w'')."""
    r, dr, dz, j, dj, R = (base[k] for k in ("r", "dr", "dz", "j", "dj", "R"))
    k11, k22, k12 = (np.zeros((len(r), 9)) for _ in range(3))
    k11[:, U2], k11[:, U1] = dz / j, -dz * dj / j**2
    k11[:, W2], k11[:, W1] = -dr / j, dr * dj / j**2
    slope = r * dr / j**2
    k22[:, U0], k22[:, Q0], k22[:, U1] = -(n * n + 1) * dz, -2 * n * dz, dz * slope
    k22[:, W0], k22[:, W1] = n * n * dr, -dr * slope
    k12[:, U1], k12[:, Q1], k12[:, U0], k12[:, Q0] = -n * dz, -dz, n * dz * dr / r, dz * dr / r
    k12[:, W1], k12[:, W0] = n * dr, -n * dr * dr / r
    return k11, k22 / (j * R**2)[:, None], k12 / (j * R)[:, None]


def integrand(base: dict[str, Array], n: float) -> Array:
    """The bending energy's matrices at the points, beta = 1."""
    k11, k22, k12 = curvatures(base, n)
    pair = lambda a, b: a[:, :, None] * b[:, None, :]  # noqa: E731
    mixed = (pair(k11, k22) + pair(k22, k11)) / 2
    scale = (base["H"] ** 3 * base["R"])[:, None, None]
    return scale * (pair(k11, k11) + pair(k22, k22) + mixed + pair(k12, k12))


def base_at(form: Quadratic, s: Array) -> dict[str, Array]:
    """Base quantities at positions s."""
    state = form.state
    e = np.clip(np.searchsorted(state.edges, s, side="right") - 1, 0, len(state.edges) - 2)
    width = np.diff(state.edges)[e]
    rows = lagrange(state.nodes, (s - state.edges[e]) / width)
    y = np.einsum("im,imc->ic", rows, state.y[e])
    dj = np.einsum("im,im->i", rows @ differentiation(state.nodes), state.y[e][..., 2]) / width
    r, z, j, b = y.T
    out = {"r": r, "z": z, "j": j, "dj": dj, "dr": j * np.sin(b), "dz": j * np.cos(b)}
    wet = state.wet[e]
    out |= {"R": state.surface.unloaded(s), "H": state.surface.eta(s), "tense": state.tense[e]}
    push, weight = state.surface.pressure(z, state.load, True), state.surface.weight
    out |= {"p": np.where(wet, push, 0.0), "pz": np.where(wet, -weight, 0.0)}
    return out


def constrained(form: Quadratic) -> Array:
    """Columns: unknowns with clamped ends and continuous u', w' (dense)."""
    k, m = len(form.state.edges) - 1, form.degree
    d, widths = differentiation(form.nodes), np.diff(form.state.edges)
    columns = np.eye(form.size)
    dependent = [0, 1, 2, form.size - 3, form.size - 2, form.size - 1]
    columns[dependent] = 0.0
    for e in range(1, k):
        for c in (0, 2):
            left = 3 * ((e - 1) * m + np.arange(m + 1)) + c
            right = 3 * (e * m + np.arange(m + 1)) + c
            rest = [i for i in range(m + 1) if i != 1]
            target = d[m] / widths[e - 1] @ columns[left] - d[0, rest] / widths[e] @ columns[right[rest]]
            columns[right[1]] = target * widths[e] / d[0, 1]
            dependent.append(int(right[1]))
    return np.delete(columns, dependent, axis=1)


def spectral(form: Quadratic, n: float, beta: float) -> float:
    """Lowest eigenvalue by method (a)."""
    size = form.s.shape
    base = base_at(form, form.s.ravel())
    x, _ = np.polynomial.legendre.leggauss(size[1])
    value = lagrange(form.nodes, (x + 1) / 2)
    d = differentiation(form.nodes)
    basis = np.zeros((*size, 9, form.degree + 1, 3))
    for c in range(3):
        for order, rows in enumerate((value, value @ d, value @ d @ d)):
            basis[:, :, 3 * c + order, :, c] = rows / form.width[:, :, None] ** order
    basis = basis.reshape(*size, 9, -1)
    matrices = integrand(base, n).reshape(*size, 9, 9) * form.weights[..., None, None]
    block = np.einsum("kgam,kgab,kgbn->kmn", basis, matrices, basis, optimize=True)
    bending = np.zeros((form.size, form.size))
    for rows, b in zip(form.index, block, strict=True):
        bending[np.ix_(rows, rows)] += b
    k = form.stiffness
    full = (k[0] + n * k[1] + n * n * k[2]).toarray() + beta * bending
    p = constrained(form)
    values = eigh(p.T @ full @ p, p.T @ (form.mass @ p), eigvals_only=True, subset_by_index=(0, 0))
    return float(values[0])


def hermite(x: Array, h: float) -> Array:
    """Cubic shapes for (value, slope, value, slope) on [0, h]: (points, orders 0..2, 4)."""
    shapes = [
        np.polynomial.Polynomial(c) for c in ((1, 0, -3, 2), (0, 1, -2, 1), (0, 0, 3, -2), (0, 0, -1, 1))
    ]
    out = np.empty((len(x), 3, 4))
    for i, s in enumerate(shapes):
        for order in range(3):
            at = (s.deriv(order) if order else s)(x)
            out[:, order, i] = at * h ** (i % 2) / h**order
    return out


def hermitian(form: Quadratic, n: float, beta: float, elements: int) -> float:
    """Lowest eigenvalue by method (b), with equal elements in each zone.

    Raises:
        RuntimeError: If the state is taut anywhere.
    """
    state = form.state
    if state.tense.any():
        raise RuntimeError("Hermite elements: the state is not wholly wrinkled")
    switch = np.nonzero(np.diff(state.wet.astype(int)))[0]
    marks = np.concatenate([state.edges[:1], state.edges[switch + 1], state.edges[-1:]])
    longest = (marks[-1] - marks[0]) / elements
    parts = [np.linspace(a, b, int(np.ceil((b - a) / longest)) + 1)[:-1]
             for a, b in pairwise(marks)]  # fmt: skip
    edges = np.concatenate([*parts, marks[-1:]])
    x, weights = np.polynomial.legendre.leggauss(6)
    x, weights = (x + 1) / 2, weights / 2
    size = 6 * len(edges)
    rows, columns, stiff, heavy = [], [], [], []
    for e, h in enumerate(np.diff(edges)):
        base = base_at(form, edges[e] + h * x)
        e1, e0 = gradients(base["dr"], base["dz"], base["j"], base["R"], n)
        d = moduli(base["j"], base["r"] / base["R"], base["tense"], state.surface.c2)
        d = d * (base["H"] * base["R"])[:, None, None]
        q = np.zeros((len(x), 9, 9))
        zeroth, first = [U0, Q0, W0], [U1, Q1, W1]
        for a, left in ((e0, zeroth), (e1, first)):
            for b, right in ((e0, zeroth), (e1, first)):
                q[np.ix_(range(len(x)), left, right)] += np.einsum("gai,gab,gbj->gij", a, d, b)
        p, pz, r, dr, dz = (base[k] for k in ("p", "pz", "r", "dr", "dz"))
        for i, j, c in ((U0, U0, -p * dz), (Q0, Q0, -p * dz), (W0, W0, pz * r * dr)):
            q[:, i, j] += c
        for i, j, c in (
            (U0, Q0, -p * n * dz), (Q0, W0, p * n * dr), (U0, W0, (p * dr - pz * r * dz) / 2),
            (U0, W1, -p * r / 2), (W0, U1, p * r / 2),
        ):  # fmt: skip
            q[:, i, j] += c
            q[:, j, i] += c
        q += beta * integrand(base, n)
        shapes = np.zeros((len(x), 9, 4, 3))
        for c in range(3):
            shapes[:, 3 * c : 3 * c + 3, :, c] = hermite(x, h)
        shapes = shapes.reshape(len(x), 9, 12)
        stiff.append(np.einsum("g,gak,gab,gbl->kl", h * weights, shapes, q, shapes, optimize=True))
        density = h * weights * base["H"] * base["R"]
        at = shapes[:, zeroth]
        heavy.append(np.einsum("g,gck,gcl->kl", density, at, at))
        index = 6 * e + np.arange(12)
        rows.append(np.repeat(index, 12))
        columns.append(np.tile(index, 12))
    place = np.concatenate(rows), np.concatenate(columns)
    k, m = (
        sparse.coo_matrix((np.concatenate([b.ravel() for b in blocks]), place), (size, size)).tocsc()
        for blocks in (stiff, heavy)
    )
    keep = np.setdiff1d(np.arange(size), [0, 1, 2, size - 6, size - 5, size - 4])
    k, m = k[np.ix_(keep, keep)], m[np.ix_(keep, keep)]
    guess = form.first(n)
    value = eigsh(k, 1, m, sigma=guess - 1, v0=np.sin(1.0 + np.arange(len(keep))), tol=1e-13)[0]
    return float(value[0])
