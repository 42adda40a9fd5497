"""What is said of the problems ``wrinkled_sheet``, ``wrinkled_material`` and ``wrinkled_patch``."""

from weakforms.problems.about import CLOSED, LINE, ONE_MESH, About, Example, Family
from weakforms.problems.column import Column, Units, derived, numbers
from weakforms.problems.homogeneous.about import ENERGY_OF_LAW
from weakforms.problems.wrinkled.about import COLUMNS, NUMBERS, PAPER4, PAPER5, SHARED

WRINKLED_SHEET = About(
    name="wrinkled_sheet",
    title="The cylindrical membrane of non-uniform thickness as a two-dimensional sheet",
    **SHARED,
    control="zw or p; the quantities are at the load `at_load`",
    unknown="the position in space over a quarter of the unrolled cylinder, held at both disks",
    forms=("forms.wrinkling:surface_tension_field", "forms.fluid:submerged_flux"),
    numbers=(
        *COLUMNS,
        *NUMBERS,
        Column("radius", "integral of the radius over the membrane over 2 pi Ao^2"),
        Column(
            "twist",
            "largest distance of a material point from its own half-plane through the axis over {length}",
        ),
    ),
    example=Example("at_load", "V", values=(3.5, 4.0, 4.5), numerics={"along": 2, "around": 2}),
    unestimated=ONE_MESH,
    missed={"radius": "an integral that no other problem returns"},
)

WRINKLED_MATERIAL = About(
    name="wrinkled_material",
    title="Energy of a sheet that may wrinkle, at two stretches",
    paper=4,
    source=PAPER4,
    energy="w(l1, l2) taut; w(l, l^(-1/2)) wrinkled with tension along l; 0 slack;  w = I1 - 3 + c2 (I2 - 3)",
    control="none; the quantities are at l1, l2",
    unknown="the principal stretches of a homogeneous state, given",
    forms=("forms.wrinkling:tension_field", "forms.wrinkling:modified_gradient"),
    units=Units(modulus="C1"),
    numbers=(*ENERGY_OF_LAW, *numbers(l1="stretch along 1", l2="stretch along 2", c2="C2/C1")),
    example=Example("l2", "W", values=tuple(0.3 + i / 10 for i in range(13))),
    unestimated=CLOSED,
)

WRINKLED_PATCH = About(
    name="wrinkled_patch",
    title="Instability of a flat wrinkled patch under pressure",
    paper=5,
    source=PAPER5,
    energy="U + P W,  U = int W_R(l1, l2) dX dY,  W = -b int z x_X dX dY;  x = a X + e sin(n X), y = b Y, "
    "z = c + e cos(n X)",
    control="e",
    unknown="the amplitude e of a displacement of a flat wrinkled patch",
    forms=("forms.wrinkling:tension_field",),
    columns=(
        Column("e", "amplitude"),
        *derived(
            *numbers(
                U="strain energy over C1 and the width",
                U_e="derivative with respect to e (and so on)",
                U_ee="",
                W="potential of the pressure over the pressure and the width",
                W_e="derivative with respect to e (and so on)",
                W_ee="",
                shear="integral of the squared shear of the metric",
            )
        ),
    ),
    numbers=numbers(
        length="any",
        a="stretch along X",
        b="stretch along Y",
        x="deformed position along",
        z="deformed height",
        c="height of the flat patch",
        n="wave number along X",
        Lx="length along X",
        c2="C2/C1",
    ),
    example=Example("e", "U"),
    held_out=(Family({"a": (0.2, 0.5), "n": (6.0, 14.0)}, **LINE, at=(("e", 0.02),)),),
    missed={
        "U_ee": "jumps where the membrane becomes taut, which no spline follows",
        "profile:x": "of a picture: the period of the wrinkles",
        "profile:z": "of a picture: the height of the wrinkles",
    },
)
