"""Paper 1's scheme for adhesive contact on a fixed mesh, and its limit.

The pole is raised by equal steps, and the ring that touched within a step is frozen at its end. The scheme is
of first order in the step. At t0 = 0.57 a step of 0.01 gives a pressure 2.6 % too high.
"""

import numpy as np

from weakforms.cases import At, Case, Claim, Finding, Solutions, circular, circular_scheme, decide, reference

STEPS = (14, 28, 56)
RUNS = [circular_scheme(t_end=0.57).on(steps=n, cells=50 * n) for n in STEPS]
LIMIT, END = circular(contact="adhesive", p_end=4.0), At("t0", 0.57)
COARSE = 0.1
"""Accuracy asked of the scheme, which is of first order, with the front within a cell of a coarse mesh."""


def tends_to_limit(solutions: Solutions) -> Finding:
    """Errors against the front-fitted solution: their mean rate, and their bounds on the finest meshes."""
    found = []
    for name in ("p", "rho_contact"):
        limit = solutions.number(LIMIT, END, name)
        runs = decide.stack(solutions.whole(spec, name) for spec in RUNS)
        errors = decide.Number(runs.value - limit.value, limit.uncertainty)
        found.append(decide.mean_order(name, STEPS, errors, 1))
        found.append(
            decide.agree(f"{name} on the finest meshes", runs[-2:], limit.value * np.ones(2), COARSE)
        )
    return decide.all_of(found)


def same_steps(solutions: Solutions) -> Finding:
    """Pressure with a step of the pole, against the reference with the same step and no error of a mesh."""
    table, found = reference(1, "freezing_scheme"), []
    step, p = table.columns["delta_t"], table.columns["p"]
    for n, spec in zip(STEPS, RUNS, strict=True):
        (row,) = np.flatnonzero(np.isclose(step, (END.value - 0.5) / n))
        off = abs(solutions.whole(spec, "p").value - p[row]) / abs(p[row] - p[step == 0][0])
        found.append(decide.at_most(f"{n} steps: off over the step's own error", off, OF_THE_MESH))
    return decide.all_of(found)


OF_THE_MESH = decide.Stated(
    0.1, "agree", "the mesh has 50 cells for each step, so that its error is a fraction of the step's"
)

CASE = Case(
    title="Freezing scheme on a fixed mesh",
    source="the algorithm of Patil, DasGupta & Eriksson (2015), section 3",
    checks=(
        Claim(
            "tends_to_limit",
            "freezing ring after ring tends to the continuous history, with first order in the step",
            (*((spec, None) for spec in RUNS), (LIMIT, END)),
            tends_to_limit,
        ),
        Claim(
            "same_steps",
            "with the same steps the scheme on a mesh and the reference's scheme without one agree",
            tuple((spec, None) for spec in RUNS),
            same_steps,
        ),
    ),
)
