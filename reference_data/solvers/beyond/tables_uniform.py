"""Tables of critical points of balloons and long tubes in planes of two parameters."""

from __future__ import annotations

from functools import partial

import numpy as np

from reference_data.solvers.closed_form import bodies as body
from reference_data.solvers.closed_form import lines as line
from reference_data.solvers.core.laws import CONSTANTS, law
from reference_data.solvers.core.tables import Column, Series, Table, steps
from reference_data.solvers.core.two_estimates import both
from reference_data.solvers.registry import Builder

COLUMNS = {
    "p": ("P R/(S h_o)", "pressure; R: radius at rest"),
    "lam": ("1", "stretch of the balloon"),
    "lam1": ("1", "axial stretch"),
    "lam2": ("1", "hoop stretch"),
    "force": ("1/(2 pi R h_o S)", "axial force in addition to the pressure"),
    "alpha": ("1", "C2/C1"),
    "mu2": ("1/S", "second modulus of Ogden's law"),
    "jm": ("1", "limit of I1 - 3 of Gent's law"),
    "order": ("1", "number along the line, from 1"),
}
SERIES = Series(
    "beyond",
    "Balloons: Ogden (1972); long tubes: Haughton & Ogden (1979), Fu, Pearce & Liu (2008)",
    COLUMNS,
    "Closed forms up to a root: (a) conditions in derivatives of the law worked out by hand; (b) other forms "
    "of them (extrema of the tension, the Jacobian of pressure and axial force, rates at constant volume or "
    "along the branch of a closed tube) in derivatives of the energy alone, by contour integrals. The values "
    "are (a).",
    "none",
    "rounding",
)
FLAT = (1e-11, 2e-9)
"""Uncertainties of parameters that depend on second derivatives of the law."""
LOOSE = (2e-9, 2e-8)
"""The same at turning points, which use differences."""


def table(
    name: str,
    title: str,
    parameters: dict[str, object],
    keys: dict[str, object],
    found: dict[str, tuple[list[float], list[float]]],
    levels: tuple[float, float] = FLAT,
) -> Table:
    """A table of numbers found in two ways."""
    columns: list[Column] = SERIES.keys(**keys)
    columns += [both(name, n, COLUMNS[n], *pair, levels=levels) for n, pair in found.items()]
    extra = {"keys": ["order"]} if "order" in keys else {}
    return SERIES.table(name, title, "", parameters, columns, kind="exact", extra=extra)


def balloon_line(name: str, model: str, vary: str, ratio: float, stretches: np.ndarray) -> Table:
    """The constant of a law and the pressure at critical points of a balloon over its stretch."""
    found: dict[str, tuple[list[float], list[float]]] = {vary: ([], []), "p": ([], [])}
    for lam in stretches.tolist():
        one = line.root(lambda c, lam=lam: line.balloon(_hand(model, vary, c), lam, ratio), (0.0, 0.4))
        other = line.root(
            lambda c, lam=lam: line.balloon_from_energy(law(model, **{vary: c}).energy, lam, ratio),
            (0.0, 0.4),
        )
        _append(found, {vary: (one, other), "p": _balloon_pressures(model, vary, one, other, lam, lam)})
    kind = "limit points" if ratio == line.LIMIT else "neutral modes of degree 1"
    return table(
        name, f"Balloon of {model}: {kind} over {vary}", _rest(model, vary), {"lam": stretches}, found
    )


def balloon_turn(name: str, model: str, vary: str, ratio: float, guess: tuple[float, float]) -> Table:
    """The point at which such a line turns in the constant."""
    one = line.balloon_turn(partial(_hand, model, vary), ratio, guess)
    other = line.balloon_turn_from_energy(lambda c: law(model, **{vary: c}).energy, ratio, guess)
    p = _balloon_pressures(model, vary, one[0], other[0], one[1], other[1])
    found = {vary: ([one[0]], [other[0]]), "p": ([p[0]], [p[1]]), "lam": ([one[1]], [other[1]])}
    kind = "merging limit points" if ratio == line.LIMIT else "merging modes of degree 1"
    return table(name, f"Balloon of {model}: {kind}", _rest(model, vary), {"order": [1.0]}, found, LOOSE)


