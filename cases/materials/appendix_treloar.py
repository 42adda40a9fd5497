"""Appendix, validation and not verification: Treloar's rubber against laws with constants of the literature.

The other cases check that equations are solved correctly; this one shows how well they describe a rubber.
Treloar, L. R. G. (1944), Trans. Faraday Soc. 40, 59-70: uniaxial and equibiaxial tension of vulcanised
natural rubber, nominal stress in kg/cm^2, on which two open collections agree (for equibiaxial tension to one
unit of the last digit). The pure shear data are left out, because only one collection contains them.
"""

import numpy as np

from weakforms.cases import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, decide, homogeneous

UNIAXIAL = (
    (1.02, 0.26),
    (1.125, 1.37),
    (1.24, 2.30),
    (1.39, 3.23),
    (1.585, 4.16),
    (1.9, 5.10),
    (2.18, 6.00),
    (2.42, 6.90),
    (3.02, 8.80),
    (3.57, 10.7),
    (4.03, 12.5),
    (4.76, 16.2),
    (5.36, 19.9),
    (5.75, 23.6),
    (6.15, 27.4),
    (6.4, 31.0),
    (6.6, 34.8),
    (6.85, 38.5),
    (7.05, 42.1),
    (7.15, 45.8),
    (7.25, 49.6),
    (7.4, 53.3),
    (7.5, 57.0),
    (7.6, 64.4),
)
EQUIBIAXIAL = (
    (1.03, 0.95),
    (1.07, 1.60),
    (1.12, 2.42),
    (1.14, 2.62),
    (1.2, 3.32),
    (1.31, 4.43),
    (1.42, 5.18),
    (1.68, 6.60),
    (1.94, 7.78),
    (2.49, 9.79),
    (3.03, 12.6),
    (3.43, 14.7),
    (3.75, 17.4),
    (4.07, 20.1),
    (4.26, 22.5),
    (4.45, 24.7),
)
MPA = 0.0980665
"""One kg/cm^2 in MPa."""
DATA = {"uniaxial": UNIAXIAL, "equibiaxial": EQUIBIAXIAL}
ENDS = {"uniaxial": 7.65, "equibiaxial": 4.5}
LAWS = {
    # thesis, section 3.1.3: N K T/2 = 0.2 MPa
    "neo_hookean": ({}, 0.2),
    # Ogden (1972): mu = 6.3, 0.012, -0.1 kg/cm^2, alpha = 1.3, 5, -2; the defaults are over 4.225 kg/cm^2
    "ogden": ({}, 4.225 * MPA),
    # Arruda & Boyce (1993): N K T = 0.27 MPa, n = 26.5. sqrt(n) allows stretches up to 8.7
    "arruda_boyce": ({"nkt": 0.27, "links": 26.5}, 1.0),
}
"""Constants of the literature and their stress S in MPa."""


BEGIN = 1.1
"""Stretch below which the data, with two digits, are less accurate than the differences between the laws."""
GOOD = decide.Stated(
    0.15, "good", "the thesis prints no number; the laws differ by more at the last stretches"
)
FOLLOWS = decide.Stated(0.1, "within 10 % rms", "the claim's own number")
NOT_GOOD = decide.Stated(
    0.6, "for small and moderate stretches only", "beyond these stretches, less than two thirds of the stress"
)
SOFT = decide.Stated(0.85, "too soft", "further off than the 15 % that count as agreement")


def test(model: str, loading: str) -> object:
    """A law's test piece."""
    spec = homogeneous(model=model, loading=loading, lam_end=ENDS[loading], **LAWS[model][0])
    return spec.on(step=0.2)


def deviation(solutions: Solutions, model: str, loading: str, up_to: float) -> decide.Number:
    """Root mean square of the relative deviation from the data up to a stretch."""
    rows = [(x, t * MPA) for x, t in DATA[loading] if BEGIN < x <= up_to]
    spec, scale = test(model, loading), LAWS[model][1]
    found = solutions.numbers(spec, [At("lam", x) for x, _ in rows], "T")
    square = (found * scale / np.array([t for _, t in rows]) - 1) ** 2
    return decide.Number(np.mean(square.value), np.max(square.uncertainty)) ** 0.5


def wanted(*models: str) -> tuple:
    """States at the stretches of the data."""
    return tuple(
        (test(m, loading), At("lam", x))
        for m in models
        for loading in DATA
        for x, _ in DATA[loading]
        if x > BEGIN
    )


def softer(solutions: Solutions, model: str, loading: str, last: float) -> decide.Number:
    """Computed over measured stress at one stretch."""
    measured = dict(DATA[loading])[last] * MPA
    return solutions.number(test(model, loading), At("lam", last), "T") * LAWS[model][1] / measured


def moderate(solutions: Solutions) -> Finding:
    """Deviations of the neo-Hookean law at moderate stretches, its stress at the last one."""
    return decide.all_of(
        decide.at_most("rms up to lam = 1.6", deviation(solutions, "neo_hookean", "uniaxial", 1.6), GOOD),
        decide.at_most("stress at 7.6", softer(solutions, "neo_hookean", "uniaxial", 7.6), NOT_GOOD),
    )


def whole_range(solutions: Solutions) -> Finding:
    """Deviations of Ogden's law over all data."""
    return decide.all_of(
        decide.at_most(f"rms, {loading}", deviation(solutions, "ogden", loading, 7.6), FOLLOWS)
        for loading in DATA
    )


def eight_chains(solutions: Solutions) -> Finding:
    """Deviation of Arruda and Boyce's law in tension, and its stress in equibiaxial tension."""
    return decide.all_of(
        decide.at_most("rms, uniaxial", deviation(solutions, "arruda_boyce", "uniaxial", 7.6), GOOD),
        decide.at_most(
            "equibiaxial stress at 3.03", softer(solutions, "arruda_boyce", "equibiaxial", 3.03), SOFT
        ),
    )


CASE = Case(
    title="Appendix (validation): Treloar's rubber",
    source="Treloar (1944), Trans. Faraday Soc. 40, 59-70",
    panels=tuple(
        Panel(
            loading,
            x=Axis("lam", 1, 8, r"$\lambda$"),
            y=Axis("T", 0, 70, r"$T/S$"),
            title=loading,
            note="Each law over its own stress: 0.2 MPa, 4.225 kg/cm^2 and 1 MPa.",
            curves=tuple(Curve(test(m, loading), m.replace("_", " ")) for m in LAWS),
        )
        for loading in DATA
    ),
    checks=(
        Claim(
            "moderate_stretches",
            "the neo-Hookean law is good for small and moderate stretches only (section 3.1.3)",
            wanted("neo_hookean"),
            moderate,
        ),
        Claim(
            "whole_range",
            "Ogden's law follows uniaxial and equibiaxial tests within 10 % rms",
            wanted("ogden"),
            whole_range,
        ),
        Claim(
            "eight_chains",
            "Arruda and Boyce's law follows the uniaxial test within 15 % rms and is too soft equibiaxially",
            wanted("arruda_boyce"),
            eight_chains,
        ),
    ),
    tags=("validation",),
)
