r"""Adhesive inflation without radial slip only (model N) by collocation (method b).

In the patch rho = rho_c(x) is frozen, eta free. With l1 = rho_c'/cos th, (x W_1 sin th)' =
(p - k (eta - l)) rho_c rho_c' is solved for th'; unknowns (eta, th). At the front eta = l, and
rho, eta and the vertical force x W_1 sin th are continuous; d rho_c/dx* = rho'(x*+). The frozen
slope g = rho_c' is a Chebyshev series, found as the fixed point over all fronts at once.

Source: Patil, DasGupta & Eriksson (2015), section 3.2, read as "no tangential slip" of the
radius alone.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.collocation import Mesh, differentiation
from reference_data.solvers.paper1.collocation.equations import (
    Array,
    Batch,
    Sliding,
    integral,
    spread,
)
from reference_data.solvers.paper1.collocation.history import Adhesive, History, cut
from reference_data.solvers.paper1.collocation.states import Resolution, at_rim, volume
from reference_data.solvers.paper1.membrane import Disk


@dataclass(frozen=True)
class Stuck:
    """A zone with frozen radius; radius, its first and second derivative at the Gauss points."""

    disk: Disk
    mesh: Mesh
    frozen: tuple[Array, Array, Array]

    def rates(self, y: list[Any], x: Any, p: Any) -> list[Any]:
        """Right-hand sides of (eta, th)."""
        eta, th = y
        rho, q, bend = self.frozen
        a, l2, c, s = self.disk.alpha, rho / x, np.cos(th), np.sin(th)
        l1 = q / c
        w1, w11 = mat.slope(l1, l2, a), mat.curvature(l1, l2, a)
        load = (p - self.disk.k * (eta - self.disk.l)) * rho * q
        given = (w1 + x * w11 * bend / c + mat.mixed(l1, l2, a) * (q - l2)) * s
        return [-q * s / c, (load - given) / (x * (w1 * c + w11 * q * (s / c) ** 2))]


def frozen(history: History, mesh: Mesh, fronts: Array) -> tuple[Array, Array, Array]:
    """Radius and its derivatives at the Gauss points of [0, front]."""
    x = spread(0 * fronts, fronts, mesh.gauss)[0]
    bend = differentiation(history.fronts) @ history.g
    return x * history.radius(x), history.series(history.g, x), history.series(bend, x)


def glued(disk: Disk, how: Resolution, history: History, fronts: Array, guess: Batch) -> Batch:
    """The two-zone problems with their fronts at given places."""
    rho = fronts * history.radius(fronts)
    zones = (Stuck(disk, how.inner, frozen(history, how.inner, fronts)), Sliding(disk, how.outer))
    slope = history.series(history.g, fronts)

    def conditions(left: Any, right: Any, scalars: Any) -> list[Any]:
        (eta, th), (rho_o, eta_o, l1_o, th_o) = right[0], left[1]
        inner = mat.slope(slope / np.cos(th), rho / fronts, disk.alpha) * np.sin(th)
        force = inner - mat.slope(l1_o, rho_o / fronts, disk.alpha) * np.sin(th_o)
        # by x*, the size of the angles at a small front
        join = [rho_o - rho, eta - disk.l, eta_o - disk.l, force / fronts]
        return [left[0][1], *join, *at_rim(right[1])]

    ends = lambda _: [(0 * fronts, fronts), (fronts, disk.length)]  # noqa: E731
    return replace(guess, zones=zones, ends=ends, conditions=conditions)


@dataclass
class Radial(Adhesive):
    """Adhesive inflation of model N."""

    def __post_init__(self) -> None:
        (lam, c), flat = self.pole, np.ones(self.how.terms)
        self.history = History(self.disk, self.reach, lam * flat, 0 * flat)
        fronts = self.history.fronts
        sliding = cut(self.onset, 0, self.disk, self.how, fronts)
        x = spread(0 * fronts, fronts, self.how.inner.x)[0]
        inner = np.stack([self.disk.l + 0 * x, c * x], axis=-1)
        self.states = replace(sliding, y=(inner, *sliding.y))
        self.settle(lam * flat)

    def problem(self, fronts: Array, guess: Batch) -> Batch:
        """The two-zone problems whose fronts are at given places."""
        return glued(self.disk, self.how, self.history, fronts, guess)


def enclosed(batch: Batch) -> Array:
    """Volume per 2 pi."""
    rho, q, _ = batch.zones[0].frozen
    patch = integral(batch, 0, lambda y, _: rho * rho * q * np.tan(y[1]) / 2)
    return patch + volume(batch, 1)
