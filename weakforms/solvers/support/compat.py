"""The few calls that depend on the dolfinx release (0.9 to 0.11), and which release changed them."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module

import basix.ufl
import dolfinx
import numpy as np
import ufl
from dolfinx import cpp, fem, la
from dolfinx import mesh as dmesh
from dolfinx.mesh import Mesh
from mpi4py import MPI
from petsc4py import PETSc

SUPPORTED = ((0, 9), (0, 12))
"""First supported release, and the first release that is not supported."""

PETSC_ERRORS = (PETSc.Error, SystemError)
"""What a call raises if PETSc fails. slepc4py 3.25 with Python 3.14 wraps its error in a ``SystemError``."""


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


def create_mesh(comm: MPI.Intracomm, cells: np.ndarray, points: np.ndarray, domain: ufl.Mesh) -> Mesh:
    """Mesh of given cells: the points come before the element up to 0.9, and after it from 0.10 on."""
    last = (points, domain) if version() < (0, 10) else (domain, points)
    return dmesh.create_mesh(comm, cells, *last)


def mesh_from_gmsh(model: object, comm: MPI.Intracomm, root: int, dimension: int) -> Mesh:
    """Mesh of the gmsh model on rank ``root``: by ``gmshio`` up to 0.9, by ``gmsh`` from 0.10 on."""
    reader = import_module("dolfinx.io." + ("gmshio" if version() < (0, 10) else "gmsh"))
    mesh, *_ = reader.model_to_mesh(model, comm, root, gdim=dimension)
    return mesh


def add_up(matrix: la.MatrixCSR, form: fem.Form, bcs: Sequence[fem.DirichletBC]) -> None:
    """Add the entries of a form, except for rows and columns of Dirichlet conditions.

    ``fem.assemble_matrix`` also writes their diagonal, in 0.9 on every rank that has a copy of the row
    if the conditions are given in blocks. The copies would be added up. So this calls the function below it.
    """
    of = form._cpp_object
    packed = cpp.fem.pack_constants(of), cpp.fem.pack_coefficients(of)
    cpp.fem.assemble_matrix(matrix._cpp_object, of, *packed, [bc._cpp_object for bc in bcs])
