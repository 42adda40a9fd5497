"""Paper 4 by a form without symmetry: a quarter of the membrane as a sheet, relaxed energy from C.

Elements of degree 4, a few around; along, the mesh ends at the fronts of the axisymmetric solution. With many
elements around the state would be unstable to waves (Paper 5).
"""

import numpy as np

from weakforms import At, Case, Claim, Finding, Solutions, wrinkled_sheet, wrinkled_tube

STATES = (
    ({"M": 0.5}, At("zw", 4.5)),
    ({"M": 1.5}, At("zw", 7.44)),
    ({"M": 0.5, "load": "gas"}, At("p", 0.2)),
)


def agrees(solutions: Solutions) -> Finding:
    """Volume and potential of sheet and surface of revolution within twice the combined uncertainty."""
    good, rows = True, []
    for given, at in STATES:
        sheet = solutions.result(wrinkled_sheet(**given, at_load=at.value)).quantities
        for name in ("V", "Pi"):
            one = solutions.quantity(wrinkled_tube(**given, delta=2), at, name)
            error = abs(sheet[name].value - one.value) / one.value
            bound = 2 * np.hypot(sheet[name].uncertainty, one.uncertainty) / one.value
            good &= error <= bound <= 1e-5
            rows.append(f"{name} at {at}: {error:.0e} <= {bound:.0e}")
    return bool(good), "; ".join(rows)


CASE = Case(
    title="The same states without axisymmetry",
    source="Patil, Nordmark & Eriksson (2015), section 2",
    checks=(
        Claim(
            "agrees",
            "the two-dimensional form on the unrolled surface gives the axisymmetric states",
            tuple(
                pair
                for given, at in STATES
                for pair in (
                    (wrinkled_sheet(**given, at_load=at.value), None),
                    (wrinkled_tube(**given, delta=2), at),
                )
            ),
            agrees,
        ),
    ),
)