def long_waves(
    name: str, alpha: float, stretches: np.ndarray, bracket: tuple[float, float], *loads: str
) -> Table:
    """Neutral long axisymmetric waves of a tube over its axial stretch, under ``loads``."""
    hand, contour = _both_ways("mooney_rivlin", alpha=alpha)
    found: dict[str, tuple[list[float], list[float]]] = {n: ([], []) for n in ("lam2", *loads)}
    for l1 in stretches.tolist():
        one = line.root(lambda l2, l1=l1: line.long_waves(hand, l1, l2), bracket)
        other = line.root(lambda l2, l1=l1: line.loads_jacobian(contour, l1, l2), bracket)
        pairs = {n: (LOADS[n](hand, l1, one), LOADS[n](contour, l1, other)) for n in loads}
        _append(found, {"lam2": (one, other), **pairs})
    title = "Long tube of mooney_rivlin: neutral long waves over the axial stretch"
    return table(name, title, {"model": "mooney_rivlin", "alpha": alpha}, {"lam1": stretches}, found)


LOADS = {"p": line.pressure, "force": line.force}


def bending(name: str, alpha: float, stretches: np.ndarray, bracket: tuple[float, float]) -> Table:
    """Axial stretch and pressure at which a tube between fixed ends bends in long waves."""
    hand, contour = _both_ways("mooney_rivlin", alpha=alpha)
    energy = law("mooney_rivlin", alpha=alpha).energy
    found: dict[str, tuple[list[float], list[float]]] = {n: ([], []) for n in ("lam1", "p")}
    for l2 in stretches.tolist():
        one = line.root(lambda l1, l2=l2: line.force(hand, l1, l2), bracket)
        other = line.root(lambda l1, l2=l2: line.bends(energy, l1, l2), bracket)
        p = line.pressure(hand, one, l2), line.pressure(contour, other, l2)
        _append(found, {"lam1": (one, other), "p": p})
    title = "Long tube of mooney_rivlin between fixed ends: no axial force"
    return table(name, title, {"model": "mooney_rivlin", "alpha": alpha}, {"lam2": stretches}, found)


def both_waves(name: str, alpha: float, guess: tuple[float, float]) -> Table:
    """The tube that bends and bulges at once: by (b) the limit point of the tube with closed ends."""
    hand, contour = _both_ways("mooney_rivlin", alpha=alpha)
    one = line.where_both(hand, guess)
    hoop = line.root(lambda l2: body.tube_slope(contour, l2), (1.5, 2.0))
    p, l1, _ = body.tube_state(contour, hoop)
    found = {"p": ([line.pressure(hand, *one)], [p])}
    found |= {n: ([a], [b]) for n, a, b in zip(("lam1", "lam2"), one, (l1, hoop), strict=True)}
    title = "Long tube of mooney_rivlin between fixed ends: bending and long waves at once"
    return table(name, title, {"model": "mooney_rivlin", "alpha": alpha}, {"order": [1.0]}, found)


def waves_turn(name: str, jm: float, guess: tuple[float, float]) -> Table:
    """The axial stretch beyond which a tube of Gent's law has no neutral long waves."""
    hand, contour = _both_ways("gent", jm=jm)
    one = line.waves_turn(line.long_waves, hand, guess, 2e-3)
    other = line.waves_turn(line.loads_jacobian, contour, guess, 4e-3)
    found = {"p": ([line.pressure(hand, *one)], [line.pressure(contour, *other)])}
    found |= {n: ([a], [b]) for n, a, b in zip(("lam1", "lam2"), one, other, strict=True)}
    title = "Long tube of gent: merging long waves"
    return table(name, title, {"model": "gent", "jm": jm}, {"order": [1.0]}, found, LOOSE)


def gent_limits(name: str, stretches: np.ndarray, bracket: tuple[float, float]) -> Table:
    """Limit points of closed tubes of Gent's law over the hoop stretch."""
    found: dict[str, tuple[list[float], list[float]]] = {n: ([], []) for n in ("jm", "p", "lam1")}

    def condition(jm: float, l2: float) -> float:
        hand = _hand("gent", "jm", jm)
        return line.long_waves(hand, body.axial(hand, l2), l2)

    for l2 in stretches.tolist():
        one = line.root(lambda jm, l2=l2: condition(jm, l2), bracket)
        other = line.root(lambda jm, l2=l2: body.tube_slope(_contour("gent", "jm", jm), l2), bracket)
        states = [body.tube_state(f("gent", "jm", c), l2) for f, c in ((_hand, one), (_contour, other))]
        pairs = {n: tuple(state[k] for state in states) for k, n in enumerate(("p", "lam1"))}
        _append(found, {"jm": (one, other), **pairs})
    return table(
        name, "Closed tube of gent: limit points over jm", {"model": "gent"}, {"lam2": stretches}, found
    )


