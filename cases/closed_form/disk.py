"""Flat disk inflated: the neo-Hookean maximum, and the pressure against the stretch of the pole.

Without a length but its radius, a disk's equations can be integrated from the pole outwards at unit pressure
for any stretch of the pole: where the circumferential stretch has come back to 1 is the clamp, and its
radius is the pressure. That one integration a point, without shooting, is what the branch is held against.
"""

import numpy as np
from scipy.integrate import solve_ivp

from weakforms import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, circular

DISK = circular(alpha=0, t_end=3.1).on(cells=192)
POLES = (1.05, 1.2, 1.5, 1.8, 2.5, 3.0, 4.0)
ANCHORS = {"p": ("1.879173469", 2.0), "lam_pole": ("2.195944", 1.0)}
"""Published digits at the maximum, p R/(2 c1 h0) and the pole's stretch, and what divides our columns."""


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


def pressure(pole: float) -> float:
    """Pressure at a stretch of the pole: the radius at which lam2 is back to 1."""
    w1, _, w11, w12 = derivatives(pole, pole)
    bend = pole**2 / (2 * w1)
    # lam1 = pole + a x^2, lam2 = pole + b x^2 near the pole
    rows = [[1.0, -3.0], [3 * w11 - w12, 3 * w12 - w11]]
    a, b = np.linalg.solve(rows, [pole * bend**2 / 2, -w1 * bend**2 / 2])
    x = 2e-3

    def clamp(_x: float, y: np.ndarray) -> float:
        return y[1] - 1.0

    clamp.terminal = True
    start = [pole + a * x**2, pole + b * x**2, bend * x]
    found = solve_ivp(rates, (x, 50.0), start, "DOP853", rtol=1e-13, atol=1e-14, events=clamp)
    return float(found.t_events[0][0])


def parametrised(solutions: Solutions) -> Finding:
    """The branch at the poles' stretches against one integration each."""
    rows, good = [], True
    for pole in POLES:
        found, exact = solutions.quantity(DISK, At("lam_pole", pole), "p"), pressure(pole)
        error = abs(found.value - exact)
        good &= error <= 2 * found.uncertainty + 1e-9 and found.uncertainty < 1e-7
        rows.append(f"{pole:g}: {error:.0e}")
    return bool(good), "difference of p at the pole's stretch " + ", ".join(rows)


def anchors(solutions: Solutions) -> Finding:
    """The maximum to all published digits; the stretch is published cut off, not rounded (2.1959445...)."""
    (top,) = solutions.points(DISK, "limit_point")
    rows, good = [], True
    for name, (digits, divisor) in ANCHORS.items():
        value, spread = top.values[name] / divisor, top.uncertainty[name] / divisor
        last = 10.0 ** -len(digits.partition(".")[2])
        good &= -last / 2 - spread <= value - float(digits) < last + spread and spread < last / 10
        rows.append(f"{name}: {value:.10g} +- {spread:.0e}, published {digits}")
    return bool(good), "; ".join(rows)


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
            "the branch is the one that integration from the pole at unit pressure gives",
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
