"""What is said of the problem ``fluid_tube_surface``."""

from weakforms.problems.about import ONE_MESH, About, Example
from weakforms.problems.column import Column, Units, numbers

HALF_OR_FULL = "compared between half and full circumference, which share its size"
EVEN_OR_NOT = "compared between an even and an uneven mesh, which share its size"

FLUID_TUBE_SURFACE = About(
    name="fluid_tube_surface",
    title="Fluid-loaded tube as a whole surface: symmetry of circle and mesh",
    paper=3,
    source="Patil, Nordmark & Eriksson (2015), Proc. R. Soc. A 471, 20150016",
    energy="Pi/(mu H A^2) = int_0^{L/delta} int_0^{2 pi} [ (I1 - 3 + alpha (I2 - 3))/2 "
    "+ (gamma/2) max(zw - z, 0)^2 N_z ] dTheta dZ - (gamma pi/2) (zw^2 - max(zw - L, 0)^2),  "
    "N = x_Theta x x_Z",
    control="none: the problem's numbers are quantities",
    unknown="the position (x, y, z) over (Z, Theta), held on both rings",
    forms=("forms.fluid:strain_energy", "forms.fluid:submerged_flux"),
    units=Units("A", "mu", "H"),
    numbers=(
        Column("length", "A, radius of the disks and of the stress-free tube"),
        Column(
            "zw_bifurcation",
            "level at which the critical eigenvalue, or the mean of the pair, is zero, over {length}",
        ),
        Column("V_bifurcation", "volume there over {volume}"),
        *numbers(
            Lambda_pair_1="smaller of the eigenvalues of the n = 1 modes at that volume",
            Lambda_pair_2="larger one (full circumference)",
            Lambda_split="difference of these eigenvalues: zero for a double one",
            multiplicity="number of eigenvalues smaller there than 1e-9 of the next one",
        ),
        Column("zw_bent", "level of the secondary state with the prescribed amplitude over {length}"),
        Column("V_bent", "its volume over {volume}"),
        Column("Pi_bent", "its potential over {energy}"),
        *numbers(
            Lambda_bent_1="its eigenvalue nearest to zero; on the full circumference the eigenvalue of the "
            "rotation",
            phase="force that prevents the rotation at that state: zero up to round-off",
            uneven="relative amplitude by which the widths of the cells vary around",
        ),
        Column(
            "amplitude", "root mean square displacement along the axisymmetric branch's mode over {length}"
        ),
    ),
    example=Example("delta", "zw_bifurcation", values=(1.8, 2.0, 2.2), numerics={"cells": 8}),
    unestimated=ONE_MESH,
    missed={
        **dict.fromkeys(
            ("Lambda_bent_1", "Pi_bent", "V_bent", "zw_bent", "Lambda_pair_1", "Lambda_pair_2"), HALF_OR_FULL
        ),
        "Lambda_split": EVEN_OR_NOT,
        "phase": EVEN_OR_NOT,
    },
    unstated="its columns are held by the tables and claims of its cases alone, not all of them by either",
)
