"""A clamped rubber disk under gas: the thin limit of a benchmark of finite elements, by two problems.

Oden (1972) and Hughes & Carnoy (1983) inflate a disk of radius 7.5 in, 0.5 in thick, of Mooney and Rivlin's
law with 80 and 20 pounds per square inch. A thickness of a fifteenth of the radius is not that of a membrane:
their curves lie beside this one and are not compared. Pressures are 5.333 p pounds per square inch, heights
7.5 t0 in.
"""

import numpy as np

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
    circular,
    decide,
    membrane,
    reference,
)

ALPHA = 0.25
LINE = circular(alpha=ALPHA, beta=1, l=5)
"""Along the radius; the substrate is out of reach."""

TRIANGLES = membrane(alpha=ALPHA, delta=1, w_end=1.3).on(cells=12, degree=2)
"""On triangles, without symmetry."""

ASKED = {"p": 1e-7, "lam_pole": 1e-7, "lam1_rim": 5e-6, "V": 1e-7}
OF_TRIANGLES = 1e-3
"""Asked of quadratic triangles on coarse meshes."""

TABLE = reference("beyond", "rubber_disk")
HEIGHTS = (0.5, 0.8, 1.2)
"""Rows at which triangles are compared."""


def triangles(solutions: Solutions) -> Finding:
    """Pressure and volume of triangles; ``V`` of the table is over ``2 pi``."""
    found = []
    for height in HEIGHTS:
        row = int(abs(TABLE.columns["t0"] - height).argmin())
        for name, factor in {"p": 1.0, "V": 2 * np.pi}.items():
            theirs = decide.Number(TABLE.columns[name][row], TABLE.uncertainty[name])
            ours = solutions.number(TRIANGLES, At("w_c", float(TABLE.columns["t0"][row])), name)
            found.append(decide.agree(f"{name} at w_c = {height:g}", ours, factor * theirs, OF_TRIANGLES))
    return decide.all_of(found)


CASE = Case(
    title="A rubber disk, as a membrane",
    source="a benchmark of finite elements for rubber: the inflated disk",
    panels=(
        Panel(
            "pressure",
            x=Axis("t0", 0, 4),
            y=Axis("p", 0, 14),
            note="Not a figure of the thesis. The published disk is thick: R = 7.5 in, h = 0.5 in.",
            curves=(Curve(LINE, r"$\alpha = 0.25$", reference="rubber_disk"),),
        ),
    ),
    checks=(
        Count("limit_point", {LINE: 0}, "number of limit pressures up to a height of five radii"),
        Claim(
            "triangles",
            "a disk of triangles has the pressure and the volume of the table",
            tuple((TRIANGLES, At("w_c", h)) for h in HEIGHTS),
            triangles,
        ),
    ),
    asked=ASKED,
    slow=True,
)
