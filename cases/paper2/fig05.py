"""Paper 2, figure 5: inflated profiles without and with pre-stretch, at p = 1.5 and p = 1.9."""

from weakforms.cases import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, decide, tube

TUBES = {d: tube(alpha=0.1, delta1=d) for d in (1, 1.5)}
PRESSURES = (1.5, 1.9)


def grows(solutions: Solutions) -> Finding:
    """The pre-stretched tube is wider at both pressures, and both tubes grow."""
    u = {(d, p): solutions.number(TUBES[d], At("p", p), "u_max") for d in TUBES for p in PRESSURES}
    return decide.all_of(
        *(decide.less(f"u_max at p = {p}", u[1, p], u[1.5, p]) for p in PRESSURES),
        *(decide.less(f"u_max of delta1 = {d}", u[d, 1.5], u[d, 1.9]) for d in TUBES),
    )


CASE = Case(
    title="Inflated profiles",
    source="Patil, Nordmark & Eriksson (2014), figure 5",
    panels=(
        Panel(
            "profiles",
            x=Axis("eta", 0, 6),
            y=Axis("rho", 1, 4),
            title=r"$\alpha = 0.1$",
            mirrored=True,
            curves=tuple(
                Curve(
                    TUBES[d],
                    rf"$\delta_1 = {d}$, $p = {p}$",
                    reference=f"fig05_delta1_{d}_p_{p}",
                    at=At("p", p),
                )
                for d in TUBES
                for p in PRESSURES
            ),
        ),
    ),
    checks=(
        Claim(
            "grows",
            "the pre-stretched tube is wider at both pressures",
            tuple((TUBES[d], At("p", p)) for d in TUBES for p in PRESSURES),
            grows,
        ),
    ),
    asked={"rho": 5e-10, "eta": 5e-10, "lam1": 1e-6, "lam2": 5e-10, "t1": 1e-6, "t2": 1e-6},
    quick=True,
)
