"""The tube of the tests of surfaces, and what meshes of it are made from."""

from mpi4py import MPI

from weakforms.problems.liquid_tube.bent.surface import SurfaceData

GAMMA, L, DELTA = 0.116, 8.0, 2.0
ONE = MPI.COMM_SELF


def data(cells=8, around=4, degree=3, full=False, uneven=0.0, alpha=0.0, front=None, material=None):
    return SurfaceData(L, DELTA, GAMMA, alpha, cells, around, degree, full, uneven, front, material)
