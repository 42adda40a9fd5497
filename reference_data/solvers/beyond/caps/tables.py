"""Tables of limit points of parts of spheres under gas: lines over alpha or the clamp's angle, and cusps."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from reference_data.solvers.beyond.caps import energy as ritz
from reference_data.solvers.beyond.caps import shooting as shoot
from reference_data.solvers.beyond.caps import waves_ritz, waves_shooting
from reference_data.solvers.core.tables import Levels, Series, Table, agreed, steps
from reference_data.solvers.registry import Builder

Array = np.ndarray
HEMISPHERE = np.pi / 2
ROUNDING = 1e-12
"""Relative rounding of the energy's points."""
ROUNDING_OF_SHOTS = 3e-12
"""The same of shooting, with the error of the flat piece at the pole."""
AT_CUSP = 1e-11
"""The same of both at cusps, where derivatives are taken twice."""
OF_WAVES = 1e-11
"""The same of eigenvalues by both."""
WAVES = (1, 2, 3)

COLUMNS = {
    "t0": ("1/R_f", "height of the pole above the clamp"),
    "lam_pole": ("1", "stretch of the pole"),
    "p": ("P R_f/(C1 h_o)", "gauge pressure; R_f: radius of the clamp"),
    "alpha": ("1", "C2/C1"),
    "angle": ("rad", "angle from the pole to the clamp, at rest"),
    "order": ("1", "number along the line, from 1"),
    **{
        f"Lambda_n{n}_1": ("1", f"lowest eigenvalue, wave number {n}, against int |dx|^2 dA at rest")
        for n in WAVES
    },
}
DEGREES = " and ".join(map(str, ritz.DEGREES))
SERIES = Series(
    "beyond",
    "Parts of spheres, as Patil, Nordmark & Eriksson, J. Mech. Phys. Solids 94 (2016) 298-315",
    COLUMNS,
    "Two codes that share no equation: (a) shooting from the pole with the axial force p r^2/2, in the "
    "logarithm of the arc; limit points and cusps from derivatives by the stretch of the pole, by sums over "
    "a circle; (b) the energy in polynomials of high degree, even about the pole, with the null vector of "
    "its second derivatives as further unknowns. The values are (b).",
    f"(a) {shoot.LEVELS[0].steps} and {shoot.LEVELS[1].steps} extrapolated steps, the first from "
    f"{shoot.LEVELS[0].piece:g} and {shoot.LEVELS[1].piece:g} of the arc; (b) degrees {DEGREES} in the "
    "square of the arc",
    "Newton takes two more steps after the first one below 1e-9: rounding only",
)

SERIES_OF_WAVES = replace(
    SERIES,
    method="Two codes that share no equation: (a) shooting from the pole, of the state and of the linearised "
    "strong equations of a wave, with a determinant at the clamp; (b) second derivatives of the energy of a "
    "surface in space, in polynomials that are regular at the pole. The values are (b).",
)


def traced(first: ritz.Point, hold: str, targets: Array) -> list[ritz.Point]:
    """Limit points at values of t0 or of the parameter, from a guess near the first one."""
    found: list[ritz.Point] = []
    for target in targets.tolist():
        found.append(ritz.limit(found[-1] if found else first, **{hold: target}))
    return found


def both_levels(points: list[ritz.Point], hold: str) -> list[list[ritz.Point]]:
    """The same points with both degrees."""
    finer = [
        ritz.limit(ritz.refined(point, ritz.DEGREES[1]), **{hold: point.numbers[hold]}) for point in points
    ]
    return [points, finer]


def shots(
    points: list[ritz.Point], held: dict[str, Array], levels: tuple[shoot.Accuracy, ...]
) -> list[dict[str, Array]]:
    """The same points by shooting, from the other method's as guesses."""
    vary = points[0].vary
    of = {"angle" if vary == "alpha" else "alpha": points[0].other}
    x = np.array([[point.numbers[n] for point in points] for n in ("lam_pole", "p", vary)])
    return [shoot.solve(x, held, of, vary, how) for how in levels]


def line(
    name: str, vary: str, alpha: float, angle: float, hold: str, targets: Array, begin: float,
    levels: tuple[shoot.Accuracy, ...] = shoot.LEVELS,
) -> Table:  # fmt: skip
    """A line of limit points over t0, or over the parameter itself.

    Args:
        name: Of the table.
        vary: The parameter, alpha or angle.
        alpha: Its first value, or the value of the other one.
        angle: The same.
        hold: ``t0`` or the parameter.
        targets: Values of that.
        begin: Height of the pole of a guess of the first point.
        levels: Accuracies of shooting.
    """
    first = ritz.start(vary, alpha, angle, begin, ritz.DEGREES[0])
    coarse, fine = both_levels(traced(first, hold, targets), hold)
    by_shots = shots(fine, {hold: targets}, levels)
    columns = SERIES.keys(**{hold: targets})
    columns += [
        agreed(name, n, *_pair(n, by_shots, (coarse, fine), rounding=(ROUNDING_OF_SHOTS, ROUNDING)),
               COLUMNS[n], other="shooting", written="energy")
        for n in dict.fromkeys(("p", vary, "t0", "lam_pole"))
        if n != hold
    ]  # fmt: skip
    return SERIES.table(name, f"Limit points over {vary}", "", _other(fine[0]), columns)


