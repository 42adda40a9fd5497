"""Tables of critical points of the wrinkled tube under gas or liquid, over one parameter, and where two meet.

The methods are those of paper 4: collocation with fronts as unknown breakpoints, and shooting that is given
no pattern of zones. Each point is solved for on its own, from the unloaded membrane.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from reference_data.solvers.core.newton import secant
from reference_data.solvers.core.tables import Array, Table, steps
from reference_data.solvers.paper4 import cases as cas
from reference_data.solvers.paper4 import events as evt
from reference_data.solvers.paper4 import limits as lim
from reference_data.solvers.paper4 import text
from reference_data.solvers.paper4.cases import Pair
from reference_data.solvers.paper4.events import Touch
from reference_data.solvers.paper4.material import Membrane
from reference_data.solvers.paper4.methods import shooting_measures as smsr
from reference_data.solvers.paper4.methods import shooting_newton as sho
from reference_data.solvers.paper4.methods import states as sta
from reference_data.solvers.paper4.methods.collocation import State, newton
from reference_data.solvers.registry import Builder

SERIES = replace(text.SERIES, paper="beyond")
FINER = " and ".join(f"degree {r.degree} on elements up to {r.longest:g}" for r in lim.RULES)
AT_LIMITS = (
    f"(a) {FINER} Ao long; (b) {sho.SEGMENTS} segments of {' and '.join(str(2 * n) for n in cas.STEPS)} "
    f"steps. The pattern is first read off finite differences with {cas.CELLS} intervals."
)
"""Resolutions at limit points, where the membrane is stretched far."""
FIRST, CLIMB = 0.4, 1.0
"""Pressure from which the volume is raised, and the step by which it is."""
OFFSET = 1e-3
"""Relative offsets of shooting's other values, for slopes only."""


def tube(load: str = "gas", **given: float) -> Membrane:
    """The membrane that the parameters are varied of."""
    return Membrane(**({"M": 0.5, "delta": 2.0, "Af": 0.5} | given), load=load)


def besides(membrane: Membrane, *varied: str) -> dict[str, object]:
    """The parameters that a table has in common, by the names of the problem diagram."""
    given = {"alpha" if name == "c2" else name: value for name, value in text.given(membrane).items()}
    return {name: value for name, value in given.items() if name not in varied}


def folds(
    name: str, over: str, values: Array, load: str = "gas", first: float = FIRST, **given: float
) -> Table:
    """Limit pressures, or levels of a liquid, over a parameter; ``first`` is a load below all of them."""
    found = [lim.limit(tube(load, **given, **{over: float(x)}), first, CLIMB).values for x in values]
    of, columns = tube(load, **given, **{over: float(values[0])}), SERIES.keys(**{over: values})
    for key, column in (("load", of.control), ("V", "V")):
        columns.append(
            cas.agreed(name, column, *cas.stacked([x[key] for x in found]), SERIES.columns[column])
        )
    what = "pressures" if load == "gas" else "levels of a liquid"
    return SERIES.table(
        name, f"Line of limit {what} over {over}", "", besides(of, over), columns, grid=AT_LIMITS
    )


def onsets(name: str) -> Table:
    """Pressures above which the membrane is taut all over, over the thickness at its lower end."""
    thick, starts = np.transpose(NEAR)
    of = [tube(M=float(M), Af=1.0) for M in thick]
    found = [evt.find(Touch(m, float(p), 4.2, maximum=False)) for m, p in zip(of, starts, strict=True)]
    columns = SERIES.keys(M=thick)
    for key, column in (("x", "p"), ("s", "Z")):
        pairs = cas.stacked([getattr(x, key) for x in found])
        columns.append(cas.agreed(name, column, *pairs, SERIES.columns[column]))
    return SERIES.table(name, "Line of first wrinkling over M", "", besides(of[0], "M"), columns)


NEAR = ((0.4, 0.0056), (0.45, 0.0046), (0.5, 0.0035), (0.55, 0.0026), (0.6, 0.0018), (0.65, 0.0012))
"""Thicknesses, and pressures just above those looked for."""


