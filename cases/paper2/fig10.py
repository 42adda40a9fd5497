"""Paper 2, figure 10: deflating profiles at p = 3, 2, 1.5, 1, 0 (bilateral spring), alpha = 0.1."""

from weakforms.cases import At, Axis, Case, Claim, Curve, Finding, Panel, Path, Solutions, decide, tube

DOWN = (3, 2, 1.5, 1, 0)
BONDED = {
    d: tube(contact="adhesive", phase="deflation", spring="bilateral", alpha=0.1, delta1=d) for d in (1, 2)
}


POINTS = (0.5, 1.0, 1.5, 2.0, 2.6, 2.8)
"""Material points of the paths, of which the first four are in the patch."""
PATHS = {d: Path(BONDED[d], f"paths_fig10{letter}", POINTS) for d, letter in ((1, "a"), (2, "b"))}


def horizontal(solutions: Solutions) -> Finding:
    """Material points of the patch keep their eta while the tube deflates, because it is frozen."""
    found = []
    for d, spec in BONDED.items():
        eta = [solutions.samples(spec, at, "eta").value[:4] for at in PATHS[d].states(2)]
        found += [decide.exact("eta", later, eta[-1]) for later in eta[:-1]]
    return decide.all_of(found)


def curls_inward(solutions: Solutions) -> Finding:
    """Curvature of the free part at the front: negative at p = 3, positive at p = 0."""
    return decide.all_of(
        decide.less(
            f"kappa, delta1 = {d}",
            solutions.number(spec, At("p", 3.0), "kappa"),
            0,
            solutions.number(spec, At("p", 0.0), "kappa"),
        )
        for d, spec in BONDED.items()
    )


CASE = Case(
    title="Deflating profiles",
    source="Patil, Nordmark & Eriksson (2014), figure 10",
    panels=tuple(
        Panel(
            letter,
            x=Axis("eta", 0, 6),
            y=Axis("rho", 1, 1.6),
            title=rf"$\alpha = 0.1$, $\delta_1 = {d}$; substrate at $\rho = 1.3$",
            mirrored=True,
            paths=(PATHS[d],),
            level=1.3,
            curves=tuple(
                Curve(BONDED[d], rf"$p = {p}$", reference=f"fig10{letter}_p_{p}", at=At("p", float(p)))
                for p in DOWN
            ),
        )
        for letter, d in (("a", 1), ("b", 2))
    ),
    checks=(
        Claim(
            "horizontal",
            "material points of the patch move on horizontal lines",
            tuple(wanted for path in PATHS.values() for wanted in path.wants(2)),
            horizontal,
        ),
        Claim(
            "curls_inward",
            "the curvature of the free part at the front changes sign as p falls",
            tuple((spec, At("p", p)) for spec in BONDED.values() for p in (3.0, 0.0)),
            curls_inward,
        ),
    ),
    asked={"rho": 1e-6, "eta": 1e-6, "lam1": 1e-5, "lam2": 1e-6, "t1": 5e-6, "t2": 2e-6},
)
