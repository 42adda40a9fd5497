"""The records of which a result consists, and their JSON form (schema ``weakforms.result/1``).

Every number here is converged. What did not converge is left out and listed as a :class:`Failure`.
Uncertainties are absolute, in the units of the value, and come from mesh refinement
(:mod:`weakforms.solvers.uncertainty.refinement`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from weakforms.errors import not_among
from weakforms.results.uncertain import uncertain

if TYPE_CHECKING:
    import pandas
    import xarray

ROUND_OFF = 1e-14
"""Relative distance within which the first or last point of a branch has a value."""


def crossings(column: np.ndarray, value: float) -> np.ndarray:
    """Indices of the points of a branch after which a column takes a value.

    A point that has the value exactly counts with the interval before it. The first and the last point have
    it within :data:`ROUND_OFF`, because there no neighbour makes up for rounding.
    """
    if not len(column):
        return np.empty(0, dtype=int)
    distance = column - value
    for end in (0, -1):
        distance[end] *= abs(distance[end]) > ROUND_OFF * abs(value)
    hits = np.flatnonzero((distance[:-1] * distance[1:] < 0) | (distance[1:] == 0))
    return np.concatenate([[0], hits]) if distance[0] == 0 else hits


SYMMETRY_BREAKING = ("mirror_breaking", *(f"bifurcation_n{n}" for n in range(1, 7)))
"""Bifurcation points whose kind says which symmetry is lost: that along the axis, or around it to n waves."""

TWO_CONDITIONS = (
    *("fold_mirror", "tip_mirror", "wrinkling_fold", "wrinkling_mirror", "contact_fold", "contact_mirror"),
)
"""Points of the lines of a diagram at which a second condition holds, besides cusps."""

WITH_WAVES = (
    *(f"{other}_n{n}" for n in range(1, 4) for other in ("fold", "mirror", "tip", "wrinkling", "contact")),
    *("n1_n2", "n1_n3", "n2_n3"),
)
"""The same on lines at which 1 to 3 waves around the axis are neutral."""

OF_LONG_WAVES = ("fold_localisation", "tip_localisation", "wrinkling_localisation", "localisation_n1")
"""The same on lines at which long axisymmetric waves of a long tube are neutral."""

KINDS = (
    *("limit_point", "bifurcation_point", "cusp_point", "contact_onset", "front", "stability_change"),
    *("pull_off", "zone_opening", "zone_closing", "volume_fold", "wrinkling_onset"),
    *TWO_CONDITIONS,
    *SYMMETRY_BREAKING,
    *WITH_WAVES,
    "mass_fold",
    *OF_LONG_WAVES,
)
"""Kinds of special points, as in the schema."""

COUNTS = (
    *("n_negative", "n_all", "n_held", "n_fixed_", "n_mirror", "n_localisation"),
    *("n_odd_", "n_even_odd", "n_A", "n_B"),
)
"""Beginnings of the names of counts of eigenvalues."""


@dataclass(frozen=True)
class Quantity:
    """A number with its absolute uncertainty (``None`` if the number is a count or exact)."""

    value: float
    uncertainty: float | None = None
    order: float | None = None
    """Observed order of convergence in the mesh size, if there are three meshes."""

    def __format__(self, spec: str) -> str:
        """The number with its uncertainty, ``2.018852029(20)``; a format is for the value alone."""
        return format(self.value, spec) if spec else uncertain(self.value, self.uncertainty)

    def __str__(self) -> str:
        return format(self)

    def to_json(self) -> dict[str, Any]:
        """JSON object ``{"value", "uncertainty"[, "order"]}``."""
        out: dict[str, Any] = {"value": self.value, "uncertainty": self.uncertainty}
        if self.order is not None:
            out["order"] = self.order
        return out

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Quantity:
        """Inverse of :meth:`to_json`."""
        return cls(data["value"], data.get("uncertainty"), data.get("order"))


@dataclass(frozen=True)
class Field:
    """Columns sampled along the body, each with one absolute uncertainty, or with one for each row."""

    name: str
    columns: dict[str, np.ndarray]
    uncertainty: dict[str, float | np.ndarray] = field(default_factory=dict)

    def to_json(self) -> dict[str, Any]:
        """JSON object with lists for columns."""
        return {
            "name": self.name,
            "columns": {key: _plain(value) for key, value in self.columns.items()},
            "uncertainty": {
                k: float(v) if np.ndim(v) == 0 else _plain(v) for k, v in self.uncertainty.items()
            },
        }

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Field:
        """Inverse of :meth:`to_json`."""
        spread = data.get("uncertainty", {})
        rows = _arrays({key: value for key, value in spread.items() if isinstance(value, list)})
        return cls(data["name"], _arrays(data["columns"]), spread | rows)

    def at(self, rows: np.ndarray) -> Field:
        """Some of the rows, by their numbers or by a mask."""
        spread = {k: v if np.ndim(v) == 0 else v[rows] for k, v in self.uncertainty.items()}
        return Field(self.name, {k: v[rows] for k, v in self.columns.items()}, spread)


@dataclass(frozen=True)
class Ended:
    """Why a branch ends where it does."""

    by: str
    """The parameter that ends it, such as ``u_end``; or ``failure``, ``absent``, or another short word."""
    column: str
    """The column that takes a value there."""
    value: float
    """This value: the parameter's, or that of the last point."""
    reason: str = ""
    """More about it: why, if no parameter ends the branch, or what lies beyond."""

    def __str__(self) -> str:
        why = self.by if not self.reason else f"{self.by}: {self.reason}"
        return f"{self.column} = {self.value:.6g} ({why})"

    def to_json(self) -> dict[str, Any]:
        """JSON object ``{"by", "column", "value"[, "reason"]}``."""
        reason = {"reason": self.reason} if self.reason else {}
        return {"by": self.by, "column": self.column, "value": self.value, **reason}

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Ended:
        """Inverse of :meth:`to_json`."""
        return cls(data["by"], data["column"], data["value"], data.get("reason", ""))


