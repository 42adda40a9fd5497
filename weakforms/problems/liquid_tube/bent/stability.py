r"""Paper 3: stability of a bent state in the whole space, split by its plane of symmetry.

Displacements that keep the mirror plane (C1v) and displacements that break it do not mix in the second
variation. Among the latter, the rotation of the pattern about the axis, :math:`e_z \times x - x_{,\Theta}`,
needs no energy. Its eigenvalue is exactly zero, and its computed value, of either sign, shows the error. The
inertia of ``K`` cannot distinguish it from an instability. The inertia of ``K + s M`` is therefore used, with
``s`` far above the error. The eigenvalues between ``-s`` and zero, whose vectors SLEPc returns, are added to
this count. The eigenvalue of the rotation, identified by its vector, is left out.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

import dolfinx.fem.petsc as fem_petsc
import numpy as np
import ufl
from dolfinx import fem
from petsc4py import PETSc

from weakforms.errors import ConvergenceError
from weakforms.problems.liquid_tube.bent.model import SurfaceModel
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.spectra import Mode, Stability

NEAR = 5
"""Number of symmetry-breaking eigenvalues that are computed, including the eigenvalue of the rotation."""

SHIFT = 0.01
"""The shift ``s``, far above the error of a zero eigenvalue."""

ZERO = 1e-3
"""Magnitude above which the eigenvalue of the rotation is not accepted as zero."""

BEYOND = 1.1
"""Relative distance of the target below another mesh's lowest eigenvalue, at which the tangent would be
singular."""

MOST_TARGETS = 12
"""Number of targets for a negative eigenvalue far from zero, each twice as far as the one before."""

LIKENESS = 0.9
"""Smallest accepted overlap between the mode of the rotation and the displacement that rotates the
pattern."""

SMALLEST_TURN = 1e-6
"""Norm of that displacement, relative to a unit displacement of the whole tube, below which there is no
pattern to rotate. At the bifurcation its direction tends to the partner of the critical mode, which has a
zero eigenvalue too."""


class BentStability:
    """Spectra of the states of one mesh.

    Args:
        model: The surface on half its circumference.
    """

    def __init__(self, model: SurfaceModel) -> None:
        self.model = model
        self.keeps = Stability(model.system)
        turn = model.turn()
        self._turning = fem.form(model.product(turn, ufl.TestFunction(model.space)))
        self._turning_squared = fem.form(model.product(turn, turn))
        self._lowest = -1.0
        """The last lowest eigenvalue, near which the next one is searched first."""

    @cached_property
    def breaks(self) -> Stability:
        """Of displacements that break the symmetry; their matrix is made when it is needed."""
        return Stability(self.model.breaking)

    def spectra(
        self, state: State, critical: float = 0.0, coarser: Mapping[str, float] | None = None
    ) -> dict[str, float]:
        """Eigenvalues and counts of negative ones: C1v at fixed level and volume, and symmetry-breaking.

        Args:
            state: An equilibrium.
            critical: An eigenvalue up to this magnitude is the zero of a special point. It does not count as
                negative, and stability at fixed volume is not computed.
            coarser: The result on a coarser mesh, near which the lowest one is searched first.

        Raises:
            ConvergenceError: If counts by inertia and by SLEPc disagree, or a sign is uncertain.
        """
        if coarser is not None and coarser["Lambda_1"] < -critical:
            self._lowest = BEYOND * coarser["Lambda_1"]
        values, negative = self._c1v_eigenvalues(state, critical)
        out: dict[str, float] = {f"Lambda_{i + 1}": value for i, value in enumerate(values[:3])}
        out["n_negative"] = negative
        if not critical:
            out["LambdaV_1"], out["n_negative_V"] = self._at_fixed_volume(state)
        self.keeps.factor.release()
        out |= self._breaking(state)
        self.breaks.factor.release()
        return out

    def lowest(self, state: State) -> float:
        """The lowest C1v eigenvalue at fixed level, for any number of negative ones.

        Raises:
            ConvergenceError: If there are eigenvalues below every target.
        """
        target = 2 * self._lowest
        for _ in range(MOST_TARGETS):
            (mode, *_), below = self.keeps.about(state, target, 1)
            if not below:
                self._lowest = mode.eigenvalue
                return mode.eigenvalue
            target *= 2
        raise ConvergenceError(f"stability: there are eigenvalues below {target / 2:g}")

    def _c1v_eigenvalues(self, state: State, critical: float) -> tuple[list[float], int]:
        """The lowest C1v eigenvalues in ascending order, and the number of those below ``-critical``."""
        near, negative = self.keeps.about(state, -critical, 3)
        values = [mode.eigenvalue for mode in near]
        below, target = [v for v in values if v < -critical], self._lowest
        for _ in range(MOST_TARGETS):
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
        """Lowest C1v eigenvalue and number of negative ones at fixed volume, with variable level."""
        system, data = self.model.system, self.model.data
        with system.at(state):
            border = system.load_derivative("zw") / data.gamma
            full = state.loads["zw"] >= data.L
            area = 0.0 if full else system.monitor_gradient("V")[1]["zw"]
        found = self.keeps.bordered(state, border, area / data.gamma)
        return found.eigenvalues[0], found.n_negative

    def _breaking(self, state: State) -> dict[str, float]:
        """Symmetry-breaking eigenvalues, with the rotation of the pattern separate."""
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
                f"as the eigenvalue of the rotation, {turn.eigenvalue:.1e}: its sign is uncertain"
            )
        return {
            "Lambda_breaking": others[0],
            "Lambda_rotation": turn.eigenvalue,
            "n_negative_breaking": below + sum(-SHIFT <= value < 0 for value in others),
        }

    def _turn(self, state: State, modes: list[Mode]) -> Mode:
        """The mode that rotates the pattern about the axis.

        Raises:
            ConvergenceError: If there is no such mode, or its eigenvalue is far from zero.
        """
        system = self.model.breaking
        with system.at(state):
            vector = fem_petsc.assemble_vector(self._turning)
            size = float(np.sqrt(system.sum(fem.assemble_scalar(self._turning_squared))))
        vector.ghostUpdate(PETSc.InsertMode.ADD, PETSc.ScatterMode.REVERSE)
        products = vector.array.copy()
        products[system.bc_dofs] = 0.0
        overlaps = np.array([abs(system.dot(products, mode.vector)) for mode in modes])
        if size < SMALLEST_TURN * np.sqrt(2 * np.pi * self.model.data.length):
            turn, likeness = min(modes, key=lambda mode: abs(mode.eigenvalue)), 1.0
        else:
            turn, likeness = modes[int(np.argmax(overlaps))], overlaps.max() / size
        if likeness < LIKENESS or abs(turn.eigenvalue) > ZERO:
            raise ConvergenceError(
                f"stability: the rotation of the pattern is not a zero mode: overlap {likeness:.2f}, "
                f"eigenvalue {turn.eigenvalue:.1e}"
            )
        return turn
