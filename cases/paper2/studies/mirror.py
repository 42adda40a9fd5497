"""Paper 2: does contact of the whole tube break its mirror symmetry?

The paper computes symmetric states. On the whole tube another branch, whose bulge or patch lies beside the
middle, may cross theirs. For the paper's substrate none does. A substrate that the neo-Hookean tube touches
only behind its limit point supports the symmetric state at first, and then loses it: patch and bulge move
to one end.
"""

from weakforms.cases import Axis, Case, Claim, Count, Curve, Finding, Panel, Solutions, decide, tube

SETS = ((0, 1), (0, 2), (0.1, 1), (0.1, 2))
KINDS = (
    {"contact": "frictionless"},
    {"contact": "adhesive"},
    {"contact": "adhesive", "phase": "deflation"},
    {"contact": "adhesive", "phase": "deflation", "spring": "unilateral"},
)
PAPER = [
    tube(alpha=a, delta1=d, extent="full", **kind).on(cells=48, levels=2) for a, d in SETS for kind in KINDS
]
FREE = tube(alpha=0, extent="full", u_end=2)
FAR = {s: tube(alpha=0, contact="frictionless", s=s, extent="full") for s in (2.2, 2.6)}
HALF = {s: spec.at(extent="half") for s, spec in FAR.items()}


def is_stable(solutions: Solutions) -> Finding:
    """No eigenvalue of the whole tube is negative."""
    return decide.every(
        "states without a negative eigenvalue",
        [bool((solutions.branch(spec).columns["n_negative"] == 0).all()) for spec in PAPER],
    )


def breaks_in_contact(solutions: Solutions) -> Finding:
    """The point lies behind first contact. From there to p = 3 only the half tube is stable."""
    kinds = "contact_onset", "bifurcation_point"
    onset, crossing = (solutions.point(FAR[2.2], kind, "p") for kind in kinds)
    counts = [int(solutions.branch(of[2.2]).columns["n_negative"][-1]) for of in (HALF, FAR)]
    return decide.all_of(
        decide.less("first contact and the point", onset, crossing),
        decide.same("negative eigenvalues of half and whole tube at p = 3", counts, [0, 1]),
    )


def same_as_free(solutions: Solutions) -> Finding:
    """A substrate that is touched behind the free tube's point does not change it."""
    free, far = (solutions.point(spec, "bifurcation_point", "p") for spec in (FREE, FAR[2.6]))
    return decide.agree("p of both", far, free, 1e-6)


CASE = Case(
    title="Mirror symmetry of the whole tube in contact",
    source="Patil, Nordmark & Eriksson (2014), the problem of figure 6 on the whole tube",
    panels=(
        Panel(
            "far",
            x=Axis("p", 0, 3),
            y=Axis("u_max", 0, 2),
            title=r"whole tube, frictionless, neo-Hookean, $\delta_1 = 1$",
            note="Not a figure of the paper.",
            markers=("limit_point", "bifurcation_point", "contact_onset"),
            curves=tuple(Curve(spec, f"$s = {s}$") for s, spec in FAR.items()),
        ),
    ),
    checks=(
        Count(
            "bifurcation_point",
            dict.fromkeys(PAPER, 0),
            "no branch crosses that of the whole tube with the paper's substrate",
        ),
        Claim(
            "is_stable",
            "with the paper's substrate the whole tube is stable at fixed pressure, in all phases",
            tuple((spec, None) for spec in PAPER),
            is_stable,
        ),
        Claim(
            "breaks_in_contact",
            "a substrate at s = 2.2, which the neo-Hookean tube touches behind its limit point, holds the "
            "half tube stably, but not the whole one: in contact its symmetry breaks",
            tuple((of[2.2], None) for of in (FAR, HALF)),
            breaks_in_contact,
        ),
        Claim(
            "same_as_free",
            "a substrate at s = 2.6 is touched after the free tube's symmetry has broken, at the same point",
            ((FREE, None), (FAR[2.6], None)),
            same_as_free,
        ),
    ),
    slow=True,
)
