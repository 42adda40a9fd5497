"""States as values, and the forms of a mesh that are lent to one state at a time."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np
from dolfinx import fem

from weakforms.solvers.equilibrium.formulation import Formulation


@dataclass
class State:
    """Owned degrees of freedom of this rank and the scalar loads, the same on every rank."""

    u: np.ndarray
    loads: dict[str, float]
    marks: Any = None
    """Choices that are no numbers, such as which blocks are wrinkled: what :attr:`Formulation.mark` takes."""

    def copy(self) -> State:
        """An independent copy."""
        return State(self.u.copy(), dict(self.loads), self.marks)


class NoStateError(AssertionError):
    """Something was read from forms that are not lent to a state: an error of the program."""


class Lendable:
    """Unknown, loads and marks of forms, which belong to one state only, and only inside of :meth:`at`.

    All states of a mesh share its forms. Outside of every context the unknown is not a number: what is
    assembled or sampled there is not a number either, and the methods of a system raise
    :class:`NoStateError`.

    Attributes:
        initial: What the forms held when they were made: a first guess.
    """

    def __init__(self, formulation: Formulation) -> None:
        self.formulation = formulation
        self.unknown = formulation.unknown
        # A view: dolfinx needs 2 to 4 µs for each, and a point of a branch would need about thirty.
        self._everywhere = self.unknown.x.array
        self._owned = self._everywhere[: self.unknown.x.petsc_vec.getLocalSize()]
        constants = {k: load for k, (load, _) in formulation.loads.items() if isinstance(load, fem.Constant)}
        self._constants = {name: constant.value for name, constant in constants.items()}
        self._marks: Any = None
        self._depth = 0
        self.initial = self._held()

    @property
    def load_names(self) -> tuple[str, ...]:
        """Names of the scalars that may become unknowns."""
        return tuple(self.formulation.loads)

    @property
    def is_lent(self) -> bool:
        """Whether the forms belong to a state."""
        return self._depth > 0

    def require_lent(self) -> None:
        """Make sure that the forms belong to a state.

        Raises:
            NoStateError: If they do not.
        """
        if not self.is_lent:
            raise NoStateError("these forms belong to no state; read them inside 'with system.at(state):'")

    @contextmanager
    def at(self, state: State) -> Iterator[None]:
        """Lend the forms to a state: inside, everything that is assembled or sampled belongs to it.

        Afterwards they belong to the state of the enclosing context again, or to none.

        Raises:
            ValueError: If the state lacks a load or its marks, which another state would then provide.
        """
        self._require_whole(state)
        outer = self._held() if self.is_lent else None
        before = self._everywhere.copy()
        self._write(state.u, state.loads)
        self._mark(state.marks)
        self._depth += 1
        try:
            yield
        finally:
            # No communication, because an exception may have ended the context on one rank only.
            self._depth -= 1
            self._everywhere[:] = before
            if outer is not None:
                self._write_loads(outer.loads)
                self._mark(outer.marks)

    def rewrite(self, u: np.ndarray, loads: Mapping[str, float]) -> None:
        """Change the lent state, for Newton's method; loads that are not given stay.

        Raises:
            NoStateError: Outside of :meth:`at`.
        """
        self.require_lent()
        self._write(u, loads)

    def state(self) -> State:
        """Copy of the lent state.

        Raises:
            NoStateError: Outside of :meth:`at`.
        """
        self.require_lent()
        return self._held()

    def owned(self) -> np.ndarray:
        """View of the lent state's degrees of freedom that this rank owns.

        Raises:
            NoStateError: Outside of :meth:`at`.
        """
        self.require_lent()
        return self._owned

    def load(self, name: str) -> float:
        """One scalar of the lent state.

        Raises:
            NoStateError: Outside of :meth:`at`.
        """
        self.require_lent()
        return self._load(name)

    # -- what is private to this class and to systems with other loads -------------------------

    def _require_whole(self, state: State) -> None:
        missing = self.formulation.loads.keys() - state.loads.keys()
        if missing or (self.formulation.mark is not None and state.marks is None):
            raise ValueError(f"a state without {', '.join(sorted(missing)) or 'marks'}")

    def _held(self) -> State:
        return State(self._owned.copy(), {n: self._load(n) for n in self.formulation.loads}, self._marks)

    def _load(self, name: str) -> float:
        known = self._constants.get(name)
        return float(self.formulation.loads[name][0].value) if known is None else known.item()

    def _write(self, u: np.ndarray, loads: Mapping[str, float]) -> None:
        self._owned[:] = u
        self.unknown.x.scatter_forward()
        self._write_loads(loads)

    def _write_loads(self, loads: Mapping[str, float]) -> None:
        for name, value in loads.items():
            if name in self._constants:
                self._constants[name].fill(value)
            else:  # a point of a moving mesh
                self.formulation.loads[name][0].value = value

    def _mark(self, marks: Any) -> None:
        if self.formulation.mark is not None and marks is not None:
            self.formulation.mark(marks)
        self._marks = marks

    def _give_up(self) -> None:
        """Belong to no state."""
        self._everywhere[:] = np.nan
