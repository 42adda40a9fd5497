"""Free inflation and frictionless contact by collocation (method b), and quantities of a state.

Free: one zone, unknown p (or t0). Frictionless: zones [0, x*] with the spring and [x*, 1/beta]
without, joined with all four unknowns continuous; scalars p and x*, condition eta(x*) = l.

Source: Patil, DasGupta & Eriksson (2015), equations (10)-(16).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.collocation import Mesh, Resolution
from reference_data.solvers.core.collocation import joined as continuous
from reference_data.solvers.paper1.collocation.equations import (
    Array,
    Batch,
    Sliding,
    evaluate,
    integral,
    newton,
    spread,
)
from reference_data.solvers.paper1.membrane import Disk, toward

RESOLUTIONS = (
    Resolution(Mesh.graded(8, 12), Mesh.graded(4, 10), Mesh.graded(9, 10), 22),
    Resolution(Mesh.graded(10, 14), Mesh.graded(5, 12), Mesh.graded(11, 12), 28),
)


ABOVE = 1.02  # the first frictionless state is computed at this multiple of the pressure of first touch


def at_rim(right: list[Any]) -> list[Any]:
    """Conditions rho = 1 and eta = 0."""
    return [right[0] - 1, right[1]]


def free_batch(disk: Disk, mesh: Mesh, heights: Array) -> Batch:
    """Guess of free states at small pole heights: a shallow cap."""
    x, t0 = mesh.x * disk.length, np.asarray(heights, dtype=float)[:, None, None]
    b = disk.beta
    lam = b + 0.3 * t0**2
    eta, slope = t0 * (1 - (b * x) ** 2), -2 * t0 * b * b * x
    rho, l1 = b * x + 0 * t0, np.sqrt(lam**2 + slope**2)
    y = np.stack([rho, eta, l1, -slope / b], axis=-1)
    p = 4 * t0[:, 0, 0] * mat.slope(lam[:, 0, 0], b, disk.alpha) / b
    return controlled(Batch((Sliding(disk, mesh),), (y,), p[:, None], None, None), "t0", heights)


def controlled(batch: Batch, control: str, values: Array) -> Batch:
    """The free problem with t0 or p given."""
    length = batch.zones[0].disk.length

    def conditions(left: Any, right: Any, scalars: Any) -> list[Any]:
        held = left[0][1] if control == "t0" else scalars[0]
        return [left[0][0], left[0][3], *at_rim(right[0]), held - values]

    return replace(batch, ends=lambda _: [(0.0, length)], conditions=conditions)


def one(batch: Batch, state: int) -> Batch:
    """One state of a batch, as values only."""
    pick = slice(state, state + 1) if state != -1 else slice(-1, None)
    return replace(batch, y=tuple(y[pick] for y in batch.y), scalars=batch.scalars[pick])


def joined(batches: list[Batch]) -> Batch:
    """States of several batches of one kind as one batch, as values only."""
    zones = range(len(batches[0].zones))
    y = tuple(np.concatenate([b.y[d] for b in batches]) for d in zones)
    return replace(batches[0], y=y, scalars=np.concatenate([b.scalars for b in batches]))


def extrapolated(old: Batch, now: Batch, f: float) -> Batch:
    """States now + f (now - old)."""
    y = tuple(b + f * (b - a) for a, b in zip(old.y, now.y, strict=True))
    return replace(now, y=y, scalars=now.scalars + f * (now.scalars - old.scalars))


def continued(
    start: Batch,
    begin: float,
    targets: Array,
    problem: Callable[[Batch, float], Batch],
    step: Callable[[float], float],
) -> list[Batch]:
    """States at monotone values of a control, reached from ``start`` by steps of limited size."""
    old, now, at, before, out = start, start, begin, begin, []
    for target in map(float, targets):
        while at != target:
            to = toward(at, target, step(at))
            far = abs(at - before) > 0.01 * abs(to - at)  # otherwise the difference of the two is rounding
            guess = extrapolated(old, now, (to - at) / (at - before)) if far else now
            old, now, before, at = now, newton(problem(guess, to)), at, to
        out.append(now)
    return out


def rising(disk: Disk, mesh: Mesh, heights: Array) -> list[Batch]:
    """Free states at rising pole heights from 0.05 up."""
    first = newton(free_batch(disk, mesh, np.array([0.05])))
    return continued(
        first,
        0.05,
        heights,
        lambda guess, t0: controlled(guess, "t0", np.array([t0])),
        lambda t0: min(0.2 * t0, 0.1),
    )


def sliding_contact(disk: Disk, how: Resolution, onset: Batch, rise: float = 2e-3) -> Batch:
    """Guess just above first touch: the free shape lifted by ``rise``, cut where it meets l."""
    lam, p = onset.y[0][:, 0, 0, 2], onset.p
    c = p * lam**2 / (2 * mat.slope(lam, lam, disk.alpha))
    front = np.sqrt(2 * rise / (lam * c))
    y = []
    for mesh, left, right in ((how.inner, 0 * front, front), (how.outer, front, disk.length)):
        x = spread(left, right, mesh.x)[0]
        y.append(evaluate(onset, 0, 0, x.ravel()).reshape(*x.shape, 4))
    zones = (Sliding(disk, how.inner, True), Sliding(disk, how.outer))
    return Batch(zones, tuple(y), np.stack([p, front], axis=-1), None, None)


def frictionless_at(batch: Batch, p: Any) -> Batch:
    """The frictionless problem at given pressures."""
    disk = batch.zones[0].disk

    def conditions(left: Any, right: Any, scalars: Any) -> list[Any]:
        pole = [left[0][0], left[0][3]]
        return [*pole, *continuous(left, right), left[1][1] - disk.l, *at_rim(right[1]), scalars[0] - p]

    return replace(batch, ends=lambda s: [(0.0, s[1]), (s[1], disk.length)], conditions=conditions)


def frictionless(disk: Disk, how: Resolution, onset: Batch, pressures: Array) -> list[Batch]:
    """Frictionless states at rising pressures above first touch."""
    touch = float(onset.p[0])
    first = min(float(pressures[0]), ABOVE * touch)
    begin = newton(frictionless_at(sliding_contact(disk, how, onset), np.array([first])))
    return continued(
        begin,
        first,
        pressures,
        lambda guess, p: frictionless_at(guess, np.array([p])),
        lambda p: min(0.2, 0.5 * (p - touch)),  # the front grows like the square root of p - touch
    )


def volume(batch: Batch, d: int) -> Array:
    """-int rho^2 eta'/2 dx over a sliding zone."""
    return integral(batch, d, lambda y, _: y[0] ** 2 * y[2] * np.sin(y[3]) / 2)


def strain_energy(batch: Batch, d: int) -> Array:
    """Int x W dx over a sliding zone."""
    alpha = batch.zones[d].disk.alpha
    return integral(batch, d, lambda y, x: x * mat.energy(y[2], y[0] / x, alpha))
