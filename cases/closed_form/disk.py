"""Inflation of a flat disk: the neo-Hookean maximum, and the pressure over the stretch of the pole.

The radius is the only length of a disk. Its equations can therefore be integrated from the pole outwards at
unit pressure for any stretch of the pole. The clamp is the point where the circumferential stretch returns to
1, and the radius of this point gives the pressure. The branch is compared with one such integration for each
point, without shooting.
"""

import numpy as np
from scipy.integrate import solve_ivp

from weakforms.cases import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, circular, decide

DISK = circular(alpha=0, t_end=3.1).on(cells=192)
POLES = (1.05, 1.2, 1.5, 1.8, 2.5, 3.0, 4.0)
ANCHORS = {"p": ("1.879173469", 2.0), "lam_pole": ("2.195944", 1.0)}
"""Published digits at the maximum, p R/(2 c1 h0) and the pole's stretch, and the factors of our columns."""


START = 2e-3
"""Radius at which the integration starts, with a series of two terms."""


def derivatives(a: float, b: float) -> tuple[float, float, float, float]:
    """w1, w2, w11, w12 of the neo-Hookean sheet."""
    w1, w2 = 2 * (a - 1 / (a**3 * b**2)), 2 * (b - 1 / (b**3 * a**2))
    return w1, w2, 2 + 6 / (a**4 * b**2), 4 / (a * b) ** 3


def rates(x: float, y: np.ndarray) -> list[float]:
    """Equilibrium of the meridian at unit pressure: stretches and slope angle over the radius."""
    a, b, angle = y
    w1, w2, w11, w12 = derivatives(a, b)
    rise = (a * np.cos(angle) - b) / x
    stretching = ((w2 * np.cos(angle) - w1) / x - w12 * rise) / w11
    return [stretching, rise, (x * b * a - w2 * np.sin(angle)) / (x * w1)]


def pressure(pole: float, x: float = START) -> float:
    """Pressure at a stretch of the pole: the radius at which lam2 returns to 1; a series up to ``x``."""
    w1, _, w11, w12 = derivatives(pole, pole)
    bend = pole**2 / (2 * w1)
    # lam1 = pole + a x^2, lam2 = pole + b x^2 near the pole
    rows = [[1.0, -3.0], [3 * w11 - w12, 3 * w12 - w11]]
    a, b = np.linalg.solve(rows, [pole * bend**2 / 2, -w1 * bend**2 / 2])

    def clamp(_x: float, y: np.ndarray) -> float:
        return y[1] - 1.0

    clamp.terminal = True
    start = [pole + a * x**2, pole + b * x**2, bend * x]
    found = solve_ivp(rates, (x, 50.0), start, "DOP853", rtol=1e-13, atol=1e-14, events=clamp)
    return float(found.t_events[0][0])


def parametrised(solutions: Solutions) -> Finding:
    """The branch at some stretches of the pole, compared with one integration for each."""
    found = solutions.numbers(DISK, [At("lam_pole", pole) for pole in POLES], "p")
    exact = np.array([pressure(pole) for pole in POLES])
    halved = np.array([pressure(pole, START / 2) for pole in POLES])
    return decide.agree("p at the pole's stretch", found, decide.Number(exact, np.abs(exact - halved)), 2e-9)


def anchors(solutions: Solutions) -> Finding:
    """The maximum to all published digits; the stretch is published cut off, not rounded (2.1959445...)."""
    found = []
    for name, (digits, divisor) in ANCHORS.items():
        value = solutions.point(DISK, "limit_point", name) / divisor
        last = 10.0 ** -len(digits.partition(".")[2])
        found.append(
            decide.between(
                f"{name}, published {digits}", value, float(digits) - last / 2, float(digits) + last
            )
        )
    return decide.all_of(found)


CASE = Case(
    title="Flat disk: pressure against the stretch of the pole, and its maximum",
    source="Adkins & Rivlin (1952); Patil, DasGupta & Eriksson (2015), section 2",
    panels=(
        Panel(
            "p",
            x=Axis("p", 0, 4),
            y=Axis("lam_pole", 1, 5, r"$\lambda_{pole}$"),
            markers="limit_point",
            curves=(Curve(DISK, "neo-Hookean"),),
        ),
    ),
    checks=(
        Claim(
            "pole_stretch",
            "the branch agrees with integration from the pole at unit pressure",
            tuple((DISK, At("lam_pole", pole)) for pole in POLES),
            parametrised,
        ),
        Claim(
            "maximum",
            "p R/(2 c1 h0) has its maximum 1.879173469 at the pole stretch 2.195944",
            ((DISK, None),),
            anchors,
        ),
    ),
    quick=True,
)
