r"""Paper 3: stability of a bent state in the whole space, split by its plane of symmetry.

Displacements that keep the mirror plane (C1v) and displacements that break it do not mix in the second
variation. Among the latter the turn of the pattern about the axis, :math:`e_z \times x - x_{,\Theta}`, costs
nothing: its eigenvalue is exactly zero and its computed size, of either sign, measures the error. No inertia
of ``K`` itself can tell it from an instability. The count is therefore taken of ``K + s M`` with ``s`` far
above the error, and the eigenvalues between ``-s`` and zero, of which SLEPc returns vectors, are added to it:
all but the turn's, known by its vector.
"""

from __future__ import annotations

from collections.abc import Mapping

import dolfinx.fem.petsc as fem_petsc
import numpy as np
import ufl
from dolfinx import fem
from petsc4py import PETSc

from weakforms.errors import ConvergenceError
from weakforms.problems.liquid_tube.bent.model import SurfaceModel
from weakforms.solvers.equilibrium.system import State
from weakforms.solvers.stability.spectra import Mode, Stability

NEAR = 5
"""Symmetry-breaking eigenvalues looked at, the turn's among them."""

SHIFT = 0.01
"""``s``, far above the error of a zero."""

ZERO = 1e-3
"""Size above which an eigenvalue of the turn is no zero, on any mesh that is of use."""

BEYOND = 1.1
"""How far beyond another mesh's lowest eigenvalue this one's is looked for: at it the tangent is singular."""

FURTHER = 12
"""Targets tried for a negative eigenvalue far from zero, each twice as far."""

LIKENESS = 0.9
"""Least overlap of the mode taken for the turn with the displacement that turns the pattern."""

UNBENT = 1e-6
"""Norm of that displacement, over the tube's own, below which there is no pattern to turn: at the bifurcation
its direction tends to that of the critical mode's partner, a zero eigenvalue too."""


