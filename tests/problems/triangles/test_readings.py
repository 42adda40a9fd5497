"""Numbers of a state on triangles that need a point."""

import pytest
import ufl
from dolfinx import mesh
from mpi4py import MPI

from weakforms.problems.triangles.readings import LeastStress


@pytest.mark.parametrize("mirrored", [False, True])
def test_of_points_with_the_same_least_stress_the_one_with_the_largest_x_is_given(mirrored):
    square = mesh.create_unit_square(MPI.COMM_SELF, 4, 4)
    if mirrored:  # the same points in another order
        square.geometry.x[:, 0] = 1 - square.geometry.x[:, 0]
    _, y = ufl.SpatialCoordinate(square)
    place, least = LeastStress(square, (2 * y - 1) ** 2, 2).least()
    # the points of quadrature nearest to the middle line are 1/24 from it, in every cell along x
    assert abs(place[1] - 0.5) == pytest.approx(1 / 24)
    assert least == pytest.approx((2 * place[1] - 1) ** 2)
    assert place[0] > 0.75
