"""Documentation texts of the tables of paper 1."""

from __future__ import annotations

from reference_data.solvers.core.tables import Series, rule
from reference_data.solvers.paper1.collocation.states import RESOLUTIONS
from reference_data.solvers.paper1.shooting.equations import LEVELS

PAPER = "Patil, DasGupta & Eriksson, Int. J. Solids Struct. 67-68 (2015) 250-262"

METHOD = {
    "sliding": (
        "Two codes that share only the constitutive derivatives: (a) shooting from the pole, "
        "second-order strong form, Runge-Kutta 8(5,3), the front an unknown; (b) piecewise "
        f"Chebyshev collocation of the first-order system, the front an unknown. {rule('b')}"
    ),
    "locked": (
        "Two codes that share only the constitutive derivatives: (a) shooting from the front, the "
        "history as an initial value problem in the front position, Runge-Kutta 8(5,3) both; (b) "
        "Chebyshev collocation of the free part and frozen slopes as Chebyshev series in x, a fixed "
        f"point over all fronts at once. {rule('b')}"
    ),
    "radial": (
        "Two codes that share only the constitutive derivatives: (a) shooting from the pole through "
        "the patch, the frozen radius marched piece by piece through Radau points; (b) two-zone "
        "Chebyshev collocation, the frozen slope a Chebyshev series in x, a fixed point over all "
        f"fronts at once. {rule('b')}"
    ),
}
TOLERANCE = (
    f"(a) relative tolerances {LEVELS[0].rtol:g} and {LEVELS[1].rtol:g} (history {LEVELS[0].history:g} and "
    f"{LEVELS[1].history:g}), Newton to rounding; (b) Newton takes one more step after the first one "
    "below 1e-8: rounding only"
)
LOCKED = (
    "Model R: the patch is rigid and locked (no slip in any direction, both stretches frozen as the "
    "front passes), rho and eta are continuous at the front, the whole patch is in vertical balance; "
    "limit of infinitely small freezing steps."
)
DEFLATION = (
    "The patch acquired at p_end moves as a rigid body and does not peel; its springs act in tension too."
)
FROZEN_POLE = "The pole keeps the stretch of first contact (table disk_contact_onset)."
RADIAL = "Model N: in the patch rho(x) is frozen, eta in vertical equilibrium."
SLIDING = "Before first contact the states are those of free inflation (table disk_contact_onset)."

COLUMNS: dict[str, tuple[str, str]] = {
    "alpha": ("C2/C1", "Mooney-Rivlin constant"),
    "beta": ("R_f/R_0", "pre-stretch"),
    "k": ("K R_f^2/(C1 h)", "stiffness of the substrate"),
    "l": ("L/R_f", "height of the substrate"),
    "p": ("P R_f/(C1 h)", "gauge pressure"),
    "t0": ("1/R_f", "height of the pole, eta(0)"),
    "lam_pole": ("1", "stretch at the pole, lambda1 = lambda2"),
    "lam1_rim": ("1", "meridional stretch at the rim"),
    "V": ("V/(2 pi R_f^3)", "enclosed volume per 2 pi, -int rho^2 eta'/2 dx"),
    "X_contact": ("beta r/R_f", "material position of the contact edge, beta x*"),
    "rho_contact": ("1/R_f", "radius of the contact edge"),
    "lam1_contact": ("1", "meridional stretch at the contact edge, inside (locked side)"),
    "lam1_contact_outer": ("1", "meridional stretch at the contact edge, outside"),
    "sigma_pole": ("sigma R_f/(C1 h)", "contact stress -k (eta - l) at the pole; negative: compression"),
    "sigma_contact": ("sigma R_f/(C1 h)", "contact stress -k (eta - l) at the edge, on the patch"),
    "X_iso": ("beta r/R_f", "first X where |lambda1 - lambda2| = 1e-4"),
    "X": ("beta r/R_f", "material position"),
    "rho": ("1/R_f", "radius"),
    "eta": ("1/R_f", "height"),
    "lam1": ("1", "meridional stretch, from the unstretched disk"),
    "lam2": ("1", "circumferential stretch, from the unstretched disk"),
    "t1": ("T1/(C1 h)", "meridional true stress resultant W_1/lambda2 (per deformed length)"),
    "t2": ("T2/(C1 h)", "circumferential true stress resultant W_2/lambda1 (per deformed length)"),
    "sigma": ("sigma R_f/(C1 h)", "contact stress -k (eta - l) on the patch, 0 outside"),
    "G": ("G/(C1 h)", "energy release rate of the contact edge at fixed p, closed form"),
    "p_end": ("P R_f/(C1 h)", "pressure at the end of adhesive inflation"),
    "curvature": ("R_f", "meridional curvature of the free part at the edge; positive: bulging"),
}


_A = " and ".join(f"series to x = {h.start:g}, history from {h.first:g}" for h in LEVELS)
_B = " and ".join(
    f"{r.free.elements} (free), {r.inner.elements} + {r.outer.elements} (contact) elements of degrees "
    f"{r.free.degree}, {r.inner.degree}, history of {r.terms} terms"
    for r in RESOLUTIONS
)
SERIES = {
    model: Series(1, PAPER, COLUMNS, method, f"(a) adaptive; {_A}; (b) {_B}", TOLERANCE)
    for model, method in METHOD.items()
}
