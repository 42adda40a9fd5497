"""Fluid-loaded tubes that are hard to follow: dry ones, laws near their limit, levels that turn at a ring."""

import numpy as np
import pytest
from mpi4py import MPI

from weakforms.errors import AbsentError
from weakforms.problems.liquid_tube.branch import FluidPath
from weakforms.problems.liquid_tube.model import TubeData
from weakforms.problems.material_choice import Chosen
from weakforms.solvers.support.sampling import Interpolant

pytestmark = pytest.mark.paper3


def test_a_dry_tube_is_not_turned_inside_out():
    """The first guess led to a tube with a negative radius in the middle: all its numbers were wrong."""
    branch = FluidPath(MPI.COMM_SELF, TubeData(20.86, 8.646, 0.2108, 0.9459, 16, 5), 1)
    r, h = branch.sampled(branch.dry(), np.linspace(0, 20.86 / 8.646, 41), ("r", "H"))
    assert r.min() == pytest.approx(8.646**-0.5, rel=0.05), "as in uniaxial tension"
    assert np.ptp(h) < 1e-4 * abs(h.mean())


def path_of(model, constants, L, delta, gamma, cells=16):
    law = Chosen(model, tuple(constants.items()))
    return FluidPath(MPI.COMM_SELF, TubeData(L, delta, gamma, 0.0, cells, 5, material=law), 1)


def varga(L, delta, gamma, cells=16):
    return path_of("varga", {"shear": 2.0}, L, delta, gamma, cells)


def test_a_tube_near_the_limit_of_its_law_is_filled_in_shorter_steps():
    """The first step to the upper ring led beyond the largest stretch of the law: no number at all."""
    filling = path_of("gent", {"shear": 0.4119, "jm": 39.78}, 16.34, 5.085, 0.7776)._filling()
    fronts = np.array([point.state.loads["front"] for point in filling.points])
    assert filling.stalled is None
    assert np.all(np.diff(fronts) > 0)
    assert fronts[-1] == pytest.approx(1 - 1e-4, abs=1e-12)


def test_a_level_that_turns_just_below_the_ring_is_followed():
    """The tube was to be filled, and steps to the upper ring did not converge."""
    tube = FluidPath(MPI.COMM_SELF, TubeData(9.646, 9.197, 1.731, 0.6146, 16, 5), 1)
    _, filling = tube.pieces
    (limit,) = (solved for solved in filling.special() if solved.kind == "limit_point")
    assert 0.98 < limit.state.loads["zw"] / 9.646 < 1
    assert filling.stalled is None
    assert filling.points[-1].state.loads["zw"] < 0.7 * limit.state.loads["zw"]


def test_a_stiff_tube_is_filled_on_fine_meshes():
    """Round-off in its forces was taken for a singular system."""
    stiff = {"shear": 7.908, "poisson": 0.2829}
    filling = path_of("saint_venant_kirchhoff", stiff, 26.26, 8.137, 1.524, 64)._filling()
    assert filling.stalled is None
    assert filling.points[-1].state.loads["front"] == pytest.approx(1 - 1e-4, abs=1e-12)


def test_the_branch_of_a_law_of_bounded_force_ends_where_the_law_gives_way():
    """Beyond, stretches grew without bound, and the number of parts of the branch depended on the mesh."""
    ends = []
    for cells in (32, 64):
        piece = varga(3.481, 1.774, 1.158, cells).pieces[-1]
        assert "the law hardly resists meridional stretch any more" in piece.ended
        before, last = (stretches(piece, point.state) for point in piece.points[-2:])
        assert least_resistance(*last) < 0.02 < least_resistance(*before)
        ends.append((piece.points[-1].state.loads["zw"], last[0].max()))
    assert ends[0] == pytest.approx(ends[1], rel=1e-2)


def test_the_branch_of_a_compressible_law_ends_where_its_membrane_has_no_thickness():
    """Its level hardly rises there, and beyond it the energy is not a number."""
    piece = path_of("harmonic", {"shear": 19.82, "f2": 3.465}, 8.17, 1.691, 0.4301, 16).pieces[-1]
    assert piece.stalled is None
    assert piece.ended.startswith("model = 'harmonic' at the stretches ")
    l1, l2 = stretches(piece, piece.points[-1].state)
    assert 0 < np.min(3 + (l1 * l2 - 1) / 3.465 - l1 - l2) < 0.05


def stretches(piece, state):
    profile = piece.system.formulation.profile
    with piece.system.at(state):
        return Interpolant(piece.system.unknown, {n: profile[n] for n in ("lam1", "lam2")}).values().T


def least_resistance(lam1, lam2):
    """``lam1 w,11 / w,1`` of ``w = lam1 + lam2 + 1/(lam1 lam2) - 3``."""
    return 2 / (lam1**2 * lam2 - 1).max()


def test_a_law_that_gives_way_without_liquid_has_no_branch():
    with pytest.raises(AbsentError, match=r"at a pre-stretch of 7\.007, without liquid, the law hardly resi"):
        varga(7.048, 7.007, 1.306).dry()
    assert varga(7.048, 3.0, 1.306).dry().loads["delta"] == 3.0


def test_a_front_that_turns_just_below_the_ring_leads_to_no_tube_that_is_turned_inside_out():
    """Long steps of the front did on a coarse mesh: the volume fell from 109 to 5.5."""
    pieces = FluidPath(MPI.COMM_WORLD, TubeData(8.0, 4.0, 0.13, 0.0, 8, 6), 0).pieces
    volumes = [point.monitors["V"] for piece in pieces for point in piece.points]
    assert np.all(np.diff(volumes) > 0)
    assert len(pieces) == 2  # it never becomes full
