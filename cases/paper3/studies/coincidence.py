"""Paper 3: the pre-stretches at which the order of first bifurcation and limit point changes.

The paper remarks that for larger and for very low pre-stretch the limit point does not come first. Where the
order changes, one state is both; it is solved for with the pre-stretch as an additional unknown.
"""

from weakforms.cases import (
    Case,
    Claim,
    Finding,
    Points,
    Solutions,
    decide,
    fluid_tube,
    fluid_tube_coincidence,
    reference,
)

ASKED = {"delta": 1e-9, "zw": 5e-10, "V": 1e-9, "r_mid": 1e-9}
RANGES = {8: (3, 5), 24: (1.1, 1.5)}
BOTH = {
    L: fluid_tube_coincidence(L=L, gamma=0.116, delta_low=a, delta_high=b) for L, (a, b) in RANGES.items()
}
TABLE = reference(3, "coincidence")
TUBES = {
    L: fluid_tube(L=L, gamma=0.116, delta=float(TABLE.columns["delta"][TABLE.columns["L"] == L][0]))
    for L in BOTH
}
SAME = "zw", "V", "Pi", "r_mid", "r_max"
OTHERS = "Lambda_n2", "Lambda_n3", "Lambda_torsion", "LambdaV_n0"


def state_of_a_branch(solutions: Solutions) -> Finding:
    """Numbers and eigenvalues of the state, and of the limit point of a branch at its pre-stretch."""
    return decide.all_of(
        decide.agree(
            f"L = {length}: {name}",
            solutions.whole(spec, name),
            solutions.point(TUBES[length], "limit_point", name),
            1e-8,
        )
        for length, spec in BOTH.items()
        for name in (*SAME, *OTHERS)
    )


CASE = Case(
    title="Where limit point and bifurcation coincide",
    source="Patil, Nordmark & Eriksson (2015), section 10.1",
    checks=(
        *(
            Points(
                "quantity",
                "coincidence",
                fluid_tube_coincidence(gamma=0.116, delta_low=low, delta_high=high),
                ("L",),
                ASKED,
                where={"L": float(length)},
            )
            for length, (low, high) in RANGES.items()
        ),
        Claim(
            "state_of_a_branch",
            "the state is the limit point of the branch traced at its pre-stretch, with the same eigenvalues",
            tuple((spec, None) for spec in (*BOTH.values(), *TUBES.values())),
            state_of_a_branch,
        ),
    ),
)
