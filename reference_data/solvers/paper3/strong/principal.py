r"""Forces of any law on the cuts of a sheet, and their derivatives, in principal axes.

With the singular values :math:`F = [a\ b] = \sum_k l_k\, u_k \otimes v_k` of the tangents and the unit normal
:math:`u_3`, the forces on cuts Z = const and Theta = const are the columns of

.. math:: P = \tfrac12 \sum_k w_k\, u_k \otimes v_k ,

and a change :math:`dF = \sum A_{ij}\, u_i \otimes v_j` changes them by

.. math::
   2\,dP_{kk} = \sum_j w_{kj} A_{jj}, \qquad 2\,dP_{3k} = (w_k/l_k)\,A_{3k}, \qquad
   2\,dP_{12}, 2\,dP_{21} = \frac{w_1 - w_2}{l_1 - l_2}\,\frac{A_{12} + A_{21}}{2}
   \pm \frac{w_1 + w_2}{l_1 + l_2}\,\frac{A_{12} - A_{21}}{2} .
"""

from __future__ import annotations

from typing import Any

import numpy as np

Array = np.ndarray
EQUAL = 1e-6  # difference of stretches below which the quotient is its limit, w_11 - w_12


def axes(a: Array, b: Array) -> tuple[Array, Array, Array]:
    """Directions in space (..., 3, 3), the normal last; stretches; material directions (..., 2, 2)."""
    left, lam, right = np.linalg.svd(np.stack([a, b], axis=-1), full_matrices=True)
    return left, lam, np.swapaxes(right, -1, -2)


def forces(a: Array, b: Array, law: Any) -> tuple[Array, Array]:
    """Forces on cuts Z = const and Theta = const, per material length, shapes (..., 3)."""
    left, lam, right = axes(a, b)
    l1, l2 = lam[..., 0], lam[..., 1]
    w = np.stack([law.slope(l1, l2), law.slope(l2, l1)], axis=-1)
    both = np.einsum("...ck,...k,...ik->...ci", left[..., :2], w, right) / 2
    return both[..., 0], both[..., 1]


def rates(a: Array, b: Array, law: Any) -> Array:
    """Derivative of the forces by (a, b), shape (..., 2, 3, 2, 3)."""
    left, lam, right = axes(a, b)
    l1, l2 = lam[..., 0], lam[..., 1]
    w1, w2, w12 = law.slope(l1, l2), law.slope(l2, l1), law.mixed(l1, l2)
    w11, w22 = law.curvature(l1, l2), law.curvature(l2, l1)
    apart = l1 - l2
    shear = np.where(apart > EQUAL, (w1 - w2) / np.where(apart > EQUAL, apart, 1.0), w11 - w12)
    spin = (w1 + w2) / (l1 + l2)
    # moduli (..., 3, 2, 3, 2): of dP_ik by A_jl
    moduli = np.zeros((*l1.shape, 3, 2, 3, 2))
    moduli[..., 0, 0, 0, 0], moduli[..., 1, 1, 1, 1] = w11, w22
    moduli[..., 0, 0, 1, 1] = moduli[..., 1, 1, 0, 0] = w12
    moduli[..., 0, 1, 0, 1] = moduli[..., 1, 0, 1, 0] = (shear + spin) / 2
    moduli[..., 0, 1, 1, 0] = moduli[..., 1, 0, 0, 1] = (shear - spin) / 2
    moduli[..., 2, 0, 2, 0], moduli[..., 2, 1, 2, 1] = w1 / l1, w2 / l2
    turned = np.einsum("...ci,...pk,...ikjl->...pcjl", left, right, moduli, optimize=True)
    return np.einsum("...pcjl,...dj,...ql->...pcqd", turned, left, right, optimize=True) / 2
