"""A case: what a figure, table or statement of a paper says, as checks and pictures."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from weakforms.verification.cases.panels import Panel, Surface
from weakforms.verification.judging.checks.check import Check
from weakforms.verification.judging.checks.curve import Curve


@dataclass(frozen=True)
class Case:
    """One figure, table or statement of a paper: what is drawn, what is checked, how accurately."""

    title: str
    source: str
    panels: tuple[Panel, ...] = ()
    surfaces: tuple[Surface, ...] = ()
    checks: tuple[Check, ...] = ()
    asked: Mapping[str, float] = field(default_factory=dict)
    """Relative accuracy wanted of each column of the curves' reference tables."""
    quick: bool = False
    """Part of the quick profile, whose cases take three minutes together."""
    slow: bool = False
    """Takes minutes by itself: left to ``verify`` and to the tests marked slow."""
    tags: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Curves that state no accuracy of their own have the case's."""

        def complete(curve: Curve) -> Curve:
            return replace(curve, asked=self.asked) if curve.asked is None else curve

        panels = [replace(p, curves=tuple(complete(c) for c in p.curves)) for p in self.panels]
        object.__setattr__(self, "panels", tuple(panels))
