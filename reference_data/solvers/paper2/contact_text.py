"""Documentation texts of the contact tables of paper 2."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from reference_data.solvers.core.tables import rule
from reference_data.solvers.paper2 import text as tube_text
from reference_data.solvers.paper2.collocation import states as st
from reference_data.solvers.paper2.differences import contact as cfd
from reference_data.solvers.paper2.differences import deflation as defl

METHOD = {
    "frictionless": (
        "Two codes that share only the constitutive derivatives: (a) central finite differences of "
        "the second-order equations, the front on a node and its position an unknown, four grids, h^2, "
        f"h^3 and h^4 eliminated; (b) piecewise Chebyshev collocation of the first-order system in two "
        f"zones, the front an unknown, two meshes. {rule('b')}"
    ),
    "adhesive": (
        "Two codes that share only the constitutive derivatives: (a) central finite differences, the "
        "front followed node by node, eta frozen node by node (first order), five grids, h to h^4 "
        "eliminated; (b) frozen eta' as a Chebyshev series in z, collocated at as many fronts, each "
        "with its own two-zone collocation state, all solved together; two series lengths and meshes. "
        f"{rule('b')}"
    ),
}
SPRING = {
    "bilateral": (
        "Spring as in equation (9): it acts on the whole acquired patch, whatever the sign of rho - s."
    ),
    "unilateral": "The spring acts only where rho > s; the axial position alone stays stuck. "
    "Not tabulated just below p_end, where the strip that has lifted is narrower than a few cells of (a).",
}
DEFLATION_NOTES = (
    "Deflation from p_end at the end of adhesive inflation; the patch acquired there does not peel."
)
BEFORE = "Before first contact the states are those of free inflation (table contact_onset)."
ONSET_NOTES = "First touch of free inflation, rho(0) = s; same for frictionless and adhesive contact."

COLUMNS: dict[str, tuple[str, str]] = tube_text.COLUMNS | {
    "contact_length": ("1/R_f", "deformed length of the whole patch, eta_e - eta_s = 2 eta(front)"),
    "lam2_mid": ("1", "circumferential stretch at the mid-plane"),
    "Z_front": ("delta1 z/R_f", "axial position of the front before inflation, from the mid-plane"),
    "traction_front": (
        "F_t R_f/(C1 h_o)",
        "|f_t| at the front, inside: axial traction of the substrate per deformed area, "
        "rho lambda1 f_t = -[(r0 w_1 eta'/lambda1)' - P_eff rho rho']",
    ),
    "traction_max": ("F_t R_f/(C1 h_o)", "largest |f_t| in the patch"),
    "spring_max": (
        "F_k R_f/(C1 h_o)",
        "largest |f_k| in the patch, f_k = -k (eta'/lambda1) [(rho - s) + (rho - s)^2/(2 rho)]",
    ),
    "line_force": (
        "F_l/(C1 h_o)",
        "axial line force at the edge of the patch, rho f_l = |jump of r0 w_1 eta'/lambda1 - g|, "
        "g = p rho^2/2 - chi k rho (rho - s)^2/2 (equation (22))",
    ),
    "line_force_membrane": ("F_l/(C1 h_o)", "the same with the jump of r0 w_1 eta'/lambda1 alone"),
    "t2_min": ("T2/(C1 h_o)", "smallest circumferential stress resultant of the tube"),
    "kappa": (
        "R_f",
        "meridional curvature of the free part at the front, "
        "(w_2 cos b - p rho lambda1)/(r0 w_1 lambda1); negative: bulged outward",
    ),
    "f_t": ("F_t R_f/(C1 h_o)", "axial traction of the substrate on the membrane, per deformed area"),
    "f_k": ("F_k R_f/(C1 h_o)", "radial spring density; negative pushes inward"),
    "k": ("K R_f^2/(C1 h_o)", "spring constant"),
    "s": ("S/R_f", "inner radius of the substrate"),
}


def grid(contact: str, cells: Sequence[int] = ()) -> str:
    """Grids of both codes, as used; of the first one the usual ones, or those given."""
    cells = cells or (cfd.GRIDS if contact == "frictionless" else defl.GRIDS)
    meshes = " and ".join(
        f"{r.inner.elements} + {r.outer.elements} elements of degree {r.inner.degree}"
        + (f", {r.terms} terms" if contact == "adhesive" else "")
        for r in st.RESOLUTIONS
    )
    shape = "z = L tanh(1.5 X)/tanh(1.5), X = x + c x (1 - x^2)"
    return f"(a) {', '.join(str(n) for n in cells)} cells, {shape}; (b) {meshes}"


SERIES = {
    contact: replace(tube_text.SERIES, columns=COLUMNS, method=METHOD[contact], grid=grid(contact))
    for contact in METHOD
}
