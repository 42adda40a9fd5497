"""What a case file needs: problems as plain values, panels of a figure, checks, claims and their decisions.

``weakforms.cases()`` lists the ids of all cases, so that this module can also be called.
"""

from __future__ import annotations

import sys
from types import ModuleType

from weakforms import api
from weakforms.verification.cases.case import Case
from weakforms.verification.cases.panels import Axis, Dashed, Line, Panel, Surface
from weakforms.verification.cases.references import load as reference
from weakforms.verification.cases.specs import MAKERS, At, Spec
from weakforms.verification.judging import continuity, decide
from weakforms.verification.judging.checks.curve import Curve
from weakforms.verification.judging.checks.order import Order
from weakforms.verification.judging.checks.path import Path
from weakforms.verification.judging.checks.points import Count, Points, States
from weakforms.verification.judging.checks.printed import Printed, PrintedExact, PrintedInput, PrintedState
from weakforms.verification.judging.checks.readings import CutOff, Misprint, OnGrid
from weakforms.verification.judging.checks.statements import Claim, Constant
from weakforms.verification.judging.decide import Finding
from weakforms.verification.run.solutions import Solutions

__all__ = [
    "At",
    "Axis",
    "Case",
    "Claim",
    "Constant",
    "Count",
    "Curve",
    "CutOff",
    "Dashed",
    "Finding",
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
    "continuity",
    "decide",
    "reference",
]

# Every problem is a function of its name: ``tube(alpha=0.1)`` is its specification at parameters.
if taken := sorted(MAKERS.keys() & globals().keys()):
    raise ImportError(f"a problem cannot be called {taken[0]!r}: this module has that name already")
globals().update(MAKERS)
__all__ += list(MAKERS)


class _Callable(ModuleType):
    """A module that can be called; the call is part of the public interface."""

    def __call__(self) -> list[str]:
        """Ids of all cases."""
        return api.cases()


sys.modules[__name__].__class__ = _Callable
