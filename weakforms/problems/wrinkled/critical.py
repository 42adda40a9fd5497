"""Numbers of the unloaded cylinder: critical radius of its disks, thickness ratios at which it wrinkles."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from mpi4py import MPI

from weakforms.errors import ConvergenceError
from weakforms.problems.material_choice import Chosen
from weakforms.problems.wrinkled.body import CYLINDER
from weakforms.problems.wrinkled.fitted import PLACE, Membrane
from weakforms.problems.wrinkled.model import TAUT, WRINKLED
from weakforms.problems.wrinkled.state import Held, Touch
from weakforms.solvers.uncertainty.refinement import Estimate, estimate

WRINKLED_RADIUS = 0.05
"""A radius of the disks at which the whole unloaded membrane is wrinkled."""

ROUND_OFF, GROWTH = 1e-12, 2e-3
"""Round-off error of ``gw``, and the rate at which the smallest ``gw`` changes with the thickness ratio."""

SEARCH, LAST = 0.05, 0.05
"""Step of the thickness ratio in the search for a threshold, and the ratio at which the search ends."""


def critical_radii(
    comm: MPI.Intracomm,
    values: Mapping[str, float],
    cells: Sequence[int],
    degree: int,
    material: Chosen | None = None,
) -> list[float]:
    r"""Largest radius of the disks with ``gw <= 1`` everywhere at zero load, on each mesh.

    .. math:: (A_f)_c = \lambda_1(\text{thin end})^{-1/2}

    The meridional stretch of the unloaded, wrinkled membrane does not depend on the radius, so that a small
    radius is used (Patil, Nordmark & Eriksson 2015, section 4.1 and table 2).

    Raises:
        ConvergenceError: If the unloaded state is not found.
    """
    membrane = Membrane(
        comm, CYLINDER, {**values, "Af": WRINKLED_RADIUS}, False, cells, degree, "relaxed", (), material
    )
    found = []
    for level in range(len(cells)):
        held = membrane.unloaded(level, WRINKLED)
        ends = held.sampled(np.array([0.0, membrane.length]))
        found.append(WRINKLED_RADIUS / ends["gw"].max())
    return found


def threshold(
    comm: MPI.Intracomm,
    values: Mapping[str, float],
    cells: Sequence[int],
    degree: int,
    towards: int,
    material: Chosen | None = None,
) -> tuple[Estimate, Estimate]:
    """Thickness ratio ``M`` beyond which the unloaded membrane wrinkles, and the first wrinkled point.

    It solves ``min gw = 1`` for the taut state: ``gw = 1`` and ``gw' = 0`` at a point of the mesh; this point
    and ``M`` are unknowns.

    Args:
        comm: Ranks.
        values: Parameters other than ``M``, including the radius ``Af`` of the disks.
        cells: Cells of a block on each mesh, coarse to fine.
        degree: Degree of the elements.
        towards: -1 for the threshold below the uniform thickness, 1 for the one above it.
        material: A law that replaces the Mooney-Rivlin law.

    Raises:
        ConvergenceError: If the membrane is taut, or wrinkled, in the whole range of the search.
    """
    membrane = Membrane(comm, CYLINDER, {**values, "M": 1.0}, False, cells, degree, "relaxed", (), material)
    held = _first_wrinkled(membrane, len(cells) - 1, towards)
    s = np.linspace(0.0, membrane.length, 801)
    place = float(s[np.argmin(held.sampled(s)["gw"])])
    found = []
    for level in reversed(range(len(cells))):
        touch = Touch(place, at_end=False)
        held = membrane.fit(level, held, held.zones, (), free=("M",), touch=touch, same=bool(found))
        place = held.touched
        found.append((held.state.loads["M"], place))
    thickness, places = zip(*reversed(found), strict=True)
    place = estimate(list(places), 2 * degree)
    place = replace(place, uncertainty=place.uncertainty + PLACE)
    ratio = estimate(list(thickness), 2 * degree)
    return replace(ratio, uncertainty=ratio.uncertainty + ROUND_OFF / GROWTH), place


def _first_wrinkled(membrane: Membrane, level: int, towards: int) -> Held:
    """The taut state at the first thickness ratio at which it is compressed somewhere."""
    held, ratio = membrane.unloaded(level, TAUT), 1.0
    if held.put().extreme("gw", -1) <= 1.0:
        raise ConvergenceError("the membrane of uniform thickness is not taut: there is no threshold")
    while held.put().extreme("gw", -1) > 1.0:
        ratio += towards * SEARCH
        if not LAST < ratio < 2 - LAST:
            raise ConvergenceError(f"the membrane is taut for every M from 1 to {ratio:.3g}")
        membrane.values["M"] = ratio
        held = membrane.unloaded_from(level, TAUT, held)
    return held
