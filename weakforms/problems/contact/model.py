"""What following contact asks of a membrane's model, whatever the body."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from dolfinx.mesh import Mesh

from weakforms.problems.contact.series import Series
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.equilibrium.system import System


@dataclass(frozen=True)
class Bond:
    """A patch that sticks: its shape is a series in the place at which each point touched, up to ``span``."""

    terms: int
    span: float
    rigid: bool = False
    """Whether the patch keeps its whole shape, and not only its stretch along the substrate."""


class Substrate(Protocol):
    """The membrane and its substrate in numbers."""

    k: float
    """Stiffness of the substrate."""

    @property
    def length(self) -> float:
        """Material coordinate of the clamped end, at which the largest patch would end."""

    @property
    def touch(self) -> float:
        """Value, at first contact, of the functional that grows along free inflation."""


class PatchModel(Protocol):
    """A model whose mesh follows the front of the patch in contact.

    Loads of its system: the pressure ``p``, the fronts, and the stiffness ``k``, which is 0 for the free
    membrane.
    """

    data: Substrate
    bond: Bond | None
    """What sticks; ``None`` without friction."""
    edges: Mapping[str, tuple[str, float]]
    """For each front the functional that is its distance from the substrate, and the front's sign. The first
    one is ``front``; a body with a mid-plane has a second, negative one."""
    centre: int
    """Mesh coordinate of the pole or mid-plane."""
    stuck: int
    """Component of the unknown that a bond determines."""
    series: Mapping[str, Series]
    """Frozen shape of a stuck patch."""
    mesh: Mesh

    @property
    def system(self) -> System:
        """The discrete equations."""

    def nodes(self) -> np.ndarray:
        """Mesh coordinates of the nodes that this rank owns."""

    def material(self, x: np.ndarray, loads: Mapping[str, float]) -> np.ndarray:
        """Material points of mesh coordinates at the front of a state."""

    def at_front(self, slipped: Solved) -> float:
        """Value of the stuck component at the front of a frictionless state."""
