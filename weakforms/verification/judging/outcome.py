"""Outcomes of cases and runs: everything that the report needs without further solves.

``report.json`` (schema ``weakforms.report/1``) is a :class:`RunOutcome` as JSON. The HTML report,
``junit.xml`` and the terminal summary use only this file.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any

SCHEMA = "weakforms.report/1"


@dataclass
class Verdict:
    """The outcome of one check: an error and its bound, which nobody chooses.

    A numerical check passes if ``error <= bound`` *and* ``bound <= asked``. The bound is twice the combined
    uncertainty of both sides, and ``asked`` is the asked accuracy; all three are relative to ``scale``. A
    structural check (a count, an order, a sign) has ``error = bound = asked = None``.
    """

    check: str
    """Stable identifier inside the case, such as ``fig03a_delta1_1:p``."""
    kind: str
    """curve, point, field, count, claim, printed, order, exact or convergence."""
    passed: bool
    statement: str
    """The statement, in one sentence for a reader of the paper."""
    detail: str = ""
    """The numbers that were found."""
    error: float | None = None
    bound: float | None = None
    asked: float | None = None
    uncertainty: float | None = None
    """Uncertainty of the weak form, relative to the same scale."""
    reference_uncertainty: float | None = None
    where: str = ""
    """The abscissa of the worst point, such as ``u_max = 1.25``."""
    reference: str = ""
    """Name of the reference table, or of the exact statement."""
    widest: float | None = None
    """The largest bound over all rows, if there are several, which must be below ``asked``."""
    differs: str = ""
    """The different statement of the paper, if there is one, and why it is not true."""


@dataclass
class Printed:
    """An entry of the ledger: one printed number or statement of the thesis."""

    what: str
    printed: str
    """The number as printed, with all digits."""
    computed: float | None
    uncertainty: float | None
    status: str
    """reproduced, cut off, grid of a scan, misprint, or an input of a figure that is decoded or not."""
    evidence: str = ""
    source: str = ""
    """Place in the paper."""


@dataclass
class CurveOutcome:
    """One curve of a panel with its reference and the residual between them."""

    name: str
    label: str
    x: list[float]
    y: list[float]
    unstable: list[int] = field(default_factory=list)
    """Whether each point is unstable (drawn dashed), or how many negative eigenvalues it has (two or more are
    drawn dotted); empty if stability was not judged."""
    reference_name: str = ""
    reference_kind: str = ""
    """exact, independent, printed or other-code."""
    reference_x: list[float] = field(default_factory=list)
    reference_y: list[float] = field(default_factory=list)
    residual_abscissa: str = ""
    residual_x: list[float] = field(default_factory=list)
    residual: list[float] = field(default_factory=list)
    """Relative error |weak form - reference| / scale at each row of the table."""
    residual_bound: list[float] = field(default_factory=list)
    """The bound at each row, relative to the same scale."""


@dataclass
class Marker:
    """A special point drawn on a panel."""

    kind: str
    label: str
    x: float
    y: float


@dataclass
class PathOutcome:
    """The path of a material point over a series of states."""

    point: float
    x: list[float]
    y: list[float]


@dataclass
class PanelOutcome:
    """One panel of a figure on the thesis's axes (``x_range``/``y_range`` as printed there)."""

    name: str
    title: str
    x: str
    y: str
    x_label: str
    """TeX, such as ``$p$``."""
    y_label: str
    x_range: tuple[float, float]
    y_range: tuple[float, float]
    curves: list[CurveOutcome] = field(default_factory=list)
    markers: list[Marker] = field(default_factory=list)
    note: str = ""
    drawn: str = "weak form"
    """Text on the curves."""
    full: str = "stable"
    """Meaning of full and of dashed lines, if there are any."""
    dashed: str = "unstable"
    dotted: str = ""
    """Meaning of dotted lines, if there are any."""
    paths: list[PathOutcome] = field(default_factory=list)
    level: float | None = None
    """Height of a dashed line across the panel."""


