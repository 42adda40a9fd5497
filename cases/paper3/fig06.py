"""Paper 3, figure 6: principal stress resultants on the secondary branch at zw = 7.779, three meridians.

Neither the length nor the pre-stretch is printed. L = 24 must be meant, because figure 8(b) has that level,
and the paper says of this figure that T2 is constant and low from the centre to the top. delta = 2 is
assumed. The secondary branch of the short tube reaches this level too, which is shown as an extra.

On the two meridians of the plane of symmetry the principal directions are the meridian's and the
circumference's. T1 >= T2, and T1 belongs to the larger stretch.
"""

from weakforms.cases import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, decide, fluid_tube

TUBES = {
    length: fluid_tube(L=length, delta=2, secondary=True).on(
        secondary_cells=48, secondary_around=around, secondary_step=step, secondary_end=end
    )
    for length, around, end, step in ((24, 24, 0.96, 0.25), (8, 32, 0.92, 0.18))
}
"""On twice as many cells along the tube as by default, which resolve the foot of the bulge, and just past the
states drawn in figures 6 and 8, which share these solutions. The steps are long, because no branch is drawn.
Around the long tube 24 cells are enough; the short one needs 32 for a state of figure 8."""
TABLES = {24: "fig06", 8: "fig06_L_8"}
BENT = At("zw", 7.779, branch="secondary", profile=())
MERIDIANS = {0: r"$\Theta = 0$", 90: r"$\Theta = \pi/2$", 180: r"$\Theta = \pi$"}
RANGES = {"T1": (0, 2.5), "T2": (0, 1.2)}


LOW = decide.Stated(0.1, "low", "no number is printed; a tenth of the largest")


def no_wrinkles(solutions: Solutions) -> Finding:
    """Smallest principal resultant anywhere."""
    return decide.all_of(
        decide.positive(f"T_min, L = {length}", solutions.number(tube, BENT, "T_min"))
        for length, tube in TUBES.items()
    )


def low_above(solutions: Solutions) -> Finding:
    """T2 of the long tube from its middle to near the upper ring, against its largest value."""
    where, t2 = solutions.profile(TUBES[24], BENT).columns["Z"], solutions.column(TUBES[24], BENT, "T2")
    above = (where > 6) & (where < 11)
    return decide.at_most(
        "largest T2 there over the largest anywhere", t2[above].largest() / t2.largest(), LOW
    )


CASE = Case(
    title="Stress resultants on the secondary branch",
    source="Patil, Nordmark & Eriksson (2015), figure 6",
    panels=tuple(
        Panel(
            f"{letter}, L = {length}" if length == 24 else f"extra {letter}, L = {length}",
            x=Axis("Z", 0, length / 2),
            y=Axis(name, *RANGES[name]),
            title=rf"$L/A = {length}$, $\delta = 2$, $z_w = 7.779$",
            note=""
            if length == 24
            else "Not in the paper: the secondary branch of the short tube at the same level.",
            curves=tuple(
                Curve(tube, label, reference=f"{TABLES[length]}@{degrees}", at=BENT, y=name)
                for degrees, label in MERIDIANS.items()
            ),
        )
        for length, tube in TUBES.items()
        for letter, name in (("a", "T1"), ("b", "T2"))
    ),
    checks=(
        Claim(
            "no_wrinkles",
            "both principal resultants are positive everywhere on the secondary branch",
            tuple((tube, BENT) for tube in TUBES.values()),
            no_wrinkles,
        ),
        Claim(
            "low_above",
            "T2 of the long tube is low from the centre to the top",
            ((TUBES[24], BENT),),
            low_above,
        ),
    ),
    asked={**dict.fromkeys(("z", "lam1", "lam2"), 1e-5), **dict.fromkeys(("T1", "T2"), 5e-5)},
)
