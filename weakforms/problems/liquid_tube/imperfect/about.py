"""What is said of the problem ``fluid_tube_imperfect``."""

from weakforms.problems import column
from weakforms.problems.about import About, Example, Family
from weakforms.problems.column import Column, Units, derived, numbers

FLUID_TUBE_IMPERFECT = About(
    name="fluid_tube_imperfect",
    title="Over-filled tube with tilted gravity or uneven thickness",
    paper="beyond",
    source="beyond Patil, Nordmark & Eriksson (2015), Proc. R. Soc. A 471, 20150016; Koiter (1945)",
    energy="Pi/(mu H A^2) = int_0^{L/delta} int_0^{2 pi} [ h (I1 - 3 + alpha (I2 - 3))/2 - gamma ((zw - "
    "z cos(tilt))/2 - x sin(tilt)/3) (x e_x + y e_y).N ] dTheta dZ,  h = 1 + uneven cos(n Theta),  "
    "N = x_Theta x x_Z;  the liquid wets all of the tube",
    control="zw (past its maximum compare over V, or over u_wave near a bifurcation)",
    unknown="the position over (Z, Theta), 0 <= Theta <= pi/n, held on both rings, between two mirrors",
    forms=("forms.fluid:strain_energy", "forms.fluid:normal"),
    units=Units("A", "mu", "H"),
    columns=(
        Column("zw", "static head over the lower disk's middle, along the vertical, over {length}", "z_w"),
        Column("V", "volume of the liquid over {volume}", "V"),
        Column("Pi", "total potential at fixed level over {energy}"),
        Column("r_mid", "radius at Z = L/(2 delta), Theta = 0 over {length}", "r_{mid}"),
        Column(
            "u_wave",
            "half the difference of the radii at Z = L/(2 delta), Theta = 0 and pi/n over {length}; of one "
            "wave the sideways displacement",
            "u_{wave}",
        ),
        *derived(*numbers(n_held="negative eigenvalues in the states' own symmetry, the volume held")),
        *column.DIAGNOSTICS,
    ),
    numbers=(
        *numbers(
            length="A, radius of the disks and of the stress-free tube",
            delta="axial pre-stretch, 1; the stress-free tube is L/delta long",
            gamma="rho g A^2/(mu H), H the mean thickness of the stress-free tube",
            mu="2 C1",
            alpha="second Mooney-Rivlin constant over the first; 0 is neo-Hookean",
            zw_2="at a bifurcation: zw - zw_c over u_wave^2 of the bent states, times A",
            V_2="V - V_c over u_wave^2, over A",
            A1="coefficient of (zw - zw_c) u_wave in the amplitude's equation, of Pi over {energy}",
            A3="coefficient of u_wave^3 there",
            B_tilt="force along the mode per degree of tilt there",
            B_uneven="force along the mode per uneven there",
            zw_tilt="zw - zw_c over tilt^(2/3), degrees, at an extremum of zw as tilt vanishes, over A",
            V_tilt="V - V_c over tilt^(2/3) at an extremum of V, over A^3",
            zw_uneven="zw - zw_c over uneven^(2/3) at an extremum of zw as uneven vanishes, over A",
            V_uneven="V - V_c over uneven^(2/3) at an extremum of V, over A^3",
            Theta="angle on the stress-free tube",
        ),
        Column("Z", "axial coordinate on the stress-free tube from the lower disk over {length}", "Z"),
        Column("r", "distance along e_r over {length}", "r"),
        Column("z", "height along the axis over {length}", "z"),
        column.LAM1,
        column.LAM2,
        Column("T1", "meridional Cauchy resultant over {resultant}", "T_1"),
        Column("T2", "circumferential Cauchy resultant over {resultant}", "T_2"),
    ),
    special_points=("limit_point", "bifurcation_point", "volume_fold"),
    branches=("primary", "secondary"),
    example=Example("u_wave", "zw", {"tilt": 0.1}, numerics={"cells": 8, "around": 4, "levels": 2}),
    tuned=(
        Family(
            {"delta": (4.8, 5.4), "tilt": (0.05, 0.5)},
            {"cells": 8, "around": 4, "degree": 3},
            {"cells": 12, "around": 6, "degree": 5, "levels": 2},
            at=(("u_wave", -0.2),),
        ),
    ),
    audit_numerics={"cells": 8, "around": 4, "levels": 2, "degree": 4},
)
