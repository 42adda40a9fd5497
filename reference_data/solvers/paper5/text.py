"""Documentation texts of the tables of paper 5."""

from __future__ import annotations

from reference_data.solvers.core.tables import Series

PAPER = (
    "Patil, Nordmark & Eriksson, Instabilities of wrinkled membranes with pressure loadings "
    "(thesis of A. Patil, paper 5)"
)
METHOD = (
    "Two codes with a base state each. (a) Base: piecewise Chebyshev collocation with fronts and level as "
    "unknown breakpoints; second variation: spectral Galerkin matrices of the metric form on the same "
    "elements (cut in two for the fine resolution), shift-and-invert with a shift that Cholesky's factors "
    "certify to lie below the spectrum. (b) Base: shooting with fronts and level met as events; second "
    "variation: canonical first-order system from the displacement gradient in principal axes and the "
    "follower-load form of the pressure, eighth-order Runge-Kutta transfer matrices, dynamic stiffness, "
    "Newton's method on the eigenvalue; two step lengths. The values are (a); a table is written only if "
    "|a - b| <= hypot(u_a, u_b) in every row. The uncertainty of a column is u_a + max |a - b| + half a "
    "unit of the last digit; largest_difference_of_methods is max |a - b|. In the uncertainties collocation "
    "stands for (a), shooting for (b)."
)
CYLINDER_GRID = (
    "(a) degree 16 on elements up to 0.4 and degree 18 up to 0.3 Ao long, the latter cut in two for the "
    "modes; (b) 32 segments of 5 and 10 steps, halved for n > 30 and quartered for n > 60"
)
HEMISPHERE_GRID = (
    "(a) degree 16 on elements up to 0.16 and degree 18 up to 0.12 Ao long, the latter cut in two for the "
    "modes; (b) expansion up to t = 0.002 and 0.001, then 32 segments of 5 and 10 steps, parts of the "
    "modes up to min(0.02, sin t/n) and half of that"
)
TOLERANCE = "Newton takes one more step after the first one below 1e-8; eigenvalues to rounding"
SCALES = {
    "mass": "int H R (u^2 + q^2 + w^2) dS, H over the mean thickness, R over Ao",
    "quadratic_form": "2 Pi2/pi over C1 h Ao^2, displacement (u cos, q sin, w cos)(n Theta)",
}
EIGENVALUE = "Lambda Ao/g"

COLUMNS: dict[str, tuple[str, str]] = {
    "Z": ("1/Ao", "material coordinate from the lower end"),
    "t": ("rad", "material polar angle from the lowest point"),
    "gw": ("1", "wrinkling function lam2 sqrt(lam1): taut above 1, wrinkled below"),
    "zw": ("1/Ao", "fluid level, in the same z as the membrane"),
    "p": ("P Ao/(C1 h)", "gas pressure"),
    "n": ("1", "wave number"),
    "Lambda_1": (EIGENVALUE, "lowest eigenvalue"),
    "Lambda_2": (EIGENVALUE, "second eigenvalue"),
    "Lambda_3": (EIGENVALUE, "third eigenvalue"),
    "direction": ("1", "1: Lambda_1 turns negative as the load rises; -1: it turns positive"),
    "z_pole": ("1/Ao", "height of the lowest point (the equator is at 0)"),
    "lam_pole": ("1", "stretch at the lowest point"),
    "V": ("V/(2 pi Ao^3)", "volume below the equator's plane per 2 pi, int r^2 z'/2 dt"),
    "t_level": ("rad", "material angle of the level"),
}


SERIES = Series(5, PAPER, COLUMNS, METHOD, CYLINDER_GRID, TOLERANCE)


def cylinder(load: str) -> dict[str, object]:
    """Parameters of the cylinder."""
    return {"M": 1.5, "delta": 3.0, "c2": 0.01, "L": 8.0, "Af": 0.4362, "load": load}
