"""What is said of the problem ``sheet``."""

from weakforms.problems import column
from weakforms.problems.about import About, Example, Family
from weakforms.problems.column import Column, Units, numbers

SMALL, LARGE = {"cells": 4, "levels": 2}, {"cells": 8, "levels": 2}
"""Coarse and fine meshes of the families."""

SHEET = About(
    name="sheet",
    title="Flat sheet that is sheared, stretched or bent in its plane",
    paper="beyond",
    source="Wagner (1929); Stein & Hedgepeth (1961); benchmarks of tension-field theory",
    energy="Pi/(C1 h a^2) = int W(C) dA over [0, c] x [0, 1];  W = I1 - 3 + alpha (I2 - 3) where taut, and "
    "with energy = relaxed lam1^2 + 2/lam1 - 3 + alpha (2 lam1 + 1/lam1^2 - 3) where wrinkled, 0 where "
    "slack; or another model w and w(lam1, n(lam1)) with its natural width n, its S for C1",
    control="gam (loading = shear), lam (loading = stretch, strip) or kap (loading = bend)",
    unknown="the displacement in the plane from (lam X + gam Y, s Y), zero on all edges; of a strip, only "
    "across the ends X = 0 and X = c and across the axis Y = 0; of a bent sheet, the displacement along the "
    "arcs (zero on all edges) and across them (zero on the long edges)",
    forms=("forms.relaxed_surface:relaxed_energy", "forms.relaxed_surface:least_stress"),
    units=Units("a", "C1", "h"),
    columns=(
        Column("gam", "displacement of the edge Y = 1 along X over {length}: the shear", r"\gamma"),
        Column("lam", "stretch in X, 1", r"\lambda"),
        Column(
            "kap", "angle between the ends of a bent sheet over its length c, times {1/curvature}", r"\kappa"
        ),
        Column("tau", "mean nominal shear stress, of edges Y = const along X, over {stress}", r"\tau"),
        Column("T_x", "mean nominal stress in X, of a bent sheet along the arcs, over {stress}", "T_x"),
        Column("T_y", "mean nominal stress in Y over {stress}", "T_y"),
        Column("M", "moment of a bent sheet about the arc of the stretch lam0, over {energy}", "M"),
        column.POTENTIAL,
        *numbers(
            lam1="mean of the larger principal stretch, 1",
            lam2="mean of the smaller principal stretch, 1",
            S_least="mean of the least principal second Piola-Kirchhoff stress of the full energy, of a bent "
            "sheet at the inner edge, over {stress}; it is zero where wrinkling begins, and negative where "
            "the sheet would be compressed",
            f_w="wrinkled part of the reference area; absent for a strip, which is on the border",
            f_s="slack part of the reference area; absent for a strip",
        ),
        *column.DIAGNOSTICS,
    ),
    numbers=(
        *numbers(
            length="a, width of the stress-free sheet",
            alpha="C2/C1",
            c="length over width",
            s="stretch in Y of the edges; of a bent sheet, distance of its guides over {length}",
            lam0="stretch in X before a sheet is bent",
        ),
        Column("X", "X of a point of the diagonal, Y = X/c, over {length}", "X", dimension="length"),
        *(Column(name, dimension="length") for name in "xy"),
    ),
    special_points=("limit_point", "bifurcation_point"),
    example=Example("gam", "tau", {"s": 1.05}, numerics={"cells": 4, "levels": 2}),
    tuned=(
        Family(
            {"alpha": (0.0, 0.2), "s": (1.1, 1.3)},
            SMALL,
            LARGE,
            fixed={"gam_end": 0.8},
            at=(("gam", 0.3), ("gam", 0.7)),
        ),
    ),
    held_out=(
        Family(
            {"alpha": (0.0, 0.2), "s": (0.7, 1.3)},
            SMALL,
            LARGE,
            fixed={"loading": "stretch"},
            at=(("lam", 1.2), ("lam", 1.7)),
            label="stretched",
        ),
        Family(
            {"alpha": (0.0, 0.2), "s": (1.0, 1.3), "lam0": (1.05, 1.3)},
            {"cells": 8, "levels": 3},
            {"cells": 32, "levels": 2},
            fixed={"loading": "bend", "c": 0.5, "kap_end": 1.0},
            at=(("kap", 0.1), ("kap", 0.8)),
            label="bent",
        ),
    ),
    audit_numerics={"cells": 4, "levels": 2},
)
