r"""Fictitious time integration (FTIM) of the tube's difference equations, for the record.

The paper solves its difference equations F(x) = 0 by the method of Liu & Atluri (CMES 31
(2008) 71-83): integrate

.. math:: \dot x = \frac{\nu}{(1 + \tau)^m}\, B\, F(x)

in a fictitious time tau, here by the classical fourth-order Runge-Kutta method with the
paper's nu = 0.02 and step 0.001. F is the residual of ``tube_fd`` at fixed pressure: minus the
gradient of the energy per length, so that with B = 1 this is a descent and converges, if at
all, only to states stable under pressure control (before the first limit point).

Three variants: the method as published (B = 1, m = 1), whose slowest mode decays like (1 + tau)^(-nu
lambda_min), which is far too slow; a constant gain B = c, m = 0, c as large as the stability limit of the
scheme allows; and the frozen tangent, B = -(dF/dx)^{-1} at the first guess times 1/(nu step), m = 1, which is
equivalent to a damped chord-Newton method.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.sparse.linalg import eigs, splu

from reference_data.solvers.core.mooney_rivlin import Tube, plain_pressure
from reference_data.solvers.paper2.differences import equations as fd
from reference_data.solvers.paper2.differences.branch import pressure_condition
from reference_data.solvers.paper2.differences.equations import Array, Grid

NU, STEP = 0.02, 0.001  # the paper's data
# Runge-Kutta is stable for |lambda| step < 2.785; lambda is taken at the first guess, and the
# tangent stiffens on the way by a factor of up to 1.5 (2.5 overflows)
STABLE = 1.7


@dataclass
class Run:
    """Outcome of one integration."""

    state: Array
    residual: float
    steps: int
    evaluations: int
    seconds: float
    converged: bool


def integrate(
    f: Callable[[Array], Array],
    precondition: Callable[[Array], Array],
    x: Array,
    damping: float,
    tolerance: float,
    max_steps: int,
) -> Run:
    """Runge-Kutta integration until max |F| < tolerance or max_steps."""
    count, begin = 0, time.perf_counter()

    def rate(at: Array, tau: float) -> Array:
        nonlocal count
        count += 1
        return NU / (1 + tau) ** damping * precondition(f(at))

    for step in range(max_steps):
        tau = step * STEP
        residual = float(np.abs(f(x)).max())
        if residual < tolerance or not np.isfinite(residual):
            break
        k1 = rate(x, tau)
        k2 = rate(x + STEP / 2 * k1, tau + STEP / 2)
        k3 = rate(x + STEP / 2 * k2, tau + STEP / 2)
        k4 = rate(x + STEP * k3, tau + STEP)
        x = x + STEP / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    else:
        step, residual = max_steps, float(np.abs(f(x)).max())
    spent = time.perf_counter() - begin
    return Run(x, residual, step, count, spent, residual < tolerance)


def solve(
    tube: Tube,
    grid: Grid,
    p: float,
    variant: int,
    tolerance: float = 1e-10,
    limit: int = 200000,
    pressure: fd.Pressure = plain_pressure,
    height: float = 0.3,
) -> tuple[Run, float]:
    """State at fixed pressure by one of the three variants, and its gain c.

    Args:
        tube: The problem.
        grid: The grid.
        p: Pressure, below the first limit pressure.
        variant: 1 as published, 2 constant gain, 3 frozen tangent.
        tolerance: Stop at this residual.
        limit: Largest number of steps.
        pressure: Effective pressure P_eff(rho, p).
        height: u_max of the first guess.
    """
    start, _ = fd.first_guess(tube, grid, height)
    core = fd.jacobian(tube, grid, start, p, pressure)[:-2, :-2]
    inner = slice(0, -2)  # the disk's two conditions hold in the first guess and stay

    def f(x: Array) -> Array:
        full = fd.residual(tube, grid, np.append(x, start[-2:]), p, pressure)[inner]
        full[1] = -full[1]  # eta(0) = 0 is written as +eta_0: turn it into a descent as well
        return full

    if variant == 3:
        flip = np.ones(core.shape[0])
        flip[1] = -1
        lu, gain = splu(core), 1 / (NU * STEP)
        run = integrate(f, lambda r: -gain * lu.solve(flip * r), start[inner], 1.0, tolerance, 2000)
        return run, gain
    top = float(np.abs(eigs(core, k=1, which="LM", return_eigenvectors=False, v0=flat(core)))[0])
    gain = 1.0 if variant == 1 else STABLE / (NU * STEP * top)
    damping = 1.0 if variant == 1 else 0.0
    steps = 5000 if variant == 1 else limit
    return integrate(f, lambda r: gain * r, start[inner], damping, tolerance, steps), gain


def flat(core: Array) -> Array:
    """A fixed start vector, so that the eigenvalue and the table come out the same each time."""
    return np.linspace(1.0, 2.0, core.shape[0])


def newton_state(
    tube: Tube, grid: Grid, p: float, pressure: fd.Pressure = plain_pressure, height: float = 0.3
) -> Array:
    """The same difference equations solved by Newton's method."""
    guess, control = fd.first_guess(tube, grid, height), fd.at_control("u_max", height)
    first = fd.newton(tube, grid, guess, control, pressure)
    return fd.newton(tube, grid, first, pressure_condition(p), pressure)[0]
