"""The bent states by the second method, and the columns on which both methods agree."""

from __future__ import annotations

import numpy as np

from reference_data.solvers.core.tables import Column, Estimate, agreed, round_up
from reference_data.solvers.core.two_estimates import on_two_grids
from reference_data.solvers.paper3 import text
from reference_data.solvers.paper3.bent.equations import Surface
from reference_data.solvers.paper3.data import FluidTube
from reference_data.solvers.paper3.strong import equations as strong
from reference_data.solvers.paper3.strong.equations import Bent
from reference_data.solvers.paper3.strong.net import Array, Net

# Wet and dry elements, degree, highest wave number. The tubes that bulge most need more waves. Those that are
# stretched least bend sharply over the lower ring, where six elements were too long: they left 1.4e-7 in V.
NETS = ((6, 4, 13, 21), (6, 4, 17, 27))
STEEP_NETS = ((6, 4, 15, 25), (7, 4, 17, 33))
SLACK_NETS = ((8, 5, 16, 21), (9, 5, 18, 26))
# Close to the bifurcation few waves suffice, but slopes divide errors by the square of a small offset.
SLOPE_NETS = ((9, 5, 16, 12), (11, 6, 18, 15))
STEEP = (FluidTube(8, 2), FluidTube(8, 3))
SLACK = (FluidTube(8, 1.5), FluidTube(24, 1.5))
LEFT = 1e-10  # relative; above what Newton's last step and rounding leave in a column (a test measures it)


def chosen(tube: FluidTube) -> tuple[tuple[int, int, int, int], ...]:
    """Elements, degree and wave numbers of the two nets of a tube."""
    if tube in SLACK:
        return SLACK_NETS
    return STEEP_NETS if tube in STEEP else NETS


def balanced(
    guess: Surface, offset: float | None = None, sizes: tuple[tuple[int, int, int, int], ...] | None = None
) -> tuple[Bent, Bent]:
    """The bent state by collocation on both nets, from another method's coarse state.

    Args:
        guess: The coarse state.
        offset: Centroid offset to hold, with the level free.
        sizes: Elements, degree and wave numbers of the nets, where not those of the tube.
    """
    pair = sizes or chosen(guess.tube)
    coarse, fine = (Net(wet, dry * guess.partial, degree, modes) for wet, dry, degree, modes in pair)
    first = strong.newton(strong.taken(guess, coarse), offset)
    return first, strong.newton(strong.taken(first, fine), offset)


def refined(coarse: Array, fine: Array, left: float = LEFT) -> Estimate:
    """Finer values with the error of two grids, and what is left."""
    return on_two_grids(coarse, fine, left)


def paired(table: str, name: str, galerkin: tuple[Array, Array], balance: tuple[Array, Array]) -> Column:
    """Column of Galerkin values, once collocation is found to agree; each at two resolutions.

    Raises:
        DisagreementError: Naming table, column and worst row.
    """
    return joined(table, name, refined(*galerkin), refined(*balance), galerkin)


def joined(table: str, name: str, galerkin: Estimate, balance: Estimate, both: tuple[Array, Array]) -> Column:
    """The same from values whose uncertainties are known."""
    column = agreed(
        table, name, balance, galerkin, text.COLUMNS[name], other="collocation", written="Galerkin"
    )
    gap = float(np.abs(np.subtract(*both)).max())
    column.extra["largest_difference_of_resolutions"] = round_up(gap)
    return column
