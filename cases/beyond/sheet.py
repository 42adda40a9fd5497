"""Homogeneous sheets: shear, tension at a held width, and a strip, against closed forms.

Each state is the same at every point, so that every mesh has the exact solution: what is compared are the
relaxed and the full energy on triangles in the plane, their stresses, and the shear at which wrinkling
begins. The sheet that is only sheared wrinkles at once; one that was stretched across wrinkles later.
"""

from weakforms.cases import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, States, decide, sheet

SHEARED = sheet()
WIDE = sheet(s=1.2)
STRETCHED = sheet(loading="stretch", s=0.8)
STRIP = sheet(loading="strip")
FULL = sheet(energy="full")
ASKED = 1e-9
ONSET = At("S_least", 0.0)


def bears(solutions: Solutions) -> Finding:
    """At a shear of 1/2 the full energy is the larger one, and pushes the edges apart in Y."""
    at = At("gam", 0.5)
    relaxed, full = (solutions.number(spec, at, "Pi") for spec in (SHEARED, FULL))
    pulled, pushed = (solutions.number(spec, at, "T_y") for spec in (SHEARED, FULL))
    return decide.all_of(
        decide.less("relaxed and full energy", relaxed, full),
        decide.positive("tension in Y of the relaxed sheet", pulled),
        decide.positive("pressure in Y of the full one", -pushed),
    )


def panel(name: str, x: Axis, y: Axis, title: str, *curves: tuple) -> Panel:
    """A stress over the motion of the edges."""
    return Panel(
        name,
        x=x,
        y=y,
        title=title,
        curves=tuple(Curve(spec, label, table) for spec, label, table in curves),
    )


CASE = Case(
    title="Homogeneous sheets in shear and in tension",
    source="Wagner (1929), tension-field theory",
    panels=(
        panel(
            "shear",
            Axis("gam", 0, 1),
            Axis("tau", 0, 2.2),
            "sheared sheets",
            (SHEARED, "$s = 1$, wrinkled at once", "sheet_sheared"),
            (WIDE, "$s = 1.2$", "sheet_sheared_wide"),
        ),
        panel(
            "tension",
            Axis("lam", 1, 2),
            Axis("T_x", 0, 4),
            "stretched sheets",
            (STRETCHED, "width held at 0.8", "sheet_stretched"),
            (STRIP, "free width", "sheet_strip"),
        ),
    ),
    checks=(
        States("sheet_onset", sheet(), ("s",), ONSET, {"gam": ASKED}),
        Claim(
            "bears",
            "a sheet that bears compression stores more energy in shear, and presses on its edges where the "
            "wrinkled one pulls",
            tuple((spec, At("gam", 0.5)) for spec in (SHEARED, FULL)),
            bears,
        ),
    ),
    asked=dict.fromkeys(("tau", "T_x", "T_y", "lam1", "lam2"), ASKED),
)
