"""The branch of a rectangular membrane on a family of meshes."""

from __future__ import annotations

from typing import ClassVar

from weakforms.solvers.stability.modal import ModalFamily


class RectangleFamily(ModalFamily):
    """As for any modal branch."""

    located_by: ClassVar = {}
