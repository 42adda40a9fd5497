"""A membrane on triangles without symmetry, against the problems and tables of the same bodies.

The disk is that of Paper 1 before contact, with lengths over the stress-free radius: p and V are those of
circular times 1/beta and 2 pi beta^3. The square is that of rectangle, whose tables come from spectral
methods; so does the table of a square of Saint Venant and Kirchhoff's law.
"""

import numpy as np

from weakforms.cases import (
    At,
    Axis,
    Case,
    Claim,
    Count,
    Curve,
    Finding,
    Panel,
    Points,
    Solutions,
    circular,
    decide,
    membrane,
)

DELTA = 1.1
DISK = membrane(alpha=0.0, delta=DELTA, w_end=1.3)
POLYGON = membrane(alpha=0.0, delta=DELTA, w_end=0.7).on(degree=1)
SQUARE = membrane(mesh="square", alpha=0.0, delta=DELTA, w_end=1.5).on(cells=12)
FILLED = membrane(
    **{"mesh": "square", "alpha": 0.0, "delta": DELTA, "w_end": 1.8},
    **{"kappa": 1.4, "p_atm": 0.5, "V_r": 60.0},
).on(cells=16)
"""With a reservoir of gas that is larger than the volume."""

ADAPTED = membrane(mesh="square", alpha=0.0, delta=DELTA, w_end=1.5).on(cells=8, refine=2)
"""From squares half as large as half a side, cut where the error is."""

KIRCHHOFF = membrane(
    **{"mesh": "square", "delta": DELTA, "w_end": 0.8},
    **{"model": "saint_venant_kirchhoff", "shear": 1 / 2.8, "poisson": 0.4},
).on(cells=12)
"""Another law, over Young's modulus, which many codes have."""

REVOLVED = circular(alpha=0.0, beta=DELTA, l=5)
ASKED = 1e-4
"""Asked of taut states, degree 2 with curved triangles; the meshes are coarser than those of rectangle."""

FLAT = 2e-4
"""Asked of all but the mass itself where it is largest: the place of an extremum has fewer digits."""

STRAIGHT = 2e-2
"""Asked of straight triangles of degree 1, whose edge is a polygon."""

HEIGHTS = (0.3, 0.6, 0.9)
NODES = 0.6 + 0.3 * np.cos(np.pi * np.arange(10, -1, -1) / 10)
"""Heights of the centre at which work is integrated."""

SCALES = {"p": 1 / DELTA, "V": 2 * np.pi * DELTA**3}
"""Factors from the numbers of circular."""


def axisymmetric(solutions: Solutions) -> Finding:
    """Pressure and volume of the disk at three heights, and its limit point."""
    found = []
    for height in HEIGHTS:
        for name, factor in SCALES.items():
            ours = solutions.number(DISK, At("w_c", height), name)
            theirs = factor * solutions.number(REVOLVED, At("t0", height / DELTA), name)
            found.append(decide.agree(f"{name} at w_c = {height:g}", ours, theirs, ASKED))
    for name, other, factor in (("p", "p", SCALES["p"]), ("w_c", "t0", DELTA), ("V", "V", SCALES["V"])):
        ours = solutions.point(DISK, "limit_point", name)
        theirs = factor * solutions.point(REVOLVED, "limit_point", other)
        found.append(decide.agree(f"{name} of the limit point", ours, theirs, ASKED))
    return decide.all_of(found)


def polygon(solutions: Solutions) -> Finding:
    """Pressure and volume on a polygon with elements of degree 1: within their uncertainties."""
    found = []
    for name, factor in SCALES.items():
        ours = solutions.number(POLYGON, At("w_c", HEIGHTS[1]), name)
        theirs = factor * solutions.number(REVOLVED, At("t0", HEIGHTS[1] / DELTA), name)
        found.append(decide.agree(f"{name} of the polygon", ours, theirs, STRAIGHT))
    return decide.all_of(found)


def work(solutions: Solutions) -> Finding:
    """DU = p dV by polynomials over the height of the centre."""
    ats = [At("w_c", float(w)) for w in NODES]
    p, volume, stored = (solutions.numbers(DISK, ats, name) for name in ("p", "V", "U"))
    exact = decide.work(NODES, p.value, volume.value)
    return decide.agree("work of the gas", stored[-1] - stored[0], exact, ASKED)


CASE = Case(
    title="Membranes of any shape: a disk and a square without their symmetries",
    source="Patil (2016), section 6.4 (future work)",
    panels=(
        Panel(
            "gas",
            x=Axis("w_c", 0, 1.6, "$w_c$"),
            y=Axis("p", 0, 4, "$p$"),
            markers="limit_point",
            note="Not a figure of the thesis.",
            curves=(
                Curve(SQUARE, "square", reference="rectangle_gas_neo_hookean"),
                Curve(DISK, "disk"),
            ),
        ),
        Panel(
            "kirchhoff",
            x=Axis("w_c", 0, 0.8, "$w_c$"),
            y=Axis("p", 0, 1.4, "$p$"),
            note="Not a figure of the thesis. Pressures are over E h/a.",
            curves=(Curve(KIRCHHOFF, "square, Saint Venant and Kirchhoff", reference="square_kirchhoff"),),
        ),
    ),
    checks=(
        Count("limit_point", {SQUARE: 1, DISK: 1, ADAPTED: 1}, "number of limit pressures up to w_end"),
        Points(
            "limit_point", "rectangle_gas_limit", SQUARE, (), dict.fromkeys(("p", "w_c", "V", "U"), ASKED)
        ),
        Points(
            "limit_point", "rectangle_gas_limit", ADAPTED, (), dict.fromkeys(("p", "w_c", "V", "U"), ASKED)
        ),
        Points(
            "mass_fold",
            "rectangle_gas_mass_fold",
            FILLED,
            (),
            {"m": ASKED, **dict.fromkeys(("p", "w_c", "V", "U"), FLAT)},
        ),
        Claim(
            "axisymmetric",
            "a disk of curved triangles has the states of the axisymmetric problem",
            (
                *((DISK, At("w_c", h)) for h in HEIGHTS),
                *((REVOLVED, At("t0", h / DELTA)) for h in HEIGHTS),
            ),
            axisymmetric,
        ),
        Claim(
            "polygon",
            "straight triangles of degree 1 agree within their uncertainties",
            ((POLYGON, At("w_c", HEIGHTS[1])), (REVOLVED, At("t0", HEIGHTS[1] / DELTA))),
            polygon,
        ),
        Claim(
            "work",
            "the work of the gas is the change of strain energy",
            tuple((DISK, At("w_c", float(w))) for w in NODES),
            work,
        ),
    ),
    asked=dict.fromkeys(("p", "V", "U"), ASKED),
    slow=True,
)
