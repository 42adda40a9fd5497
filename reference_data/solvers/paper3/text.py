"""What the tables of paper 3 say about themselves."""

from __future__ import annotations

from reference_data.solvers.core.tables import Series, rule
from reference_data.solvers.paper3 import path

PAPER = "Patil, Nordmark & Eriksson, Proc. R. Soc. A 471 (2015) 20150016"

METHOD = (
    "Two codes that share the definitions of volume and energy (and another law's derivatives, where "
    "there is one), but no equation of equilibrium, stress or stability: (a) piecewise Chebyshev "
    "collocation of the first-order system at Gauss points, the free surface an unknown between two "
    "regions, the Fourier perturbation as a canonical (Hamiltonian) system with the eigenvalue, or at "
    "critical points the volume, as an unknown; (b) Galerkin's method with fitted spectral elements on "
    "the Cartesian weak form F(x; v) = 0, its point-wise tangent averaged over Theta, resultants from the"
    " energy by complex step, dense symmetric eigenproblem. Two resolutions each. " + rule("a")
)
TOLERANCE = "Newton takes one more step after the first one below 1e-7: rounding only"
BRANCH_NOTES = (
    "Primary branch over the fluid volume, which rises strictly along it. The level passes its maximum on "
    "the way. Where z_w crosses L, dV/dz_w jumps by pi, the area of the free surface: the columns, smooth "
    "functions of z_w, have a kink there as functions of V, and LambdaV_n0 jumps."
)
SPECTRUM_NOTES = (
    "Lowest eigenvalue of each family, d2Pi = Lambda M with M = int |dx|^2 dTheta dZ over the reference "
    "area and d2Pi the full second variation. Lambda: level held; LambdaV: volume held."
)
CRITICAL_NOTES = (
    "First zero of the lowest eigenvalue at given level for n = 0 (limit point of z_w), 1 and 2 "
    "(bifurcation points), met along the primary branch for rising volume. (a) solves the state, the "
    "perturbation and the volume at once; (b) finds the zero of its own eigenvalue."
)
PRESSURE_NOTES = "T1 = lam1/lam2 - (lam1 lam2)^-3, T2 = lam2/lam1 - (lam1 lam2)^-3."

COLUMNS: dict[str, tuple[str, str]] = {
    "L": ("1/A", "distance of the discs"),
    "delta": ("1", "axial pre-stretch"),
    "gamma": ("rho g A^2/(mu H)", "weight of the fluid"),
    "n": ("1", "circumferential wave number of the critical mode"),
    "order": ("1", "1: first zero of this family along the branch"),
    "zw": ("1/A", "fluid level above the lower disc; over-filled: static head"),
    "V": ("1/A^3", "fluid volume"),
    "r_mid": ("1/A", "radius at Z = l/2 (secondary branch: at Theta = 0)"),
    "r_max": ("1/A", "largest radius of the profile"),
    "T1_ring": ("1/(mu H)", "meridional Cauchy stress resultant at the lower ring (equal at the upper one)"),
    "T2_ring": ("1/(mu H)", "circumferential Cauchy stress resultant at the lower ring (equal at the upper)"),
    "T1_mid": ("1/(mu H)", "meridional Cauchy stress resultant at Z = l/2"),
    "T2_mid": ("1/(mu H)", "circumferential Cauchy stress resultant at Z = l/2"),
    "Pi": ("1/(mu H A^2)", "total potential energy, strain energy - int P dV, at given level"),
    "Lambda_n0": ("mu/(rho_m A^2) as omega^2", "lowest axisymmetric eigenvalue, level held"),
    "Lambda_n1": ("mu/(rho_m A^2) as omega^2", "lowest eigenvalue of wave number 1"),
    "Lambda_n2": ("mu/(rho_m A^2) as omega^2", "lowest eigenvalue of wave number 2"),
    "Lambda_n3": ("mu/(rho_m A^2) as omega^2", "lowest eigenvalue of wave number 3"),
    "Lambda_torsion": ("mu/(rho_m A^2) as omega^2", "lowest eigenvalue of axisymmetric torsion"),
    "LambdaV_n0": ("mu/(rho_m A^2) as omega^2", "lowest axisymmetric eigenvalue, volume held"),
    "Z": ("1/A", "material coordinate, 0 (lower ring) to l = L/delta"),
    "Theta": ("rad", "material angle; the bulge is at 0"),
    "r": ("1/A", "radius"),
    "x": ("1/A", "Cartesian position, towards Theta = 0"),
    "y": ("1/A", "Cartesian position, across the mirror plane"),
    "z": ("1/A", "height above the lower disc"),
    "lam1": ("1", "principal stretch, direction nearer to the meridian"),
    "lam2": ("1", "the other principal stretch"),
    "T1": ("1/(mu H)", "principal Cauchy stress resultant of lam1 (per current length)"),
    "T2": ("1/(mu H)", "principal Cauchy stress resultant of lam2 (per current length)"),
    "delta_a": ("1", "pre-stretch of the first curve"),
    "delta_b": ("1", "pre-stretch of the second curve"),
    "post_a": ("1", "1 if the first curve has passed its limit point there"),
    "post_b": ("1", "1 if the second curve has passed its limit point there"),
}

