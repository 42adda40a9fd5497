"""Energy release rates at fixed pressure over the contact radius, by both methods, and their minimum.

At each front position the inflation state is brought to the pressure with its patch locked; the
rate is then the closed form of ``disk_release``. The minimum over the radius is the pull-off point.

Source: Patil, DasGupta & Eriksson (2015), section 4 and equation for G.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq

from reference_data.solvers.core.newton import Secants
from reference_data.solvers.paper1 import cases as dc
from reference_data.solvers.paper1 import release
from reference_data.solvers.paper1.cases import Case
from reference_data.solvers.paper1.collocation import history as ch
from reference_data.solvers.paper1.collocation.equations import Array, Batch
from reference_data.solvers.paper1.membrane import Patch, toward
from reference_data.solvers.paper1.shooting import history as sh

Rates = Callable[[Array], Array]
STENCIL = ((-2, 1 / 12), (-1, -2 / 3), (1, 2 / 3), (2, -1 / 12))
RELATIVE = 0.004  # step of the difference quotient over x*
STEP = 0.4  # of p


def fronts_a(case: Case, radii: Array, i: int) -> Array:
    """Front positions of given contact radii by shooting."""
    run = dc.inflation_a(case, i)
    ends = run.how.first, case.reach / case.disk.beta
    return np.array([brentq(lambda x: run.path.sol(x)[0] - r, *ends, xtol=1e-15, rtol=1e-14) for r in radii])  # noqa: B023


def fronts_b(case: Case, radii: Array, i: int) -> Array:
    """The same by collocation (Newton on the frozen radius)."""
    history = dc.inflation_b(case, i).history
    x = radii / history.g[0]
    for _ in range(12):
        x = np.minimum(x - (x * history.radius(x) - radii) / history.series(history.g, x), history.reach)
    return x


def state_a(case: Case, p: float, x: float, i: int) -> sh.Edge:
    """The locked patch [0, x] at pressure p by shooting."""
    edge, newton = dc.inflation_a(case, i).at(x), Secants()
    while edge.p != p:
        edge = sh.deflated(edge, toward(edge.p, p, STEP), newton)
    return edge


def states_b(case: Case, p: float, x: Array, i: int) -> tuple[Patch, Batch]:
    """Locked patches [0, x] at pressure p by collocation, side by side."""
    run = dc.inflation_b(case, i)
    patch, batch = run.history.patch(x), run.at(x)
    first = batch.p
    count = int(np.ceil(np.max(np.abs(first - p)) / STEP)) + 1
    for f in np.arange(1, count + 1) / count:
        batch = ch.deflated(case.disk, run.how, patch, batch, first + f * (p - first))
    return patch, batch


def widest(case: Case) -> float:
    """Largest contact radius of the history, with a margin for the difference quotient."""
    x = np.array([case.reach / case.disk.beta / (1 + 3 * RELATIVE)])
    return float(dc.inflation_b(case, 1).history.patch(x).rho[0])


def rates_a(case: Case, p: float, i: int) -> Rates:
    """G as a function of the contact radius by shooting."""

    def call(radii: Array) -> Array:
        edges = [state_a(case, p, float(x), i) for x in fronts_a(case, radii, i)]
        return np.array([release.rate(case.disk, e.patch, e.height, e.slope, e.dip) for e in edges])

    return call


def rates_b(case: Case, p: float, i: int) -> Rates:
    """The same by collocation."""

    def call(radii: Array) -> Array:
        patch, batch = states_b(case, p, fronts_b(case, radii, i), i)
        _, eta, l1, th = batch.y[0][:, 0, 0].T
        return release.rate(case.disk, patch, eta, l1 * np.cos(th), l1 * np.sin(th))

    return call


def quotient(case: Case, p: float, x: Array, i: int) -> Array:
    """(dPi/dx*)_p/(2 pi rho* lambda_1c) by a five-point difference of the potential."""
    total = 0 * x
    for place, weight in STENCIL:
        patch, batch = states_b(case, p, x * (1 + RELATIVE * place), i)
        total = total + weight * ch.potential(batch, patch)
    patch = dc.inflation_b(case, i).history.patch(x)
    return total / (RELATIVE * x * patch.rho * np.hypot(patch.slope, patch.dip))


def minimum(call: Rates, grid: Array, points: int, spread: float = 0.025) -> tuple[float, float] | None:
    """(radius, rate) of the interior minimum; None if the smallest rate of the grid is at an end.

    The minimum of the polynomial through ``points`` Chebyshev points, twice, the second time
    around the first answer.
    """
    values = call(grid)
    j = int(np.argmin(values))
    if j in (0, len(grid) - 1):
        return None
    centre = float(grid[j])
    centre = float(np.clip(centre, grid[0] + spread, grid[-1] - spread))
    for _ in range(2):
        at = centre + spread * np.cos(np.pi * (np.arange(points) + 0.5) / points)
        fit = np.polynomial.Chebyshev.fit(at, call(at), points - 1)
        roots = fit.deriv().roots()
        real = np.real(roots[np.abs(np.imag(roots)) < 1e-8])
        centre = float(real[np.argmin(np.abs(real - centre))])
    return centre, float(call(np.array([centre]))[0])
