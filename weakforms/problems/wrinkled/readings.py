"""Columns and fields of states of a wrinkled membrane, with uncertainties from several meshes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from weakforms.errors import ConvergenceError
from weakforms.problems.meridian.model import WRINKLED
from weakforms.problems.wave_numbers import LOWEST, eigenvalue_names
from weakforms.problems.wrinkled.fitted import PLACE
from weakforms.problems.wrinkled.membrane import Membrane
from weakforms.problems.wrinkled.state import ZonedState, solver_of
from weakforms.problems.wrinkled.waves.modes import MODE, waves_at
from weakforms.results import Field, Quantity, SpecialPoint
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.stability.agreement import same_count
from weakforms.solvers.stability.spectra import spectrum_of
from weakforms.solvers.uncertainty.points import special_point
from weakforms.solvers.uncertainty.refinement import Estimate, estimate, estimate_in_norm

ROUND_OFF = 1e-10
"""Relative round-off error of derivatives and of fronts, on blocks of very different length."""

EVENTS = ("zone_opening", "zone_closing")

VALUES = ("V", "Pi", "N")

POLE = ("z_pole", "lam_pole", "gw_max")
"""Columns that are values at the pole, if the body has one; ``gw`` is largest there."""


@dataclass(frozen=True)
class Readings:
    """Post-processing of the states of one membrane.

    Args:
        membrane: The membrane.
        cap: Highest assumed order of convergence.
        waves: Wave numbers for which stability is computed.
        abscissa: Name of the material coordinate.
        beta: Additional bending stiffness against waves.
    """

    membrane: Membrane
    cap: float
    waves: tuple[int, ...] = ()
    abscissa: str = "Z"
    beta: float = 0.0

    # -- one mesh ------------------------------------------------------------------------------

    def columns(self, held: ZonedState) -> dict[str, float]:
        """Columns of a state, including its fronts."""
        with held.lent() as meridian:
            monitors = held.model.system.monitors()
            extremes = {
                "r_max": meridian.extreme("r", 1),
                "gw_max": meridian.extreme("gw", 1),
                "gw_min": meridian.extreme("gw", -1),
            }
        zones = held.all_zones(self.membrane.length)
        fronts = {f"{self.abscissa}_front_{i}": z for i, z in enumerate(zones.fronts, 1)}
        of_pole = {name: monitors[name] for name in ("z_pole", "lam_pole") if name in monitors}
        if of_pole and self.membrane.liquid:
            full = self.membrane.length if zones.wet else 0.0
            of_pole[f"{self.abscissa}_level"] = full if zones.surface is None else zones.surface
        return {
            self.membrane.control: held.state.loads[self.membrane.control],
            **{name: monitors[name] for name in VALUES},
            "wrinkled_fraction": zones.share(WRINKLED, self.membrane.length),
            **extremes,
            **of_pole,
            **fronts,
        }

    def without_fronts(self, held: ZonedState) -> dict[str, float]:
        """Columns of a state without its fronts."""
        found = self.columns(held)
        return {name: value for name, value in found.items() if not self._is_front(name)}

    def _is_front(self, name: str) -> bool:
        return name.startswith(f"{self.abscissa}_front")

    def eigenvalues(self, held: ZonedState) -> dict[str, float]:
        """The lowest eigenvalues of every wave number."""
        out: dict[str, float] = {}
        for n in self.waves:
            with waves_at(held) as waves:
                found = waves.spectrum(n, LOWEST, self.beta).eigenvalues
            out |= dict(zip(eigenvalue_names(n), found, strict=False))
        return out

    def diagnostics(self, held: ZonedState) -> dict[str, float]:
        """Number of negative eigenvalues in the symmetric space, and the record of the solve."""
        factor = solver_of(held.model, held.scalars).factor
        with held.lent():
            factor.update()
        return {
            "n_negative": factor.negative_count(),
            "residual": held.record.norms[-1],
            "iterations": held.record.iterations,
        }

    # -- all meshes ----------------------------------------------------------------------------

    def order(self, name: str) -> float:
        """Highest assumed order of convergence: of energies, or of stretches for all other columns.

        If a radius follows from the stretches, energies depend on it and have the order of stretches too.
        """
        if self.membrane.on_meshes[-1]:
            return self.cap / 2
        energetic = name in (self.membrane.control, "load", "V", "Pi", "eigenvalue_1")
        # Nodal values have the order of energies; the level is a nodal value.
        nodal = self.membrane.body.pole and name in (*POLE, f"{self.abscissa}_level")
        return self.cap if energetic or nodal or name.startswith("Lambda") else self.cap / 2

    def _resolved(self, name: str) -> bool:
        """Columns that depend on fronts, if cells are graded towards fronts for waves."""
        return bool(self.waves) and (self._is_front(name) or name in ("wrinkled_fraction", "r_max", "gw_min"))

    def estimate(self, name: str, values: list[float] | list[np.ndarray], resolved: bool = False) -> Estimate:
        """Value and uncertainty from values on meshes, coarse to fine.

        If the mesh resolves the surroundings of a front, its position has the order of energies, and at least
        the order of stretches.
        """
        order = self.order(name)
        found = estimate(values, self.cap, order, order) if resolved else estimate(values, order)
        left = ROUND_OFF * np.maximum(1.0, np.abs(found.value))
        return replace(found, uncertainty=found.uncertainty + left)

    def quantity(self, name: str, values: list[float]) -> Quantity:
        """The same as a quantity of a result."""
        return self.estimate(name, values, self._resolved(name)).quantity()

    def quantities(self, levels: Sequence[ZonedState], critical: float) -> dict[str, Quantity]:
        """All columns of a state, including its spectra.

        Args:
            levels: The state on every mesh.
            critical: An axisymmetric eigenvalue below this magnitude does not count as negative.

        Raises:
            ConvergenceError: If meshes disagree on fronts or on stability.
        """
        values = [self.columns(held) for held in levels]
        if any(set(v) != set(values[-1]) for v in values):
            raise ConvergenceError("the number of fronts depends on the mesh")
        found = {n: self.quantity(n, [v[n] for v in values]) for n in values[-1]}
        most = found["gw_max"]
        left = self._sliver_error(levels[-1], most.value)
        found["gw_max"] = replace(most, uncertainty=most.uncertainty + left)
        found |= self._spectrum(levels, critical)
        waves = [self.eigenvalues(held) for held in levels]
        return found | {n: self.quantity(n, [v[n] for v in waves]) for n in waves[-1]}

    def _sliver_error(self, held: ZonedState, most: float) -> float:
        """Error of the largest ``gw`` from thin zones, in which it is reached.

        In a thin zone without a block the law of the other state was used, so that only the order of ``gw -
        1`` is correct there. In a thin zone with a block, positions with round-off are differentiated over
        tiny cells.
        """
        if held.slivers:
            return abs(most - 1)
        thinnest = np.diff([0.0, *held.zones.fronts, self.membrane.length]).min()
        return float(np.finfo(float).eps * held.model.cells / thinnest)

    def _spectrum(self, levels: Sequence[ZonedState], critical: float) -> dict[str, Quantity]:
        """Lowest eigenvalue at fixed load and number of negative ones (below ``-critical``).

        By SLEPc, and by inertia.
        """
        spectra = [spectrum_of(held.model.system, held.state, critical) for held in levels]
        count = same_count(spectrum.n_negative for spectrum in spectra)
        lowest = self.quantity("eigenvalue_1", [spectrum.eigenvalues[0] for spectrum in spectra])
        return {"n_negative": Quantity(count), "eigenvalue_1": lowest}

    def point(self, same: Sequence[Solved], branch: str, exact: Sequence[str] = ()) -> SpecialPoint:
        """A special point from its columns on every mesh.

        Args:
            same: The point, coarse to fine.
            branch: Its branch.
            exact: Columns that say what it is and have no error.
        """
        shown = list(same[-1].values)
        caps = {name: self.order(name) for name in shown}
        if same[-1].kind in EVENTS:  # located by stretches at one point: everything has their order
            caps = dict.fromkeys(shown, self.cap / 2)
        point = special_point(same, shown, self.cap, branch, self.membrane.control, caps)
        left = {n: ROUND_OFF * max(1.0, abs(v)) for n, v in point.values.items()}
        if point.kind in EVENTS:
            left[self.abscissa] += PLACE
        spread = {n: u + left[n] for n, u in point.uncertainty.items()}
        return replace(point, uncertainty=spread | dict.fromkeys(exact, 0.0))

    def fronts(self, levels: Sequence[ZonedState], branch: str) -> list[SpecialPoint]:
        """Fronts of a state as special points."""
        values = [self.columns(held) for held in levels]
        out, control = [], self.membrane.control
        for name in filter(self._is_front, values[-1]):
            rows = [{control: v[control], "V": v["V"], self.abscissa: v[name]} for v in values]
            out.append(self.point([Solved(row, None, "front") for row in rows], branch))
        return out

    # -- fields --------------------------------------------------------------------------------

    def fields(self, levels: Sequence[ZonedState], points: np.ndarray) -> tuple[Field, ...]:
        """The profile, and the lowest mode of every wave number except 0."""
        shown = levels[-1].model.system.formulation.profile
        profile = self._field("profile", [held.sampled(points) for held in levels], shown, points)
        modes = (self._modes(n, levels, points) for n in self.waves if n)
        return profile, *modes

    def _modes(self, n: int, levels: Sequence[ZonedState], points: np.ndarray) -> Field:
        samples = []
        for held in levels:
            with waves_at(held) as waves:
                samples.append(waves.sampled(waves.lowest_mode(n, self.beta), points, held.state.loads))
        return self._field(f"mode_n{n}", samples, MODE, points)

    def _field(
        self, title: str, samples: list[dict[str, np.ndarray]], names: Sequence[str], points: np.ndarray
    ) -> Field:
        columns: dict[str, np.ndarray] = {self.abscissa: points}
        uncertainty = {self.abscissa: 0.0}
        for name in names:
            columns[name] = samples[-1][name]
            left = ROUND_OFF * max(1.0, float(np.abs(columns[name]).max()))
            spread = estimate_in_norm([sample[name] for sample in samples], self.order(name))
            uncertainty[name] = spread + left
        return Field(title, columns, uncertainty)
