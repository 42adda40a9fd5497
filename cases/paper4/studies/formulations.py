"""Paper 4: relaxed energy and modified deformation gradient give the same fields; its difference scheme.

This can also be compared with the model "Wrinkling of Cylindrical Membranes with Varying Thickness"
of the COMSOL application library (M = 0.5, stretching, then water): it compares the same two treatments
with this paper and reports that their wrinkled regions agree. Its numbers could not be obtained.
"""

import numpy as np

from weakforms.cases import At, Case, Claim, Finding, Solutions, decide, reference, wrinkled_tube

GRID = tuple(np.linspace(0.0, 8.0, 81))
STATES = {
    "M = 0.5, fluid": ({"M": 0.5, "delta": 2}, At("zw", 7.44, profile=GRID)),
    "M = 1.5, fluid": ({"M": 1.5, "delta": 2}, At("zw", 7.44, profile=GRID)),
    "M = 0.5, gas": ({"M": 0.5, "delta": 2, "load": "gas"}, At("p", 0.2, profile=GRID)),
    "M = 0.5, delta = 3, fluid": ({"M": 0.5, "delta": 3}, At("zw", 7.44, profile=GRID)),
    "M = 1.5, delta = 3, fluid": ({"M": 1.5, "delta": 3}, At("zw", 7.44, profile=GRID)),
    "M = 0.5, delta = 3, gas": ({"M": 0.5, "delta": 3, "load": "gas"}, At("p", 0.2, profile=GRID)),
    "M = 0.99, fluid": ({"M": 0.99, "delta": 2}, At("zw", 4.5, profile=GRID)),
    "Af = 0.4, fluid": ({"M": 0.5, "delta": 2, "Af": 0.4}, At("zw", 12.0, profile=GRID)),
    "case 2, gas": ({"M": 0.5, "delta": 2, "load": "gas", "Af": 1}, At("p", 0.002, profile=GRID)),
    "case 2, fluid": ({"M": 0.5, "delta": 2, "Af": 1}, At("zw", 2.0, profile=GRID)),
}
"""A state of each wrinkled figure: 2 to 8 and 10."""
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
            decide.agree(f"{name}: {column}", *(solutions.number(s, at, column) for s in specs), 1e-7)
            for column in fronts[0]
        ]
    return decide.all_of(found)


def difference_scheme(solutions: Solutions) -> Finding:
    """Errors of the paper's central differences, which do not follow the fronts, over the intervals."""
    found = []
    for load in ("gas", "fluid"):
        table = reference(4, f"fd_scheme_{load}")
        n = table.columns["n"]
        found += [
            decide.mean_order(f"{load}: {name}", n, table.number(f"error_{name}"), expected)
            for name, expected in (("r", 2), ("z", 2), ("gw", 2), ("front", 1))
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
        Claim(
            "difference_scheme",
            "the paper's difference scheme on a uniform grid, which does not follow the fronts, is of second "
            "order in the fields and of first order in the fronts",
            (),
            difference_scheme,
        ),
    ),
)
