"""Paper 2, free inflation far from the paper's parameters: alpha 0 to 0.2, delta1 1 to 3, l_f 4 to 10."""

from weakforms.cases import Axis, Case, Count, Curve, Panel, Points, tube

SETS = ((0, 1, 4), (0.05, 1.3, 6), (0.2, 1, 6), (0.2, 3, 8), (0.1, 1.05, 10), (0, 2.5, 10))
TUBES = {s: tube(alpha=s[0], delta1=s[1], lf=s[2]) for s in SETS}

CASE = Case(
    title="Free inflation off the paper's parameters",
    source="the problem of Patil, Nordmark & Eriksson (2014), figure 2, at other data",
    panels=(
        Panel(
            "off",
            x=Axis("p", 0, 5),
            y=Axis("u_max", 0, 5),
            markers="limit_point",
            note="Not a figure of the paper.",
            curves=tuple(
                Curve(
                    TUBES[a, d, lf],
                    rf"$\alpha = {a}$, $\delta_1 = {d}$, $l_f = {lf}$",
                    reference=f"off_alpha_{a}_delta1_{d}_lf_{lf}",
                )
                for a, d, lf in SETS
            ),
        ),
    ),
    checks=(
        Count(
            "limit_point",
            dict(zip(TUBES.values(), (1, 1, 0, 0, 2, 1), strict=True)),
            "number of limit points as in the reference",
        ),
        Points(
            "limit_point",
            reference="limit_points_off",
            base=tube(),
            parameters=("alpha", "delta1", "lf"),
            asked={"p": 5e-10, "u_max": 5e-10},
        ),
    ),
    asked={"p": 1e-9, "lam1_mid": 1e-6, "t1_mid": 1e-6, "V": 1e-9},
    slow=True,
)
