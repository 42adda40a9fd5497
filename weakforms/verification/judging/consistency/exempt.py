"""Columns of solutions that are not judged, or not in all they say, with reasons: the report lists them."""

from __future__ import annotations

EXEMPT: dict[str, str] = {
    "residual": "how far Newton's method came; it describes the solve, not the solution",
    "iterations": "how many steps it took; it describes the solve, not the solution",
}
"""Columns that are not judged, and why."""

EXEMPT_SIZE: dict[str, str] = {
    "eigenvalue_1": "its size is that of the mass it is taken against; its sign and its zeros are judged",
    "Lambda_1_stable": "its size is that of the mass it is taken against; its sign is judged",
    "n_negative": "a count: one percent more of it is no whole number, and none is none",
    "n_negative_V": "a count: one percent more of it is no whole number, and none is none",
    "departure": "whether a surface departs from its rings is judged, not how far",
}
"""Columns of which only the sign is judged where no table has them, and why."""

KNOWN: dict[str, str] = {
    "hemisphere: t": "of an event: where on the meridian it is, without a profile there",
    **{
        f"hemisphere: mode_n#:{part}": "a mode's size and sign are conventions; its shape is looked at"
        for part in ("meridional", "circumferential", "normal")
    },
    "fluid_tube: Z_front": "its sign alone: tables and profiles look for it from the ring upwards",
    "fluid_tube: z_min": "of bent states: their surfaces are sampled at too few points for an extreme",
    "fluid_tube: T_min": "of bent states: their surfaces are sampled at too few points for an extreme",
    **{
        f"fluid_tube_surface: {name}": "compared between half and full circumference, which share its size"
        for name in ("Lambda_bent_1", "Pi_bent", "V_bent", "zw_bent", "Lambda_pair_1", "Lambda_pair_2")
    },
    "fluid_tube_surface: Lambda_split": "compared between an even and an uneven mesh, which share its size",
    "fluid_tube_surface: phase": "compared between an even and an uneven mesh, which share its size",
    "surface: Pi": "walks of triangles have too few points for the work along them",
    **{
        f"surface: {name}": "of a picture: nodes and triangles of a deformed surface, looked at"
        for name in (
            *("surface:Theta", "surface:gw", "surface:x", "surface:y", "surface:u_x", "surface:u_y"),
            *("surface:u_z", "triangles:b", "triangles:c"),
            *("triangles:lam1", "triangles:lam2", "triangles:state"),
        )
    },
    "circular_scheme: lam_pole": "of a scheme of first order, known to a third of a percent",
    "wrinkled_linear: n_critical": "a claim compares it with whole n, closer than 1 % is not asked",
    "wrinkled_patch: U_ee": "jumps where the membrane becomes taut, which no spline follows",
    "wrinkled_patch: profile:x": "of a picture: the period of the wrinkles",
    "wrinkled_patch: profile:z": "of a picture: the height of the wrinkles",
    "wrinkled_sheet: radius": "an integral that no other problem returns",
}
"""Columns that the audit is known to miss, and why: a debt, not an exemption."""

UNSTATED: dict[str, str] = dict.fromkeys(
    ("fluid_tube_surface", "fluid_tube_coincidence"),
    "its columns are held by the tables and claims of its cases alone, not all of them by either",
)
"""Problems whose columns no identity holds, and what holds them."""
