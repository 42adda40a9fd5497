"""Columns of solutions that are not judged, or not in all they say, with reasons: the report lists them."""

from __future__ import annotations

EXEMPT: dict[str, str] = {
    "residual": "how far Newton's method came; it describes the solve, not the solution",
    "iterations": "how many steps it took; it describes the solve, not the solution",
}
"""Columns that are not judged, and why."""

EXEMPT_SIZE: dict[str, str] = {
    "eigenvalue_1": "its size is that of the mass it is taken against; its sign and its zeros are judged",
    "n_negative": "a count: one percent more of it is no whole number, and none is none",
}
"""Columns of which only the sign is judged where no table has them, and why."""

KNOWN: dict[str, str] = {
    "wrinkled_tube: Pi": "in traces of few steps the work is not known to one percent (gas, near its end)",
    "wrinkled_tube: profile:slope": "its size is held by the axial force, its sign by nothing",
    "wrinkled_tube: state": "a label of what opens or closes, not a number",
    "wrinkled_tube: load": "of an event: the control's own value, under the name that both controls share",
    "wrinkled_tube: Z": "of an event: where on the meridian; compared in the cases of zones only",
    "wrinkled_tube: Z_front_1": "tables have fronts at the states of the figures only",
    "wrinkled_tube: Z_front_2": "tables have fronts at the states of the figures only",
    "wrinkled_tube: Z_front_3": "tables have fronts at the states of the figures only",
    "hemisphere: state": "a label of what opens or closes, not a number",
    "hemisphere: load": "of an event: the control's own value, under the name that both controls share",
    "tube: traction_max": "a peak at the edge of a patch that lets go, known to a few percent there",
    "circular: X_iso": "where two stretches part by 1e-4: compared in the cases that show it",
    "fluid_tube: profile:H": "a first integral: its constancy is judged where a case shows it, not its size",
}
"""Columns that the audit is known to miss in some solution, and why: a debt, not an exemption."""

UNSTATED: dict[str, str] = dict.fromkeys(
    ("surface", "fluid_tube_surface", "fluid_tube_coincidence", "wrinkled_sheet", "wrinkled_linear"),
    "its columns are held by the tables and claims of its cases alone, not all of them by either",
)
"""Problems whose columns no identity holds, and what holds them."""
