"""Tables of paper 1, free inflation: branches, limit points, first contact, small pole heights.

Patil, DasGupta & Eriksson, Int. J. Solids Struct. 67-68 (2015) 250-262, section 2.
"""

from __future__ import annotations

from functools import lru_cache, partial

import numpy as np
from scipy.optimize import brentq

from reference_data.solvers.core.newton import Secants
from reference_data.solvers.core.tables import DisagreementError, Table, steps
from reference_data.solvers.paper1 import cases as dc
from reference_data.solvers.paper1.collocation import rows as rc
from reference_data.solvers.paper1.collocation import states as cs
from reference_data.solvers.paper1.collocation.equations import Array, Batch, newton
from reference_data.solvers.paper1.membrane import Disk
from reference_data.solvers.paper1.shooting import rows as rs
from reference_data.solvers.paper1.shooting import states as ss
from reference_data.solvers.paper1.shooting.equations import LEVELS
from reference_data.solvers.registry import Builder

CURVE = ("p", "lam_pole", "lam1_rim", "V", "X_iso")
HIGHEST = {0.0: 3.0}  # pole height up to which a branch is followed; others: TOP
TOP = 4.0
FREE = {"contact": "none", "phase": "inflation"}
SOFT_BETAS = (1.0, 1.2, 1.5, 2.0, 3.0, 5.0, 10.0)


def top(disk: Disk) -> float:
    """Largest pole height tabulated."""
    return HIGHEST.get(disk.alpha, TOP)


def branch(name: str, disk: Disk, source: str) -> Table:
    """Free inflation over the pole height."""
    t0 = steps(0.05, top(disk), 0.05)
    a = [dc.rows_of([rs.shot_row(s, iso=True) for s in ss.rising(disk, LEVELS[i], t0)]) for i in dc.BOTH]
    b = [rc.sliding_rows(cs.joined(cs.rising(disk, cs.RESOLUTIONS[i].free, t0)), iso=True) for i in dc.BOTH]
    columns = [dc.given("t0", t0), *dc.columns(name, CURVE, a, b)]
    parameters = {"alpha": float(disk.alpha), "beta": float(disk.beta)} | FREE
    title = f"Free inflation, alpha = {disk.alpha:g}, beta = {disk.beta:g}"
    notes = "Past a limit point the branch is followed under control of the pole height."
    return dc.table(name, title, source, parameters, columns, notes=notes)


def slope(state: Batch) -> float:
    """dp/dt0, from the linearised problem."""
    held = cs.controlled(state, "t0", state.y[0][:, 0, 0, 1])
    return float(held.problem.linearised(held.y, held.scalars).response()[1][0, 0])


@lru_cache(maxsize=32)
def walk_b(disk: Disk, i: int) -> tuple[Array, list[Batch]]:
    """Free states over pole heights by collocation."""
    t0 = steps(0.1, top(disk), 0.1)
    return t0, cs.rising(disk, cs.RESOLUTIONS[i].free, t0)


def limit_b(disk: Disk, i: int) -> list[Batch]:
    """Limit points as roots of dp/dt0."""
    t0, states = walk_b(disk, i)
    rates = [slope(s) for s in states]
    out = []
    for j in np.nonzero(np.diff(np.sign(rates)))[0]:

        def at(height: float, start: Batch = states[j]) -> Batch:
            return newton(cs.controlled(start, "t0", np.array([height])))

        height = brentq(lambda h: slope(at(h)), t0[j], t0[j + 1], xtol=1e-14, rtol=1e-13)
        out.append(at(height))
    return out


def limit_a(disk: Disk, i: int) -> list[ss.Shot]:
    """Limit points as extrema of a polynomial through p at Chebyshev points around them."""
    t0 = steps(0.1, top(disk), 0.1)
    states = ss.rising(disk, LEVELS[i], t0)
    rise, out = np.diff([s.p for s in states]), []
    for j in np.nonzero(np.diff(np.sign(rise)))[0] + 1:
        points = t0[j] + 0.12 * np.cos(np.pi * (np.arange(13) + 0.5) / 13)
        near = [ss.free(states[j], "t0", float(h), Secants()) for h in points]
        fit = np.polynomial.Chebyshev.fit(points, [s.p for s in near], 12)
        roots = np.real(fit.deriv().roots())
        height = float(roots[np.argmin(np.abs(roots - t0[j]))])
        out.append(ss.free(states[j], "t0", height, Secants()))
    return out


