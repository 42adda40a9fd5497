"""What is said of the problem ``diagram``."""

import math
from typing import Literal

from weakforms.problems import column
from weakforms.problems.about import LINE, MORE, About, Example, Family
from weakforms.problems.column import Column, Units, derived, numbers
from weakforms.results import OF_LONG_WAVES, WITH_WAVES

Body = Literal["tube", "circular", "hemisphere", "sphere", "infinite_tube", "fluid_tube", "wrinkled_tube"]
"""Membranes whose critical points are followed."""

WAVES = ("n1", "n2", "n3")
"""Kinds of lines at which one, two or three waves around the axis are neutral."""

BREAKING = ("mirror", "localisation")
"""Kinds of lines at which a symmetry along the axis breaks."""

PLAIN = ("fold", *BREAKING, "wrinkling", "contact")
"""Kinds of lines without waves around the axis."""

LINES = (*PLAIN[:3], *WAVES, *PLAIN[3:])
"""Kinds of lines, and names of the first line of each."""

MOST = 4
"""Number of lines of a kind that states can be requested of."""

NAMES = (*(name + (f"_{k}" if k > 1 else "") for name in LINES for k in range(1, MOST + 1)), "end")

MIRRORED = {"coarse": {"cells": 96, "degree": 5}, "fine": {"cells": 128, "degree": 6, "levels": 2}}
"""Meshes that resolve what holds a bulge in the middle of a tube, and the layer at the disk. At ``lf = 7.86``
the critical eigenvalue is 2.6e-4: on 16 cells of degree 3 or 4 its error is as large, and there are critical
points that no finer mesh has. The least resultant at the disk is off by 3.6e-6, 2.6e-6 and 2.1e-7 on 24, 48
and 96 cells of degree 4, which is no order yet, and by 1.0e-6 and 2e-8 on 24 and 48 cells of degree 6."""

UNIFORM = {"coarse": {"step": 0.15}, "fine": {"step": 0.05, "levels": 3}}

