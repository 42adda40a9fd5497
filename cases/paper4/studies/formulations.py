"""Paper 4: relaxed energy and modified deformation gradient give the same fields.

This can also be compared with the model "Wrinkling of Cylindrical Membranes with Varying Thickness"
of the COMSOL application library (M = 0.5, stretching, then water): it compares the same two treatments
with this paper and reports that their wrinkled regions agree. Its numbers could not be obtained.
"""

import numpy as np

from weakforms.cases import At, Case, Claim, Finding, Solutions, decide, wrinkled_tube

GRID = tuple(np.linspace(0.0, 8.0, 81))
STATES = {
    "M = 0.5, fluid": ({"M": 0.5, "delta": 2}, At("zw", 7.44, profile=GRID)),
    "M = 1.5, fluid": ({"M": 1.5, "delta": 2}, At("zw", 7.44, profile=GRID)),
    "M = 0.5, gas": ({"M": 0.5, "delta": 2, "load": "gas"}, At("p", 0.2, profile=GRID)),
}
ENERGIES = ({}, {"energy": "modified_gradient"})


def same_fields(solutions: Solutions) -> Finding:
    """Profiles and fronts of both treatments."""
    found = []
    for name, (given, at) in STATES.items():
        specs = [wrinkled_tube(**given, **e) for e in ENERGIES]
        for column in ("r", "z", "lam1", "gw", "tension"):
            found.append(
                decide.agree(f"{name}: {column}", *(solutions.samples(s, at, column) for s in specs), 5e-9)
            )
        fronts = [
            [column for column in solutions.state(s, at).quantities if column.startswith("Z_front")]
            for s in specs
        ]
        found.append(decide.same("fronts", *fronts))
        found += [
            decide.agree(column, *(solutions.number(s, at, column) for s in specs), 5e-9)
            for column in fronts[0]
        ]
    return decide.all_of(found)


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
