"""What is said of the problems ``wrinkled_tube``, ``wrinkled_tube_threshold`` and ``hemisphere``."""

import math

from weakforms.problems import column
from weakforms.problems.about import BLOCKS, About, Example, Family
from weakforms.problems.column import Column, Units, numbers

PAPER4 = "Patil, Nordmark & Eriksson (2015), Eur. J. Mech. A/Solids 54, 1-10"
PAPER5 = "Patil, Nordmark & Eriksson (2016), J. Mech. Phys. Solids 94, 298-315"
UNITS = Units("Ao", "C1", "h", 2 * math.pi)

# -- numbers of the cylinder and of the hemisphere ---------------------------------------------------------

OTHER_LAW = Column(
    "C1", "for another model the stress S by which its constants are divided (weakforms show material)"
)
RATIO = Column("c2", "C2/C1")
GAMMA = Column("gamma", "rho g Ao^2/(C1 h)")
BETA = Column(
    "beta", "bending stiffness over H^3 and C1 h Ao^2: (2/3)(1 + c2)(h/Ao)^2 for an isotropic sheet"
)
EXTREMES = (
    Column("gw_max", "largest value of the wrinkling function lam2 sqrt(lam1); taut above 1", derived=True),
    Column("gw_min", "smallest value of the wrinkling function", derived=True),
)
SHARED_NUMBERS = (
    RATIO,
    OTHER_LAW,
    GAMMA,
    BETA,
    column.LAM1,
    Column("lam2", "hoop stretch, 1"),
    Column("gw", "wrinkling function, 1", "g_w"),
    Column("tension", "meridional tension per undeformed hoop length over {resultant}"),
    Column("axial", "N cos(phi) - P r^2/2 over {resultant}: constant under gas, and above the fluid"),
    Column(
        "Lambda",
        "Lambda_nN_k: k-th lowest eigenvalue for N waves, d2Pi = Lambda M, M = int H R |dx|^2, "
        "over C1/(rho_m Ao^2)",
        r"\Lambda",
    ),
    Column("r", "deformed radius over {length}", "r"),
    *numbers(
        eigenvalue_1="lowest eigenvalue of the second variation at fixed load, axisymmetric, against the "
        "mass",
        n="waves around the axis",
        direction="of a change of stability: 1 if waves appear there along the branch, -1 if they disappear",
        meridional="mode along the meridian, int H R |dx|^2 dS = 1",
        circumferential="mode around the axis (a length)",
        normal="mode along the outward normal",
        state="state of the zone that opens or closes: 1 taut, -1 wrinkled",
    ),
)

# -- the cylinder ------------------------------------------------------------------------------------------

LEVEL = Column("zw", "level of the fluid above the lower end over {length}", "z_w")
CYLINDER = (
    *numbers(
        length="Ao, undeformed radius",
        M="thickness at the lower end over its mean h (2 - M at the upper end)",
        delta="axial pre-stretch L_f/L_o",
        L="L_o/Ao",
        Af="radius of the disks over Ao",
    ),
    RATIO,
    OTHER_LAW,
    GAMMA,
)
"""Its parameters."""

COLUMNS = (
    LEVEL,
    column.PRESSURE,
    column.VOLUME,
    column.POTENTIAL,
    Column("N", "meridional tension per undeformed hoop length at Z = 0 over {resultant}"),
    Column("wrinkled_fraction", "fraction of the material length with gw < 1", derived=True),
    Column("r_max", "largest radius over {length}, the disks included", derived=True),
    *EXTREMES,
)
NUMBERS = (
    *CYLINDER,
    *SHARED_NUMBERS,
    *numbers(
        M_taut="thickness ratio M up to which, from 1 on, the unloaded membrane is taut: it wrinkles at none",
        slope="dr/dz of the meridian",
    ),
    Column("Z", "material coordinate from the lower end over {length}", "Z"),
    Column(
        "Z_front_1",
        "front 1 from the lower end (and so on): material coordinate where gw = 1",
        dimension="length",
        also=("Z_front_2", "Z_front_3"),
    ),
    Column("z", "height above the lower end over {length}", "z"),
    Column("Af_critical", "largest radius of the disks with gw <= 1 everywhere at zero load, over {length}"),
)

SHARED = {
    "paper": 4,
    "source": PAPER4,
    "energy": "Pi/(2 pi C1 h Ao^2) = int_0^L [ eta W - P r^2 z'/2 ] ds,  eta = M + 2 (1 - M) s/L,  "
    "P = p or gamma max(zw - z, 0);  W = w(lam1, lam2) where gw = lam2 sqrt(lam1) > 1, else "
    "w(lam1, lam1^(-1/2)) = lam1^2 + 2/lam1 - 3 + c2 (2 lam1 + 1/lam1^2 - 3);  "
    "w = I1 - 3 + c2 (I2 - 3) or of another model (its S for C1),  lam1 = sqrt(r'^2 + z'^2),  lam2 = r",
    "units": UNITS,
}
AXISYMMETRIC = "(r, z) over the material coordinate Z, held at both disks"
THICKER_BELOW = {"M": (1.3, 1.6), "delta": (1.9, 2.2)}
FILLED = {"load_end": 7.0, "Af": 0.6}

