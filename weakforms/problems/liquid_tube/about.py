"""What is said of the problems ``fluid_tube`` and ``fluid_tube_coincidence``."""

from weakforms.problems import column
from weakforms.problems.about import MORE, About, Example, Family
from weakforms.problems.column import Column, Units, numbers
from weakforms.problems.liquid_tube.bent.columns import DERIVED, PRESCRIBED, SLOPES, SURFACE

MOST_WAVES = 6
"""Largest wave number that can be requested."""

MOST_FRONTS = 4
"""Largest number of fronts: those of a wrinkled zone near either ring."""

PRIMARY = (
    Column(
        "zw",
        "level of the free surface above the lower disk, or static head over a full tube, over {length}",
        "z_w",
    ),
    Column("V", "volume of the liquid over {volume}", "V"),
    Column("Pi", "total potential at fixed level over {energy}"),
    Column(
        "r_mid",
        "radius at Z = L/(2 delta) over {length}; on the secondary branch at Theta = 0, the bulge's side",
        "r_{mid}",
    ),
    Column("r_max", "largest radius over {length}"),
    Column("r_front", "radius at the free surface over {length}; none over a full tube"),
    Column("Z_front", "Z of the free surface over {length}"),
    *(
        Column(f"{name}_{where}", f"{what} Cauchy resultant at {place} over {{resultant}}")
        for where, place in {"ring": "the rings", "mid": "Z = L/(2 delta)"}.items()
        for name, what in {"T1": "meridional", "T2": "circumferential"}.items()
    ),
    *(
        Column(
            f"Lambda_n{n}",
            "lowest eigenvalue at fixed level against int |dx|^2 dZ dTheta, "
            + ("axisymmetric without torsion" if n == 0 else f"{n} wave{'s' if n > 1 else ''} around"),
        )
        for n in range(MOST_WAVES + 1)
    ),
    *numbers(
        Lambda_torsion="lowest eigenvalue at fixed level, axisymmetric torsion",
        LambdaV_n0="lowest axisymmetric eigenvalue at fixed volume",
    ),
)
RELAXED = (
    Column("wrinkled_fraction", "part of the material length that is wrinkled"),
    *(
        Column(
            f"Z_front_{k}",
            f"Z of the {'lower' if k % 2 else 'upper'} end of wrinkled zone {(k + 1) // 2} from below, over "
            "{length}; none without it",
            f"Z_{k}",
            dimension="length",
        )
        for k in range(1, MOST_FRONTS + 1)
    ),
)
"""Columns of the relaxed energy only."""

COLUMNS = (*PRIMARY, *PRESCRIBED, *DERIVED)
NUMBERS = (
    *numbers(
        length="A, radius of the disks and of the stress-free tube",
        L="stretched length over A",
        delta="axial pre-stretch, 1; the stress-free tube is L/delta long",
        gamma="rho g A^2/(mu H), H the thickness of the stress-free tube",
        mu="2 C1; for another model 2 S, twice the stress by which its constants are divided",
        alpha="second Mooney-Rivlin constant over the first; 0 is neo-Hookean",
        H="w - lam1 w_,1, constant along the membrane, over {resultant}",
    ),
    Column("Z", "axial coordinate on the stress-free tube from the lower disk over {length}", "Z"),
    Column("r", "radius over {length}", "r"),
    Column("z", "height over {length}", "z"),
    column.LAM1,
    column.LAM2,
    Column("T1", "meridional Cauchy resultant over {resultant}", "T_1"),
    Column("T2", "circumferential Cauchy resultant over {resultant}", "T_2"),
    *SLOPES,
    *SURFACE,
)
DIRECTION = Column(
    "direction",
    "of a bifurcation point with the relaxed energy: 1 if an eigenvalue becomes negative along the branch, "
    "-1 if it becomes positive",
)

