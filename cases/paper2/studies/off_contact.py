"""Paper 2, constrained inflation at other parameters than in the paper: alpha, delta1, l_f, k and s."""

from weakforms.cases import Axis, Case, Curve, Panel, tube

SETS = ({"alpha": 0.05, "delta1": 1.3, "lf": 8, "k": 50, "s": 1.2}, {"alpha": 0.05, "delta1": 1.5, "lf": 6})
# The substrate is far from the tube, so that the patch is still short at p = 3. Finite differences do not
# resolve the traction at its edge just after contact, so there is no table of adhesive inflation itself.
DISTANT = ({"alpha": 0.1, "delta1": 1.5, "lf": 6, "k": 100, "s": 1.6},)
KINDS = {
    "frictionless": ({"contact": "frictionless"}, (*SETS, *DISTANT)),
    "adhesive": ({"contact": "adhesive"}, SETS),
    "deflation_bilateral": ({"contact": "adhesive", "phase": "deflation"}, (*SETS, *DISTANT)),
    "deflation_unilateral": ({"contact": "adhesive", "phase": "deflation", "spring": "unilateral"}, SETS),
}
ASKED = {
    "u_max": 2e-8,
    "contact_length": 5e-7,
    "Z_front": 5e-7,
    "lam1_mid": 2e-9,
    "t1_mid": 5e-9,
    "V": 5e-8,
    "line_force": 1e-5,
    "traction_front": 5e-5,
    "traction_max": 1e-4,
    "spring_max": 5e-7,
}

CASE = Case(
    title="Constrained inflation off the paper's parameters",
    source="the problem of Patil, Nordmark & Eriksson (2014), figure 6, at other data",
    panels=tuple(
        Panel(
            kind,
            x=Axis("p", 0, 3),
            y=Axis("u_max", 0, 0.7),
            title=kind.replace("_", ", "),
            note="Not a figure of the paper.",
            curves=tuple(
                Curve(
                    tube(**data, **how),
                    rf"$\alpha = {data['alpha']}$, $\delta_1 = {data['delta1']}$, $l_f = {data['lf']}$",
                    reference=f"off_contact_{kind}_alpha_{data['alpha']}_delta1_{data['delta1']}_lf_{data['lf']}",
                )
                for data in sets
            ),
        )
        for kind, (how, sets) in KINDS.items()
    ),
    asked=ASKED,
    quick=True,
    slow=True,
)
