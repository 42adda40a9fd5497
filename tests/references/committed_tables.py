"""Compare reference tables computed again with those committed."""

from collections.abc import Mapping

import numpy as np

from reference_data.solvers.core.tables import last_digit

WIDER = 3.0
"""Factor by which an uncertainty may change: differences of rounding depend on the libraries."""


def assert_same_table(new: Mapping, committed: Mapping, about: Mapping, stated: Mapping) -> None:
    """Assert that every column agrees within its stated uncertainty plus one rounding of the new column.

    An uncertainty of another size fails too, because a wide one would hide a wrong number.

    Args:
        new: Columns computed again.
        committed: The committed ones.
        about: Documentation of the committed table.
        stated: Uncertainties of the new columns, by name.
    """
    assert list(new) == list(committed)
    for column, values in committed.items():
        size = about["columns"][column]["uncertainty"]
        bound = size + last_digit(values)
        assert np.abs(new[column] - values).max() <= bound, column
        assert size / WIDER <= stated[column] <= size * WIDER, column


def assert_same_rows(new: Mapping, committed: Mapping, about: Mapping, stated: Mapping, rows: object) -> None:
    """The same for a part of a table's rows, of which only these were computed again.

    The committed uncertainties are those of the worst row; the new ones may be smaller, but not larger.

    Args:
        new: Columns of these rows computed again.
        committed: All committed rows.
        about: Documentation of the committed table.
        stated: Uncertainties of the new columns, by name.
        rows: Which rows they are: a slice, numbers, or a mask.
    """
    whole = uncertainties(about)
    assert all(stated[column] <= WIDER * whole[column] for column in stated)
    assert_same_table(new, {name: values[rows] for name, values in committed.items()}, about, whole)


def uncertainties(about: Mapping) -> dict[str, float]:
    """Uncertainties that the documentation of a table states, by column."""
    return {name: column["uncertainty"] for name, column in about["columns"].items()}
