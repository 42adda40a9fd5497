"""FEniCSx weak-form verification suite for the inflation and instabilities of hyperelastic membranes."""

from weakforms.api import cases, solve
from weakforms.errors import (
    ConvergenceError,
    EnvironmentLackError,
    InputError,
    WeakformsError,
)
from weakforms.scaling import dimensional, nondimensional
from weakforms.verification.cases.case import Case
from weakforms.verification.cases.panels import Axis, Dashed, Line, Panel, Path, Surface
from weakforms.verification.cases.references import load as reference
from weakforms.verification.cases.specs import (
    At,
    Spec,
    circular,
    circular_scheme,
    fluid_tube,
    fluid_tube_coincidence,
    fluid_tube_surface,
    hemisphere,
    homogeneous,
    infinite_tube,
    material,
    sphere,
    surface,
    tube,
    tube_fold,
    tube_scheme,
    wrinkled_bending,
    wrinkled_linear,
    wrinkled_material,
    wrinkled_patch,
    wrinkled_sheet,
    wrinkled_tube,
    wrinkled_tube_threshold,
)
from weakforms.verification.crosscheck.compare import compare
from weakforms.verification.judging import continuity, decide
from weakforms.verification.judging.checks.curve import Curve
from weakforms.verification.judging.checks.order import Order
from weakforms.verification.judging.checks.points import Count, Points, States
from weakforms.verification.judging.checks.printed import Printed, PrintedExact, PrintedInput, PrintedState
from weakforms.verification.judging.checks.readings import CutOff, Misprint, OnGrid
from weakforms.verification.judging.checks.statements import Claim, Constant
from weakforms.verification.judging.decide import Finding
from weakforms.verification.run.solutions import Solutions

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
    "CutOff",
    "Dashed",
    "EnvironmentLackError",
    "Finding",
    "InputError",
    "Line",
    "Misprint",
    "OnGrid",
    "Order",
    "Panel",
    "Path",
    "Points",
    "Printed",
    "PrintedExact",
    "PrintedInput",
    "PrintedState",
    "Solutions",
    "Spec",
    "States",
    "Surface",
    "WeakformsError",
    "cases",
    "circular",
    "circular_scheme",
    "compare",
    "continuity",
    "decide",
    "dimensional",
    "fluid_tube",
    "fluid_tube_coincidence",
    "fluid_tube_surface",
    "hemisphere",
    "homogeneous",
    "infinite_tube",
    "material",
    "nondimensional",
    "reference",
    "solve",
    "sphere",
    "surface",
    "tube",
    "tube_fold",
    "tube_scheme",
    "wrinkled_bending",
    "wrinkled_linear",
    "wrinkled_material",
    "wrinkled_patch",
    "wrinkled_sheet",
    "wrinkled_tube",
    "wrinkled_tube_threshold",
]
