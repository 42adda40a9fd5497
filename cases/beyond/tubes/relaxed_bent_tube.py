"""A bent tube that bears no compression: it wrinkles at the disk, between its outer and its inner side.

The neo-Hookean tube of ten radii bends while it is taut, and its bent states stay taut up to a volume of 6.4
or so. From there on the ordinary membrane is compressed around the axis at the disk, and the one with the
relaxed energy wrinkles. Both have the same states before. Beyond, the pressure differs by 1e-5 and the
amplitude by 2e-4, because a thousandth of the surface is wrinkled. Two other codes find the same states.
"""

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
    tube,
)

BRANCH, KIND, TABLE = "secondary", "bifurcation_n1", "bent_tube_wrinkled"
RELAXED = tube(
    secondary=True, secondary_n=1, energy="relaxed", alpha=0.0, delta1=1.0, lf=10.0, u_end=1.08
).on(degree=6, cells=48, levels=2, step=0.3, secondary_cells=24, secondary_around=12)
ORDINARY = RELAXED.at(energy="standard")
BOTH = {RELAXED: "relaxed energy", ORDINARY: "ordinary membrane"}
TAUT = At("V", 6.15, branch=BRANCH)
BEYOND = tuple(At("V", v, branch=BRANCH) for v in (7.0, 7.4))
COLUMNS = ("p", "u_max", "u_wave", "Pi")
COUNTS = ("n_negative_volume", "n_negative_all_volume")
ROUND_OFF = decide.Stated(1e-8, "the same", "Newton's last steps; errors of the mesh are the same in both")


def unchanged(solutions: Solutions) -> Finding:
    """Where the branch begins, and while it is taut, its states are those of the ordinary membrane."""
    begins, bent = [], []
    for spec in BOTH:
        (point,) = (p for p in solutions.points(spec, KIND) if p.branch == BRANCH)
        begins.append(point.values)
        bent.append({name: solutions.number(spec, TAUT, name).value for name in COLUMNS})
    return decide.all_of(
        decide.at_most(f"difference of {name}, {where}", abs(ours[name] - theirs[name]), ROUND_OFF)
        for where, (ours, theirs), names in (
            ("crossing", begins, ("p", "V", "p_2", "V_2")),
            ("taut", bent, COLUMNS),
        )
        for name in names
    )


def differs(solutions: Solutions) -> Finding:
    """At the same volume the wrinkled tube is bent further."""
    return decide.all_of(
        decide.less(
            f"u_wave at {at}", *(solutions.number(spec, at, "u_wave") for spec in (ORDINARY, RELAXED))
        )
        for at in BEYOND
    )


def bears_no_compression(solutions: Solutions) -> Finding:
    """No resultant of the wrinkled tube is negative, where the ordinary membrane is clearly compressed."""
    found = []
    for at in BEYOND:
        least = solutions.number(RELAXED, at, "t_min")
        found.append(decide.at_most(f"magnitude of t_min at {at}", abs(least.value), ROUND_OFF))
        # On both meshes; how much it is compressed at the disk depends on them.
        compressed = solutions.number(ORDINARY, at, "wrinkled")
        found.append(decide.exact(f"compression of the ordinary membrane at {at}", compressed.value, 1.0))
        found.append(
            decide.positive(
                f"wrinkled part at {at}", solutions.number(RELAXED, at, "wrinkled_fraction").value
            )
        )
    columns = solutions.branch(RELAXED, BRANCH).columns
    found.append(decide.not_negative("t_min along the branch", columns["t_min"], ROUND_OFF.value, 1.0))
    found.append(decide.same("wrinkled", decide.runs(columns["wrinkled"]), [0, 1]))
    return decide.all_of(found)


def stable(solutions: Solutions) -> Finding:
    """Wrinkled states have no negative eigenvalue at a given volume, of any class, on any of the meshes."""
    return decide.all_of(
        decide.exact(f"{name} at {at}", solutions.number(RELAXED, at, name).value, 0.0)
        for at in BEYOND
        for name in COUNTS
    )


CASE = Case(
    title="The bent tube that wrinkles instead of being compressed",
    source="beyond Patil, Nordmark & Eriksson (2014)",
    panels=(
        *(
            Panel(
                letter,
                x=Axis("V", 5.8, 7.6),
                y=Axis(column, *over),
                title=title,
                markers=(KIND,) if column == "u_wave" else (),
                curves=(
                    Curve(RELAXED, BOTH[RELAXED], reference=TABLE, branch=BRANCH),
                    Curve(ORDINARY, BOTH[ORDINARY], branch=BRANCH),
                ),
            )
            for letter, column, over, title in (
                ("a", "p", (1.56, 1.67), "Pressure of bent states"),
                ("b", "u_wave", (0, 1.9), "Their amplitude"),
            )
        ),
        Panel(
            "c",
            x=Axis("V", 5.8, 7.6),
            y=Axis("t_min", -0.2, 0.25),
            title="Smallest principal resultant of bent states",
            curves=tuple(Curve(spec, label, branch=BRANCH) for spec, label in BOTH.items()),
        ),
        Panel(
            "d",
            x=Axis("V", 5.8, 7.6),
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
            "beyond, at the same volume it is bent further",
            tuple((spec, at) for spec in BOTH for at in BEYOND),
            differs,
        ),
        Claim(
            "bears_no_compression",
            "no resultant is negative, where the ordinary membrane is compressed",
            tuple((spec, at) for spec in BOTH for at in BEYOND),
            bears_no_compression,
        ),
        Claim(
            "stable",
            "wrinkled states are stable to every displacement that the meshes resolve if the volume is held",
            tuple((RELAXED, at) for at in BEYOND),
            stable,
        ),
    ),
    asked={"p": 1e-5, "u_max": 2e-5, "u_wave": 8e-5},
    slow=True,
)
