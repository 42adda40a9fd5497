"""Columns and profiles of a state found by shooting (method a).

A row is a dictionary of the columns of a branch, a profile one of arrays over X = beta x.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.paper1.membrane import Disk
from reference_data.solvers.paper1.shooting.equations import Array, second, shoot
from reference_data.solvers.paper1.shooting.history import Edge, Inflation
from reference_data.solvers.paper1.shooting.radial import Front, Radial
from reference_data.solvers.paper1.shooting.states import Shot

TOLERANCE = 1e-4  # of lambda1 = lambda2, as in the paper


def rim_stretch(y: Array) -> float:
    """lambda1 from a state vector."""
    return float(np.hypot(y[2], y[3]))


def equal_until(shot: Shot) -> float:
    """X_iso, the first X where |lambda1 - lambda2| reaches the tolerance.

    Raises:
        ValueError: If there is none.
    """
    disk, start = shot.disk, shot.how.start * shot.disk.length
    x = np.linspace(0, disk.length, 201)[1:]
    states = shot.states(x)

    def gap(at: float, y: Array) -> float:
        return abs(rim_stretch(y) - y[0] / at) - TOLERANCE

    over = [i for i, (at, y) in enumerate(zip(x, states, strict=True)) if gap(at, y) > 0]
    if not over:
        raise ValueError(f"lambda1 = lambda2 within {TOLERANCE} everywhere: {disk}, p = {shot.p:g}")
    low, high = (x[over[0] - 1] if over[0] else start), x[over[0]]
    values = [gap(at, shot.states([at])[-1]) for at in (low, high)]
    for _ in range(60):  # regula falsi (Illinois)
        new = (low * values[1] - high * values[0]) / (values[1] - values[0])
        value = gap(new, shot.states([new])[-1])
        if value * values[1] < 0:
            low, values[0] = high, values[1]
        else:
            values[0] /= 2
        step, high, values[1] = abs(new - high), new, value
        if step < 1e-13 or abs(value) < 1e-15:
            break
    return disk.beta * high


def shot_row(shot: Shot, iso: bool = False) -> dict[str, float]:
    """A state of free inflation or frictionless contact."""
    disk = shot.disk
    end = shot.states([disk.length], totals=True)[-1]
    row = {"p": shot.p, "t0": shot.t0, "lam_pole": shot.lam, "lam1_rim": rim_stretch(end), "V": float(end[4])}
    if iso:
        row["X_iso"] = equal_until(shot)
    if shot.front:
        edge = shot.states([shot.front])[-1]
        row |= {"X_contact": disk.beta * shot.front, "rho_contact": float(edge[0])}
        row |= {"lam1_contact": rim_stretch(edge), "lam1_contact_outer": rim_stretch(edge)}
        row |= {"sigma_pole": -disk.k * (shot.t0 - disk.l), "sigma_contact": -disk.k * (edge[1] - disk.l)}
    return row


def edge_row(edge: Edge, lam: float) -> dict[str, float]:
    """A state with a locked patch; ``lam`` is the stretch of its pole."""
    disk, patch = edge.disk, edge.patch
    end = edge.outside([disk.length], totals=True)[-1]
    bend, drop = second(patch.x, patch.rho, edge.height, edge.slope, -edge.dip, edge.p, disk.alpha)
    outer = float(np.hypot(edge.slope, edge.dip))
    return {
        "p": edge.p,
        "t0": edge.t0,
        "lam_pole": lam,
        "lam1_rim": rim_stretch(end),
        "V": patch.moment + float(end[4]),
        "X_contact": disk.beta * patch.x,
        "rho_contact": patch.rho,
        "lam1_contact": float(np.hypot(patch.slope, patch.dip)),
        "lam1_contact_outer": outer,
        "sigma_pole": -disk.k * (edge.t0 - disk.l),
        "sigma_contact": -disk.k * (edge.height - disk.l),
        "curvature": (-edge.dip * bend - edge.slope * drop) / outer**3,
    }


def front_row(run: Radial, front: Front) -> dict[str, float]:
    """A state of model N."""
    disk, outer = run.disk, float(np.hypot(front.slope, front.dip))
    start = [front.rho, disk.l, front.slope, -front.dip]
    end = shoot(disk, front.p, False, start, [front.x, disk.length], run.how.rtol)[-1]
    return {
        "p": front.p,
        "t0": front.t0,
        "lam_pole": run.onset.lam,
        "lam1_rim": rim_stretch(end),
        "V": run.volume(front),
        "X_contact": disk.beta * front.x,
        "rho_contact": front.rho,
        "lam1_contact": outer,
        "lam1_contact_outer": outer,
        "sigma_pole": -disk.k * (front.t0 - disk.l),
        "sigma_contact": 0.0,
    }


def _columns(disk: Disk, x: Array, raw: Array, sigma: Callable[[Array, Array], Array]) -> dict[str, Array]:
    """Profile from rows (rho, eta, lam1, lam2)."""
    rho, eta, lam1, lam2 = raw.T
    t1, t2 = mat.resultants(lam1, lam2, disk.alpha)
    out = {"rho": rho, "eta": eta, "lam1": lam1, "lam2": lam2, "t1": t1, "t2": t2}
    return out | {"sigma": sigma(x, eta)}


def shot_profile(shot: Shot, X: Array) -> dict[str, Array]:
    """Profile of a free or frictionless state at X."""
    disk, x = shot.disk, np.asarray(X) / shot.disk.beta
    states = shot.states(x[x > 0])
    raw = [(y[0], y[1], rim_stretch(y), y[0] / at) for at, y in zip(x[x > 0], states, strict=True)]
    raw = [(0.0, shot.t0, shot.lam, shot.lam)] * int(np.sum(x == 0)) + raw
    press = lambda x, eta: np.where(x < shot.front, -disk.k * (eta - disk.l), 0.0)  # noqa: E731
    return _columns(disk, x, np.array(raw), press)


def edge_profile(run: Inflation, edge: Edge, X: Array) -> dict[str, Array]:
    """Profile of a state with a locked patch at X."""
    disk, x, raw = run.disk, np.asarray(X) / run.disk.beta, []
    for at in x[x < edge.patch.x]:
        if at < run.how.first:
            if at > 0:
                raise ValueError(f"x = {at:g} is inside the first front")
            raw.append((0.0, edge.t0, run.onset.lam, run.onset.lam))
            continue
        patch = run.frozen(float(at))
        lam1 = float(np.hypot(patch.slope, patch.dip))
        raw.append((patch.rho, edge.t0 - patch.depth, lam1, patch.rho / at))
    outside = x[x > edge.patch.x]
    for at, y in zip(outside, edge.outside(outside), strict=True):
        raw.append((y[0], y[1], rim_stretch(y), y[0] / at))
    press = lambda x, eta: np.where(x < edge.patch.x, -disk.k * (eta - disk.l), 0.0)  # noqa: E731
    return _columns(disk, x, np.array(raw), press)
