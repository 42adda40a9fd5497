"""Columns of solutions that are not judged, or not in all they say, with reasons: the report lists them."""

from __future__ import annotations

from weakforms.problems.registry import abouts

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
    f"{name}: {column}": reason for name, about in abouts().items() for column, reason in about.missed.items()
}
"""Columns that the audit is known to miss, and why: a debt, not an exemption."""

UNSTATED: dict[str, str] = {name: about.unstated for name, about in abouts().items() if about.unstated}
"""Problems whose columns no identity holds, and what holds them."""
