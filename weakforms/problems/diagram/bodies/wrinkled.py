r"""The pre-stretched tube of papers 4 and 5 with relaxed energy, in the planes of diagrams.

Its states are those of the problem ``wrinkled_tube`` under gas or liquid. The parts of a branch, and so the
lines, have one pattern of taut and wrinkled zones each; the fronts between them, and the free surface of a
liquid inside of the tube, are scalar unknowns. Where a zone opens or closes, or the surface meets a front or
a ring, lines end. The material coordinate is the fraction ``S = Z/L`` of the meridian, so that the mesh does
not depend on the length; every parameter is a constant of the forms.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cached_property
from itertools import groupby
from math import inf

import numpy as np
import ufl
from mpi4py import MPI

from weakforms.errors import ConvergenceError
from weakforms.forms.materials import SurfaceLaw, stress_resultants, surface_law
from weakforms.problems.diagram.followed import PLACE, Part
from weakforms.problems.material_choice import MOONEY_RIVLIN, Chosen
from weakforms.problems.meridian.blocks import UPPER
from weakforms.problems.meridian.fields import carried
from weakforms.problems.meridian.limits import limit_along
from weakforms.problems.meridian.model import DRY, WET, Marks
from weakforms.problems.wrinkled.body import CYLINDER
from weakforms.problems.wrinkled.branch import WrinkledBranch
from weakforms.problems.wrinkled.fields import Zones
from weakforms.problems.wrinkled.membrane import Membrane, natural_radius
from weakforms.problems.wrinkled.model import WrinkledModel
from weakforms.problems.wrinkled.readings import Readings
from weakforms.problems.wrinkled.state import AtBreak, ZonedState
from weakforms.solvers.continuation.branch import FittedBranch
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, StepControl
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.least import LeastValue
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.modes import SecondVariation

BLOCKS = 8
"""Blocks of a mesh; each zone has as many as any other, give or take one."""

THIN = 1e-3
"""Thinnest zone, as a fraction of the length, with which a part of the branch is looked for."""

CROWDED = 1e5
"""Sum of one over the blocks' widths at which a zone counts as closed: with two blocks it is as thin as
``4e-4`` of the length, with four ``2e-3``."""

WRONG = 1e-8
"""Integral, over ``S``, of how far ``gw`` is on the wrong side of 1, at which a zone has opened. Inside of
another zone the new one then is about ``2e-3`` of the length."""

PLAIN_STEP = 0.5
"""Largest step on the plain mesh, on which zones are found."""

CLOSE = 1e-3
"""Shortest step along a part of the branch: it ends as close to where a zone between others closes, because
the fronts move ever faster there."""

UNIT = replace(
    CYLINDER,
    length=lambda _q: 1.0,
    thickness=lambda s, q: q["L"] * CYLINDER.thickness(s * q["L"], q),
    shape=lambda s, q: CYLINDER.shape(s * q["L"], q),
    scales=lambda q: (1 / q["L"], 1.0),
)
"""The tube over the fraction of its length."""

OPENS = "there a zone opens or closes; lines of other zones are separate"
OPENS_OR_FILLS = "there a zone opens or closes, or the liquid reaches a ring or a front; other lines go on"


class VariedWrinkledTube(WrinkledModel):
    """The tube; its loads are ``p``, ``M``, ``delta``, ``L``, ``Af``, and the constants of the law.

    With a liquid they are ``zw`` and ``gamma`` in place of ``p``. Break points that are neither fronts nor
    the free surface divide the zones between them in fixed ratios.

    Args:
        comm: Ranks.
        material: The law.
        values: First values of ``M``, ``delta``, ``L`` and ``Af``, and of ``gamma`` if there is a liquid.
        cells: Cells of the mesh.
        degree: Degree of the elements.
    """

    depth = "V"

    def __init__(
        self, comm: MPI.Intracomm, material: Chosen, values: Mapping[str, float], cells: int, degree: int
    ) -> None:
        self.anchors: np.ndarray = np.array([], dtype=int)
        self.given = np.linspace(0.0, 1.0, BLOCKS + 1)
        self.liquid = "gamma" in values
        self.control = "zw" if self.liquid else "p"
        body = replace(UNIT, parameters=(*UNIT.parameters, *dict(material.constants)))
        values = {**values, **dict(material.constants)}
        super().__init__(comm, body, values, BLOCKS, max(1, cells // BLOCKS), degree, material=material)
        self.loads |= {name: (_Front(self, k), self._rate) for name, k in self.fronts.items()}

    # -- the moving mesh -----------------------------------------------------------------------

    def mark(self, marks: Marks) -> None:
        """Write the marks of a state into the form; nodes between different marks are unknown."""
        super().mark(marks)
        self.anchors = anchors(marks)
        self.move()

    def spread(self, given: np.ndarray, last: float = 1.0) -> np.ndarray:
        """All break points, from those at fronts and the last one: dense at fronts and ends."""
        nodes = [0, *self.anchors.tolist(), BLOCKS]
        places = [0.0, *given[self.anchors].tolist(), last]
        out = np.empty(BLOCKS + 1)
        for (i, low), (j, high) in zip(
            zip(nodes, places, strict=True), zip(nodes[1:], places[1:], strict=True), strict=False
        ):
            share = (1 - np.cos(np.pi * np.arange(j - i + 1) / (j - i))) / 2
            out[i : j + 1] = low + (high - low) * share
        return out

    def move(self) -> None:
        """Write the break points into the form."""
        self.breaks = self.spread(self.given)
        super().move()

    def aim(self, name: str) -> None:
        """Select one front for derivatives; it moves the break points beside it."""
        rates = np.zeros(BLOCKS + 1)
        if self.fronts.get(name) in self.anchors:
            rates[self.fronts[name]] = 1.0
            rates = self.spread(rates, 0.0)
        self._by_cell["left_rate"].x.array[:] = rates[self._block_of]
        self._by_cell["width_rate"].x.array[:] = np.diff(rates)[self._block_of]

    def breaks_of(self, loads: Mapping[str, float]) -> np.ndarray:
        """All break points of a state, whose marks are written."""
        given = self.given.copy()
        given[self.anchors] = [loads[f"b{k}"] for k in self.anchors]
        return self.spread(given)

    # -- the weak form -------------------------------------------------------------------------

    @cached_property
    def full(self) -> SurfaceLaw:
        """The law without wrinkling, with its constants as loads."""
        names = dict(self.material_law.constants)
        return surface_law(self.material_law.model, {name: self.q[name] for name in names})

    @cached_property
    def resultants(self) -> tuple:
        """Cauchy resultants ``t1, t2`` of the law without wrinkling: ``t2 < 0`` where it wrinkles."""
        return stress_resultants(self.full.stretches, self.expressions["lam1"], self.expressions["lam2"])

    def mass(self) -> ufl.Form:
        """``int |dx|^2`` over the mesh coordinate, which depends on no parameter and on no front."""
        (u, w), (v, y) = ufl.TrialFunction(self.space), ufl.TestFunction(self.space)
        return (u * v + w * y) / BLOCKS * self.dx

    def formulation(self) -> Formulation:
        """The weak form with the least principal resultant, and what says that its marks hold."""
        given, e, (t1, t2) = super().formulation(), self.expressions, self.resultants
        wrong = ufl.max_value(self._by_cell["taut"] * (1 - e["gw"]), 0.0)
        kept = {name: given.monitors[name] for name in ("V", "Pi", "gw", "z")}
        over = {"over": (self.q["zw"] - e["z"]) * self.ends(UPPER)}
        placed = {"rho": e["r"], "eta": e["z"], "lam1": e["lam1"], "lam2": e["lam2"]}
        return replace(
            given,
            monitors=kept
            | {"crowded": 1 / e["width"] * self.dx, "wrong": wrong * e["width"] * self.dx, **over},
            maxima={"minus_t": ufl.max_value(-t1, -t2)},
            derived={"t_min": lambda values: -values["minus_t"]},
            internal=("gw", "z", "crowded", "wrong", "over", "minus_t", *self.fronts),
            profile={**placed, "t1": t1, "t2": t2},
            abscissa="S",
        )

    @cached_property
    def least(self) -> LeastValue:
        """The least principal resultant, whose zero is the onset of wrinkling."""
        return LeastValue(self.system, ufl.min_value(*self.resultants), 2 * self.degree + 1)

    def at_onset(self) -> dict[str, float]:
        """Where the least resultant is."""
        self.least.turn()
        place = self.material(np.array([self.least.place]), self.system.state().loads)[0]
        return {"at_end": int(self.least.at_end), PLACE: float(place)}

    @cached_property
    def limit(self) -> Callable[[State], str]:
        """Why the law takes no more than a state."""
        return limit_along(self)

    def gives_way(self, _point: CurvePoint) -> str:
        """Nothing: lines end at the limit of the law."""
        return ""

    def operators(self, _kind: str) -> dict[int, Callable[[], SecondVariation]]:
        """None."""
        return {}

    # -- parts of the branch -------------------------------------------------------------------

    def part(self, state: State) -> Part:
        """The states with the same zones, and with the free surface in the same one."""
        wet, bounds = state.marks.wet, [("wrong", WRONG, 1), ("crowded", CROWDED, 1)]
        fronts = {
            f"b{k}": AtBreak(self, "gw", k) if wet[k - 1] == wet[k] else AtBreak(self, "z", k, minus="zw")
            for k in anchors(state.marks).tolist()
        }
        if wet[-1] == WET:
            bounds.append(("over", 0.0, -1))
        return Part(fronts, tuple(bounds), OPENS_OR_FILLS if self.liquid else OPENS, _in_order)

    def primary(self, end: float, step: float) -> list[FittedBranch]:
        """Parts of the branch over the load at the loads of the initial state, up to ``V = end``.

        Their zones are those of a trace on a plain mesh. A tube without liquid is left out.

        Raises:
            ConvergenceError: If the trace does not come so far.
        """
        loads = self.system.initial.loads
        membrane = self._membrane(loads)
        least = loads["delta"] * loads["L"] * min(loads["Af"], natural_radius(loads["delta"])) ** 2 / 2
        trace = _Trace(membrane, inf, end / least, PLAIN_STEP, Readings(membrane, 2.0)).trace
        if trace.stalled:
            raise ConvergenceError(trace.stalled)
        plain = [
            (membrane.plain(p.state), p.monitors["V"])
            for p in trace.points
            if p.monitors["V"] <= end and (not self.liquid or p.state.loads["zw"] > 0)
        ]
        for held, _ in plain:
            held.zones = held.zones.thicker_than(THIN, membrane.length)

        def pattern(pair: tuple[ZonedState, float]) -> bytes:
            return np.concatenate(marks_of(pair[0].zones, membrane.length)).tobytes()

        parts = (self._followed(list(same), end, step) for _, same in groupby(plain, key=pattern))
        return [part for part in parts if part is not None]

    def _membrane(self, loads: Mapping[str, float]) -> Membrane:
        """The tube of some loads on a plain mesh."""
        names = (*CYLINDER.parameters, *(["gamma"] if self.liquid else []))
        values, law = {name: loads[name] for name in names}, self.material_law
        other = replace(law, constants=tuple((name, loads[name]) for name, _ in law.constants))
        if law.model == MOONEY_RIVLIN:
            values["c2"], other = loads["alpha"], None
        mesh = [self.cells], self.degree
        return Membrane(self.mesh.comm, CYLINDER, values, self.liquid, *mesh, "relaxed", (), other)

    def _followed(self, same: list[tuple[ZonedState, float]], end: float, step: float) -> FittedBranch | None:
        """The part of the branch with the zones of some plain states, from one end to the other.

        None if its equations have no solution near any of them: thin zones of a plain mesh may be its error.
        """
        for held, volume in same:
            guess = self._moved(held)
            part = self.part(guess)
            steps = StepControl(first=step / 4, largest=step, smallest=CLOSE, usual_load=1.0)
            solver = ExtendedNewton(self.system, [self.control, *part.fronts])
            fitted = [*part.fronts.values()]
            continuation = Continuation(solver, fitted, steps, allowed=part.allowed)
            try:
                begin = continuation.start(guess, Held("V", volume), towards={"V": -1.0})
            except ConvergenceError:
                continue

            def outside(point: CurvePoint, part: Part = part) -> bool:
                return any(side * (point.monitors[name] - most) > 0 for name, most, side in part.bounds)

            def beyond(point: CurvePoint, volume: float = volume) -> bool:
                here = point.monitors["V"]
                return here > end or (here > volume and outside(point))

            def before(point: CurvePoint, part: Part = part) -> bool:
                return outside(point, part) or point.state.loads[self.control] < 0

            back = FittedBranch(continuation, self.control, begin, before)
            return FittedBranch(continuation, self.control, back.points[-1].reversed(), beyond)
        return None

    def _moved(self, held: ZonedState) -> State:
        """A plain state on the mesh of its zones."""
        loads, length = dict(self.system.initial.loads), held.state.loads["L"]
        loads[self.control], marks = held.state.loads[self.control], marks_of(held.zones, length)
        self.anchors = anchors(marks)  # for the places of nodes
        for k, place in zip(self.anchors.tolist(), places(held.zones), strict=True):
            loads[f"b{k}"] = place / length
        u = carried(lambda s: held.sampled(s * length), self, loads)
        u[self.system.bc_dofs] = 0.0
        return State(u, loads, marks)


class _Front:
    """A front with the interface of a load."""

    def __init__(self, model: VariedWrinkledTube, index: int) -> None:
        self._model, self._index = model, index

    @property
    def value(self) -> float:
        return float(self._model.breaks[self._index])

    @value.setter
    def value(self, value: float) -> None:
        self._model.given[self._index] = value
        self._model.move()


class _Trace(WrinkledBranch):
    """The branch up to a volume, whatever its load does."""

    def _is_past_limit(self, _point: CurvePoint, _peak: float) -> bool:
        return False


def anchors(marks: Marks) -> np.ndarray:
    """Nodes between blocks of different marks."""
    return np.flatnonzero(np.diff(marks.taut).astype(bool) | np.diff(marks.wet).astype(bool)) + 1


def places(zones: Zones) -> list[float]:
    """Fronts and the free surface, in order."""
    return sorted([*zones.fronts, *([] if zones.surface is None else [zones.surface])])


def marks_of(zones: Zones, length: float) -> Marks:
    """The marks of blocks, shared evenly among zones, which the free surface divides too."""
    edges = np.array([0.0, *places(zones), length])
    counts = np.diff(np.round(np.linspace(0, BLOCKS, len(edges))).astype(int))
    middles = (edges[1:] + edges[:-1]) / 2
    under = zones.wet & (middles < (length if zones.surface is None else zones.surface))
    return Marks(np.repeat(zones.states(middles), counts), np.repeat(np.where(under, WET, DRY), counts))


def _in_order(state: State) -> bool:
    """Whether all zones have a width."""
    places = [0.0, *(state.loads[f"b{k}"] for k in anchors(state.marks).tolist()), 1.0]
    return bool(np.diff(places).min() > 0)
