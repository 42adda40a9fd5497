"""What is said of the problem ``membrane``."""

from weakforms.problems import column
from weakforms.problems.about import About, Example, Family
from weakforms.problems.column import Column, Units, derived, numbers

MEMBRANE = About(
    name="membrane",
    title="Membrane of any shape on the user's triangles under gas or a liquid",
    paper="beyond",
    source="Patil (2016), section 6.4, future work",
    energy="Pi/(C1 h a^2) = int H W(C) dA - p V,  V = int z N_z dA less that of the reference surface "
    "stretched by delta, or under a liquid - int gamma max(zw - z, 0)^2/2 N_z dA alike for - p V;  "
    "W = I1 - 3 + alpha (I2 - 3) where taut, and with energy = relaxed lam1^2 + 2/lam1 - 3 + "
    "alpha (2 lam1 + 1/lam1^2 - 3) where wrinkled, 0 where slack; or another model w "
    "and w(lam1, n(lam1)) with its natural width n, its S for C1",
    control="p (load = gas; compare over V, which increases past limit points) or zw (liquid; over w_c)",
    unknown="the displacement from the reference surface stretched by delta, zero on held edges, zero across "
    "planes of symmetry and planes in which edges slide",
    forms=("forms.relaxed_surface:relaxed_energy", "forms.relaxed_surface:pressure_potential"),
    units=Units("a", "C1", "h"),
    columns=(
        column.PRESSURE,
        Column("zw", "level of the liquid, in the coordinate Z, over {length}", "z_w"),
        Column(
            "w_c",
            "deflection along the normal at the point (X_c, Y_c, Z_c) over {length}; against it for a liquid",
            "w_c",
        ),
        Column("V", "volume between the membrane and its stretched reference surface over {volume}", "V"),
        Column("V_f", "liquid over the membrane between vertical walls over {volume}", "V_f"),
        column.POTENTIAL,
        Column("U", "strain energy over {energy}", "U"),
        Column(
            "u_far",
            "displacement of the farthest sliding corner towards (X_c, Y_c, Z_c) over {length}; absent if no "
            "edges slide",
        ),
        *derived(
            *numbers(
                f_w="wrinkled part of the reference area",
                f_s="slack part of the reference area",
            ),
            Column("w_max", "largest deflection in the direction of w_c over {length}"),
            *numbers(
                S_least="least principal second Piola-Kirchhoff stress of the full energy at the points of "
                "quadrature, over {stress}; negative where the membrane would be compressed",
            ),
            *(Column(f"{x}_least", f"{x} of that stress over {{length}}") for x in "XYZ"),
            *numbers(
                n_held="negative eigenvalues, the volume of the gas or liquid held",
                n_fixed_m="the same, the mass of the gas held",
            ),
            column.MASS,
        ),
        *column.DIAGNOSTICS,
    ),
    numbers=(
        *numbers(
            length="a: unit of the file; disk: radius, square: half the side of the stress-free sheet",
            alpha="C2/C1",
            gamma="rho g a^2/(C1 h)",
            delta="stretch of the supports about the centroid, or about a point on the planes of symmetry",
            X_c="X of the point where a shallow sheet rises most over {length}, for w_c; Y_c, Z_c alike",
            eigenvalue_1="lowest eigenvalue of the second variation at fixed p against int |dx|^2 dA",
            a="row of the first corner of a triangle in the table of corners; b and c alike",
            state="of a triangle: 1 taut, 0 wrinkled, -1 slack",
            t_x="direction of the larger stretch of a triangle, deformed; t_y and t_z alike",
            lam1="larger principal stretch of a triangle, 1",
            lam2="smaller principal stretch of a triangle, 1",
        ),
        Column(
            "error",
            "of a triangle: root mean square of the difference between the stress resultants and continuous "
            "ones recovered from them, over {stress} h",
        ),
        column.OUTSIDE,
        column.RESERVOIR,
        *(Column(name, dimension="length") for name in ("Y_c", "Z_c", "X", "Y", "Z", "x", "y", "z")),
    ),
    special_points=("limit_point", "bifurcation_point", "volume_fold", "mass_fold"),
    example=Example("w_c", "p", {"mesh": "square", "alpha": 0.0}, numerics={"cells": 8}),
    tuned=(
        Family(
            {"alpha": (0.0, 0.1), "delta": (1.05, 1.4)},
            {"cells": 8},
            {"cells": 24, "levels": 2},
            fixed={"mesh": "disk"},
            at=(("w_c", 0.4), ("w_c", 0.9)),
        ),
    ),
    held_out=(
        Family(
            {"alpha": (0.0, 0.1), "gamma": (0.5, 6.0)},
            {"cells": 8},
            {"cells": 24, "levels": 2},
            fixed={"mesh": "disk", "load": "liquid"},
            at=(("w_c", 0.4), ("w_c", 0.9)),
            label="liquid",
        ),
    ),
    audit_numerics={"cells": 8},
)