@dataclass(frozen=True, repr=False)
class Branch:
    """A curve of equilibria in the order of continuation: one array per column, all of the same length."""

    name: str
    control: str
    columns: dict[str, np.ndarray]
    uncertainty: dict[str, np.ndarray] = field(default_factory=dict)
    """Absolute uncertainty for each column and point, in the direction across the branch."""
    ended: Ended | None = None
    """Why the branch ends where it does, if this is known."""

    def __len__(self) -> int:
        return len(next(iter(self.columns.values()), ()))

    def __getitem__(self, name: str) -> np.ndarray:
        """The values of a column over the points of the branch.

        Raises:
            KeyError: If there is no such column; the message names a similar one.
        """
        if name not in self.columns:
            raise KeyError(f"no column {name!r}{not_among(name, self.columns)}")
        return self.columns[name]

    def __repr__(self) -> str:
        end = f", ends at {self.ended}" if self.ended else ""
        return f"<Branch {self.name}: {len(self)} points over {self.control}{end}; {', '.join(self.columns)}>"

    def crossings(self, name: str, value: float) -> int:
        """How often a column takes a value along the branch."""
        column = np.asarray(self[name], float)
        return len(crossings(column[np.isfinite(column)], value))

    def to_json(self) -> dict[str, Any]:
        """JSON object with lists for columns."""
        ended = {} if self.ended is None else {"ended": self.ended.to_json()}
        return {
            "name": self.name,
            "control": self.control,
            "columns": {key: _plain(value) for key, value in self.columns.items()},
            "uncertainty": {key: _plain(value) for key, value in self.uncertainty.items()},
            **ended,
        }

    def to_pandas(self) -> pandas.DataFrame:
        """A ``DataFrame`` of :func:`weakforms.results.frames.branch_frame`."""
        from weakforms.results.frames import branch_frame

        return branch_frame(self)

    def to_xarray(self) -> xarray.Dataset:
        """A ``Dataset`` of :func:`weakforms.results.frames.branch_dataset`."""
        from weakforms.results.frames import branch_dataset

        return branch_dataset(self)

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Branch:
        """Inverse of :meth:`to_json`."""
        return cls(
            data["name"],
            data["control"],
            _arrays(data["columns"]),
            _arrays(data.get("uncertainty", {})),
            Ended.from_json(data["ended"]) if data.get("ended") else None,
        )


