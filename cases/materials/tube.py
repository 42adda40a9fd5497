"""The tube of paper 2 with other rubbers: Ogden's, Gent's, Arruda and Boyce's.

Branch, limit points and stability are compared with the paper's reference codes, which implement the laws
separately.
"""

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
    decide,
    tube,
)

MODELS = ("ogden", "gent", "arruda_boyce")
TUBES = {m: tube(model=m) for m in MODELS}
FINE = {m: spec.on(cells=192) for m, spec in TUBES.items()}
"""For the first integrals: small differences of large numbers."""
CONTACT = tube(model="gent", contact="frictionless", p_end=1.8)
DEEP = At("p", 1.8, profile=())
FIRST, LATER = At("u_max", 0.5, profile=()), At("u_max", 2.0, profile=())


def stable_before(solutions: Solutions) -> Finding:
    """Negative eigenvalues before and after the first limit point."""
    counts = [
        [int(solutions.value(spec, at, "n_negative")) for at in (FIRST, LATER)] for spec in TUBES.values()
    ]
    return decide.same("negative eigenvalues", counts, [[0, 1]] * len(TUBES))


def integrals(solutions: Solutions) -> Finding:
    """Axial force and Hamiltonian along the meridian of each law at u_max = 2."""
    return decide.all_of(
        decide.constant(f"{model} {name}", solutions.column(spec, LATER, name), 2e-5)
        for model, spec in FINE.items()
        for name in ("F_axial", "H")
    )


def contact_balance(solutions: Solutions) -> Finding:
    """In frictionless contact the axial force is constant, on the patch and outside."""
    return decide.all_of(
        decide.constant("F_axial", solutions.column(CONTACT, DEEP, "F_axial"), 5e-6),
        decide.positive("contact length", solutions.number(CONTACT, DEEP, "contact_length")),
    )


CASE = Case(
    title="The tube of paper 2 with other laws",
    source="the problem of Patil, Nordmark & Eriksson (2014) with laws of the thesis's chapter 3",
    panels=(
        Panel(
            "p",
            x=Axis("p", 0, 2),
            y=Axis("u_max", 0, 5),
            markers="limit_point",
            note="Not a figure of the paper.",
            curves=tuple(
                Curve(spec, m.replace("_", " "), reference=f"tube_{m}") for m, spec in TUBES.items()
            ),
        ),
    ),
    checks=(
        Count("limit_point", dict.fromkeys(TUBES.values(), 2), "a maximum and a minimum of the pressure"),
        *(
            Points(
                "limit_point",
                reference=f"tube_limits_{m}",
                base=spec,
                parameters=(),
                asked={"p": 5e-10, "u_max": 5e-7},
            )
            for m, spec in TUBES.items()
        ),
        Claim(
            "stability",
            "stable under pressure control before the first limit point, one negative eigenvalue after it",
            tuple((spec, at) for spec in TUBES.values() for at in (FIRST, LATER)),
            stable_before,
        ),
        Claim(
            "integrals",
            "both first integrals of the meridian are constant for every law",
            tuple((spec, LATER) for spec in FINE.values()),
            integrals,
        ),
        Claim(
            "contact",
            "frictionless contact of a tube of Gent's rubber keeps the axial force constant",
            ((CONTACT, DEEP),),
            contact_balance,
        ),
    ),
    asked={"p": 1e-9, "lam1_mid": 1e-6, "t1_mid": 1e-6, "V": 5e-10},
    quick=True,
)
