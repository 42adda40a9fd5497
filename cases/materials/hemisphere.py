"""The hanging hemisphere of paper 5 with other rubbers: Ogden's and Gent's.

Branch, fronts of the wrinkled zone, and levels at which waves around the axis vanish, are compared with the
paper's reference codes, which implement the laws separately. The relaxed energy follows from each law. The
liquid on Ogden's rubber, which is half as stiff, is half as heavy.
"""

from weakforms.cases import (
    At,
    Axis,
    Case,
    Claim,
    Curve,
    Finding,
    Panel,
    Points,
    Solutions,
    decide,
    hemisphere,
)

LAWS = {"ogden": {"model": "ogden", "gamma": 2.3}, "gent": {"model": "gent"}}
WAVES = (20, 30)
BOWLS = {m: hemisphere(**given, n=WAVES, low_end=-1.14) for m, given in LAWS.items()}
LOW, HIGH = At("zw", -0.8, profile=()), At("zw", -0.55, profile=())


def wrinkled_then_taut(solutions: Solutions) -> Finding:
    """Smallest gw at a low and at a high level."""
    found = []
    for m, spec in BOWLS.items():
        low, high = (solutions.number(spec, at, "gw_min") for at in (LOW, HIGH))
        found.append(decide.less(f"{m}: gw_min", low, 1, high))
    return decide.all_of(found)


CASE = Case(
    title="The hemisphere of paper 5 with other laws",
    source="the problem of Patil, Nordmark & Eriksson (2016) with laws of the thesis's chapter 3",
    panels=tuple(
        Panel(
            kind,
            x=Axis("zw", -1.2, -0.4),
            y=Axis(y, *limits, label=label),
            note="Not a figure of the paper. The table of fronts is compared at its levels."
            if kind == "fronts"
            else "Not a figure of the paper.",
            curves=tuple(Curve(spec, m, reference=f"{table}_{m}") for m, spec in BOWLS.items()),
        )
        for kind, y, limits, label, table in (
            ("branch", "z_pole", (-1.6, -1.1), "height of the pole", "hemisphere"),
            ("fronts", "t_level", (0, 1.6), "level on the meridian", "hemisphere_fronts"),
        )
    ),
    checks=(
        *(
            Points(
                "stability_change",
                reference=f"hemisphere_changes_{m}",
                base=spec,
                parameters=(),
                where={"n": float(n), "direction": -1.0},
                asked={"zw": 2e-8},
            )
            for m, spec in BOWLS.items()
            for n in WAVES
        ),
        Claim(
            "wrinkled_then_taut",
            "also with these laws the hemisphere is wrinkled at low levels and taut at high ones",
            tuple((spec, at) for spec in BOWLS.values() for at in (LOW, HIGH)),
            wrinkled_then_taut,
        ),
    ),
    asked=dict.fromkeys(("z_pole", "V", "lam_pole", "t_level", "t_front_1", "t_front_2"), 5e-9),
    slow=True,
)
