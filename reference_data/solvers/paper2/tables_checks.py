"""Further tables of paper 2: the long tube and the paper's solution method."""

from __future__ import annotations

import numpy as np

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.core.tables import (
    Column,
    Table,
    agreed,
    last_digit,
    prescribed,
    round_up,
    steps,
)
from reference_data.solvers.paper2 import ftim, text
from reference_data.solvers.paper2.collocation import critical as col
from reference_data.solvers.paper2.common import given
from reference_data.solvers.paper2.differences import branch as fdb
from reference_data.solvers.paper2.differences.equations import Grid
from reference_data.solvers.registry import Builder

LONG = Tube(0.1, 1.5, 40.0)
LONG_U = steps(0.05, 0.8, 0.05)  # well before the first limit point, where the bulge localises
FORMULA = "p = 2 (1 - 1/(delta1^2 lambda2^4)) (1 + alpha delta1^2)/delta1^(3/2)"


def uniform_pressure(tube: Tube, lam1: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Pressure of a uniform cylinder, p = w_2/(r0 lambda1 lambda2)."""
    lam2 = (1 + u) / tube.r0
    return mat.slope(lam2, lam1, tube.alpha) / (tube.r0 * lam1 * lam2)


def long_exact(name: str) -> Table:
    """The infinitely long tube: lambda1 = delta1 at the mid-plane, in closed form."""
    p = uniform_pressure(LONG, np.full(len(LONG_U), LONG.delta1), LONG_U)
    columns = text.SERIES.keys(u_max=LONG_U)
    columns.append(Column("p", p, round_up(last_digit(p)), *text.COLUMNS["p"]))
    parameters = {"alpha": LONG.alpha, "delta1": LONG.delta1}
    return text.SERIES.table(
        name,
        "Uniform inflation of an infinitely long tube",
        "the limit of the boundary value problem for lf to infinity before bulging",
        parameters,
        columns,
        kind="exact",
        method=f"Closed form: {FORMULA}, lambda2 = (1 + u_max)/sqrt(delta1).",
        grid="none",
        tolerance="rounding",
    )


def long_computed(name: str) -> Table:
    """A tube of length 40 against the closed form."""
    a, b = fdb.curve(LONG, "u_max", LONG_U), col.curve(LONG, "u_max", LONG_U)
    columns = text.SERIES.keys(u_max=LONG_U)
    columns += [agreed(name, c, a[c], b[c], text.COLUMNS[c]) for c in ("p", "lam1_mid", "V")]
    infinite = uniform_pressure(LONG, np.full(len(LONG_U), LONG.delta1), LONG_U)
    p, lam1 = b["p"].value, b["lam1_mid"].value
    away = float(np.max(np.abs(p / infinite - 1)))
    inserted = float(np.max(np.abs(p - uniform_pressure(LONG, lam1, LONG_U))))
    notes = (
        f"Largest relative difference of p to the closed form with lambda1 = delta1: {away:.1e}; "
        f"largest difference to p = w_2/(r0 lambda1 lambda2) with the computed lambda1: "
        f"{inserted:.1e}."
    )
    title = "Free inflation of a long tube, lf = 40"
    source = "the problem of figure 2 at other data"
    return text.SERIES.table(name, title, source, given(LONG), columns, notes=notes)


FTIM_NOTES = (
    "u_max of a row with converged = 0 is where 5000 steps lead, not a solution; its "
    "uncertainty is that of the converged rows. The tangent of variant 3 is that of the "
    "first guess. seconds is machine-dependent."
)


def ftim_state(name: str) -> Table:
    """One state by fictitious time integration, in three variants, against Newton."""
    tube, p, grid = Tube(0.1, 1.0, 6.0), 1.5, Grid(20)
    root = float(ftim.newton_state(tube, grid, p)[0]) - 1
    solved = [ftim.solve(tube, grid, p, v) for v in (1, 2, 3)]
    title = "Fictitious time integration of one state of free inflation"
    return ftim_table(name, title, given(tube) | {"p": p}, grid, root, solved)


def ftim_table(
    name: str,
    title: str,
    parameters: dict[str, object],
    grid: Grid,
    root: float,
    solved: list[tuple[ftim.Run, float]],
) -> Table:
    """The three variants of fictitious time integration against the Newton root.

    Raises:
        RuntimeError: If other variants than 2 and 3 converge, or not to the root.
    """
    runs, gains = zip(*solved, strict=True)
    u = np.array([run.state[0] - 1 for run in runs])
    done = np.array([run.converged for run in runs])
    if not np.array_equal(done, [False, True, True]):
        raise RuntimeError(f"table {name}: variants converged: {done}")
    if (error := float(np.max(np.abs(u[done] - root)))) > 1e-9:
        raise RuntimeError(f"table {name}: FTIM and Newton differ by {error:.1e}")
    counts = {
        "variant": ((1, 2, 3), "1: as published; 2: constant gain, m = 0; 3: frozen tangent"),
        "converged": (done, "1 if the residual fell below 1e-10"),
        "steps": ([r.steps for r in runs], "Runge-Kutta steps"),
        "rhs_evaluations": ([r.evaluations for r in runs], "evaluations of the residual"),
        "gain": (gains, "factor c of the residual (3: of the solved residual)"),
    }
    columns = [prescribed(c, np.array(v, float), ("1", m)) for c, (v, m) in counts.items()]
    columns += [
        Column("u_max", u, round_up(error + last_digit(u)), *text.COLUMNS["u_max"]),
        Column(
            "u_max_newton",
            np.full(len(u), root),
            round_up(last_digit(np.array([root])) + 1e-14 * grid.n),
            "(R_mid - R_f)/R_f",
            "root of the same difference equations by Newton's method",
        ),
    ]
    return text.SERIES.table(
        name,
        title,
        "the solution method of the paper (fictitious time, nu = 0.02, step 0.001)",
        parameters | {"nu": ftim.NU, "step": ftim.STEP},
        columns,
        method="x' = nu/(1 + tau)^m B F(x), classical Runge-Kutta; F: central differences.",
        grid=f"{grid.n} cells: the discretisation error is common to all rows, and not included",
        tolerance="residual below 1e-10",
        notes=FTIM_NOTES,
        extra={"seconds": [round(r.seconds, 3) for r in runs]},
    )


TABLES: dict[str, Builder] = {
    "long_tube": lambda: long_exact("long_tube"),
    "long_tube_lf_40": lambda: long_computed("long_tube_lf_40"),
    "ftim_state": lambda: ftim_state("ftim_state"),
}
