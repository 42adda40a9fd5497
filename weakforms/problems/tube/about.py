"""What is said of the problems ``tube``, ``tube_fold`` and ``tube_scheme``."""

import math

from weakforms.problems import column
from weakforms.problems.about import LINE, MORE, SCHEME, About, Example, Family
from weakforms.problems.column import Column, Units, derived, numbers
from weakforms.problems.wave_numbers import count_columns, eigenvalue_columns

FREE = (
    column.PRESSURE,
    Column("u_max", "radial displacement of the mid-plane over {length}", "u_{max}"),
    Column("lam1_mid", "meridional stretch at the mid-plane, 1"),
    Column("t1_mid", "meridional Cauchy resultant at the mid-plane over {resultant}"),
    Column("V", "enclosed volume of the half tube (extent = full: of the whole one) over {volume}", "V"),
    Column("Pi", "total potential of the same over {energy}"),
)
CONTACT = (
    Column("Z_front", "Z of the contact front", dimension="length"),
    Column("contact_length", "deformed length of the whole patch over {length}"),
    Column("lam2_mid", "circumferential stretch at the mid-plane, 1"),
    Column("kappa", "curvature of the free part at the front times {1/curvature}; negative: bulged outward"),
    *derived(
        *numbers(
            line_force="axial line force at the edge of the patch over {resultant} (equation 22)",
            line_force_membrane="axial line force without the jump of the spring's term over {resultant}",
            traction_front="|f_t| at the front, inside, times {1/pressure}",
            traction_max="largest axial traction |f_t| of the substrate times {1/pressure}",
            spring_max="largest radial spring density |f_k| times {1/pressure}",
            t2_min="smallest circumferential resultant over {resultant}",
        )
    ),
)
"""Columns of constrained inflation only."""

MOST_WAVES = 6
"""Largest wave number for which the stability of a tube is computed."""

BIFURCATIONS = ("mirror_breaking", *(f"bifurcation_n{n}" for n in range(1, MOST_WAVES + 1)))
"""Kinds of special points where an eigenvalue of waves is zero."""

STABILITY = (
    Column("t_min", "smallest principal Cauchy resultant anywhere over {resultant}"),
    Column("Z_t_min", "distance of that place from the mid-plane on the pre-stretched tube over {length}"),
    *eigenvalue_columns(MOST_WAVES, "int |dx|^2 dZ", "whole tube"),
    *derived(
        *numbers(
            wrinkled="1 if the membrane is compressed somewhere (t_min < 0; of the relaxed energy, if an "
            "ordinary membrane would be), else 0"
        )
    ),
    *count_columns(MOST_WAVES, "whole tube"),
)
"""Columns of free inflation for which wave numbers are asked."""

LOPSIDED = (
    Column("w_mid", "axial displacement of the mid-plane over {length}, on the secondary branch", "w_{mid}"),
)
"""Columns of lopsided states only."""

BENT = (
    Column(
        "u_wave",
        "amplitude of cos(n Theta) in the radial displacement of the mid-plane over {length}, on the branch "
        "of secondary_n = n; u_max is then the mean around the axis",
        "u_{wave}",
    ),
    Column("m", "(p + p_atm) (V + V_r)^gas_kappa of a state with waves, conserved with the gas"),
    Column(
        "Lambda_rotation",
        "eigenvalue of the rotation of the pattern about the axis: exactly 0, its size shows the error",
    ),
    *derived(
        *numbers(
            n_negative_even_odd="number of negative eigenvalues at fixed p and at fixed V of a state "
            "with waves, displacements that keep its mirrors Theta = 0 and pi/n and break that at mid-length",
            n_negative_odd_even="the same of those that break the former and keep the latter, without the "
            "rotation of the pattern about the axis, whose eigenvalue is zero",
            n_negative_odd_odd="the same of those that break all of them",
            n_negative_alternating="of secondary_n = 2, the same of those that change sign from one wave to "
            "the next: they break one of the mirrors Theta = 0 and pi/2",
            n_negative_all="of secondary_n = 1 and 2, number of negative eigenvalues at fixed p, all "
            "displacements: n_negative and those of all other classes",
            n_negative_all_volume="the same at fixed V: n_negative_volume and those of all other classes",
            n_negative_mass="as n_negative_volume, of a state with waves, the mass of the gas held",
            n_negative_all_mass="the same of all displacements, with those of all other classes",
        )
    ),
)
"""Columns of states with waves around the axis only."""

