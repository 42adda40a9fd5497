"""A judged column as a panel: the curve, the table, and the error of every row with its bound."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from weakforms.problems.registry import symbol
from weakforms.verification.cases.panels import Panel
from weakforms.verification.cases.references import Reference
from weakforms.verification.crosscheck.rows import JudgedColumn
from weakforms.verification.judging.outcome import CurveOutcome, PanelOutcome


def picture(
    table: Reference, own: Mapping[str, np.ndarray], judged: JudgedColumn, panels: Sequence[Panel]
) -> PanelOutcome:
    """The column over the table's abscissa; on the paper's axes, if the case has such a figure."""
    over, column = table.abscissa, judged.verdict.column
    paper = next((p for p in panels if (p.x.name, p.y.name) == (over, column)), None)
    labels = [symbol(name) or name.replace("_", " ") for name in (over, column)]
    ranges = [_range(table.columns[name], own[name]) for name in (over, column)]
    if paper is not None:
        ranges = [(axis.low, axis.high) for axis in (paper.x, paper.y)]
    return PanelOutcome(
        name=column,
        title=f"{column} of the curve against {table.name}",
        x=over,
        y=column,
        x_label=labels[0],
        y_label=labels[1],
        x_range=ranges[0],
        y_range=ranges[1],
        drawn="the curve",
        curves=[
            CurveOutcome(
                name=table.name,
                label=table.name,
                x=own[over].tolist(),
                y=own[column].tolist(),
                reference_name=table.name,
                reference_kind=table.kind,
                reference_x=table.columns[over].tolist(),
                reference_y=table.columns[column].tolist(),
                residual_abscissa=over,
                residual_x=judged.x.tolist(),
                residual=np.abs(judged.error).tolist(),
                residual_bound=judged.bound.tolist(),
            )
        ],
    )


def _range(*columns: np.ndarray) -> tuple[float, float]:
    values = np.concatenate(columns)
    margin = 0.03 * float(np.ptp(values))
    return float(values.min()) - margin, float(values.max()) + margin
