"""Paper 3: the secondary branch of L = 24, delta = 1.5, whose dry part is slightly compressed.

A membrane without bending stiffness wrinkles there as finely as the mesh allows: the number of negative
eigenvalues grows with the compression, and from some states of a coarse mesh Newton's method does not find
the states of a finer one. On a coarse mesh the branch can be followed and compared.
"""

from weakforms.cases import Axis, Case, Claim, Curve, Finding, Panel, Solutions, decide, fluid_tube, reference

BENT = fluid_tube(L=24, delta=1.5, secondary=True).on(
    levels=2, secondary_levels=2, secondary_cells=12, secondary_end=0.94
)
TABLE = reference(3, "secondary_L_24_delta_1.5")


def compressed(solutions: Solutions) -> Finding:
    """Smallest principal resultant along the branch, by the reference."""
    return decide.negative("T_min", TABLE.number("T_min"))


def loses_stability(solutions: Solutions) -> Finding:
    """Negative eigenvalues at fixed level: one at the bifurcation, then more and more."""
    counts = solutions.branch(BENT, "secondary").columns["n_negative"]
    return decide.all_of(
        decide.same("at the bifurcation", int(counts[0]), 1),
        decide.every("never fewer", counts[1:] >= counts[:-1]),
        decide.less("at last", 2, int(counts[-1])),
    )


CASE = Case(
    title="A secondary branch with compression",
    source="Patil, Nordmark & Eriksson (2015), figures 2 and 3 and conclusions",
    panels=(
        Panel(
            "r_mid",
            x=Axis("zw", 7.8, 8.4),
            y=Axis("r_mid", 0.8, 1.6),
            title=r"$L/A = 24$, $\delta = 1.5$",
            note="Not a figure of the paper: a part of figure 2b.",
            curves=(Curve(BENT, "secondary", reference="secondary_L_24_delta_1.5", branch="secondary"),),
        ),
    ),
    checks=(
        Claim(
            "compressed",
            "on the secondary branch of L = 24, delta = 1.5 the smaller principal resultant is negative in "
            "the dry part: a membrane wrinkles there",
            (),
            compressed,
            differs="the text says that no wrinkling occurs for the geometries studied; both reference "
            "methods find a resultant down to -4e-4 on this branch",
        ),
        Claim(
            "loses_stability",
            "the number of negative eigenvalues grows along this branch, on the other ones it is one",
            ((BENT, None),),
            loses_stability,
        ),
    ),
    asked={"V": 2e-2, "r_mid": 2e-2, "r_mid_pi": 5e-2},  # on a coarse mesh, to a line's width in figure 2b
    slow=True,
)
