"""The verdicts on a curve of another code, with their JSON."""

from __future__ import annotations

import json
from dataclasses import dataclass, fields
from typing import Any

from weakforms.verification.crosscheck.convergence import Convergence
from weakforms.verification.crosscheck.rows import EXIT_STATUS, FAILED, NOT_JUDGED, PASSED, ColumnVerdict
from weakforms.verification.judging.outcome import PanelOutcome

SCHEMA = "weakforms.verdicts/1"
STATED = (
    *("check", "kind", "passed", "statement", "detail", "error", "bound", "asked"),
    *("reference_uncertainty", "where", "reference"),
    *("status", "column", "judged_rows", "signed_error", "row", "largest", "scale", "scale_floor", "units"),
    *("reached", "claim", "trend", "causes", "rows_judged"),
)
"""Entry of the JSON of a verdict: the uncertainty of the curve is unknown."""


@dataclass(frozen=True)
class Verdicts:
    """Verdicts on a curve of another code, one for each column, and the part of the table that it covers."""

    case: str
    curve: str
    abscissa: str
    covered: tuple[float, float]
    """Range of the abscissa that was judged."""
    table: tuple[float, float]
    """Range of the abscissa in the table."""
    rows: int
    ignored_rows: int
    """Number of rows of the curve outside the table's range."""
    unjudged_rows: dict[str, int]
    """For each column, the number of rows where the table is too coarse for the accuracy asked."""
    table_rows: int
    met_rows: int
    """Number of rows of the table that the curve covers."""
    missing: tuple[str, ...]
    """Columns to be judged that the curve does not have."""
    left_out: tuple[str, ...]
    """Columns of the table that were not to be judged."""
    claimed: float | None
    """Accuracy that the caller claims; without one no column passes but by what is asked of our own code."""
    verdicts: tuple[ColumnVerdict, ...]
    pictures: tuple[PanelOutcome, ...]
    """For each judged column the curve, the table, and the error of every row with its bound."""
    convergence: tuple[Convergence, ...] = ()
    """For each column the order and the limit, if curves of several meshes were given."""

    @property
    def status(self) -> str:
        """``failed`` if any column is out of bounds, ``passed`` if all are within, else ``not judged``.

        Of several curves the limit is judged, and the finest curve too if an accuracy is claimed.
        """
        single = [
            v.status for v in self.verdicts if not self.convergence or v.asked is not None or v.error is None
        ]
        kinds = {*single, *(found.status for found in self.convergence)}
        if FAILED in kinds:
            return FAILED
        return PASSED if kinds == {PASSED} else NOT_JUDGED

    @property
    def exit_status(self) -> int:
        """Exit status of a command with this verdict: 0 passed, 1 failed, 5 not judged."""
        return EXIT_STATUS[self.status]

    @property
    def passed(self) -> bool:
        """Whether every column is judged and within its bound."""
        return self.status == PASSED

    @property
    def extent(self) -> str:
        """The judged part of the table, in words."""
        if not self.partial:
            return "all of it is judged"
        return f"part of it is judged, {self.met_rows} of {self.table_rows} rows are covered"

    @property
    def partial(self) -> bool:
        """Whether the curve leaves part of the table unjudged."""
        return (
            self.covered != self.table or self.met_rows < self.table_rows or any(self.unjudged_rows.values())
        )

    def to_json(self) -> dict[str, Any]:
        """JSON object of schema ``weakforms.verdicts/1``, without the pictures."""
        shown = {
            f.name: getattr(self, f.name)
            for f in fields(self)
            if f.name not in ("pictures", "verdicts", "convergence")
        }
        verdicts = [{name: getattr(verdict, name) for name in STATED} for verdict in self.verdicts]
        head = {"schema": SCHEMA, "passed": self.passed, "status": self.status, "partial": self.partial}
        orders = [found.to_json() for found in self.convergence]
        more = {"convergence": orders} if orders else {}
        return json.loads(json.dumps({**head, **shown, "verdicts": verdicts, **more}))
