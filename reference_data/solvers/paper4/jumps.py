"""Jumps of second derivatives at fronts, by differentiating polynomials and from the equations."""

from __future__ import annotations

import numpy as np

from reference_data.solvers.paper4.material import Array
from reference_data.solvers.paper4.methods.collocation import State
from reference_data.solvers.paper4.methods.shooting import local
from reference_data.solvers.paper4.methods.shooting_measures import Reading
from reference_data.solvers.paper4.methods.shooting_newton import Solution

NAMES = ("jump_r2", "jump_z2", "jump_lam1", "tan_phi")


def of_state(state: State) -> dict[str, Array]:
    """Upper minus lower side of r'', z'' and lam1' at each front, from the nodal polynomials."""
    l1, b = state.y[..., 2], state.y[..., 3]
    second = [state.mesh.slope(x) for x in (l1 * np.sin(b), l1 * np.cos(b), l1)]
    last = np.cumsum(state.counts)[:-1]
    at = [n for n, k in zip(last, state.pattern.kinds, strict=True) if k == "front"]
    jumps = [np.array([x[n, 0] - x[n - 1, -1] for n in at]) for x in second]
    return dict(zip(NAMES, [*jumps, np.array([np.tan(b[n, 0]) for n in at])], strict=True))


def of_shot(found: Solution) -> dict[str, Array]:
    """The same from the equilibrium equations on either side of each front met."""
    reading, rows = Reading(found), []
    for front in found.shot.fronts:
        i = int(np.argmin(np.abs(reading.s - front) + 10 * (reading.s < front)))
        s, y = reading.s[i : i + 1], reading.first[i : i + 1]
        r, a, f = y[0, 0], y[0, 2], y[0, 3]
        sine, cosine = a / np.hypot(a, f), f / np.hypot(a, f)
        slopes = []
        for tense in (reading.tense[i], not reading.tense[i]):  # upper side, lower side
            l1, g, dg = (float(x[0]) for x in local(found.membrane, s, y, np.array([tense])))
            slopes.append(2 * l1 * (dg / (g + 1) - l1 * sine / r))
        jump = slopes[0] - slopes[1]
        # the inclination's derivative holds W_2, which vanishes on either side: no jump
        rows.append([jump * sine, jump * cosine, jump, sine / cosine])
    return dict(zip(NAMES, np.array(rows).reshape(-1, 4).T, strict=True))
