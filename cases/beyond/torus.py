"""The inflated torus: pressure over volume, limit point and meridian, against two other methods.

A torus of circular cross-section is the benchmark of a closed membrane whose linear theory fails: without
pressure it bends freely along its highest and lowest circles. It has one limit point and is taut everywhere.
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
    Spec,
    decide,
    torus,
)

USUAL = torus(b=0.4, alpha=0.0, v_end=4.2)
SLENDER = torus(b=0.2, v_end=4.2)
THICK = torus(b=0.6)
TORI = {"usual": USUAL, "slender": SLENDER, "thick": THICK}
STATE = At("V", 6.316547, profile=())
"""Twice the volume without stress."""

WAVES = torus(n=(0, 1, 2, 3)).on(degree=5, cells=32, levels=2, step=0.15)
"""With stability; tori as in the table of bifurcation points."""


def waves(b: float, alpha: float, v_end: float) -> Spec:
    """One torus with its stability."""
    return WAVES.at(b=b, alpha=alpha, v_end=v_end)


SWELLS, NARROW = waves(0.4, 0.0, 4.2), waves(0.2, 0.1, 5.2)
STIFF, STIFFER = waves(0.4, 0.1, 5.2), waves(0.4, 0.2, 7.2)
EVEN = {n: f"bifurcation_n{n}" for n in (1, 2, 3)}
FOUND = {SWELLS: (1, 2), NARROW: (1, 2, 3), STIFF: (1,), STIFFER: ()}
"""Wave numbers of the bifurcation points of each torus, in the order of their volumes."""

PRESSURE = tuple(f"n_negative_n{n}" for n in range(4))
VOLUME = ("n_negative_volume", *PRESSURE[1:])

ASKED = 1e-7
OUTER = 1.7 + 0.2 * np.cos(np.pi * np.arange(10, -1, -1) / 10)
"""Outer radii of the usual torus between which the work of the gas is integrated."""


def taut(solutions: Solutions) -> Finding:
    """Both resultants along the meridian, at two volumes of each torus."""
    found = []
    for name, spec in TORI.items():
        for at in states(name):
            for resultant in ("t1", "t2"):
                values = solutions.column(spec, at, resultant)
                found.append(decide.positive(f"{resultant} of the {name} torus", values))
    return decide.all_of(*found)


def states(name: str) -> tuple[At, ...]:
    """States of one torus at which its resultants are looked at."""
    radii = {"usual": (1.45, 1.9), "slender": (1.25, 1.55), "thick": (1.65, 2.2)}[name]
    return tuple(At("r_out", radius, profile=()) for radius in radii)


def work(solutions: Solutions) -> Finding:
    """The energy changes by the integral of p dV, by polynomials over the outer radius."""
    ats = [At("r_out", float(r)) for r in OUTER]
    p, volume, stored = (solutions.numbers(USUAL, ats, name) for name in ("p", "V", "U"))
    exact = decide.work(OUTER, p.value, volume.value)
    return decide.agree("work of the gas", stored[-1] - stored[0], exact, 1e-6)


def order(solutions: Solutions) -> Finding:
    """The limit point comes first, then bifurcations by their wave numbers."""
    return decide.all_of(
        *(
            decide.less(
                f"V of special points, {spec}",
                solutions.point(spec, "limit_point", "V"),
                *(solutions.point(spec, EVEN[n], "V") for n in found),
            )
            for spec, found in FOUND.items()
            if found
        )
    )


def counts(solutions: Solutions) -> Finding:
    """Numbers of negative eigenvalues along the branches, with growing volume; waves count once."""
    found = []
    for spec, numbers in FOUND.items():
        columns = solutions.branch(spec).columns
        for held, names, more in (("pressure", PRESSURE, 1), ("volume", VOLUME, 0)):
            runs = decide.runs(sum(columns[name] for name in names))
            found.append(decide.same(f"{spec}, {held} held", runs, list(range(len(numbers) + more + 1))))
    return decide.all_of(*found)


def lowest(spec: Spec, table: str) -> tuple[Curve, ...]:
    """The lowest eigenvalue for one wave, with its table, and for two and three."""
    more = (Curve(spec, rf"$n = {n}$", y=f"Lambda_n{n}_1") for n in (2, 3))
    return Curve(spec, r"$n = 1$", reference=table), *more


CASE = Case(
    title="Inflation of a torus",
    source="a benchmark of codes for membranes: the toroidal membrane",
    panels=(
        Panel(
            "pressure",
            x=Axis("V", 0, 13),
            y=Axis("p", 0, 10),
            markers="limit_point",
            note="Not a figure of the thesis.",
            curves=(
                Curve(USUAL, r"$b = 0.4,\ \alpha = 0$", reference="torus"),
                Curve(SLENDER, r"$b = 0.2,\ \alpha = 0.1$", reference="torus_slender"),
            ),
        ),
        Panel(
            "meridian",
            x=Axis("t", 0, 3.1416),
            y=Axis("lam1", 1.2, 1.6),
            note="Twice the volume without stress.",
            curves=(Curve(USUAL, r"$b = 0.4,\ \alpha = 0$", reference="torus_meridian", at=STATE, y="lam1"),),
        ),
        Panel(
            "held_volume",
            x=Axis("V", 3, 16),
            y=Axis("p", 0, 5),
            title="volume held",
            markers=("limit_point", *EVEN.values()),
            counted=VOLUME,
            note="Lines by the number of negative eigenvalues.",
            curves=(
                Curve(SWELLS, r"$b = 0.4,\ \alpha = 0$"),
                Curve(STIFF, r"$b = 0.4,\ \alpha = 0.1$"),
            ),
        ),
        Panel(
            "eigenvalues",
            x=Axis("V", 3, 13),
            y=Axis("Lambda_n1_1", -3, 7, r"$\Lambda$"),
            title="lowest eigenvalue for one, two and three waves around",
            note="Not a figure of the thesis.",
            curves=lowest(SWELLS, "torus_eigenvalues"),
        ),
        Panel(
            "slender_eigenvalues",
            x=Axis("V", 0.8, 4.2),
            y=Axis("Lambda_n1_1", -6, 5, r"$\Lambda$"),
            title="lowest eigenvalue of a slender torus, for one, two and three waves",
            note="Not a figure of the thesis.",
            curves=lowest(NARROW, "torus_slender_eigenvalues"),
        ),
    ),
    checks=(
        Count("limit_point", dict.fromkeys(TORI.values(), 1), "number of limit points"),
        Points("limit_point", "torus_limit", USUAL, (), dict.fromkeys(("p", "V", "r_out", "U"), ASKED)),
        Points(
            "limit_point", "torus_slender_limit", SLENDER, (), dict.fromkeys(("p", "V", "r_out", "U"), ASKED)
        ),
        Claim(
            "taut",
            "a torus is taut everywhere, before and after its limit point",
            tuple((spec, at) for name, spec in TORI.items() for at in states(name)),
            taut,
        ),
        *(
            Points(
                kind,
                "torus_waves",
                WAVES,
                ("b", "alpha", "v_end"),
                dict.fromkeys(("p", "V", "r_out"), ASKED),
                {"n": float(n), "parity": 1.0},
            )
            for n, kind in EVEN.items()
        ),
        *(
            Count(kind, {spec: int(n in found) for spec, found in FOUND.items()}, f"n = {n}")
            for n, kind in EVEN.items()
        ),
        Count("mirror_breaking", dict.fromkeys(FOUND, 0), "axisymmetric waves, odd"),
        Claim(
            "order",
            "a torus loses its axial symmetry only beyond its limit point, to fewer waves first",
            tuple((spec, None) for spec, found in FOUND.items() if found),
            order,
        ),
        Claim(
            "counts",
            "negative eigenvalues along the branches, at given pressure and at given volume",
            tuple((spec, None) for spec in FOUND),
            counts,
        ),
        Claim(
            "work",
            "the work of the gas is the change of strain energy",
            tuple((USUAL, At("r_out", float(r))) for r in OUTER),
            work,
        ),
    ),
    asked=dict.fromkeys(("p", "r_out", "r_in", "U", "virial", "r", "z"), ASKED)
    | {"z_top": ASKED, "lam1": 1e-6, "lam2": 1e-6}
    | {f"Lambda_n{n}_1": ASKED for n in range(4)},
    slow=True,
)
