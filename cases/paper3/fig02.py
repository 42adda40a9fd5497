"""Paper 3, figure 2: mid-height radius against fluid level, for two aspect ratios and three pre-stretches.

The level has a maximum along the branch, so that the curves are compared over the volume, which rises along
the whole branch. Dashed parts are unstable under level control to axisymmetric perturbations.
"""

from weakforms.cases import (
    Axis,
    Case,
    Claim,
    Curve,
    CutOff,
    Finding,
    Panel,
    PrintedExact,
    Solutions,
    Spec,
    decide,
    fluid_tube,
)

LENGTHS, STRETCHES = (8, 24), (1.5, 2, 3)
TUBES = {(length, d): fluid_tube(L=length, delta=d, gamma=0.116) for length in LENGTHS for d in STRETCHES}
BENT = {key: fluid_tube(L=key[0], delta=key[1], secondary=True) for key in TUBES}
BENT[24, 1.5] = BENT[24, 1.5].on(levels=2, secondary_levels=2, secondary_cells=12, secondary_end=0.94)
"""On a coarse mesh, because its dry part is slightly compressed: see case ``compressed``."""
COARSE = {"V": 2e-2, "r_mid": 2e-2, "r_mid_pi": 5e-2}
EVERY = tuple((tube, None) for tube in TUBES.values())
BOTH = ("limit_point", "bifurcation_point")

SIDES = ("0", "pi")
BENT_ASKED = {
    **dict.fromkeys(("V", "r_mid", "r_mid_pi"), 1e-5),
    **{f"{name}_quarter_{side}": 2e-5 for name in "xz" for side in SIDES},
    **{f"{name}_quarter_{side}": 1e-4 for name in ("T1", "T2") for side in SIDES},
    "Pi": 1e-6,
}
"""Accuracy asked of the secondary branch on the whole surface; case ``secondary`` checks its eigenvalues."""


def first(solutions: Solutions, tube: Spec, kind: str, name: str) -> decide.Number:
    """A column at the first special point of a kind (of one wave, for bifurcations)."""
    points = [p for p in solutions.points(tube, kind) if p.values.get("n", 1) == 1]
    return decide.of_point(points[0], name)


def limit_first(solutions: Solutions) -> Finding:
    """Volumes at the limit point and at the first bifurcation."""
    return decide.all_of(
        decide.less(
            f"V, L = {key[0]}, delta = {key[1]}", *(first(solutions, tube, kind, "V") for kind in BOTH)
        )
        for key, tube in TUBES.items()
    )


def filled_or_not(solutions: Solutions) -> Finding:
    """Limit levels against the length."""
    found = []
    for (length, d), tube in TUBES.items():
        level = first(solutions, tube, "limit_point", "zw")
        sides = (length, level) if length == LENGTHS[0] else (level, length)
        found.append(decide.less(f"L = {length}, delta = {d}: length and level", *sides))
    return decide.all_of(found)


def one_maximum(solutions: Solutions) -> Finding:
    """The level rises, then falls; the volume always rises."""
    found = []
    for tube in TUBES.values():
        level, volume = (solutions.along(tube, name) for name in ("zw", "V"))
        before, behind = decide.sides(volume, first(solutions, tube, "limit_point", "V"))
        found += [
            decide.rises("zw before the limit point", level[before]),
            decide.falls("zw after it", level[behind]),
            decide.rises("V", volume),
        ]
    return decide.all_of(found)


CASE = Case(
    title="Response diagrams: mid-height radius against fluid level",
    source="Patil, Nordmark & Eriksson (2015), figure 2",
    panels=tuple(
        Panel(
            name,
            x=Axis("zw", 0, 10),
            y=Axis("r_mid", low, high),
            title=rf"$L/A = {length}$",
            markers=BOTH,
            note="The text does not give the printed axes; the ranges are chosen here.",
            curves=tuple(
                Curve(TUBES[length, d], rf"$\delta = {d}$", reference=f"primary_L_{length}_delta_{d}")
                for d in STRETCHES
            )
            + tuple(
                Curve(
                    BENT[length, d],
                    rf"$\delta = {d}$, secondary",
                    reference=f"secondary_L_{length}_delta_{d}",
                    branch="secondary",
                    asked=COARSE if (length, d) == (24, 1.5) else BENT_ASKED,
                )
                for d in STRETCHES
            ),
        )
        for name, length, low, high in (("a", 8, 0.5, 4), ("b", 24, 0.5, 1.4))
    ),
    checks=(
        Claim(
            "limit_first",
            "for these pre-stretches the limit point comes before the first bifurcation on the branch",
            EVERY,
            limit_first,
        ),
        Claim(
            "filled_or_not",
            "L/A = 8: the limit point is reached over-filled (zw > L); L/A = 24: partially filled (zw < L)",
            EVERY,
            filled_or_not,
        ),
        Claim(
            "one_maximum",
            "the level has exactly one maximum on the primary branch, the volume none",
            EVERY,
            one_maximum,
        ),
        PrintedExact(
            "rho g A^2/(mu H)",
            "0.1160",
            exact=1000 * 9.81 * 0.02**2 / (0.4225e6 * 0.08e-3),
            evidence="the printed A, H, mu and water give 3.924/33.8 = 0.116095; "
            "all figures are computed with 0.116",
            source="captions of figures 2 and 3",
            reading=CutOff(),
        ),
    ),
    asked={
        "zw": 5e-10,
        "r_mid": 5e-9,
        "r_max": 1e-7,
        "Pi": 5e-10,
        "T1_ring": 1e-5,
        "T2_ring": 1e-5,
        "T1_mid": 1e-5,
        "T2_mid": 1e-4,
    },
)
