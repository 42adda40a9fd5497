r"""The tube of paper 3, filled by a liquid, in the planes of diagrams; its load is the level ``zw``.

Its states and second variations are those of the problem ``fluid_tube``. The parts of a branch, and so the
lines, are those of a partially filled tube, whose free surface is a scalar unknown, and of a full one. They
meet where the level is at the upper ring, and lines end there. Resultants are over ``C1 H``, volumes over
``2 pi A^3`` and energies over ``2 pi C1 H A^2``, as of the other bodies.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property, partial
from math import inf, pi

import numpy as np
import ufl
from mpi4py import MPI

from weakforms.problems.diagram.bodies.varied import WAVES
from weakforms.problems.diagram.followed import PLACE, Part
from weakforms.problems.liquid_tube.branch import EDGE, STEP, FluidPath
from weakforms.problems.liquid_tube.model import TubeData, TubeModel
from weakforms.problems.material_choice import MOONEY_RIVLIN, Chosen
from weakforms.problems.meridian.blocks import UPPER
from weakforms.solvers.continuation.continuation import CurvePoint
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.least import LeastValue
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.modal import ModalBranch
from weakforms.solvers.stability.modes import SecondVariation

AT_BRIM = "there the liquid reaches a ring; lines of full and of partially filled tubes are separate"
PARTLY = Part({"front": Held("gap", 0.0)}, (("front", 1 - EDGE, 1), ("front", EDGE, -1)), AT_BRIM)
FULL = Part({}, (("over", 0.0, -1),), AT_BRIM)
"""What holds for the states of a partially filled tube, and of a full one."""

OF_C1 = 2.0
"""``mu = 2 C1``, by which paper 3 divides."""


class VariedFluidTube(TubeModel):
    """The tube; its loads are ``zw``, ``delta``, ``L``, ``gamma``, and the constants of the law.

    Args:
        comm: Ranks.
        material: The law.
        values: First values of ``delta``, ``L`` and ``gamma``.
        cells: Cells of the mesh.
        degree: Degree of the elements.
    """

    depth = "V"

    def __init__(
        self, comm: MPI.Intracomm, material: Chosen, values: dict[str, float], cells: int, degree: int
    ) -> None:
        of_tube = {name: values[name] for name in ("L", "delta", "gamma")}
        mesh = {"cells": cells // 2, "degree": degree}
        ratio = dict(material.constants).get("alpha", 0.0)
        other = None if material.model == MOONEY_RIVLIN else material
        super().__init__(comm, TubeData(**of_tube, **mesh, alpha=ratio, material=other))

    def formulation(self) -> Formulation:
        """The weak form with the least principal resultant, in the scaling of diagrams."""
        given, tensions = super().formulation(), (self.fields["T1"], self.fields["T2"])
        t1, t2 = (OF_C1 * value for value in tensions)
        volume, energy = (1 / (2 * pi) * given.monitors[name] for name in ("V", "Pi"))
        over = (self.q["zw"] - self.q["L"]) * self.ends(UPPER)
        monitors = {"V": volume, "Pi": OF_C1 * energy, "gap": given.monitors["gap"], "over": over}
        placed = {"rho": self.fields["r"], "eta": self.fields["z"]}
        stretches = {name: self.fields[name] for name in ("lam1", "lam2")}
        return replace(
            given,
            monitors=monitors,
            maxima={"minus_t": ufl.max_value(-t1, -t2)},
            derived={"t_min": lambda values: -values["minus_t"]},
            internal=("front", "gap", "over", "minus_t"),
            profile={**placed, **stretches, "t1": t1, "t2": t2},
            abscissa="S",
            locate=self._located,
        )

    def _located(self, s: np.ndarray, loads: dict[str, float]) -> np.ndarray:
        """Mesh coordinates of fractions ``S`` of the length."""
        return self.position(np.asarray(s) * loads["L"] / loads["delta"], loads)

    @cached_property
    def least(self) -> LeastValue:
        """The least principal resultant, which is not zero first at a ring: there both are zero together."""
        t1, t2 = (OF_C1 * self.fields[name] for name in ("T1", "T2"))
        return LeastValue(self.system, ufl.min_value(t1, t2), 2 * self.degree + 1)

    def at_onset(self) -> dict[str, float]:
        """Where the least resultant is."""
        self.least.turn()
        loads = self.system.state().loads
        place = self.material(np.array([self.least.place]), loads)[0] * loads["delta"] / loads["L"]
        return {"at_end": int(self.least.at_end), PLACE: float(place)}

    def operators(self, kind: str) -> dict[int, Callable[[], SecondVariation]]:
        """The second variation in waves around the axis; the liquid leaves no parity along it."""
        numbered = WAVES.fullmatch(kind)
        return {0: partial(self._waves, int(numbered[1]))} if numbered else {}

    def _waves(self, n: int) -> SecondVariation:
        self.wave_number.value = n
        return self.waves

    def part(self, state: State) -> Part:
        """Whether a state is full or has a free surface inside."""
        return FULL if state.loads["high"] else PARTLY

    def _path(self, state: State, step: float = STEP, end: float = inf) -> _Path:
        """The branch of the tube that has the parameters of a state."""
        loads, data = state.loads, self.data
        given = {name: loads[name] for name in ("L", "delta", "gamma")}
        if data.material is None:
            given["alpha"] = loads["alpha"]
        else:
            constants = tuple((name, loads[name]) for name, _ in data.material.constants)
            given["material"] = replace(data.material, constants=constants)
        return _Path(self, replace(data, **given), step, end)

    def limit(self, state: State) -> str:
        """Why the law takes no more than a state."""
        return self._path(state).limit(state)

    def gives_way(self, point: CurvePoint) -> str:
        """Why the tube is followed no further beyond a point; empty if it is."""
        return self._path(point.state).locked(point)

    def primary(self, end: float, step: float) -> list[ModalBranch]:
        """Parts of the branch at the loads of the initial state, up to ``V = end``, without the dry one."""
        return self._path(self.system.initial, step, end).pieces[1:]


class _NoModes:
    """Nothing is computed along primary branches: neutral waves are looked for, not their eigenvalues."""

    wave_numbers, columns = (), ()

    def observe(self) -> dict[str, float]:
        return {}


class _Path(FluidPath):
    """The primary branch up to a volume, whatever its level does."""

    modes = _NoModes()

    def __init__(self, model: VariedFluidTube, data: TubeData, step: float, end: float) -> None:
        super().__init__(model.mesh.comm, data, 0, step=step, model=model)
        self.end = end

    def _volume_of(self, point: CurvePoint) -> float:
        return 2 * pi * point.monitors["V"]

    def _ends(self, point: CurvePoint) -> bool:
        return point.monitors["V"] > self.end or bool(self.locked(point))
