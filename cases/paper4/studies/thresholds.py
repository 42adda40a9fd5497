"""Paper 4, section on case 2: thickness ratios beyond which the unloaded membrane wrinkles.

Printed as "M < 0.75 or M > 1.25" (delta = 2) and "M < 0.4 or M > 1.6" (delta = 3): these are values of a
grid. The thresholds are the roots of min gw = 1 in M for the taut solution, and depend on the length and on
c2.
"""

from weakforms.cases import (
    At,
    Case,
    Claim,
    Finding,
    OnGrid,
    Points,
    Printed,
    Solutions,
    decide,
    wrinkled_tube,
    wrinkled_tube_threshold,
)

STEP = "0.05"
"""Step of the grid of the text's ratios: wrinkling starts less than a step beyond them."""
ROWS = (
    (2, False, "0.75", OnGrid(STEP, upwards=False)),
    (2, True, "1.25", OnGrid(STEP, upwards=True)),
    (3, False, "0.4", None),
    (3, True, "1.6", None),
)
ON_GRID = wrinkled_tube(M=0.75, delta=2, load="gas", Af=1)
EMPTY = At("p", 0.0)


def still_taut(solutions: Solutions) -> Finding:
    """M = 0.75, delta = 2, without load: smallest gw."""
    return decide.positive("gw_min - 1", solutions.number(ON_GRID, EMPTY, "gw_min") - 1)


CASE = Case(
    title="Thickness ratios at which the unloaded membrane starts to wrinkle",
    source="Patil, Nordmark & Eriksson (2015), section on case 2",
    checks=(
        Points(
            "quantity",
            reference="thresholds",
            base=wrinkled_tube_threshold(),
            parameters=("delta", "c2", "L", "upper"),
            asked={"M": 5e-8, "Z": 1e-6},
        ),
        *(
            Printed(
                f"threshold of M {'above' if upper else 'below'} 1 for delta = {delta}",
                printed,
                of=wrinkled_tube_threshold(delta=delta, upper=upper),
                kind="quantity",
                column="M",
                source="section on case 2",
                reading=reading,
            )
            for delta, upper, printed, reading in ROWS
        ),
        Claim(
            "still_taut",
            "at the printed threshold M = 0.75, delta = 2 the membrane is still taut everywhere",
            ((ON_GRID, EMPTY),),
            still_taut,
        ),
    ),
)
