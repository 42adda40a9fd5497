r"""Relaxed energy, data and unloaded state of the cylinder of non-uniform thickness.

Source: Patil, Nordmark & Eriksson, Eur. J. Mech. A/Solids 54 (2015) 1-10, sections 2 and 3.
With the full Mooney-Rivlin energy of :mod:`core.mooney_rivlin` (alpha = c2 = C2/C1), the energy of a sheet
wrinkled along the meridian, over C1, equals the energy of uniaxial tension,

.. math:: W_r(l) = l^2 + 2/l - 3 + c_2\,(2 l + 1/l^2 - 3),

valid where the wrinkling function gw = lam2 sqrt(lam1) is below 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, Protocol

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq

Array = np.ndarray

# Data of the paper: rho g Ao^2/(C1 h) with water, Ao = 10 mm, h = 0.1 mm, C1 = 0.2111 MPa.
GAMMA = 1000.0 * 9.81 * 0.010**2 / (0.2111e6 * 0.1e-3)


def relaxed_slope(l1: Any, c2: float) -> Any:
    """First derivative of the relaxed energy, W_r'(l1).

    Here and below ``c2`` may be another law instead of C2/C1 (``core.laws``), W_r(l) = w(l, l^(-1/2)).
    """
    if not isinstance(c2, float | int):
        return c2.slope(l1, c2.width(l1)[0])
    return 2 * (l1 - 1 / (l1 * l1)) + 2 * c2 * (1 - 1 / (l1 * l1 * l1))


def relaxed_curvature(l1: Any, c2: float) -> Any:
    """Second derivative of the relaxed energy, W_r''(l1)."""
    if not isinstance(c2, float | int):
        width, rate = c2.width(l1)
        return c2.curvature(l1, width) + c2.mixed(l1, width) * rate
    cube = l1 * l1 * l1
    return 2 + 4 / cube + 6 * c2 / (cube * l1)


class Body(Protocol):
    """A membrane of revolution over its unloaded meridian, s in [0, L], and its load.

    Attributes:
        L: Length of the meridian.
        c2: C2/C1, or another law.
        energy: "relaxed", or "standard" for the full energy everywhere.
        load: "gas" or "fluid".
        control: Name of the load.
        weight: Specific weight of the fluid; 0 for gas.
        pole: Whether the meridian begins on the axis.
        longest: Longest step of Newton's method of tracked states.
        cautious: Longest step of that of differences.
    """

    L: float
    c2: float
    energy: str
    load: str
    control: str
    weight: float
    pole: bool
    longest: float
    cautious: float

    def unloaded(self, s: Any) -> Any:
        """Unloaded radius."""

    def eta(self, s: Any) -> Any:
        """Thickness over its mean."""

    def slopes(self, s: Any) -> tuple[Any, Any]:
        """Derivatives of the unloaded radius and of the thickness."""

    def clamped(self, bottom: list[Any], top: list[Any]) -> list[Any]:
        """What vanishes at both ends, of (r, z, l, b) there: two numbers each."""

    def pressure(self, z: Any, load: Any, wet: Any) -> Any:
        """Pressure at a height, on the wet part."""

    def decided(self, load: float) -> bool:
        """Whether the sign of gw - 1 is not needed."""

    def segments(self, count: int, steps: int) -> Any:
        """Ends of the segments of multiple shooting with some steps each."""

    def begin(self, given: Any, load: Any, s: float) -> Any:
        """(r, z, A, F) where the first segment begins, from the unknowns there (last axis)."""

    def free(self, given: Any) -> list[Any]:
        """What vanishes of the unknowns where the first segment begins: two numbers."""

    def crossed(self, load: float) -> bool:
        """Whether the fluid's surface lies between the ends."""


