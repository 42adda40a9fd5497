"""What one asks of a state without axial symmetry: positions, stresses, volume, energy, stability."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse.linalg as sla
from scipy.optimize import brentq

from reference_data.solvers.paper3 import weak
from reference_data.solvers.paper3.bent.equations import (
    BREAKING,
    SYMMETRIC,
    Array,
    Assembly,
    Surface,
    points,
)
from reference_data.solvers.paper3.bent.newton import Factor


def integrals(surface: Surface) -> tuple[float, float]:
    """Fluid volume and total potential energy of the whole tube."""
    volume = potential = 0.0
    for e in range(surface.grid.elements.count):
        p = points(surface, e)
        flux = weak.flux_of_radius(p.x, p.a, p.b) * p.wet
        load = surface.tube.gamma * (surface.zw - p.x[..., 2])
        volume += 2 * float(np.sum(p.weight * flux))
        strain = weak.energy_density(p.a, p.b, surface.tube.law)
        potential += 2 * float(np.sum(p.weight * (strain - load * flux)))
    return volume, potential


def surface_area(surface: Surface) -> float:
    """Area of the free surface, 0 when over-filled."""
    if not surface.partial:
        return 0.0
    theta = surface.grid.theta
    node = surface.grid.elements.wet * surface.grid.elements.degree
    # along the curve s = 1, so the derivative at fixed s is the one along the curve
    x, turn = surface.nodal(theta)[node], surface.nodal(theta, 1)[node]
    return float(np.sum(x[:, 0] * turn[:, 1] - x[:, 1] * turn[:, 0]) * np.pi / len(theta))


def lowest_point(surface: Surface) -> float:
    """Smallest height on the meridian Theta = 0, where the membrane hangs lowest."""
    at, zero = np.linspace(0, surface.tube.length / 2, 201), np.zeros(1)
    bottom = int(np.argmin(surface.evaluate(at, zero)[0][:, 0, 2]))
    if bottom == 0:
        return 0.0
    slope = lambda x: surface.evaluate(np.array([x]), zero)[1][0, 0, 2]  # noqa: E731
    where = brentq(slope, at[bottom - 1], at[bottom + 1], xtol=1e-13)
    return float(surface.evaluate(np.array([where]), zero)[0][0, 0, 2])


def smallest_resultant(surface: Surface) -> float:
    """Smallest principal stress resultant on a net of 240 by 60 points of the half tube."""
    at, theta = np.linspace(0, surface.tube.length, 241), np.linspace(0, np.pi, 61)
    _, a, b = surface.evaluate(at, theta)
    return float(min(t.min() for t in weak.resultants(*weak.stretches(a, b), surface.tube.law)))


def quantities(surface: Surface) -> dict[str, float]:
    """Columns of the secondary branch, without the eigenvalues."""
    length, ends = surface.tube.length, np.array([0.0, np.pi])
    x, a, b = surface.evaluate(np.array([length / 2, length / 4]), ends)
    t1, t2 = weak.resultants(*weak.stretches(a, b), surface.tube.law)
    r = np.hypot(x[0, :, 0], x[0, :, 1])
    volume, potential = integrals(surface)
    out = {"zw": surface.zw, "V": volume, "r_mid": float(r[0]), "r_mid_pi": float(r[1])}
    for i, side in enumerate(("0", "pi")):
        out |= {
            f"x_quarter_{side}": float(x[1, i, 0]),
            f"z_quarter_{side}": float(x[1, i, 2]),
            f"T1_quarter_{side}": float(t1[1, i]),
            f"T2_quarter_{side}": float(t2[1, i]),
        }
    return out | {"z_min": lowest_point(surface), "T_min": smallest_resultant(surface), "Pi": potential}


@dataclass
class Stability:
    """Lowest eigenvalues at given level: C1v, its breaking (without the rotation), and at given volume."""

    symmetric: Array
    breaking: float
    rotation: float
    volume_held: float

    def columns(self) -> dict[str, float]:
        """As columns of a table."""
        names = {f"Lambda_{i + 1}": float(v) for i, v in enumerate(self.symmetric)}
        return names | {"Lambda_breaking": self.breaking, "LambdaV_1": self.volume_held}


class Pencil:
    """Stiffness and mass of one symmetry family, with a shift below the whole spectrum."""

    def __init__(self, surface: Surface, parities: tuple[int, ...], shift: float) -> None:
        self.assembly = Assembly(surface, parities, mass=True)
        self.functions, el = self.assembly.functions, surface.grid.elements
        self.joined, self.nodes = el.joined, el.count * el.degree + 1
        self.shift = shift
        while True:  # Cholesky's method succeeds only when the shift is below every eigenvalue
            try:
                blocks = self.assembly.stiffness - self.shift * self.assembly.mass
                self.factor = Factor(blocks, self.functions, definite=True)
                return
            except np.linalg.LinAlgError:
                self.shift *= 2
                if self.shift < -100:
                    raise RuntimeError(f"surface: no shift below the spectrum of {surface.tube}") from None

    def full(self, v: Array) -> Array:
        """Nodal values (nodes, functions) of a vector of the free unknowns."""
        out = np.zeros((self.nodes, self.functions))
        out[1:-1] = v.reshape(-1, self.functions)
        return out

    def mass(self, v: Array) -> Array:
        """Mass matrix times a vector."""
        values, out = self.full(v), np.zeros((self.nodes, self.functions))
        for e, at in enumerate(self.joined):
            out[at] += (self.assembly.mass[e] @ values[at].ravel()).reshape(len(at), -1)
        return out[1:-1].ravel()

    def inverse(self, v: Array) -> Array:
        """(K - shift M)^-1 times a vector."""
        return self.factor.solve(self.full(v))[1:-1].ravel()

    def lowest(self, count: int, held: tuple[Array, float] | None = None) -> tuple[Array, Array]:
        """Lowest eigenpairs; ``held`` = (d, c) adds c d d^T to K, or for c = inf demands d.v = 0."""
        size = (self.nodes - 2) * self.functions

        def inverse(v: Array) -> Array:
            y = self.inverse(v)
            if held is None:
                return y
            return y - z * (held[0] @ y) / (1 / held[1] + held[0] @ z)

        if held is not None:
            z = self.inverse(held[0])
        start = np.random.default_rng(0).standard_normal(size)
        values, vectors = sla.eigsh(
            _operator(size, lambda v: v),  # not used: everything goes through the inverse
            k=count,
            M=_operator(size, self.mass),
            sigma=self.shift,
            OPinv=_operator(size, inverse),
            v0=inverse(start),
            tol=1e-12,
        )
        order = np.argsort(values)
        return values[order], vectors[:, order]


def _operator(size: int, f: object) -> sla.LinearOperator:
    return sla.LinearOperator((size, size), matvec=f, dtype=float)


def rotation(surface: Surface) -> Array:
    """Rigid rotation of the pattern, e_z x x - x_,Theta, in the breaking family's basis."""
    grid = surface.grid
    front, _ = surface.front_at(grid.theta)
    at = np.stack([grid.elements.positions(surface.tube, f) for f in front], axis=1)
    x, _, b = surface.evaluate(at, grid.theta)
    turned = np.stack([-x[..., 1], x[..., 0], 0 * x[..., 0]], axis=-1) - b
    return np.concatenate([grid.project(turned[..., i], p) for i, p in enumerate(BREAKING)], axis=-1)


