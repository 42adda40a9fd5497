"""Uniaxial, equibiaxial and pure shear tests of every law: nominal stress over stretch."""

from weakforms.cases import Axis, Case, Curve, Panel, homogeneous

ENDS = {"saint_venant_kirchhoff": 1.6, "harmonic": 2.0}
"""Stretches up to which compressible laws are tested; the others up to 4."""
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
LOADINGS = ("uniaxial", "equibiaxial", "pure_shear")

CASE = Case(
    title="Test pieces of every law",
    source="Patil (2016), chapter 3",
    panels=tuple(
        Panel(
            loading,
            x=Axis("lam", 1, 4, r"$\lambda$"),
            y=Axis("T", 0, 15, r"$T$"),
            title=loading.replace("_", " "),
            curves=tuple(
                Curve(
                    homogeneous(model=m, loading=loading, lam_end=ENDS.get(m, 4.0)),
                    m.replace("_", " "),
                    reference=f"{loading}_{m}",
                )
                for m in MODELS
            ),
        )
        for loading in LOADINGS
    ),
    asked={"T": 5e-10},
)
