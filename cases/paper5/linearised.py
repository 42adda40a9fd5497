"""Paper 5, section 2.4: a perturbation without meridional displacement, and the n from which it is unstable.

Along u = f z0', v = f, w = -f r0' the relaxed second variation is A + n B with B < 0: unstable for every
n > n* = A/(-B), whatever the pressure. The true n from which waves set in is smaller: only one shape is
tried.
"""

from weakforms import (
    At,
    Case,
    Claim,
    Finding,
    Points,
    Solutions,
    Spec,
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


def number(solutions: Solutions, spec: Spec, name: str) -> float:
    """A quantity."""
    return solutions.result(spec).quantities[name].value


def affine(solutions: Solutions) -> Finding:
    """Largest second difference in n, and of B from its closed form."""
    curved = max(abs(number(solutions, spec, "curved")) for spec in ROWS)
    off = max(abs(number(solutions, s, "B") / number(solutions, s, "B_exact") - 1) for s in ROWS)
    return curved < 1e-11 and off < 1e-9, f"{curved:.0e}, {off:.0e}"


def overestimates(solutions: Solutions) -> Finding:
    """The estimate n* and the real n at which the lowest eigenvalue is zero, at each level."""
    good, rows = True, []
    for spec in ROWS:
        star, true = (number(solutions, spec, name) for name in ("n_star", "n_critical"))
        good &= star >= true and number(solutions, spec, "B") < 0
        rows.append(f"{star:.2f} >= {true:.2f}")
    return good, "; ".join(rows)


def true_numbers(solutions: Solutions) -> Finding:
    """The lowest whole number of waves that is unstable, against the table's, at each of its levels."""
    found = [round(number(solutions, spec, "n_true")) for spec in ROWS]
    known = TABLE.columns["n_true"].astype(int).tolist()
    return found == known, ", ".join(map(str, found))


def short_waves(solutions: Solutions) -> Finding:
    """Distance of Lambda_1/n from -max p lam1/(H R) at zw = 3, times n^(1/2)."""
    state = solutions.state(SHORT, STATE)
    columns = state.fields[0].columns
    pressure = GAMMA * (STATE.value - columns["z"]).clip(min=0)
    mu = float((pressure * columns["lam1"] / (1.5 - columns["Z"] / 8)).max())
    gaps = [(state.quantities[f"Lambda_n{n}_1"].value / n + mu) * n**0.5 for n in (50, 100, 200, 400)]
    good = all(g > 0 for g in gaps) and max(gaps) < 2 * min(gaps)
    return good, f"mu = {mu:.6f}; " + ", ".join(f"{g:.4f}" for g in gaps)


CASE = Case(
    title="Linearised theory",
    source="Patil, Nordmark & Eriksson (2016), section 2.4",
    checks=(
        Points(
            "quantity",
            reference="linearised",
            base=wrinkled_linear(),
            parameters=("zw", "f"),
            asked={"A": 1e-6, "B": 1e-6, "n_star": 1e-6},
        ),
        Claim(
            "affine",
            "along the trial perturbation the second variation is affine in n, with B as in closed form",
            tuple((spec, None) for spec in ROWS),
            affine,
        ),
        Claim(
            "overestimates",
            "n* is larger than the n from which the membrane is unstable",
            tuple((spec, None) for spec in ROWS),
            overestimates,
        ),
        Claim(
            "true_numbers",
            "the lowest unstable wave number at each level is the reference's",
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
)
