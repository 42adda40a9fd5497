"""What is said of the problems ``circular`` and ``circular_scheme``."""

import math

from weakforms.problems import column
from weakforms.problems.about import LINE, MORE, SCHEME, About, Example, Family
from weakforms.problems.column import Column, Units, numbers

PATCH = (
    Column("X_contact", "X of the contact edge", "X^*", dimension="length"),
    Column("rho_contact", "deformed radius of the contact edge over {length}", r"\rho^*"),
    *numbers(
        lam1_contact="meridional stretch at the contact edge, inside, 1",
        lam1_contact_outer="meridional stretch at the contact edge, outside, 1",
    ),
    Column("sigma_pole", "contact stress at the pole times {1/pressure}, negative in compression"),
    Column("sigma_contact", "contact stress at the edge of the patch, inside, times {1/pressure}"),
    Column(
        "kappa",
        "meridional curvature of the free part at the contact edge times {1/curvature}, positive: "
        "bulged outward",
    ),
    Column("G", "energy release rate at the contact edge over {resultant}, closed form", "G"),
)
"""Columns of the edge of the patch."""

COLUMNS = (
    column.PRESSURE,
    Column("t0", "height of the pole over {length}", "t_0"),
    *numbers(lam_pole="both stretches at the pole, 1", lam1_rim="meridional stretch at the clamp, 1"),
    column.VOLUME,
    column.POTENTIAL,
    Column(
        "X_iso",
        "smallest X with |lam1 - lam2| = 1e-4 (1 where there is none)",
        "X_{iso}",
        derived=True,
        dimension="length",
    ),
    *PATCH,
    Column(
        "G_difference", "energy release rate from differences of potentials over {resultant}", derived=True
    ),
    Column("t_min", "smallest principal Cauchy resultant anywhere over {resultant}", derived=True),
)
NUMBERS = (
    *numbers(
        length="R_f, radius of the clamp (= beta R_0)",
        alpha="C2/C1",
        beta="uniform pre-stretch, 1",
        M="thickness at the pole over h, its mean of pole and clamp",
        k="K R_f^2/(C1 h)",
        l="L/R_f",
        eigenvalue_1="lowest eigenvalue of the second variation at fixed p against int |dx|^2 x dx",
    ),
    Column("X", "material radius, X = beta x in [0, 1]", "X", dimension="length"),
    column.RHO,
    Column("eta", "deformed height over {length}", r"\eta"),
    column.LAM1,
    column.LAM2,
    column.T1,
    column.T2,
    Column("sigma", "contact stress times {1/pressure}, negative in compression", r"\sigma"),
)

SHARED = {
    "paper": 1,
    "source": "Patil, DasGupta & Eriksson (2015), Int. J. Solids Struct. 67-68, 250-262",
    "energy": "Pi/(2 pi C1 h R_f^2) = int_0^{1/beta} [ W(lam1, lam2) x + (p/2) rho^2 eta' "
    "+ (k/2) chi (eta - l)^2 rho rho' ] dx,  rho = x lam2,  lam1 = sqrt(rho'^2 + eta'^2),  "
    "W = I1 - 3 + alpha (I2 - 3), or of another model (weakforms show material; its S for C1)",
    "units": Units("R_f", "C1", "h", 2 * math.pi),
}

CIRCULAR = About(
    name="circular",
    title="Circular membrane inflated against a deformable substrate",
    **SHARED,
    control="p (free: past a limit point compare over t0); peeling: the front at fixed p, and n_negative "
    "counts the front among the freedoms",
    unknown="(lam2, eta) over the radius x of the disk, rho = x lam2; both held at the clamp",
    forms=("forms.loads:gas_potential", "forms.loads:bed_potential", "forms.kinematics:revolution_stretches"),
    columns=(*COLUMNS, *column.DIAGNOSTICS),
    numbers=NUMBERS,
    special_points=("limit_point", "bifurcation_point", "contact_onset", "pull_off"),
    example=Example("p", "t0", {"contact": "frictionless"}, numerics={"cells": 24, "levels": 2}),
    tuned=(
        Family(
            {"alpha": (0.02, 0.3), "beta": (1.0, 2.0)},
            **LINE,
            fixed={"t_end": 1.3},
            at=(("t0", 0.6), ("t0", 1.2)),
            quick=2,
        ),
        Family(
            {"k": (10.0, 60.0), "l": (0.35, 0.55)},
            **MORE,
            fixed={"contact": "frictionless"},
            at=(("p", 3.3),),
            label="contact",
            quick=2,
        ),
        Family(
            {"alpha": (0.06, 0.15), "beta": (1.0, 1.2)},
            **MORE,
            fixed={"contact": "adhesive", "p_end": 4.05},
            at=(("p", 4.0),),
            label="adhesive",
        ),
        Family(
            {"alpha": (0.06, 0.15), "beta": (1.0, 1.2)},
            **MORE,
            fixed={"contact": "adhesive", "phase": "peeling", "p_end": 4.0, "p": 2.4},
            label="peeling",
        ),
    ),
)

CIRCULAR_SCHEME = About(
    name="circular_scheme",
    title="Adhesive inflation of the disk by frozen rings on a fixed mesh",
    **SHARED,
    control="t0; the quantities p, rho_contact and lam_pole are at t_end",
    unknown="(rho, eta) over the radius of the disk, held at the clamp; rings in contact are frozen "
    "one by one",
    forms=("forms.loads:gas_potential", "forms.loads:bed_potential"),
    numbers=(*COLUMNS, *NUMBERS),
    example=Example("t_end", "p", values=(0.51, 0.53, 0.55, 0.57), numerics={"cells": 100, "steps": 14}),
    unestimated=SCHEME,
    missed={"lam_pole": "of a scheme of first order, known to a third of a percent"},
)
