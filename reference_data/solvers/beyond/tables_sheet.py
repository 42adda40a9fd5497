"""Tables of homogeneous sheets: sheared, stretched at a held width, and pulled as a strip."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np

from reference_data.solvers.closed_form import sheets
from reference_data.solvers.core.tables import Column, Series, Table, agreed, steps
from reference_data.solvers.core.two_estimates import rounded
from reference_data.solvers.registry import Builder

COLUMNS = {
    "gam": ("a", "displacement of the edge Y = 1 along X; a: width at rest"),
    "lam": ("1", "stretch in X"),
    "s": ("1", "stretch in Y"),
    "tau": ("C1 h", "mean nominal shear stress"),
    "T_x": ("C1 h", "mean nominal stress in X"),
    "T_y": ("C1 h", "mean nominal stress in Y"),
    "lam1": ("1", "larger principal stretch"),
    "lam2": ("1", "smaller principal stretch"),
}
SERIES = Series(
    "beyond",
    "Wagner (1929), tension-field theory of homogeneous sheets",
    COLUMNS,
    "Two ways that share the law only: (a) derivatives by hand of the energy of two invariants, and of that "
    "of uniaxial tension where the sheet is wrinkled; (b) differences of sixth order of the bulk energy, "
    "least over all widths greater than the sheet's. The values are (a).",
    "none",
    "rounding",
)
HAND, DIFFERENCES = 1e-13, 2e-11
"""Uncertainties of both, relative to one plus the value: rounding, and the truncation of differences."""
ALPHA = 0.1


def states(
    name: str, title: str, over: str, values: np.ndarray, fixed: dict[str, float], *names: str
) -> Table:
    """Stresses and stretches of a sheet over the motion of its edges."""
    found = []
    for value in values.tolist():
        at = sheets.State(**({"lam": 1.0, "gam": 0.0, "s": 1.0} | fixed | {over: value}))
        found.append((sheets.by_hand(ALPHA, at), sheets.by_energy(ALPHA, at)))
    return _table(name, title, over, values, fixed, found, names)


def strip(name: str, stretches: np.ndarray) -> Table:
    """A strip of free width: it has its natural width, and the force of a wrinkled sheet of that length."""
    found = []
    for lam in stretches.tolist():
        own = sheets.by_hand(ALPHA, sheets.State(lam, 0.0, lam**-0.5))
        folded = sheets.by_energy(ALPHA, sheets.State(lam, 0.0, NARROW))
        found.append((own, folded._replace(lam2=sheets.natural(ALPHA, lam))))
    title = "A strip of free width in tension"
    return _table(name, title, "lam", stretches, {"loading": "strip"}, found, ("T_x", "lam2"))


NARROW = 0.4
"""Width at which a sheet is wrinkled at every stretch of the tables."""


def _table(
    name: str, title: str, over: str, values: np.ndarray, fixed: dict, found: list, names: tuple[str, ...]
) -> Table:
    columns = SERIES.keys(**{over: values})
    for column in names:
        pairs = zip(*((getattr(a, column), getattr(b, column)) for a, b in found), strict=True)
        columns.append(_both(name, column, *pairs))
    return SERIES.table(name, title, "", {"alpha": ALPHA} | fixed, columns, kind="exact")


def _both(table: str, name: str, hand: Sequence[float], energy: Sequence[float]) -> Column:
    by_energy, by_hand = rounded(energy, DIFFERENCES), rounded(hand, HAND)
    how = {"other": "differences of the energy", "written": "by hand"}
    return agreed(table, name, by_energy, by_hand, COLUMNS[name], **how)


def onset(name: str, widths: tuple[float, ...]) -> Table:
    """Shear at which sheets of some widths begin to wrinkle."""
    hand, other = ([f(s) for s in widths] for f in (sheets.onset_by_hand, sheets.onset_by_stretches))
    columns = [*SERIES.keys(s=np.array(widths)), _both(name, "gam", hand, other)]
    title = "Shear at which a stretched sheet begins to wrinkle"
    return SERIES.table(name, title, "", {"alpha": ALPHA}, columns, kind="exact", extra={"keys": ["s"]})


SHEAR = "tau", "T_x", "T_y", "lam1", "lam2"
TABLES: dict[str, Builder] = {
    "sheet_sheared": partial(
        states, "sheet_sheared", "Shear of a sheet", "gam", steps(0.1, 1.0, 0.1), {"s": 1.0}, *SHEAR
    ),
    "sheet_sheared_wide": partial(
        states,
        "sheet_sheared_wide",
        "Shear of a sheet that was stretched across",
        "gam",
        steps(0.1, 1.0, 0.1),
        {"s": 1.2},
        *SHEAR,
    ),
    "sheet_stretched": partial(
        states,
        "sheet_stretched",
        "Tension of a sheet whose width is held below that at rest",
        "lam",
        steps(1.1, 2.0, 0.1),
        {"s": 0.8},
        *("T_x", "T_y", "lam2"),
    ),
    "sheet_strip": partial(strip, "sheet_strip", steps(1.1, 2.0, 0.1)),
    "sheet_onset": partial(onset, "sheet_onset", (1.05, 1.1, 1.2, 1.3)),
}
