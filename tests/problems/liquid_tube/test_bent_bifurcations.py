"""Spectra and bifurcations of a surface are those of the axisymmetric tube and of the whole circle."""

import numpy as np
import pytest
from bent_surfaces import DELTA, GAMMA, ONE, L, data

from weakforms import solve
from weakforms.problems import registry
from weakforms.problems.liquid_tube.bent.bifurcation_point import bifurcation_on, position
from weakforms.problems.liquid_tube.bent.family import free_surface
from weakforms.problems.liquid_tube.bent.model import SurfaceModel
from weakforms.problems.liquid_tube.branch import FluidPath
from weakforms.problems.liquid_tube.model import TubeData
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.stability.spectra import Stability

pytestmark = pytest.mark.paper3


# -- against the axisymmetric side ---------------------------------------------------------------


def test_spectrum_about_an_axisymmetric_state_is_that_of_the_waves(primary):
    """C1v has n = 0 and the cosines of each n; the symmetry-breaking space has torsion and the sines."""
    path = FluidPath(ONE, TubeData(L, DELTA, GAMMA, 0.0, 24, 4), 3)
    solved = path.pieces[1].at("zw", 7.0)
    columns = solved.values
    points = np.linspace(0, L / DELTA, 121)
    model = SurfaceModel(ONE, data(cells=12, around=6, degree=4))
    state = primary.at("zw", 7.0, points)
    found, _ = ExtendedNewton(model.system).solve(model.state_of(position(state), {"zw": 7.0}))
    keeps = Stability(model.system).spectrum(found, 16).eigenvalues
    breaks = Stability(model.breaking).spectrum(found, 16).eigenvalues
    for n in range(4):
        assert min(abs(np.array(keeps) - columns[f"Lambda_n{n}"])) < 1e-4
    for name in ("Lambda_n1", "Lambda_n2", "Lambda_n3", "Lambda_torsion"):
        assert min(abs(np.array(breaks) - columns[name])) < 1e-4
    assert min(abs(np.array(breaks) - columns["Lambda_n0"])) > 1e-2


def test_eigenvalues_about_a_target_are_those_of_the_spectrum(primary):
    model = SurfaceModel(ONE, data(cells=12, around=6, degree=3))
    state = primary.at("V", 140.0, np.linspace(0, L / DELTA, 121))
    guess = model.state_of(position(state), {"zw": state.values["zw"]})
    found, _ = ExtendedNewton(model.system).solve(guess)
    stability = Stability(model.system)
    lowest = stability.spectrum(found, 4)
    assert lowest.n_negative == 2, "past the limit point and the bifurcation"
    modes, below = stability.about(found, 0.0, 4)
    assert below == 2
    assert sorted(mode.eigenvalue for mode in modes)[-1] > 0
    _, between = stability.about(found, (lowest.eigenvalues[2] + lowest.eigenvalues[3]) / 2, 1)
    assert between == 3
    (first, *_), _ = stability.about(found, 1.5 * lowest.eigenvalues[0], 1)
    assert first.eigenvalue == pytest.approx(lowest.eigenvalues[0], rel=1e-9)
    rest = model.system.multiply(model.system.mass, first.vector)
    assert model.system.dot(rest, first.vector) == pytest.approx(1)


def test_bifurcation_on_the_surface_is_the_axisymmetric_one(primary):
    begin = primary.bifurcation(np.linspace(0, L / DELTA, 121))
    model = SurfaceModel(ONE, data(cells=12, around=6, degree=4))
    point, mode, beside, _ = bifurcation_on(model, primary, begin)
    assert point.kind == "bifurcation_point"
    assert beside == 1, "past the limit point of the level"
    assert model.system.dot(mode, model.system.mass_times(mode)) == pytest.approx(1)
    assert point.state.loads["zw"] == pytest.approx(begin.values["zw"], rel=1e-6)
    assert point.values["V"] == pytest.approx(begin.values["V"], rel=1e-5)


def test_bifurcation_is_the_same_by_comparison_with_a_coarser_mesh(primary):
    begin = primary.bifurcation(np.linspace(0, L / DELTA, 121))
    coarse, fine = (
        SurfaceModel(ONE, data(cells, around, 4, front=free_surface(begin)))
        for cells, around in ((6, 4), (12, 8))
    )
    trend = bifurcation_on(coarse, primary, begin)[-1]
    whole, compared = (bifurcation_on(fine, primary, begin, below)[0] for below in (None, trend))
    for name in ("zw", "V", "z_quarter_pi"):
        assert compared.values[name] == pytest.approx(whole.values[name], rel=1e-8), "from fewer states"


# -- the whole circumference ---------------------------------------------------------------------


def test_full_circle_has_a_double_zero_and_the_same_branch():
    mesh = {"cells": 8, "degree": 3}
    half = solve("fluid_tube_surface", extent="half", numerics=mesh).quantities
    full = solve("fluid_tube_surface", numerics=mesh).quantities
    assert half["multiplicity"].value == 1
    assert full["multiplicity"].value == 2
    assert abs(full["Lambda_split"].value) < 1e-11
    for name in ("zw_bifurcation", "V_bifurcation", "zw_bent", "V_bent", "Pi_bent"):
        assert full[name].value == pytest.approx(half[name].value, rel=1e-9)
    assert abs(full["phase"].value) < 1e-10
    assert abs(full["Lambda_bent_1"].value) < 1e-6 < half["Lambda_bent_1"].value


def test_a_finer_mesh_serves_unless_its_cells_were_asked_for():
    problem = registry.get("fluid_tube_surface")
    assert problem.finer(None, problem.numerics(degree=2)) == problem.numerics(cells=24, degree=2)
    assert problem.finer(None, problem.numerics(cells=16)) is None


def test_a_mesh_uneven_around_splits_the_pair():
    uneven = solve("fluid_tube_surface", uneven=0.3, numerics={"cells": 8, "degree": 3}).quantities
    assert uneven["Lambda_split"].value > 1e-7
    assert uneven["multiplicity"].value == 0
    assert abs(uneven["phase"].value) > 1e-9, "the pattern is held where the mesh would not have it"
