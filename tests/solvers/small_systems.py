"""Small systems of equations for tests of the solvers."""

import basix.ufl
import numpy as np
import ufl
from dolfinx import fem, mesh
from mpi4py import MPI

from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.system import System

COMM = MPI.COMM_SELF


def system_of(residual, element="DG", degree=0, cells=1, ends=False, shape=None):
    """``residual(u, v, load) dx`` on the unit interval."""
    domain = mesh.create_unit_interval(COMM, cells)
    space = fem.functionspace(domain, basix.ufl.element(element, "interval", degree, shape=shape))
    u, v = fem.Function(space), ufl.TestFunction(space)
    constant = fem.Constant(domain, 0.0)
    load = ufl.variable(constant)
    facets = mesh.locate_entities_boundary(domain, 0, lambda x: np.full(x.shape[1], True))
    dofs = fem.locate_dofs_topological(space, 0, facets) if ends else []
    return System(
        Formulation(
            unknown=u,
            residual=residual(u, v, load) * ufl.dx,
            loads={"load": (constant, load)},
            bcs=[fem.dirichletbc(np.zeros(shape or ()), dofs, space)] if ends else [],
            mass=ufl.inner(ufl.TrialFunction(space), v) * ufl.dx,
            monitors={} if shape else {"u": u * ufl.dx},
        )
    )
