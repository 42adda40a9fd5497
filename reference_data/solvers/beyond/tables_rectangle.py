"""Tables of framed square sheets under gas and liquid: states over the height of the centre, limit loads."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import cache, partial

import numpy as np
from numpy.polynomial.chebyshev import Chebyshev

from reference_data.solvers.beyond.collocated_sheet import CollocatedSheet
from reference_data.solvers.beyond.framed_sheet import (
    CLASSES,
    Array,
    Found,
    Framed,
    Kirchhoff,
    follow,
    limit,
    solve,
)
from reference_data.solvers.beyond.ritz_sheet import RitzSheet
from reference_data.solvers.core.tables import (
    TWO_GRIDS,
    Column,
    Levels,
    Series,
    Table,
    agreed,
    rule,
    steps,
)
from reference_data.solvers.registry import Builder

DEGREES, HALVES = (20, 28), (12, 18)
"""Coarse and fine resolution of Galerkin's method and of collocation."""

FIRST = 0.05
"""Height of the centre from which states are followed."""

SERIES = Series(
    paper="beyond",
    source="Patil (2016), section 6.4, future work",
    columns={
        "order": ("1", "number of the limit load along the branch"),
        "w_c": ("1/a", "height of the centre, down for a liquid; a is half the side"),
        "p": ("P a/(C1 h)", "pressure of the gas from below"),
        "zw": ("1/a", "level of the liquid on top, above the frame"),
        "V": ("1/a^3", "volume between the sheet and the plane of the frame"),
        "V_f": ("1/a^3", "liquid over the sheet between vertical walls"),
        "U": ("1/(C1 h a^2)", "strain energy"),
        **{
            f"eigenvalue_{name}": (
                "1/C1",
                f"lowest eigenvalue in class {name} of C4v, over h int |v|^2 dA/a^4",
            )
            for name in CLASSES
        },
        "m": ("1", "(p + p_atm) (V + V_r)^kappa of a gas inside, its mass if kappa = 1"),
    },
    method="Two codes that share only the derivatives of the energy: (a) collocation of the equations of "
    "equilibrium at Chebyshev points of a quarter; (b) Galerkin's method with Legendre polynomials over the "
    "whole square. " + rule("Galerkin"),
    grid=f"(a) {HALVES[0]} and {HALVES[1]} intervals from the centre to an edge; (b) degrees {DEGREES[0]} "
    f"and {DEGREES[1]}",
    tolerance="Newton's method to steps of 1e-12; limit loads by secants to 1e-9 of the height, where they "
    "are stationary",
)


@dataclass(frozen=True)
class Inflated:
    """One sheet of the tables.

    Attributes:
        sheet: Law, frame and load.
        first: Load at the height :data:`FIRST`, roughly.
    """

    sheet: Framed
    first: float

    @property
    def names(self) -> tuple[str, str]:
        """Load and amount in the tables."""
        return ("zw", "V_f") if self.sheet.gamma else ("p", "V")

    @property
    def facts(self) -> dict[str, object]:
        """Parameters of the problem."""
        law = self.sheet.alpha
        if isinstance(law, Kirchhoff):  # a law of membrane, not of rectangle
            facts = {"mesh": "square", "model": "saint_venant_kirchhoff", "poisson": law.nu}
            return facts | {"delta": self.sheet.delta}
        liquid = {"load": "liquid", "gamma": self.sheet.gamma} if self.sheet.gamma else {"load": "gas"}
        return {**liquid, "alpha": law, "delta": self.sheet.delta, "c": 1.0}


GAS_KIRCHHOFF = Inflated(Framed(Kirchhoff(0.4)), 0.025)
GAS_NEO_HOOKEAN, GAS = Inflated(Framed(0.0), 0.12), Inflated(Framed(0.1), 0.13)
LIGHT_NEO_HOOKEAN = Inflated(Framed(0.0, gamma=1.0), 0.08)
LIGHT, HEAVY = Inflated(Framed(0.1, gamma=1.0), 0.1), Inflated(Framed(0.1, gamma=5.0), -0.006)

Code = RitzSheet | CollocatedSheet


@cache
def codes(sheet: Framed) -> dict[str, tuple[Code, Code]]:
    """Both methods at both resolutions."""
    a, b = (
        tuple(make(sheet, n) for n in sizes)
        for make, sizes in ((CollocatedSheet, HALVES), (RitzSheet, DEGREES))
    )
    return {"a": a, "b": b}


def _first(code: Code, of: Inflated) -> Found:
    return solve(code.equations, code.centre, code.start(FIRST, of.first), FIRST)


def _states(
    of: Inflated, work: Callable[[Code], list[dict[str, float]]], safety: float = 1.0
) -> dict[str, dict[str, Levels]]:
    """Columns of states by both methods, each at two resolutions, whose difference is the uncertainty."""
    out = {}

    def levels(coarse: list[float], fine: list[float]) -> Levels:
        more = (safety - 1) * np.abs(np.subtract(fine, coarse))
        return Levels(coarse, fine, floor=more, rounding=1e-13)

    for key, pair in codes(of.sheet).items():
        coarse, fine = (work(code) for code in pair)
        out[key] = {
            name: levels([row[name] for row in coarse], [row[name] for row in fine]) for name in fine[0]
        }
    return out


def _columns(
    table: str, of: Inflated, found: dict[str, dict[str, Levels]], names: tuple[str, ...]
) -> list[Column]:
    own = dict(zip(("load", "amount"), of.names, strict=True))
    about = ("collocation", "Galerkin")
    return [
        agreed(table, own.get(n, n), found["a"][n], found["b"][n], SERIES.columns[own.get(n, n)], *about)
        for n in names
    ]


