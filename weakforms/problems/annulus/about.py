"""What is said of the problem ``annulus``."""

from weakforms.problems import column
from weakforms.problems.about import LINE, About, Example, Family
from weakforms.problems.column import Column, Units, numbers

ANNULUS = About(
    name="annulus",
    title="Torsion of a flat annulus in its plane, with wrinkles",
    paper="beyond",
    source="Reissner (1938); COMSOL's model of a wrinkled annulus",
    energy="U/(2 pi C1 h R_o^2) = int_a^1 W(C) R dR,  C11 = r'^2 + r^2 w'^2, C22 = r^2/R^2, C12 = r^2 w'/R;  "
    "W = I1 - 3 + alpha (I2 - 3) where taut, and with energy = relaxed "
    "lam1^2 + 2/lam1 - 3 + alpha (2 lam1 + 1/lam1^2 - 3) where wrinkled; or another model w and "
    "w(lam1, n(lam1)) with its natural width n, its S for C1",
    control="psi, the angle of the inner edge; the torque rises with it",
    unknown="radius r and angle w of a point over R;  r = s R at both edges, w = psi at R = a, 0 at R = 1",
    forms=("forms.revolution:strain_energy", "forms.kinematics:polar_metric"),
    units=Units("R_o", "C1", "h"),
    columns=(
        Column("psi", "angle of the inner edge in radians", r"\psi"),
        Column("M", "torque dU/dpsi over {energy}", "M"),
        Column("U", "strain energy over {energy}", "U"),
        Column("R_front", "R of the front, wrinkled inside of it and taut outside, over {length}", "R_f"),
        Column("M_in", "torque by the stress at the inner edge over {energy}"),
        Column("M_out", "torque by the stress at the outer edge over {energy}"),
        Column(
            "U_edges",
            "strain energy by stretches and stresses at both edges (Clapeyron's identity) over {energy}",
        ),
        Column("f_w", "wrinkled part of the reference area", "f_w"),
        *numbers(
            lam1_in="larger principal stretch at the inner edge, 1",
            lam1_out="larger principal stretch at the outer edge, 1",
            gw_in="smaller principal stretch over the natural width at the inner edge; wrinkled below 1",
            gw_out="the same at the outer edge",
        ),
        *column.DIAGNOSTICS,
    ),
    numbers=(
        *numbers(
            length="R_o, outer radius of the stress-free sheet",
            a="inner radius over {length}",
            s="ratio in which both radii are stretched",
            alpha="C2/C1",
            gw="smaller principal stretch over the natural width; wrinkled below 1",
            turn="angle w in radians",
        ),
        Column("R", "reference radius over {length}", "R"),
        Column("r", "deformed radius over {length}", "r"),
        Column("lam1", "larger principal stretch, 1", r"\lambda_1"),
        Column("lam2", "smaller principal stretch, 1", r"\lambda_2"),
        Column("torque", "-2 pi R dW/dw', the torque at each radius, over {energy}"),
        Column("tension", "force across a circle per radian over {force}; constant where wrinkled"),
        Column("line", "distance of its line from the centre over {length}; constant where wrinkled"),
    ),
    special_points=("wrinkling_onset", "zone_closing", "zone_opening"),
    example=Example("psi", "M", {"s": 1.05}, numerics={"cells": 16, "levels": 2}),
    tuned=(
        Family(
            {"a": (0.2, 0.7), "alpha": (0.0, 0.2)},
            **LINE,
            fixed={"psi_end": 0.3},
            at=(("psi", 0.1), ("psi", 0.25)),
        ),
    ),
    held_out=(
        Family(
            {"a": (0.2, 0.7), "s": (1.02, 1.3)},
            **LINE,
            fixed={"psi_end": 0.4},
            at=(("psi", 0.05), ("psi", 0.35)),
            label="stretched",
        ),
    ),
)
