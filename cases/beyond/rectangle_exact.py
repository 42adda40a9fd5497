"""Exact statements on framed rectangular sheets: strips, shallow states, ponding, the work of the load.

A strip whose points keep y = delta Y bends into a cylinder: the pressure is normal, so that lam1 is
uniform under gas and under a liquid. A shallow sheet is a stretched membrane with the stress
S = 2 (1 - delta^-6)(1 + alpha delta^2); its series is that of a linear membrane with a restoring force.
"""

from functools import cache

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, root

from weakforms.cases import At, Case, Claim, Finding, Solutions, Spec, decide, rectangle

ALPHA, DELTA = 0.1, 1.1
STRESS = 2 * (1 - DELTA**-6) * (1 + ALPHA * DELTA**2)
HEIGHTS = (0.3, 0.7, 1.1)
STRIP_GAS = rectangle(load="gas", edges="strip", w_end=1.2)
STRIP_LIQUID = rectangle(edges="strip", gamma=1.0, w_end=1.2)

SHALLOW = 2e-3
"""Height at which, and at half of it, the linear membrane is compared."""

THRESHOLD = STRESS * np.pi**2 / (2 * DELTA**2)
"""Weight at which the flat square ponds."""

NEARLY = 0.95
"""Share of the threshold at which the series is compared: its first term is then twenty times as large."""

SERIES = {
    (load, c): rectangle(load=load, c=c, **({} if load == "gas" else {"gamma": g})).on(start=5e-4)
    for load, c, g in (
        ("gas", 1, 0),
        ("gas", 2, 0),
        ("liquid", 1, round(NEARLY * THRESHOLD, 9)),
        ("liquid", 2, 1.0),
    )
}
PONDED = rectangle(edges="strip", gamma=5.0).on(start=5e-4)
SQUARE = rectangle(load="gas", alpha=0.0)
POND = rectangle(gamma=5.0)
NODES = 0.65 + 0.25 * np.cos(np.pi * np.arange(12, -1, -1) / 12)
"""Heights of the centre at which work is integrated."""


def slope(lam: float) -> float:
    """``W_1(lam, delta)`` of the strip."""
    first = 2 * lam - 2 / (lam**3 * DELTA**2)
    return first + ALPHA * (2 * lam * DELTA**2 - 2 / lam**3)


def cylinder(height: float) -> dict[str, float]:
    """Pressure and volume of a strip under gas, per quarter times four, by its arc."""
    half = brentq(lambda a: DELTA * (1 - np.cos(a)) / np.sin(a) - height, 1e-3, 3.0)
    rho = DELTA / np.sin(half)
    p = slope(rho * half) / (DELTA * rho)
    return {"p": p, "V": 2 * DELTA * rho**2 * (half - np.sin(half) * np.cos(half))}


@cache
def pond(height: float, gamma: float = 1.0) -> dict[str, float]:
    """Level and liquid of a strip: its meridian from the centre, by shooting for stretch and level."""

    def meridian(lam: float, level: float) -> np.ndarray:
        def rates(_s: float, y: np.ndarray) -> list[float]:
            angle, _, depth, _ = y
            head = max(level + depth, 0.0)
            run = lam * np.cos(angle)
            return [lam * DELTA * gamma * head / slope(lam), run, -lam * np.sin(angle), DELTA * run * head]

        return solve_ivp(rates, (0, 1), [0, 0, height, 0], "DOP853", rtol=1e-12, atol=1e-13).y[:, -1]

    def misses(unknown: np.ndarray) -> list[float]:
        end = meridian(*unknown)
        return [end[1] - DELTA, end[2]]

    start = [DELTA * (1 + 0.5 * height**2), height]
    found = root(misses, start, tol=1e-13)
    lam, level = found.x
    return {"zw": level, "V_f": 4 * meridian(lam, level)[3]}


def strips(solutions: Solutions) -> Finding:
    """Load and volume of strips at three heights."""
    found = []
    for spec, exact in ((STRIP_GAS, cylinder), (STRIP_LIQUID, pond)):
        for name in exact(0.5):
            ours = solutions.numbers(spec, [At("w_c", h) for h in HEIGHTS], name)
            theirs = np.array([exact(h)[name] for h in HEIGHTS])
            found.append(decide.agree(f"{name} of the strip", ours, theirs, 1e-5))
    return decide.all_of(found)


