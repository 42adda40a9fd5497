"""The residual up to which the forces of a state count as balanced."""

from __future__ import annotations

import numpy as np

from weakforms.solvers.equilibrium.system import System

RESIDUAL_LIMIT = 1e-8
"""Residual norm above which no state is accepted if forces are of order one, however small the last step is.
It is also the largest allowed error of a constraint, unless its terms are large (:data:`OF_TERMS`)."""

OF_FORCES = 1e-15, 1e-10
"""Smallest and largest value of this limit, relative to the size of the forces (:meth:`System.force_size`).
The smallest is about 25 times round-off; the largest is the residual of a Newton step at the tolerance."""

OF_TERMS = 1e-14
"""Round-off of a constraint ``g``, relative to the sum of its terms, ``|∂g/∂U| |U| + |∂g/∂λ| |λ|``: about 45
units in the last place. A constraint counts as met to this if the sum is above a million, as for a law that
locks."""


def residual_limit(system: System, enough: float = np.inf) -> float:
    """Residual norm above which a state is refused; the tangent may be from a state close to it.

    Args:
        system: The system, lent to the state.
        enough: A lower bound of the limit serves too, if it is not below this residual: it is cheaper.
    """
    least = _limit(system.least_force_size())
    return least if least >= enough else _limit(system.force_size())


def _limit(forces: float) -> float:
    """The limit for forces of a size; it grows with them."""
    low, high = OF_FORCES
    return min(max(RESIDUAL_LIMIT, low * forces), high * forces)
