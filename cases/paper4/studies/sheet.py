"""Paper 4 by a form without symmetry: a quarter of the membrane as a sheet, relaxed energy from C.

There are a few elements of degree 4 around. Along the meridian, the mesh has nodes at the fronts of the
axisymmetric solution. With many elements around, the state would be unstable to waves (Paper 5).
"""

from weakforms.cases import At, Case, Claim, Finding, Solutions, decide, wrinkled_sheet, wrinkled_tube

STATES = (
    ({"M": 0.5}, At("zw", 4.5)),
    ({"M": 1.5}, At("zw", 7.44)),
    ({"M": 0.5, "load": "gas"}, At("p", 0.2)),
)


def agrees(solutions: Solutions) -> Finding:
    """Volume and potential of sheet and surface of revolution."""
    return decide.all_of(
        decide.agree(
            f"{name} at {at}",
            solutions.whole(wrinkled_sheet(**given, at_load=at.value), name),
            solutions.number(wrinkled_tube(**given, delta=2), at, name),
            5e-6,
        )
        for given, at in STATES
        for name in ("V", "Pi")
    )


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
