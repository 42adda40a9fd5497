"""Compare reference tables computed again with those committed."""

from collections.abc import Mapping

import numpy as np

from reference_data.solvers.core.tables import last_digit


def assert_same_table(new: Mapping, committed: Mapping, about: Mapping) -> None:
    """Assert that every column agrees within its stated uncertainty plus one rounding of the new column."""
    assert list(new) == list(committed)
    for column, values in committed.items():
        bound = about["columns"][column]["uncertainty"] + last_digit(values)
        assert np.abs(new[column] - values).max() <= bound, column
