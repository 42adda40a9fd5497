"""Wrinkled states of every law: the state, the natural width, and the agreement of two formulations.

Section 3.3: for an isotropic sheet the modified deformation gradient and the relaxed energy are the same for
every law. The width in uniaxial tension is lam^(-1/2) for every incompressible law.
"""

import numpy as np

from weakforms.cases import (
    At,
    Case,
    Claim,
    Finding,
    Solutions,
    Spec,
    decide,
    homogeneous,
    material,
    reference,
)

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
    "varga",
    "gent",
)
COMPRESSIBLE = ("saint_venant_kirchhoff", "harmonic")
FORMS = ("relaxed", "modified")
NAMES = ("W", "W1", "W2", "W11", "W12", "W22")
PIECES = {m: homogeneous(model=m, loading="uniaxial") for m in MODELS}
PULLED = tuple(At("lam", v) for v in (1.1, 1.5, 2.0, 3.0, 3.9))


def rows(model: str) -> list[tuple[Spec, int]]:
    """Solutions at the stretches of the reference, except at rest, and its states there."""
    columns = reference("materials", f"law_{model}").columns
    return [
        (material(model=model, l1=float(a), l2=float(b)), int(s))
        for a, b, s in zip(columns["l1"], columns["l2"], columns["state"], strict=True)
        if (a, b) != (1, 1)  # where three states meet, second derivatives depend on the direction
    ]


def states(solutions: Solutions) -> Finding:
    """State of the sheet at all stretches of all laws."""
    wanted = [row for model in (*MODELS, *COMPRESSIBLE) for row in rows(model)]
    found = [solutions.result(spec).quantities["state"].value == expected for spec, expected in wanted]
    return decide.every("states that agree with the reference", found)


def same_energy(solutions: Solutions) -> Finding:
    """Difference of the two formulations, relative to one plus the number."""
    found = [solutions.result(spec).quantities for model in MODELS for spec, _ in rows(model)]
    one, two = (np.array([q[f"{n}_{form}"].value for q in found for n in NAMES]) for form in FORMS)
    return decide.exact("relaxed energy and modified gradient", one, two, 1 + np.abs(one))


def widths(solutions: Solutions) -> Finding:
    """lam_across sqrt(lam) along uniaxial tests."""
    found = []
    for model in MODELS:
        across, lam = (solutions.numbers(PIECES[model], PULLED, name) for name in ("lam_across", "lam"))
        found.append(decide.agree(model, across * lam**0.5, np.ones(len(PULLED)), 5e-10))
    return decide.all_of(found)


CASE = Case(
    title="Relaxed energies and the modified deformation gradient, every law",
    source="Patil (2016), section 3.3; Patil, Nordmark & Eriksson (2015), section 2",
    checks=(
        Claim(
            "states",
            "every law is taut, wrinkled or slack where the reference says so",
            tuple((spec, None) for m in (*MODELS, *COMPRESSIBLE) for spec, _ in rows(m)),
            states,
        ),
        Claim(
            "modified_gradient",
            "for every incompressible law the modified deformation gradient gives the relaxed energy, with "
            "its first and second derivatives",
            tuple((spec, None) for m in MODELS for spec, _ in rows(m)),
            same_energy,
        ),
        Claim(
            "natural_width",
            "the width in uniaxial tension is lam^(-1/2) for every incompressible law",
            tuple((spec, at) for spec in PIECES.values() for at in PULLED),
            widths,
        ),
    ),
    quick=True,
)
