"""Columns and profiles of states found by collocation (method b).

Rows are a dictionary of the columns of a branch, each an array over the states of a batch; a
profile is one of arrays over X = beta x.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.optimize import brentq

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.paper1.collocation.equations import Array, Batch, evaluate
from reference_data.solvers.paper1.collocation.history import History
from reference_data.solvers.paper1.collocation.radial import enclosed
from reference_data.solvers.paper1.collocation.states import volume
from reference_data.solvers.paper1.membrane import Disk, Patch

TOLERANCE = 1e-4  # of lambda1 = lambda2, as in the paper


def equal_until(batch: Batch, state: int) -> float:
    """X_iso of a free or frictionless state.

    Raises:
        ValueError: If lambda1 = lambda2 within the tolerance everywhere.
    """
    disk = batch.zones[0].disk

    def gap(x: Any) -> Array:
        x = np.atleast_1d(x)
        out = np.empty(x.shape)
        for d in range(len(batch.zones)):
            left, right = (float(e[state]) for e in batch.edges(d))
            here = (x > left) & (x <= right)
            y = evaluate(batch, d, state, x[here])
            out[here] = np.abs(y[:, 2] - y[:, 0] / x[here]) - TOLERANCE
        return out

    x = np.linspace(0, disk.length, 1001)[1:]
    over = np.nonzero(gap(x) > 0)[0]
    if not len(over):
        raise ValueError(f"lambda1 = lambda2 within {TOLERANCE} everywhere: {disk}")
    low = x[over[0] - 1] if over[0] else x[0] / 100
    return disk.beta * brentq(lambda s: float(gap(s)[0]), low, x[over[0]], xtol=1e-15, rtol=1e-14)


def sliding_rows(batch: Batch, iso: bool = False) -> dict[str, Array]:
    """Free or frictionless states."""
    disk, pole, rim = batch.zones[0].disk, batch.y[0][:, 0, 0], batch.y[-1][:, -1, -1]
    rows = {
        "p": batch.p,
        "t0": pole[:, 1],
        "lam_pole": pole[:, 2],
        "lam1_rim": rim[:, 2],
        "V": sum(volume(batch, d) for d in range(len(batch.zones))),
    }
    if iso:
        rows["X_iso"] = np.array([equal_until(batch, i) for i in range(len(batch.p))])
    if len(batch.zones) > 1:
        edge = batch.y[1][:, 0, 0]
        rows |= {"X_contact": disk.beta * batch.scalars[:, 1], "rho_contact": edge[:, 0]}
        rows |= {"lam1_contact": edge[:, 2], "lam1_contact_outer": edge[:, 2]}
        rows |= {"sigma_pole": -disk.k * (pole[:, 1] - disk.l), "sigma_contact": 0 * batch.p}
    return rows


def patch_rows(batch: Batch, patch: Patch, lam: float) -> dict[str, Array]:
    """States with locked patches; ``lam`` is the stretch of the pole."""
    disk = batch.zones[0].disk
    rho, eta, l1, th = batch.y[0][:, 0, 0].T
    l2 = rho / patch.x
    w1, w2 = mat.slope(l1, l2, disk.alpha), mat.slope(l2, l1, disk.alpha)
    return {
        "p": batch.p,
        "t0": eta + patch.depth,
        "lam_pole": lam + 0 * rho,
        "lam1_rim": batch.y[0][:, -1, -1, 2],
        "V": patch.moment + volume(batch, 0),
        "X_contact": disk.beta * patch.x + 0 * rho,
        "rho_contact": rho,
        "lam1_contact": np.hypot(patch.slope, patch.dip) + 0 * rho,
        "lam1_contact_outer": l1,
        "sigma_pole": -disk.k * (eta + patch.depth - disk.l),
        "sigma_contact": -disk.k * (eta - disk.l),
        "curvature": (batch.p * rho * l1 - w2 * np.sin(th)) / (patch.x * w1 * l1),
    }


def radial_rows(batch: Batch, lam: float) -> dict[str, Array]:
    """States of model N."""
    disk, t0 = batch.zones[0].disk, batch.y[0][:, 0, 0, 0]
    rho, _, l1, _ = batch.y[1][:, 0, 0].T
    return {
        "p": batch.p,
        "t0": t0,
        "lam_pole": lam + 0 * rho,
        "lam1_rim": batch.y[1][:, -1, -1, 2],
        "V": enclosed(batch),
        "X_contact": disk.beta * batch.edges(1)[0],
        "rho_contact": rho,
        "lam1_contact": l1,
        "lam1_contact_outer": l1,
        "sigma_pole": -disk.k * (t0 - disk.l),
        "sigma_contact": 0 * rho,
    }


def _columns(disk: Disk, raw: Array, touched: Array) -> dict[str, Array]:
    """Profile from rows (rho, eta, lam1, lam2)."""
    rho, eta, lam1, lam2 = raw.T
    t1, t2 = mat.resultants(lam1, lam2, disk.alpha)
    sigma = np.where(touched, -disk.k * (eta - disk.l), 0.0)
    return {"rho": rho, "eta": eta, "lam1": lam1, "lam2": lam2, "t1": t1, "t2": t2, "sigma": sigma}


def _sliding(batch: Batch, d: int, x: Array) -> Array:
    y = evaluate(batch, d, 0, x)
    l2 = np.where(x > 0, y[:, 0] / np.where(x > 0, x, 1.0), y[:, 2])
    return np.stack([y[:, 0], y[:, 1], y[:, 2], l2], axis=-1)


def sliding_profile(batch: Batch, X: Array) -> dict[str, Array]:
    """Profile of one free or frictionless state at X."""
    disk, x = batch.zones[0].disk, np.asarray(X) / batch.zones[0].disk.beta
    front = float(batch.scalars[0, 1]) if len(batch.zones) > 1 else -1.0
    parts = [_sliding(batch, 0, x[x <= front])] if front > 0 else []
    parts.append(_sliding(batch, len(batch.zones) - 1, x[x > front]))
    return _columns(disk, np.concatenate(parts), x < front)


def patch_profile(batch: Batch, history: History, front: float, X: Array) -> dict[str, Array]:
    """Profile of one state with a locked patch [0, front] at X."""
    disk, x = history.disk, np.asarray(X) / history.disk.beta
    inside = x[x < front]
    height = float(batch.y[0][0, 0, 0, 1]) + float(history.patch(np.array([front])).depth[0])
    radius, dip = history.radius(inside), inside * history.series(history.h, inside)
    lam1 = np.hypot(history.series(history.g, inside), dip)
    eta = height - inside**2 * history.depth(inside)
    locked = np.stack([inside * radius, eta, lam1, radius], axis=-1)
    return _columns(disk, np.concatenate([locked, _sliding(batch, 0, x[x > front])]), x < front)