PRE_STRETCH = Column("delta1", "axial pre-stretch, 1", r"\delta_1")
RELAXED = (
    Column(
        "wrinkled_fraction",
        "fraction of the length that is wrinkled, of one zone or of both; with waves, of the surface",
        r"\phi_{\mathrm{w}}",
    ),
    Column(
        "Z_front_1",
        "Z of the end of the wrinkled zone that is nearer to the mid-plane, over {length}",
        "Z_1",
        dimension="length",
    ),
    Column(
        "Z_front_2",
        "Z of its other end over {length}; lf/2 if it ends at the disk",
        "Z_2",
        dimension="length",
    ),
)
"""Columns of the relaxed energy only."""

NUMBERS = (
    *numbers(
        length="R_f, radius of the disks (= R_o/sqrt(delta1))",
        alpha="C2/C1",
        lf="L_f/R_f",
        k="K R_f^2/(C1 h_o)",
        s="S/R_f",
        eigenvalue_1="lowest eigenvalue of the second variation at fixed p against int |u|^2 dZ",
    ),
    PRE_STRETCH,
    Column("Z", "axial coordinate on the pre-stretched tube from the mid-plane over {length}", "Z"),
    column.RHO,
    Column("eta", "deformed axial position from the mid-plane over {length}", r"\eta"),
    column.LAM1,
    column.LAM2,
    column.T1,
    column.T2,
    Column("f_t", "axial traction of the substrate on the membrane times {1/pressure}"),
    Column("f_k", "radial spring density times {1/pressure}; negative: pushes inward"),
)

WAVES = numbers(
    n="wave number of a bifurcation point",
    parity="of a bifurcation point along the axis: 1 even, -1 odd, 0 not known (a whole tube)",
    direction="1 if an eigenvalue becomes negative with growing u_max, -1 if it becomes positive",
)

CURVATURES = numbers(
    p_2="initial curvature of the secondary branch: p = p_c + p_2 w_mid^2, w_mid over R_f, p scaled as p is; "
    "of secondary_n = 1 and more u_wave instead of w_mid",
    V_2="the same of its volume: V = V_c + V_2 w_mid^2",
    A1="coefficient of (p - p_c) w_mid in the equation of the amplitude, from the third variation of Pi",
    A3="coefficient of w_mid^3 in it, from the third and fourth variation; p_2 = -A3/A1",
    B="coefficient of uneven in it: the force of a thickness 1 + uneven Z/(lf/2) on the mode",
    p_s="coefficient of |uneven|^(2/3) in the difference of an uneven tube's limit point from p_c, p scaled "
    "as p is: Koiter's law, 3 p_2 |B/(2 A1 p_2)|^(2/3)",
    V_s="the same of the extremum of the volume: 3 V_2 |V' B/(2 A1 V_2)|^(2/3), V' = dV/dp of free inflation",
)
"""Values of the point at which a secondary branch begins; ``B``, ``p_s``, ``V_s`` of lopsided states only."""

SHARED = {
    "paper": 2,
    "source": "Patil, Nordmark & Eriksson (2014), Proc. R. Soc. A 470, 20140282",
    "energy": "Pi/(2 pi C1 h_o R_f^2) = int_0^{lf/2} [ w(lam1, lam2)/sqrt(delta1) - (p/2) rho^2 eta_Z "
    "+ (k/2) chi rho (rho - s)^2 eta_Z ] dZ,  "
    "lam1 = delta1 sqrt(rho_Z^2 + eta_Z^2),  lam2 = rho/sqrt(delta1),  "
    "w = I1 - 3 + alpha (I2 - 3), or of another model (weakforms show material; its S for C1)",
    "units": Units("R_f", "C1", "h_o", 2 * math.pi),
}
STICKING = {"alpha": (0.05, 0.15), "k": (5.0, 40.0)}
DEFLATION = {"contact": "adhesive", "phase": "deflation", "delta1": 1.2, "p_end": 2.4}

