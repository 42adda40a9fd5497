"""What is said of the problem ``surface``."""

from weakforms.problems import column
from weakforms.problems.about import About, Example, Family
from weakforms.problems.column import Column, Units, derived, numbers
from weakforms.problems.wrinkled.about import GAMMA, OTHER_LAW, PAPER5, RATIO

SURFACE = About(
    name="surface",
    title="Wrinkled membrane of revolution on flat triangles in space",
    paper=5,
    source=PAPER5,
    energy="Pi/(C1 h Ao^2) = int H W(C) dA + int Phi(z) N_z dA,  Phi = -p z + gamma max(zw - z, 0)^2/2,  "
    "C = (J^T J)^-1 F^T F of each triangle;  W = I1 - 3 + c2 (I2 - 3) where taut, "
    "lam1^2 + 2/lam1 - 3 + c2 (2 lam1 + 1/lam1^2 - 3) where wrinkled, 0 where slack; or another "
    "model w and w(lam1, lam1^(-1/2)), its S for C1",
    control="zw (load = fluid) or p (gas)",
    unknown="the positions of the nodes of a triangulated surface, the edges held",
    forms=("forms.relaxed_surface:relaxed_energy", "forms.relaxed_surface:pressure_potential"),
    units=Units("Ao", "C1", "h"),
    columns=(
        Column("zw", "level of the fluid over {length}, in the coordinate z of the reference surface"),
        column.PRESSURE,
        *derived(
            *numbers(
                V="integral of (x N_x + y N_y)/2 over the surface over {volume}",
                Pi="strain energy less integral of P (x N_x + y N_y)/2, over {energy}",
                r_max="largest distance of a node from the axis over {length}",
                departure="largest distance of a node from the equilibrium among surfaces of revolution over "
                "{length}",
                Lambda_1="lowest eigenvalue against the membrane's mass (density C1/(Ao g)) over g/Ao; 2, 3 "
                "alike",
                Lambda_2="",
                Lambda_3="",
                n_negative="negative eigenvalues of the whole tangent, by inertia",
            )
        ),
        *column.DIAGNOSTICS[1:],
    ),
    numbers=(
        RATIO,
        OTHER_LAW,
        GAMMA,
        *numbers(
            length="Ao, undeformed radius (the tube's or the hemisphere's; of a file 1)",
            geometry="tube, hemisphere, or the name of a file",
            meridional="quadrilaterals along the tube, each cut into two triangles",
            circumferential="quadrilaterals around the tube",
            size="length of the triangles' edges on the hemisphere over Ao",
            M="thickness at the lowest point over its mean (2 - M at the highest)",
            delta="axial pre-stretch",
            L="L_o/Ao",
            Af="radius of the clamped edges over their undeformed one",
            rule="of the load on a triangle: 1 edge midpoints, 2 centroid, 3 three inner points, 4 of degree "
            "6",
            lower="load at which a negative eigenvalue first appears along the branch",
            upper="load at which the last one disappears",
            gaps="stable intervals between them",
            n_lower="waves around the axis of the critical mode at the lower end, on this mesh",
            n_upper="waves around the axis of the critical mode at the upper end",
            direction="1 if instability starts there along the branch, -1 if it ends",
            n="waves around the axis of the critical mode, on this mesh",
            Lambda_1_stable="of a stability change: lowest eigenvalue at the stable end of its bracket "
            "(Lambda_1 is that at the unstable one); both near zero unless it jumps",
            unknowns="degrees of freedom, including prescribed ones",
        ),
        *(Column(name, dimension="length") for name in "xyz"),
    ),
    special_points=("stability_change",),
    on_demand=False,
    example=Example(
        "zw", "r_max", {"meridional": 24, "circumferential": 12}, numerics={"scan": 10, "shown": 1}
    ),
    held_out=(
        Family(
            {"M": (1.45, 1.55), "delta": (2.8, 3.2)},
            coarse={"scan": 15, "tolerance": 1e-4},
            fine={"scan": 15, "tolerance": 1e-8},
            fixed={"meridional": 60, "circumferential": 48, "load_start": 4.5, "load_end": 7.5},
        ),
    ),
    audit_numerics={"scan": 10},
    audit_held={"meridional": 30, "circumferential": 12, "size": 0.25},
    missed={
        "Pi": "walks of triangles have too few points for the work along them",
        **dict.fromkeys(
            (
                *("surface:Theta", "surface:gw", "surface:x", "surface:y", "surface:u_x", "surface:u_y"),
                *("surface:u_z", "triangles:b", "triangles:c"),
                *("triangles:lam1", "triangles:lam2", "triangles:state"),
            ),
            "of a picture: nodes and triangles of a deformed surface, looked at",
        ),
    },
)