AXISYMMETRIC = "(r, z) over the material coordinate Z, held at both disks"
SHARED = {
    "paper": 3,
    "source": "Patil, Nordmark & Eriksson (2015), Proc. R. Soc. A 471, 20150016",
    "energy": "Pi/(mu H A^2) = int_0^{L/delta} int_0^{2 pi} [ (I1 - 3 + alpha (I2 - 3))/2 - P(z) (x e_x + "
    "y e_y).N/2 ] dTheta dZ,  P = gamma max(zw - z, 0),  N = x_Theta x x_Z;  written as its first variation, "
    "w_a.v_Z + w_b.v_Theta - P v.N;  another model (weakforms show material) has w/2 for the first term",
    "units": Units("A", "mu", "H"),
}
UNREAD = "of bent states: their surfaces are sampled at too few points for an extreme"

FLUID_TUBE = About(
    name="fluid_tube",
    title="Fluid-loaded pre-stretched cylindrical membrane",
    **SHARED,
    control="zw (past its maximum compare over V, which increases along the whole primary branch)",
    unknown=f"{AXISYMMETRIC}; waves around enter through the second variation of each wave number",
    forms=("forms.fluid:strain_energy", "forms.fluid:submerged_flux", "forms.fluid:pressure_work"),
    columns=(*COLUMNS, *RELAXED, *column.DIAGNOSTICS),
    numbers=(*NUMBERS, DIRECTION),
    special_points=("limit_point", "bifurcation_point", "zone_opening", "zone_closing"),
    branches=("primary", "secondary"),
    example=Example("zw", "V", {"L": 8, "delta": 2}, numerics={"cells": 24, "levels": 2}),
    tuned=(
        Family({"delta": (1.6, 2.4), "gamma": (0.05, 0.11)}, **MORE, fixed={"n_max": 1}, at=(("zw", 6.0),)),
    ),
    held_out=(
        Family(
            {"delta": (1.9, 3.0), "gamma": (0.112, 0.12)},
            coarse=MORE["coarse"] | {"secondary_cells": 24, "secondary_degree": 4},
            fine=MORE["fine"] | {"secondary_cells": 24, "secondary_degree": 6, "secondary_levels": 2},
            fixed={"n_max": 1, "secondary": True},
            label="secondary",
            branch="secondary",
        ),
        Family(
            {"delta": (1.38, 1.44), "gamma": (0.029, 0.032)},
            coarse=MORE["coarse"] | {"secondary_cells": 24, "secondary_degree": 4, "secondary_end": 0.8},
            fine=MORE["fine"] | {"secondary_cells": 48, "secondary_levels": 2, "secondary_end": 0.8},
            fixed={"L": 12.0, "n_max": 1, "secondary": True, "energy": "relaxed"},
            at=(("zw", 17.4),),
            label="secondary, relaxed",
            branch="secondary",
        ),
        Family(
            {"delta": (1.03, 1.06), "gamma": (0.45, 0.6)},
            coarse={"cells": 64, "degree": 4},  # coarser meshes do not resolve the zone
            fine={"cells": 96, "degree": 6, "levels": 2},
            fixed={"n_max": 1, "energy": "relaxed"},
            at=(("V", 29.0),),
            label="relaxed",
        ),
    ),
    audit_numerics={"secondary_cells": 12, "secondary_levels": 2, "secondary_degree": 4},
    missed={
        "Z_front": "its sign alone: tables and profiles look for it from the ring upwards",
        "z_min": UNREAD,
        "T_min": UNREAD,
    },
)

FLUID_TUBE_COINCIDENCE = About(
    name="fluid_tube_coincidence",
    title="Pre-stretch at which limit point and bifurcation of the fluid-loaded tube coincide",
    **SHARED,
    control="none: the quantities belong to the one state",
    unknown=f"{AXISYMMETRIC}, with the pre-stretch at which two second variations are singular at once",
    forms=("forms.fluid:strain_energy", "forms.fluid:submerged_flux"),
    numbers=(*COLUMNS, *NUMBERS),
    example=Example("gamma", "delta", values=(0.1, 0.116, 0.13), numerics={"cells": 32, "levels": 2}),
    held_out=(Family({"L": (7.0, 9.0), "gamma": (0.1, 0.12)}, **MORE),),
    unstated="its columns are held by the tables and claims of its cases alone, not all of them by either",
)
