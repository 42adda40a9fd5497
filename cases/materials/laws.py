"""Every law of chapter 3: energy, stresses and tangent, full and relaxed, against derivatives by hand."""

from weakforms import Case, Points, material

MODELS = (
    "neo_hookean",
    "mooney_rivlin",
    "rivlin",
    "ogden",
    "biderman",
    "rivlin_saunders",
    "three_chain",
    "arruda_boyce",
    "beda_chevalier",
    "saint_venant_kirchhoff",
    "varga",
    "gent",
    "harmonic",
)
NAMES = ("W", "W1", "W2", "W11", "W12", "W22")

CASE = Case(
    title="Material laws: energy, stresses and tangent",
    source="Patil (2016), sections 3.1 and 3.3",
    checks=tuple(
        Points(
            "quantity",
            reference=f"law_{model}",
            base=material(model=model),
            parameters=("l1", "l2"),
            # The tables have twelve digits of their largest number; the smallest ones have fewer.
            asked=dict.fromkeys([n + suffix for suffix in ("", "_relaxed") for n in NAMES], 1e-7),
        )
        for model in MODELS
    ),
)
