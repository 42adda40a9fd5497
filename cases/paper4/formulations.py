"""Paper 4: relaxed energy and modified deformation gradient give the same fields.

This is also what can be compared with the model "Wrinkling of Cylindrical Membranes with Varying Thickness"
of the COMSOL application library (M = 0.5, stretching, then water): it compares the same two treatments
with this paper and reports that their wrinkled regions agree. Its numbers could not be obtained.
"""

import numpy as np

from weakforms import At, Case, Claim, Finding, Solutions, wrinkled_tube

GRID = tuple(np.linspace(0.0, 8.0, 81))
STATES = {
    "M = 0.5, fluid": ({"M": 0.5, "delta": 2}, At("zw", 7.44, profile=GRID)),
    "M = 1.5, fluid": ({"M": 1.5, "delta": 2}, At("zw", 7.44, profile=GRID)),
    "M = 0.5, gas": ({"M": 0.5, "delta": 2, "load": "gas"}, At("p", 0.2, profile=GRID)),
}
ENERGIES = ({}, {"energy": "modified_gradient"})


def same_fields(solutions: Solutions) -> Finding:
    """Largest differences of profiles and fronts, against twice the combined uncertainty."""
    good, rows = True, []
    for name, (given, at) in STATES.items():
        a, b = (solutions.state(wrinkled_tube(**given, **e), at) for e in ENERGIES)
        errors, fronts = [], 0
        for column in ("r", "z", "lam1", "gw", "tension"):
            (x, u), (y, v) = (solutions.sampled(wrinkled_tube(**given, **e), at, column) for e in ENERGIES)
            error = np.abs(x - y).max()
            good &= bool(error <= 2 * np.hypot(u, v))
            errors.append(error)
        good &= set(a.quantities) == set(b.quantities)
        for column in a.quantities:
            if column.startswith("Z_front"):
                p, q = a.quantities[column], b.quantities[column]
                good &= abs(p.value - q.value) <= 2 * np.hypot(p.uncertainty, q.uncertainty)
                fronts += 1
        rows.append(f"{name}: {max(errors):.0e}, {fronts} fronts")
    return bool(good), "; ".join(rows)


CASE = Case(
    title="Two treatments of wrinkling",
    source="Patil, Nordmark & Eriksson (2015), sections 2 and 3",
    checks=(
        Claim(
            "same_fields",
            "relaxed energy and modified deformation gradient give the same fields and fronts",
            tuple((wrinkled_tube(**given, **e), at) for given, at in STATES.values() for e in ENERGIES),
            same_fields,
        ),
    ),
)
