"""FEniCSx weak-form verification suite for the inflation and instabilities of hyperelastic membranes."""

from weakforms.api import cases, solve
from weakforms.errors import (
    ConvergenceError,
    EnvironmentLackError,
    InputError,
    WeakformsError,
)
from weakforms.verification.case import (
    Axis,
    Case,
    Claim,
    Constant,
    Count,
    Curve,
    Finding,
    Order,
    Panel,
    Points,
    Printed,
    PrintedExact,
)
from weakforms.verification.compare import compare
from weakforms.verification.references import load as reference
from weakforms.verification.solutions import Solutions
from weakforms.verification.specs import At, Spec, tube, tube_fold, tube_scheme

__version__ = "0.1.0"

__all__ = [
    "At",
    "Axis",
    "Case",
    "Claim",
    "Constant",
    "ConvergenceError",
    "Count",
    "Curve",
    "EnvironmentLackError",
    "Finding",
    "InputError",
    "Order",
    "Panel",
    "Points",
    "Printed",
    "PrintedExact",
    "Solutions",
    "Spec",
    "WeakformsError",
    "cases",
    "compare",
    "reference",
    "solve",
    "tube",
    "tube_fold",
    "tube_scheme",
]
