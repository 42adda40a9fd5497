"""A result: everything that one solve returns (schema ``weakforms.result/1``)."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from weakforms.errors import closest, not_among
from weakforms.results.model import KINDS, Absence, Branch, Failure, Quantity, SpecialPoint, State

if TYPE_CHECKING:
    import pandas
    import xarray
    from matplotlib.figure import Figure

SCHEMA = "weakforms.result/1"


@dataclass(repr=False)
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
    warnings: list[str] = field(default_factory=list)
    """A parameter that was set and has no effect, or one that was changed to reach a requested state."""

    def branch(self, name: str = "primary") -> Branch:
        """The branch of that name.

        Raises:
            KeyError: If there is none.
        """
        for branch in self.branches:
            if branch.name == name:
                return branch
        raise KeyError(f"no branch {name!r}{not_among(name, [b.name for b in self.branches])}")

    def points(self, kind: str, branch: str | None = None) -> list[SpecialPoint]:
        """Special points of one kind, in their order along the branch.

        Raises:
            KeyError: If no point is ever of this kind, which a misspelt name would hide.
        """
        if kind not in KINDS:
            similar, found = closest(kind, KINDS), dict.fromkeys(p.kind for p in self.special_points)
            hint = f"; did you mean {similar!r}?" if similar else "."
            has = f"The result has {', '.join(found) or 'none'}"
            raise KeyError(f"no kind of special point {kind!r}{hint} {has}")
        return [
            point for point in self.special_points if point.kind == kind and branch in (None, point.branch)
        ]

    def __repr__(self) -> str:
        from weakforms.results.wording import short

        return short(self)

    def _repr_html_(self) -> str:
        from weakforms.results.notebook import html

        return html(self)

    def plot(self, x: str = "", y: str = "") -> Figure:
        """Draw one column over another with special points and stability, or a diagram in its plane.

        :mod:`weakforms.results.plot` has the details.

        Raises:
            InputError: If a column is missing, or there is nothing to draw.
            EnvironmentLackError: If matplotlib is missing.
        """
        from weakforms.results.diagram import draw

        return draw({"": self}, x, y)

    def to_pandas(self) -> pandas.DataFrame:
        """A ``DataFrame`` of :func:`weakforms.results.frames.result_frame`."""
        from weakforms.results.frames import result_frame

        return result_frame(self)

    def to_xarray(self) -> xarray.Dataset:
        """A ``Dataset`` of :func:`weakforms.results.frames.result_dataset`."""
        from weakforms.results.frames import result_dataset

        return result_dataset(self)

    def to_json(self) -> dict[str, Any]:
        """JSON object of schema ``weakforms.result/1``, without ``absent`` or ``warnings`` that are empty."""
        absent = {"absent": [item.to_json() for item in self.absent]} if self.absent else {}
        absent |= {"warnings": list(self.warnings)} if self.warnings else {}
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
            list(data.get("warnings", [])),
        )