class BentStability:
    """Spectra of the states of one mesh.

    Args:
        model: The surface on half its circumference.
    """

    def __init__(self, model: SurfaceModel) -> None:
        self.model = model
        self.keeps, self.breaks = Stability(model.system), Stability(model.breaking)
        turn = model.turn()
        self._turning = fem.form(model.product(turn, ufl.TestFunction(model.space)))
        self._turning_squared = fem.form(model.product(turn, turn))
        self._lowest = -1.0
        """Last one found: where the next one is looked for first."""

    def spectra(
        self, state: State, critical: float = 0.0, coarser: Mapping[str, float] | None = None
    ) -> dict[str, float]:
        """Eigenvalues and counts of negative ones: C1v at fixed level and volume, and symmetry-breaking.

        Args:
            state: An equilibrium.
            critical: Magnitude up to which an eigenvalue is a special point's own zero; it does not count as
                negative, and there is no judgement at fixed volume.
            coarser: The same on a coarser mesh: where the lowest one is looked for first.

        Raises:
            ConvergenceError: When counts by inertia and by SLEPc disagree, or a sign cannot be told.
        """
        if coarser is not None and coarser["Lambda_1"] < -critical:
            self._lowest = BEYOND * coarser["Lambda_1"]
        values, negative = self._keeping(state, critical)
        out: dict[str, float] = {f"Lambda_{i + 1}": value for i, value in enumerate(values[:3])}
        out["n_negative"] = negative
        if not critical:
            out["LambdaV_1"], out["n_negative_V"] = self._at_fixed_volume(state)
        return out | self._breaking(state)

    def lowest(self, state: State) -> float:
        """The lowest C1v eigenvalue at fixed level, whatever else is negative.

        Raises:
            ConvergenceError: When there are eigenvalues below every target tried.
        """
        target = 2 * self._lowest
        for _ in range(FURTHER):
            (mode, *_), below = self.keeps.about(state, target, 1)
            if not below:
                self._lowest = mode.eigenvalue
                return mode.eigenvalue
            target *= 2
        raise ConvergenceError(f"stability: there are eigenvalues below {target / 2:g}")

    def _keeping(self, state: State, critical: float) -> tuple[list[float], int]:
        """The lowest C1v eigenvalues in ascending order, and how many of them are below ``-critical``."""
        near, negative = self.keeps.about(state, -critical, 3)
        values = [mode.eigenvalue for mode in near]
        below, target = [v for v in values if v < -critical], self._lowest
        for _ in range(FURTHER):
            if len(below) >= negative:
                break
            found, _ = self.keeps.about(state, target, negative)
            below = [mode.eigenvalue for mode in found if mode.eigenvalue < -critical]
            target *= 2
        if len(below) != negative:
            raise ConvergenceError(
                f"stability: inertia counts {negative} negative eigenvalues, SLEPc finds {len(below)}"
            )
        if below:
            self._lowest = min(below)
        return sorted(below) + sorted(v for v in values if v >= -critical), negative

    def _at_fixed_volume(self, state: State) -> tuple[float, int]:
        """Lowest C1v eigenvalue and number of negative ones with the volume held, the level free."""
        system, data = self.model.system, self.model.data
        system.set_state(state.u, state.loads)
        border = system.load_derivative("zw") / data.gamma
        full = state.loads["zw"] >= data.L
        area = 0.0 if full else system.monitor_gradient("V")[1]["zw"]
        found = self.keeps.bordered(state, border, area / data.gamma)
        return found.eigenvalues[0], found.n_negative

    def _breaking(self, state: State) -> dict[str, float]:
        """Symmetry-breaking eigenvalues, the turn of the pattern apart."""
        modes, below = self.breaks.about(state, -SHIFT, NEAR)
        if below:
            modes, below = self.breaks.about(state, -SHIFT, NEAR + below)
        found = sum(mode.eigenvalue < -SHIFT for mode in modes)
        if found != below:
            raise ConvergenceError(
                f"stability: inertia counts {below} symmetry-breaking eigenvalues below {-SHIFT:g}, SLEPc "
                f"finds {found}"
            )
        turn = self._turn(state, modes)
        others = sorted(mode.eigenvalue for mode in modes if mode is not turn)
        if min(map(abs, others)) <= abs(turn.eigenvalue):
            raise ConvergenceError(
                f"stability: a symmetry-breaking eigenvalue of {min(others, key=abs):.1e} is as near to zero "
                f"as that of the turn, {turn.eigenvalue:.1e}: its sign cannot be told"
            )
        return {
            "Lambda_breaking": others[0],
            "Lambda_rotation": turn.eigenvalue,
            "n_negative_breaking": below + sum(-SHIFT <= value < 0 for value in others),
        }

    def _turn(self, state: State, modes: list[Mode]) -> Mode:
        """The mode that turns the pattern about the axis.

        Raises:
            ConvergenceError: When no mode does, or the one that does is far from costing nothing.
        """
        system = self.model.breaking
        system.set_state(state.u, state.loads)
        vector = fem_petsc.assemble_vector(self._turning)
        vector.ghostUpdate(PETSc.InsertMode.ADD, PETSc.ScatterMode.REVERSE)
        products = vector.array.copy()
        products[system.bc_dofs] = 0.0
        overlaps = np.array([abs(system.dot(products, mode.vector)) for mode in modes])
        size = float(np.sqrt(system.sum(fem.assemble_scalar(self._turning_squared))))
        if size < UNBENT * np.sqrt(2 * np.pi * self.model.data.length):
            turn, likeness = min(modes, key=lambda mode: abs(mode.eigenvalue)), 1.0
        else:
            turn, likeness = modes[int(np.argmax(overlaps))], overlaps.max() / size
        if likeness < LIKENESS or abs(turn.eigenvalue) > ZERO:
            raise ConvergenceError(
                f"stability: the turn of the pattern is no zero mode: overlap {likeness:.2f}, "
                f"eigenvalue {turn.eigenvalue:.1e}"
            )
        return turn
