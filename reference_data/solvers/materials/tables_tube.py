"""Tables of the tube with laws other than Mooney-Rivlin, by the papers' reference codes.

The codes of paper 2 are used with another law (``core.laws``).
"""

from __future__ import annotations

from functools import partial

import numpy as np

from reference_data.solvers.core.laws import CONSTANTS, law
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.core.tables import Array, Column, Estimate, Table, agreed, steps
from reference_data.solvers.paper2 import text
from reference_data.solvers.paper2.collocation import critical as col
from reference_data.solvers.paper2.differences import branch as fdb
from reference_data.solvers.registry import Builder

MODELS = ("ogden", "gent", "arruda_boyce")
LF = 6.0
U_STOP = 4.5
NEAR = {"ogden": (0.838, 4.293), "gent": (0.857, 3.645), "arruda_boyce": (0.848, 3.61)}
"""Displacements at the centres of the windows in which limit points are searched."""
WINDOW, NODES = 0.12, 12


def make(name: str, title: str, model: str, columns: list[Column], notes: str) -> Table:
    """A table with the documentation common to all of them."""
    facts = {"model": model, **CONSTANTS[model], "delta1": 1.0, "lf": LF}
    return text.SERIES.table(name, title, "section 2", facts, columns, paper="materials", notes=notes)


def tube_curve(name: str, model: str) -> Table:
    """Free inflation of a tube over its mid-plane displacement."""
    tube = Tube(law(model), 1.0, LF)
    targets = steps(0.05, U_STOP, 0.05)
    a, b = fdb.curve(tube, "u_max", targets), col.curve(tube, "u_max", targets)
    columns = text.SERIES.keys(u_max=targets)
    columns += [agreed(name, c, a[c], b[c], text.COLUMNS[c]) for c in ("p", "lam1_mid", "t1_mid", "V")]
    return make(name, f"Free inflation of a tube of {model}", model, columns, "")


def tube_limits(name: str, model: str) -> Table:
    """Limit points of a tube: maxima and minima of polynomials through states at Chebyshev nodes."""
    tube = Tube(law(model), 1.0, LF)
    nodes = np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)[::-1]
    found: dict[str, list[Estimate]] = {"a": [], "b": []}
    for centre in NEAR[model]:
        window = centre + WINDOW * nodes
        targets = np.concatenate([steps(0.05, window[0] - 0.02, 0.05), window])
        a, b = fdb.curve(tube, "u_max", targets), col.curve(tube, "u_max", targets)
        for key, value in (("a", a["p"]), ("b", b["p"])):
            p, spread = value.value[-NODES:], float(np.max(value.uncertainty[-NODES:]))
            found[key].append(_turn(window, p, spread, centre))
    columns = text.SERIES.keys(order=np.arange(1, len(NEAR[model]) + 1))
    for i, c in enumerate(("p", "u_max")):
        a, b = (
            Estimate(np.array([r.value[i] for r in found[k]]), np.array([r.uncertainty[i] for r in found[k]]))
            for k in ("a", "b")
        )
        columns.append(agreed(name, c, a, b, text.COLUMNS[c]))
    notes = "dp/du_max = 0 of a polynomial of degree 11 through p at Chebyshev nodes, both methods."
    title = f"Limit points of a tube of {model}"
    return make(name, title, model, columns, notes)


def _turn(u: Array, p: Array, spread: float, centre: float) -> Estimate:
    """``(p, u)`` at an extremum of a polynomial, and the effect of an error ``spread`` of ``p`` on it."""
    fit = np.polynomial.Chebyshev.fit(u, p, NODES - 1, domain=[centre - WINDOW, centre + WINDOW])
    roots = [r.real for r in fit.deriv().roots() if abs(r.imag) < 1e-9 and abs(r.real - centre) < WINDOW]
    if len(roots) != 1:
        raise RuntimeError(f"{len(roots)} limit points near u_max = {centre:g}")
    at = roots[0]
    # A polynomial of size e and degree n on a window of half width h has slopes up to n^2 e/h.
    slope = NODES**2 * spread / WINDOW
    return Estimate(np.array([fit(at), at]), np.array([2 * spread, slope / abs(fit.deriv(2)(at))]))


TABLES: dict[str, Builder] = {}
for _m in MODELS:
    TABLES[f"tube_{_m}"] = partial(tube_curve, f"tube_{_m}", _m)
    TABLES[f"tube_limits_{_m}"] = partial(tube_limits, f"tube_limits_{_m}", _m)
