"""The branch of a rectangular membrane on one mesh: its start, and what is read at its states."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from weakforms.problems.gas import Gas, folds_of
from weakforms.problems.rectangle.model import RectangleModel
from weakforms.problems.rectangle.readings import Centre, Diagonal
from weakforms.problems.rectangle.start import states_at
from weakforms.problems.triangles.limits import GIVES_WAY, gives_way
from weakforms.problems.triangles.readings import ZERO, AmountHeld, LeastStress
from weakforms.problems.triangles.weak_form import RULE
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, StepControl
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.stability.modes import SecondVariation
from weakforms.solvers.stability.surface_family import FilledBranch

COUNTED = {1: "n_odd_even", 2: "n_even_odd", 3: "n_odd_odd"}
"""Columns of the counts by class; that of the states' own class is ``n_negative``."""


PARTS = {0: ("A1", "B1"), 1: (1,), 3: ("A2", "B2")}
"""Classes of a square, of the group C4v, that a class of the mirrors consists of; 1 is one half of E."""

C4V = {"A1": 1.0, "A2": 2.0, "B1": 3.0, "B2": 4.0, 1: 5.0}
"""Number ``C4v`` of a critical point, by the class of its mode; 5 is the pair E."""


CRITICAL = ("limit_point", "bifurcation_point")
"""Special points at which an eigenvalue is zero with the load held."""


class RectangleModes:
    """What is computed at a state besides its functionals: least stress, stretch, counts by class."""

    def __init__(self, model: RectangleModel, gas: Gas | None = None) -> None:
        self.model = model
        self.square = model.sheet.is_square
        rule = RULE[model.sheet.degree]
        self._points = LeastStress(model.mesh, model.least_stress, rule, mirrored=True)
        self._centre = Centre(model)
        self.amount = "V" if model.sheet.load == "gas" else "V_f"
        self.folds = folds_of(gas)
        self._held = AmountHeld(model.system, model.sheet.control, self.amount, gas)
        self._counted = {} if model.sheet.whole else COUNTED
        self._split = {f"n_{name}": name for name in model.diagonals}
        self.classes = (*model.diagonals, "E") if self._split else ()
        self._diagonal = Diagonal(model) if self._split else None
        self.columns = (
            *("lam1_c", "S_least", "X_least", "Y_least", *self._counted.values(), "n_all"),
            *self._held.columns,
            *self._split,
        )

    @property
    def wave_numbers(self) -> tuple[int | str, ...]:
        """Classes whose zeros are bifurcation points; on a square two of them are copies of each other."""
        if not self._counted:
            return ()
        return (*PARTS[1], *PARTS[3]) if self.square else (1, 2, 3)

    def variation(self, n: int | str) -> SecondVariation:
        """The operator of a class; 0 is that of the states."""
        return self.model.variation(n)

    def observe(self) -> dict[str, float]:
        """The columns at the state that the system is lent to.

        Raises:
            ConvergenceError: If a state of a square has lost the mirrors in its diagonals.
        """
        if self._diagonal is not None:
            self._diagonal.require_mirrored()
        place, least = self._points.least()
        counts = {name: self._count(n) for n, name in self._counted.items()}
        rest, own = sum(counts.values()), self._held.counts()
        whole = dict.fromkeys(PARTS[0], own["n_all"]) | dict.fromkeys(PARTS[3], counts.get(COUNTED[3], 0))
        counts |= {name: count + rest for name, count in own.items()}
        for column, n in self._split.items():  # both parts of a class without negative ones have none
            counts[column] = self.variation(n).negative_count(ZERO) if whole[n] else 0
        return {
            "lam1_c": self._centre.stretch(),
            "S_least": least,
            **dict(zip(("X_least", "Y_least"), place, strict=True)),
            **self._held.mass(),
            **{name: float(count) for name, count in counts.items()},
        }

    def lowest(self) -> dict[str, float]:
        """The lowest eigenvalue in each class of a square, at the state that the system is lent to."""
        classes = {name: self.variation(PARTS[1][0] if name == "E" else name) for name in self.classes}
        return {name: variation.spectrum().eigenvalues[0] for name, variation in classes.items()}

    def breaking(self, n: int) -> float:
        """Number of the class of a square that a critical state's zero eigenvalue belongs to.

        Args:
            n: Class of the mirrors in ``X`` and ``Y``.
        """
        nearest = {part: abs(self.variation(part).nearest().eigenvalue) for part in PARTS[n]}
        return C4V[min(nearest, key=nearest.__getitem__)]

    def _count(self, n: int) -> int:
        return self.model.variation(1 if self.square and n == 2 else n).negative_count(ZERO)


class RectangleBranch(FilledBranch):
    """States of a rectangle; at critical points of a square, the class of C4v of the mode as ``C4v``."""

    modes: RectangleModes

    def special(self) -> list[Solved]:
        """As for any branch."""
        return [self._classed(solved) for solved in super().special()]

    def _classed(self, solved: Solved) -> Solved:
        if not self.modes.model.sheet.has_diagonals or solved.kind not in CRITICAL:
            return solved
        with self.system.at(solved.state):
            breaking = self.modes.breaking(round(solved.values.get("n", 0.0)))
        return replace(solved, values=solved.values | {"C4v": breaking})

    def _named(self, n: int | str, direction: float) -> tuple[str, dict[str, float]]:
        """As for any branch; A2 and B2 are the two parts of the class odd in both."""
        return super()._named(3 if n in PARTS[3] else n, direction)


def traced(
    model: RectangleModel,
    start: float,
    end: float,
    step: float,
    progress: Callable[[], None] = lambda: None,
    gas: Gas | None = None,
) -> RectangleBranch:
    """The branch from a small height of the centre to a larger one.

    Args:
        model: The membrane on one mesh.
        start: Height of the centre at the first point.
        end: Height of the centre at which the branch ends.
        step: Largest step.
        progress: Called at every point.
        gas: The gas inside, if its mass is to be held.
    """
    control = model.sheet.control
    solver = ExtendedNewton(model.system, [control])
    continuation = Continuation(solver, control=StepControl(first=step / 8, largest=step))
    first, *_ = states_at(model, solver, [start])
    begin = continuation.start(first, Held("w_c", start), towards={"w_c": 1.0})

    given = model.sheet.law, model.law, RULE[model.sheet.degree]
    yields = gives_way(model.system, model.membrane.cauchy_green, *given)

    def ends(point: CurvePoint) -> bool:
        progress()
        return point.monitors["w_c"] > end or yields(point.state)

    branch = RectangleBranch(continuation, control, begin, ends, RectangleModes(model, gas))
    branch.end_before(yields, GIVES_WAY)
    return branch
