"""What is said of the problem ``torus``."""

from weakforms.problems import column
from weakforms.problems.about import LINE, About, Example, Family
from weakforms.problems.column import Column, Units, derived, numbers
from weakforms.problems.wave_numbers import count_columns, eigenvalue_columns

MOST_WAVES = 6
"""Largest wave number for which the stability of a torus is computed."""

BIFURCATIONS = ("mirror_breaking", *(f"bifurcation_n{n}" for n in range(1, MOST_WAVES + 1)))
"""Kinds of special points where an eigenvalue of waves is zero."""

TORUS = About(
    name="torus",
    title="Inflated torus of circular cross-section",
    paper="beyond",
    source="a benchmark of codes for membranes: the toroidal membrane",
    energy="Pi/(C1 h a^2) = int W(lam1, lam2) dA - p V,  R = 1 + b cos t, Z = b sin t without stress, "
    "lam1 = |(r', z')|/b, lam2 = r/R, dA = b R dt dTheta, V = pi oint r^2 z' dt;  "
    "W = I1 - 3 + alpha (I2 - 3), or another model w, its S for C1",
    control="p (compare over V, which increases past limit points)",
    unknown="r and z over the angle t of the cross-section, from the outer equator (t = 0) to the inner one "
    "(t = pi), where z = 0; the other half is the mirror image",
    forms=(
        "problems.meridian.model:MeridianModel",
        "forms.loads:gas_potential",
        "forms.revolution:around",
        "forms.revolution:strain_energy",
        "forms.revolution:gas_energy",
    ),
    units=Units("a", "C1", "h"),
    columns=(
        column.PRESSURE,
        column.VOLUME,
        Column("v", "volume over that of the stress-free torus", "v"),
        column.POTENTIAL,
        Column("U", "strain energy over {energy}", "U"),
        Column("r_out", "radius of the outer equator over {length}", r"r_\mathrm{out}"),
        Column("r_in", "radius of the inner equator over {length}", r"r_\mathrm{in}"),
        *derived(
            Column("z_top", "largest height over {length}", r"z_\mathrm{top}"),
            Column(
                "virial",
                "int (lam1 W_,1 + lam2 W_,2) dA over {energy}; 3 p V in equilibrium, because lengths scale",
            ),
        ),
        *eigenvalue_columns(MOST_WAVES, "int |dx|^2 dA, not moved as a rigid body", "whole torus"),
        *count_columns(MOST_WAVES, "whole torus"),
        *column.DIAGNOSTICS,
    ),
    numbers=(
        *numbers(
            length="a, radius of the centre line of the stress-free torus",
            b="radius of the cross-section over {length}",
            alpha="C2/C1",
            t="angle of the cross-section from the outer equator, in radians",
            eigenvalue_1="lowest eigenvalue of the second variation at fixed p against int |dx|^2 dA",
            n="wave number of a bifurcation point",
            parity="of a bifurcation point about the equatorial plane: 1 even, -1 odd",
            direction="1 if an eigenvalue becomes negative with growing volume, -1 if it becomes positive",
        ),
        Column("r", "distance from the axis over {length}", "r"),
        Column("z", "height over {length}", "z"),
        column.LAM1,
        column.LAM2,
        column.T1,
        column.T2,
    ),
    special_points=("limit_point", "bifurcation_point", *BIFURCATIONS),
    example=Example("V", "p", {"alpha": 0.0}, numerics={"cells": 16, "levels": 2}),
    tuned=(
        Family(
            {"b": (0.2, 0.5), "alpha": (0.0, 0.2)},
            **LINE,
            fixed={"v_end": 2.5},
            at=(("v", 1.8),),
        ),
    ),
)
