"""Results: branches, special points, states and fields, to and from JSON and CSV. Needs numpy only."""

from weakforms.results.curves import CurveFile, read_curve
from weakforms.results.io import load_result, validate, write_atomically
from weakforms.results.model import (
    OF_LONG_WAVES,
    SYMMETRY_BREAKING,
    TWO_CONDITIONS,
    WITH_WAVES,
    Absence,
    Branch,
    Ended,
    Failure,
    Field,
    Quantity,
    SpecialPoint,
    State,
)
from weakforms.results.result import Result

__all__ = [
    "OF_LONG_WAVES",
    "SYMMETRY_BREAKING",
    "TWO_CONDITIONS",
    "WITH_WAVES",
    "Absence",
    "Branch",
    "CurveFile",
    "Ended",
    "Failure",
    "Field",
    "Quantity",
    "Result",
    "SpecialPoint",
    "State",
    "load_result",
    "read_curve",
    "validate",
    "write_atomically",
]
