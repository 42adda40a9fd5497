"""Paper 5, section 2.4: a perturbation without meridional displacement, and its limit of stability in n.

Along u = f z0', v = f, w = -f r0' the relaxed second variation is A + n B with B < 0: the membrane is
unstable for every n > n* = A/(-B), at any pressure. The true stability limit in n is smaller, because only
one shape is tried.
"""

import numpy as np

from weakforms.cases import (
    At,
    Case,
    Claim,
    Finding,
    Points,
    Solutions,
    decide,
    reference,
    wrinkled_linear,
    wrinkled_tube,
)

TABLE = reference(5, "linearised")
ROWS = tuple(
    wrinkled_linear(zw=float(zw), f=float(f))
    for zw, f in zip(TABLE.columns["zw"], TABLE.columns["f"], strict=True)
)
SHORT = wrinkled_tube(M=1.5, delta=3, Af=0.4362, n=(50, 100, 200, 400), load_end=4.0)
STATE = At("zw", 3.0, profile=())
GAMMA = 1000 * 9.81 * 0.01**2 / (0.2111e6 * 0.1e-3)


AFFINE = decide.Stated(
    1e-11, "affine", "rounding in differences of numbers of size one; it does not depend on a mesh"
)
CORRECTION = decide.Stated(
    2, "a correction in n^(-1/2)", "over a factor 8 of n any other power of n differs by more"
)


def column(solutions: Solutions, name: str) -> decide.Number:
    """A quantity of all rows."""
    return decide.stack(solutions.whole(spec, name) for spec in ROWS)


def affine(solutions: Solutions) -> Finding:
    """Second difference in n, and B from its closed form."""
    B, exact = (column(solutions, name) for name in ("B", "B_exact"))
    curved = column(solutions, "curved").value  # an identity on every mesh
    return decide.all_of(
        decide.at_most("second difference", np.abs(curved), AFFINE),
        decide.agree("B in closed form", B / exact, np.ones(len(ROWS)), 1e-7),
    )


def overestimates(solutions: Solutions) -> Finding:
    """The estimate n* and the real n at which the lowest eigenvalue is zero, at each level."""
    star, true = (column(solutions, name) for name in ("n_star", "n_critical"))
    return decide.all_of(
        decide.positive("n* minus the true n", star - true), decide.negative("B", column(solutions, "B"))
    )


def true_numbers(solutions: Solutions) -> Finding:
    """The smallest unstable whole number of waves, compared with the table at each of its levels."""
    found = [round(n) for n in column(solutions, "n_true").value]
    return decide.same("n", found, TABLE.columns["n_true"].astype(int).tolist())


def short_waves(solutions: Solutions) -> Finding:
    """Distance of Lambda_1/n from -max p lam1/(H R) at zw = 3, times n^(1/2)."""
    z, lam1 = (solutions.column(SHORT, STATE, name) for name in ("z", "lam1"))
    where = solutions.profile(SHORT, STATE).columns["Z"]
    mu = (GAMMA * (STATE.value - z) * lam1 / (1.5 - where / 8)).largest()
    gaps = decide.stack(
        (solutions.number(SHORT, STATE, f"Lambda_n{n}_1") / n + mu) * n**0.5 for n in (50, 100, 200, 400)
    )
    return decide.all_of(
        decide.positive("gaps", gaps),
        decide.at_most("largest over least", gaps.largest() / gaps.smallest(), CORRECTION),
    )


CASE = Case(
    title="Linearised theory",
    source="Patil, Nordmark & Eriksson (2016), section 2.4",
    checks=(
        Points(
            "quantity",
            reference="linearised",
            base=wrinkled_linear(),
            parameters=("zw", "f"),
            asked={"A": 5e-9, "B": 1e-6, "n_star": 1e-8},
        ),
        Claim(
            "affine",
            "along the trial perturbation the second variation is affine in n, with B as in closed form",
            tuple((spec, None) for spec in ROWS),
            affine,
        ),
        Claim(
            "overestimates",
            "n* is larger than the n at which the membrane becomes unstable",
            tuple((spec, None) for spec in ROWS),
            overestimates,
        ),
        Claim(
            "true_numbers",
            "the lowest unstable wave number at each level agrees with the reference",
            tuple((spec, None) for spec in ROWS),
            true_numbers,
        ),
        Claim(
            "short_waves",
            "Lambda_1/n tends to -max p lam1/(H R) from above, with a correction in n^(-1/2)",
            ((SHORT, STATE),),
            short_waves,
        ),
    ),
    slow=True,
)
