"""Paper 1's own way through adhesive contact on a fixed mesh, and the limit it tends to.

The pole is raised by equal steps, and the ring that touched within a step is frozen at its end: of first
order in the step. At t0 = 0.57 a step of 0.01 gives a pressure 2.6 % too high.
"""

import numpy as np

from weakforms import At, Case, Claim, Finding, Solutions, circular, circular_scheme

STEPS = (8, 16, 32, 64)
RUNS = [circular_scheme(t_end=0.58).on(steps=n, cells=50 * n) for n in STEPS]
LIMIT, END = circular(contact="adhesive", p_end=4.0), At("t0", 0.58)
LEAST_ORDER = 0.75
"""First order, less a quarter: the front lies within a cell."""


def tends_to_limit(solutions: Solutions) -> Finding:
    """Errors against the front-fitted solution: their mean rate, and their bounds on the finest meshes."""
    good, rows = True, []
    for name in ("p", "rho_contact"):
        exact = solutions.value(LIMIT, END, name)
        found = [solutions.result(spec).quantities[name] for spec in RUNS]
        errors = np.array([q.value - exact for q in found])
        order = -np.polyfit(np.log(STEPS), np.log(np.abs(errors)), 1)[0]
        good &= order > LEAST_ORDER and all(
            abs(e) <= 2 * q.uncertainty for e, q in zip(errors[-2:], found[-2:], strict=True)
        )
        rows.append(
            f"{name}: order {order:.2f}, relative errors " + ", ".join(f"{e / exact:.1e}" for e in errors)
        )
    return bool(good), "; ".join(rows)


CASE = Case(
    title="Freezing scheme on a fixed mesh",
    source="the algorithm of Patil, DasGupta & Eriksson (2015), section 3",
    checks=(
        Claim(
            "tends_to_limit",
            "freezing ring after ring tends to the continuous history, with first order in the step",
            (*((spec, None) for spec in RUNS), (LIMIT, END)),
            tends_to_limit,
        ),
    ),
)
