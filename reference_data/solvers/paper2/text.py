"""Documentation texts of the tables of paper 2."""

from __future__ import annotations

from reference_data.solvers.core.tables import Series, rule
from reference_data.solvers.paper2.collocation import critical as col
from reference_data.solvers.paper2.differences import branch as fdb

PAPER = "Patil, Nordmark & Eriksson, Proc. R. Soc. A 470 (2014) 20140282"

METHOD = (
    "Two codes that share only the constitutive derivatives: (a) central finite differences of "
    "the second-order Euler-Lagrange equations, three grids, Richardson-extrapolated; (b) "
    "piecewise Chebyshev collocation of the first-order system at Gauss points, two meshes. " + rule("b")
)
TOLERANCE = "Newton takes one more step after the first one below 1e-7 (b) or 1e-6 (a): rounding only"
CURVE_NOTES = (
    "Primary branch from the unloaded tube on. u_max rises monotonically along it, which the "
    "pseudo-arclength trace of the finite-difference code checks over the whole table."
)
LIMIT_NOTES = (
    "Extended systems: (a) Newton on F = 0 and g = 0, g from the bordered Jacobian; (b) root of "
    "the exact dp/du_max."
)
CUSP_NOTES = (
    "dp/du_max = d2p/du_max2 = 0 in (u_max, delta1), found by following the fold line from the "
    "first limit point at delta1 = 1. Sets with fewer than two limit points there, up to the "
    "searched u_max, have no cusp at delta1 >= 1 in that range."
)

COLUMNS: dict[str, tuple[str, str]] = {
    "u_max": ("(R_mid - R_f)/R_f", "radial displacement of the mid-plane, rho(0) - 1"),
    "p": ("P R_f/(C1 h_o)", "gauge pressure"),
    "lam1_mid": ("1", "meridional stretch at the mid-plane"),
    "t1_mid": ("T1/(C1 h_o)", "meridional Cauchy stress resultant at the mid-plane"),
    "V": (
        "V/(2 pi R_f^3)",
        "enclosed volume of the half tube per 2 pi, int_0^L rho^2 eta' dz/2",
    ),
    "order": ("1", "1: first limit point met along the branch, 2: second"),
    "alpha": ("C2/C1", "Mooney-Rivlin constant"),
    "delta1": ("1", "axial pre-stretch"),
    "lf": ("L_f/R_f", "distance of the disks"),
    "Z": ("delta1 z/R_f", "axial position before inflation, from the mid-plane; disk at lf/2"),
    "rho": ("1/R_f", "radius"),
    "eta": ("1/R_f", "axial position, from the mid-plane"),
    "lam1": ("1", "meridional stretch, from the unstretched tube"),
    "lam2": ("1", "circumferential stretch, from the unstretched tube"),
    "t1": ("T1/(C1 h_o)", "meridional Cauchy stress resultant (per deformed length)"),
    "t2": ("T2/(C1 h_o)", "circumferential Cauchy stress resultant (per deformed length)"),
}


_CELLS = ", ".join(map(str, fdb.GRIDS))
_MESHES = " and ".join(f"{m.elements} elements of degree {m.degree}" for m in col.MESHES)
GRID = f"(a) {_CELLS} cells, z = L tanh(1.5 x)/tanh(1.5); (b) {_MESHES}, graded to the disk"
SERIES = Series(2, PAPER, COLUMNS, METHOD, GRID, TOLERANCE)
