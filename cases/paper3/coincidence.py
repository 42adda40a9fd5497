"""Paper 3: the pre-stretches at which the order of first bifurcation and limit point changes.

The paper remarks that for larger and for very low pre-stretch the limit point does not come first. Where the
order changes, one state is both; it is solved for with the pre-stretch as an additional unknown.
"""

from weakforms import Case, Points, fluid_tube_coincidence

ASKED = {"delta": 1e-9, "zw": 5e-10, "V": 1e-9, "r_mid": 1e-9}
RANGES = {8: (3, 5), 24: (1.1, 1.5)}

CASE = Case(
    title="Where limit point and bifurcation coincide",
    source="Patil, Nordmark & Eriksson (2015), section 10.1",
    checks=tuple(
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
)
