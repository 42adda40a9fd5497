"""Lines of limit points of parts of spheres under gas: over the ratio C2/C1, and over the angle of the clamp.

The hemisphere is the part up to a right angle. Limit points vanish in cusps: in one over C2/C1, where the law
has become stiff enough, and in one over the angle, where the part has become shallow enough. The lines pass
through the limit point of the problem hemisphere, and lie between that of the flat disk of circular
and that of the whole balloon of sphere. No limit point is unstable to waves around the axis. Two
other methods check the lowest eigenvalues of these waves on the hemisphere.
"""

from math import sin

from weakforms.cases import (
    At,
    Axis,
    Case,
    Claim,
    Count,
    Curve,
    Finding,
    Panel,
    Points,
    Solutions,
    circular,
    decide,
    diagram,
    hemisphere,
    sphere,
)

CAP = {"body": "hemisphere", "kind": "fold"}
OVER_ALPHA = diagram(**CAP, x="alpha", high=0.2).on(cells=24, levels=2)
OVER_ANGLE = diagram(body="hemisphere", kind="fold,n1,n2,n3", alpha=0.0, high=2.4, t_end=4.5).on(
    cells=24, levels=2
)
STIFFER = diagram(**CAP, alpha=0.1, low=1.3, high=2.0).on(cells=24, levels=2)
HANGING = hemisphere(load="gas", energy="relaxed")
WAVES = hemisphere(load="gas", energy="relaxed", n=(1, 2, 3))
EIGENVALUES = tuple(f"Lambda_n{n}_1" for n in (1, 2, 3))
FLAT, BALLOON = circular(alpha=0, beta=1, t_end=1.5), sphere(model="mooney_rivlin", alpha=0.0)
FIRST = At("alpha", 0.0, branch="fold")
SHALLOW, DEEP, DEEPER = (At("angle", angle, branch="fold") for angle in (0.4, 1.6, 2.4))


def the_hemisphere(solutions: Solutions) -> Finding:
    """The first point of the line is the limit point of the problem ``hemisphere``."""
    return decide.all_of(
        decide.agree(
            name,
            solutions.number(OVER_ALPHA, FIRST, name),
            solutions.point(HANGING, "limit_point", name, 0),
            1e-8,
        )
        for name in ("p", "V", "lam_pole")
    )


def between(solutions: Solutions) -> Finding:
    """Pressures lie between those of the flat disk and, over the radius of the sphere, of the balloon."""
    by_clamp = [solutions.number(OVER_ANGLE, at, "p") for at in (DEEPER, DEEP, SHALLOW)]
    by_sphere = [
        decide.number(solutions.number(OVER_ANGLE, at, "p")) / sin(at.value) for at in (DEEPER, DEEP)
    ]
    return decide.all_of(
        decide.less("p, the last of the flat disk", *by_clamp, solutions.point(FLAT, "limit_point", "p", 0)),
        decide.less(
            "p/sin(angle), the first of the balloon",
            solutions.point(BALLOON, "limit_point", "P", 0),
            *by_sphere,
        ),
    )


def no_waves(solutions: Solutions) -> Finding:
    """No limit point is unstable to waves around the axis."""
    line = solutions.branch(OVER_ANGLE, "fold").columns
    return decide.all_of(
        decide.same(f"n = {n}", sorted(set(line[f"n_negative_n{n}"].tolist())), [0]) for n in (1, 2, 3)
    )


CASE = Case(
    title="Lines of limit points of parts of spheres",
    source="the membrane of Patil, Nordmark & Eriksson (2016)",
    panels=(
        Panel(
            "a",
            x=Axis("alpha", 0, 0.12),
            y=Axis("p", 3, 4.5),
            title="hemisphere",
            markers="cusp_point",
            curves=(Curve(OVER_ALPHA, "limit points", "caps_fold_alpha", branch="fold"),),
        ),
        Panel(
            "b",
            x=Axis("angle", 0.4, 2.4),
            y=Axis("p", 1, 4.5),
            title="parts of spheres",
            markers="cusp_point",
            curves=(
                Curve(OVER_ANGLE, "neo-Hookean", "caps_fold_angle", branch="fold"),
                Curve(STIFFER, r"$\alpha = 0.1$", branch="fold"),
            ),
        ),
        Panel(
            "c",
            x=Axis("p", 0, 3.2),
            y=Axis("Lambda", 0, 30),
            title="waves around the hemisphere",
            curves=tuple(Curve(WAVES, f"$n = {name[8]}$", "caps_waves", y=name) for name in EIGENVALUES),
        ),
    ),
    checks=(
        Count("cusp_point", {OVER_ALPHA: 1, OVER_ANGLE: 0, STIFFER: 1}, "limit points merge in cusps"),
        *(
            Points(
                "cusp_point",
                reference=table,
                base=spec,
                parameters=(),
                asked=dict.fromkeys((vary, "p", "t0", "lam_pole"), 1e-6),
            )
            for spec, table, vary in (
                (OVER_ALPHA, "caps_cusp_alpha", "alpha"),
                (STIFFER, "caps_cusp_angle", "angle"),
            )
        ),
        Claim(
            "the_hemisphere",
            "the line passes through the limit point of the problem hemisphere",
            ((OVER_ALPHA, FIRST), (HANGING, None)),
            the_hemisphere,
        ),
        Claim(
            "between",
            "the limit pressure falls with the angle, from the flat disk's towards the whole balloon's",
            (*((OVER_ANGLE, at) for at in (SHALLOW, DEEP, DEEPER)), (FLAT, None), (BALLOON, None)),
            between,
        ),
        Claim(
            "no_waves",
            "no limit point is unstable to one, two or three waves around the axis",
            ((OVER_ANGLE, None),),
            no_waves,
        ),
    ),
    asked=dict.fromkeys(("p", "alpha", "angle", "t0", "lam_pole", *EIGENVALUES), 1e-7),
    slow=True,
)
