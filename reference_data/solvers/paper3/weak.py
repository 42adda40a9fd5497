r"""First variation of the fluid-loaded membrane, and its tangent, point by point.

At a point with tangents a = x_,Z and b = x_,Theta, metric g11 = a.a, g22 = b.b, g12 = a.b,
J = g11 g22 - g12^2, normal N = b x a and P = gamma (z_w - z)_+ the principle of stationary potential
energy of paper 3, integrated by parts once, is

.. math::
   F(x; v) = \iint f_a \cdot v_{,Z} + f_b \cdot v_{,\Theta} - P\, v\cdot N \; dZ\, d\Theta,\quad
   f_a = a - (g_{22} a - g_{12} b)/J^2,\quad f_b = b - (g_{11} b - g_{12} a)/J^2 .

Its derivative needs no term at the free surface, because (z_w - z) vanishes there. Everything is
Cartesian; vectors of nine stand for (v_,Z, v_,Theta, v). This is the physics of the two variational
methods (Galerkin in one and in two dimensions); the collocation code uses none of it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from reference_data.solvers.core.law_metric import shear_modulus

Array = np.ndarray
STEP = 1e-30
TINY = 1e-32


def dot(a: Any, b: Any) -> Any:
    """Scalar product over the last axis (no complex conjugation)."""
    return np.sum(a * b, axis=-1)


def fluxes(a: Any, b: Any, law: Any = None) -> tuple[Any, Any]:
    r"""Factors f_a, f_b of v_,Z and v_,Theta.

    Of another law, with :math:`f_i = w_i/(2 l_i)` and :math:`f_y = (f_1 - f_2)/(l_1^2 - l_2^2)`, the tensor
    of the energy's derivatives by the metric G is :math:`f_y G + [(f_1 + f_2)/2 - f_y\,\mathrm{tr}\,G/2] I`.
    """
    g11, g22, g12 = (dot(*pair)[..., None] for pair in ((a, a), (b, b), (a, b)))
    if law is not None:
        l1, l2 = (x[..., None] for x in stretches(a, b))
        shear = shear_modulus(law, l1, l2)
        mean = (law.slope(l1, l2) / l1 + law.slope(l2, l1) / l2) / 4
        half = shear * (g11 - g22) / 2
        return (mean + half) * a + shear * g12 * b, (mean - half) * b + shear * g12 * a
    square = (g11 * g22 - g12 * g12) ** 2
    return a - (g22 * a - g12 * b) / square, b - (g11 * b - g12 * a) / square


def residual(a: Array, b: Array, pressure: Array, law: Any = None) -> Array:
    """Factors (..., 9) of (v_,Z, v_,Theta, v) in F."""
    return np.concatenate([*fluxes(a, b, law), -pressure[..., None] * np.cross(b, a)], axis=-1)


def cross_matrix(a: Array) -> Array:
    """Matrix (..., 3, 3) of the map c -> a x c."""
    out = np.zeros((*a.shape, 3))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        out[..., i, k], out[..., i, j] = a[..., j], -a[..., k]
    return out


def tangent(a: Array, b: Array, pressure: Array, slope: Array, law: Any = None) -> Array:
    """Derivative (..., 9, 9) of :func:`residual` with respect to (x_,Z, x_,Theta, x).

    Args:
        a: x_,Z.
        b: x_,Theta.
        pressure: P.
        slope: dP/dz, -gamma in the fluid.
        law: Another law than the neo-Hookean one.
    """
    out = np.zeros((*a.shape[:-1], 9, 9))
    for i in range(3):
        bump = 1j * STEP * np.eye(3)[i]
        for at, (da, db) in ((i, (bump, 0)), (3 + i, (0, bump))):
            out[..., :6, at] = np.imag(np.concatenate(fluxes(a + da, b + db, law), axis=-1)) / STEP
    load = pressure[..., None, None]
    out[..., 6:, :3] = -load * cross_matrix(b)
    out[..., 6:, 3:6] = load * cross_matrix(a)
    out[..., 6:, 8] = -slope[..., None] * np.cross(b, a)
    return out


def energy_density(a: Array, b: Array, law: Any = None) -> Array:
    """Strain energy (g11 + g22 + 1/J - 3)/2 per reference area, or that of another law."""
    if law is not None:
        return law.energy(*stretches(a, b)) / 2
    g11, g22, g12 = dot(a, a), dot(b, b), dot(a, b)
    return (g11 + g22 + 1 / (g11 * g22 - g12 * g12) - 3) / 2


def flux_of_radius(x: Array, a: Array, b: Array) -> Array:
    """(x e_x + y e_y).N/2, whose integral is a volume."""
    return np.sum(x[..., :2] * np.cross(b, a)[..., :2], axis=-1) / 2


def stretches(a: Array, b: Array) -> tuple[Array, Array]:
    """Principal stretches; the first one belongs to the direction nearer to the meridian."""
    g11, g22, g12 = dot(a, a), dot(b, b), dot(a, b)
    square = (g11 - g22) ** 2 + 4 * g12 * g12
    half = np.sqrt(np.where(square == 0, TINY, square)) / 2  # complex steps need a slope there
    half = np.where(g11 >= g22, half, -half)
    mean = (g11 + g22) / 2
    return np.sqrt(mean + half), np.sqrt(mean - half)


def cut_resultants(a: Array, b: Array, law: Any = None) -> tuple[Array, Array]:
    """T1, T2 across the curves Z = const and Theta = const where a.b = 0, from the energy alone.

    The force on a cut is the energy's derivative by the Cartesian tangent (complex step); it is divided by
    the current length of the cut.
    """
    l1, l2 = np.sqrt(dot(a, a)), np.sqrt(dot(b, b))
    along = 1j * STEP * a / l1[..., None], 1j * STEP * b / l2[..., None]
    force = np.imag(energy_density(a + along[0], b, law)), np.imag(energy_density(a, b + along[1], law))
    return force[0] / STEP / l2, force[1] / STEP / l1


def resultants(lam1: Any, lam2: Any, law: Any = None) -> tuple[Any, Any]:
    """Principal Cauchy stress resultants T1, T2 (per current length)."""
    if law is not None:
        return law.slope(lam1, lam2) / (2 * lam2), law.slope(lam2, lam1) / (2 * lam1)
    cube = (lam1 * lam2) ** 3
    return lam1 / lam2 - 1 / cube, lam2 / lam1 - 1 / cube
