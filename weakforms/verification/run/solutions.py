"""Results by specification, from which cases are judged."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np

from weakforms.errors import ConvergenceError
from weakforms.results import Branch, Field, Quantity, Result, SpecialPoint, State
from weakforms.verification.cases.specs import At, Spec
from weakforms.verification.judging.numbers import Number, number, of_point, stack


class Solutions:
    """Results of a run, looked up by :class:`Spec`; nothing is solved here."""

    def __init__(self, results: Mapping[Spec, Result]) -> None:
        self._results = dict(results)

    def result(self, spec: Spec) -> Result:
        """The stored result.

        Raises:
            ConvergenceError: If solving it failed altogether.
        """
        if spec not in self._results:
            raise ConvergenceError(f"{spec} was not solved")
        return self._results[spec]

    def branch(self, spec: Spec, name: str = "primary") -> Branch:
        """A branch by its name.

        Raises:
            ConvergenceError: If the solution has none of that name.
        """
        try:
            return self.result(spec).branch(name)
        except KeyError as error:
            raise ConvergenceError(f"{spec}: {error.args[0]}") from error

    def points(self, spec: Spec, kind: str) -> list[SpecialPoint]:
        """Special points of a kind in order; ``quantity`` has one, the quantities of the whole problem."""
        result = self.result(spec)
        if kind == "quantity":
            known = {name: q for name, q in result.quantities.items() if q.uncertainty is not None}
            values = {name: q.value for name, q in known.items()}
            return [SpecialPoint(kind, "", "", values, {name: q.uncertainty for name, q in known.items()})]
        for failure in result.failures:
            if failure.what == "special points":
                raise ConvergenceError(f"{spec}: {failure.reason}")
        return result.points(kind)

    def state(self, spec: Spec, at: At) -> State:
        """The requested state.

        Raises:
            ConvergenceError: If it is missing; the message says why.
        """
        result = self.result(spec)
        for state in result.states:
            # JSON keeps Python floats exactly, so that equality is exact.
            same = state.crossing == at.crossing and state.branch == at.branch
            if same and state.at == {at.name: at.value}:
                return state
        reasons = [f.reason for f in result.failures if f.what == f"state at {at}"]
        raise ConvergenceError(f"{spec}: no state at {at}: {'; '.join(reasons) or 'not solved'}")

    def quantity(self, spec: Spec, at: At, name: str) -> Quantity:
        """One number of a state."""
        return self.state(spec, at).quantities[name]

    def value(self, spec: Spec, at: At, name: str) -> float:
        """One number of a state, without its uncertainty."""
        return self.quantity(spec, at, name).value

    def number(self, spec: Spec, at: At, name: str) -> Number:
        """One number of a state, with its uncertainty."""
        return number(self.quantity(spec, at, name))

    def numbers(self, spec: Spec, ats: Iterable[At], name: str) -> Number:
        """One number of several states."""
        return stack(self.number(spec, at, name) for at in ats)

    def whole(self, spec: Spec, name: str) -> Number:
        """One number of a whole problem, with its uncertainty."""
        return number(self.result(spec).quantities[name])

    def point(self, spec: Spec, kind: str, name: str, index: int = 0) -> Number:
        """One number of a special point, with its uncertainty.

        Raises:
            IndexError: If there are fewer points of the kind.
        """
        return of_point(self.points(spec, kind)[index], name)

    def along(self, spec: Spec, name: str, branch: str = "primary") -> Number:
        """A column of a branch, with the largest uncertainty of the states and points on that branch.

        The trace is computed on the finest of the meshes for states and special points. Without any of these
        the uncertainty is NaN, and nothing can be decided.
        """
        result = self.result(spec)
        known = [s.quantities[name] for s in result.states if s.branch == branch and name in s.quantities]
        points = [p for p in result.special_points if p.branch == branch and name in p.values]
        spreads = [number(q).uncertainty for q in known] + [of_point(p, name).uncertainty for p in points]
        return Number(self.branch(spec, branch).columns[name], max(spreads, default=np.nan))

    def samples(self, spec: Spec, at: At, name: str) -> Number:
        """A profile's column at the points ``at.profile``, with its uncertainty."""
        return Number(*self.sampled(spec, at, name))

    def column(self, spec: Spec, at: At, name: str) -> Number:
        """A profile's whole column, with its uncertainty."""
        field = self.profile(spec, at)
        return Number(field.columns[name], field.uncertainty[name])

    def profile(self, spec: Spec, at: At) -> Field:
        """Profile of a state."""
        state = self.state(spec, at)
        if not state.fields:
            raise ConvergenceError(f"{spec}: state at {at} was stored without a profile")
        field = next((f for f in state.fields if at.field in ("", f.name)), None)
        if field is None:
            raise ConvergenceError(f"{spec}: state at {at} has no field {at.field!r}")
        return field if at.theta is None else _meridian(field, at.theta)

    def sampled(self, spec: Spec, at: At, name: str) -> tuple[np.ndarray, float | np.ndarray]:
        """A profile's column at the points ``at.profile``, and its uncertainty or uncertainties."""
        field = self.profile(spec, at)
        where = np.asarray(at.profile)
        abscissa = next(iter(field.columns))  # the first column of a field is its abscissa
        index = np.searchsorted(field.columns[abscissa], where - 1e-12)
        found = field.at(index)
        return found.columns[name], found.uncertainty[name]


def _meridian(field: Field, theta: float) -> Field:
    """The rows of a surface's field on one meridian.

    Raises:
        ConvergenceError: If the field has none there.
    """
    rows = np.isclose(field.columns["Theta"], theta, rtol=0, atol=1e-9)
    if not rows.any():
        raise ConvergenceError(f"the {field.name} has no meridian at Theta = {theta:g}")
    return field.at(rows)