def limit_points(name: str) -> Table:
    """First limit points of neo-Hookean membranes.

    Raises:
        DisagreementError: If the methods find other numbers of them than one per neo-Hookean
            membrane and none per Mooney-Rivlin one.
    """
    disks = [Disk(0.0, beta) for beta in SOFT_BETAS]
    a, b = ([[f(d, i) for d in disks] for i in dc.BOTH] for f in (limit_a, limit_b))
    hard = [Disk(0.1, beta) for beta in SOFT_BETAS]
    counts = {len(found) for side in (a, b) for level in side for found in level}
    none = sum(len(f(d, 1)) for d in hard for f in (limit_a, limit_b))
    if counts != {1} or none:
        raise DisagreementError(f"table {name}: {counts} limit points for alpha = 0, {none} for alpha = 0.1")
    rows_a = [dc.rows_of([rs.shot_row(found[0]) for found in level]) for level in a]
    rows_b = [dc.rows_of([rc.sliding_rows(found[0]) for found in level]) for level in b]
    least = min(slope(s) for d in hard for s in walk_b(d, 1)[1])
    columns = [dc.given("alpha", [d.alpha for d in disks]), dc.given("beta", [d.beta for d in disks])]
    columns += dc.columns(name, ("p", "t0", "lam_pole", "lam1_rim", "V"), rows_a, rows_b)
    return dc.table(
        name,
        "Limit points of free inflation",
        "figure 6(a) lies above them; section 4",
        FREE | {"t0_searched": HIGHEST[0.0], "t0_searched_alpha_0.1": TOP},
        columns,
        notes=(
            "One limit point (a maximum of p over the pole height) each. alpha = 0.1 at the same beta has "
            f"none up to t0 = {TOP:g}: the smallest dp/dt0 of them all, on steps of 0.1, is {least:.4f}."
        ),
        extra={"keys": ["alpha", "beta"]},
    )


def onset(name: str) -> Table:
    """First contact of free inflation."""
    disks = [c.disk for c in (*dc.PAPER, *dc.OFF)]
    disks += [
        Disk(alpha, beta, 50.0, height)
        for alpha in (0.0, 0.1)
        for beta in (1.0, 2.0)
        for height in (0.3, 0.6)
    ]
    disks += [Disk(alpha, 1.5) for alpha in (0.0, 0.1)]
    disks = sorted(disks, key=lambda d: (d.alpha, d.beta, d.l))
    a = [dc.rows_of([rs.shot_row(dc.onset_a(d, i)) for d in disks]) for i in dc.BOTH]
    b = [dc.rows_of([rc.sliding_rows(dc.onset_b(d, i)) for d in disks]) for i in dc.BOTH]
    keys = {c: [getattr(d, c) for d in disks] for c in ("alpha", "beta", "l")}
    columns = [dc.given(c, values) for c, values in keys.items()]
    columns += dc.columns(name, ("p", "lam_pole", "lam1_rim", "V"), a, b)
    notes = "eta(0) = l on the rising branch; the same for every substrate stiffness and kind of contact."
    return dc.table(
        name,
        "First contact with the substrate",
        "the start of contact, figure 7(b)",
        FREE,
        columns,
        notes=notes,
        extra={"keys": list(keys)},
    )


def small(name: str) -> Table:
    """Limit of p/t0^3 of unstretched membranes at vanishing pole height."""
    alphas, t0 = (0.0, 0.05, 0.1, 0.2), steps(0.05, 0.19, 0.02)

    def limit(p: Array, top: int) -> float:
        """Extrapolation of p/t0^3 in powers of t0^2."""
        square = t0[:top] ** 2
        return float(np.polynomial.polynomial.polyfit(square, p[:top] / t0[:top] ** 3, top - 1)[0])

    a = [
        [limit(np.array([s.p for s in ss.rising(Disk(al, 1.0), h, t0)]), 8) for al in alphas] for h in LEVELS
    ]
    states = [cs.joined(cs.rising(Disk(al, 1.0), cs.RESOLUTIONS[1].free, t0)) for al in alphas]
    b = [[limit(s.p, top) for s in states] for top in (7, 8)]
    about = ("P R_f/(C1 h)", "limit of p/t0^3 as t0 tends to 0")
    columns = [dc.given("alpha", alphas)]
    columns.append(dc.column(name, "p_per_t0_cubed", a, b, about))
    notes = "The ratio to 1 + alpha does not depend on alpha: shallow membranes are linearly elastic."
    return dc.table(
        name,
        "Unstretched membranes at small pole heights",
        "free inflation",
        {"beta": 1.0} | FREE,
        columns,
        notes=notes,
        extra={"extrapolation": "polynomials in t0^2 through 7 and 8 pole heights from 0.05 to 0.19"},
    )


def _tables() -> dict[str, Builder]:
    """Every table of this module."""
    out: dict[str, Builder] = {}
    for case in (*dc.PAPER, *dc.OFF):
        off = case in dc.OFF
        name = f"{'off_' if off else ''}free_{case.label}"
        out[name] = partial(branch, name, case.disk, "free inflation" + (" at other data" if off else ""))
    for name, builder in (
        ("free_limit_points", limit_points),
        ("disk_contact_onset", onset),
        ("small_t0", small),
    ):
        out[name] = partial(builder, name)
    return out


TABLES: dict[str, Builder] = _tables()