def stability(surface: Surface, near: Stability | None = None) -> Stability:
    """Lowest eigenvalues of d2Pi = Lambda M in the C1v space, its complement, and at given volume.

    Args:
        surface: The state.
        near: The same on another grid, which tells where the spectrum begins (only to save time).

    Raises:
        RuntimeError: If no shift below the spectrum is found.
    """
    kept = Pencil(surface, SYMMETRIC, -1.0 if near is None else 1.1 * float(near.symmetric[0]) - 0.3)
    symmetric, _ = kept.lowest(3)
    area = surface_area(surface)
    d = kept.assembly.volume[1:-1].ravel()
    # over half the circumference d and K are halves, hence twice gamma/A_s
    stiffness = 2 * surface.tube.gamma / area if area > 0 else np.inf
    volume_held, _ = kept.lowest(1, (d, stiffness))
    broken = Pencil(surface, BREAKING, -0.3)
    values, vectors = broken.lowest(3)
    spin = broken.mass(rotation(surface)[1:-1].ravel())
    norms = np.sqrt(np.einsum("ij,ij->j", vectors, np.stack([broken.mass(v) for v in vectors.T], axis=1)))
    which = int(np.argmax(np.abs(spin @ vectors) / norms))
    others = np.delete(values, which)
    return Stability(symmetric, float(others[0]), float(values[which]), float(volume_held[0]))