def gent_merge(name: str, guess: tuple[float, float]) -> Table:
    """The constant of Gent's law at which they merge."""
    ways = ((_hand, 2e-3), (_contour, 4e-3))
    rows = []
    for make, step in ways:
        rate = lambda c, x, make=make: body.tube_slope(make("gent", "jm", c), x)  # noqa: E731
        jm, l2 = line.tube_merge(rate, guess, step)
        p, l1, _ = body.tube_state(make("gent", "jm", jm), l2)
        rows.append({"jm": jm, "p": p, "lam1": l1, "lam2": l2})
    found = {n: ([rows[0][n]], [rows[1][n]]) for n in rows[0]}
    title = "Closed tube of gent: merging limit points"
    return table(name, title, {"model": "gent"}, {"order": [1.0]}, found, LOOSE)


def _hand(model: str, vary: str, constant: float) -> body.Derivatives:
    return body.by_hand(law(model, **{vary: constant}))


def _contour(model: str, vary: str, constant: float) -> body.Derivatives:
    return body.by_contour(law(model, **{vary: constant}))


def _both_ways(model: str, **constants: float) -> tuple[body.Derivatives, body.Derivatives]:
    return body.by_hand(law(model, **constants)), body.by_contour(law(model, **constants))


def _balloon_pressures(
    model: str, vary: str, one: float, other: float, lam: float, lam_other: float
) -> tuple[float, float]:
    return (
        body.balloon(_hand(model, vary, one), lam),
        body.balloon(_contour(model, vary, other), lam_other),
    )


def _rest(model: str, vary: str) -> dict[str, object]:
    """The law, without the constant that varies."""
    return {"model": model} | {name: value for name, value in CONSTANTS[model].items() if name != vary}


def _append(found: dict[str, tuple[list[float], list[float]]], row: dict[str, tuple[float, float]]) -> None:
    for name, pair in row.items():
        for values, value in zip(found[name], pair, strict=True):
            values.append(value)


TABLES: dict[str, Builder] = {
    "uniform_balloon_alpha": partial(
        balloon_line, "uniform_balloon_alpha", "mooney_rivlin", "alpha", line.LIMIT, steps(1.4, 3.9, 0.1)
    ),
    "uniform_balloon_mu2": partial(
        balloon_line, "uniform_balloon_mu2", "ogden", "mu2", line.LIMIT, steps(1.4, 5.2, 0.2)
    ),
    "uniform_pear_mu2": partial(
        balloon_line, "uniform_pear_mu2", "ogden", "mu2", line.PEAR, steps(1.75, 2.9, 0.05)
    ),
    "uniform_balloon_cusp_alpha": partial(
        balloon_turn, "uniform_balloon_cusp_alpha", "mooney_rivlin", "alpha", line.LIMIT, (0.2, 1.8)
    ),
    "uniform_balloon_cusp_mu2": partial(
        balloon_turn, "uniform_balloon_cusp_mu2", "ogden", "mu2", line.LIMIT, (0.096, 1.65)
    ),
    "uniform_pear_tip_mu2": partial(
        balloon_turn, "uniform_pear_tip_mu2", "ogden", "mu2", line.PEAR, (0.007, 2.0)
    ),
    "uniform_long_waves": partial(
        long_waves, "uniform_long_waves", 0.1, steps(1.1, 2.0, 0.1), (1.3, 2.2), "p"
    ),
    "uniform_free_ends": partial(
        long_waves, "uniform_free_ends", 0.1, steps(1.1, 1.9, 0.1), (1.3, 2.2), "p", "force"
    ),
    "uniform_bending": partial(bending, "uniform_bending", 0.1, steps(1.4, 3.9, 0.1), (0.9, 2.5)),
    "uniform_both_waves": partial(both_waves, "uniform_both_waves", 0.1, (1.2, 1.7)),
    "uniform_waves_turn": partial(waves_turn, "uniform_waves_turn", 30.0, (1.93, 2.25)),
    "uniform_closed_jm": partial(gent_limits, "uniform_closed_jm", steps(1.65, 2.55, 0.15), (16.0, 80.0)),
    "uniform_closed_cusp_jm": partial(gent_merge, "uniform_closed_cusp_jm", (18.2, 1.9)),
}  # fmt: skip
