"""The plan of a run: the checks of its cases, and every solution with its states once."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from weakforms.verification.cases.case import Case
from weakforms.verification.cases.discovery import FoundCase
from weakforms.verification.cases.specs import At, Spec
from weakforms.verification.judging import surfaces
from weakforms.verification.judging.checks.check import Check
from weakforms.verification.judging.consistency import marks
from weakforms.verification.judging.consistency.identities import Identities
from weakforms.verification.judging.consistency.table_traces import TableTrace
from weakforms.verification.judging.consistency.traces import Trace


@dataclass
class Plan:
    """Every solution that a set of cases needs, once, with all its requested states."""

    states: dict[Spec, list[At]]
    by_case: dict[str, list[Spec]]

    @classmethod
    def of(cls, cases: Iterable[FoundCase]) -> Plan:
        """Collect the solutions of the cases; reference tables are read and checked here, before any solve.

        Slow cases come first, so that no long solution is left at the end of a parallel run.
        """
        states: dict[Spec, list[At]] = {}
        by_case: dict[str, list[Spec]] = {}
        for found in sorted(cases, key=lambda found: not found.case.slow):
            check_ids(found)
            needed = []
            for spec, at in case_wants(found):
                listed = states.setdefault(spec, [])
                if at is not None and at not in listed:
                    listed.append(at)
                if spec not in needed:
                    needed.append(spec)
            by_case[found.id] = needed
        return cls({spec: _merge(ats) for spec, ats in states.items()}, by_case)


def case_wants(found: FoundCase) -> list[tuple[Spec, At | None]]:
    """All solutions and states of one case."""
    case = found.case
    out = [want for check in _written(case) for want in check.wants(found.paper)]
    return out + [want for surface in case.surfaces for want in surfaces.surface_wants(surface)]


def checks_of(found: FoundCase) -> list[Check]:
    """All checks of a case: first the checks in its file, then the checks of every solution."""
    drawn = [TableTrace(curve) for panel in found.case.panels for curve in panel.curves]
    specs = dict.fromkeys(spec for spec, _ in case_wants(found))
    return [*_written(found.case), *drawn, *(of(spec) for spec in specs for of in (Trace, Identities))]


def _written(case: Case) -> list[Check]:
    """The checks in the case's file."""
    return [*(drawn for panel in case.panels for drawn in (*panel.curves, *panel.paths)), *case.checks]


def check_ids(found: FoundCase) -> list[str]:
    """Names of the verdicts of a case, which are known before anything is solved."""
    stated = [name for check in checks_of(found) for name in check.names(found.paper)]
    pictures = [name for panel in found.case.panels for name in marks.names(found.paper, panel)]
    return list(dict.fromkeys([*stated, *pictures]))


def _merge(ats: list[At]) -> list[At]:
    """One request for each state, sampled at the union of its requested points."""
    merged: dict[tuple[str, float, int, str], tuple[float, ...] | None] = {}
    for at in ats:
        key = (at.name, at.value, at.crossing, at.branch)
        points = merged.get(key)
        if at.profile is not None:
            # An empty tuple requests the default points of the problem, which are added for every picture.
            points = tuple(sorted({*(points or ()), *at.profile}))
        merged[key] = points
    return [At(*key[:3], profile=points, branch=key[3]) for key, points in merged.items()]
