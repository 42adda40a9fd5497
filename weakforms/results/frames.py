"""Results as tables of pandas and xarray, if these are installed."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from weakforms.errors import EnvironmentLackError
from weakforms.results.io import BRANCH
from weakforms.results.model import Branch
from weakforms.results.result import Result
from weakforms.results.tables import SPREAD, Row, header

if TYPE_CHECKING:
    import pandas
    import xarray


def _pandas() -> Any:
    try:
        import pandas
    except ImportError as error:
        raise _lack("pandas") from error
    return pandas


def _xarray() -> Any:
    try:
        import xarray
    except ImportError as error:
        raise _lack("xarray") from error
    return xarray


def _lack(name: str) -> EnvironmentLackError:
    how = f"pip install {name}, or apt install python3-{name}"
    return EnvironmentLackError(f"{name} is not installed here: {how}")


def _columns(branch: Branch) -> dict[str, np.ndarray]:
    """Columns of a branch, each followed by its uncertainties."""
    out = {}
    for name, values in branch.columns.items():
        out[name] = np.asarray(values)
        if name in branch.uncertainty:
            out[name + SPREAD] = np.asarray(branch.uncertainty[name])
    return out


def branch_frame(branch: Branch) -> pandas.DataFrame:
    """A row for each point; ``p_uncertainty`` stands beside ``p``.

    Raises:
        EnvironmentLackError: If pandas is missing.
    """
    return _pandas().DataFrame(_columns(branch))


def result_frame(result: Result) -> pandas.DataFrame:
    """All branches, with the name of the branch in the column ``branch``.

    Raises:
        EnvironmentLackError: If pandas is missing.
    """
    frames = [branch_frame(b).assign(**{BRANCH: b.name}) for b in result.branches]
    if not frames:
        return _pandas().DataFrame()
    whole = _pandas().concat(frames, ignore_index=True)
    return whole[[BRANCH, *(name for name in whole.columns if name != BRANCH)]]


def rows_frame(rows: list[Row]) -> pandas.DataFrame:
    """Rows of a table, such as those of a sweep.

    Raises:
        EnvironmentLackError: If pandas is missing.
    """
    return _pandas().DataFrame(rows, columns=header(rows))


def branch_dataset(branch: Branch) -> xarray.Dataset:
    """Variables over the dimension ``point``; ``p_uncertainty`` stands beside ``p``.

    Raises:
        EnvironmentLackError: If xarray is missing.
    """
    variables = {name: ("point", values) for name, values in _columns(branch).items()}
    ended = {} if branch.ended is None else {"ended": str(branch.ended)}
    return _xarray().Dataset(variables, attrs={"branch": branch.name, "control": branch.control} | ended)


def result_dataset(result: Result) -> xarray.Dataset:
    """All branches along ``point``, with the coordinate ``branch``, scalings and parameters as attributes.

    Raises:
        EnvironmentLackError: If xarray is missing.
    """
    found = [branch_dataset(b).assign_coords({BRANCH: ("point", [b.name] * len(b))}) for b in result.branches]
    whole = _xarray().concat(found, "point") if found else _xarray().Dataset()
    for name in whole.variables:
        if name in result.scales:
            whole[name].attrs["scale"] = result.scales[name]
    whole.attrs = {"problem": result.problem, "parameters": json.dumps(result.parameters)}
    return whole
