"""Tables of paper 1, profiles and material paths of figures 3-10, and figure 7(b).

Patil, DasGupta & Eriksson, Int. J. Solids Struct. 67-68 (2015) 250-262, section 5. States in several figures
are tabulated once, under the first figure.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from reference_data.solvers.core.tables import Table, steps
from reference_data.solvers.paper1 import cases as dc
from reference_data.solvers.paper1 import text
from reference_data.solvers.paper1.cases import Case
from reference_data.solvers.paper1.collocation import rows as rc
from reference_data.solvers.paper1.collocation.equations import Array
from reference_data.solvers.paper1.shooting import rows as rs
from reference_data.solvers.registry import Builder

FIELDS = ("rho", "eta", "lam1", "lam2", "t1", "t2", "sigma")
AWAY = 2e-3  # rows nearer to the front (in X) are left out
POINTS = steps(0.1, 0.9, 0.1)  # material points whose paths are drawn

Profile = dict[str, Array]


def drawn_a(
    case: Case, kind: str, pressures: Array, i: int
) -> list[tuple[float, Callable[[Array], Profile]]]:
    """States at falling (deflation) or rising pressures by shooting: fronts and profiles."""
    beta = case.disk.beta
    if kind == "frictionless":
        shots = dc.sliding_a(case.disk, pressures, i)
        return [(beta * s.front, partial(rs.shot_profile, s)) for s in shots]
    run = dc.inflation_a(case, i)
    if kind == "deflation":
        edges = dc.deflated_a(case, pressures, i)
        return [(beta * e.patch.x, partial(rs.edge_profile, run, e)) for e in edges]
    onset, out = dc.touching(case.disk), []
    low = np.asarray(pressures)[np.asarray(pressures) < onset]
    for s in dc.sliding_a(case.disk, low, i):
        out.append((0.0, partial(rs.shot_profile, s)))
    for p in pressures[len(low) :]:
        edge = dc.edge_a(case, float(p), i)
        out.append((beta * edge.patch.x, partial(rs.edge_profile, run, edge)))
    return out


def drawn_b(
    case: Case, kind: str, pressures: Array, i: int
) -> list[tuple[float, Callable[[Array], Profile]]]:
    """The same by collocation."""
    beta = case.disk.beta
    if kind == "frictionless":
        batches = dc.sliding_b(case.disk, pressures, i)
        fronts = [beta * float(b.scalars[0, 1]) if len(b.zones) > 1 else 0.0 for b in batches]
        return [(x, partial(rc.sliding_profile, b)) for x, b in zip(fronts, batches, strict=True)]
    history = dc.inflation_b(case, i).history
    if kind == "deflation":
        x, batches = dc.deflated_b(case, pressures, i)
        return [(beta * x, partial(rc.patch_profile, b, history, x)) for b in batches]
    onset = dc.touching(case.disk)
    low = np.asarray(pressures)[np.asarray(pressures) < onset]
    out = [(0.0, partial(rc.sliding_profile, b)) for b in dc.sliding_b(case.disk, low, i)]
    for p in pressures[len(low) :]:
        x, batch = dc.edge_b(case, float(p), i)
        out.append((beta * x, partial(rc.patch_profile, batch, history, x)))
    return out


def described(case: Case, kind: str) -> dict[str, object]:
    """Parameters of a kind of state."""
    out = case.disk.parameters | {"contact": "frictionless", "phase": "inflation"}
    if kind != "frictionless":
        out |= {"contact": "adhesive", "adhesion": "locked"}
    if kind == "deflation":
        out |= {"phase": "deflation", "p_end": case.p_end}
    return out


def notes(kind: str) -> str:
    """Notes on a kind of state."""
    if kind == "frictionless":
        return text.SLIDING
    return text.LOCKED + (f" {text.DEFLATION}" if kind == "deflation" else "")


def profile(name: str, case: Case, kind: str, p: float, source: str) -> Table:
    """The profile of one state."""
    at = np.array([p])
    a, b = ([f(case, kind, at, i)[0] for i in dc.BOTH] for f in (drawn_a, drawn_b))
    front = b[-1][0]
    X = steps(0.0, 1.0, 0.01)
    X = X[np.abs(X - front) > AWAY] if front else X
    raw_a, raw_b = ([call(X) for _, call in side] for side in (a, b))
    parameters = described(case, kind) | {"p": float(p)} | ({"X_front": front} if front else {})
    if not front:
        parameters |= {"contact": "none"}
    what = {"frictionless": "frictionless contact", "inflation": "adhesive inflation"}
    where = f"p = {p:g}" if front else f"p = {p:g} (not yet in contact)"
    said = f" X_front is the contact edge; X within {AWAY:g} of it is left out." if front else ""
    return dc.table(
        name,
        f"Profile, {what.get(kind, 'adhesive deflation')}, {case.title}, {where}",
        source,
        parameters,
        [dc.given("X", X), *dc.columns(name, FIELDS, raw_a, raw_b)],
        notes=f"{notes(kind)}{said}",
        model="sliding" if kind == "frictionless" else "locked",
    )


def flat(name: str) -> Table:
    """Figure 7(a) at p = 0: the membrane as it was clamped."""
    X, disk = steps(0.0, 1.0, 0.01), dc.MR_1.disk
    one, zero = np.ones_like(X), np.zeros_like(X)
    values = {"rho": X, "eta": zero, "lam1": one, "lam2": one, "t1": zero, "t2": zero, "sigma": zero}
    return dc.table(
        name,
        f"Profile, {dc.MR_1.title}, p = 0",
        "figure 7(a)",
        disk.parameters | {"contact": "none", "phase": "inflation", "p": 0.0},
        [dc.given("X", X), *(dc.given(c, v) for c, v in values.items())],
        method="The unloaded unstretched disk.",
        grid="none",
        tolerance="exact",
        kind="exact",
    )


def paths(name: str, case: Case, kind: str, pressures: Array, source: str) -> Table:
    """Radius and height of material points over the pressure."""
    order = pressures[::-1] if kind == "deflation" else pressures
    sides = []
    for f in (drawn_a, drawn_b):
        side = []
        for i in dc.BOTH:
            found = [call(POINTS) for _, call in f(case, kind, order, i)]
            side.append(found[::-1] if kind == "deflation" else found)
        sides.append(side)
    columns = [dc.given("p", pressures)]
    for j, X in enumerate(POINTS):
        for c in ("rho", "eta"):
            raw = [[np.array([one[c][j] for one in level]) for level in side] for side in sides]
            scaling, meaning = text.COLUMNS[c]
            columns.append(dc.column(name, f"{c}_{X:g}", *raw, (scaling, f"{meaning} of X = {X:g}")))
    return dc.table(
        name,
        f"Paths of material points, {kind}, {case.title}",
        source,
        described(case, kind),
        columns,
        notes=notes(kind),
        model="sliding" if kind == "frictionless" else "locked",
    )


def equal_stretches(name: str) -> Table:
    """Figure 7(b): the radius up to which lambda1 = lambda2 within 1e-4."""
    case, onset = dc.MR_1, dc.touching(dc.MR_1.disk)
    near = [0.01, 0.02, 0.05, *np.round(onset + np.array([-0.02, -0.01, 0.01, 0.02, 0.04, 0.06]), 3)]
    p = np.unique(np.round(np.concatenate([near, steps(0.1, 7.0, 0.1)]), 10))
    a = [dc.rows_of([rs.shot_row(s, iso=True) for s in dc.sliding_a(case.disk, p, i)]) for i in dc.BOTH]
    b = []
    for i in dc.BOTH:
        states = dc.sliding_b(case.disk, p, i)
        b.append(dc.rows_of([rc.sliding_rows(s, iso=True) for s in states]))
    return dc.table(
        name,
        f"Zone of equal stretches, frictionless contact, {case.title}",
        "figure 7(b)",
        described(case, "frictionless") | {"p_contact": onset, "tolerance": rc.TOLERANCE},
        [dc.given("p", p), *dc.columns(name, ("X_iso", "t0"), a, b)],
        notes="First X where |lambda1 - lambda2| reaches the tolerance; free inflation below p_contact.",
    )


FIGURES: tuple[tuple[str, str, Case, str, tuple[float, ...]], ...] = (
    ("fig03a", "figure 3(a)", dc.MR_1, "frictionless", (0.409, 1.659, 4.83, 7.10)),
    ("fig03b", "figure 3(b)", dc.MR_2, "frictionless", (2.66, 4.49, 6.81, 8.63)),
    ("fig04a", "figure 4(a)", dc.MR_1, "inflation", (0.408, 2.094, 2.833, 3.477)),
    ("fig04b", "figure 4(b)", dc.MR_2, "inflation", (6.16, 8.49)),
    ("fig05a", "figures 5(a), 9 and 10(c)", dc.MR_1, "deflation", (0.6, 1.4, 2.4, 3.2)),
    ("fig05b", "figure 5(b)", dc.MR_2, "deflation", (0.2, 2.2, 4.2, 6.43)),
    ("fig07a", "figure 7(a)", dc.MR_1, "frictionless", (1.64, 4.82, 5.95)),
    ("fig08", "figure 8", dc.MR_1, "inflation", (0.95, 2.83, 3.26, 3.47)),
    ("fig10a", "figure 10(a)", dc.MR_1, "frictionless", (2.79, 3.74, 5.281, 5.963)),
    ("fig10b", "figure 10(b)", dc.MR_1, "inflation", (2.591, 2.887, 3.059, 3.238, 3.726)),
    ("fig10c", "figure 10(c)", dc.MR_1, "deflation", (0.4, 1.0, 2.8)),
)
"""Figure 4(b) shows at p = 2.66 and 4.49 the free states of figure 3(b), 10(a) at 4.83 the state of 3(a)."""

EQUAL = (("fig06a", 4.0, (dc.NH_1, dc.NH_2)), ("fig06b", 6.0, (dc.MR_1, dc.MR_2)))
"""Figure 6: frictionless and adhesive contact at equal pressures."""


def _tables() -> dict[str, Builder]:
    """Every table of this module."""
    out: dict[str, Builder] = {"fig07a_p_0": partial(flat, "fig07a_p_0")}
    for head, source, case, kind, pressures in FIGURES:
        for p in pressures:
            out[f"{head}_p_{p:g}"] = partial(profile, f"{head}_p_{p:g}", case, kind, p, source)
    for head, p, cases in EQUAL:
        for case in cases:
            for word, kind in (("frictionless", "frictionless"), ("adhesive", "inflation")):
                name = f"{head}_{word}_beta_{case.disk.beta:g}"
                source = f"figure {head[4]}({head[5]})"
                far = Case(case.disk, 0.61, case.p_end) if head == "fig06b" and case is dc.MR_1 else case
                out[name] = partial(profile, name, far, kind, p, source)
    for head, kind, cases, stops in (
        ("fig03", "frictionless", (dc.MR_1, dc.MR_2), (7.2, 8.6)),
        ("fig04", "inflation", (dc.MR_1, dc.MR_2), (3.4, 8.4)),
        ("fig05", "deflation", (dc.MR_1, dc.MR_2), (3.477, 8.49)),
    ):
        for letter, case, stop in zip("ab", cases, stops, strict=True):
            name, source = f"paths_{head}{letter}", f"figure {head[4]}({letter})"
            pressures = steps(0.2, np.floor(stop * 5 + 1e-9) / 5, 0.2)
            if kind == "deflation":
                pressures = np.append(pressures, case.p_end)
            out[name] = partial(paths, name, case, kind, pressures, source)
    out["fig07b_iso"] = partial(equal_stretches, "fig07b_iso")
    return out


TABLES: dict[str, Builder] = _tables()
