"""Paper 3, section 10.1: the lowest eigenvalues along the primary branch, by Fourier number.

These are the eigenvalues of the second variation at fixed level with the mass of the stress-free tube, for n
waves around (n = 0 is axisymmetric without torsion), and the axisymmetric one at fixed volume. Limit point
and bifurcation are their zeros.
"""

from weakforms.cases import Axis, Case, Curve, Panel, fluid_tube

COLUMNS = {
    "Lambda_n0": r"$\Lambda(n = 0)$",
    "Lambda_n1": r"$\Lambda(n = 1)$",
    "Lambda_n2": r"$\Lambda(n = 2)$",
    "Lambda_n3": r"$\Lambda(n = 3)$",
    "Lambda_torsion": r"$\Lambda$, torsion",
    "LambdaV_n0": r"$\Lambda_V(n = 0)$, fixed volume",
}
MAIN = {(length, d): (0.116, "") for length in (8, 24) for d in (1.5, 2, 3)}
OFF = {
    (8, 5): 0.116,
    (8, 7): 0.116,
    (24, 1.1): 0.116,
    (16, 2.5): 0.05,
    (12, 1.3): 0.25,
    (24, 7): 0.25,
}
SETS = [(*key, *value) for key, value in MAIN.items()]
SETS += [(length, 2, g, f"_gamma_{g}") for length in (8, 24) for g in (0.058, 0.232)]
SETS += [(*key, g, f"_gamma_{g}") for key, g in OFF.items()]


def panel(length: int, delta: float, gamma: float, suffix: str) -> Panel:
    """All families of one tube over the volume."""
    tube = fluid_tube(L=length, delta=delta, gamma=gamma)
    return Panel(
        f"L_{length}_delta_{delta}{suffix}",
        x=Axis("V", 0, 150),
        y=Axis("Lambda", -1, 1),
        title=rf"$L = {length}$, $\delta = {delta}$, $\gamma = {gamma}$",
        note="Not a figure of the paper.",
        curves=tuple(
            Curve(tube, label, reference=f"spectrum_L_{length}_delta_{delta}{suffix}", y=column)
            for column, label in COLUMNS.items()
        ),
    )


CASE = Case(
    title="Eigenvalues along the primary branch",
    source="Patil, Nordmark & Eriksson (2015), sections 6 and 10.1",
    panels=tuple(panel(*which) for which in SETS),
    asked={"zw": 1e-9, **dict.fromkeys(COLUMNS, 1e-7), "Lambda_n0": 5e-9},
    slow=True,
)
