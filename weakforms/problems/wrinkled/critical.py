"""Numbers of the unloaded cylinder: critical radius of its disks, thickness ratios at which it wrinkles."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from mpi4py import MPI

from weakforms.errors import ConvergenceError
from weakforms.problems.material_choice import Chosen
from weakforms.problems.meridian.body import Body
from weakforms.problems.meridian.model import TAUT, WRINKLED
from weakforms.problems.wrinkled.body import CYLINDER
from weakforms.problems.wrinkled.fitted import PLACE
from weakforms.problems.wrinkled.membrane import STEEP, WALK, Membrane, natural_radius
from weakforms.problems.wrinkled.state import Touch, ZonedState
from weakforms.solvers.continuation.walk import walk
from weakforms.solvers.uncertainty.refinement import Estimate, estimate

WRINKLED_RADIUS = 0.05
"""A radius of the disks at which the whole unloaded membrane is wrinkled."""

ROUND_OFF = 1e-12
"""Round-off error of ``gw``."""

BESIDE = 1e-3
"""Step of the thickness ratio over which the rate of the smallest ``gw`` is taken."""

SEARCH, LAST = 0.05, 0.05
"""Step of the thickness ratio in the search for a threshold, and the ratio at which the search ends."""

COMPRESSED = 1e-11
"""How far from 1 the least ``gw`` counts: in the middle of a long membrane it is 1 to round-off."""

SAMPLES = 801
"""Places at which ``gw`` is looked at to find the least, and again around it."""

NEAR = 1e-3
"""Width in the ratio from which a threshold is solved for."""


def critical_radii(
    comm: MPI.Intracomm,
    values: Mapping[str, float],
    cells: Sequence[int],
    degree: int,
    material: Chosen | None = None,
    body: Body = CYLINDER,
) -> list[float]:
    r"""Largest radius of the disks with ``gw <= 1`` everywhere at zero load, on each mesh.

    .. math:: (A_f)_c = \lambda_1(\text{thinnest place})^{-1/2}

    The meridional stretch of the unloaded, wrinkled membrane does not depend on the radius, so that a small
    radius is used (Patil, Nordmark & Eriksson 2015, section 4.1 and table 2).

    Raises:
        ConvergenceError: If the unloaded state is not found.
    """
    membrane = Membrane(
        comm, body, {**values, "Af": WRINKLED_RADIUS}, False, cells, degree, "relaxed", (), material
    )
    found = []
    for level in range(len(cells)):
        held = membrane.unloaded(level, WRINKLED)
        ends = held.sampled(np.array([0.0, membrane.length]))["gw"].max()
        inside = 0.0 if body is CYLINDER else held.extreme("gw", 1)  # a linear thickness is least at an end
        found.append(WRINKLED_RADIUS / max(ends, inside))
    return found


def threshold(
    comm: MPI.Intracomm,
    values: Mapping[str, float],
    cells: Sequence[int],
    degree: int,
    towards: int,
    material: Chosen | None = None,
) -> dict[str, Estimate]:
    """Thickness ratio ``M`` beyond which the unloaded membrane wrinkles, and where it does first, ``Z``.

    The root of ``min gw = 1`` on the wholly taut state: ``gw = 1`` at an end, or ``gw = 1`` and ``gw' = 0``
    at a point of the mesh that is an unknown, as ``M`` is. In a long membrane ``gw`` may be so level that no
    such point is found: then ``M`` alone, from between the last ratio that is taut beyond round-off and the
    first that is not. Between wide disks a short membrane is taut at every ratio: then the last ratio looked
    at, ``M_taut``, and the least ``gw`` there, ``gw_min``.

    Args:
        comm: Ranks.
        values: Parameters other than ``M``, including the radius ``Af`` of the disks.
        cells: Cells of a block on each mesh, coarse to fine.
        degree: Degree of the elements.
        towards: -1 for the threshold below the uniform thickness, 1 for the one above it.
        material: A law that replaces the Mooney-Rivlin law.

    Raises:
        ConvergenceError: When the membrane of uniform thickness is wrinkled, or a step does not converge.
    """
    membrane = Membrane(comm, CYLINDER, {**values, "M": 1.0}, False, cells, degree, "relaxed", (), material)
    held, taut = _first_wrinkled(membrane, len(cells) - 1, towards)
    beyond = held.state.loads["M"]
    if _least(held) >= 1 - COMPRESSED:
        found = [_least(membrane.fit(k, held, held.zones, (), free=(), same=True)) for k in range(len(cells))]
        exact = np.array(0.0)
        return {"M_taut": Estimate(np.array(beyond), exact, exact), "gw_min": estimate(found, degree)}
    try:
        return _touching(membrane, held, degree)
    except ConvergenceError:
        middle, half = (taut + beyond) / 2, abs(taut - beyond) / 2
        return {"M": Estimate(np.array(middle), np.array(half), np.array(0.0))}


def _touching(membrane: Membrane, held: ZonedState, degree: int) -> dict[str, Estimate]:
    """The threshold and its place, from a state close by."""
    first, s = held, np.linspace(0.0, membrane.length, SAMPLES)
    place = float(s[np.argmin(held.sampled(s)["gw"])])
    at_end = place in (0.0, membrane.length)
    if not at_end:
        s = place + np.linspace(-1.0, 1.0, SAMPLES) * membrane.length / (SAMPLES - 1)
        place = float(s[np.argmin(held.sampled(s)["gw"])])
    found = membrane.touching(held, Touch(place, at_end), free=("M",))
    thickness = [held.state.loads["M"] for held in found]
    where = estimate([held.touched for held in found], 2 * degree)
    where = replace(where, uncertainty=where.uncertainty + PLACE)
    ratio = estimate(thickness, 2 * degree)
    value = float(ratio.value)
    membrane.values["M"] = value + float(np.sign(value - 1)) * BESIDE
    growth = abs(_least(membrane.unloaded_from(len(found) - 1, TAUT, first)) - 1.0) / BESIDE
    return {"M": replace(ratio, uncertainty=ratio.uncertainty + ROUND_OFF / growth), "Z": where}


def _least(held: ZonedState) -> float:
    return held.extreme("gw", -1)


def _first_wrinkled(membrane: Membrane, level: int, towards: int) -> tuple[ZonedState, float]:
    """The taut state at a thickness ratio just beyond the threshold, or at the last ratio.

    Returns:
        The state, and the last ratio at which the membrane is taut beyond round-off.

    Taut states of uniform thickness are followed from a cylinder in uniaxial tension, whose radius is
    ``delta^(-1/2)``, to the disks' radius and the pre-stretch, and from there over the ratio.
    """
    values = membrane.values
    radius, delta = values["Af"], values["delta"]
    values["delta"] = max(delta, STEEP)
    values["Af"] = min(radius, natural_radius(values["delta"]))
    held = membrane.unloaded_from(level, TAUT, None)
    held = _walked(membrane, level, held, "Af", radius, WALK)
    held = _walked(membrane, level, held, "delta", delta, SEARCH)
    if _least(held) < 1 - COMPRESSED:
        raise ConvergenceError("the membrane of uniform thickness is not taut: there is no threshold")
    last, step, clear = 1 + towards * (1 - LAST), towards * SEARCH, 1.0
    while values["M"] != last:
        taut, at = held, values["M"]
        goal = last if abs(last - at) < 1.5 * abs(step) else at + step
        held = _walked(membrane, level, taut, "M", goal, SEARCH)
        if _least(held) > 1 + COMPRESSED:
            clear = goal
        if _least(held) >= 1 - COMPRESSED:
            continue
        if abs(step) < NEAR:
            break
        step /= 4
        held, values["M"] = taut, at
    return held, clear


def _walked(
    membrane: Membrane, level: int, held: ZonedState, name: str, goal: float, step: float
) -> ZonedState:
    """The taut state with one parameter at a goal, by steps that shorten where they do not converge."""

    def solve(before: ZonedState, value: float) -> ZonedState:
        membrane.values[name] = value
        return membrane.unloaded_from(level, TAUT, before)

    try:
        return walk(solve, held, membrane.values[name], goal, step)
    except ConvergenceError as error:
        raise ConvergenceError(f"{name} of the taut membrane: {error}") from error
