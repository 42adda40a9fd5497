r"""Data of the circular membrane above a deformable substrate, and integrals over its patch.

Source: Patil, DasGupta & Eriksson, Int. J. Solids Struct. 67-68 (2015) 250-262. Lengths over the
clamped radius R_f = beta R_0, x = r/R_f in [0, 1/beta] material radius of the unstretched disk,
X = beta x, p = P R_f/(C1 h), k = K R_f^2/(C1 h), l = L/R_f, energies over 2 pi C1 h R_f^2,

.. math::
   \Phi = \int_0^{1/\beta} [\, x\, W(\lambda_1, \lambda_2) + \tfrac{p}{2} \rho^2 \eta'
          + \tfrac{k}{2} \langle \eta - l \rangle^2 \rho \rho' \,]\, dx,
   \qquad \lambda_1 = (\rho'^2 + \eta'^2)^{1/2}, \quad \lambda_2 = \rho/x .

A locked patch [0, x*] moves as a rigid body: rho = rho_c(x), eta = e* + F(x*) - F(x). Only these numbers of
its history enter the equilibrium and the potential of a later state:

.. math::
   I = \int_0^{x*} (F_* - F)\, \rho_c \rho_c'\, dx = \int_0^{x*} \tfrac12 \rho_c^2 F'\, dx, \quad
   J = \int_0^{x*} (F_* - F)^2 \rho_c \rho_c'\, dx, \quad E = \int_0^{x*} x\, W_c\, dx .

Only the law of the material (``tube_material``) and these data are common to both methods.
"""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Disk:
    """A membrane and its substrate.

    Attributes:
        alpha: C2/C1 (0 is neo-Hookean).
        beta: Pre-stretch R_f/R_0.
        k: Stiffness of the substrate.
        l: Height of the substrate.
    """

    alpha: float
    beta: float
    k: float = 50.0
    l: float = 0.5  # noqa: E741  the paper's name

    @property
    def length(self) -> float:
        """Unstretched radius R_0/R_f = 1/beta."""
        return 1 / self.beta

    @property
    def parameters(self) -> dict[str, object]:
        """As stored with a table."""
        names = ("alpha", "beta", "k", "l")
        return {name: float(getattr(self, name)) for name in names}


@dataclass(frozen=True)
class Patch:
    """The data of a locked patch [0, x] for later states.

    Attributes:
        x: Its edge x*.
        rho: rho_c(x*).
        depth: F(x*).
        moment: I.
        second: J.
        energy: E.
        slope: rho_c'(x*), locked side.
        dip: F'(x*), locked side.
    """

    x: float
    rho: float
    depth: float
    moment: float
    second: float
    energy: float
    slope: float
    dip: float

    def spring(self, disk: Disk, edge: float) -> float:
        """Spring energy of the patch, k/2 int (eta - l)^2 rho rho' dx, at edge height ``edge``."""
        gap = edge - disk.l
        return disk.k / 2 * (gap * gap * self.rho**2 / 2 + 2 * gap * self.moment + self.second)


def toward(at: float, target: float, size: float) -> float:
    """The end of the next of several equal steps to ``target``, each at most ``size`` long."""
    count = math.ceil(abs(target - at) / size - 1e-6)
    return target if count <= 1 else at + (target - at) / count
