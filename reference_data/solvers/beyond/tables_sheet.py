"""Tables of sheets in their plane: sheared, stretched at a held width, pulled as a strip, and bent."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np

from reference_data.solvers.beyond.bent_sheet import quadrature, shooting
from reference_data.solvers.closed_form import sheets
from reference_data.solvers.core.tables import Column, Levels, Series, Table, agreed, rule, steps
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


TOLERANCES, NODES = (1e-10, 1e-12), (16, 24)
"""Coarse and fine resolution of both methods for bent sheets."""
ROUNDING = 1e-12
"""Rounding of both, relative to numbers above one."""
BENT_COLUMNS = COLUMNS | {
    "kap": ("1/a", "curvature: angle between the ends over the length at rest"),
    "lam0": ("1", "stretch in X before the sheet is bent"),
    "s": ("a", "distance of the guides"),
    "T_x": ("C1 h", "mean nominal stress along the arcs"),
    "M": ("C1 h a^2", "moment about the arc of the stretch lam0"),
    "f_w": ("1", "width of the wrinkled band over the width at rest"),
}
BENT = Series(
    "beyond",
    "Stein & Hedgepeth (1961), a stretched sheet that is bent, at finite strains",
    BENT_COLUMNS,
    "Two ways: (a) integration of the equilibrium across the sheet, with the slope at the inner arc unknown; "
    "(b) quadratures of the first integral w' W_w' - W of the relaxed energy, with derivatives by complex "
    "steps. " + rule("b"),
    f"(a) tolerances {TOLERANCES[0]} and {TOLERANCES[1]}; (b) {NODES[0]} and {NODES[1]} points of Gauss",
    "brackets of roots down to rounding",
)


def bent(name: str, sheet: shooting.Sheet, curvatures: np.ndarray) -> Table:
    """Force, moment and wrinkled band of a sheet over its curvature."""
    shot, integrated = (
        [[bend(sheet, kap, fine) for kap in curvatures.tolist()] for fine in levels]
        for bend, levels in ((shooting.bent, TOLERANCES), (quadrature.bent, NODES))
    )
    columns = BENT.keys(kap=curvatures)
    for column, part in (("T_x", "force"), ("M", "moment"), ("f_w", "wrinkled")):
        a, b = ([[getattr(state, part) for state in level] for level in way] for way in (shot, integrated))
        columns.append(_by_both_ways(name, column, a, b))
    return BENT.table(name, "A stretched sheet that is bent in its plane", "", _parameters(sheet), columns)


def bent_onset(name: str, bodies: tuple[shooting.Sheet, ...]) -> Table:
    """Curvature at which bent sheets begin to wrinkle."""
    shot, integrated = (
        [[find(sheet, fine) for sheet in bodies] for fine in levels]
        for find, levels in ((shooting.onset, TOLERANCES), (quadrature.onset, NODES))
    )
    keys = {part: np.array([getattr(sheet, part) for sheet in bodies]) for part in ("lam0", "s")}
    columns = [*BENT.keys(**keys), _by_both_ways(name, "kap", shot, integrated)]
    title = "Curvature at which a stretched sheet begins to wrinkle"
    given = {"loading": "bend", "alpha": ALPHA}
    return BENT.table(name, title, "", given, columns, extra={"keys": ["lam0", "s"]})


def _by_both_ways(table: str, name: str, shot: list, integrated: list) -> Column:
    a, b = (Levels(*map(np.array, way), rounding=ROUNDING) for way in (shot, integrated))
    return agreed(table, name, a, b, BENT_COLUMNS[name], other="shooting", written="b")


def _parameters(sheet: shooting.Sheet) -> dict[str, object]:
    return {"loading": "bend", "alpha": sheet.alpha, "lam0": sheet.lam0, "s": sheet.s}


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
    "bent_sheet": partial(bent, "bent_sheet", shooting.Sheet(ALPHA, 1.1, 1.0), steps(0.05, 1.0, 0.05)),
    "bent_sheet_wide": partial(
        bent, "bent_sheet_wide", shooting.Sheet(ALPHA, 1.2, 1.2), steps(0.05, 1.0, 0.05)
    ),
    "bent_sheet_onset": partial(
        bent_onset,
        "bent_sheet_onset",
        tuple(shooting.Sheet(ALPHA, *at) for at in ((1.1, 1.0), (1.2, 1.2))),
    ),
    "sheet_onset": partial(onset, "sheet_onset", (1.05, 1.1, 1.2, 1.3)),
}
