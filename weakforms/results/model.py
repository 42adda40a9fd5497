"""The records of a solution and their JSON form (schema ``weakforms.result/1``).

Every number here is converged. What did not converge is left out and listed as a :class:`Failure`.
Uncertainties are absolute, in the units of the value, and come from mesh refinement
(:mod:`weakforms.solvers.uncertainty.refinement`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

SCHEMA = "weakforms.result/1"


@dataclass(frozen=True)
class Quantity:
    """A number with its absolute uncertainty (``None`` if the number is a count or exact)."""

    value: float
    uncertainty: float | None = None
    order: float | None = None
    """Observed order of convergence in the mesh size, if there are three meshes."""

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
    """Columns sampled along the body, each with one absolute uncertainty."""

    name: str
    columns: dict[str, np.ndarray]
    uncertainty: dict[str, float] = field(default_factory=dict)

    def to_json(self) -> dict[str, Any]:
        """JSON object with lists for columns."""
        return {
            "name": self.name,
            "columns": {key: _plain(value) for key, value in self.columns.items()},
            "uncertainty": dict(self.uncertainty),
        }

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Field:
        """Inverse of :meth:`to_json`."""
        return cls(data["name"], _arrays(data["columns"]), dict(data.get("uncertainty", {})))


@dataclass(frozen=True)
class Branch:
    """A curve of equilibria in the order of continuation: one array per column, all of the same length."""

    name: str
    control: str
    columns: dict[str, np.ndarray]
    uncertainty: dict[str, np.ndarray] = field(default_factory=dict)
    """Absolute uncertainty for each column and point, in the direction across the branch."""

    def __len__(self) -> int:
        return len(next(iter(self.columns.values()), ()))

    def to_json(self) -> dict[str, Any]:
        """JSON object with lists for columns."""
        return {
            "name": self.name,
            "control": self.control,
            "columns": {key: _plain(value) for key, value in self.columns.items()},
            "uncertainty": {key: _plain(value) for key, value in self.uncertainty.items()},
        }

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Branch:
        """Inverse of :meth:`to_json`."""
        return cls(
            data["name"],
            data["control"],
            _arrays(data["columns"]),
            _arrays(data.get("uncertainty", {})),
        )


@dataclass(frozen=True)
class SpecialPoint:
    """A point solved for by an extended system, not interpolated in a table.

    ``kind`` is one of limit_point, bifurcation_point, cusp_point, contact_onset, front,
    stability_change, pull_off, zone_opening, zone_closing.
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

    def to_json(self) -> dict[str, Any]:
        """JSON object as the schema requires."""
        return {
            "at": dict(self.at),
            "branch": self.branch,
            "crossing": self.crossing,
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


@dataclass
class Result:
    """Everything that one ``solve`` returns; its JSON form is the contract with other programs."""

    problem: str
    parameters: dict[str, Any]
    scales: dict[str, str]
    numerics: dict[str, Any]
    provenance: dict[str, Any]
    branches: list[Branch] = field(default_factory=list)
    special_points: list[SpecialPoint] = field(default_factory=list)
    quantities: dict[str, Quantity] = field(default_factory=dict)
    states: list[State] = field(default_factory=list)
    failures: list[Failure] = field(default_factory=list)
    absent: list[Absence] = field(default_factory=list)

    def branch(self, name: str = "primary") -> Branch:
        """The branch of that name.

        Raises:
            KeyError: If there is none.
        """
        for branch in self.branches:
            if branch.name == name:
                return branch
        raise KeyError(f"no branch {name!r}; there are {[b.name for b in self.branches]}")

    def points(self, kind: str, branch: str | None = None) -> list[SpecialPoint]:
        """Special points of one kind, in their order along the branch."""
        return [
            point for point in self.special_points if point.kind == kind and branch in (None, point.branch)
        ]

    def to_json(self) -> dict[str, Any]:
        """JSON object of schema ``weakforms.result/1``; ``absent`` is there when something is."""
        absent = {"absent": [item.to_json() for item in self.absent]} if self.absent else {}
        return {
            "schema": SCHEMA,
            "problem": self.problem,
            "parameters": self.parameters,
            "scales": self.scales,
            "numerics": self.numerics,
            "provenance": self.provenance,
            "branches": [branch.to_json() for branch in self.branches],
            "special_points": [point.to_json() for point in self.special_points],
            "quantities": {key: q.to_json() for key, q in self.quantities.items()},
            "states": [state.to_json() for state in self.states],
            "failures": [failure.to_json() for failure in self.failures],
            **absent,
        }

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Result:
        """Inverse of :meth:`to_json`."""
        return cls(
            data["problem"],
            dict(data["parameters"]),
            dict(data["scales"]),
            dict(data["numerics"]),
            dict(data["provenance"]),
            [Branch.from_json(item) for item in data["branches"]],
            [SpecialPoint.from_json(item) for item in data["special_points"]],
            {key: Quantity.from_json(q) for key, q in data["quantities"].items()},
            [State.from_json(item) for item in data["states"]],
            [Failure(item["what"], item["reason"]) for item in data["failures"]],
            [Absence(item["what"], item["reason"]) for item in data.get("absent", [])],
        )


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
