"""Documentation texts of the tables of paper 4."""

from __future__ import annotations

from reference_data.solvers.core.tables import Series
from reference_data.solvers.paper4 import cases as cas
from reference_data.solvers.paper4.material import Membrane
from reference_data.solvers.paper4.methods import shooting_newton as sho
from reference_data.solvers.paper4.methods import states as sta

PAPER = "Patil, Nordmark & Eriksson, Eur. J. Mech. A/Solids 54 (2015) 1-10"

METHOD = (
    "Two codes that share only the constitutive derivatives: (a) piecewise Chebyshev collocation in "
    "(r, z, lam1, slope angle) with the fronts gw = 1 and the fluid's surface as unknown "
    "breakpoints, the sign of gw - 1 checked inside every zone, two resolutions; (b) multiple "
    "shooting in (r, z, components of the tension) by a Runge-Kutta formula of order eight that "
    "meets fronts and surface as events and is given no pattern, two step lengths. The values are "
    "(a); a table is written only if |a - b| <= hypot(u_a, u_b) in every row and both find the same "
    "number of fronts. The uncertainty of a column is u_a + max |a - b| + half a unit of the last "
    "digit; largest_difference_of_methods is max |a - b|."
)
TOLERANCE = "Newton takes one more step after the first one below 1e-8: rounding only"

COLUMNS: dict[str, tuple[str, str]] = {
    "p": ("P Ao/(C1 h)", "gas pressure"),
    "t0": ("1/R_f", "height of the pole of a disk"),
    "zw": ("1/Ao", "fluid level above the lower end"),
    "V": ("V/(2 pi Ao^3)", "volume of the membrane's whole inside per 2 pi, int_0^L r^2 z'/2 ds"),
    "r_max": ("1/Ao", "largest radius, the disks included"),
    "N": (
        "1/(C1 h)",
        "meridional tension per undeformed hoop length at the lower end, eta W_1 at s = 0",
    ),
    "gw_max": ("1", "largest value of the wrinkling function gw = lam2 sqrt(lam1)"),
    "gw_min": ("1", "least value of the wrinkling function gw = lam2 sqrt(lam1)"),
    "wrinkled_fraction": ("1", "part of the material length L with gw < 1"),
    "Z": ("1/Ao", "material coordinate s from the lower end, in [0, L]"),
    "r": ("1/Ao", "radius"),
    "z": ("1/Ao", "height above the lower end"),
    "lam1": ("1", "meridional stretch"),
    "lam2": ("1", "hoop stretch, r"),
    "gw": ("1", "wrinkling function lam2 sqrt(lam1): taut above 1, wrinkled below"),
    "tension": ("1/(C1 h)", "meridional tension per undeformed hoop length, eta W_1"),
    "M": ("1", "thickness at the lower end over the mean"),
    "delta": ("1", "axial pre-stretch"),
    "c2": ("C2/C1", "Mooney-Rivlin constant"),
    "L": ("Lo/Ao", "undeformed length"),
    "Af": ("1/Ao", "radius of the disks"),
    "Af_critical": ("1/Ao", "largest radius of the disks with gw <= 1 everywhere at zero load"),
}


def front(i: int) -> tuple[str, str]:
    """Description of column Z_front_i."""
    return "1/Ao", f"front {i} from the lower end: material coordinate where gw = 1"


_RULES = " and ".join(f"degree {r.degree} on elements up to {r.longest:g}" for r in sta.RULES)
GRID = (
    f"(a) {_RULES} Ao long; (b) {sho.SEGMENTS} segments of {' and '.join(map(str, cas.STEPS))} steps. The "
    f"pattern is first read off finite differences with {cas.CELLS} intervals."
)
SERIES = Series(4, PAPER, COLUMNS, METHOD, GRID, TOLERANCE)


def given(membrane: Membrane) -> dict[str, object]:
    """Parameters as stored; Af is "critical" or a number."""
    out: dict[str, object] = {k: float(getattr(membrane, k)) for k in ("M", "delta", "c2", "L")}
    out["Af"] = "critical" if membrane.Af is None else float(membrane.Af)
    out["load"] = membrane.load
    if membrane.load == "fluid":
        out["gamma"] = membrane.gamma
    return out | {"energy": membrane.energy}


def described(membrane: Membrane) -> str:
    """Description of a membrane in one line, for titles."""
    radius = "critical" if membrane.Af is None else f"{membrane.Af:g}"
    energy = ", standard energy everywhere" if membrane.energy == "standard" else ""
    return (
        f"{membrane.load}, M = {membrane.M:g}, delta = {membrane.delta:g}, c2 = {membrane.c2:g}, "
        f"L = {membrane.L:g}, Af = {radius}{energy}"
    )