@dataclass
class SurfaceOutcome:
    """A deformed surface in space."""

    name: str
    title: str
    position: list[list[list[float]]]
    """``x, y, z`` over the two coordinates of the surface."""
    ranges: list[tuple[float, float]]
    labels: list[str]
    note: str = ""
    curves: list[CurveOutcome] = field(default_factory=list)
    """``None``, because nothing is compared."""
    fields: dict[str, list[list[float]]] = field(default_factory=dict)
    """Further fields on the surface, for other programs."""


@dataclass
class Convergence:
    """Refinement history of one quantity, on which its uncertainty is based."""

    quantity: str
    degree: int
    cells: list[int]
    errors: list[float]
    """Relative errors with respect to the reference value or the finest mesh, one for each mesh."""
    observed_order: float | None
    expected_order: float | None
    against: str
    """The value for which errors are computed."""


@dataclass
class CaseOutcome:
    """The outcome of one case: verdicts, pictures, ledger entries, convergence."""

    id: str
    """Id of the case, such as ``paper2.fig03``."""
    title: str
    source: str
    description: str
    """The docstring of the case file."""
    status: str
    """passed, failed, or error (a solve did not converge, or the input was bad)."""
    verdicts: list[Verdict] = field(default_factory=list)
    panels: list[PanelOutcome] = field(default_factory=list)
    printed: list[Printed] = field(default_factory=list)
    convergence: list[Convergence] = field(default_factory=list)
    errors: list[str] = field(default_factory=list)
    seconds: float = 0.0
    solutions: list[dict[str, Any]] = field(default_factory=list)
    """For each solution its problem, parameters, numerics, provenance, and file."""
    surfaces: list[SurfaceOutcome] = field(default_factory=list)


@dataclass
class RunOutcome:
    """A whole run of ``verify``."""

    profile: str
    selection: str
    started: str
    """Time in ISO 8601, UTC."""
    seconds: float
    environment: dict[str, str]
    """Versions of the stack, machine, cores, memory, ranks, git revision."""
    cases: list[CaseOutcome] = field(default_factory=list)

    @property
    def status(self) -> str:
        """``error`` if any case could not be solved, else ``failed`` or ``passed``."""
        kinds = {case.status for case in self.cases}
        return next((kind for kind in ("error", "failed") if kind in kinds), "passed")

    def to_json(self) -> dict[str, Any]:
        """JSON object of schema ``weakforms.report/1``."""
        return {"schema": SCHEMA, "status": self.status, **asdict(self)}

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> RunOutcome:
        """Inverse of :meth:`to_json`."""
        values = {k: v for k, v in data.items() if k not in ("schema", "status", "cases")}
        return cls(**values, cases=[case_from_json(item) for item in data["cases"]])


def case_from_json(data: dict[str, Any]) -> CaseOutcome:
    """A :class:`CaseOutcome` from its JSON object (one file for each case, so that a run can resume)."""
    nested = {
        "verdicts": [Verdict(**item) for item in data["verdicts"]],
        "panels": [
            PanelOutcome(
                **{
                    **item,
                    "x_range": tuple(item["x_range"]),
                    "y_range": tuple(item["y_range"]),
                    "curves": [CurveOutcome(**curve) for curve in item["curves"]],
                    "markers": [Marker(**marker) for marker in item["markers"]],
                    "paths": [PathOutcome(**path) for path in item["paths"]],
                }
            )
            for item in data["panels"]
        ],
        "surfaces": [
            SurfaceOutcome(**{**item, "ranges": [tuple(pair) for pair in item["ranges"]]})
            for item in data.get("surfaces", [])
        ],
        "printed": [Printed(**item) for item in data["printed"]],
        "convergence": [Convergence(**item) for item in data["convergence"]],
    }
    return CaseOutcome(**{**data, **nested})