def rise(spec: Spec) -> float:
    """Height of the centre over the load (gas: the pressure) of the linear membrane, by its double series."""
    given = dict(spec.parameters)
    c, liquid = given["c"], given["load"] == "liquid"
    weight = (given["gamma"] if liquid else 1.0) * DELTA**2
    m, n = np.meshgrid(*[np.arange(1, TERMS, 2)] * 2, indexing="ij")
    stiffness = STRESS * np.pi**2 / 4 * (m**2 + (n / c) ** 2) - (weight if liquid else 0.0)
    signs = (-1.0) ** ((m + n) // 2 - 1)
    partial = (signs * 16 / (np.pi**2 * m * n) * weight / stiffness).cumsum(axis=0).cumsum(axis=1).diagonal()
    return float((partial[-1] + partial[-2]) / 2)


TERMS = 4001
"""Waves of the series, whose terms alternate: the mean of the last two partial sums is taken."""


def shallow(solutions: Solutions) -> Finding:
    """Height over load in the limit of small heights, by two of them: the next term is quadratic."""
    found = []
    for (load, c), spec in SERIES.items():
        name = "p" if load == "gas" else "zw"
        once, half = (h / solutions.number(spec, At("w_c", h), name) for h in (SHALLOW, SHALLOW / 2))
        limit = half + (half - once) / 3
        known = decide.Number(limit.value, limit.uncertainty + abs((half - once).value) / 3)
        found.append(decide.agree(f"w_c/{name} of {load}, c = {c}", known, rise(spec), 2e-4))
    return decide.all_of(found)


CURVED = 20.0
"""Largest factor of the relative change of a strip's ratio, over the square of the height."""


def ponded(solutions: Solutions) -> Finding:
    """Level over height of a shallow pond on a strip, heavier than the threshold."""
    k = np.sqrt(5.0 * DELTA**2 / STRESS)
    exact = (k - np.pi / 2) / (1 + k - np.pi / 2)
    ours = -1 * solutions.number(PONDED, At("w_c", SHALLOW), "zw") / SHALLOW
    number = decide.Number(exact, CURVED * SHALLOW**2 * exact)
    return decide.agree("-zw/w_c of a shallow pond", ours, number, 2e-3)


def work(solutions: Solutions) -> Finding:
    """Gas: dU = p dV; liquid: dPi = -gamma (V_f - column over the frame) dzw, by polynomials."""
    ats = [At("w_c", float(w)) for w in NODES]
    found = []
    for spec, load, amount, energy in ((SQUARE, "p", "V", "U"), (POND, "zw", "V_f", "Pi")):
        force, volume, stored = (solutions.numbers(spec, ats, name) for name in (load, amount, energy))
        over = np.maximum(force.value, 0.0) * 4 * DELTA**2
        along, rate = (
            (force.value, volume.value) if load == "p" else (-5.0 * (volume.value - over), force.value)
        )
        exact = decide.work(NODES, along, rate)
        found.append(decide.agree(f"work of {load}", stored[-1] - stored[0], exact, 1e-4))
    return decide.all_of(found)


CASE = Case(
    title="Exact statements on framed sheets",
    source="Patil (2016), section 6.4 (future work); closed forms",
    checks=(
        Claim(
            "strips",
            "a strip under gas or liquid is a cylinder of uniform stretch",
            tuple((spec, At("w_c", h)) for spec in (STRIP_GAS, STRIP_LIQUID) for h in HEIGHTS),
            strips,
        ),
        Claim(
            "shallow",
            "shallow sheets follow the series of the linear membrane, also close to the ponding threshold",
            tuple((spec, At("w_c", h)) for spec in SERIES.values() for h in (SHALLOW, SHALLOW / 2)),
            shallow,
        ),
        Claim(
            "ponded",
            "above the threshold the level leaves zero downwards, in a finite ratio to the height",
            ((PONDED, At("w_c", SHALLOW)),),
            ponded,
        ),
        Claim(
            "work",
            "the load's work is the change of energy",
            tuple((spec, At("w_c", float(w))) for spec in (SQUARE, POND) for w in NODES),
            work,
        ),
    ),
    slow=True,
)
