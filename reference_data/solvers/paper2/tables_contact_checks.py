"""Further tables of paper 2 on contact: Table 1, and the paper's method on a contact state."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from reference_data.solvers.core import continuity as con
from reference_data.solvers.core.collocation import differentiation
from reference_data.solvers.core.tables import Array, Table
from reference_data.solvers.paper2 import contact_cases as cc
from reference_data.solvers.paper2 import ftim
from reference_data.solvers.paper2.collocation import states as st
from reference_data.solvers.paper2.collocation.equations import State, Zone, columns, places, solve
from reference_data.solvers.paper2.differences.equations import Grid
from reference_data.solvers.paper2.tables_checks import ftim_table
from reference_data.solvers.registry import Builder

PRINTED = {1: None, 2: 2, 3: 1, 4: 0}  # C^i of rho, eta, lam2; lam1, t1, t2 are C^(i-1)
CASE = cc.PAPER[2]


def derivatives(state: State, zone: int, element: int) -> dict[str, Array]:
    """Derivatives by z at the front's side of one element at the front, by field."""
    mesh, values = state.zones[zone].mesh, state.y[zone][element]
    left, right = state.bounds[zone]
    z = places(mesh, left, right)[element]
    if state.zones[zone].stuck:
        e, (rho, a, _) = state.history.slope(z), values.T
        values = np.stack([rho, state.history.position(z), np.hypot(a, e), np.arctan2(a, e)], axis=-1)
    d = differentiation(mesh.rule.nodes) / (mesh.widths[element] * (right - left))
    return {c: con.derivatives(d, f)[:, element] for c, f in columns(state.tube, values).items()}


def relative_jumps(state: State, zone: int = 0) -> dict[str, Array]:
    """Jump of each derivative at the right end of a zone over the larger of its two values there."""
    return con.relative(derivatives(state, zone, -1), derivatives(state, zone + 1, 0))


def examined(which: int) -> list[State]:
    """The four kinds of state at the resolutions: 1 free, 2 frictionless, 3 and 4 adhesive."""
    if which == 1:  # an arbitrary point of a free tube instead of the front
        out, z = [], 0.7 * CASE.tube.length
        for first, how in zip(cc.touching(CASE), st.RESOLUTIONS, strict=True):
            guess = st.frictionless_near_touch(first, how, z)
            out.append(solve(replace(guess, zones=(Zone(how.inner), Zone(how.outer))), p=first.p, front=z))
        return out
    if which == 2:
        return [states[0] for states in cc.frictionless(CASE, np.array([2.5]))]
    if which == 3:
        return list(cc.adhesive(CASE, 2.5))
    return [states[-1] for states in cc.deflated(CASE, "bilateral", np.array([2.5, 2.0]))]


def said(which: int, field: str) -> int:
    """The order that the paper's table implies."""
    smooth = PRINTED[which]
    return con.NONE if smooth is None else smooth + (field in ("rho", "eta", "lam2"))


def continuity(name: str) -> Table:
    """Table 1: order of the first derivative that jumps at the front."""
    kinds = {which: lambda which=which: tuple(map(relative_jumps, examined(which))) for which in PRINTED}
    about = "1 free (at an arbitrary point), 2 frictionless, 3 adhesive inflation, 4 deflation"
    return cc.table(
        "adhesive",
        name,
        f"Orders of continuity at the contact front, {CASE.title}",
        "table 1",
        CASE.parameters | {"p_inflation": 2.5, "p_deflation": 2.0, "threshold": con.JUMP},
        con.columns(name, kinds, "z", about, said),
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
    name: partial(build, name)
    for name, build in (("table1_continuity", continuity), ("ftim_contact_state", ftim_contact_state))
}
