"""Tables of paper 2 over Z: profiles in contact (figures 7-10) and tractions in the patch (12).

Patil, Nordmark & Eriksson, Proc. R. Soc. A 470 (2014) 20140282.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from reference_data.solvers.core.tables import Array, Table, agreed, steps
from reference_data.solvers.paper2 import contact_cases as cc
from reference_data.solvers.paper2 import contact_text as text
from reference_data.solvers.paper2.collocation import states as st
from reference_data.solvers.paper2.collocation.critical import resolved
from reference_data.solvers.paper2.collocation.equations import State, columns
from reference_data.solvers.paper2.collocation.equations import profile as at_places
from reference_data.solvers.paper2.contact_cases import P_END, Case
from reference_data.solvers.paper2.differences import contact as cfd
from reference_data.solvers.paper2.differences import deflation as defl
from reference_data.solvers.registry import Builder

FIELDS = ("rho", "eta", "lam1", "lam2", "t1", "t2")
TRACTIONS = ("f_t", "f_k")
AWAY = 0.02  # rows nearer to the front (in Z) are left out
AMPLIFIED = 256  # rounding of a slope interpolated near the disk, where the grid is fine
FINER = tuple(2 * n for n in defl.GRIDS)  # for tractions of the other tubes of figure 12
SECOND = FINER[-1] ** 2 // cfd.GRIDS[-1]  # a traction contains second differences: rounding grows like n^2

Profile = dict[str, Array]


def states_by_collocation(case: Case, kind: str, p: float) -> list[State]:
    """One state at both resolutions; kind is frictionless, inflation or deflation (bilateral)."""
    if kind == "frictionless":
        return [states[0] for states in cc.frictionless(case, np.array([p]))]
    if kind == "inflation":
        return list(cc.adhesive(case, p))
    walk = np.append(steps(p, P_END, 0.5)[:0:-1], p)
    return [states[-1] for states in cc.deflated(case, "bilateral", walk)]


def profiles_by_differences(
    case: Case, kind: str, p: float, grids: Sequence[int] = defl.GRIDS
) -> Callable[[Array], list[Profile]]:
    """Profiles of the same state on every grid, as a function of z; grids are those of stuck patches."""
    if kind == "frictionless":
        states = cfd.on_grids(cfd.walk(case.tube, case.substrate, np.array([p]))[0])
        return lambda z: [cfd.profile(case.tube, s.grid, s.y, s.grid.front, z) for s in states]
    if kind == "inflation":
        stuck = [defl.fitted(case.tube, case.substrate, n, p) for n in grids]
    else:
        walk = np.append(steps(p, P_END, 0.5)[:0:-1], p)
        stuck = [run[-1] for run in cc.deflated_fd(case, "bilateral", walk, grids=grids)]
    return lambda z: [defl.profile(s, z) for s in stuck]


def profile(
    name: str,
    case: Case,
    kind: str,
    p: float,
    source: str,
    wanted: tuple[str, ...],
    finer: bool = False,
) -> Table:
    """One profile, or the tractions of one patch; with finer grids if need be."""
    states = states_by_collocation(case, kind, p)
    tube, front = case.tube, float(states[-1].fronts[-1]) * case.tube.delta1
    z_plot = steps(0.0, tube.lf / 2, tube.lf / 80)
    z_plot = z_plot[np.abs(z_plot - front) > AWAY]
    if wanted == TRACTIONS:
        z_plot = z_plot[z_plot < front]
    z = z_plot / tube.delta1
    grids, amplified = (FINER, SECOND) if finer else (defl.GRIDS, AMPLIFIED)
    raw_a = profiles_by_differences(case, kind, p, grids)(z)
    raw_b = []
    for state in states:
        column = columns(tube, at_places(state, z))
        if wanted == TRACTIONS:
            column |= dict(zip(TRACTIONS, st.tractions_at(state, z), strict=True))
        raw_b.append(column)
    powers = (2, 3, 4) if kind == "frictionless" else defl.POWERS
    found = text.SERIES["adhesive"].keys(Z=z_plot)
    for c in wanted:
        a = cfd.extrapolated([r[c] for r in raw_a], powers, amplified=amplified)
        found.append(agreed(name, c, a, resolved(*(r[c] for r in raw_b)), text.COLUMNS[c]))
    contact = "frictionless" if kind == "frictionless" else "adhesive"
    phase = "deflation" if kind == "deflation" else "inflation"
    spring = {"spring": "bilateral"} if phase == "deflation" else {}
    parameters = (
        case.parameters | {"phase": phase} | spring | {"p_end": P_END, "p": float(p), "Z_front": front}
    )
    what = "Tractions in the patch" if wanted == TRACTIONS else "Profile"
    title = f"{what}, {contact} {phase}, {case.title}, p = {p:g}"
    notes = f"Z_front is the position of the front; Z within {AWAY:g} of it is left out."
    if spring:
        notes += f" {text.DEFLATION_NOTES} {text.SPRING['bilateral']}"
    more = {"grid": text.grid(contact, grids)} if finer else {}
    return cc.table(contact, name, title, source, parameters, found, notes=notes, **more)


def paths(name: str, case: Case, source: str) -> Table:
    """Radius and axial position of material points over the pressure in deflation, bilateral spring."""
    walk, z = steps(0.0, P_END, 0.25)[::-1], np.array(POINTS) / case.tube.delta1
    raw_a = [
        [defl.profile(state, z) for state in run[::-1]] for run in cc.deflated_fd(case, "bilateral", walk)
    ]
    raw_b = [
        [columns(case.tube, at_places(state, z)) for state in run[::-1]]
        for run in cc.deflated(case, "bilateral", walk)
    ]
    found = text.SERIES["adhesive"].keys(p=walk[::-1])
    for i, point in enumerate(POINTS):
        for c in ("rho", "eta"):
            a, b = ([np.array([row[c][i] for row in run]) for run in raw] for raw in (raw_a, raw_b))
            a = cfd.extrapolated(a, defl.POWERS, amplified=AMPLIFIED)
            about = (text.COLUMNS[c][0], f"{text.COLUMNS[c][1]} of Z = {point:g}")
            found.append(agreed(name, f"{c}_{point:g}", a, resolved(*b), about))
    parameters = case.parameters | {"phase": "deflation", "spring": "bilateral", "p_end": P_END}
    title = f"Paths of material points, adhesive deflation, {case.title}"
    notes = f"{text.DEFLATION_NOTES} {text.SPRING['bilateral']}"
    return cc.table("adhesive", name, title, source, parameters, found, notes=notes)


POINTS = (0.5, 1.0, 1.5, 2.0, 2.6, 2.8)
"""Z of the points of the paths; the last two stay outside the patch."""
SOFT_1, SOFT_2 = cc.PAPER[2:]  # alpha = 0.1, delta1 = 1 and 2
FIGURES: tuple[tuple[str, str, Case, str, tuple[float, ...]], ...] = (
    ("fig07a", "figure 7(a)", SOFT_1, "frictionless", (1.6, 2.0, 2.5, 3.0)),
    ("fig07b", "figures 7(b) and 8(a)", SOFT_1, "inflation", (1.6, 2.0, 2.5, 3.0)),
    ("fig07c", "figures 7(c) and 8(c)", SOFT_1, "deflation", (3.0, 2.0, 1.0, 0.0)),
    ("fig08b", "figure 8(b)", SOFT_2, "inflation", (1.6, 2.0, 2.5, 3.0)),
    ("fig10a", "figure 10(a)", SOFT_1, "deflation", (3.0, 2.0, 1.5, 1.0, 0.0)),
    ("fig10b", "figure 10(b)", SOFT_2, "deflation", (3.0, 2.0, 1.5, 1.0, 0.0)),
)


def _tables() -> dict[str, Builder]:
    """Every table of this module."""
    out: dict[str, Builder] = {}
    for head, source, case, kind, pressures in FIGURES:
        for p in pressures:
            name = f"{head}_p_{p:g}"
            out[name] = partial(profile, name, case, kind, p, source, FIELDS)
    for case in cc.PAPER:
        for letter, kind in (("a", "frictionless"), ("b", "inflation")):
            name = f"fig09{letter}_{case.label}"
            out[name] = partial(profile, name, case, kind, P_END, f"figure 9({letter})", FIELDS)
    for letter, case in (("a", SOFT_1), ("b", SOFT_2)):
        name = f"paths_fig10{letter}"
        out[name] = partial(paths, name, case, f"figure 10({letter})")
    for letter, kind, pressures in (
        ("a", "inflation", (1.5, 2.0, 2.5, 3.0)),
        ("b", "deflation", (2.5, 2.0, 1.5, 1.0, 0.0)),
    ):
        for case in cc.PAPER:
            which = "" if case is SOFT_1 else f"{case.label}_"
            source = f"figure 12({letter})" if case is SOFT_1 else f"figure 12({letter}), another tube"
            for p in pressures:
                name = f"fig12{letter}_{which}p_{p:g}"
                finer = case is not SOFT_1
                out[name] = partial(profile, name, case, kind, p, source, TRACTIONS, finer)
    return out


TABLES: dict[str, Builder] = _tables()
