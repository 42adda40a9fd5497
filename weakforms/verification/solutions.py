"""Solved results by what was asked for: all that judging a case may look at."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from weakforms.errors import ConvergenceError
from weakforms.results import Branch, Field, Quantity, Result, SpecialPoint, State
from weakforms.verification.specs import At, Spec


class Solutions:
    """Results of a run, looked up by :class:`Spec`; nothing is solved here."""

    def __init__(self, results: Mapping[Spec, Result]) -> None:
        self._results = dict(results)

    def result(self, spec: Spec) -> Result:
        """The stored result.

        Raises:
            ConvergenceError: When solving it failed altogether.
        """
        if spec not in self._results:
            raise ConvergenceError(f"{spec} was not solved")
        return self._results[spec]

    def branch(self, spec: Spec) -> Branch:
        """The primary branch."""
        return self.result(spec).branch()

    def points(self, spec: Spec, kind: str) -> list[SpecialPoint]:
        """Special points of a kind in order."""
        result = self.result(spec)
        for failure in result.failures:
            if failure.what == "special points":
                raise ConvergenceError(f"{spec}: {failure.reason}")
        return result.points(kind)

    def state(self, spec: Spec, at: At) -> State:
        """The state asked for.

        Raises:
            ConvergenceError: When it is not there; says why.
        """
        result = self.result(spec)
        for state in result.states:
            # Values went through JSON as Python floats: equality is exact.
            if state.at == {at.name: at.value} and state.crossing == at.crossing:
                return state
        reasons = [f.reason for f in result.failures if f.what == f"state at {at}"]
        raise ConvergenceError(f"{spec}: no state at {at}: {'; '.join(reasons) or 'not solved'}")

    def quantity(self, spec: Spec, at: At, name: str) -> Quantity:
        """One number of a state."""
        return self.state(spec, at).quantities[name]

    def value(self, spec: Spec, at: At, name: str) -> float:
        """One number of a state, without its uncertainty."""
        return self.quantity(spec, at, name).value

    def profile(self, spec: Spec, at: At) -> Field:
        """Profile of a state."""
        state = self.state(spec, at)
        if not state.fields:
            raise ConvergenceError(f"{spec}: state at {at} was stored without a profile")
        return state.fields[0]

    def sampled(self, spec: Spec, at: At, name: str) -> tuple[np.ndarray, float]:
        """A profile's column at the points ``at.profile`` and its uncertainty."""
        field = self.profile(spec, at)
        where = np.asarray(at.profile)
        index = np.searchsorted(field.columns["Z"], where - 1e-12)
        return field.columns[name][index], field.uncertainty[name]
