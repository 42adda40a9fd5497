"""Paper 5: a hemisphere that holds a liquid and is thin at its equator; the thickness is an expression."""

from weakforms.cases import Axis, Case, Curve, Panel, hemisphere

BOWL = hemisphere(thickness="1 + 0.3*cos(2*t)", low_end=-1.05)

CASE = Case(
    title="A hemisphere of a thickness given as an expression",
    source="Patil, Nordmark & Eriksson (2016), section 3.3; another thickness",
    panels=(
        Panel(
            "branch",
            x=Axis("zw", -1.1, -0.4),
            y=Axis("z_pole", -1.6, -1.1, label="height of the pole"),
            note="Not a figure of the paper.",
            curves=(Curve(BOWL, "height of the pole", reference="hemisphere_uneven"),),
        ),
    ),
    asked={"z_pole": 5e-7, "lam_pole": 1e-7, "V": 1e-7, "t_level": 2e-8},
)
