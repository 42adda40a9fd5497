"""A curve in units: what was forgotten is recognised, and closed forms take units too."""

import numpy as np
import pytest
from curves_of_tables import FREE, PIECE, columns_of, verdict_on

from weakforms import InputError, compare, dimensional

SI = {"R_f": 0.02, "C1": 4e5, "h": 1.5e-4}


@pytest.mark.parametrize(
    ("factor", "constants", "said"),
    [
        (4e5 * 1.5e-4 / 0.02, None, "yours / ours = 3000 in every row: C1 h/R_f (see --constant)?"),
        (4e5, SI, "yours / ours = 400000 in every row: C1?"),
        (2 / 0.02**2, SI, "yours / ours = 5000 in every row: 2/R_f^2?"),
        (-1.0, SI, "yours / ours = -1 in every row: the other sign?"),
        (1.2345, SI, "yours / ours = 1.2345 in every row"),
        (1.01, SI, "yours / ours = 1.01 in every row: is C1 h/R_f 1 % too large?"),
        (0.995, None, "yours / ours = 0.995 in every row: is C1 h/R_f 0.5 % too small?"),
        (0.1, None, "yours / ours = 0.1 in every row: alpha or C1 h/R_f (see --constant)?"),
    ],
)
def test_a_forgotten_unit_is_recognised(factor, constants, said):
    curve = columns_of(FREE)
    if constants:
        curve = dimensional("circular", curve, **constants)
    curve["p"] = curve["p"] * factor
    for accuracy in (1e-6, None):
        verdicts = verdict_on(FREE, curve, accuracy, constants=constants)
        slip = abs(factor - 1) < 0.1  # which a curve of a coarse mesh may have too
        assert verdicts.status == ("not judged" if slip and not accuracy else "failed")
        units = [v.units for v in verdicts.verdicts]
        assert units == [said, *[""] * (len(units) - 1)]


def test_a_curve_that_is_just_wrong_is_no_matter_of_units():
    curve = columns_of(FREE)
    curve["p"] = curve["p"] * np.linspace(1.4, 1.6, len(curve["p"]))
    curve["V"] = curve["V"] + 0.1
    assert [v.units for v in verdict_on(FREE, curve).verdicts] == [""] * 4
    assert [v.units for v in verdict_on(FREE, columns_of(FREE)).verdicts] == [""] * 4


def test_an_abscissa_in_units_is_recognised():
    with pytest.raises(InputError, match=r"nothing to compare; is t0 in units of R_f \(see --constant\)"):
        compare(FREE[0], columns_of(FREE, t0=1e-3), FREE[1])
    verdicts = verdict_on(FREE, columns_of(FREE, t0=0.02))
    assert verdicts.status == "failed"
    assert "is t0 in units of R_f" in verdicts.verdicts[0].units
    t0 = columns_of(FREE)["t0"]
    rows = slice(*np.searchsorted(0.02 * t0, [t0.min() / 2, np.inf]))
    half = {name: values[rows] for name, values in columns_of(FREE, t0=0.02, p=3000).items()}
    inside = np.sum(half["t0"] >= t0.min())
    assert len(half["t0"]) / 2 < inside < len(half["t0"])
    assert "is t0 in units of R_f" in verdict_on(FREE, half).verdicts[0].units


@pytest.mark.parametrize(
    ("which", "problem", "constants"),
    [
        (PIECE, "homogeneous", {"S": 3e5}),
        (("closed_form.sphere", "sphere_gent"), "sphere", {"S": 3e5, "r_o": 0.1, "h_o": 1e-3}),
    ],
)
def test_closed_forms_take_units_too(which, problem, constants):
    curve = dimensional(problem, columns_of(which), **constants)
    assert verdict_on(which, curve).status == "failed"
    assert verdict_on(which, curve, constants=constants).passed