def curve(name: str, title: str, of: Inflated, heights: Array) -> Table:
    """States over the height of the centre."""

    def work(code: Code) -> list[dict[str, float]]:
        return [code.columns(f) for f in follow(code.equations, code.centre, _first(code, of), heights)]

    columns = SERIES.keys(w_c=heights) + _columns(name, of, _states(of, work), ("load", "amount", "U"))
    return SERIES.table(name, title, "", of.facts, columns)


def classes(name: str, title: str, of: Inflated, heights: Array) -> Table:
    """The lowest eigenvalue in each class of C4v over the height of the centre."""

    def work(code: Code) -> list[dict[str, float]]:
        states = follow(code.equations, code.centre, _first(code, of), heights)
        return [{f"eigenvalue_{name}": code.lowest(at, name) for name in CLASSES} for at in states]

    columns = SERIES.keys(w_c=heights)
    columns += _columns(name, of, _states(of, work), tuple(f"eigenvalue_{name}" for name in CLASSES))
    return SERIES.table(name, title, "", of.facts, columns)


def limits(name: str, title: str, of: Inflated, near: float, order: int, notes: str = "") -> Table:
    """One limit load; with ``notes`` of irregular convergence its uncertainty is larger."""

    def work(code: Code) -> list[dict[str, float]]:
        (state,) = follow(code.equations, code.centre, _first(code, of), np.array([near]))
        return [code.columns(limit(code.equations, code.centre, state))]

    columns = SERIES.keys(order=np.array([float(order)]))
    columns += _columns(
        name, of, _states(of, work, TWO_GRIDS if notes else 1.0), ("load", "w_c", "amount", "U")
    )
    return SERIES.table(name, title, "", of.facts, columns, notes=notes)


@dataclass(frozen=True)
class Gas:
    """A gas: (p + p_atm) (V + V_r)^kappa = m."""

    kappa: float
    p_atm: float
    V_r: float

    def mass(self, row: dict[str, float]) -> float:
        """``m`` of a state."""
        return (row["load"] + self.p_atm) * (row["amount"] + self.V_r) ** self.kappa


def fold(
    name: str,
    title: str,
    of: Inflated,
    near: float,
    gas: Gas | None = None,
    width: float = 0.15,
    nodes: int = 9,
) -> Table:
    """The largest volume, or mass of a gas, by a polynomial through states at Chebyshev nodes."""
    largest = "m" if gas else "amount"
    names = ("load", "amount", "U", *(("m",) if gas else ()))

    def work(code: Code) -> list[dict[str, float]]:
        window = near + width * np.cos(np.pi * (np.arange(nodes) + 0.5) / nodes)[::-1]
        states = follow(code.equations, code.centre, _first(code, of), window)
        rows = [code.columns(state) for state in states]
        if gas:
            rows = [row | {"m": gas.mass(row)} for row in rows]
        fits = {n: Chebyshev.fit(window, [row[n] for row in rows], nodes - 1) for n in names}
        roots = [r.real for r in fits[largest].deriv().roots() if abs(r.imag) < 1e-12]
        place = min(roots, key=lambda r: abs(r - near))
        return [{n: float(fit(place)) for n, fit in fits.items()} | {"w_c": place}]

    columns = SERIES.keys(order=np.ones(1))
    columns += _columns(name, of, _states(of, work), ("load", "w_c", *names[1:]))
    return SERIES.table(name, title, "", of.facts | (asdict(gas) if gas else {}), columns)


KINK = (
    "The level lies below the frame: only a part of the sheet is wet, and the pressure's kink inside limits "
    "both methods to the digits stated."
)

TABLES: dict[str, Builder] = {
    name: partial(make, name, *given)
    for name, make, *given in (
        ("rectangle_gas", curve, "Square sheet under gas", GAS, steps(0.1, 1.5, 0.1)),
        (
            *("rectangle_gas_neo_hookean", curve, "Neo-Hookean square sheet under gas", GAS_NEO_HOOKEAN),
            steps(0.1, 1.5, 0.1),
        ),
        ("square_kirchhoff", curve, "Square sheet under gas, C1 = E", GAS_KIRCHHOFF, steps(0.1, 0.8, 0.05)),
        ("rectangle_liquid", curve, "Square sheet under a light liquid", LIGHT, steps(0.1, 1.4, 0.1)),
        ("rectangle_heavy", curve, "Square sheet under a heavy liquid", HEAVY, steps(0.5, 1.0, 0.1)),
        (
            *("rectangle_gas_limit", limits, "Neo-Hookean square sheet: limit pressure"),
            *(GAS_NEO_HOOKEAN, 1.3, 1),
        ),
        ("rectangle_liquid_limit", limits, "Square sheet, light liquid: limit level", LIGHT, 1.2, 1),
        (
            *("rectangle_liquid_limit_neo_hookean", limits, "The same, neo-Hookean: limit level"),
            *(LIGHT_NEO_HOOKEAN, 1.1, 1),
        ),
        (
            *("rectangle_liquid_fold_neo_hookean", fold, "The same, neo-Hookean: largest volume"),
            *(LIGHT_NEO_HOOKEAN, 1.63),
        ),
        (
            *("rectangle_gas_classes", classes, "Neo-Hookean square sheet: stability by classes"),
            *(GAS_NEO_HOOKEAN, steps(0.3, 1.5, 0.3)),
        ),
        (
            *("rectangle_gas_mass_fold", fold, "Neo-Hookean square sheet: largest mass of gas"),
            *(GAS_NEO_HOOKEAN, 1.62, Gas(1.4, 0.5, 60.0)),
        ),
        ("rectangle_heavy_lower", limits, "Heavy liquid: lower limit level", HEAVY, 0.2, 1, KINK),
        ("rectangle_heavy_upper", limits, "Heavy liquid: upper limit level", HEAVY, 0.85, 2),
    )
}
