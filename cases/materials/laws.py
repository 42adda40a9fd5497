"""Every law of chapter 3: energy, stresses and tangent, against derivatives in closed form."""

from weakforms.cases import Case, Points, material

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
ASKED = {
    **dict.fromkeys(NAMES, 1e-7),
    **{f"{name}_relaxed": 5e-8 for name in NAMES},
    "W2": 5e-9,
    "W22": 1e-8,
    "W2_relaxed": 2e-9,
    "W22_relaxed": 2e-9,
}
"""The tables have twelve digits of their largest number; the smallest ones have fewer."""

CASE = Case(
    title="Material laws: energy, stresses and tangent",
    source="Patil (2016), sections 3.1 and 3.3",
    checks=tuple(
        Points(
            "quantity",
            reference=f"law_{model}",
            base=material(model=model),
            parameters=("l1", "l2"),
            asked=ASKED,
        )
        for model in MODELS
    ),
)
