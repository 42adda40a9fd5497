"""What is said of the problem ``controls``."""

import math

from weakforms.problems import column
from weakforms.problems.about import LINE, About, Example, Family
from weakforms.problems.column import Column, Units, derived, numbers

CONTROLS = About(
    name="controls",
    title="Stability of inflated membranes at given pressure, given mass of gas, and given volume",
    paper="beyond",
    source="the membranes of papers 1 and 2 and a sphere; gas of given mass by its potential",
    energy="E - p V (pressure);  E + p_atm V + Psi(V), Psi' = -m (V + V_r)^-kappa (mass);  E at V (volume)",
    control="p (past a limit point compare over u_max, t0 or lam)",
    unknown="(rho, eta) as of tube or circular without a substrate, or the stretch of a sphere",
    forms=("forms.kinematics:revolution_stretches", "forms.loads:gas_potential"),
    units=Units("R_f", "C1", "h_o", 2 * math.pi),
    columns=(
        column.PRESSURE,
        Column("u_max", "radial displacement of the tube's mid-plane over {length}", "u_{max}"),
        Column("t0", "height of the disk's pole over {length}", "t_0"),
        Column("lam", "radius of the sphere over {length}", r"\lambda"),
        Column("lam1_mid", "meridional stretch at the mid-plane, 1"),
        Column("lam_pole", "both stretches at the pole, 1"),
        Column("V", "enclosed volume of the half tube, under the disk, or of the sphere, over {volume}", "V"),
        Column("Pi", "total potential of the same at given pressure over {energy}"),
        *derived(
            column.LAM1,
            column.LAM2,
            column.MASS,
            Column("t_min", "least principal Cauchy resultant over {resultant}"),
            Column("n_fixed_V", "negative eigenvalues at given volume, in the symmetry of the states, 1"),
            Column(
                "n_fixed_m", "negative eigenvalues at given mass of gas, in the symmetry of the states, 1"
            ),
        ),
        *column.DIAGNOSTICS,
    ),
    numbers=(
        *numbers(
            length="R_f, radius of the disks, or of the clamp; of the sphere r_o, its radius at rest",
            S="fraction of the meridian from the mid-plane or the pole",
            eigenvalue_1="lowest eigenvalue of the second variation at fixed p against int |dx|^2 R dS",
        ),
        column.OUTSIDE,
        column.RESERVOIR,
        column.RHO,
        Column("eta", "deformed axial position, or height, over {length}", r"\eta"),
        column.T1,
        column.T2,
    ),
    special_points=("limit_point", "volume_fold", "mass_fold"),
    example=Example("u_max", "p", {"V_r": 20.0}, numerics={"cells": 32, "levels": 2}),
    tuned=(
        Family(
            {"alpha": (0.05, 0.15), "V_r": (5.0, 40.0)},
            **LINE,
            fixed={"u_end": 2.5},
            at=(("u_max", 1.4),),
            label="tube",
        ),
    ),
    audit_numerics={"cells": 24, "levels": 2},
)
