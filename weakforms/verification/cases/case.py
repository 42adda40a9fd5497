"""A case: a figure, table or statement of a paper, as checks and pictures."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from weakforms.verification.cases.panels import Panel, Surface
from weakforms.verification.judging.checks.check import Check
from weakforms.verification.judging.checks.curve import Curve
from weakforms.verification.judging.checks.path import Path


@dataclass(frozen=True)
class Case:
    """One figure, table or statement of a paper: its panels, its checks, and their accuracy."""

    title: str
    source: str
    panels: tuple[Panel, ...] = ()
    surfaces: tuple[Surface, ...] = ()
    checks: tuple[Check, ...] = ()
    asked: Mapping[str, float] = field(default_factory=dict)
    """Relative accuracy wanted of each column of the curves' reference tables."""
    quick: bool = False
    """Whether it belongs to the quick profile, whose cases take three minutes together."""
    slow: bool = False
    """Whether only ``verify`` and the tests marked slow run it: it takes half a minute or more, and shows no
    figure or table of a paper."""
    tags: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Give curves and paths without an accuracy the accuracy of the case."""

        def complete(drawn: tuple[Curve | Path, ...]) -> tuple[Curve | Path, ...]:
            return tuple(replace(d, asked=self.asked) if d.asked is None else d for d in drawn)

        panels = [replace(p, curves=complete(p.curves), paths=complete(p.paths)) for p in self.panels]
        object.__setattr__(self, "panels", tuple(panels))
