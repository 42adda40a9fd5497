"""Reference tables made again against those committed."""

from collections.abc import Mapping

import numpy as np

from reference_data.solvers.core.tables import last_digit


def assert_same_table(new: Mapping, committed: Mapping, about: Mapping) -> None:
    """Every column within its stated uncertainty, which holds one rounding; the new one has another."""
    assert list(new) == list(committed)
    for column, values in committed.items():
        bound = about["columns"][column]["uncertainty"] + last_digit(values)
        assert np.abs(new[column] - values).max() <= bound, column
