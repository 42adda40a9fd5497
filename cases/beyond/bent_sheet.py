"""A stretched sheet that is bent in its plane: the band of wrinkles along its inner edge.

Stein & Hedgepeth (1961) gave the band and the curvature over the moment for small strains. Here the strains
are finite: guides along both long edges bend the sheet into a part of a ring, and the lines of tension of the
wrinkled band are radial. Two other methods give the numbers, and the closed form is their limit.
"""

from numpy.polynomial import Polynomial

from weakforms.cases import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, States, decide, sheet

MESH = {"cells": 32, "levels": 3, "step": 0.2}
TWO = {"cells": 32, "levels": 2, "step": 0.2}
GIVEN = {"loading": "bend", "c": 0.25}
LONG = sheet(**GIVEN, lam0=1.1, s=1.0, kap_end=1.0).on(**MESH)
WIDE = sheet(**GIVEN, lam0=1.2, s=1.2, kap_end=1.0).on(**MESH)
FULL = sheet(**GIVEN, lam0=1.1, s=1.0, kap_end=1.0, energy="full").on(cells=8, levels=3, step=0.2)

STRAINS = (0.005, 0.01, 0.02)
"""Strains with which a sheet is stretched in both directions before it is bent."""

SMALL = {
    strain: sheet(**GIVEN, alpha=0.0, lam0=1 + strain, s=1 + strain, kap_end=10 * strain).on(**TWO)
    for strain in STRAINS
}

BENDINGS = (6.0, 9.0)
"""Curvatures over that strain; wrinkling begins at 4."""

YOUNG = 6.0
"""Young's modulus at rest, over C1."""


def limit(found: list[decide.Number]) -> decide.Number:
    """A number at vanishing strain by the parabola through three strains; the line through two judges it."""
    values = [x.value for x in found]
    all_of, fewer = (Polynomial.fit(STRAINS[:n], values[:n], n - 1)(0.0) for n in (3, 2))
    return decide.Number(all_of, abs(all_of - fewer)) + decide.Number(0.0, max(x.uncertainty for x in found))


def stein_and_hedgepeth(solutions: Solutions) -> Finding:
    """Band and curvature over the moment at vanishing strain, beside their closed forms."""
    found = []
    for bending in BENDINGS:
        bands, curvatures = [], []
        for strain, spec in SMALL.items():
            at = At("kap", bending * strain)
            force, moment, band = (solutions.number(spec, at, name) for name in ("T_x", "M", "f_w"))
            bands.append(band - (3 * moment / force - 0.5))
            curvatures.append(YOUNG * at.value / (2 * force) * 9 / 4 * (1 - 2 * moment / force) ** 2)
        times = f"kap = {bending:g} strains"
        found += [
            decide.zero(f"band less 3 M/(P h) - 1/2, {times}", limit(bands), 0.05),
            decide.agree(f"E t h^2 kap/(2 P) (1 - 2 M/(P h))^2 9/4, {times}", limit(curvatures), 1.0, 2e-3),
        ]
    return decide.all_of(*found)


def bears(solutions: Solutions) -> Finding:
    """At a curvature of 0.8 the sheet that bears compression needs a larger moment."""
    at = At("kap", 0.8)
    relaxed, full = (solutions.number(spec, at, "M") for spec in (LONG, FULL))
    pulled, held = (solutions.number(spec, at, "T_x") for spec in (LONG, FULL))
    return decide.all_of(
        decide.less("moment, relaxed and full", relaxed, full),
        decide.less("force, full and relaxed", held, pulled),
    )


CASE = Case(
    title="Bending of a stretched sheet in its plane",
    source="Stein & Hedgepeth (1961), at finite strains",
    panels=tuple(
        Panel(
            name,
            x=Axis("kap", 0, 1),
            y=Axis(column, 0, top),
            title=title,
            note="Not a figure of the thesis.",
            curves=(
                Curve(LONG, r"$\lambda_0 = 1.1,\ s = 1$", "bent_sheet"),
                Curve(WIDE, r"$\lambda_0 = s = 1.2$", "bent_sheet_wide"),
            ),
        )
        for name, column, top, title in (
            ("moment", "M", 0.6, "moment"),
            ("force", "T_x", 2, "mean stress along the sheet"),
            ("band", "f_w", 0.4, "wrinkled band"),
        )
    ),
    checks=(
        States(
            "bent_sheet_onset",
            LONG,
            ("lam0", "s"),
            At("S_least", 0.0),
            {"kap": 1e-3},
        ),
        Claim(
            "stein_and_hedgepeth",
            "at vanishing strain band and curvature over the moment are those of Stein & Hedgepeth",
            tuple((spec, At("kap", b * strain)) for strain, spec in SMALL.items() for b in BENDINGS),
            stein_and_hedgepeth,
        ),
        Claim(
            "bears",
            "a sheet that bears compression needs a larger moment and a smaller force to be bent as far",
            tuple((spec, At("kap", 0.8)) for spec in (LONG, FULL)),
            bears,
        ),
    ),
    asked={"T_x": 1e-3, "M": 1e-3, "f_w": 0.2},
    slow=True,
)
