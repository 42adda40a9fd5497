"""FEniCSx weak-form verification suite for the inflation and instabilities of hyperelastic membranes.

``solve`` computes a problem at any parameters, ``sweep`` over ranges of them, ``compare`` judges a curve of
another code; ``load`` and ``save`` read and write results. What case files need is in :mod:`weakforms.cases`.
"""

from typing import Any

from weakforms import cases
from weakforms.api import solve
from weakforms.errors import (
    ConvergenceError,
    EnvironmentLackError,
    InputError,
    WeakformsError,
)
from weakforms.results import Quantity, Result
from weakforms.results.io import load_result as load
from weakforms.results.io import save_result as save
from weakforms.scaling import dimensional, nondimensional
from weakforms.verification.crosscheck.compare import compare
from weakforms.verification.run.sweep import sweep

__version__ = "0.1.0"

__all__ = [
    "ConvergenceError",
    "EnvironmentLackError",
    "InputError",
    "Quantity",
    "Result",
    "WeakformsError",
    "cases",
    "compare",
    "dimensional",
    "load",
    "nondimensional",
    "save",
    "solve",
    "sweep",
]


def __dir__() -> list[str]:
    """What a notebook offers after ``weakforms.``: the names for users, not the modules behind them."""
    return sorted([*__all__, "__doc__", "__version__"])


def __getattr__(name: str) -> Any:
    """The names of :mod:`weakforms.cases` are found here too, where case files imported them at first."""
    if name in cases.__all__:
        return getattr(cases, name)
    raise AttributeError(f"module 'weakforms' has no attribute {name!r}")
