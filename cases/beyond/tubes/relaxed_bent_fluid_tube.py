"""A bent tube full of liquid that bears no compression: it wrinkles at the lower ring.

The neo-Hookean tube bends while it is taut, and its bent states stay taut until the level has fallen by a
seventh. From there on the ordinary membrane is compressed around the axis at the lower ring, and the one with
the relaxed energy wrinkles. Both have the same states before. Beyond, the volume at a level differs by 3e-5
at most, because less than two thousandths of the surface are wrinkled. Two other codes find the same states.
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
)

BRANCH, KIND, TABLE = "secondary", "bifurcation_point", "bent_liquid_wrinkled"
RELAXED = fluid_tube(secondary=True, energy="relaxed", L=12.0, delta=1.4, gamma=0.03, n_max=1).on(
    cells=64, levels=2, secondary_cells=48, secondary_levels=2, secondary_step=0.2, secondary_end=0.8
)
ORDINARY = RELAXED.at(energy="standard")
BOTH = {RELAXED: "relaxed energy", ORDINARY: "ordinary membrane"}
TAUT = At("zw", 19.0, branch=BRANCH)
BEYOND = tuple(At("zw", level, branch=BRANCH) for level in (17.4, 17.1))
COLUMNS = ("V", "r_mid", "Pi", "x_quarter_pi")
ROUND_OFF = decide.Stated(1e-8, "the same", "Newton's last steps; errors of the mesh are the same in both")


def unchanged(solutions: Solutions) -> Finding:
    """Where the branch begins, and while it is taut, its states are those of the ordinary membrane."""
    begins, bent = [], []
    for spec in BOTH:
        (point,) = (p for p in solutions.points(spec, KIND) if p.branch == BRANCH)
        begins.append(point.values)
        bent.append({name: solutions.number(spec, TAUT, name).value for name in COLUMNS})
    return decide.all_of(
        decide.at_most(
            f"difference of {name}, {where}, over its size", abs(ours[name] / theirs[name] - 1), ROUND_OFF
        )
        for where, (ours, theirs), names in (
            ("bifurcation", begins, ("zw", "V", "dzw_dV")),
            ("taut", bent, COLUMNS),
        )
        for name in names
    )


def differs(solutions: Solutions) -> Finding:
    """Beyond, the wrinkled tube holds less liquid at the same level."""
    return decide.all_of(
        decide.less(f"V at {at}", *(solutions.number(spec, at, "V") for spec in (RELAXED, ORDINARY)))
        for at in BEYOND
    )


def wrinkles(solutions: Solutions) -> Finding:
    """The wrinkled part is zero at first and then grows to the end of the branch."""
    part = solutions.branch(RELAXED, BRANCH).columns["wrinkled_fraction"]
    begun = int(np.argmax(part > 0))
    taut = solutions.number(RELAXED, TAUT, "wrinkled_fraction").value
    return decide.all_of(
        [
            decide.exact("wrinkled part of the taut state", taut, 0.0),
            decide.exact("wrinkled part at the bifurcation", part[0], 0.0),
            decide.rises("wrinkled part from its first point on", part[begun - 1 :].tolist()),
            *(
                decide.positive(
                    f"wrinkled part at {at}", solutions.number(RELAXED, at, "wrinkled_fraction").value
                )
                for at in BEYOND
            ),
        ]
    )


def same_stability(solutions: Solutions) -> Finding:
    """One eigenvalue is negative at a given level along the whole branch, wrinkled or not."""
    counts = solutions.branch(RELAXED, BRANCH).columns["n_negative"]
    return decide.same("negative eigenvalues", decide.runs(counts), [1])


CASE = Case(
    title="The bent tube of liquid that wrinkles instead of being compressed",
    source="beyond Patil, Nordmark & Eriksson (2015), figure 2",
    panels=(
        *(
            Panel(
                letter,
                x=Axis("zw", 16.8, 21.4),
                y=Axis(column, *over),
                title=title,
                markers=(KIND,) if column == "r_mid" else (),
                curves=(
                    Curve(RELAXED, BOTH[RELAXED], reference=TABLE, branch=BRANCH),
                    Curve(ORDINARY, BOTH[ORDINARY], branch=BRANCH),
                ),
            )
            for letter, column, over, title in (
                ("a", "V", (215, 265), "Volume of bent states"),
                ("b", "r_mid", (1.4, 2.8), "Their largest bulge, at mid-length"),
            )
        ),
        Panel(
            "c",
            x=Axis("zw", 16.8, 21.4),
            y=Axis("wrinkled_fraction", 0, 0.003),
            title="Part of the surface that is wrinkled",
            curves=(Curve(RELAXED, BOTH[RELAXED], branch=BRANCH),),
        ),
    ),
    checks=(
        Claim(
            "unchanged",
            "while it is taut, the bent tube is that of the ordinary membrane",
            tuple((spec, TAUT) for spec in BOTH),
            unchanged,
        ),
        Claim(
            "differs",
            "beyond, at the same level it holds less",
            tuple((spec, at) for spec in BOTH for at in BEYOND),
            differs,
        ),
        Claim(
            "wrinkles",
            "its wrinkled part is zero at first and then grows",
            tuple((RELAXED, at) for at in (TAUT, *BEYOND)),
            wrinkles,
        ),
        Claim(
            "same_stability",
            "one eigenvalue is negative at a given level, while it is taut and when it is wrinkled",
            ((RELAXED, None),),
            same_stability,
        ),
    ),
    asked={"V": 1e-5, "r_mid": 2e-5, "Pi": 1e-5, "x_quarter_pi": 1e-4, "z_quarter_pi": 2e-5},
    slow=True,
)
