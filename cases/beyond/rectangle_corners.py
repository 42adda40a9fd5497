"""What the thesis expects of square membranes, judged by numbers: wrinkled corners, broken symmetry.

Section 6.4 has "indications that the corners of square membranes wrinkle when fluid-loaded", and asks for the
relation between symmetry and stability. The numbers say: corners wrinkle in slack frames, under gas and under
a light liquid, from small loads on; under a heavy liquid they stay taut, and in a stretched frame too. No
perturbation that breaks a symmetry becomes unstable in the range computed.
"""

import numpy as np

from weakforms.cases import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, Spec, decide, rectangle

COARSE = {"cells": 8, "levels": 2}
"""Counts and signs do not need more."""

TAUT = [
    rectangle(load="gas", alpha=0.0).on(**COARSE),
    rectangle(load="gas").on(**COARSE),
    *(rectangle(gamma=gamma, w_end=1.2).on(**COARSE) for gamma in (1, 5, 20)),
    rectangle(gamma=1, c=2).on(**COARSE),
    rectangle(load="gas", c=2).on(**COARSE),
]
"""Stretched frames, delta = 1.1, squares and rectangles."""

SLACK = {
    "gas": rectangle(load="gas", delta=1, w_end=1.0).on(cells=16),
    "light": rectangle(gamma=1, delta=1, w_end=1.0).on(cells=16),
    "heavy": rectangle(gamma=5, delta=1, w_end=1.0).on(cells=16),
}
ON_TWO = {name: (spec, spec.on(**COARSE)) for name, spec in SLACK.items()}
"""On two meshes each: the wrinkled area converges slowly, so that its sign is read from both."""
DEEP = (At("w_c", 0.6), At("w_c", 0.8))
WHOLE = [
    (rectangle(**given, w_end=0.9).on(**COARSE), rectangle(**given, w_end=0.9, symmetry="full").on(**COARSE))
    for given in ({"load": "gas", "alpha": 0.0}, {"gamma": 5})
]
SEEN = (At("w_c", 0.15), At("w_c", 0.4), At("w_c", 0.8))
FULL = (
    rectangle(load="gas", w_end=0.9).on(**COARSE),
    rectangle(load="gas", w_end=0.9, energy="full").on(**COARSE),
)
CORNER = decide.Stated(0.9, "in the corner", "a tenth of half the side from both edges")


def unbroken(solutions: Solutions) -> Finding:
    """Counts of the three classes that break a mirror, at all points of the branches."""
    found = []
    for spec in TAUT:
        columns = solutions.branch(spec).columns
        broken = sum(columns[f"n_{name}"] for name in ("odd_even", "even_odd", "odd_odd"))
        found.append(decide.every(f"{spec}: no class that breaks a mirror is unstable", broken == 0))
        found.append(
            decide.same(f"{spec}: bifurcations", len(solutions.points(spec, "bifurcation_point")), 0)
        )
    return decide.all_of(found)


def by_limits(solutions: Solutions) -> Finding:
    """The count of the symmetric class changes at limit loads only: no branch with both mirrors crosses."""
    found = []
    for spec in TAUT:
        n = solutions.branch(spec).columns["n_negative"]
        changes = int(np.count_nonzero(np.diff(n)))
        found.append(decide.same(f"{spec}: changes", changes, len(solutions.points(spec, "limit_point"))))
    return decide.all_of(found)


def sum_rule(solutions: Solutions) -> Finding:
    """Counts of the whole sheet against the sum of the classes on a quarter."""
    found = []
    for quarter, whole in WHOLE:
        counts = [[solutions.value(spec, at, "n_all") for at in SEEN] for spec in (quarter, whole)]
        found.append(decide.same(f"{quarter}", *counts))
    return decide.all_of(found)


def wrinkled(solutions: Solutions) -> Finding:
    """Least stress, its place and the wrinkled part, deep in slack frames, on each of two meshes."""
    found = []
    for name, spec, at in ((n, spec, at) for n in ("gas", "light") for spec in ON_TWO[n] for at in DEEP):
        stress, part, *place = (
            solutions.value(spec, at, n) for n in ("S_least", "f_w", "X_least", "Y_least")
        )
        found += [
            decide.negative(f"{name}: least stress", stress),
            decide.positive(f"{name}: wrinkled part", part),
            *(decide.at_least(f"{name}: its place", x, CORNER) for x in place),
        ]
    return decide.all_of(found)


def taut(solutions: Solutions) -> Finding:
    """No wrinkled part, and positive least stress, under a heavy liquid and in stretched frames."""
    found = []
    for spec in (SLACK["heavy"], *TAUT):
        columns = solutions.branch(spec).columns
        found.append(decide.every(f"{spec}: taut", columns["f_w"] + columns["f_s"] == 0))
        found.append(decide.positive(f"{spec}: least stress", columns["S_least"]))
    return decide.all_of(found)


def alike(solutions: Solutions) -> Finding:
    """Relaxed and full energy of a taut sheet."""
    relaxed, full = ([solutions.number(spec, SEEN[2], name) for name in ("p", "V", "U")] for spec in FULL)
    return decide.all_of(
        decide.agree("relaxed and full", ours.value, theirs.value, 1e-9)
        for ours, theirs in zip(relaxed, full, strict=True)
    )


def _all(specs: list[Spec]) -> tuple[tuple[Spec, None], ...]:
    return tuple((spec, None) for spec in specs)


CASE = Case(
    title="Square and rectangular sheets: wrinkled corners and broken symmetry, the thesis's expectation",
    source="Patil (2016), section 6.4 (future work)",
    panels=(
        Panel(
            "corners",
            x=Axis("w_c", 0, 1.0, "$w_c$"),
            y=Axis("f_w", 0, 0.02, "wrinkled part"),
            note="Slack frames, delta = 1. The area is known to a few digits only.",
            curves=tuple(Curve(spec, name) for name, spec in SLACK.items()),
        ),
    ),
    checks=(
        Claim("unbroken", "no perturbation that breaks a mirror becomes unstable", _all(TAUT), unbroken),
        Claim(
            "by_limits", "symmetric perturbations become unstable at limit loads only", _all(TAUT), by_limits
        ),
        Claim(
            "sum_rule",
            "the classes on a quarter count what the whole sheet counts",
            tuple((spec, at) for pair in WHOLE for spec in pair for at in SEEN),
            sum_rule,
        ),
        Claim(
            "wrinkled",
            "corners of slack frames wrinkle under gas and under a light liquid",
            tuple((spec, at) for name in ("gas", "light") for spec in ON_TWO[name] for at in DEEP),
            wrinkled,
        ),
        Claim(
            "taut",
            "corners stay taut under a heavy liquid, and in stretched frames",
            _all([SLACK["heavy"], *TAUT]),
            taut,
        ),
        Claim(
            "alike",
            "relaxed and full energy agree to all digits where the sheet is taut",
            tuple((spec, SEEN[2]) for spec in FULL),
            alike,
        ),
    ),
    slow=True,
)
