"""The primary branch of a tube of liquid that bears no compression: it wrinkles around the axis.

Its states are those of the problem ``wrinkled_tube`` for a uniform thickness and rings of radius 1, in the
units and with the columns of ``fluid_tube``: ``mu = 2 C1``, the weight of the liquid is ``2 gamma`` over
``C1``, and volumes and energies are of the whole circumference. The ends of wrinkled zones and the free
surface are break points of the mesh and scalar unknowns.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import pi

import numpy as np
from mpi4py import MPI

from weakforms.errors import ConvergenceError, InputError
from weakforms.problems.liquid_tube.about import MOST_FRONTS
from weakforms.problems.liquid_tube.branch import USUAL_LEVEL, WIDEST, heaviest
from weakforms.problems.liquid_tube.model import TubeData
from weakforms.problems.liquid_tube.parameters import FluidTubeNumerics, FluidTubeParameters
from weakforms.problems.material_choice import require_foldable
from weakforms.problems.meridian.fields import Meridian
from weakforms.problems.meridian.model import WRINKLED
from weakforms.problems.meridian.pre_stretch import has_bounded_force
from weakforms.problems.problem import Requests
from weakforms.problems.wrinkled.body import CYLINDER
from weakforms.problems.wrinkled.branch import WrinkledBranch
from weakforms.problems.wrinkled.events import Event
from weakforms.problems.wrinkled.membrane import Membrane
from weakforms.problems.wrinkled.model import WrinkledModel, kept_with_model
from weakforms.problems.wrinkled.problem import LONGEST
from weakforms.problems.wrinkled.readings import Readings
from weakforms.problems.wrinkled.state import ZonedState
from weakforms.problems.wrinkled.waves.modes import waves_at
from weakforms.problems.wrinkled.waves.stability import Change
from weakforms.results import Absence, Field, Quantity, SpecialPoint, State
from weakforms.results.wording import not_crossed
from weakforms.solvers.continuation.continuation import CurvePoint
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.uncertainty.refinement import Estimate

PER_BLOCK = 8
"""Cells of a mesh over those of each of its blocks, of which there are ten or more."""

WHOLE = {"V": ("V_f", 2 * pi), "Pi": ("Pi", pi)}
"""The functional of the wrinkled membrane that a column is, of one radian and over ``C1``, and the factor."""

PRESCRIBED = ("zw", *WHOLE, "limit_point", "bifurcation_point", "zone_opening", "zone_closing")
"""What a state can be asked for by."""

NODAL = ("Z_front", "r_front")
"""Columns that are values at a node, the free surface."""

FIELDS = ("r", "z", "lam1", "lam2", "T1", "T2", "H")


@kept_with_model
def fields_of(model: WrinkledModel) -> Meridian:
    """Fields of ``fluid_tube`` along the meridian, resultants over ``mu H``."""
    e, (t1, t2) = model.expressions, model.resultants
    first = model.law(e["lam1"], e["lam2"]) - e["lam1"] * e["lam2"] * t1
    own = e["r"], e["z"], e["lam1"], e["lam2"], t1 / 2, t2 / 2, first / 2
    return Meridian(model, dict(zip(FIELDS, own, strict=True)))


@dataclass(frozen=True)
class FluidReadings(Readings):
    """Columns and fields of ``fluid_tube``; columns without a value are left out of states and points."""

    def columns(self, held: ZonedState) -> dict[str, float]:
        """Columns of a state.

        Raises:
            ConvergenceError: If its zones are not those that there are columns for.
        """
        length, zones = self.membrane.length, held.all_zones(self.membrane.length)
        surface = (length if zones.wet else 0.0) if zones.surface is None else zones.surface
        if zones.first == WRINKLED or len(zones.fronts) not in range(0, MOST_FRONTS + 1, 2):
            raise ConvergenceError(
                f"{len(zones.fronts)} fronts: up to {MOST_FRONTS // 2} wrinkled zones between taut rings are "
                "followed; raise cells, or delta"
            )
        with held.lent():
            monitors, fields = held.model.system.monitors(), fields_of(held.model)
            ring, middle, at = (
                dict(zip(fields.names, row, strict=True))
                for row in np.transpose(
                    list(fields.sampled(np.array([0.0, length / 2, surface]), held.state.loads).values())
                ).tolist()
            )
            widest = fields.extreme("r", 1)
        full = zones.wet and zones.surface is None
        fronts = np.full(MOST_FRONTS, np.nan)
        fronts[: len(zones.fronts)] = zones.fronts
        return {
            "zw": held.state.loads["zw"],
            **{name: factor * monitors[own] for name, (own, factor) in WHOLE.items()},
            **{f"{name}_ring": ring[name] for name in ("T1", "T2")},
            "Z_front": surface,
            "r_front": np.nan if full else at["r"],
            "r_mid": middle["r"],
            **{f"{name}_mid": middle[name] for name in ("T1", "T2")},
            "r_max": widest,
            "wrinkled_fraction": zones.share(WRINKLED, length),
            **{f"Z_front_{k}": float(z) for k, z in enumerate(fronts, 1)},
        }

    def without_fronts(self, held: ZonedState) -> dict[str, float]:
        """All columns: there is one for every front."""
        return self.columns(held)

    def eigenvalues(self, held: ZonedState) -> dict[str, float]:
        """The lowest eigenvalue of every wave number, 0 included, over ``mu H``."""
        with waves_at(held) as waves:
            return {f"Lambda_n{n}": waves.spectrum(n, 1).eigenvalues[0] / 2 for n in (0, *self.waves)}

    def order(self, name: str) -> float:
        """As for any wrinkled membrane; of eigenvalues, whose operator jumps at fronts, the order of fronts.

        The surface is a node. The radius at the mid-plane is a value of the unknown inside of a cell.
        """
        own = {**dict.fromkeys(NODAL, self.cap), "r_mid": self.cap / 2 + 1}
        return self.cap / 2 if self._resolved(name) else own.get(name, super().order(name))

    def _resolved(self, name: str) -> bool:
        """Whether the observed order may be higher than that of fronts, as it is for eigenvalues.

        Modes are small in the zone above the ring, so that the error of its fronts dominates on fine meshes
        only. The rest of the error has twice the order of the elements.
        """
        return name.startswith("Lambda")

    def estimate(self, name: str, values: list, resolved: bool = False) -> Estimate:
        """As for any wrinkled membrane; a number without a value has no error."""
        if np.isnan(values[-1]).all():
            return Estimate(np.array(np.nan), np.array(0.0), np.array(np.nan))
        return super().estimate(name, values, resolved or self._resolved(name))

    def quantities(self, levels: Sequence[ZonedState], critical: float) -> dict[str, Quantity]:
        """All columns of a state that have a value, and the number of negative eigenvalues at fixed level.

        Raises:
            ConvergenceError: If meshes disagree on stability.
        """
        values = [self.columns(held) | self.eigenvalues(held) for held in levels]
        known = [name for name, value in values[-1].items() if not np.isnan(value)]
        found = {name: self.quantity(name, [v[name] for v in values]) for name in known}
        return found | {"n_negative": self._spectrum(levels, critical)["n_negative"]}

    def point(self, same: Sequence[Solved], branch: str, exact: Sequence[str] = ()) -> SpecialPoint:
        """A special point, of the columns that have a value."""
        known = [name for name, value in same[-1].values.items() if not np.isnan(value)]
        same = [replace(one, values={name: one.values[name] for name in known}) for one in same]
        return super().point(same, branch, exact)

    def fronts(self, _levels: Sequence[ZonedState], _branch: str) -> list[SpecialPoint]:
        """None: fronts are columns."""
        return []

    def fields(self, levels: Sequence[ZonedState], points: np.ndarray) -> tuple[Field, ...]:
        """The profile."""
        samples = []
        for held in levels:
            with held.lent():
                samples.append(fields_of(held.model).sampled(points, held.state.loads))
        return (self._field("profile", samples, FIELDS, points),)


class RelaxedBranch(WrinkledBranch):
    """The primary branch over the level, from the dry tube to its end.

    Args:
        parameters: The tube.
        numerics: Meshes.
        comm: Ranks.
    """

    usual_load = USUAL_LEVEL

    def __init__(
        self, parameters: FluidTubeParameters, numerics: FluidTubeNumerics, comm: MPI.Intracomm
    ) -> None:
        data = tube_data(parameters, numerics, numerics.cells)
        values = {"M": 1.0, "delta": data.delta, "L": data.length, "Af": 1.0, "c2": data.alpha}
        finest = len(numerics.meshes) - 1
        most = max(1, numerics.cells // (PER_BLOCK << finest))
        cells = [most << level for level in range(finest + 1)]
        weight, law = {"gamma": 2 * data.gamma}, ("relaxed", (), data.material)
        membrane = Membrane(comm, CYLINDER, values | weight, True, cells, data.degree, *law)
        readings = FluidReadings(membrane, 2 * data.degree, tuple(range(1, parameters.n_max + 1)))
        widest = WIDEST**2 * data.delta  # over the volume of the dry tube, whose radius is delta^(-1/2)
        super().__init__(membrane, heaviest(data), widest, numerics.step, readings)
        self._lowest, self._stiffens = parameters.zw_end, data.material is not None
        self.missing: list[Absence] = []
        """What was asked for besides the branch and is not there."""

    @property
    def absent(self) -> list[Absence]:
        """What is missing; the branch itself is there."""
        return self.missing

    def _is_past_limit(self, point: CurvePoint, peak: float) -> bool:
        """Whether the level has fallen far enough or, for a law that stiffens, rises again."""
        level = point.state.loads["zw"]
        rises = self._stiffens and level < peak and point.tangent.loads["zw"] > 0
        return level < self._lowest * peak or rises

    def _changed(self, change: Change) -> SpecialPoint:
        return replace(super()._changed(change), kind="bifurcation_point")

    def _event_values(self, event: Event) -> list[dict[str, float]]:
        return [self.readings.columns(held) | {"Z": held.touched} for held in event.levels]

    def state(self, name: str, value: float, crossing: int = 1, profile: np.ndarray | None = None) -> State:
        """The state at which a column has exactly a value, with its profile if requested.

        Raises:
            InputError: If the branch has no such state.
            ConvergenceError: If the solve fails on some mesh.
        """
        own, factor = WHOLE.get(name, ("stability_change" if name == "bifurcation_point" else name, 1.0))
        if name in WHOLE:
            count, over = len(self.trace.crossings(own, value / factor)), self.trace.over_points(own)
            if count < crossing:
                raise InputError(not_crossed(name, value, crossing, count, factor * over))
        return replace(super().state(own, value / factor, crossing, profile), at={name: value})


def tube_data(parameters: FluidTubeParameters, numerics: FluidTubeNumerics, cells: int) -> TubeData:
    """The tube of some parameters on a mesh."""
    given = parameters.L, parameters.delta, parameters.gamma, parameters.alpha
    return TubeData(*given, cells // 2, numerics.degree, numerics.grading, parameters.other_law)


def require_relaxed_possible(parameters: FluidTubeParameters, requests: Requests | None = None) -> None:
    """Refuse what is not known of a tube that wrinkles, and laws without a natural width.

    Raises:
        InputError: With a message that names the parameter.
    """
    what = "fluid_tube: energy = 'relaxed'"
    require_foldable(what, parameters, invariants=True)
    if has_bounded_force(parameters.material):
        raise InputError(
            f"{what}: the force of model = {parameters.model!r} is bounded, and a tube of it gives way; set "
            "energy = 'standard'"
        )
    length = parameters.L / parameters.delta
    if length > LONGEST:
        raise InputError(f"{what}: L/delta = {length:g} is too long to tell its zones; allowed: {LONGEST:g}")
    for wanted in requests.states if requests else ():
        if wanted.name not in PRESCRIBED and wanted.branch == "primary":
            raise InputError(
                f"{what}: no state is solved for by {wanted.name}; allowed: {', '.join(PRESCRIBED)}"
            )