TUBE = About(
    name="tube",
    title="Inflation of a pre-stretched cylindrical membrane",
    **SHARED
    | {
        "energy": f"{SHARED['energy']};  if the thickness is uneven, w is multiplied by "
        "1 + uneven Z/(lf/2), and the integral is over the whole tube"
    },
    control="p (past a limit point compare over u_max, which increases along the whole branch)",
    unknown="(rho, eta) over half the tube, held at the disk and symmetric at mid-length, or over all of it",
    forms=(
        "forms.kinematics:revolution_stretches",
        "forms.loads:gas_potential",
        "forms.loads:substrate_potential",
        "forms.wrinkling:relaxed",
        "forms.revolution:around",
        "forms.revolution:strain_energy",
        "forms.revolution:gas_energy",
        "forms.wrinkling:surface_tension_field",
    ),
    columns=(*FREE, *LOPSIDED, *BENT, *STABILITY, *CONTACT, *RELAXED, *column.DIAGNOSTICS),
    numbers=(*NUMBERS, *WAVES, *CURVATURES, column.OUTSIDE, column.RESERVOIR),
    special_points=(
        *("limit_point", "bifurcation_point", "contact_onset", "wrinkling_onset"),
        *(*BIFURCATIONS, "volume_fold", "mass_fold"),
    ),
    branches=("primary", "secondary"),
    example=Example("p", "u_max", {"alpha": 0.1, "delta1": 1.1}, numerics={"cells": 32, "levels": 2}),
    tuned=(
        Family(
            {"alpha": (0.02, 0.3), "delta1": (1.0, 1.6), "lf": (4.0, 8.0)},
            **LINE,
            fixed={"u_end": 1.6},
            at=(("u_max", 0.6), ("u_max", 1.5)),
            quick=4,
        ),
        Family(
            {"alpha": (0.05, 0.3), "k": (5.0, 40.0)},
            **LINE,
            fixed={"contact": "frictionless", "delta1": 1.2, "p_end": 1.95},
            at=(("p", 1.9),),
            label="contact",
        ),
        Family(
            STICKING,
            **LINE,
            fixed={"contact": "adhesive", "delta1": 1.2, "p_end": 2.45},
            at=(("p", 2.4),),
            label="adhesive",
        ),
        Family(STICKING, **LINE, fixed=DEFLATION, at=(("p", 2.2),), label="deflation"),
        Family(
            STICKING,
            **LINE,
            fixed=DEFLATION | {"spring": "unilateral"},
            at=(("p", 2.2),),
            label="unilateral",
        ),
    ),
    held_out=(
        Family(
            {"alpha": (0.0, 0.15), "delta1": (1.0, 1.4), "lf": (5.0, 9.0)},
            **MORE,
            fixed={"n": (0, 1, 2), "u_end": 1.3},
            at=(("u_max", 1.1),),
            label="waves",
        ),
        Family(
            {"alpha": (0.0, 0.01), "delta1": (1.0, 1.03)},
            coarse={"cells": 96, "degree": 3},  # coarser meshes do not resolve the zone
            fine={"cells": 96, "degree": 5, "levels": 2},
            fixed={"energy": "relaxed", "u_end": 3.6},
            at=(("u_max", 2.2),),
            label="relaxed",
        ),
    ),
)

TUBE_FOLD = About(
    name="tube_fold",
    title="Fold line of the freely inflated tube and its cusp",
    **SHARED,
    control="delta1 (past the cusp compare over u_max, which increases along the whole line)",
    unknown="(rho, eta) as of `tube` with p and delta1, and a null vector of the second variation",
    forms=("forms.kinematics:revolution_stretches", "forms.loads:gas_potential"),
    columns=(PRE_STRETCH, *FREE, *column.DIAGNOSTICS),
    numbers=(*CONTACT, *NUMBERS),
    special_points=("cusp_point",),
    example=Example("delta1", "p", {"alpha": 0.1}, numerics={"cells": 32, "levels": 2}),
    held_out=(Family({"alpha": (0.05, 0.15), "lf": (4.0, 8.0)}, **LINE),),
)

TUBE_SCHEME = About(
    name="tube_scheme",
    title="Contact of the tube by the paper's schemes on a fixed mesh",
    **SHARED,
    control="p; the quantities u_max and contact_length are at p_end",
    unknown="(rho, eta) over half the tube on a fixed mesh; nodes in contact stick, or slide on the spring",
    forms=(
        "forms.kinematics:revolution_stretches",
        "forms.loads:gas_potential",
        "forms.loads:substrate_potential",
    ),
    numbers=(*FREE, *CONTACT, *NUMBERS),
    example=Example("p_end", "u_max", values=(1.5, 2.0, 2.5, 3.0), numerics={"cells": 60, "steps": 16}),
    unestimated=SCHEME,
)
