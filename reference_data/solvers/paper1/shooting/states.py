"""Free inflation and frictionless contact by shooting from the pole (method a).

Free: unknowns (lambda0, p) at a given pole height, or (lambda0, t0) at a given pressure.
Frictionless: unknowns (lambda0, t0, x*), the spring acting on [0, x*]; residuals eta(x*) - l,
rho(1/beta) - 1 and eta(1/beta). Integration ends at the rim, not at the first point with lambda2 = beta,
which a bulging membrane reaches before the rim.

Source: Patil, DasGupta & Eriksson (2015), section 3.1.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.newton import Secants
from reference_data.solvers.paper1.membrane import Disk, toward
from reference_data.solvers.paper1.shooting.equations import Accuracy, Array, pole, shoot


@dataclass(frozen=True)
class Shot:
    """One equilibrium, started from the pole.

    Attributes:
        disk: The membrane.
        how: Accuracy.
        p: Pressure.
        t0: Pole height.
        lam: Stretch at the pole.
        front: x*; 0 without contact.
    """

    disk: Disk
    how: Accuracy
    p: float
    t0: float
    lam: float
    front: float = 0.0

    def states(self, x: Sequence[float], totals: bool = False) -> list[Array]:
        """(rho, eta, rho', eta') and the totals at rising x >= the start of the series."""
        at, spring = self.how.start * self.disk.length, self.front > 0
        y = pole(self.disk, self.lam, self.t0, self.p, at, spring)
        if totals:
            y += [0.0, at * at / 2 * mat.energy(self.lam, self.lam, self.disk.alpha)]
        out: list[Array] = []
        if spring:
            inside = [s for s in x if s <= self.front]
            out = shoot(self.disk, self.p, True, y, [at, *inside, self.front], self.how.rtol, totals)
            y, at = out.pop(), self.front
        outside = [s for s in x if s > self.front]
        return out + shoot(self.disk, self.p, False, y, [at, *outside], self.how.rtol, totals)


def free(shot: Shot, control: str, value: float, newton: Secants) -> Shot:
    """Free state at t0 = value or p = value, from a neighbouring one."""
    disk, how = shot.disk, shot.how
    first = how.start * disk.length
    other = "p" if control == "t0" else "t0"

    def moved(z: Array) -> Shot:
        return replace(shot, **{control: value, "lam": float(z[0]), other: float(z[1])}, front=0.0)

    def miss(z: Array) -> Array:
        s = moved(z)
        start = pole(disk, s.lam, s.t0, s.p, first, False)
        end = shoot(disk, s.p, False, start, [first, disk.length], how.rtol)[-1]
        return np.array([end[0] - 1, end[1]])

    return moved(newton.solve(miss, [shot.lam, getattr(shot, other)]))


def rising(disk: Disk, how: Accuracy, heights: Array) -> list[Shot]:
    """Free states at rising pole heights (from about 0.05 up)."""
    newton = Secants()
    lam = disk.beta + 0.3 * 0.05**2
    shot = Shot(disk, how, 4 * 0.05 * mat.slope(lam, disk.beta, disk.alpha) / disk.beta, 0.05, lam)
    shot = free(shot, "t0", 0.05, newton)
    previous, out = shot, []
    for target in heights:
        while shot.t0 != target:
            step = toward(shot.t0, float(target), min(0.2 * shot.t0, 0.1))
            guess = shot
            if previous.t0 != shot.t0:
                f = (step - shot.t0) / (shot.t0 - previous.t0)
                guess = replace(
                    shot, p=shot.p + f * (shot.p - previous.p), lam=shot.lam + f * (shot.lam - previous.lam)
                )
            previous, shot = shot, free(guess, "t0", step, newton)
        out.append(shot)
    return out


def frictionless(shot: Shot, p: float, newton: Secants) -> Shot:
    """Frictionless contact at p, from a neighbouring state (front > 0)."""
    disk, how = shot.disk, shot.how
    first = how.start * disk.length

    def miss(z: Array) -> Array:
        lam, t0, front = z
        start = pole(disk, lam, t0, p, first, True)
        y = shoot(disk, p, True, start, [first, front], how.rtol)[-1]
        end = shoot(disk, p, False, y, [front, disk.length], how.rtol)[-1]
        return np.array([y[1] - disk.l, end[0] - 1, end[1]])

    lam, t0, front = newton.solve(miss, [shot.lam, shot.t0, shot.front])
    return Shot(disk, how, p, float(t0), float(lam), float(front))


def touching(onset: Shot, rise: float = 2e-3) -> Shot:
    """A guess just above first touch: the front where the free shape, lifted by rise, meets l."""
    c = onset.p * onset.lam**2 / (2 * mat.slope(onset.lam, onset.lam, onset.disk.alpha))
    front = (2 * rise / (onset.lam * c)) ** 0.5
    return replace(onset, t0=onset.t0 + rise, front=front)


def predicted(old: Shot, now: Shot, p: float) -> Shot:
    """Guess of the state at p by the straight line through two states."""
    f = (p - now.p) / (now.p - old.p) if now.p != old.p else 0.0
    ahead = {c: getattr(now, c) + f * (getattr(now, c) - getattr(old, c)) for c in ("lam", "t0", "front")}
    return replace(now, **ahead)


def walk(onset: Shot, pressures: Array) -> list[Shot]:
    """Frictionless states at rising pressures above first touch."""
    newton, out = Secants(), []
    shot = frictionless(touching(onset), min(float(pressures[0]), 1.02 * onset.p), newton)
    old = shot
    for p in map(float, pressures):
        while shot.p != p:
            to = toward(shot.p, p, min(0.2, 0.5 * (shot.p - onset.p)))
            old, shot = shot, frictionless(predicted(old, shot, to), to, newton)
        out.append(shot)
    return out


def seed(onset: Shot) -> tuple[float, float, float]:
    """The history next to the pole: rho_c = lam x + m x^3 and F = d x^2/2; returns (lam, m, d).

    When a small patch [0, s] has formed, the rest is the free state of the height l + d s^2/2;
    its pole stretch lam + e s^2, lambda2 = lam + e s^2 + a x^2 + B/x^2 outside and the slope
    that the front freezes, 3 m s^2 = (3 a + e) s^2 - B/s^2, give m = a + e/2.
    """
    disk, alpha, step = onset.disk, onset.disk.alpha, 1e-3
    low, high = (free(onset, "t0", onset.t0 + h, Secants()) for h in (-step, step))
    dip = onset.p * onset.lam**3 / (2 * mat.slope(onset.lam, onset.lam, alpha))
    a = pole(disk, onset.lam, onset.t0, onset.p, 1.0, False)[0] - onset.lam
    return onset.lam, a + (high.lam - low.lam) / (2 * step) * dip / 4, dip
