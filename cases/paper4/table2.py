"""Paper 4, table 2: critical radius of the disks, (Af)_c/Ao.

The largest radius at which the unloaded membrane has gw <= 1 everywhere, computed with the weak form. The
printed 0.5568 is cut off: with the fifth digit it rounds up to 0.5569.
"""

from weakforms.cases import Case, Claim, CutOff, Finding, Points, Printed, Solutions, decide, wrinkled_tube

ROWS = ((0.5, 2, "0.5568"), (1.5, 2, "0.5568"), (0.5, 3, "0.4362"), (1.5, 3, "0.4362"), (0.99, 2, "0.7046"))
UNIFORM = wrinkled_tube(M=1, delta=2)
LENGTHS = {L: wrinkled_tube(M=0.5, delta=2, L=L) for L in (5, 8, 12)}


def radius(M: float, delta: float) -> Printed:
    """One printed row."""
    digits = next(row[2] for row in ROWS if row[:2] == (M, delta))
    return Printed(
        f"(Af)_c for M = {M}, delta = {delta}",
        digits,
        of=wrinkled_tube(M=M, delta=delta),
        kind="quantity",
        column="Af_critical",
        source="table 2",
        reading=CutOff() if digits == "0.5568" else None,
    )


def uniform(solutions: Solutions) -> Finding:
    """M = 1: delta^(-1/2)."""
    return decide.agree("(Af)_c", solutions.whole(UNIFORM, "Af_critical"), 2**-0.5, 1e-10)


def any_length(solutions: Solutions) -> Finding:
    """M = 0.5, delta = 2: L = 5, 8, 12."""
    return decide.constant(
        "(Af)_c", decide.stack(solutions.whole(s, "Af_critical") for s in LENGTHS.values()), 1e-10
    )


CASE = Case(
    title="Critical radius of the disks",
    source="Patil, Nordmark & Eriksson (2015), table 2",
    checks=(
        *(radius(M, delta) for M, delta, _ in ROWS),
        Printed(
            "(Af)_c for M = 1, delta = 2",
            "0.7071",
            of=UNIFORM,
            kind="quantity",
            column="Af_critical",
            source="table 2",
        ),
        Points(
            "quantity",
            reference="table2",
            base=wrinkled_tube(),
            parameters=("M", "delta"),
            asked={"Af_critical": 1e-10},
        ),
        Claim("uniform", "for uniform thickness (Af)_c = delta^(-1/2)", ((UNIFORM, None),), uniform),
        Claim(
            "any_length",
            "(Af)_c does not depend on the length",
            tuple((spec, None) for spec in LENGTHS.values()),
            any_length,
        ),
    ),
)