@dataclass(frozen=True)
class SpecialPoint:
    """A point solved for by an extended system, not interpolated in a table.

    ``kind`` is one of limit_point, bifurcation_point, cusp_point, contact_onset, front,
    stability_change, pull_off, zone_opening, zone_closing, volume_fold, mass_fold, wrinkling_onset,
    mirror_breaking, bifurcation_n1 to bifurcation_n6; where two conditions hold on a line of a diagram,
    fold_mirror, tip_mirror, wrinkling_fold, wrinkling_mirror, contact_fold, contact_mirror, and
    with n1 to n3, or localisation, in place of mirror; mirror_n1 to mirror_n3, n1_n2, n1_n3, n2_n3,
    localisation_n1.
    """

    kind: str
    branch: str
    control: str
    values: dict[str, float]
    uncertainty: dict[str, float]
    status: str = "converged"
    orders: dict[str, float] = field(default_factory=dict)

    def to_json(self) -> dict[str, Any]:
        """JSON object as the schema requires."""
        return {
            "kind": self.kind,
            "branch": self.branch,
            "control": self.control,
            "values": dict(self.values),
            "uncertainty": dict(self.uncertainty),
            "status": self.status,
            "orders": dict(self.orders),
        }

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> SpecialPoint:
        """Inverse of :meth:`to_json`."""
        return cls(
            data["kind"],
            data["branch"],
            data["control"],
            dict(data["values"]),
            dict(data["uncertainty"]),
            data.get("status", "converged"),
            dict(data.get("orders", {})),
        )


@dataclass(frozen=True)
class State:
    """One equilibrium, requested at an exact value of a column of its branch, with its fields."""

    at: dict[str, float]
    branch: str
    quantities: dict[str, Quantity]
    fields: tuple[Field, ...] = ()
    crossing: int = 1
    crossings: int | None = None
    """How often the branch takes this value; ``None`` if this was not counted."""

    def to_json(self) -> dict[str, Any]:
        """JSON object as the schema requires."""
        crossings = {} if self.crossings is None else {"crossings": self.crossings}
        return {
            "at": dict(self.at),
            "branch": self.branch,
            "crossing": self.crossing,
            **crossings,
            "quantities": {key: q.to_json() for key, q in self.quantities.items()},
            "fields": [item.to_json() for item in self.fields],
        }

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> State:
        """Inverse of :meth:`to_json`."""
        return cls(
            dict(data["at"]),
            data["branch"],
            {key: Quantity.from_json(q) for key, q in data["quantities"].items()},
            tuple(Field.from_json(item) for item in data.get("fields", [])),
            data.get("crossing", 1),
            data.get("crossings"),
        )


@dataclass(frozen=True)
class Failure:
    """Something that was requested and could not be computed, with the reason."""

    what: str
    reason: str

    def to_json(self) -> dict[str, str]:
        """JSON object ``{"what", "reason"}``."""
        return {"what": self.what, "reason": self.reason}


@dataclass(frozen=True)
class Absence(Failure):
    """Something asked for that is not there, and what was searched for it: no failure of a solve."""


def _plain(values: np.ndarray) -> list[float | int | None]:
    """A JSON list; integers stay integers and a number that is not finite becomes ``null``."""
    array = np.asarray(values)
    if array.dtype.kind in "iu":
        return [int(v) for v in array]
    return [float(v) if math.isfinite(v) else None for v in array]


def _arrays(columns: dict[str, list]) -> dict[str, np.ndarray]:
    return {
        key: np.array(
            [np.nan if v is None else v for v in values],
            dtype=int if values and all(isinstance(v, int) for v in values) else float,
        )
        for key, values in columns.items()
    }
