"""Tables of a square airbag at given pressures."""

from __future__ import annotations

import numpy as np

from reference_data.solvers.beyond.airbag.bag import Bag
from reference_data.solvers.core.tables import Levels, Series, Table, agreed, rule
from reference_data.solvers.registry import Builder

NU = 0.4
"""Poisson's ratio of the published set-up."""

CUBIC, QUADRATIC = (3, (8, 16)), (2, (16, 32))
"""Degree of the elements, and numbers of squares along half a side, coarse and fine."""

PRINTED = 5e3 * (1.2 / 8**0.5) / (588e6 * 0.6e-3)
"""``P a/(E h)`` with 5 kPa, a diagonal of 1.2 m, 588 MPa and 0.6 mm."""

PRESSURES = (0.004, PRINTED, 0.009, 0.013, 0.018, 0.024)
"""The printed one and others."""

SERIES = Series(
    paper="beyond",
    source="Square airbag; set-up of a published finite element model (COMSOL)",
    columns={
        "p": ("P a/(E h)", "pressure; a is half the side"),
        "w_c": ("1/a", "height of the centre above the plane of the seam"),
        "V": ("1/a^3", "volume under a quarter of one sheet"),
        "Pi": ("1/(E h a^2)", "potential U - p V of a quarter of one sheet"),
        "u_far": ("1/a", "displacement of the corner towards the centre"),
    },
    method="Two families of elements that share the relaxed energy and its derivatives: least potential "
    "energy on squares (a) with biquadratic and (b) with bicubic polynomials. " + rule("bicubic"),
    grid=f"squares along half a side: (a) {QUADRATIC[1][0]} and {QUADRATIC[1][1]}, "
    f"(b) {CUBIC[1][0]} and {CUBIC[1][1]}",
    tolerance="Newton steps until nodal forces are 1e-11 of the pressure; the tangent is positive definite",
)


PLEATS = 1e-3
"""About half of the range of heights of minima that differ in the pleats of the seam."""


NOTES = (
    "Finer meshes develop more pleats along the seam, to which the relaxed energy has no resistance. The "
    "height of the centre then moves without order: minima on five kinds of elements had heights from "
    "0.5099 to 0.5121 at the printed pressure, and about half of this range is in its uncertainty. The "
    "middle of the seam and the wrinkled part of the area do not converge and are not given."
)


def curve(name: str) -> Table:
    """Minima at the pressures by both families, each on two meshes whose difference is the uncertainty.

    The height of the centre has a further uncertainty, its scatter.
    """
    found = {}
    for key, (degree, counts) in {"a": QUADRATIC, "b": CUBIC}.items():
        coarse, fine = ([Bag(count, degree, NU).least(p) for p in PRESSURES] for count in counts)
        found[key] = {
            n: Levels([x[n] for x in coarse], [x[n] for x in fine], floor=PLEATS if n == "w_c" else 0.0)
            for n in SERIES.columns
            if n != "p"
        }
    columns = SERIES.keys(p=np.array(PRESSURES))
    columns += [
        agreed(name, n, found["a"][n], first, SERIES.columns[n], "biquadratic", "bicubic")
        for n, first in found["b"].items()
    ]
    facts = {"mesh": "airbag", "model": "saint_venant_kirchhoff", "poisson": NU, "delta": 1.0}
    return SERIES.table(name, "Square airbag over the pressure", "", facts, columns, notes=NOTES)


TABLES: dict[str, Builder] = {"airbag": lambda: curve("airbag")}
"""A square airbag: least energy of one sheet on quadrilateral elements."""
