"""Torsion of a flat annulus in its plane: torque, wrinkles and their front, against two other methods.

Both edges are held and the inner one is turned. The sheet wrinkles along straight lines of tension. COMSOL's
model of the wrinkled annulus has the radii 5 and 12.5 m and an angle of 10 degrees; Reissner (1938) gives
the limit of small angles where the sheet is wrinkled all over.
"""

import numpy as np
from numpy.polynomial import Chebyshev, Polynomial
from scipy.optimize import minimize_scalar

from weakforms.cases import (
    At,
    Axis,
    Case,
    Claim,
    Constant,
    Curve,
    Finding,
    Panel,
    Points,
    Solutions,
    Spec,
    annulus,
    decide,
)

WIDE = annulus(a=0.4, alpha=0.0)
NARROW = annulus(a=0.8, psi_end=0.3)
STRETCHED = annulus(a=0.4, s=1.05)
FULL = annulus(a=0.4, alpha=0.0, energy="full")
TEN_DEGREES = At("psi", 0.174532925199, profile=())
ASKED = {"M": 1e-7, "U": 1e-7, "R_front": 1e-6}

SVK = {"model": "saint_venant_kirchhoff", "shear": 1.0}
SMALL = {
    (a, nu): annulus(a=a, psi_end=0.04, **law).on(start=0.002, step=0.02, cells=24)
    for nu, law in ((0.3, {**SVK, "poisson": 0.3}), (0.5, {"alpha": 0.0}))
    for a in (0.4, 0.6, 0.8)
}
"""By the inner radius and Poisson's ratio of small strains."""

YOUNG = {0.3: 2.6, 0.5: 6.0}
"""Young's modulus over the stress of the law: 2 (1 + nu) shear, and 6 C1."""

ANGLES = (0.0025, 0.005, 0.01, 0.02, 0.025)
NODES = 0.3 + 0.15 * np.cos(np.pi * np.arange(10, -1, -1) / 10)
"""Angles between which the work of the torque is integrated, past the onset of the stretched annulus."""


def lines(a: float) -> tuple[float, float]:
    """Torque per angle over E and distance of the lines of tension from the centre, for small angles.

    Straight lines at a distance c from the centre give an admissible field of stress for every c below a; the
    largest torque among them is the exact one if the sheet is wrinkled all over.
    """

    def torque(c: float) -> float:
        return 4 * np.pi * c**2 / np.log((1 - c**2) / (a**2 - c**2))

    c = minimize_scalar(lambda c: -torque(c), bounds=(0, a), method="bounded", options={"xatol": 1e-12}).x
    return float(torque(c)), float(c)


def everywhere(a: float, nu: float) -> bool:
    """Whether the field of straight lines may hold at the outer edge: tan^2(beta) >= nu there."""
    _, c = lines(a)
    return c**2 / (1 - c**2) >= nu


def zones(solutions: Solutions) -> Finding:
    """Small angles: wrinkled all over, or with a taut ring at the outer edge, which the hoop's hold pulls."""
    found = []
    for (a, nu), spec in SMALL.items():
        front = solutions.number(spec, At("psi", ANGLES[0]), "R_front")
        if everywhere(a, nu):
            found.append(decide.exact(f"wrinkled all over, a = {a}, nu = {nu}", front.value, 1.0))
        else:
            found.append(decide.less(f"front inside, a = {a}, nu = {nu}", a, front, 1.0))
    return decide.all_of(*found)


def small(solutions: Solutions) -> Finding:
    """Torque per angle at vanishing angle, extrapolated by polynomials, where the sheet wrinkles all over."""
    found = []
    for (a, nu), spec in SMALL.items():
        if not everywhere(a, nu):
            continue
        ratios = [solutions.value(spec, At("psi", x), "M") / x for x in ANGLES]
        all_of, fewer = (Polynomial.fit(ANGLES[:n], ratios[:n], n - 1)(0.0) for n in (5, 4))
        ours = decide.Number(all_of, abs(all_of - fewer))
        found.append(decide.agree(f"M/psi, a = {a}, nu = {nu}", ours, YOUNG[nu] * lines(a)[0], 1e-5))
    return decide.all_of(*found)


def work(solutions: Solutions) -> Finding:
    """The work of the torque between two angles is the change of the energy."""
    found = []
    for spec in (WIDE, STRETCHED, FULL):
        torques = solutions.numbers(spec, [At("psi", float(x)) for x in NODES], "M")
        last, fewer = (Chebyshev.fit(NODES, torques.value, n).integ() for n in (10, 8))
        done, less = (fit(NODES[-1]) - fit(NODES[0]) for fit in (last, fewer))
        change = solutions.number(spec, At("psi", float(NODES[-1])), "U") - solutions.number(
            spec, At("psi", float(NODES[0])), "U"
        )
        found.append(decide.agree(f"work on {spec}", change, decide.Number(done, abs(done - less)), 1e-6))
    return decide.all_of(*found)


