"""Paper 3: columns and quantities of the secondary branch, with their scaling."""

from __future__ import annotations

COLUMNS = ("r_mid_pi", *(f"{name}_quarter_{side}" for name in "xz" for side in ("0", "pi")))
"""Columns of the secondary branch that the primary branch does not have."""

RESULTANTS = tuple(f"{name}_quarter_{side}" for name in ("T1", "T2") for side in ("0", "pi"))
"""Columns that are evaluated across elements."""

DERIVED_COLUMNS = (
    *RESULTANTS,
    "z_min",
    "T_min",
    "Lambda_1",
    "Lambda_2",
    "Lambda_3",
    "Lambda_breaking",
    "Lambda_rotation",
    "LambdaV_1",
    "n_negative_breaking",
    "n_negative_V",
)
"""Numbers of a state of the secondary branch that cannot be prescribed."""

SLOPES = ("dzw_dV", "dzw_dr2", "dr_mean_dzw")
"""Initial slopes, values of the bifurcation point at which the secondary branch starts."""

SCALES = {
    "r_mid": "radius at Z = L/(2 delta) over A; on the secondary branch at Theta = 0, the bulge's side",
    "r_mid_pi": "radius at Z = L/(2 delta), Theta = pi over A",
    **{
        f"{name}_quarter_{side}": f"{what} at Z = L/(4 delta), Theta = {side}"
        for side in ("0", "pi")
        for name, what in {
            "x": "x over A, from the axis of the disks to the bulge's side,",
            "z": "height over A",
            "T1": "meridional Cauchy resultant over mu H",
            "T2": "circumferential Cauchy resultant over mu H",
        }.items()
    },
    "z_min": "lowest point of the membrane over A",
    "T_min": "smallest principal Cauchy resultant anywhere over mu H",
    **{
        f"Lambda_{i}": f"{i}. lowest eigenvalue at fixed level, mirror-symmetric displacements"
        for i in (1, 2, 3)
    },
    "Lambda_breaking": "lowest eigenvalue at fixed level, displacements that break the mirror symmetry, "
    "without the rotation of the pattern",
    "Lambda_rotation": "eigenvalue of the rotation of the pattern about the axis: exactly 0, its size "
    "shows the error",
    "LambdaV_1": "lowest eigenvalue at fixed volume, mirror-symmetric displacements",
    "n_negative_breaking": "negative eigenvalues at fixed level among displacements that break the symmetry",
    "n_negative_V": "negative eigenvalues at fixed volume, mirror-symmetric displacements",
    "dzw_dV": "initial slope of the secondary branch, both of second order in its amplitude",
    "dzw_dr2": "initial ratio of the decrease of zw to the square of the change of r_mid, times A",
    "dr_mean_dzw": "initial slope over zw of the mean of r_mid and r_mid_pi",
    "Theta": "angle on the stress-free tube from the bulge's side",
    "x": "coordinate across the axis, towards the bulge, over A",
    "y": "coordinate across the axis, normal to the plane of symmetry, over A",
}