def meetings(name: str) -> Table:
    """Radii of the disks at which the membrane is about to wrinkle at its limit pressure."""
    thick = np.array([0.5, 0.7])
    pairs: dict[str, list[tuple[Pair, Pair]]] = {"Af": [], "p": [], "V": []}
    for M in thick:
        membrane = tube(M=float(M), Af=0.95)
        past, v1, v0 = lim.climbed(membrane, FIRST, CLIMB)
        levels = [by_collocation(past, v0, v1, rule) for rule in lim.RULES]
        a = [numbers for _, numbers in levels]
        b = [by_shooting(levels[1][0], 2 * n) for n in cas.STEPS]
        for key, found in pairs.items():
            found.append(tuple(Pair(*(np.array(x[key]) for x in side), ROUNDING[key]) for side in (a, b)))
    columns = SERIES.keys(M=thick)
    for key, found in pairs.items():
        columns.append(cas.agreed(name, key, *cas.stacked(found), SERIES.columns[key]))
    fixed, title = besides(tube(), "M", "Af"), "Disks between which the limit point is about to wrinkle"
    return SERIES.table(name, title, "", fixed, columns, grid=AT_LIMITS)


ROUNDING = {"Af": 1e-11, "p": 1e-11, "V": 1e-9}
"""What rounding leaves: the volume follows from a slope that is nearly flat."""


def excess(state: State) -> float:
    """``gw - 1`` at the upper disk."""
    return evt.of_state(state, Touch(state.membrane, 0.0, state.membrane.L))[1]


def by_collocation(past: State, v0: float, v1: float, rule: sta.Rule) -> tuple[State, dict[str, float]]:
    """Radius at which the limit point of the membrane as a taut one has ``gw = 1`` at the upper disk."""
    here, volumes = [sta.moved_to(past, rule)], [v0, v1]

    def at_limit(radius: float) -> float:
        membrane = replace(past.membrane, Af=radius)

        def rate(v: float) -> float:
            here[0] = newton(replace(here[0], membrane=membrane), "V", v)
            return here[0].rate("V")

        v, _ = secant(rate, *volumes)
        rate(v)
        volumes[:] = [v, v * (1 + OFFSET)]
        return excess(here[0])

    radius, _ = secant(at_limit, past.membrane.radius, past.membrane.radius * (1 - 10 * OFFSET))
    at_limit(radius)
    return here[0], {"Af": radius, "p": here[0].load, "V": here[0].volume}


def by_shooting(state: State, count: int) -> dict[str, float]:
    """The same by one Newton step in radius and volume from the state found by collocation."""

    def at(radius: float, volume: float) -> Array:
        membrane = replace(state.membrane, Af=radius)
        shot = sho.solve(membrane, smsr.starts_of(state, count), state.load, "V", volume, count)
        return np.array([shot.rate, evt.of_shot(shot, Touch(membrane, 0.0, membrane.L))[1], shot.load])

    x = np.array([state.membrane.radius, state.volume])
    base = at(*x)
    moves = OFFSET * np.diag(x) * (1, -1)
    slopes = np.transpose([(at(*(x + move)) - base) / move.sum() for move in moves])
    step = np.linalg.solve(slopes[:2], -base[:2])
    return {"Af": x[0] + step[0], "V": x[1] + step[1], "p": base[2] + slopes[2] @ step}


TABLES: dict[str, Builder] = {
    "wrinkled_fold_M": partial(folds, "wrinkled_fold_M", "M", steps(0.5, 1.0, 0.1)),
    "wrinkled_fold_M_thin": partial(folds, "wrinkled_fold_M_thin", "M", steps(0.3, 0.4, 0.05)),
    "wrinkled_fold_M_taut": partial(folds, "wrinkled_fold_M_taut", "M", steps(0.4, 0.9, 0.1), Af=1.0),
    "wrinkled_fold_delta": partial(folds, "wrinkled_fold_delta", "delta", steps(1.5, 2.0, 0.25)),
    "wrinkled_fold_delta_far": partial(folds, "wrinkled_fold_delta_far", "delta", steps(2.25, 3.0, 0.25)),
    "wrinkled_fold_Af": partial(folds, "wrinkled_fold_Af", "Af", steps(0.55, 0.8, 0.05)),
    "wrinkled_fold_Af_taut": partial(folds, "wrinkled_fold_Af_taut", "Af", steps(0.85, 1.0, 0.05)),
    "wrinkled_fold_M_full": partial(
        folds, "wrinkled_fold_M_full", "M", steps(0.45, 0.55, 0.05), load="fluid", first=17.5, gamma=0.05
    ),
    "wrinkled_fold_M_partly": partial(
        folds, "wrinkled_fold_M_partly", "M", steps(0.45, 0.55, 0.05), load="fluid", first=5.0, gamma=0.3
    ),
    "wrinkled_onset_M": lambda: onsets("wrinkled_onset_M"),
    "wrinkled_meetings": lambda: meetings("wrinkled_meetings"),
}
