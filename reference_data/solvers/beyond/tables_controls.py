"""Table of the freely inflated tube under a gas of given mass: where the mass has an extremum."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from reference_data.solvers.beyond import tables_tube_bends as bends
from reference_data.solvers.beyond.tube_waves import ritz, strong
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.core.tables import Table
from reference_data.solvers.registry import Builder


@dataclass(frozen=True)
class Gas:
    """A gas: (p + p_atm) (V + V_r)^kappa = m."""

    kappa: float
    p_atm: float
    V_r: float

    def slope(self, p: float, volume: float, rate: float) -> float:
        """dm/dV over (V + V_r)^(kappa - 1), with the rate dp/dV of the branch."""
        return (volume + self.V_r) * rate + self.kappa * (p + self.p_atm)

    def of_energy(self, state: ritz.State) -> float:
        """The same of a state of (a)."""
        return self.slope(state.p, state.volume, ritz.rate(state))

    def of_equations(self, state: strong.State) -> float:
        """The same of a state of (b)."""
        return self.slope(state.p, state.volume, strong.rate(state))


CASES = (
    (Tube(0.0, 1.0, 6.0), Gas(1.0, 1.0, 10.0)),
    (Tube(0.0, 1.0, 6.0), Gas(1.0, 1.0, 20.0)),
    (Tube(0.0, 1.0, 6.0), Gas(1.4, 0.5, 40.0)),
    (Tube(0.05, 1.0, 6.0), Gas(1.0, 1.0, 40.0)),
    (Tube(0.1, 1.0, 6.0), Gas(1.0, 1.0, 400.0)),
    (Tube(0.0, 2.0, 6.0), Gas(1.0, 0.0, 20.0)),
)
NAMES = ("kappa", "p_atm", "V_r")
COLUMNS = {
    "kappa": ("1", "1 of an isothermal gas, ratio of specific heats of an adiabatic one"),
    "p_atm": ("P R_f/(C1 h_o)", "absolute pressure outside"),
    "V_r": ("1/(2 pi R_f^3)", "volume of a rigid reservoir, for the half tube"),
}
SERIES = replace(
    bends.SERIES,
    columns=bends.SERIES.columns | COLUMNS,
    method="Two codes that share the data of the tube and no equation: (a) the energy of a surface in space, "
    "by polynomials of high degree; (b) collocation of the strong equations of paper 2. Each has its own "
    "rate dp/dV of the branch, from its linearised equations. " + bends.rule("b"),
)


def mass_folds(name: str) -> Table:
    """Extrema of the mass of gas along free inflation, of some tubes and gases."""
    points, gases = [], []
    for tube, gas in CASES:
        at = bends.search(tube)
        falling = np.array([int(gas.of_energy(state) < 0) for state in at.by_energy])
        slopes = np.array([gas.of_equations(state) for state in at.by_equations])
        by_energy: Callable[[int], Callable] = lambda _, gas=gas: gas.of_energy  # noqa: E731
        found = bends.located(tube, (falling, slopes), by_energy, gas.of_equations)
        points += found
        gases += [gas] * len(found)
    named = {key: [getattr(q.tube, key) for q in points] for key in ("alpha", "delta1", "lf")}
    named |= {key: [getattr(gas, key) for gas in gases] for key in NAMES}
    named["order"] = [float(q.order) for q in points]
    without = [
        pair for pair in CASES if pair not in {(q.tube, g) for q, g in zip(points, gases, strict=True)}
    ]
    notes = f"Searched up to u_max = {bends.u_end(CASES[0][0]):g}."
    if without:
        notes += " None for " + "; ".join(f"{tube}, {gas}" for tube, gas in without) + "."
    columns = SERIES.keys(**named) + bends.columns(name, points, {})
    title = "Extrema of the mass of gas in free inflation of a tube"
    return SERIES.table(name, title, "", {}, columns, notes=notes, extra={"keys": list(named)})


TABLES: dict[str, Builder] = {"controls_mass_folds": partial(mass_folds, "controls_mass_folds")}
