"""Wrinkled states of every law: which state, which width, and two formulations that are one function.

Section 3.3: for an isotropic sheet the modified deformation gradient and the relaxed energy are the same,
whatever the law. The width that uniaxial tension leaves is lam^(-1/2) for every incompressible law.
"""

from weakforms import Case, Claim, Finding, Solutions, Spec, homogeneous, material, reference

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
NAMES = ("W", "W1", "W2", "W11", "W12", "W22")


def rows(model: str) -> list[tuple[Spec, int]]:
    """Solutions at the stretches of the reference, but at rest, and the states it has there."""
    columns = reference("materials", f"law_{model}").columns
    return [
        (material(model=model, l1=float(a), l2=float(b)), int(s))
        for a, b, s in zip(columns["l1"], columns["l2"], columns["state"], strict=True)
        if (a, b) != (1, 1)  # where three states meet, second derivatives depend on the way there
    ]


def states(solutions: Solutions) -> Finding:
    """State of the sheet at all stretches of all laws."""
    wrong, seen = [], 0
    for model in (*MODELS, *COMPRESSIBLE):
        for spec, expected in rows(model):
            seen += 1
            if solutions.result(spec).quantities["state"].value != expected:
                wrong.append(str(spec))
    return (
        not wrong,
        f"{seen} states of {len(MODELS) + len(COMPRESSIBLE)} laws, {len(wrong)} differ {wrong[:3]}",
    )


def same_energy(solutions: Solutions) -> Finding:
    """Largest difference of the two formulations, relative to one plus the number."""
    worst, where, seen = 0.0, "", 0
    for model in MODELS:
        for spec, _ in rows(model):
            found = solutions.result(spec).quantities
            for name in NAMES:
                a, b = found[f"{name}_relaxed"].value, found[f"{name}_modified"].value
                difference = abs(a - b) / (1 + abs(a))
                seen += 1
                if not difference <= worst:
                    worst, where = difference, f"{spec}: {name}"
    return worst < 1e-13, f"{seen} numbers, largest difference {worst:.1e} ({where or 'nowhere'})"


def widths(solutions: Solutions) -> Finding:
    """lam_across sqrt(lam) - 1 all along uniaxial tests."""
    worst = {}
    for model in MODELS:
        columns = solutions.branch(homogeneous(model=model, loading="uniaxial")).columns
        worst[model] = float(abs(columns["lam_across"] * columns["lam"] ** 0.5 - 1).max())
    return max(worst.values()) < 1e-9, ", ".join(f"{m} {w:.0e}" for m, w in worst.items())


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
            "uniaxial tension leaves the width lam^(-1/2), whatever the incompressible law",
            tuple((homogeneous(model=m, loading="uniaxial"), None) for m in MODELS),
            widths,
        ),
    ),
    quick=True,
)
