r"""Energy release rate of the edge of a locked patch, in closed form.

At the edge x* (c: locked side, o: free side; the tangents enclose Delta theta)

.. math::
   G = \frac{1}{\lambda_{1c} \lambda_2} \{ W_c - W_o - W_{1o} [\lambda_{1c} \cos\Delta\theta
       - \lambda_{1o}] \} + \frac{k}{2} (e_* - l)^2 \cos\theta_c ,

which is (dPi/dx*)_p/(2 pi rho* lambda_1c): the first part comes from the membrane, the last is the energy of
the released springs. Source: derived from the potential of Patil, DasGupta & Eriksson (2015), whose equation
for G is its difference quotient.
"""

from __future__ import annotations

from typing import Any

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.paper1.membrane import Disk, Patch


def rate(disk: Disk, patch: Patch, height: Any, slope: Any, dip: Any) -> Any:
    """G/(C1 h); slope = rho' and dip = -eta' on the free side, height = eta at the edge."""
    l2 = patch.rho / patch.x
    inner = (patch.slope**2 + patch.dip**2) ** 0.5
    outer = (slope**2 + dip**2) ** 0.5
    cosine = (patch.slope * slope + patch.dip * dip) / (inner * outer)
    jump = mat.energy(inner, l2, disk.alpha) - mat.energy(outer, l2, disk.alpha)
    jump -= mat.slope(outer, l2, disk.alpha) * (inner * cosine - outer)
    return jump / (inner * l2) + disk.k / 2 * (height - disk.l) ** 2 * patch.slope / inner
