"""What one asks of a bent tube, from the balance of forces: volume and energy by fluxes of height, stability.

No formula is that of :mod:`bent.states`: volume and the liquid's potential are fluxes of
vertical fields through the closed body, stretches are singular values, resultants are forces on principal
cuts, eigenvalues are those of the linearised balance of forces, which is not symmetric.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse.linalg as sla

from reference_data.solvers.paper3.bent.newton import Factor
from reference_data.solvers.paper3.strong.equations import (
    BREAKING,
    SYMMETRIC,
    Balance,
    Bent,
    forces,
    spread_out,
)
from reference_data.solvers.paper3.strong.net import EVEN, Array

SHIFT = -3.0  # of the eigenvalue problem; the lowest eigenvalue of the published states is above -2.1
COUNT = 8  # eigenvalues nearest to the shift, from which the lowest are taken
REAL = 1e-6  # imaginary part, over the distance from the shift, above which an eigenvalue is not believed


def principal(a: Array, b: Array, law: Any = None) -> tuple[Array, Array, Array, Array]:
    """Stretches and Cauchy resultants lam1, lam2, T1, T2; the first belongs to the direction nearer to Z."""
    left, lam, right = np.linalg.svd(np.stack([a, b], axis=-1), full_matrices=False)
    force = np.stack(forces(a, b, law), axis=-1)
    # the force on a cut that a unit of material length crosses, per current length of that cut
    pull = np.einsum("...ci,...cd,...id->...i", left, force, right) / lam[..., ::-1]
    first = np.abs(right[..., 0, 0]) >= np.abs(right[..., 1, 0])
    swapped = (
        np.where(first[..., None], lam, lam[..., ::-1]),
        np.where(first[..., None], pull, pull[..., ::-1]),
    )
    return swapped[0][..., 0], swapped[0][..., 1], swapped[1][..., 0], swapped[1][..., 1]


def surface_area(bent: Bent) -> float:
    """Area of the free surface by the shoelace of its trigonometric curve, 0 when over-filled."""
    if not bent.net.dry:
        return 0.0
    edge = bent.x[bent.net.wet - 1, -1]
    turned = [edge[:, c] @ bent.net.turns[p].T for c, p in ((0, EVEN), (1, 1))]
    return float(np.sum((edge[:, 0] * turned[1] - edge[:, 1] * turned[0]) * bent.net.around)) / 2


def density(l1: Array, l2: Array, law: Any) -> Array:
    """Twice the strain energy per reference area."""
    return l1**2 + l2**2 + (l1 * l2) ** -2 - 3 if law is None else law.energy(l1, l2)


def integrals(bent: Bent) -> tuple[float, float]:
    """Fluid volume and total potential energy of the whole tube, fluxes through membrane and lid."""
    net, zw, gamma = bent.net, bent.zw, bent.tube.gamma
    w, widths = net.weights(), np.diff(net.breaks)
    lid = surface_area(bent) if net.dry else np.pi
    top = zw if net.dry else bent.tube.L
    volume, weight = lid * top, lid * (zw * top - top**2 / 2)
    strain = 0.0
    for e in range(net.count):
        a, b = bent.tangents(e)
        area = w[:, None] * widths[e] * bent.mapping(e)[0] * net.around
        lam = np.linalg.svd(np.stack([a, b], axis=-1), compute_uv=False)
        strain += float(np.sum(area * density(lam[..., 0], lam[..., 1], bent.tube.law))) / 2
        if e < net.wet:
            up, z = area * np.cross(b, a)[..., 2], bent.x[e][..., 2]
            volume += float(np.sum(up * z))
            weight += float(np.sum(up * (zw * z - z**2 / 2)))
    return volume, strain - gamma * weight


def lowest_point(bent: Bent) -> float:
    """Smallest height on the meridian Theta = 0: stationary points of the elements' polynomials."""
    found = 0.0
    for x in bent.x[:, :, 0, 2]:
        series = np.polynomial.Chebyshev(
            np.polynomial.chebyshev.chebfit(2 * bent.net.nodes - 1, x, bent.net.degree)
        )
        roots = series.deriv().roots()
        inside = roots[(np.abs(roots.imag) < 1e-9) & (np.abs(roots.real) <= 1)].real
        found = min([found, *series(inside)])
    return float(found)


def quantities(bent: Bent) -> dict[str, float]:
    """Columns of the secondary branch, without the eigenvalues."""
    length, ends = bent.tube.length, np.array([0.0, np.pi])
    x, a, b = bent.evaluate(np.array([length / 2, length / 4]), ends)
    *_, t1, t2 = principal(a, b, bent.tube.law)
    volume, potential = integrals(bent)
    r = np.hypot(x[0, :, 0], x[0, :, 1])
    out = {"zw": bent.zw, "V": volume, "r_mid": float(r[0]), "r_mid_pi": float(r[1])}
    for i, side in enumerate(("0", "pi")):
        names = (f"{k}_quarter_{side}" for k in ("x", "z", "T1", "T2"))
        values = (x[1, i, 0], x[1, i, 2], t1[1, i], t2[1, i])
        out |= {k: float(v) for k, v in zip(names, values, strict=True)}
    net = bent.evaluate(np.linspace(0, length, 241), np.linspace(0, np.pi, 61))[1:]
    smallest = min(float(t.min()) for t in principal(*net, bent.tube.law)[2:])
    return out | {"z_min": lowest_point(bent), "T_min": smallest, "Pi": potential}


