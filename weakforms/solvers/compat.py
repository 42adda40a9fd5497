"""The few calls whose form depends on the dolfinx release (0.9 to 0.11), and which release changed them."""

from __future__ import annotations

import basix.ufl
import dolfinx
from dolfinx import fem, jit

SUPPORTED = ((0, 9), (0, 12))
"""First release the code runs on, and the first it was never read against."""


PATIENCE = 180
"""Seconds a process waits for another that compiles the same form; dolfinx's own 10 are too few for ours."""

_, _about = jit.DOLFINX_DEFAULT_JIT_OPTIONS["timeout"]
jit.DOLFINX_DEFAULT_JIT_OPTIONS["timeout"] = (PATIENCE, _about)


def version() -> tuple[int, int]:
    """Major and minor version of the dolfinx in use."""
    major, minor = dolfinx.__version__.split(".")[:2]
    return int(major), int(minor)


def interpolation_points(element: object) -> object:
    """Reference points of an element: a method up to 0.9, a property from 0.10 on."""
    points = element.interpolation_points
    return points() if callable(points) else points


def scalar_space(space: fem.FunctionSpace, family: str, degree: int, size: int) -> fem.FunctionSpace:
    """Space of ``size`` components on the mesh of another; ``functionspace`` itself did not change."""
    cell = space.mesh.basix_cell()
    element = basix.ufl.element(family, cell, degree, shape=(size,), discontinuous=True)
    return fem.functionspace(space.mesh, element)
