"""A square airbag: two sheets joined at their edges, with a seam that slides in its plane and wrinkles.

The set-up is that of COMSOL's model and of earlier papers: a diagonal of 1.2 m, 5 kPa, E = 588 MPa, nu = 0.4.
The thickness is printed as 6 mm and as 0.6 mm; with 0.6 mm the pressure is 6.01e-3 E h/a, a half the side. By
symmetry a quarter of one sheet is solved. Numbers depend on the pressure alone, so that p = 6.01e-4 is the
other thickness.
"""

from weakforms.cases import (
    At,
    Axis,
    Case,
    Claim,
    Count,
    Curve,
    Finding,
    Panel,
    Solutions,
    decide,
    membrane,
    reference,
)

NU = 0.4
LAW = {"model": "saint_venant_kirchhoff", "shear": 1 / (2 * (1 + NU)), "poisson": NU}
"""Stresses over Young's modulus: shear = 1/(2 (1 + nu))."""

BAG = membrane(mesh="airbag", delta=1, w_end=0.5106, **LAW).on(degree=1, cells=32, p_start=5.9e-3)
"""Straight triangles of degree 1, on a short branch around the printed pressure."""

CURVED = membrane(mesh="airbag", delta=1, w_end=0.523, **LAW).on(degree=2, cells=16, p_start=3.5e-3)
"""Curved triangles of degree 2, on a branch over several pressures."""

RUBBER = membrane(mesh="airbag", delta=1, alpha=0.0, w_end=0.8).on(cells=4, levels=2, p_start=0.05)
"""Another law, from a state with larger strains."""

MINIMA = tuple((spec, None) for spec in (BAG, CURVED, RUBBER))
"""Branches whose stability is counted."""

ASKED = {"w_c": 3e-2, "V": 3e-3, "Pi": 5e-3, "u_far": 0.1}
"""Pleats of the seam move the height of the centre, and most of all the corner."""

TABLE = reference("beyond", "airbag")
ROW = 1
PRINTED = At("p", float(TABLE.columns["p"][ROW]))
"""5 kPa on 0.6 mm."""


def quadrilaterals(solutions: Solutions) -> Finding:
    """Every column of the table."""
    found = []
    for column, asked in ASKED.items():
        theirs = decide.Number(TABLE.columns[column][ROW], TABLE.uncertainty[column])
        found.append(decide.agree(column, solutions.number(BAG, PRINTED, column), theirs, asked))
    return decide.all_of(found)


def wrinkles(solutions: Solutions) -> Finding:
    """The wrinkled part of the sheet."""
    return decide.positive("wrinkled part", solutions.number(BAG, PRINTED, "f_w"))


def stable(solutions: Solutions) -> Finding:
    """No negative eigenvalue at any point: the states on these meshes are minima."""
    return decide.all_of(
        decide.every(f"{spec}", solutions.branch(spec).columns["n_negative"] == 0) for spec, _ in MINIMA
    )


CASE = Case(
    title="A square airbag, wrinkled along its seam",
    source="a benchmark of codes for wrinkled membranes: the square airbag",
    panels=(
        Panel(
            "airbag",
            x=Axis("p", 0, 0.03),
            y=Axis("V", 0.2, 0.22),
            note="Not a figure of the thesis. The pressure of 0.6 mm is 0.006, that of 6 mm 0.0006.",
            curves=(Curve(CURVED, r"$\nu = 0.4$", reference="airbag"),),
        ),
    ),
    checks=(
        Count("limit_point", {RUBBER: 0}, "number of limit pressures up to w_end"),
        Claim(
            "quadrilaterals",
            "triangles have the centre, corner, volume and energy of quadrilaterals of higher degree",
            ((BAG, PRINTED),),
            quadrilaterals,
        ),
        Claim(
            "wrinkles",
            "a part of the sheet is wrinkled",
            ((BAG, PRINTED),),
            wrinkles,
        ),
        Claim("stable", "the states are minima of the energy on these meshes", MINIMA, stable),
    ),
    asked=ASKED,
    slow=True,
)
