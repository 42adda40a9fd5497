"""A constant that is wrong by 1 % moves the tables of a law beyond the accuracy that their cases ask."""

import csv
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from reference_data.solvers.core.collocation import Mesh, Resolution
from reference_data.solvers.core.laws import CONSTANTS, law
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.materials import tables_disk_contact as disk
from reference_data.solvers.materials import tables_hemisphere as hemisphere
from reference_data.solvers.materials import tables_tube_contact as tube
from reference_data.solvers.paper1.cases import onset_b
from reference_data.solvers.paper1.collocation.history import Inflation as DiskInflation
from reference_data.solvers.paper1.membrane import Disk
from reference_data.solvers.paper2.collocation import history as stuck
from reference_data.solvers.paper2.collocation.states import two_sided
from reference_data.solvers.paper2.contact_cases import SOFT
from reference_data.solvers.paper5.hemisphere.body import Hemisphere
from reference_data.solvers.paper5.hemisphere.states import start
from weakforms.verification.cases.discovery import find_cases

DATA = Path(__file__).resolve().parents[3] / "reference_data" / "materials"
PAIRS = [
    pytest.param(model, name, marks=[pytest.mark.slow] if (model, i) != ("ogden", 0) else [])
    for model in ("ogden", "gent")
    for i, name in enumerate(CONSTANTS[model])
]
"""All constants; the first one of a law in every run, the others with ``-m slow``."""

COARSE_DISK = Resolution(Mesh.graded(4, 8), Mesh.graded(2, 8), Mesh.graded(4, 8), 10)
COARSE_TUBE = Resolution(Mesh.graded(5, 8, 1.6), Mesh.graded(3, 8, 1.6), two_sided(4, 8), 15)
"""Their errors are about a hundredth of the accuracy asked, and less."""

TABLES = {"disk_contact": "disk_adhesive", "tube_contact": "tube_adhesive", "hemisphere": "hemisphere"}


def disk_value(given) -> tuple[str, float, str, float]:
    """Pressure of the disk's adhesive inflation at a front."""
    at = Disk(given, 1.0)
    run = DiskInflation(at, COARSE_DISK, onset_b(at, 0), 0.2)
    return "X_contact", 0.2, "p", float(run.at(np.array([disk.FRONTS[1]])).p[0])


def tube_value(given, model: str) -> tuple[str, float, str, float]:
    """Displacement of the tube's adhesive inflation at a pressure."""
    p = tube.PRESSURES[model][0]
    run = stuck.Inflation(Tube(given, 1.0, 6.0), SOFT, COARSE_TUBE, p)
    return "p", p, "u_max", run.at(p).u_max


def hemisphere_value(given, model: str) -> tuple[str, float, str, float]:
    """Height of the hemisphere's pole at a level."""
    state = start(Hemisphere(given, hemisphere.WEIGHTS[model]), -0.6)
    return "zw", -0.6, "z_pole", float(state.y[0, 0, 1])


VALUES = {"disk_contact": lambda given, _: disk_value(given), "tube_contact": tube_value}
VALUES["hemisphere"] = hemisphere_value


@cache
def asked(case: str) -> dict[str, float]:
    """Accuracy asked by a case."""
    (found,) = (f for f in find_cases() if f.id == f"materials.{case}")
    return found.case.asked


def off(case: str, model: str, given) -> float:
    """Difference of a value to the table's, over the accuracy asked."""
    key, at, column, value = VALUES[case](given, model)
    rows = csv.DictReader((DATA / f"{TABLES[case]}_{model}.csv").read_text().splitlines())
    known = next(float(row[column]) for row in rows if float(row[key]) == at)
    return abs(value / known - 1) / asked(case)[column]


@pytest.mark.parametrize("case", VALUES)
@pytest.mark.parametrize("model", ["ogden", "gent"])
def test_the_law_of_the_table_gives_its_numbers(case, model):
    assert off(case, model, law(model)) < 0.2


@pytest.mark.parametrize("case", VALUES)
@pytest.mark.parametrize(("model", "constant"), PAIRS)
def test_a_constant_that_is_wrong(case, model, constant):
    assert off(case, model, law(model, **{constant: 1.01 * CONSTANTS[model][constant]})) > 2