@dataclass(frozen=True)
class Membrane:
    """A pre-stretched cylinder and its load; lengths over Ao, s = Z/Ao in [0, L].

    Attributes:
        M: Thickness at s = 0 over the mean, eta(s) = M + 2 (1 - M) s/L.
        delta: Axial pre-stretch; z(L) = delta L.
        c2: C2/C1, or another law.
        L: Undeformed length over the undeformed radius.
        Af: Radius of the end disks over Ao; None for the critical one of case 1.
        load: "gas" (p = P Ao/(C1 h)) or "fluid" (level zw over Ao, specific weight gamma).
        gamma: rho g Ao^2/(C1 h).
        energy: "relaxed", or "standard" for the full energy everywhere.
    """

    M: float
    delta: float
    c2: float = 0.01
    L: float = 8.0
    Af: float | None = None
    load: str = "fluid"
    gamma: float = GAMMA
    energy: str = "relaxed"
    pole: ClassVar[bool] = False
    longest: ClassVar[float] = 0.4
    cautious: ClassVar[float] = 0.5

    def unloaded(self, s: Any) -> Any:
        """Unloaded radius."""
        return 1.0 + 0 * s

    def slopes(self, s: Any) -> tuple[Any, Any]:
        """Derivatives of the unloaded radius and of the thickness."""
        return 0.0, self.eta_slope

    def clamped(self, bottom: list[Any], top: list[Any]) -> list[Any]:
        """Both ends on the disks."""
        return [bottom[0] - self.radius, bottom[1], top[0] - self.radius, top[1] - self.delta * self.L]

    def segments(self, count: int, _steps: int) -> Array:
        """Ends of the segments of multiple shooting."""
        return np.linspace(0, self.L, count + 1)

    def begin(self, given: Array, _load: Array, _s: float) -> Array:
        """(r, z, A, F) at the lower disk are the unknowns there."""
        return given

    def free(self, given: Array) -> list[Any]:
        """What vanishes of the unknowns at the lower disk."""
        return [given[0] - self.radius, given[1]]

    def crossed(self, load: float) -> bool:
        """Whether the fluid's surface lies between the ends."""
        return self.load == "fluid" and 0 < load < self.delta * self.L

    @property
    def weight(self) -> float:
        """Specific weight of the fluid; 0 for gas."""
        return 0.0 if self.load == "gas" else self.gamma

    @property
    def control(self) -> str:
        """Name of the load: p or zw."""
        return "p" if self.load == "gas" else "zw"

    def eta(self, s: Any) -> Any:
        """Thickness over its mean."""
        return self.M + self.eta_slope * s

    @property
    def eta_slope(self) -> float:
        """Derivative of eta with respect to s."""
        return 2 * (1 - self.M) / self.L

    @property
    def thinnest(self) -> float:
        """Least thickness over the mean."""
        return min(self.M, 2 - self.M)

    @cached_property
    def radius(self) -> float:
        """Radius of the disks, Af/Ao."""
        return critical_radius(self) if self.Af is None else self.Af

    @cached_property
    def cylindrical(self) -> bool:
        """Whether the unloaded membrane is a wholly wrinkled cylinder (case 1, Af <= (Af)_c)."""
        return self.energy == "relaxed" and (self.Af is None or self.Af <= critical_radius(self))

    def decided(self, load: float) -> bool:
        """Whether the sign of gw - 1 is not needed: standard energy, or the unloaded cylinder (gw <= 1)."""
        return self.energy == "standard" or (load == 0 and self.cylindrical)

    def pressure(self, z: Any, load: Any, wet: Any) -> Any:
        """Pressure p, or gamma (zw - z) on the wet part and 0 on the dry."""
        if self.load == "gas":
            return load + 0 * z
        return np.where(wet, self.gamma * (load - z), 0.0)


def stiffness(c2: float) -> float:
    """Stiffness of a law at large stretches, for a start to the left of a root; infinite if unknown."""
    return 2 + 2 * c2 if isinstance(c2, float | int) else np.inf


def uniaxial_stretch(force: Any, c2: float) -> Any:
    """Root l of W_r'(l) = force >= 0; W_r' rises and is concave, so Newton cannot overshoot.

    For other laws, which may stiffen, steps are limited.
    """
    l1 = np.maximum(1.0, np.real(force) / stiffness(c2)) + 0 * force
    for _ in range(60):
        step = (force - relaxed_slope(l1, c2)) / relaxed_curvature(l1, c2)
        l1 = l1 + bounded(step, c2)
        if np.max(np.abs(step)) < 1e-15 * np.max(np.abs(l1)):
            break
    return l1


def bounded(step: Any, c2: float) -> Any:
    """A step of Newton's method for a stretch, for other laws at most a fifth of it."""
    if isinstance(c2, float | int):
        return step
    return step * np.minimum(1.0, 0.2 / np.maximum(np.abs(step), 1e-300))


def uniaxial_tension(membrane: Membrane) -> float:
    """Tension N of the unloaded, wholly wrinkled cylinder: eta W_r'(lam1) = N, mean of lam1 = delta.

    The mean is a Gauss-Legendre sum over s.
    """
    x, w = np.polynomial.legendre.leggauss(80)
    eta = membrane.eta(membrane.L * (x + 1) / 2)

    def excess(force: float) -> float:
        return float(np.sum(w / 2 * uniaxial_stretch(force / eta, membrane.c2))) - membrane.delta

    top = 4.0 * relaxed_slope(membrane.delta, membrane.c2)
    return float(brentq(excess, 1e-6, top, xtol=1e-15, rtol=9e-16))


def critical_radius(membrane: Membrane) -> float:
    """Largest Af with gw <= 1 everywhere at zero load: lam1^(-1/2) at the thinnest place."""
    force = np.array(uniaxial_tension(membrane) / membrane.thinnest)
    return float(uniaxial_stretch(force, membrane.c2)) ** -0.5


def critical_radius_by_parts(membrane: Membrane) -> float:
    r"""The same radius, computed differently: the mean of lam1 integrated by parts over the stretch.

    With eta = N/W_r'(l), int l d eta = [l eta] - N int d l/W_r'(l), between the stretches of the
    two ends; the integral over l is adaptive.
    """
    thin = min(membrane.M, 2 - membrane.M)
    if thin == 1:
        return membrane.delta**-0.5
    thick, c2 = 2 - thin, membrane.c2

    def stretch(force: float) -> float:
        high = 2 + force
        if not isinstance(c2, float | int):
            high = 1.1
            while relaxed_slope(high, c2) < force:
                high *= 1.1
        return brentq(lambda l1: relaxed_slope(l1, c2) - force, 1.0, high, xtol=1e-15, rtol=9e-16)

    def excess(force: float) -> float:
        low, high = stretch(force / thick), stretch(force / thin)
        area = quad(lambda l1: 1 / relaxed_slope(l1, c2), low, high, epsabs=1e-13, epsrel=1e-13)[0]
        return (low * thick - high * thin + force * area) / (thick - thin) - membrane.delta

    top = 2.0 * relaxed_slope(membrane.delta, c2)
    return stretch(brentq(excess, 1e-3, top, xtol=1e-15, rtol=9e-16) / thin) ** -0.5
