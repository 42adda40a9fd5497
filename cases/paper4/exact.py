"""Paper 4: what the exact solution satisfies, checked on the computed one.

The tension is constant in wrinkled zones, the axial force all along the gas-filled membrane and in dry parts;
dry wrinkled parts are cones; gas-filled wrinkled parts keep the first integral of the Mylar balloon. At a
front the second derivatives of r and z jump, in the ratio r' : z': the printed statement that u is C2 and w
is C1 holds as far as r' is small there.
"""

import numpy as np

from weakforms import At, Case, Claim, Constant, Finding, Solutions, wrinkled_tube

GAS = {d: wrinkled_tube(M=0.5, delta=d, load="gas") for d in (2, 3)}
FLUID = wrinkled_tube(M=1.5, delta=2)
ALL_WRINKLED = wrinkled_tube(M=0.5, delta=2, Af=0.4)
INFLATED, PRINTED, LOW = (
    At("p", 0.2, profile=()),
    At("zw", 7.44, profile=()),
    At("zw", 4.5, profile=()),
)
DENSE = At("zw", 7.44, profile=tuple(np.linspace(0.0, 8.0, 801)))
FRONTS = {
    "fluid": (FLUID, PRINTED, (1.511572660117, 5.069224906584, 7.595374980714)),
    "gas": (GAS[2], INFLATED, (6.305956442427,)),
}
"""States and their fronts, as the reference has them: where jumps are measured."""
WINDOW, NODES, FIT = 0.1, 24, 9
OFFSETS = WINDOW * (1 - np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)) / 2
SMALL = 1e-4
"""Relative error of second derivatives by polynomials fitted to samples."""


def jumps_at(kind: str) -> At:
    """The state sampled on both sides of its fronts."""
    _, at, fronts = FRONTS[kind]
    places = sorted(z + side * d for z in fronts for d in OFFSETS for side in (-1, 1))
    return At(at.name, at.value, profile=tuple(places))


def wrinkled(gw: np.ndarray) -> np.ndarray:
    """Rows clear of any front."""
    return gw < 1 - 1e-6


def tension_constant(solutions: Solutions) -> Finding:
    """Spread of N over each wrinkled zone, relative."""
    good, rows = True, []
    for spec, at in ((FLUID, PRINTED), (GAS[2], INFLATED), (ALL_WRINKLED, LOW)):
        field = solutions.profile(spec, at)
        inside = wrinkled(field.columns["gw"])
        zones = np.split(np.arange(len(inside)), np.flatnonzero(np.diff(inside)) + 1)
        for zone in (z for z in zones if inside[z[0]]):
            values = field.columns["tension"][zone]
            spread = np.ptp(values) / values.mean()
            good &= bool(spread <= 2 * field.uncertainty["tension"] / values.mean() + 1e-10)
            rows.append(f"{spread:.0e}")
    return good, f"{len(rows)} zones: " + ", ".join(rows)


def cones(solutions: Solutions) -> Finding:
    """Spread of dr/dz over the dry wrinkled part: Af = 0.4 at zw = 4.5 above the surface."""
    field = solutions.profile(ALL_WRINKLED, LOW)
    dry = field.columns["z"] > LOW.value
    slopes, u = field.columns["slope"][dry], field.uncertainty["slope"]
    spread = np.ptp(slopes)
    return bool(
        spread <= 2 * u + 1e-10
    ), f"slope {slopes.mean():.9f}, spread {spread:.0e} on {dry.sum()} points"


def mylar(solutions: Solutions) -> Finding:
    """Spread of cos(phi) - p r^2/(2 N) over the wrinkled zone under gas."""
    columns = solutions.profile(GAS[2], INFLATED).columns
    inside = wrinkled(columns["gw"])
    cosine = 1 / np.sqrt(1 + columns["slope"] ** 2)
    integral = (cosine - INFLATED.value * columns["r"] ** 2 / (2 * columns["tension"]))[inside]
    return bool(np.ptp(integral) < 1e-9), f"{integral.mean():.9f}, spread {np.ptp(integral):.0e}"