def clapeyron(solutions: Solutions) -> Finding:
    """Twice the energy from stretches and stresses at both edges."""
    return decide.all_of(
        *(
            decide.agree(f"U of {spec}", *(solutions.number(spec, at, n) for n in ("U_edges", "U")), 1e-5)
            for spec in (WIDE, NARROW, STRETCHED, FULL)
            for at in (At("psi", 0.25),)
        )
    )


def straight(solutions: Solutions) -> Finding:
    """Inside of the front tension and distance of its lines from the centre are constant, outside not."""
    found = []
    for spec in (WIDE, STRETCHED):
        front = solutions.value(spec, TEN_DEGREES, "R_front")
        radii = solutions.column(spec, TEN_DEGREES, "R").value
        for name in ("tension", "line"):
            column = solutions.column(spec, TEN_DEGREES, name)
            inside, outside = (
                decide.Number(column.value[i], column.uncertainty[i]) for i in (radii < front, radii > front)
            )
            found.append(decide.constant(f"{name} where wrinkled, {spec}", inside, 1e-4))
            rising = decide.rises if name == "tension" else decide.falls
            found.append(rising(f"{name} where taut, {spec}", outside))
    return decide.all_of(*found)


def softer(solutions: Solutions) -> Finding:
    """A sheet that bears no compression needs less torque; in the plane its states are stable."""
    relaxed, full = (solutions.number(spec, TEN_DEGREES, "M") for spec in (WIDE, FULL))
    counts = [solutions.branch(spec).columns["n_negative"] for spec in (WIDE, NARROW, STRETCHED)]
    return decide.all_of(
        decide.less("torque, relaxed and full", relaxed, full),
        decide.same("negative eigenvalues", sorted({int(n) for column in counts for n in column}), [0]),
    )


def torque(spec: Spec) -> Constant:
    """The stress gives the same torque at every radius."""
    return Constant("torque", spec, TEN_DEGREES, 1e-4, "the torque is the same at every radius")


CASE = Case(
    title="Torsion of a flat annulus",
    source="Reissner (1938); set-up of COMSOL's model of a wrinkled annulus",
    panels=(
        Panel(
            "torque",
            x=Axis("psi", 0, 0.5),
            y=Axis("M", 0, 3),
            markers="wrinkling_onset",
            note="Not a figure of the thesis.",
            curves=(
                Curve(WIDE, r"$a = 0.4,\ \alpha = 0$", reference="annulus_wide"),
                Curve(STRETCHED, r"$a = 0.4,\ s = 1.05$", reference="annulus_stretched"),
                Curve(FULL, r"$a = 0.4,\ \alpha = 0$, bears compression"),
            ),
        ),
        Panel(
            "narrow",
            x=Axis("psi", 0, 0.3),
            y=Axis("M", 0, 15),
            curves=(Curve(NARROW, "$a = 0.8$", reference="annulus_narrow"),),
        ),
        Panel(
            "front",
            x=Axis("psi", 0, 0.5),
            y=Axis("R_front", 0.4, 1),
            curves=(Curve(WIDE, r"$a = 0.4,\ \alpha = 0$"), Curve(STRETCHED, r"$a = 0.4,\ s = 1.05$")),
        ),
    ),
    checks=(
        Points("wrinkling_onset", "annulus_onset", STRETCHED, (), {"psi": 1e-6, "M": 1e-6, "U": 1e-6}),
        torque(WIDE),
        torque(NARROW),
        torque(STRETCHED),
        Claim(
            "zones",
            "wrinkled all over only if the straight lines meet the outer edge flat enough; else a taut ring",
            tuple((spec, At("psi", ANGLES[0])) for spec in SMALL.values()),
            zones,
        ),
        Claim(
            "small_angles",
            "torque per angle of small angles is the largest one of straight lines of tension",
            tuple((s, At("psi", x)) for key, s in SMALL.items() if everywhere(*key) for x in ANGLES),
            small,
        ),
        Claim(
            "work",
            "the torque is the derivative of the energy",
            tuple((spec, At("psi", float(x))) for spec in (WIDE, STRETCHED, FULL) for x in NODES),
            work,
        ),
        Claim(
            "clapeyron",
            "the energy follows from the edges alone, taut or wrinkled",
            tuple((spec, At("psi", 0.25)) for spec in (WIDE, NARROW, STRETCHED, FULL)),
            clapeyron,
        ),
        Claim(
            "straight",
            "where wrinkled, lines of tension are straight and the tension along them is constant",
            tuple((spec, TEN_DEGREES) for spec in (WIDE, STRETCHED)),
            straight,
        ),
        Claim(
            "softer",
            "wrinkles lower the torque, and states in the plane are stable",
            ((WIDE, TEN_DEGREES), (FULL, TEN_DEGREES), (NARROW, None), (STRETCHED, None)),
            softer,
        ),
    ),
    asked=ASKED,
)
