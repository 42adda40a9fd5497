"""The bulge that moves to one end, with the relaxed energy: the tube wrinkles beside the near disk.

The ordinary lopsided tube is compressed around the axis soon after its mirror symmetry breaks. A tube that
bears no compression has the same crossing and the same first wrinkle. Beyond, its bulge moves further at the
same volume, by a seventh for the neo-Hookean tube. Two other codes, one of which follows the fronts while the
other one shoots across them, find the same states. With alpha = 0.05 the wrinkles vanish again, and the
states are those of the ordinary tube once more.
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
    Spec,
    decide,
    tube,
)

BRANCH, BEGINS, ONSET = "secondary", "mirror_breaking", "wrinkling_onset"
BASE = tube(extent="full", secondary=True, energy="relaxed", delta1=1.0, lf=6.0)
BASE = BASE.on(degree=6, cells=128, step=0.15)
NEO, CLOSING = BASE.at(alpha=0.0, u_end=2.1), BASE.at(alpha=0.05, u_end=2.6).on(step=0.06)
ORDINARY, ALIKE = (spec.at(energy="standard") for spec in (NEO, CLOSING))
TABLES = {NEO: "lopsided_wrinkled_neo_hookean", CLOSING: "lopsided_wrinkled_alpha_0_05"}
LEGEND = {NEO: r"$\alpha = 0$", CLOSING: r"$\alpha = 0.05$"}
BOTH = {NEO: "relaxed energy", ORDINARY: "ordinary membrane"}
TAUT, TAUT_AGAIN = At("V", 12.1, branch=BRANCH), At("V", 32.0, branch=BRANCH)
BESIDE_DISK = tuple(2 + k / 80 for k in range(81))
BEYOND = At("V", 16.5, branch=BRANCH, profile=BESIDE_DISK)
COUNTED = ("n_negative_volume",)
COLUMNS = ("p", "u_max", "w_mid", "Pi")
ROUND_OFF = decide.Stated(1e-8, "the same", "Newton's last steps; errors of the mesh are the same in both")


def on_branch(solutions: Solutions, spec: Spec, kind: str) -> list:
    """Special points of a kind on the lopsided branch."""
    return [point for point in solutions.points(spec, kind) if point.branch == BRANCH]


def unchanged(solutions: Solutions) -> Finding:
    """Crossing, its curvatures, first and last wrinkle and taut states are those of the ordinary tube."""
    found = []
    for pair in ((NEO, ORDINARY), (CLOSING, ALIKE)):
        for kind, names in ((BEGINS, ("p", "V", "p_2", "V_2")), (ONSET, ("p", "V", "w_mid"))):
            for both in zip(*(on_branch(solutions, spec, kind) for spec in pair), strict=True):
                found += [
                    decide.agree(f"{kind}, {name}", *(decide.of_point(at, name) for at in both), 1e-6)
                    for name in names
                ]
    for pair, at in (((NEO, ORDINARY), TAUT), ((CLOSING, ALIKE), TAUT_AGAIN)):
        for name in COLUMNS:
            here, there = (solutions.number(spec, at, name).value for spec in pair)
            found.append(decide.at_most(f"difference of {name}, taut", abs(here - there), ROUND_OFF))
    return decide.all_of(found)


def further(solutions: Solutions) -> Finding:
    """At the same volume the bulge of the tube that wrinkles is nearer to the disk, at a lower pressure."""
    return decide.all_of(
        decide.less(f"{name} at V = 16.5", *(solutions.number(spec, BEYOND, name) for spec in order))
        for name, order in (("w_mid", (ORDINARY, NEO)), ("p", (NEO, ORDINARY)))
    )


def softer(solutions: Solutions) -> Finding:
    """At the same volume it stores less energy."""
    stored, ordinary = (
        solutions.number(spec, BEYOND, "Pi")
        + solutions.number(spec, BEYOND, "p") * solutions.number(spec, BEYOND, "V")
        for spec in (NEO, ORDINARY)
    )
    return decide.less("energy at V = 16.5", stored, ordinary)


def bears_no_compression(solutions: Solutions) -> Finding:
    """No resultant is negative along the branch; the ordinary tube is compressed over most of it."""
    found = []
    for spec, flags in ((NEO, [0, 1]), (CLOSING, [0, 1, 0])):
        columns = solutions.branch(spec, BRANCH).columns
        found.append(decide.not_negative(f"t_min, {spec}", columns["t_min"], ROUND_OFF.value, 1.0))
        found.append(decide.same(f"wrinkled, {spec}", decide.runs(columns["wrinkled"]), flags))
    found.append(decide.negative("t_min, ordinary", solutions.number(ORDINARY, BEYOND, "t_min")))
    return decide.all_of(found)


def stable(solutions: Solutions) -> Finding:
    """Wrinkled lopsided states too are stable to axisymmetric displacements if the volume is held."""
    return decide.all_of(
        decide.same(f"{name}, {spec}", decide.runs(solutions.branch(spec, BRANCH).columns[name]), [count])
        for spec in TABLES
        for name, count in (("n_negative_volume", 0), ("n_negative", 1))
    )


CASE = Case(
    title="The bulge that moves to one end of a tube that wrinkles",
    source="beyond Patil, Nordmark & Eriksson (2014)",
    panels=(
        *(
            Panel(
                letter,
                x=Axis("V", 11.5, 22.5),
                y=Axis(column, *over),
                title=title,
                counted=COUNTED,
                curves=(
                    Curve(NEO, BOTH[NEO], reference=TABLES[NEO], branch=BRANCH),
                    Curve(ORDINARY, BOTH[ORDINARY], branch=BRANCH),
                ),
            )
            for letter, column, over, title in (
                ("a", "p", (1.2, 1.6), r"Pressure of lopsided states, $\alpha = 0$"),
                ("b", "w_mid", (0, 1.5), r"Their amplitude, $\alpha = 0$"),
            )
        ),
        *(
            Panel(
                letter,
                x=Axis("V", 11.5, 33),
                y=Axis(column, *over),
                title=title,
                markers=(ONSET,) if column == "wrinkled_fraction" else (),
                counted=COUNTED,
                curves=tuple(
                    Curve(spec, LEGEND[spec], reference=TABLES[spec], branch=BRANCH) for spec in TABLES
                ),
            )
            for letter, column, over, title in (
                ("c", "wrinkled_fraction", (0, 0.14), "Part of the length that is wrinkled"),
                ("d", "u_max", (1.3, 2.6), "Radial displacement of the mid-plane"),
            )
        ),
        Panel(
            "e",
            x=Axis("V", 15, 33),
            y=Axis("p", 1.5, 1.75),
            title=r"Pressure of lopsided states, $\alpha = 0.05$",
            counted=COUNTED,
            curves=(
                Curve(CLOSING, "relaxed energy", reference=TABLES[CLOSING], branch=BRANCH),
                Curve(ALIKE, "ordinary membrane", branch=BRANCH),
            ),
        ),
        Panel(
            "f",
            x=Axis("Z", 2.0, 3.0),
            y=Axis("t2", -0.6, 0.6),
            title=r"Hoop resultant beside the near disk, $\alpha = 0$, $V = 16.5$",
            curves=tuple(
                Curve(spec, label, at=BEYOND, branch=BRANCH, y="t2") for spec, label in BOTH.items()
            ),
        ),
    ),
    checks=(
        Claim(
            "unchanged",
            "crossing, first wrinkle and taut states are those of the ordinary membrane",
            ((NEO, TAUT), (ORDINARY, TAUT), (CLOSING, TAUT_AGAIN), (ALIKE, TAUT_AGAIN)),
            unchanged,
        ),
        Claim(
            "further",
            "at the same volume the bulge moves further, at a lower pressure",
            ((NEO, BEYOND), (ORDINARY, BEYOND)),
            further,
        ),
        Claim(
            "softer",
            "at the same volume it stores less energy than the ordinary membrane",
            ((NEO, BEYOND), (ORDINARY, BEYOND)),
            softer,
        ),
        Claim(
            "bears_no_compression",
            "no resultant is negative, where the ordinary membrane is compressed",
            ((NEO, None), (CLOSING, None), (ORDINARY, BEYOND)),
            bears_no_compression,
        ),
        Claim(
            "stable",
            "wrinkled states are stable to axisymmetric displacements if the volume is held",
            tuple((spec, None) for spec in TABLES),
            stable,
        ),
    ),
    asked={"p": 5e-6, "u_max": 1e-5, "w_mid": 1e-4, "wrinkled_fraction": 2e-3},
    slow=True,
)
