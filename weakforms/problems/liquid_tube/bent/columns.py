"""Paper 3: numbers of the secondary branch."""

from __future__ import annotations

from weakforms.problems.column import Column, derived, numbers


def _at_quarter(name: str, what: str) -> tuple[Column, ...]:
    """A number at a quarter of the length, on both sides of the plane of symmetry."""
    sides = ("0", "pi")
    return tuple(Column(f"{name}_quarter_{t}", f"{what} at Z = L/(4 delta), Theta = {t}") for t in sides)


PRESCRIBED = (
    Column("r_mid_pi", "radius at Z = L/(2 delta), Theta = pi over {length}"),
    *_at_quarter("x", "x over {length}, from the axis of the disks to the bulge's side,"),
    *_at_quarter("z", "height over {length}"),
)
"""Columns of the secondary branch that the primary branch does not have."""

RESULTANTS = derived(
    *_at_quarter("T1", "meridional Cauchy resultant over {resultant}"),
    *_at_quarter("T2", "circumferential Cauchy resultant over {resultant}"),
)
"""Columns that are evaluated across elements."""

DERIVED = derived(
    *RESULTANTS,
    *numbers(
        z_min="lowest point of the membrane over {length}",
        T_min="smallest principal Cauchy resultant anywhere over {resultant}",
        Lambda_1="1. lowest eigenvalue at fixed level, mirror-symmetric displacements",
        Lambda_2="2. lowest eigenvalue at fixed level, mirror-symmetric displacements",
        Lambda_3="3. lowest eigenvalue at fixed level, mirror-symmetric displacements",
        Lambda_breaking="lowest eigenvalue at fixed level, displacements that break the mirror symmetry, "
        "without the rotation of the pattern",
        Lambda_rotation="eigenvalue of the rotation of the pattern about the axis: exactly 0, its size "
        "shows the error",
        LambdaV_1="lowest eigenvalue at fixed volume, mirror-symmetric displacements",
        n_negative_breaking="negative eigenvalues at fixed level among displacements that break the symmetry",
        n_negative_V="negative eigenvalues at fixed volume, mirror-symmetric displacements",
    ),
)
"""Numbers of a state of the secondary branch that cannot be prescribed."""

SLOPES = numbers(
    dzw_dV="initial slope of the secondary branch, both of second order in its amplitude",
    dzw_dr2="initial ratio of the decrease of zw to the square of the change of r_mid, times A",
    dr_mean_dzw="initial slope over zw of the mean of r_mid and r_mid_pi",
)
"""Values of the bifurcation point at which the secondary branch starts."""

SURFACE = numbers(
    Theta="angle on the stress-free tube from the bulge's side",
    x="coordinate across the axis, towards the bulge, over {length}",
    y="coordinate across the axis, normal to the plane of symmetry, over {length}",
)
"""Coordinates on the surface."""