def wet_part(solutions: Solutions) -> Finding:
    """Fluid: the axial force grows by the integral of gamma z' r^2/2 on the wet part, and not above it."""
    names = ("Z", "z", "r", "lam1", "slope", "axial")
    columns = {n: solutions.sampled(FLUID, DENSE, n)[0] for n in names[1:]} | {"Z": np.asarray(DENSE.profile)}
    z, r, force = columns["z"], columns["r"], columns["axial"]
    gamma = 1000 * 9.81 * 0.01**2 / (0.2111e6 * 0.1e-3)
    wet = z < PRINTED.value
    dry = np.ptp(force[~wet]) / force[~wet].mean()
    # Simpson's rule on equidistant points, with z' r^2 from the profile itself.
    slope = columns["lam1"] / np.sqrt(1 + columns["slope"] ** 2)
    density, h = gamma * slope * r**2 / 2, columns["Z"][1] - columns["Z"][0]
    last = int(wet.sum()) - 1 - (int(wet.sum()) - 1) % 2
    weights = np.r_[1, np.tile([4, 2], last // 2 - 1), 4, 1] * h / 3
    gained = weights @ density[: last + 1]
    error = abs(force[last] - force[0] - gained) / force[0]
    return bool(dry < 1e-9 and error < 1e-6), f"dry: spread {dry:.0e}; wet: {error:.0e} relative"


def second(z: np.ndarray, values: np.ndarray, side: int) -> tuple[float, float]:
    """First and second derivative at a front from one side."""
    inside = (side * z > 0) & (side * z < WINDOW)
    fit = np.polynomial.Chebyshev.fit(z[inside], values[inside], FIT)
    return float(fit.deriv()(0.0)), float(fit.deriv(2)(0.0))


def jumps(solutions: Solutions) -> Finding:
    """[r''] z' = [z''] r' at each front, [z''] not zero and [r''] much smaller."""
    good, rows = True, []
    for kind, (spec, _, fronts) in FRONTS.items():
        at = jumps_at(kind)
        for front in fronts:
            z = np.asarray(at.profile) - front
            found = {n: solutions.sampled(spec, at, n)[0] for n in ("r", "z")}
            (rp, r2), (zp, z2) = (
                (second(z, v, 1)[0], second(z, v, 1)[1] - second(z, v, -1)[1]) for v in found.values()
            )
            defect = abs(r2 * zp - z2 * rp) / abs(z2 * zp)
            good &= defect < SMALL < abs(z2) and abs(r2) < 0.15 * abs(z2)
            rows.append(f"Z = {front:.3f}: [z''] = {z2:.4f}, [r''] = {r2:.5f}, defect {defect:.0e}")
    return bool(good), "; ".join(rows)


CASE = Case(
    title="First integrals and jumps at fronts",
    source="Patil, Nordmark & Eriksson (2015), sections 2 and 3",
    checks=(
        *(
            Constant(
                "axial", spec, INFLATED, 1e-6, "under gas the axial force N cos(phi) - p r^2/2 is constant"
            )
            for spec in GAS.values()
        ),
        Constant(
            "tension",
            ALL_WRINKLED,
            LOW,
            1e-6,
            "the tension is constant all along a membrane wrinkled everywhere",
        ),
        Claim(
            "tension_constant",
            "the tension is constant in every wrinkled zone",
            ((FLUID, PRINTED), (GAS[2], INFLATED), (ALL_WRINKLED, LOW)),
            tension_constant,
        ),
        Claim("cones", "dry wrinkled parts are cones", ((ALL_WRINKLED, LOW),), cones),
        Claim(
            "mylar",
            "cos(phi) - p r^2/(2N) is constant where gas-filled and wrinkled",
            ((GAS[2], INFLATED),),
            mylar,
        ),
        Claim(
            "wet_part",
            "(N cos(phi) - P r^2/2)' = gamma z' r^2/2 where wet and 0 where dry",
            ((FLUID, DENSE),),
            wet_part,
        ),
        Claim(
            "jumps",
            "at a front r'' and z'' jump in the ratio r' : z', so the jump of r'' is the smaller by far",
            tuple((spec, jumps_at(kind)) for kind, (spec, _, _) in FRONTS.items()),
            jumps,
            differs="the text has u in C2 and w in C1 at a front; the second derivatives of both jump, in "
            "the ratio r' : z', so that of u is small where the meridian is steep, and not zero",
        ),
    ),
    quick=True,
)
