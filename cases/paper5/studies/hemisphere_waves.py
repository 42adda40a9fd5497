"""Paper 5: short waves around the hemisphere on triangles in space, against its spectrum by wave number.

A mesh whose edges follow the meridians resolves waves that do not stretch the meridian; unstructured meshes
stiffen them (95818 triangles show none at zw = -0.97). On N columns of linear triangles n waves
have the derivative of N/(2 pi) sin(2 pi n/N) waves, so that no more than N/(2 pi) are resolved: 51 on
the finer mesh here.
"""

import numpy as np

from weakforms.cases import At, Case, Claim, Finding, Solutions, decide, hemisphere, surface

COARSE, FINE = (
    surface(
        geometry="hemisphere",
        layout="columns",
        meridional=columns // 4,
        circumferential=columns,
        load_start=-0.7,
        load_end=-0.95,
    ).on(scan=5, shown=5, eigenvalues=1, tolerance=5e-3)
    for columns in (160, 320)
)
FREE = surface(geometry="hemisphere", size=0.025, load_start=-0.7, load_end=-0.95).on(
    scan=5, shown=5, eigenvalues=1
)
HIGH, LOW = At("zw", -0.7), At("zw", -0.95)
WAVES = (20, 24, 30, 40, 50)
BOWL = hemisphere(n=WAVES, low_end=-1.1)


def resolved(n: float, columns: int) -> float:
    """Wave number whose derivative ``n`` waves have on some columns of linear triangles."""
    return columns / (2 * np.pi) * float(np.sin(2 * np.pi * n / columns))


def negative(solutions: Solutions) -> Finding:
    """Negative eigenvalues of the whole surface, and the lowest one for n = 50, at high and low levels."""
    counts = {s: solutions.branch(s).columns["n_negative"] for s in (COARSE, FINE, FREE)}
    return decide.all_of(
        decide.same("negative on the fine mesh, high", int(counts[FINE][0]), 0),
        decide.less("none, and negative on the fine mesh, low", 0, int(counts[FINE][-1])),
        decide.same("in pairs, sine and cosine", int(counts[FINE][-1]) % 2, 0),
        decide.every("none on fewer columns", counts[COARSE] == 0),
        decide.every("none on an unstructured mesh", counts[FREE] == 0),
        decide.positive("n = 50, high", solutions.number(BOWL, HIGH, "Lambda_n50_1")),
        decide.negative("n = 50, low", solutions.number(BOWL, LOW, "Lambda_n50_1")),
    )


def onset(solutions: Solutions) -> Finding:
    """Where the fine mesh becomes unstable, with the waves that it resolves, and levels of the spectrum."""
    first = solutions.points(FINE, "stability_change")[0]
    level, n = decide.of_point(first, "zw"), resolved(first.values["n"], 320)
    changes = {p.values["n"]: decide.of_point(p, "zw") for p in solutions.points(BOWL, "stability_change")}
    return decide.all_of(
        decide.between("waves that the mesh resolves there", n, WAVES[-2], WAVES[-1]),
        decide.less("level: below the spectrum's for n = 50", level, changes[50.0]),
        decide.less("level: above the spectrum's for n = 24", changes[24.0], level),
    )


CASE = Case(
    title="Short waves around the hemisphere on triangles in space",
    source="Patil, Nordmark & Eriksson (2016), figure 10(b) and section 5",
    checks=(
        Claim(
            "negative",
            "at a low level the surface in space is unstable, as the spectrum is for n = 50, if the mesh has "
            "enough columns; at a high level both are stable",
            ((COARSE, None), (FINE, None), (FREE, None), (BOWL, HIGH), (BOWL, LOW)),
            negative,
        ),
        Claim(
            "onset",
            "the waves that appear first are those that the mesh just resolves, a little below the level of "
            "the spectrum",
            ((FINE, None), (BOWL, None)),
            onset,
        ),
    ),
    slow=True,
)
