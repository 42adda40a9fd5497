r"""The verdict on curves of several meshes: their order, their limit, and whether the limit is the table.

For three meshes whose cells are :math:`r` times as small each time, the curves :math:`c_1, c_2, c_3` of a
code of order :math:`p` satisfy :math:`c_2 - c_1 = r^p (c_3 - c_2)`, and their limit is

.. math:: c = c_3 + \frac{c_3 - c_2}{r^p - 1}.

(Richardson's extrapolation; see Roache, Verification and Validation in Computational Science and Engineering,
1998.) The order is observed: one number for the whole curve, from the mean squares of both differences. The
limit's uncertainty is the larger of two differences: between the limits of meshes 1, 2 and of meshes 2, 3
with this order, which vanishes only if every row converges alike, and between the limits with this order and
with the whole number next to it, which vanishes only if the meshes show the order of the method.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from weakforms.errors import InputError
from weakforms.verification.crosscheck.rows import FAILED, NOT_JUDGED, PASSED, JudgedColumn
from weakforms.verification.report.wording import scientific, signed

RATIO = 2.0
"""Default ratio of the sizes of cells of two meshes in succession."""

FEWEST = 3
"""Number of meshes from which an order is observed."""


@dataclass(frozen=True)
class Convergence:
    """The order and the limit of one column over several meshes."""

    column: str
    status: str
    """passed: the curves converge, and their limit is the table within the bound; failed; or not judged."""
    errors: tuple[float, ...]
    """Largest error of each mesh, coarse to fine, relative to the table."""
    order: float | None
    """Observed order of convergence; ``None`` if the differences do not shrink."""
    order_range: tuple[float, float] | None
    """First and last tenth of the orders of single rows."""
    limit_error: float | None = None
    """Error of the limit where its ratio to the bound is largest, with its sign."""
    limit_bound: float | None = None
    """Twice the combined uncertainty of limit and table there."""
    where: str = ""
    detail: str = ""

    @property
    def text(self) -> str:
        """The errors of the meshes, the order and the limit in one line."""
        text = f"largest error of each mesh {', '.join(map(scientific, self.errors))}"
        if self.order is not None and self.order_range is not None:
            text += "; order {:.2f} (single rows {:.1f} to {:.1f})".format(self.order, *self.order_range)
        if self.limit_error is not None:
            text += f"; error of the limit {signed(self.limit_error)}, bound {scientific(self.limit_bound)}"
            text += f" at {self.where}"
        return text + (f"; {self.detail}" if self.detail else "")

    def to_json(self) -> dict[str, Any]:
        """JSON object, an entry ``convergence`` of schema ``weakforms.verdicts/1``."""
        return asdict(self)


def require_meshes(count: int, ratio: float) -> None:
    """Make sure that an order can be observed.

    Raises:
        InputError: If there are too few meshes, or the ratio is not above 1.
    """
    if count < FEWEST:
        raise InputError(f"{count} curves: an order of convergence needs {FEWEST}, from coarse to fine")
    if not 1 < ratio <= 100:
        raise InputError(
            f"ratio = {ratio:g}: the cells of a mesh must be smaller than those of the one before"
        )


def judge_convergence(
    column: str, over: str, judged: Sequence[JudgedColumn], ratio: float, accuracy: float | None
) -> Convergence:
    """Judge the order and the limit of a column.

    The errors of the coarser curves are interpolated to the rows of the finest. Errors are smooth and small,
    so that the curves may have different rows.

    Args:
        column: Name of the column.
        over: Name of the abscissa.
        judged: The column on each mesh, coarse to fine.
        ratio: Size of the cells of a mesh over the size on the next one.
        accuracy: Accuracy that the finest curve claims; the limit must then be at least so certain.
    """
    fine = judged[-1]
    x = fine.x
    inside = np.ones(len(x), dtype=bool)
    for other in judged[:-1]:
        inside &= (x >= other.x.min()) & (x <= other.x.max())
    errors = tuple(float(np.abs(j.error).max()) for j in judged)
    if inside.sum() < FEWEST:
        return Convergence(column, NOT_JUDGED, errors, None, None, detail="the meshes have no rows in common")
    e = [_at(j, x[inside]) for j in judged[-FEWEST:]]
    first, second = e[1] - e[0], e[2] - e[1]
    order, spread = _order(first, second, ratio)
    known = fine.known[inside]
    if order is None:
        within = bool(np.all(np.abs(e[2]) <= 2 * known))  # converged long ago: only round-off differs
        detail = "the curves of the meshes do not approach each other"
        return Convergence(
            column, PASSED if within else FAILED, errors, None, spread, detail=detail * (not within)
        )
    factor, whole = (1 / (ratio**p - 1) for p in (order, max(1, round(order))))
    limit, coarser = e[2] + second * factor, e[1] + first * factor
    uncertainty = np.maximum(np.abs(limit - coarser), np.abs(second * (factor - whole)))
    bound = 2 * np.hypot(uncertainty, known)
    widest = max(accuracy or errors[-1], 4 * float(known.max()))
    told = bound <= widest
    i = int(np.argmax(np.abs(limit) / np.where(bound > 0, bound, np.finfo(float).tiny)))
    if np.any(np.abs(limit) > bound):
        status, detail = FAILED, "the curves converge, but not to the table"
    elif told.sum() > len(told) / 2:
        status, detail = PASSED, ""
    else:
        status, detail = NOT_JUDGED, "the limit is too uncertain: the meshes are too coarse for their order"
    place = f"{over} = {x[inside][i]:g}"
    return Convergence(column, status, errors, order, spread, float(limit[i]), float(bound[i]), place, detail)


def _at(judged: JudgedColumn, x: np.ndarray) -> np.ndarray:
    """The error of a curve at other rows."""
    order = np.argsort(judged.x)
    rows, error = judged.x[order], judged.error[order]
    if np.isin(x, rows).all():
        return error[np.searchsorted(rows, x)]
    from scipy.interpolate import make_interp_spline  # above, it would slow the start of every command

    return make_interp_spline(rows, error, k=min(3, len(rows) - 1))(x)


def _order(
    first: np.ndarray, second: np.ndarray, ratio: float
) -> tuple[float | None, tuple[float, float] | None]:
    """The order of all rows together, and the range of the orders of single rows."""
    sizes = float(np.linalg.norm(first)), float(np.linalg.norm(second))
    with np.errstate(divide="ignore", invalid="ignore"):
        single = np.log(np.abs(first / second)) / math.log(ratio)
    single = single[np.isfinite(single)]
    spread = tuple(float(q) for q in np.quantile(single, (0.1, 0.9))) if len(single) else None
    if not 0 < sizes[1] < sizes[0]:
        return None, spread
    return math.log(sizes[0] / sizes[1]) / math.log(ratio), spread
