"""The bent branch of the fluid-loaded tube of paper 3 with other rubbers: Ogden's and Gent's.

L = 8, delta = 2, gamma = 0.116 with mu = 2 S. The branch and its eigenvalues are compared with the two
two-dimensional reference codes of the paper, which implement the laws separately.
"""

import numpy as np

from weakforms.cases import (
    At,
    Axis,
    Case,
    Claim,
    Curve,
    Finding,
    Panel,
    Solutions,
    decide,
    fluid_tube,
    reference,
)

ENDS = {"ogden": 0.9, "gent": 0.8}
"""Fraction of the highest level at which the primary branch ends, beyond the first bifurcation."""
LOWEST = {"ogden": 0.95, "gent": 0.98}
"""Fraction of the level of the bifurcation at which the bent branch ends."""
TUBES = {
    m: fluid_tube(model=m, zw_end=end, secondary=True).on(secondary_end=LOWEST[m]) for m, end in ENDS.items()
}
BENT = {m: At("zw", zw, branch="secondary", profile=()) for m, zw in {"ogden": 5.2, "gent": 7.44}.items()}


ASKED_OF_STATES = 1e-6
EIGENVALUES = ("Lambda_1", "Lambda_2", "Lambda_3", "Lambda_breaking", "LambdaV_1")
SIDES = ("0", "pi")


def spectrum(solutions: Solutions) -> Finding:
    """Lowest eigenvalues at fixed level, of displacements that break the symmetry, and at fixed volume."""
    found = []
    for m, at in BENT.items():
        table = reference("materials", f"fluid_tube_secondary_{m}")
        row = int(np.argmin(np.abs(table.columns["zw"] - at.value)))
        for name in EIGENVALUES:
            here, known = solutions.number(TUBES[m], at, name), table.number(name)
            largest = np.abs(known.value).max()
            found.append(decide.agree(f"{m}: {name}", here, known[row], ASKED_OF_STATES, largest))
    return decide.all_of(found)


def unstable(solutions: Solutions) -> Finding:
    """Lowest mirror-symmetric eigenvalue at fixed level, and at fixed volume."""
    found = []
    for m, at in BENT.items():
        found.append(decide.negative(f"{m}: Lambda_1", solutions.number(TUBES[m], at, "Lambda_1")))
        found.append(decide.positive("LambdaV_1", solutions.number(TUBES[m], at, "LambdaV_1")))
    return decide.all_of(found)


CASE = Case(
    title="The bent branch of the fluid-loaded tube with other laws",
    source="the problem of Patil, Nordmark & Eriksson (2015) with laws of the thesis's chapter 3",
    panels=(
        Panel(
            "secondary",
            x=Axis("V", 0, 400),
            y=Axis("zw", 0, 10),
            markers=("limit_point", "bifurcation_point"),
            note="Not a figure of the paper.",
            curves=tuple(
                Curve(spec, m, reference=f"fluid_tube_secondary_{m}", branch="secondary")
                for m, spec in TUBES.items()
            ),
        ),
    ),
    checks=(
        Claim(
            "spectrum",
            "the eigenvalues of a bent state are those of the reference",
            tuple((TUBES[m], at) for m, at in BENT.items()),
            spectrum,
        ),
        Claim(
            "unstable",
            "also with these laws the bent states are unstable at fixed level and stable at fixed volume",
            tuple((TUBES[m], at) for m, at in BENT.items()),
            unstable,
        ),
    ),
    asked={
        **dict.fromkeys(("V", "Pi"), 5e-8),
        **dict.fromkeys(("r_mid", "r_mid_pi", *(f"x_quarter_{side}" for side in SIDES)), 2e-7),
        **{f"{name}_quarter_{side}": 1e-6 for name in ("z", "T1", "T2") for side in SIDES},
    },
    slow=True,
)
