"""Paper 2, constrained inflation off the paper: other alpha, delta1, l_f, k and s."""

from weakforms import Axis, Case, Curve, Panel, tube

SETS = ({"alpha": 0.05, "delta1": 1.3, "lf": 8, "k": 50, "s": 1.2}, {"alpha": 0.05, "delta1": 1.5, "lf": 6})
KINDS = {
    "frictionless": {"contact": "frictionless"},
    "adhesive": {"contact": "adhesive"},
    "deflation_bilateral": {"contact": "adhesive", "phase": "deflation"},
}

CASE = Case(
    title="Constrained inflation off the paper's parameters",
    source="the problem of Patil, Nordmark & Eriksson (2014), figure 6, at other data",
    panels=tuple(
        Panel(
            kind,
            x=Axis("p", 0, 3),
            y=Axis("u_max", 0, 0.6),
            title=kind.replace("_", ", "),
            note="Not a figure of the paper.",
            curves=tuple(
                Curve(
                    tube(**data, **how),
                    rf"$\delta_1 = {data['delta1']}$, $l_f = {data['lf']}$",
                    reference=f"off_contact_{kind}_alpha_0.05_delta1_{data['delta1']}_lf_{data['lf']}",
                )
                for data in SETS
            ),
        )
        for kind, how in KINDS.items()
    ),
    asked={
        "u_max": 2e-8,
        "contact_length": 1e-6,
        "Z_front": 1e-6,
        "lam1_mid": 2e-9,
        "t1_mid": 5e-9,
        "V": 1e-6,
        "line_force": 5e-6,
        "traction_front": 1e-3,
        "traction_max": 1e-3,
        "spring_max": 5e-7,
    },
    quick=True,
)
