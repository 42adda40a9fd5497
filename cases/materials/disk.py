"""The circular membrane of paper 1 with other rubbers: Ogden's, Gent's, Arruda and Boyce's."""

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
    States,
    circular,
    decide,
)

MODELS = ("ogden", "gent", "arruda_boyce")
DISKS = {m: circular(model=m, t_end=2.1) for m in MODELS}
CONTACT = {m: circular(model=m, contact="frictionless", p_end=2.9) for m in ("gent", "arruda_boyce")}
DEEP = At("p", 2.8)


def contact(solutions: Solutions) -> Finding:
    """Front and contact stress of the pole at p = 2.8."""
    found = []
    for model, spec in CONTACT.items():
        onset = solutions.points(spec, "contact_onset")
        found += [
            decide.same(f"{model}: first contacts", len(onset), 1),
            decide.between("front", solutions.number(spec, DEEP, "X_contact"), 0, 1),
            decide.negative("stress at the pole", solutions.number(spec, DEEP, "sigma_pole")),
        ]
    return decide.all_of(found)


CASE = Case(
    title="The circular membrane of paper 1 with other laws",
    source="the problem of Patil, DasGupta & Eriksson (2015) with laws of the thesis's chapter 3",
    panels=(
        Panel(
            "p",
            x=Axis("p", 0, 5),
            y=Axis("t0", 0, 2),
            markers="limit_point",
            note="Not a figure of the paper.",
            curves=tuple(
                Curve(spec, m.replace("_", " "), reference=f"disk_{m}") for m, spec in DISKS.items()
            ),
        ),
    ),
    checks=(
        Count("limit_point", dict.fromkeys(DISKS.values(), 1), "one maximum of the pressure up to t0 = 2.1"),
        *(
            Points(
                "limit_point",
                reference=f"disk_limits_{m}",
                base=spec,
                parameters=(),
                asked={"p": 5e-10, "t0": 5e-10, "lam_pole": 5e-10},
            )
            for m, spec in DISKS.items()
        ),
        *(
            States(
                reference=f"disk_contact_{m}",
                base=spec,
                parameters=(),
                at=DEEP,
                asked={
                    **dict.fromkeys(("t0", "lam_pole", "rho_contact"), 5e-10),
                    "X_contact": 1e-9,
                    "V": 2e-9,
                    "lam1_rim": 1e-6,
                    "lam1_contact": 5e-8,
                    "sigma_pole": 5e-10,
                },
            )
            for m, spec in CONTACT.items()
        ),
        Claim(
            "contact",
            "also with these laws, frictionless contact starts once and spreads, and the substrate pushes",
            tuple((spec, DEEP) for spec in CONTACT.values()),
            contact,
        ),
    ),
    asked={"p": 5e-10, "lam_pole": 5e-10, "V": 5e-10, "lam1_rim": 1e-6},
    slow=True,
)
