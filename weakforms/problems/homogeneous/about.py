"""What is said of the problems ``material``, ``sphere``, ``infinite_tube`` and ``homogeneous``."""

import math

from weakforms.problems import column
from weakforms.problems.about import CLOSED, About, Example, Family
from weakforms.problems.column import Column, Units

THESIS = "Patil (2016), chapter 3"
UNKNOWN = "the principal stretches of a homogeneous state"
FORMS = ("forms.materials.phenomenological:mooney_rivlin", "problems.homogeneous.body:")
STEPS = {"coarse": {"step": 0.1}, "fine": {"step": 0.02, "levels": 4}}


def _law(suffix: str, text: str) -> Column:
    """Energy, stresses and tangent: their units are that of the energy per volume."""
    names = (f"{name}{suffix}" for name in ("W1", "W2", "W11", "W12", "W22"))
    return Column(f"W{suffix}", text, dimension="stress", also=tuple(names))


ENERGY_OF_LAW = (
    _law("", "energy per reference volume over {stress}"),
    Column("W1", "its derivative in l1 (and so on): nominal stress over {stress}"),
    Column("W11", "its second derivative in l1 (and so on) over {stress}"),
)

MATERIAL = About(
    name="material",
    title="A material law at two stretches: full and relaxed energy, stresses, tangent",
    paper="materials",
    source=THESIS,
    energy="W(l1, l2) of the model; relaxed: W taut, W(l, width(l)) under tension along l, 0 slack, "
    "width(l) = l^(-1/2) for every incompressible law",
    control="none; the quantities are at l1, l2",
    unknown=f"{UNKNOWN}, given",
    forms=("forms.materials.phenomenological:mooney_rivlin", "forms.wrinkling:tension_field"),
    units=Units(modulus="S"),
    numbers=(
        _law("", "energy per reference volume over the model's stress {stress}"),
        *ENERGY_OF_LAW[1:],
        _law("_relaxed", "the same of the relaxed energy (and so on)"),
        _law("_modified", "the same of the full energy of the modified deformation gradient (and so on)"),
        Column(
            "W_metric",
            "energy from the metric of turned, skew coordinates, the sheet turned in space, over {stress}",
            dimension="stress",
            also=("W_metric_relaxed",),
        ),
    ),
    example=Example("l1", "W1", values=tuple(1 + i / 4 for i in range(9))),
    unestimated=CLOSED,
)

SPHERE = About(
    name="sphere",
    title="Inflation of a spherical balloon of any material law",
    paper="closed_form",
    source=THESIS,
    energy="Pi = w(lam, lam) - P lam^3/3,  P = 2 w1(lam, lam)/lam^2",
    control="P (past a limit point compare over lam); branch fold: a constant of the model",
    unknown="the stretch of the balloon",
    forms=FORMS,
    units=Units("r_o", "S", "h_o"),
    columns=(
        Column("P", "p {1/pressure}, S the model's stress (C1 for neo_hookean and mooney_rivlin)"),
        Column("lam", "radius over its value at rest"),
        Column("lam1", derived=True),
        Column("lam2", derived=True),
        Column("Pi", "potential per reference area over {resultant}"),
        *column.DIAGNOSTICS,
    ),
    special_points=("limit_point", "cusp_point"),
    branches=("primary", "fold"),
    example=Example("lam", "P"),
    held_out=(Family({"alpha": (0.02, 0.3)}, **STEPS, fixed={"lam_end": 3.0}, at=(("lam", 1.7),)),),
)

INFINITE_TUBE = About(
    name="infinite_tube",
    title="Uniform inflation of an infinite tube: limit and Maxwell pressures",
    paper="closed_form",
    source=THESIS,
    energy="Pi = w(lam1, lam2) - (p/2) lam1 lam2^2 - F lam1",
    control="p (past a limit point compare over lam2)",
    unknown=UNKNOWN,
    forms=FORMS,
    units=Units("R_o", "S", "h_o", 2 * math.pi),
    columns=(
        Column("p", "P {1/pressure}, S the model's stress"),
        Column("lam1", "axial stretch"),
        Column("lam2", "hoop stretch"),
        Column("V", "volume over its value at rest"),
        Column("Pi", "potential per reference area over {resultant}"),
        *column.DIAGNOSTICS,
    ),
    numbers=(
        Column("force", "axial force in addition to the pressure over 2 pi R_o h_o S", dimension="axial"),
        Column(
            "p_maxwell",
            "pressure at which a thin and a thick state have the same Pi, if there is one",
            dimension="pressure",
        ),
        Column("lam1_thin", "axial stretch of the thin state at that pressure (and so on)"),
    ),
    special_points=("limit_point", "bifurcation_point"),
    example=Example("lam2", "p"),
    held_out=(Family({"alpha": (0.02, 0.3), "force": (0.0, 3.0)}, **STEPS, fixed={"lam_end": 3.0}),),
)

HOMOGENEOUS = About(
    name="homogeneous",
    title="Test pieces of any material law: uniaxial, equibiaxial, pure shear",
    paper="closed_form",
    source=THESIS,
    energy="Pi = w(lam1, lam2) - T lam1 (uniaxial), w(lam, lam) - 2 T lam (equibiaxial), w(lam, 1) - T lam "
    "(pure shear)",
    control="T (past a limit point compare over lam)",
    unknown=UNKNOWN,
    forms=FORMS,
    units=Units(modulus="S"),
    columns=(
        Column("T", "nominal stress over {stress}, the model's stress"),
        Column("lam", "stretch along the load"),
        Column("lam1", derived=True),
        Column("lam2", "the other stretch of the sheet", derived=True),
        Column("lam_across"),
        Column("Pi", "potential per reference volume over {stress}"),
        *column.DIAGNOSTICS,
    ),
    special_points=("limit_point", "bifurcation_point"),
    example=Example("lam", "T"),
    held_out=(Family({"alpha": (0.02, 0.3)}, **STEPS, fixed={"lam_end": 3.0}, at=(("lam", 1.7),)),),
)
