"""Gas-filled tubes for which an audit once got no answer, on coarse meshes."""

import pytest

from weakforms import solve
from weakforms.errors import InputError


def test_a_scheme_that_touches_nothing_says_so_and_stays_free():
    tube = {"alpha": 0.6091, "delta1": 3.757, "lf": 3.978}
    given = tube | {"k": 98.02, "s": 3.575, "scheme": "pressure_steps", "p_end": 0.05848}
    result = solve("tube_scheme", **given, numerics={"cells": 32, "steps": 8})
    assert "p_end = 0.05848 is reached before first contact" in result.absent[0].reason
    assert result.quantities["contact_length"].value == 0.0
    free = solve("tube", **tube, at={"p": 0.05848}, numerics={"cells": 16, "levels": 2}).states[0]
    assert result.quantities["u_max"].value == pytest.approx(free.quantities["u_max"].value, rel=1e-3)


def test_a_scheme_ends_below_first_contact_at_its_last_pressure():
    """The step in which ``p_end`` is passed leads near a limit point, from where Newton's method diverges."""
    tube = {"alpha": 0.244, "delta1": 3.336, "lf": 12.77}
    given = tube | {"k": 1776.0, "s": 9.785, "p_end": 0.3542}
    result = solve("tube_scheme", **given, numerics={"cells": 32, "steps": 8})
    assert "p_end = 0.3542 is reached before first contact" in result.absent[0].reason
    free = solve("tube", **tube, at={"p": 0.3542}, numerics={"cells": 16, "levels": 2}).states[0]
    assert result.quantities["u_max"].value == pytest.approx(free.quantities["u_max"].value, rel=1e-2)
    with pytest.raises(InputError, match=r"p_end = 1e-09 is below p = .*raise p_end"):
        solve("tube_scheme", p_end=1e-9, numerics={"cells": 32, "steps": 8})


def test_a_scheme_of_a_law_that_makes_a_neck_without_pressure_reaches_a_low_one():
    """The first guess, of uniform radius, was taken for the state without pressure."""
    law = {"model": "saint_venant_kirchhoff", "shear": 5.738, "poisson": 0.2504}
    tube = law | {"delta1": 4.456, "lf": 56.98}
    given = tube | {"k": 5169.0, "s": 13.59, "p_end": 0.4301, "scheme": "pressure_steps"}
    result = solve("tube_scheme", **given, numerics={"cells": 100, "steps": 8})
    free = solve("tube", **tube, at={"p": 0.4301}, numerics={"cells": 16, "levels": 2}).states[0]
    assert free.quantities["u_max"].value < -0.4
    assert result.quantities["u_max"].value == pytest.approx(free.quantities["u_max"].value, rel=1e-3)


def test_a_scheme_that_loses_contact_beyond_a_limit_point_says_so():
    """First contact is behind a limit point; the scheme's steps up to p_end lead back before it."""
    given = {
        "model": "varga",
        "shear": 3.56,
        "delta1": 3.245,
        "lf": 1.875,
        "k": 0.0,
        "s": 13.68,
        "p_end": 0.9191,
    }
    result = solve("tube_scheme", **given, scheme="pressure_steps", numerics={"cells": 40, "steps": 8})
    assert result.quantities["contact_length"].value == 0
    assert "lead to a state without contact; choose a smaller s" in result.absent[0].reason


def test_a_tube_is_inflated_from_rest_each_time():
    """The second free branch, up to ``p_end``, started from the bulged state at first contact."""
    given = {"alpha": 0.4899, "delta1": 1.389, "lf": 1.106, "k": 668.0, "s": 9.626, "p_end": 2.367}
    coarse = {"cells": 16, "levels": 2}
    result = solve("tube", **given, contact="adhesive", phase="deflation", numerics=coarse)
    assert result.failures == []
    assert "p_end = 2.367 is below first contact" in result.absent[0].reason
    p = result.branch().columns["p"]
    assert p[0] == pytest.approx(2.367, abs=1e-9)
    assert -0.1 * 2.367 < p[-1] <= 0
    assert not result.warnings, "the last step goes beyond p = 0, where the tube is compressed"


def test_a_scheme_whose_tube_cannot_reach_the_substrate_ends_at_the_last_pressure_before():
    """At ``u_max = 1.2`` the membrane is all but inextensible, far above the last pressure."""
    law = {"model": "gent", "shear": 1.46, "jm": 29.75}
    given = law | {"delta1": 2.905, "lf": 1.889, "k": 308.2, "s": 2.997, "p_end": 0.02736}
    result = solve("tube_scheme", **given)
    assert result.failures == []
    (rest,) = result.absent
    assert "p_end = 0.02736 is reached before first contact" in rest.reason
    assert result.quantities["contact_length"].value == 0
    assert 0 < result.quantities["u_max"].value < 0.1


@pytest.mark.parametrize("scheme", ["pressure_steps", "semismooth"])
def test_pressure_steps_of_a_scheme_that_find_no_state_where_the_pressure_falls_say_so(scheme):
    law = {"model": "three_chain", "nkt": 0.4865, "links": 456100.0}
    given = law | {"delta1": 4.258, "lf": 5.717, "k": 1008.0, "s": 4.51, "p_end": 7.783}
    result = solve("tube_scheme", **given, scheme=scheme)
    assert result.failures == []
    assert result.quantities == {}
    (rest,) = result.absent
    assert "the pressure falls at first contact, and steps of it find no state beyond p = " in rest.reason
    assert "scheme = 'front_nodes' follows the branch" in rest.reason
