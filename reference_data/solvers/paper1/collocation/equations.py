r"""Method (b): piecewise Chebyshev collocation of the first-order system, many states at once.

In a sliding zone the unknowns are (rho, eta, l1, th), th the angle by which the membrane falls:

.. math::
   \rho' = l_1 \cos\theta, \quad \eta' = -l_1 \sin\theta, \quad
   l_1' = \frac{W_2 \cos\theta - W_1 - W_{12} (l_1 \cos\theta - l_2)}{x W_{11}}, \quad
   \theta' = \frac{p_e\, \rho\, l_1 - W_2 \sin\theta}{x W_1},

p_e = p - k (eta - l) where the spring acts. Fronts cut [0, 1/beta] into zones. Each zone is
mapped to [0, 1], linearly if it begins at the pole, else by x = left (right/left)^s. Conditions couple the
ends of the zones, p and the fronts. States of one kind (same zones, same conditions) are solved together, in
a leading axis (see :mod:`core.collocation`). Source: Patil,
DasGupta & Eriksson (2015), equations (10)-(13) and (16).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.collocation import Array, Conditions, Mesh, Problem, Zone, components
from reference_data.solvers.paper1.membrane import Disk


@dataclass(frozen=True)
class Sliding:
    """A zone whose points move freely; ``spring``: the substrate pushes."""

    disk: Disk
    mesh: Mesh
    spring: bool = False

    def rates(self, y: list[Any], x: Any, p: Any) -> list[Any]:
        """Right-hand sides of (rho, eta, l1, th)."""
        rho, eta, l1, th = y
        a, l2 = self.disk.alpha, rho / x
        w1, w2 = mat.slope(l1, l2, a), mat.slope(l2, l1, a)
        c, s = np.cos(th), np.sin(th)
        push = p - self.disk.k * (eta - self.disk.l) if self.spring else p
        stretching = w2 * c - w1 - mat.mixed(l1, l2, a) * (l1 * c - l2)
        turning = push * rho * l1 - w2 * s
        return [l1 * c, -l1 * s, stretching / (x * mat.curvature(l1, l2, a)), turning / (x * w1)]


@dataclass(frozen=True)
class Batch:
    """Several states, converged or guesses.

    Attributes:
        zones: From the pole to the rim.
        y: Nodal values per zone, shape (state, element, node, unknown).
        scalars: p and further unknowns, shape (state, number).
        ends: The ends of the zones as a function of the scalars, each of shape (state,).
        conditions: Of (left values, right values, scalars) of the zones; lists over zones of
            lists over unknowns.
    """

    zones: tuple[Any, ...]
    y: tuple[Array, ...]
    scalars: Array
    ends: Callable[[Any], list[tuple[Any, Any]]]
    conditions: Conditions

    @property
    def p(self) -> Array:
        """Pressures."""
        return self.scalars[:, 0]

    @property
    def problem(self) -> Problem:
        """The equations of all zones, and the conditions."""
        zones = (Zone(z.mesh, partial(self.rates, d)) for d, z in enumerate(self.zones))
        return Problem(tuple(zones), self.conditions)

    def rates(self, d: int, y: list[Any], s: Array, c: list[Any]) -> list[Any]:
        """Right-hand sides over the fraction of zone d."""
        x, stretch = spread(*self.ends([v[..., 0, 0] for v in c])[d], s)
        return [stretch * f for f in self.zones[d].rates(y, x, c[0])]

    def edges(self, d: int) -> tuple[Array, Array]:
        """Left and right end of zone d."""
        left, right = self.ends(list(self.scalars.T))[d]
        return tuple(np.broadcast_to(e, self.p.shape) for e in (left, right))


def spread(left: Any, right: Any, at: Array) -> tuple[Any, Any]:
    """Position x and dx/ds at fractions ``at`` of a zone; at has shape (element, point)."""
    left, right = (np.asarray(e)[..., None, None] for e in (left, right))
    if np.all(left == 0):
        return right * at, right + 0 * at
    x = left * (right / left) ** at
    return x, x * np.log(right / left)


def fractions(left: Any, right: Any, x: Array) -> Array:
    """Inverse of :func:`spread`."""
    return x / right if left == 0 else np.log(x / left) / np.log(right / left)


def newton(batch: Batch) -> Batch:
    """Solve all states.

    Raises:
        RuntimeError: If a state does not converge.
    """
    what = f"collocation of {batch.zones[-1].disk} at {batch.scalars[0]}"
    y, c = batch.problem.solve(batch.y, batch.scalars, what, longest=0.3, most=60)
    return replace(batch, y=y, scalars=c)


def evaluate(batch: Batch, d: int, state: int, x: Array) -> Array:
    """Values of zone d of one state at positions x, shape of x, then unknowns."""
    left, right = (float(e[state]) for e in batch.edges(d))
    s = fractions(left, right, np.asarray(x, dtype=float))
    return batch.zones[d].mesh.evaluate(batch.y[d][state], s)


def integral(batch: Batch, d: int, density: Callable[[list[Any], Any], Any]) -> Array:
    """Integral over x of a density (values, x), zone d, every state."""
    mesh = batch.zones[d].mesh
    x, stretch = spread(*batch.edges(d), mesh.gauss)
    at = components(mesh.rule.value @ batch.y[d])
    return np.sum(mesh.weights * stretch * density(at, x), axis=(1, 2))