DIAGRAM = About(
    name="diagram",
    title="Lines of critical points in a plane of two parameters",
    paper="beyond",
    source="the membranes of papers 1, 2, 3 and 5, balloons and long tubes of any law; extended systems: "
    "Govaerts (2000), chapters 3, 4 and 7; long waves: Haughton & Ogden (1979), Fu, Pearce & Liu (2008)",
    energy="that of tube or circular without a substrate, of a hemisphere (or a shallower or deeper part of "
    "a sphere) under gas, of a sphere, a long tube, a tube that holds a liquid, or a tube that may "
    "wrinkle, with all parameters as loads",
    control="the parameter that varies besides p or zw (past a cusp or tip compare over u_max, t0, lam, lam2 "
    "or V)",
    unknown="(rho, eta) as of tube, circular, hemisphere, fluid_tube or wrinkled_tube, or the stretches of a "
    "sphere or a long tube, with p or zw and another parameter, and a null vector",
    forms=(
        *("forms.kinematics:revolution_stretches", "forms.loads:gas_potential"),
        *(
            "problems.diagram.bodies.cap:VariedCap",
            "problems.diagram.bodies.balloon:VariedSphere",
            "problems.diagram.bodies.long_tube:HeldTube",
            "problems.diagram.bodies.liquid:VariedFluidTube",
            "problems.diagram.bodies.wrinkled:VariedWrinkledTube",
        ),
    ),
    units=Units("R_f", "C1", "h_o", 2 * math.pi),
    columns=(
        column.PRESSURE,
        Column(
            "zw",
            "level of the liquid in the fluid or wrinkled tube (full: static head) over {length}",
            "z_w",
        ),
        Column("delta1", "axial pre-stretch of the tube, 1", r"\delta_1"),
        Column("lf", "L_f/R_f of the tube", "l_f"),
        Column("alpha", "C2/C1", r"\alpha"),
        Column("beta", "uniform pre-stretch of the disk, 1", r"\beta"),
        Column("delta", "axial pre-stretch of the fluid or wrinkled tube, 1", r"\delta"),
        Column(
            "L", "stretched length of the fluid tube, undeformed one of the wrinkled tube, over {length}", "L"
        ),
        Column("M", "thickness at the wrinkled tube's lower end over its mean h (2 - M at the upper end)"),
        Column("Af", "radius of the wrinkled tube's disks over {length}"),
        Column(
            "gamma",
            "weight of the liquid: rho g A^2/(mu H) of the fluid tube, mu = 2 C1; rho g Ao^2/(C1 h) of the "
            "wrinkled tube, 1",
            r"\gamma",
        ),
        Column("angle", "angle from the pole to the clamp of the hemisphere, rad"),
        Column("u_max", "radial displacement of the tube's mid-plane over {length}", "u_{max}"),
        Column("t0", "height of the pole over the clamp, over {length}", "t_0"),
        Column("lam1_mid", "meridional stretch at the mid-plane, 1"),
        Column("lam_pole", "both stretches at the pole, 1"),
        Column("lam", "stretch of the sphere, 1", r"\lambda"),
        column.LAM1,
        column.LAM2,
        Column("force", "axial force of free ends, besides the pressure, over {axial}"),
        Column(
            "V",
            "enclosed volume of the half tube, of the sphere, under the disk or hemisphere, or of a piece "
            "of a long tube that is as long at rest as its radius; of the liquid in the fluid tube; over "
            "{volume}",
            "V",
        ),
        Column("Pi", "total potential of the same over {energy}"),
        *derived(
            Column(
                "t_min",
                "least principal Cauchy resultant over {resultant}; negative: the membrane would be wrinkled",
            ),
            Column("n_mirror", "negative eigenvalues of modes that are odd under the mirror, 1"),
            Column("n_localisation", "negative eigenvalues of long axisymmetric waves of a long tube, 1"),
            *(
                Column(
                    f"n_negative_{kind}",
                    f"negative eigenvalues of {kind[1]} wave{'s' * (kind != 'n1')} around the axis (each of "
                    f"them twice: cos and sin), or of modes of degree {kind[1]} of the sphere "
                    f"({2 * int(kind[1]) + 1} times each), 1",
                )
                for kind in WAVES
            ),
            Column("wrinkled", "1 if the membrane is compressed somewhere (t_min < 0), else 0"),
            Column("parity", "along the axis, of the waves that are neutral on the line: 1 even, -1 odd"),
            Column("at_end", "whether the least resultant is at the disk or clamp (1), or inside (0)"),
        ),
        *column.DIAGNOSTICS,
    ),
    numbers=(
        *numbers(
            length="R_f, radius of the disks (A of the fluid tube), of the clamp, or of the sphere or the "
            "infinite tube at rest",
            s="S/R_f, radius of a substrate around the tube",
            l="L/R_f, height of a substrate above the disk",
            S_least="place of the least resultant as a fraction of the meridian, of states",
            S="fraction of the meridian from the mid-plane, the pole, or the lower disk of the fluid tube",
            eigenvalue_1="lowest eigenvalue of the second variation at fixed p against int |dx|^2 R dS (a "
            "hemisphere: against that of the flat disk, R = S)",
        ),
        column.RHO,
        Column("eta", "deformed axial position, or height, over {length}", r"\eta"),
        column.T1,
        column.T2,
    ),
    special_points=(
        *("cusp_point", "fold_mirror", "tip_mirror", "wrinkling_fold", "wrinkling_mirror"),
        *("contact_fold", "contact_mirror", *WITH_WAVES, *OF_LONG_WAVES),
    ),
    branches=NAMES,
    example=Example("delta1", "p", {"kind": "fold"}, numerics={"cells": 32, "levels": 2}),
    tuned=(
        Family(
            {"alpha": (0.05, 0.15), "lf": (5.0, 8.0)},
            **LINE,
            fixed={"kind": "fold", "high": 3.0},
            at=(("u_max", 1.4),),
            branch="fold",
            label="folds",
        ),
        Family(
            {"alpha": (0.0, 0.04)},
            **MORE,
            fixed={"kind": "n1", "x": "lf", "low": 7.0, "high": 10.0, "u_end": 1.5},
            at=(("lf", 8.5),),
            branch="n1",
            label="bending",
        ),
        Family(
            {"lf": (5.5, 8.0)},
            **MIRRORED,
            fixed={"kind": "mirror", "alpha": 0.0},
            at=(("u_max", 1.8),),
            branch="mirror",
            label="mirror",
        ),
    ),
    held_out=(
        Family(
            {"mu2": (0.001, 0.006)},
            **UNIFORM,
            fixed={"body": "sphere", "model": "ogden", "kind": "n1", "x": "mu2", "low": 5e-4, "high": 0.01},
            at=(("lam", 2.2),),
            branch="n1",
            label="pears",
        ),
        Family(
            {"alpha": (0.0, 0.03)},
            **LINE,
            fixed={"body": "hemisphere", "kind": "fold"},
            at=(("angle", 1.7),),
            branch="fold",
            label="parts of spheres",
        ),
        Family(
            {"alpha": (0.02, 0.2)},
            **UNIFORM,
            fixed={"body": "infinite_tube", "ends": "held", "kind": "localisation", "high": 2.0},
            at=(("lam1", 1.5),),
            branch="localisation",
            label="long waves",
        ),
    ),
    audit_numerics={"levels": 2},
)
