"""The rule of agreement passes numbers within their bounds, and no others."""

import numpy as np
import pytest

from weakforms.verification.judging.bounds import compare
from weakforms.verification.judging.checks.readings import rounds_to

NAN, INF = float("nan"), float("inf")


@pytest.mark.parametrize(
    ("value", "uncertainty", "reference", "known", "asked", "passes"),
    [
        (1.0, 1e-9, 1.0, 1e-9, 1e-8, True),
        (1 + 4.9e-9, 1.5e-9, 1.0, 2e-9, 1e-8, True),  # bound 2 hypot(1.5, 2) = 5
        (1 + 5.1e-9, 1.5e-9, 1.0, 2e-9, 1e-8, False),
        (1 - 5.1e-9, 1.5e-9, 1.0, 2e-9, 1e-8, False),
        (1.0, 1e-3, 1.0, 0.0, 1e-8, False),  # agrees, but for a wide bar
        (1.0, 0.0, 1.0, 1e-3, 1e-8, False),
        (1.0, 0.0, 1.0, 0.0, 1e-8, True),
        (1 + 1e-15, 0.0, 1.0, 0.0, 1e-8, False),
        (NAN, 1e-9, 1.0, 1e-9, 1e-8, False),
        (1.0, NAN, 1.0, 1e-9, 1e-8, False),
        (1.0, 1e-9, NAN, 1e-9, 1e-8, False),
        (1.0, 1e-9, 1.0, NAN, 1e-8, False),
        (1.0, INF, 1.0, 0.0, 1e-8, False),
        (0.0, 1e-9, 0.0, 0.0, 1e-8, True),  # a reference that is zero is its own scale of one
        (1e-7, 1e-9, 0.0, 0.0, 1e-8, False),
        (1e6 + 1e-3, 1e-3, 1e6, 0.0, 1e-8, True),  # relative to the reference's size
        (-5.0, 1e-9, 5.0, 1e-9, 1e-8, False),
    ],
)
def test_two_numbers(value, uncertainty, reference, known, asked, passes):
    assert compare(value, uncertainty, reference, known).passed(asked) is passes


def test_one_wrong_row_among_many_is_found_and_named():
    reference = np.linspace(1, 2, 50)
    values = reference.copy()
    values[17] += 1e-6
    found = compare(values, np.full(50, 1e-9), reference, 1e-9)
    assert not found.passed(1e-3)
    assert found.worst == 17
    assert compare(reference, 1e-9, reference, 1e-9).passed(1e-8)
    values[17] = NAN
    assert compare(values, 1e-9, reference, 1e-9).worst == 17


def test_one_wide_bar_among_many_fails():
    reference, uncertainty = np.ones(50), np.full(50, 1e-9)
    uncertainty[3] = 1e-4
    assert not compare(reference, uncertainty, reference, 0).passed(1e-8)


def test_scale_is_the_largest_magnitude_or_what_is_given():
    found = compare([0.0, 1.0], 0.1, [0.5, -4.0], 0.0)
    assert found.scale == 4
    assert found.error == pytest.approx([0.125, 1.25])
    assert found.bound == pytest.approx([0.05, 0.05])
    assert compare(1.0, 0.1, 2.0, 0.0, scale=10).error == pytest.approx(0.1)
    assert compare(1e-3, 0.1, 0.0, 0.0).scale == 1.0, "the errors of a column of zeros are absolute"


@pytest.mark.parametrize(
    ("value", "uncertainty", "printed", "same"),
    [
        (1.1629868, 1e-6, "1.163", True),
        (1.16349, 0.0, "1.163", True),
        (1.16351, 0.0, "1.163", False),
        (1.1630, 6e-4, "1.163", False),  # not to all digits, as far as is known
        (1.16349, 2e-5, "1.163", False),
        (1.163, 0.0, "1.1630", True),
        (1.1629868, 1e-6, "1.1630", True),
        (-0.4, 0.0, "-0.4", True),
        (0.4, 0.0, "-0.4", False),
        (123.6, 0.0, "124", True),
        (0.0, 1e-9, "0.00", True),
        (NAN, 0.0, "1.0", False),
        (1.0, NAN, "1.0", False),
        (INF, 0.0, "1.0", False),
        (1.0, INF, "1.0", False),
        (1e40, 0.0, "1.0", False),
    ],
)
def test_printed_digits(value, uncertainty, printed, same):
    assert rounds_to(value, uncertainty, printed) is same