WRINKLED_TUBE = About(
    name="wrinkled_tube",
    title="Wrinkling of a pre-stretched cylindrical membrane of non-uniform thickness",
    **SHARED,
    control="zw (load = fluid) or p (gas); past a limit load compare over V, which increases",
    unknown=AXISYMMETRIC,
    forms=("forms.wrinkling:tension_field", "forms.loads:liquid_potential", "forms.loads:gas_potential"),
    columns=(*COLUMNS, *column.DIAGNOSTICS),
    numbers=NUMBERS,
    special_points=("limit_point", "zone_opening", "zone_closing", "stability_change", "front"),
    example=Example("zw", "r_max", {"M": 1.5, "delta": 2}),
    tuned=(
        Family(
            {"M": (0.8, 0.95), "delta": (1.9, 2.2)},
            **BLOCKS,
            fixed={"load": "gas", "load_end": 0.15, "Af": 1.0},
            at=(("p", 0.1),),
            label="gas",
            quick=1,
        ),
        Family(THICKER_BELOW, **BLOCKS, fixed=FILLED, at=(("zw", 6.0),), label="fluid", quick=1),
        Family(THICKER_BELOW, **BLOCKS, fixed={"load_end": 7.0}, at=(("zw", 6.0),), label="critical"),
        Family(THICKER_BELOW, **BLOCKS, fixed=FILLED | {"n": [2]}, at=(("zw", 6.0),), label="waves"),
    ),
)

WRINKLED_TUBE_THRESHOLD = About(
    name="wrinkled_tube_threshold",
    title="Thickness ratio at which the unloaded cylindrical membrane starts to wrinkle",
    **SHARED,
    control="none; the quantity M is the root of min gw = 1 at zero load, Z where it is reached; a membrane "
    "that is taut at every ratio looked at has M_taut, the last of them, and gw_min there instead",
    unknown=f"{AXISYMMETRIC}, with the thickness ratio at which it is about to wrinkle",
    forms=("forms.wrinkling:natural_width", "forms.wrinkling:wrinkling_function"),
    numbers=(*COLUMNS, *NUMBERS),
    example=Example("delta", "M", values=(1.5, 2.0, 2.5, 3.0, 3.5)),
    held_out=(Family({"delta": (1.7, 2.5), "Af": (0.8, 1.2)}, **BLOCKS),),
)

# -- the hemisphere ----------------------------------------------------------------------------------------

FILLINGS = {"c2": (0.0, 0.2), "gamma": (1.5, 4.0)}

HEMISPHERE = About(
    name="hemisphere",
    title="Wrinkling and stability of a hemispherical membrane that holds a liquid or a gas",
    paper=5,
    source=PAPER5,
    energy="Pi/(2 pi C1 h Ao^2) = int_0^{pi/2} [ R W - Phi r r' ] dt,  R = sin t,  "
    "Phi = gamma max(zw - z, 0)^2/2,  or with -p r^2 z'/2 under gas;  "
    "W = w(lam1, lam2) where gw = lam2 sqrt(lam1) > 1, else w(lam1, lam1^(-1/2));  "
    "w = I1 - 3 + c2 (I2 - 3) or of another model (its S for C1),  lam1 = sqrt(r'^2 + z'^2),  lam2 = r/R",
    control="zw (load = fluid) or p (gas), from low loads up to the maximum; past that compare over V, which "
    "increases",
    unknown="(r, z) over the arc of the hemisphere, held at its equator",
    forms=(
        "forms.revolution:strain_energy",
        "forms.revolution:liquid_energy",
        "forms.revolution:gas_energy",
    ),
    units=UNITS,
    columns=(
        Column("zw", "level of the liquid above the equator's plane over {length}: negative"),
        column.PRESSURE,
        Column("V", "volume between the membrane and the equator's plane over {volume}"),
        column.POTENTIAL,
        Column("N", "meridional tension per reference angle around the axis at the equator over {force}"),
        Column("z_pole", "height of the pole over {length}"),
        Column("lam_pole", "stretch at the pole, 1"),
        Column("t_level", "reference angle at the level of the liquid", derived=True),
        Column("wrinkled_fraction", "fraction of the meridian's reference length with gw < 1", derived=True),
        Column("r_max", "largest radius over {length}", derived=True),
        *EXTREMES,
        *column.DIAGNOSTICS,
    ),
    numbers=(
        *SHARED_NUMBERS,
        *numbers(
            length="Ao, radius of the undeformed hemisphere",
            low_end="level at which the branch starts",
            past="decrease of the load below its maximum at the end of the branch",
            t="angle from the pole in the reference, rad",
            t_front_1="front 1 from the pole (and so on): reference angle where gw = 1",
        ),
        Column("z", "height over {length}"),
    ),
    special_points=("limit_point", "zone_opening", "zone_closing", "stability_change", "front"),
    example=Example("zw", "V"),
    tuned=(
        Family(FILLINGS, **BLOCKS, at=(("zw", -0.9),)),
        Family(FILLINGS, **BLOCKS, fixed={"n": [2, 10]}, at=(("zw", -0.9),), label="waves"),
    ),
    held_out=(
        Family(
            {"c2": (0.0, 0.2)},
            **BLOCKS,
            fixed={"load": "gas", "load_end": 1.5},
            at=(("p", 1.0),),
            label="gas",
        ),
    ),
    missed={
        "t": "of an event: where on the meridian it is, without a profile there",
        **{
            f"mode_n#:{part}": "a mode's size and sign are conventions; its shape is looked at"
            for part in ("meridional", "circumferential", "normal")
        },
    },
)
