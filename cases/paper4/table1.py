"""Paper 4, table 1: energy of a sheet in its four states, also by the modified deformation gradient.

Both forms, differentiated by UFL, are compared with the printed formulas. The first derivatives are
continuous where the states meet; the second ones jump.
"""

import numpy as np

from weakforms.cases import Case, Claim, Finding, Solutions, Spec, decide, wrinkled_material

C2 = 0.01
SAMPLES = {
    "taut": ((1.5, 1.2), (2.0, 0.9), (0.95, 1.3), (1.05, 1.05)),
    "tension along 1": ((1.5, 0.5), (2.5, 0.05), (1.01, 0.6)),
    "tension along 2": ((0.5, 1.5), (0.05, 2.5), (0.6, 1.01)),
    "slack": ((0.9, 0.8), (0.3, 0.99), (0.05, 0.05)),
}
NAMES = ("W", "W1", "W2", "W11", "W12", "W22")
NEAR = 1e-7
"""Distance from the curves on which states meet, for the check of continuity."""
CONTINUOUS = decide.Stated(
    50 * NEAR, "continuous", "a slope of 25 times the distance of the two sides; the tangent is below that"
)
JUMPS = decide.Stated(0.5, "jumps", "millions of times that; the tangent's own size is about 2")
MEETING = {
    "taut / tension along 1": lambda e: (1.5, 1.5**-0.5 * (1 + e)),
    "taut / tension along 2": lambda e: (1.5**-0.5 * (1 + e), 1.5),
    "tension along 1 / slack": lambda e: (1 + e, 0.7),
    "tension along 2 / slack": lambda e: (0.7, 1 + e),
}


def sheet(stretches: tuple[float, float], energy: str = "relaxed") -> Spec:
    """The solution at two stretches."""
    return wrinkled_material(l1=stretches[0], l2=stretches[1], c2=C2, energy=energy)


def found(solutions: Solutions, stretches: tuple[float, float], energy: str = "relaxed") -> np.ndarray:
    """Energy, stresses and tangent."""
    quantities = solutions.result(sheet(stretches, energy)).quantities
    return np.array([quantities[name].value for name in NAMES])


def full(a: float, b: float) -> tuple[float, ...]:
    """Mooney-Rivlin energy of the taut state, with its derivatives written out."""
    j = (a * b) ** 2
    return (
        a**2 + b**2 + 1 / j - 3 + C2 * (1 / a**2 + 1 / b**2 + j - 3),
        2 * (a - 1 / (a * j) + C2 * (a * b**2 - 1 / a**3)),
        2 * (b - 1 / (b * j) + C2 * (a**2 * b - 1 / b**3)),
        2 * (1 + 3 / (a**2 * j) + C2 * (b**2 + 3 / a**4)),
        4 / (a * b * j) + 4 * C2 * a * b,
        2 * (1 + 3 / (b**2 * j) + C2 * (a**2 + 3 / b**4)),
    )


def uniaxial(a: float) -> tuple[float, float, float]:
    """Energy of the wrinkled state and two derivatives."""
    return (
        a**2 + 2 / a - 3 + C2 * (2 * a + 1 / a**2 - 3),
        2 * (a - 1 / a**2 + C2 * (1 - 1 / a**3)),
        2 + 4 / a**3 + 6 * C2 / a**4,
    )


def printed(state: str, a: float, b: float) -> tuple[float, ...]:
    """The table's energy in a state."""
    if state == "taut":
        return full(a, b)
    if state == "tension along 1":
        w, w1, w11 = uniaxial(a)
        return w, w1, 0, w11, 0, 0
    if state == "tension along 2":
        w, w2, w22 = uniaxial(b)
        return w, 0, w2, 0, 0, w22
    return (0,) * 6


def as_printed(solutions: Solutions, energy: str) -> Finding:
    """Difference from the printed formulas in each state, relative to the largest number of a sample."""
    rows = []
    for state, points in SAMPLES.items():
        pairs = [(found(solutions, p, energy), np.array(printed(state, *p))) for p in points]
        rows += [decide.exact(state, a, b, max(1.0, np.abs(b).max())) for a, b in pairs]
    return decide.all_of(rows)


def smooth(solutions: Solutions) -> Finding:
    """Jumps across the curves where states meet: none in W and its first derivatives, some in the tangent.

    Without a jump the difference is the slope times the distance of the two sides; all slopes are below 50.
    """
    rows = []
    for name, point in MEETING.items():
        below, above = (found(solutions, point(e)) for e in (-NEAR, NEAR))
        jump = np.abs(above - below)
        rows.append(decide.at_most(name, jump[:3], CONTINUOUS))
        rows.append(decide.at_least("tangent", jump[3:].max(), JUMPS))
    return decide.all_of(rows)


POINTS = [p for points in SAMPLES.values() for p in points]

CASE = Case(
    title="States of a sheet and their energies",
    source="Patil, Nordmark & Eriksson (2015), table 1",
    checks=(
        Claim(
            "state_table",
            "energy, stresses and tangent in all four states agree with the table",
            tuple((sheet(p), None) for p in POINTS),
            lambda solutions: as_printed(solutions, "relaxed"),
        ),
        Claim(
            "modified_gradient",
            "the modified deformation gradient gives the same in all four states",
            tuple((sheet(p, "modified_gradient"), None) for p in POINTS),
            lambda solutions: as_printed(solutions, "modified_gradient"),
        ),
        Claim(
            "smooth",
            "energy and stresses are continuous where states meet, the tangent is not",
            tuple((sheet(point(e)), None) for point in MEETING.values() for e in (-NEAR, NEAR)),
            smooth,
        ),
    ),
)
