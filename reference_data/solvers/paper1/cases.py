"""Shared by the tables of paper 1: cases, their states by both methods (computed once), columns."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from scipy.optimize import brentq

from reference_data.solvers.core.newton import Secants
from reference_data.solvers.core.tables import Column, Estimate, Levels, Table, agreed, prescribed
from reference_data.solvers.paper1 import text
from reference_data.solvers.paper1.collocation import history as ch
from reference_data.solvers.paper1.collocation import radial as cr
from reference_data.solvers.paper1.collocation import states as cs
from reference_data.solvers.paper1.collocation.equations import Array, Batch
from reference_data.solvers.paper1.membrane import Disk, toward
from reference_data.solvers.paper1.shooting import history as sh
from reference_data.solvers.paper1.shooting import radial as sr
from reference_data.solvers.paper1.shooting import states as ss
from reference_data.solvers.paper1.shooting.equations import LEVELS
from reference_data.solvers.paper2.collocation.critical import ROUNDING

BOTH = (0, 1)  # coarse and fine
FLOOR = 1e-12  # relative; remaining error of Newton's method in shooting, and rounding elsewhere
STEP = 0.1  # of p, in deflation


@dataclass(frozen=True)
class Case:
    """A membrane, the end of its patch, and the start of deflation.

    Attributes:
        disk: The membrane and its substrate.
        reach: Largest front position X = beta x* of adhesive inflation.
        p_end: Pressure at which deflation starts.
    """

    disk: Disk
    reach: float
    p_end: float

    @property
    def label(self) -> str:
        """Part of a table's name."""
        return f"alpha_{self.disk.alpha:g}_beta_{self.disk.beta:g}"

    @property
    def long_label(self) -> str:
        """The same with k and l."""
        return f"{self.label}_k_{self.disk.k:g}_l_{self.disk.l:g}"

    @property
    def title(self) -> str:
        """Description of the case for headings."""
        return ", ".join(f"{name} = {value:g}" for name, value in self.disk.parameters.items())


MR_1, MR_2 = Case(Disk(0.1, 1.0), 0.51, 3.477), Case(Disk(0.1, 2.0), 0.56, 8.49)
NH_1, NH_2 = Case(Disk(0.0, 1.0), 0.51, 3.477), Case(Disk(0.0, 2.0), 0.54, 5.0)
STIFF = Case(Disk(0.1, 1.0, 100.0), 0.51, 3.477)
PAPER = (NH_1, NH_2, MR_1, MR_2)
OFF = (
    Case(Disk(0.0, 1.6, 120.0, 0.45), 0.5, 4.5),
    Case(Disk(0.05, 1.2, 80.0, 0.6), 0.43, 5.0),
    Case(Disk(0.05, 1.25, 200.0, 0.3), 0.45, 2.5),
    Case(Disk(0.15, 1.0, 60.0, 0.35), 0.51, 2.0),
    Case(Disk(0.2, 1.5, 30.0, 0.4), 0.56, 6.0),
)


@lru_cache(maxsize=64)
def onset_a(disk: Disk, i: int) -> ss.Shot:
    """Free state at first touch by shooting."""
    return ss.rising(disk, LEVELS[i], np.array([disk.l]))[0]


@lru_cache(maxsize=64)
def onset_b(disk: Disk, i: int) -> Batch:
    """Free state at first touch by collocation."""
    return cs.rising(disk, cs.RESOLUTIONS[i].free, np.array([disk.l]))[0]


def touching(disk: Disk) -> float:
    """Pressure of first contact."""
    return float(onset_b(disk, 1).p[0])


@lru_cache(maxsize=16)
def inflation_a(case: Case, i: int) -> sh.Inflation:
    """Adhesive inflation by shooting."""
    return sh.Inflation(onset_a(case.disk, i), case.reach / case.disk.beta)


@lru_cache(maxsize=16)
def inflation_b(case: Case, i: int) -> ch.Inflation:
    """Adhesive inflation by collocation."""
    return ch.Inflation(case.disk, cs.RESOLUTIONS[i], onset_b(case.disk, i), case.reach / case.disk.beta)


@lru_cache(maxsize=8)
def radial_a(case: Case, i: int) -> sr.Radial:
    """Model N by shooting."""
    return sr.Radial(onset_a(case.disk, i), case.reach / case.disk.beta)


@lru_cache(maxsize=8)
def radial_b(case: Case, i: int) -> cr.Radial:
    """Model N by collocation."""
    return cr.Radial(case.disk, cs.RESOLUTIONS[i], onset_b(case.disk, i), case.reach / case.disk.beta)


def _front(case: Case, pressure: Any, p: float) -> float:
    x = case.reach / case.disk.beta
    if pressure(x) < p or p <= touching(case.disk):
        raise ValueError(f"adhesive inflation of {case} does not reach p = {p:g} at X <= {case.reach:g}")
    return brentq(lambda s: pressure(s) - p, 1e-2 * x, x, xtol=1e-15, rtol=1e-14)


