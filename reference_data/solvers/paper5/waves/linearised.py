r"""The linearised theory of paper 5, section 2.2: trial fields without meridional displacement.

u = f z', v = f, w = -f r' (v an angle, so q = r f) with f zero at the ends of the wet part leaves
lam1 unchanged to first order, and

.. math::
   \Pi_2/\pi = A + n B,\qquad B = -\int p\, r f^2 (r'^2 + z'^2)\, ds < 0.

(a) the matrices K0, K1, K2 of :mod:`waves.second_variation` between nodal values of the field; (b) sums
over Gauss points of the principal-axes form of :mod:`waves.transfer`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reference_data.solvers.core.collocation import differentiation, lagrange
from reference_data.solvers.paper5.waves.second_variation import Quadratic
from reference_data.solvers.paper5.waves.transfer import gradients, moduli

Array = np.ndarray


@dataclass
class Affine:
    """A, B, the coefficient of n^2 (zero up to rounding), and B by its closed form."""

    A: float
    B: float
    square: float
    closed: float

    @property
    def n_star(self) -> float:
        """Wave number above which the field lowers the energy."""
        return -self.A / self.B


def amplitude(s: Array, level: float, power: int) -> Array:
    """sin(pi s/level)^power on the wet part, 0 above."""
    return np.where(s < level, np.sin(np.pi * np.minimum(s, level) / level) ** power, 0.0)


def nodal(form: Quadratic, level: float, power: int) -> tuple[Array, Array]:
    """Base values and the field (u, q, w) at the form's nodes, (elements, nodes, .)."""
    edges = form.state.edges
    s = edges[:-1, None] + np.diff(edges)[:, None] * form.nodes
    y = np.einsum("im,kmc->kic", lagrange(form.state.nodes, form.nodes), form.state.y)
    r, _, l1, b = np.moveaxis(y, -1, 0)
    f = amplitude(s, level, power)
    return y, np.stack([f * l1 * np.cos(b), r * f, -f * l1 * np.sin(b)], axis=-1)


def closed_form(form: Quadratic, level: float, power: int) -> float:
    """B by its integral in closed form."""
    f = amplitude(form.s, level, power)
    return -float(np.sum(form.weights * form.p * form.r * f**2 * form.l1**2))


def by_matrices(form: Quadratic, level: float, power: int) -> Affine:
    """The second variation by method (a), the matrices."""
    _, field = nodal(form, level, power)
    d = np.zeros(form.size)
    d[form.index] = field.reshape(len(field), -1)
    terms = [float(d @ (k @ d)) / 2 for k in form.stiffness]
    return Affine(terms[0], terms[1], terms[2], closed_form(form, level, power))


def by_principal_axes(form: Quadratic, level: float, power: int) -> Affine:
    """The second variation by method (b): coefficients from the values at n = 0, 1, 2."""
    _, field = nodal(form, level, power)
    x, _ = np.polynomial.legendre.leggauss(form.s.shape[1])
    rows = lagrange(form.nodes, (x + 1) / 2)
    width = form.width[..., None]
    at = np.einsum("gm,kmc->kgc", rows, field).reshape(-1, 3)
    slope = (np.einsum("gm,kmc->kgc", rows @ differentiation(form.nodes), field) / width).reshape(-1, 3)
    flat = [np.ravel(a) for a in (form.r, form.dr, form.dz, form.l1, form.R, form.H, form.p, form.pz)]
    r, dr, dz, l1, R, H, p, pz = flat
    d = moduli(l1, r / R, np.ravel(form.tense), form.state.surface.c2)
    (u, q, w), (du, _, dw) = at.T, slope.T
    values = []
    for n in range(3):
        e1, e0 = gradients(dr, dz, l1, R, n)
        h = np.einsum("kij,kj->ki", e1, slope) + np.einsum("kij,kj->ki", e0, at)
        elastic = H * R * np.einsum("ki,kij,kj->k", h, d, h)
        push = dz * (u**2 + q**2) + 2 * n * q * (dz * u - dr * w) - dr * u * w + r * (u * dw - w * du)
        load = -p * push - pz * r * w * (dz * u - dr * w)
        values.append(float(np.sum(np.ravel(form.weights) * (elastic + load))) / 2)
    square = (values[2] - 2 * values[1] + values[0]) / 2
    return Affine(values[0], values[1] - values[0] - square, square, closed_form(form, level, power))
