"""Further tables of paper 2 on contact: Table 1, and the paper's method on a contact state."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from reference_data.solvers.core import collocation as free
from reference_data.solvers.core.tables import Array, Column, DisagreementError, Table, prescribed, round_up
from reference_data.solvers.paper2 import contact_cases as cc
from reference_data.solvers.paper2 import ftim
from reference_data.solvers.paper2.collocation import contact as con
from reference_data.solvers.paper2.collocation import states as st
from reference_data.solvers.paper2.collocation.contact import State, Zone
from reference_data.solvers.paper2.differences.equations import Grid
from reference_data.solvers.paper2.tables_checks import ftim_table
from reference_data.solvers.registry import Builder

FIELDS = ("rho", "eta", "lam1", "lam2", "t1", "t2")
HIGHEST = 3  # derivatives of order 0 .. 3 are compared
NONE = HIGHEST + 1
JUMP = 5e-3  # relative; actual jumps are larger, and others are much smaller
PRINTED = {1: None, 2: 2, 3: 1, 4: 0}  # C^i of rho, eta, lam2; lam1, t1, t2 are C^(i-1)
CASE = cc.PAPER[2]


def derivatives(state: State, zone: int, element: int) -> dict[str, Array]:
    """Derivatives by z, orders 0 .. HIGHEST, at the nodes of one element, shape (order, node)."""
    mesh = state.zones[zone].mesh
    left, right = con.bounds(state, state.scalars)[zone]
    z = con.places(mesh, left, right)[0][element]
    values = state.y[zone][element]
    if state.zones[zone].stuck:
        e = state.history.slope(z)
        rho, a = values.T
        values = np.stack([rho, state.history.position(z), np.hypot(a, e), np.arctan2(a, e)], axis=-1)
    d = free.differentiation(mesh.nodes) / (mesh.widths[element] * (right - left))
    out = {}
    for name, f in st.columns(state.tube, values).items():
        rows = [f]
        for _ in range(HIGHEST):
            rows.append(d @ rows[-1])
        out[name] = np.array(rows)
    return out


def relative_jumps(state: State, zone: int) -> dict[str, Array]:
    """Jump of each derivative at the right end of a zone over the larger of its two values there."""
    inside, outside = derivatives(state, zone, -1), derivatives(state, zone + 1, 0)
    out = {}
    for name in FIELDS:
        a, b = inside[name], outside[name]
        out[name] = np.abs(a[:, -1] - b[:, 0]) / np.maximum(np.abs(a[:, -1]), np.abs(b[:, 0]))
    return out


def examined(which: int) -> list[State]:
    """The four kinds of state at the resolutions: 1 free, 2 frictionless, 3 and 4 adhesive."""
    if which == 1:  # an arbitrary point of a free tube instead of the front
        out = []
        for (first, _), how in zip(cc.touching(CASE), st.RESOLUTIONS, strict=True):
            guess = st.frictionless_near_touch(first, CASE.substrate, how, 0.7 * CASE.tube.length)
            guess = replace(guess, zones=(Zone(how.inner), Zone(how.outer)))
            fixed = [("scalar", 0, first.p), ("scalar", 1, 0.7 * CASE.tube.length)]
            out.append(con.newton(guess, fixed)[0])
        return out
    if which == 2:
        return [systems[0].state for systems in cc.frictionless(CASE, np.array([2.5]))]
    if which == 3:
        return list(cc.adhesive(CASE, 2.5))
    return [systems[-1].state for systems in cc.deflated(CASE, "bilateral", np.array([2.5, 2.0]))]


def first_jump(jumps: Array) -> int:
    """Order of the first derivative that jumps."""
    found = np.nonzero(jumps > JUMP)[0]
    return int(found[0]) if len(found) else NONE


def continuity(name: str) -> Table:
    """Table 1: order of the first derivative that jumps at the front.

    Raises:
        DisagreementError: If the two resolutions differ in an order.
    """
    rows = []
    for which, smooth in PRINTED.items():
        coarse, fine = (relative_jumps(s, 0) for s in examined(which))
        for i, f in enumerate(FIELDS, 1):
            order = first_jump(fine[f])
            if first_jump(coarse[f]) != order:
                raise DisagreementError(f"table {name}: order of {f}, kind {which}, depends on the mesh")
            ratio = [j[f][order] if order < NONE else 0.0 for j in (coarse, fine)]
            below = max(float(j[f][:order].max(initial=0.0)) for j in (coarse, fine))
            said = NONE if smooth is None else smooth + (f in ("rho", "eta", "lam2"))
            rows.append((which, i, order, said, ratio[1], below, abs(ratio[1] - ratio[0])))
    data = np.array(rows).T
    about: dict[str, tuple[str, str]] = {
        "kind": ("1", "1 free (at an arbitrary point), 2 frictionless, 3 adhesive inflation, 4 deflation"),
        "field": ("1", "1 rho, 2 eta, 3 lam1, 4 lam2, 5 t1, 6 t2"),
        "first_jump": ("1", f"order of the first derivative by z that jumps; {NONE}: none up to {HIGHEST}"),
        "printed": ("1", "the same by the printed table"),
        "jump": ("1", "that jump over the larger of the two one-sided values; 0 if there is none"),
        "below": ("1", "largest such ratio of all lower orders: rounding amplified by differentiation"),
    }
    columns = [prescribed(c, v, about[c]) for c, v in zip(list(about)[:4], data[:4], strict=True)]
    columns.append(Column("jump", data[4], round_up(float(data[6].max()) + 1e-6), *about["jump"]))
    columns.append(Column("below", data[5], round_up(float(data[5].max())), *about["below"]))
    return cc.table(
        name,
        f"Orders of continuity at the contact front, {CASE.title}",
        "table 1",
        "adhesive",
        CASE.parameters | {"p_inflation": 2.5, "p_deflation": 2.0, "threshold": JUMP},
        columns,
        method=(
            "One-sided derivatives of the collocation polynomials of the elements that meet at the front, "
            "on two meshes; frictionless and adhesive inflation at p_inflation, deflation (bilateral "
            "spring, after p = 3) at p_deflation, free inflation at first touch."
        ),
        extra={"keys": ["kind", "field"]},
        notes="lam1, t1 and t2 in frictionless contact are smoother than printed: w - lambda1 w_1 = const.",
    )


def ftim_contact_state(name: str) -> Table:
    """A frictionless contact state by fictitious time integration."""
    tube, substrate, p, grid, height = CASE.tube, CASE.substrate, 2.0, Grid(20), 0.34

    def pressure(rho: Any, p: Any) -> Any:
        return np.where(np.real(rho) > substrate.s, substrate.push(rho, p), p + 0 * rho)

    root = float(ftim.newton_state(tube, grid, p, pressure, height)[0]) - 1
    solved = [ftim.solve(tube, grid, p, v, pressure=pressure, height=height) for v in (1, 2, 3)]
    title = "Fictitious time integration of one state in frictionless contact"
    about = CASE.parameters | {"contact": "frictionless", "phase": "inflation", "p": p, "guess": height}
    return ftim_table(name, title, about, grid, root, solved)


TABLES: dict[str, Builder] = {
    "table1_continuity": lambda: continuity("table1_continuity"),
    "ftim_contact_state": lambda: ftim_contact_state("ftim_contact_state"),
}