@lru_cache(maxsize=256)
def edge_a(case: Case, p: float, i: int) -> sh.Edge:
    """Adhesive inflation at p by shooting."""
    run = inflation_a(case, i)
    return run.at(_front(case, lambda x: run.at(x).p, p))


@lru_cache(maxsize=256)
def edge_b(case: Case, p: float, i: int) -> tuple[float, Batch]:
    """Front and state of adhesive inflation at p by collocation."""
    run = inflation_b(case, i)
    x = _front(case, lambda s: float(run.at(s).p[0]), p)
    return x, run.at(x)


def deflated_a(case: Case, pressures: Array, i: int) -> list[sh.Edge]:
    """Deflation from p_end at falling pressures by shooting."""
    edge, newton, out = edge_a(case, case.p_end, i), Secants(), []
    for p in map(float, pressures):
        while edge.p != p:
            edge = sh.deflated(edge, toward(edge.p, p, STEP), newton)
        out.append(edge)
    return out


def deflated_b(case: Case, pressures: Array, i: int) -> tuple[float, list[Batch]]:
    """Front, and states of deflation from p_end at falling pressures by collocation."""
    run = inflation_b(case, i)
    x, start = edge_b(case, case.p_end, i)
    patch = run.history.patch(np.array([x]))

    def problem(guess: Batch, p: float) -> Batch:
        return ch.outer(case.disk, run.how.outer, patch, guess, np.array([p]))

    at_p = ch.outer(case.disk, run.how.outer, patch, start, start.p)
    return x, cs.continued(at_p, float(start.p[0]), pressures, problem, lambda _: STEP)


def sliding_a(disk: Disk, pressures: Array, i: int) -> list[ss.Shot]:
    """Frictionless states at rising pressures, free ones below first touch, by shooting."""
    p, onset = np.asarray(pressures, dtype=float), onset_a(disk, i)
    low, high = p[p < touching(disk)], p[p > touching(disk)]
    out: list[ss.Shot] = []
    if len(low):
        climb = ss.rising(disk, LEVELS[i], np.arange(1, round(disk.l / 0.05) + 1) * 0.05)
        heights = [s.p for s in climb]
        for target in low:
            near = climb[int(np.argmin(np.abs(np.log(np.array(heights) / target))))]
            out.append(ss.free(near, "p", float(target), Secants()))
    return out + (ss.walk(onset, high) if len(high) else [])


def sliding_b(disk: Disk, pressures: Array, i: int) -> list[Batch]:
    """The same by collocation."""
    p, onset, how = np.asarray(pressures, dtype=float), onset_b(disk, i), cs.RESOLUTIONS[i]
    low, high = p[p < touching(disk)], p[p > touching(disk)]
    out: list[Batch] = []
    if len(low):
        climb = cs.rising(disk, how.free, np.arange(1, round(disk.l / 0.05) + 1) * 0.05)
        heights = np.array([s.p[0] for s in climb])
        for target in low:
            near = climb[int(np.argmin(np.abs(np.log(heights / target))))]
            out.append(cs.newton(cs.controlled(near, "p", np.array([target]))))
    return out + (cs.frictionless(disk, how, onset, high) if len(high) else [])


def rows_of(parts: list[dict[str, Any]]) -> dict[str, Array]:
    """Columns from the rows of single states."""
    return {c: np.array([np.ravel(part[c])[0] for part in parts]) for c in parts[0]}


def levels(coarse: Array, fine: Array) -> Estimate:
    """Values of shooting: the finer ones, with the largest change of the column as uncertainty."""
    coarse, fine = np.asarray(coarse, dtype=float), np.asarray(fine, dtype=float)
    change = float(np.max(np.abs(fine - coarse)))
    return Estimate(fine, change + FLOOR * np.maximum(1.0, np.abs(fine)))


def column(table: str, name: str, a: list[Array], b: list[Array], about: tuple[str, str]) -> Column:
    """A column from two levels of shooting (a) and two resolutions of collocation (b)."""
    # FLOOR: possible changes on another machine, by the order of sums
    return agreed(table, name, levels(*a), Levels(*b, rounding=ROUNDING + FLOOR), about, other="shooting")


def columns(
    table: str, wanted: tuple[str, ...], a: list[dict[str, Array]], b: list[dict[str, Array]]
) -> list[Column]:
    """Columns of the two levels and the two resolutions."""
    return [column(table, c, [r[c] for r in a], [r[c] for r in b], text.COLUMNS[c]) for c in wanted]


def given(name: str, values: Any) -> Column:
    """A prescribed column of a table."""
    return prescribed(name, values, text.COLUMNS[name])


def table(*given: Any, model: str = "sliding", **more: Any) -> Table:
    """A table of paper 1 about a model of contact, from name, title, source, parameters and columns."""
    return text.SERIES[model].table(*given, **more)
