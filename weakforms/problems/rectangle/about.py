"""What is said of the problem ``rectangle``."""

from weakforms.problems import column
from weakforms.problems.about import About, Example, Family
from weakforms.problems.column import Column, Units, derived, numbers

SMALL, LARGE = {"cells": 8}, {"cells": 24, "levels": 2}
"""Coarse and fine meshes of the families."""

RECTANGLE = About(
    name="rectangle",
    title="Framed rectangular membrane under gas or under a liquid",
    paper="beyond",
    source="Patil (2016), section 6.4, future work",
    energy="Pi/(C1 h a^2) = int W(C) dA - int phi(z) N_z dA over [-1, 1] x [-c, c],  "
    "phi = p z + gamma (max(zw - z, 0)^2 - max(zw, 0)^2)/2;  W = I1 - 3 + alpha (I2 - 3) where taut, and "
    "with energy = relaxed lam1^2 + 2/lam1 - 3 + alpha (2 lam1 + 1/lam1^2 - 3) where wrinkled, 0 where "
    "slack; or another model w and w(lam1, lam1^(-1/2)), its S for C1",
    control="p (load = gas) or zw (liquid); compare over w_c, which increases along the whole branch",
    unknown="the displacement (x - delta X, y - delta_y Y, z), zero on the edges",
    forms=("forms.relaxed_surface:relaxed_energy", "forms.relaxed_surface:pressure_potential"),
    units=Units("a", "C1", "h"),
    columns=(
        column.PRESSURE,
        Column("zw", "level of the liquid above the frame over {length}", "z_w"),
        Column("w_c", "height of the centre over {length}, down for a liquid", "w_c"),
        column.VOLUME,
        Column("V_f", "liquid over the sheet between vertical walls over {volume}", "V_f"),
        column.POTENTIAL,
        Column("U", "strain energy over {energy}", "U"),
        *derived(
            *numbers(
                lam1_c="larger stretch at the centre, 1",
                S_least="least principal second Piola-Kirchhoff stress of the full energy at the points of "
                "quadrature, over {stress}; negative where the sheet would be compressed",
                f_w="wrinkled part of the reference area",
                f_s="slack part of the reference area",
                n_odd_even="negative eigenvalues in the class with z odd in X and even in Y",
                n_even_odd="the same, z even in X and odd in Y; on a square equal to n_odd_even",
                n_odd_odd="the same, z odd in X and in Y",
                n_all="negative eigenvalues of the whole tangent, all classes, the load held",
                n_held="the same, the volume of the gas or liquid held",
                n_fixed_m="the same, the mass of the gas held",
                n_A1="of a square: negative eigenvalues in class A1 of the group C4v, that of the states; "
                "class E is the pair odd_even, even_odd",
                n_A2="the same in A2, odd in both mirrors and in the diagonals",
                n_B1="the same in B1, even in both mirrors and odd in the diagonals",
                n_B2="the same in B2, odd in both mirrors and even in the diagonals",
            )
        ),
        *derived(column.MASS),
        Column("X_least", "X of that stress over {length}, on the quarter", derived=True, dimension="length"),
        Column("Y_least", "Y of that stress over {length}, on the quarter", derived=True, dimension="length"),
        *column.DIAGNOSTICS,
    ),
    numbers=(
        *numbers(
            length="a, half the short side of the stress-free sheet",
            alpha="C2/C1",
            gamma="rho g a^2/(C1 h)",
            delta="pre-stretch in X",
            delta_y="pre-stretch in Y",
            c="long side over short side",
            Y="of a corner of a triangle: its place in the stress-free sheet, with X",
            a="row of the first corner of a triangle in the table of corners; b and c alike",
            state="of a triangle: 1 taut, 0 wrinkled, -1 slack",
            t_x="direction of the larger stretch of a triangle, deformed; t_y and t_z alike",
            n="class of the critical mode: 0 both mirrors, 1 z odd in X, 2 z odd in Y, 3 odd in both",
            eigenvalue_A1="lowest eigenvalue of the second variation in class A1 of a square at fixed load "
            "against int |dx|^2 dA, of a state; A2, B1, B2 and E alike",
            C4v="class of the critical mode of a square: 1 A1, 2 A2, 3 B1, 4 B2, 5 the pair E",
        ),
        column.OUTSIDE,
        column.RESERVOIR,
        *(Column(f"eigenvalue_{name}") for name in ("A2", "B1", "B2", "E")),
        Column("X", "X of a point of the diagonal, Y = c X", "X", dimension="length"),
        *(Column(name, dimension="length") for name in "xyz"),
        Column("lam1", "larger principal stretch, 1", r"\lambda_1"),
        Column("lam2", "smaller principal stretch, 1", r"\lambda_2"),
    ),
    special_points=("limit_point", "bifurcation_point", "volume_fold", "mass_fold"),
    example=Example("w_c", "zw", {"gamma": 1.0}, numerics={"cells": 8}),
    tuned=(
        Family(
            {"alpha": (0.0, 0.1), "delta": (1.05, 1.4)},
            SMALL,
            LARGE,
            fixed={"load": "gas", "w_end": 1.2},
            at=(("w_c", 0.4), ("w_c", 1.0)),
            label="gas",
        ),
    ),
    held_out=(
        Family(
            {"alpha": (0.0, 0.1), "gamma": (0.5, 6.0)},
            SMALL,
            LARGE,
            fixed={"w_end": 1.2},
            at=(("w_c", 0.4), ("w_c", 1.0)),
            label="liquid",
        ),
    ),
    audit_numerics={"cells": 8},
)