def cusp(name: str, vary: str, alpha: float, angle: float, begin: float, near: Array) -> Table:
    """The cusp of a line: stretches of the pole along the line, from a guess to near the cusp."""
    state = ritz.start(vary, alpha, angle, begin, ritz.DEGREES[0])
    coarse = ritz.cusp(traced(state, "lam_pole", near)[-1])
    fine = ritz.cusp(ritz.refined(coarse, ritz.DEGREES[1]))
    by_shots = shots([fine], {}, shoot.LEVELS)
    columns = SERIES.keys(order=[1.0])
    columns += [
        agreed(name, n, *_pair(n, by_shots, ([coarse], [fine]), rounding=(AT_CUSP, AT_CUSP)), COLUMNS[n],
               other="shooting", written="energy")
        for n in (vary, "p", "t0", "lam_pole")
    ]  # fmt: skip
    title = f"Cusp of limit points over {vary}"
    return SERIES.table(name, title, "", _other(fine), columns, extra={"keys": ["order"]})


def waves(
    name: str, angle: float, begin: float, pressures: Array, levels: tuple[shoot.Accuracy, ...] = shoot.LEVELS
) -> Table:
    """The lowest eigenvalues of waves around a neo-Hookean part of a sphere over the pressure.

    Args:
        name: Of the table.
        angle: That of the clamp.
        begin: Height of the pole of a guess of the first state.
        pressures: The pressures, below the limit point.
        levels: Accuracies of shooting.
    """
    state, states = ritz.start("angle", 0.0, angle, begin, ritz.DEGREES[0]), []
    for p in pressures.tolist():
        state = ritz.under(state, p)
        states.append((state, ritz.under(ritz.refined(state, ritz.DEGREES[1]), p)))
    data = [shoot.Data(p, 0.0, angle) for p in pressures.tolist()]
    poles = [
        [
            waves_shooting.pole(fine.numbers["lam_pole"], of, how)
            for (_, fine), of in zip(states, data, strict=True)
        ]
        for how in levels
    ]
    columns = SERIES.keys(p=pressures)
    for n in WAVES:
        own = np.array([[waves_ritz.lowest(at, n) for at in pair] for pair in states]).T
        other = [
            np.array([
                waves_shooting.eigenvalue(*given, n, near, how)
                for *given, near in zip(found, data, own[1].tolist(), strict=True)
            ])
            for how, found in zip(levels, poles, strict=True)
        ]  # fmt: skip
        column = f"Lambda_n{n}_1"
        pair = Levels(*other, rounding=OF_WAVES), Levels(*own, rounding=OF_WAVES)
        columns.append(agreed(name, column, *pair, COLUMNS[column], other="shooting", written="energy"))
    return SERIES_OF_WAVES.table(
        name, "Waves around a part of a sphere", "", {"alpha": 0.0, "angle": angle}, columns
    )


def _pair(
    name: str,
    by_shots: list[dict[str, Array]],
    levels: tuple[list[ritz.Point], list[ritz.Point]],
    rounding: tuple[float, float],
) -> tuple[Levels, Levels]:
    """A column by both methods."""
    own = (np.array([point.numbers[name] for point in level]) for level in levels)
    other = (found[name] for found in by_shots)
    return Levels(*other, rounding=rounding[0]), Levels(*own, rounding=rounding[1])


def _other(point: ritz.Point) -> dict[str, object]:
    """The parameter that does not vary."""
    return {"angle" if point.vary == "alpha" else "alpha": point.other}


TABLES: dict[str, Builder] = {
    "caps_fold_alpha": partial(
        line, "caps_fold_alpha", "alpha", 0.0, HEMISPHERE, "t0", steps(1.7, 3.0, 0.1), 1.69
    ),
    "caps_fold_angle": partial(
        line, "caps_fold_angle", "angle", 0.0, 1.6, "angle", steps(0.4, 2.4, 0.1), 1.72
    ),
    "caps_cusp_alpha": partial(
        cusp, "caps_cusp_alpha", "alpha", 0.02, HEMISPHERE, 1.745, np.array([1.8, 2.0, 2.3, 2.6])
    ),
    "caps_cusp_angle": partial(
        cusp, "caps_cusp_angle", "angle", 0.1, 2.0, 2.65, np.array([1.9, 2.1, 2.4, 2.7])
    ),
    "caps_waves": partial(waves, "caps_waves", HEMISPHERE, 1.05, steps(0.5, 3.0, 0.5)),
}  # fmt: skip