class Linearised:
    """The linearised balance of forces of one symmetry family, shifted and factorised.

    The mass of an element is its reference area, Z_,s; conditions between elements have none.
    """

    def __init__(self, bent: Bent, parities: tuple[int, ...]) -> None:
        self.bent, self.now = bent, Balance(bent, parities)
        degree = bent.net.degree
        blocks = []
        for e, matrix in enumerate(self.now.matrix):
            mass = self.now.mass[e * degree : (e + 1) * degree + 1].ravel()
            blocks.append(-matrix - SHIFT * np.diag(mass))
        self.factor = Factor(blocks, self.now.unknowns)

    def full(self, v: Array) -> Array:
        """Nodal values (nodes, unknowns) of a vector of the free unknowns."""
        out = np.zeros_like(self.now.mass)
        out[1:-1] = v.reshape(-1, self.now.unknowns)
        return out

    def solved(self, v: Array) -> Array:
        """The factorised matrix' inverse times a vector."""
        return self.factor.solve(self.full(v))[1:-1].ravel()

    def lowest(self, held: bool = False) -> tuple[Array, Array]:
        """Eigenvalues nearest to SHIFT, rising, and their modes (modes, free unknowns).

        ``held``: at given volume, which adds (gamma/A_s) N (int N.v) to the balance, or, over-filled, asks
        for int N.v = 0.

        Raises:
            RuntimeError: If one of the lowest three is not real.
        """
        mass = self.now.mass[1:-1].ravel()
        gradient = volume_gradient(self.bent, self.now)[1:-1].ravel()
        spread = self.solved(self.now.by_level[1:-1].ravel() / self.bent.tube.gamma)
        room = surface_area(self.bent) / self.bent.tube.gamma + gradient @ spread

        def operator(v: Array) -> Array:
            y = self.solved(mass * v)
            return y - spread * (gradient @ y) / room if held else y

        start = operator(np.random.default_rng(0).standard_normal(len(mass)))
        linear = sla.LinearOperator((len(mass),) * 2, matvec=operator, dtype=float)
        found, modes = sla.eigs(linear, k=COUNT, which="LM", v0=start, tol=1e-11)
        values = SHIFT + 1 / found
        order = np.argsort(values.real)
        first = values[order][:3]
        if np.any(np.abs(first.imag) > REAL * np.abs(first - SHIFT)):
            raise RuntimeError(f"collocation of the bent tube: complex eigenvalues {first}")
        return values.real[order], modes.real[:, order].T


def volume_gradient(bent: Bent, now: Balance) -> Array:
    """Weights (nodes, unknowns) of int N.v over the wet membrane."""
    net, w, widths = bent.net, bent.net.weights(), np.diff(bent.net.breaks)
    out = np.zeros_like(now.residual)
    for e in range(net.wet):
        a, b = bent.tangents(e)
        area = w[:, None] * widths[e] * bent.mapping(e)[0] * net.around
        flat = (area[..., None] * np.cross(b, a)).reshape(net.degree + 1, -1)[:, now.keep]
        out[e * net.degree : (e + 1) * net.degree + 1] += flat
    return out


def rotation(bent: Bent) -> Array:
    """Rigid rotation of the pattern, e_z x x - x_,Theta at fixed Z, shape of the positions."""
    out = np.stack([-bent.x[..., 1], bent.x[..., 0], 0 * bent.x[..., 0]], axis=-1)
    for e in range(bent.net.count):
        out[e] -= bent.tangents(e)[1]
    return out


def stability(bent: Bent) -> dict[str, float]:
    """Lowest eigenvalues in the C1v space, of its breaking (without the rotation), and at given volume.

    Raises:
        RuntimeError: If one of them is not real.
    """
    symmetric, broken = Linearised(bent, SYMMETRIC), Linearised(bent, BREAKING)
    out = {f"Lambda_{i + 1}": float(v) for i, v in enumerate(symmetric.lowest()[0][:3])}
    values, modes = broken.lowest()
    spin, keep = rotation(bent), broken.now.keep
    fields = [spread_out(bent, broken.full(v), keep) for v in modes]
    which = int(np.argmax([abs(np.sum(f * spin)) / np.linalg.norm(f) for f in fields]))
    out["Lambda_breaking"] = float(np.delete(values, which)[0])
    out["LambdaV_1"] = float(symmetric.lowest(held=True)[0][0])
    return out | {"rotation": float(values[which])}
