"""The framed square sheet under gas and under liquids of two weights, against spectral methods.

No figure of the thesis belongs to this problem: it is the first item of its future work. The references are
states and limit loads by collocation and by Galerkin's method with Legendre polynomials.
"""

from weakforms.cases import Axis, Case, Count, Curve, Panel, Points, Spec, rectangle

FINE = {"cells": 24}
"""Meshes on which all columns of smooth taut states are known to 1e-5."""

GAS, GAS_NEO_HOOKEAN = (rectangle(load="gas", alpha=alpha).on(**FINE) for alpha in (0.1, 0.0))
LIGHT, LIGHT_NEO_HOOKEAN = (
    rectangle(gamma=1, alpha=a, w_end=e).on(**FINE) for a, e in ((0.1, 2.0), (0.0, 1.8))
)
FILLED = rectangle(load="gas", alpha=0.0, kappa=1.4, p_atm=0.5, V_r=60.0, w_end=1.8).on(**FINE)
"""Neo-Hookean with a large reservoir: a given mass of gas is not enough for stability beyond its fold."""

HEAVY = rectangle(gamma=5, w_end=1.2).on(**FINE)
TAUT = 1e-5
"""Asked of smooth taut states at degree 2."""

BY_CLASS = {f"eigenvalue_{name}": 1e-4 for name in ("A1", "A2", "B1", "B2", "E")}
"""Asked of eigenvalues in each class of C4v, most of them of modes that are shorter than the sheet."""

PLACE = 5e-5
"""Asked of all but the volume itself where it is largest: an extremum is flat, its place has fewer digits."""

PARTLY_WET, ITS_PLACE = 1e-3, 5e-3
"""Asked of the level where it lies below the frame, and of the place of its minimum: the edge of the wet part
crosses the elements of our meshes, and the polynomials of the reference."""


def points(kind: str, table: str, spec: Spec, asked: dict[str, float]) -> Points:
    """One special point."""
    return Points(kind, table, spec, (), asked)


def limit(table: str, spec: Spec, load: str = "zw", amount: str = "V_f") -> Points:
    """A limit load of a smooth taut state."""
    return points("limit_point", table, spec, dict.fromkeys((load, "w_c", amount, "U"), TAUT))


CASE = Case(
    title="Square sheet under gas and under liquid",
    source="Patil (2016), section 6.4 (future work)",
    panels=(
        Panel(
            "gas",
            x=Axis("w_c", 0, 1.6, "$w_c$"),
            y=Axis("p", 0, 4, "$p$"),
            markers="limit_point",
            note="Not a figure of the thesis.",
            curves=(
                Curve(GAS_NEO_HOOKEAN, r"$\alpha = 0$", reference="rectangle_gas_neo_hookean"),
                Curve(GAS, r"$\alpha = 0.1$", reference="rectangle_gas"),
            ),
        ),
        Panel(
            "liquid",
            x=Axis("w_c", 0, 2.0, "$w_c$"),
            y=Axis("zw", -0.2, 4, "$z_w$"),
            markers="limit_point",
            curves=(
                Curve(LIGHT, r"$\gamma = 1$", reference="rectangle_liquid"),
                Curve(LIGHT_NEO_HOOKEAN, r"$\gamma = 1$, neo-Hookean"),
                Curve(HEAVY, r"$\gamma = 5$", reference="rectangle_heavy"),
            ),
        ),
    ),
    checks=(
        Curve(GAS_NEO_HOOKEAN, "eigenvalues by class", reference="rectangle_gas_classes", asked=BY_CLASS),
        Count(
            "limit_point",
            {GAS_NEO_HOOKEAN: 1, GAS: 0, LIGHT: 1, LIGHT_NEO_HOOKEAN: 1, HEAVY: 2},
            "number of limit loads up to w_end",
        ),
        Count("mass_fold", {FILLED: 1, GAS: 0}, "number of folds of the mass of gas"),
        Count("volume_fold", {LIGHT_NEO_HOOKEAN: 1, LIGHT: 0, HEAVY: 0}, "number of folds of the volume"),
        limit("rectangle_gas_limit", GAS_NEO_HOOKEAN, "p", "V"),
        limit("rectangle_liquid_limit", LIGHT),
        limit("rectangle_liquid_limit_neo_hookean", LIGHT_NEO_HOOKEAN),
        limit("rectangle_heavy_upper", HEAVY),
        points(
            "volume_fold",
            "rectangle_liquid_fold_neo_hookean",
            LIGHT_NEO_HOOKEAN,
            {"V_f": TAUT, "zw": PLACE, "w_c": PLACE, "U": PLACE},
        ),
        points(
            "mass_fold",
            "rectangle_gas_mass_fold",
            FILLED,
            {"m": TAUT, "p": PLACE, "w_c": PLACE, "V": PLACE, "U": PLACE},
        ),
        points(
            "limit_point",
            "rectangle_heavy_lower",
            HEAVY,
            {"zw": PARTLY_WET, "w_c": ITS_PLACE, "V_f": ITS_PLACE, "U": ITS_PLACE},
        ),
    ),
    asked=dict.fromkeys(("p", "zw", "V", "V_f", "U"), TAUT),
    slow=True,
)
