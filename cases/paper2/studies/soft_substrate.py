"""Paper 2, conclusions: the limit pressure of constrained inflation depends on the substrate.

With the stiffness of the figures, k = 20, the pressure rises all the way in contact. A softer substrate has a
limit point in contact.
"""

from weakforms.cases import Axis, Case, Claim, Curve, Finding, Panel, Solutions, decide, tube

SOFT = {0: tube(alpha=0)} | {k: tube(alpha=0, contact="frictionless", k=k) for k in (0.25, 0.5)}
FAR = tube(alpha=0, contact="frictionless", k=0.5, s=1.4)
STRETCHED = tube(alpha=0, contact="frictionless", k=0.25, delta1=1.5)
STIFF = tube(alpha=0, contact="frictionless", k=1.0)


def limit_in_contact(solutions: Solutions) -> Finding:
    """First limit pressures for neo-Hookean tubes, and the pressure of first contact."""
    free, soft, stiffer = (solutions.point(SOFT[k], "limit_point", "p") for k in SOFT)
    far = solutions.point(FAR, "limit_point", "p")
    onsets = [solutions.point(spec, "contact_onset", "p") for spec in (SOFT[0.25], FAR)]
    counts = [len(solutions.points(spec, "limit_point")) for spec in (STIFF, STRETCHED)]
    return decide.all_of(
        decide.less("limit pressure, k = 0, 0.25, 0.5", free, soft, stiffer),
        decide.less("limit pressure, s = 1.4 and 1.3", far, stiffer),
        *(
            decide.less("first contact and limit point", *pair)
            for pair in zip(onsets, (soft, far), strict=True)
        ),
        decide.same("limit points, k = 1 and delta1 = 1.5", counts, [0, 0]),
    )


CASE = Case(
    title="Limit points in contact",
    source="Patil, Nordmark & Eriksson (2014), conclusions",
    panels=(
        Panel(
            "soft",
            x=Axis("p", 0, 3),
            y=Axis("u_max", 0, 3),
            title=r"frictionless, neo-Hookean, $\delta_1 = 1$, $s = 1.3$",
            note="Not a figure of the paper.",
            markers=("limit_point", "contact_onset"),
            curves=tuple(Curve(spec, f"$k = {k}$") for k, spec in (*SOFT.items(), (1, STIFF))),
        ),
    ),
    checks=(
        Claim(
            "limit_in_contact",
            "the limit pressure depends on the substrate and on the pre-stretch: it rises with the stiffness "
            "and with a nearer substrate; a stiff substrate or a pre-stretched tube has none",
            tuple((spec, None) for spec in (*SOFT.values(), FAR, STRETCHED, STIFF)),
            limit_in_contact,
        ),
    ),
)
