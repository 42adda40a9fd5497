"""Paper 1, section 3: the usual no-slip model, in which only the radius of a point sticks.

The text says that both stretches are locked. If only rho is locked, and the patch is in vertical equilibrium,
the indentation is slightly smaller than without friction. This contradicts figure 6 and the abstract, so
that the paper's patch must be locked.
"""

from weakforms.cases import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, circular, decide

ENDS = {1: 4.9, 2: 9.0}
RADIAL = {b: circular(alpha=0.1, beta=b, contact="adhesive", adhesion="radial", p_end=ENDS[b]) for b in ENDS}
SLIP = {b: circular(alpha=0.1, beta=b, contact="frictionless", p_end=9.0) for b in ENDS}
PRESSURES = {1: (2.5, 3.0, 4.0), 2: (6.0, 7.0, 8.0)}


SLIGHTLY = decide.Stated(0.01, "slightly", "no number is printed; a line of figure 6 is as wide")


def indents_less(solutions: Solutions) -> Finding:
    """Pole height compared with frictionless contact at equal pressure."""
    gaps = decide.stack(
        solutions.number(SLIP[b], At("p", p), "t0") - solutions.number(RADIAL[b], At("p", p), "t0")
        for b, pressures in PRESSURES.items()
        for p in pressures
    )
    return decide.all_of(
        decide.positive("t0 less than frictionless by", gaps), decide.at_most("by", gaps, SLIGHTLY)
    )


CASE = Case(
    title="Adhesion that locks the radius only",
    source="Patil, DasGupta & Eriksson (2015), section 3",
    panels=(
        Panel(
            "radial",
            x=Axis("p", 0, 9),
            y=Axis("t0", 0, 0.7),
            markers="contact_onset",
            curves=tuple(
                Curve(RADIAL[b], rf"$\beta = {b}$", reference=f"adhesive_radial_alpha_0.1_beta_{b}")
                for b in ENDS
            ),
        ),
    ),
    checks=(
        Claim(
            "indents_less",
            "with the radius alone locked the indentation is slightly smaller than without friction",
            tuple((of[b], At("p", p)) for of in (RADIAL, SLIP) for b, ps in PRESSURES.items() for p in ps),
            indents_less,
            differs="according to the abstract and figure 6, adhesion increases the indentation; the usual "
            "no-slip model, in which only the radius sticks, decreases it slightly, so that the paper's "
            "patch must lock both stretches",
        ),
    ),
    asked={"p": 1e-7, "t0": 5e-8, "rho_contact": 1e-6, "lam1_contact": 1e-6, "sigma_pole": 1e-7, "V": 1e-6},
)