SECONDARY_METHOD = (
    "Two codes: (a) Galerkin's method on the Cartesian weak form F(x; v) = 0: trigonometric polynomials "
    "in Theta times spectral elements in Z, integrals by quadrature, elements fitted to the free surface "
    "Z = Zf(Theta), an unknown cosine polynomial; symmetric eigenproblem; (b) pseudo-spectral collocation"
    " of the balance of forces, point by point: Chebyshev nodes in Z times equidistant angles, forces on "
    "cuts as derivatives of the energy by Cartesian components, continuous across the free surface, which"
    " is an edge of elements too; volume and the liquid's energy as fluxes of vertical fields, resultants"
    " as forces on principal cuts; eigenvalues of the linearised balance, which is not symmetric. They "
    "share the elimination of unknowns inside elements and, for slopes and turn, the polynomials through "
    "states. Two resolutions each. The values are (a); a table is written only if |a - b| <= hypot(u_a, "
    "u_b) in every row. u_a and u_b are 3 times the largest difference of resolutions, plus what Newton's"
    " last step leaves. The uncertainty of a column is u_a + max |a - b| + half a unit of the last digit;"
    " largest_difference_of_methods is max |a - b|."
)
SECONDARY_TOLERANCE = "last step of either Newton iteration below 2e-10"
SECONDARY_NOTES = (
    "The C1v branch that starts at the first n = 1 zero, mirror plane Theta = 0, pi, bulge at Theta = 0. "
    "Along it z_w and V fall: in this table the branch starts below the last row and runs upwards. "
    "Lambda: level held; LambdaV: volume held; Lambda_breaking leaves out the rotation of the pattern, whose "
    "eigenvalue is 0 (rotation_eigenvalue is the largest one computed)."
)
COMPRESSED_NOTES = (
    " The dry part is slightly compressed (T_min < 0): a membrane without bending stiffness is then unstable "
    "against wrinkles of any shortness, so that the eigenvalues but Lambda_1 and LambdaV_1 depend on the "
    "grid and are left out."
)
_STATES = (
    " u_a and u_b hold, besides, the difference to the polynomial through one state fewer; such differences "
    "at least halve with each state."
)
TURN_NOTES = (
    "Stationary point of the polynomial in the centroid's offset through seven states around it." + _STATES
)
SLOPE_NOTES = (
    "States at small offsets A of the centroid, z_w = zw + dzw_dA2 A^2 + ..., V = V + dV_dA2 A^2 + ..., "
    "extrapolated to A = 0 with a polynomial in A^2; the critical level, volume and radius are those of "
    "critical_points." + _STATES
)
PLACES = {"0": "Theta = 0", "pi": "Theta = pi"}
for _side, _where in PLACES.items():
    COLUMNS |= {
        f"x_quarter_{_side}": ("1/A", f"x at Z = l/4, {_where}"),
        f"z_quarter_{_side}": ("1/A", f"height at Z = l/4, {_where}"),
        f"T1_quarter_{_side}": ("1/(mu H)", f"T1 at Z = l/4, {_where}"),
        f"T2_quarter_{_side}": ("1/(mu H)", f"T2 at Z = l/4, {_where}"),
    }
COLUMNS |= {
    "r_mid_pi": ("1/A", "radius at Z = l/2, Theta = pi"),
    "z_min": ("1/A", "smallest height of the membrane (on Theta = 0, near the lower ring)"),
    "T_min": ("1/(mu H)", "smallest principal stress resultant on a net of 240 x 60 intervals"),
    "Lambda_1": ("mu/(rho_m A^2) as omega^2", "lowest eigenvalue in the C1v space, level held"),
    "Lambda_2": ("mu/(rho_m A^2) as omega^2", "second eigenvalue in the C1v space, level held"),
    "Lambda_3": ("mu/(rho_m A^2) as omega^2", "third eigenvalue in the C1v space, level held"),
    "Lambda_breaking": ("mu/(rho_m A^2) as omega^2", "lowest non-zero eigenvalue that breaks C1v"),
    "LambdaV_1": ("mu/(rho_m A^2) as omega^2", "lowest eigenvalue in the C1v space, volume held"),
    "dzw_dV": ("A^2", "initial slope dz_w/dV of the secondary branch"),
    "dzw_dr2": ("A", "z_w - zw over (r_mid - r_mid at the bifurcation)^2, initially"),
    "dr_mean_dzw": ("1", "initial slope of the mean of r_mid at Theta = 0 and pi over z_w"),
    "dzw_dA2": ("A", "initial slope of z_w over the squared offset of the centroid"),
    "dV_dA2": ("1/A", "initial slope of V over the squared offset of the centroid"),
}


def secondary_grid(
    grids: tuple[tuple[int, int, int, int], ...], nets: tuple[tuple[int, int, int, int], ...]
) -> str:
    """Grids of both two-dimensional codes."""
    one, two = (
        "; ".join(f"{w} + {d} of degree {p}, wave numbers to {m}" for w, d, p, m in each)
        for each in (grids, nets)
    )
    return f"wet + dry elements, (a) {one}; (b) {two} (over-filled: wet only)"


def _counts(mesh: object) -> str:
    return f"{mesh.wet} + {mesh.dry} of degree {mesh.degree}"


_A = "; ".join(f"{_counts(r.partial)} (over-filled {_counts(r.full)})" for r in path.RESOLUTIONS)
_B = "; ".join(
    f"{_counts(r.partial_elements)} (over-filled {_counts(r.full_elements)})" for r in path.RESOLUTIONS
)
GRID = f"wet + dry elements, (a) {_A}; (b) {_B}; wet elements graded to the lower ring"
SERIES = Series(3, PAPER, COLUMNS, METHOD, GRID, TOLERANCE)
