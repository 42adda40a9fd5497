"""Columns of Paper 3's primary branch: eigenvalues by wave number and at fixed volume, and radii."""

from __future__ import annotations

import numpy as np

from weakforms.problems.liquid_tube.model import TubeModel
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.modes import SecondVariation
from weakforms.solvers.support.sampling import Peak, Probe


class TubeModes:
    """Quantities along the branch: eigenvalues by wave number, torsion, volume control, values at the middle.

    Eigenvalues are those of the second variation with the mass ``int |dx|^2 dZ dTheta`` (reference area).
    """

    def __init__(self, model: TubeModel, n_max: int) -> None:
        self.model, self.n_max = model, n_max
        self.wave_numbers = range(1, n_max + 1)
        self.columns = (
            "r_mid",
            "T1_mid",
            "T2_mid",
            "r_max",
            *(f"Lambda_n{n}" for n in range(n_max + 1)),
            "Lambda_torsion",
            "LambdaV_n0",
        )
        self._middle = Probe(model.unknown, {name: model.fields[name] for name in ("r", "T1", "T2")})
        self._widest = Peak(model.unknown, 0)

    def variation(self, n: int) -> SecondVariation:
        """The operator of a wave number; for 0 the axisymmetric one without torsion."""
        if n == 0:
            return self.model.axial
        self.model.wave_number.value = n
        return self.model.waves

    def observe(self) -> dict[str, float]:
        """Radii and resultants at the middle, largest radius, lowest eigenvalues."""
        state = self.model.system.state()
        place = self.model.position(np.array(state.loads["L"] / state.loads["delta"] / 2), state.loads)
        middle = self._middle(float(place))
        values = (
            middle["r"],
            middle["T1"],
            middle["T2"],
            1 + self._widest(),
            *(self._lowest(self.variation(n)) for n in range(self.n_max + 1)),
            self._lowest(self.model.torsion),
            self.at_fixed_volume(state),
        )
        return dict(zip(self.columns, values, strict=True))

    @staticmethod
    def _lowest(variation: SecondVariation) -> float:
        return variation.spectrum().eigenvalues[0]

    def at_fixed_volume(self, state: State) -> float:
        r"""Lowest axisymmetric eigenvalue at fixed volume.

        With ``R`` the first variation, ``R_zw = -gamma d`` and :math:`A_s = \pi r_f^2` the free surface,
        :math:`K_V = K + (\gamma/A_s)\, d\, d^T` (per radian :math:`K + 2/(\gamma r_f^2)\, R_{zw} R_{zw}^T`);
        for a full tube the fixed volume allows only :math:`R_{zw}^T x = 0`.
        """
        model = self.model
        if not state.loads["low"]:
            return self._lowest(model.axial)
        border = model.system.load_derivative("zw")
        compliance = 0.0
        if not state.loads["high"]:
            compliance = state.loads["gamma"] * model.system.monitor("r_front") ** 2 / 2
        return model.axial.fixed(border, compliance).eigenvalues[0]
