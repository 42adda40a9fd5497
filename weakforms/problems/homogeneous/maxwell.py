r"""Two coexisting states of a long tube: equal pressure and equal potential (Maxwell's rule).

.. math:: \Pi_{,\lambda}(\lambda^{a}; p) = \Pi_{,\lambda}(\lambda^{b}; p) = 0, \qquad
          \Pi(\lambda^{a}; p) = \Pi(\lambda^{b}; p)
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from scipy.interpolate import CubicSpline

from weakforms.problems.homogeneous.body import Body, system_of
from weakforms.problems.material_choice import Chosen
from weakforms.results import Quantity
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.support.roots import root
from weakforms.solvers.uncertainty.refinement import ALGEBRAIC

NAMES = {"thin": "", "thick": "_2"}
"""The number of states, and the ending of the columns of the second one."""


def maxwell_states(body: Body, chosen: Chosen, traced: Mapping[str, np.ndarray]) -> dict[str, Quantity]:
    """The pressure and both states, solved for together; empty if the pressure does not rise twice.

    Args:
        body: The tube.
        chosen: Its law.
        traced: Columns of the branch, which give the first guess.
    """
    guess = _guess(body, traced)
    if guess is None:
        return {}
    p, stretches = guess
    system = system_of(body, chosen, copies=2)
    solver = ExtendedNewton(system, [body.load])
    begin = State(np.array(stretches), system.initial.loads | {body.load: p})
    both, _ = solver.solve(begin, [Held("Pi_difference", 0.0)])
    with system.at(both):
        values = system.monitors()
    found = {"p_maxwell": both.loads[body.load], "Pi_maxwell": values["Pi"]}
    for state, ending in NAMES.items():
        found |= {f"{name}_{state}": values[name + ending] for name in body.unknowns}
    return {name: Quantity(v, ALGEBRAIC * max(1.0, abs(v))) for name, v in found.items()}


def _guess(body: Body, traced: Mapping[str, np.ndarray]) -> tuple[float, list[float]] | None:
    """The crossing of the curve of potential over pressure, between its first and its last rising part."""
    p = traced[body.load]
    rising = np.diff(p) > 0
    ends = np.flatnonzero(np.diff(rising.astype(int)))  # turns of the pressure
    if len(ends) < 2:
        return None
    first, last = slice(0, ends[0] + 2), slice(ends[1] + 1, None)
    parts = []
    for part in (first, last):
        order = np.argsort(p[part])
        names = ("Pi", *body.unknowns)
        parts.append({n: CubicSpline(p[part][order], traced[n][part][order]) for n in names})
    low = max(p[first].min(), p[last].min())
    high = min(p[first].max(), p[last].max())

    def gap(x: float) -> float:
        return float(parts[0]["Pi"](x) - parts[1]["Pi"](x))

    if low >= high or gap(low) * gap(high) > 0:
        return None
    x = root(gap, low, high, "the pressure of equal potentials")
    return x, [float(part[n](x)) for part in parts for n in body.unknowns]
