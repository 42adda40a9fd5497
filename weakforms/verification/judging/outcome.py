"""What judging a case leaves behind: everything the report draws, and nothing that must be solved again.

``report.json`` (schema ``weakforms.report/1``) is a :class:`RunOutcome` written out; the HTML report,
``junit.xml`` and the terminal summary are made from it alone.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any

SCHEMA = "weakforms.report/1"


@dataclass
class Verdict:
    """One check: an error held against a bound that was not picked by hand.

    A numerical check passes when ``error <= bound`` *and* ``bound <= asked``: the bound is twice the
    combined uncertainty of both sides, ``asked`` the accuracy wanted; all three relative to ``scale``.
    A structural check (a count, an order, a sign) has ``error = bound = asked = None``.
    """

    check: str
    """Stable identifier inside the case, such as ``fig03a_delta1_1:p``."""
    kind: str
    """curve, point, field, count, claim, printed, order, exact or convergence."""
    passed: bool
    statement: str
    """What is claimed, in one sentence a reader of the paper understands."""
    detail: str = ""
    """What was found, with numbers."""
    error: float | None = None
    bound: float | None = None
    asked: float | None = None
    uncertainty: float | None = None
    """Of the weak-form side, relative to the same scale."""
    reference_uncertainty: float | None = None
    where: str = ""
    """The abscissa of the worst point, such as ``u_max = 1.25``."""
    reference: str = ""
    """Name of the reference table, or of the exact statement."""
    widest: float | None = None
    """The largest bound over all rows, where there are several: it is what must be below ``asked``."""
    differs: str = ""
    """Where the paper says otherwise: what it says, and why that does not hold."""


@dataclass
class Printed:
    """One printed number or statement of the thesis in the ledger."""

    what: str
    printed: str
    """As printed, all digits."""
    computed: float | None
    uncertainty: float | None
    status: str
    """reproduced, cut off, grid of a scan, misprint, or an input of a figure that is decoded or not."""
    evidence: str = ""
    source: str = ""
    """Where in the paper."""


@dataclass
class CurveOutcome:
    """One curve of a panel with its reference and the residual between them."""

    name: str
    label: str
    x: list[float]
    y: list[float]
    unstable: list[bool] = field(default_factory=list)
    """Per point: negative eigenvalues under the branch's control; drawn dashed. Empty: not judged."""
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
    """What the curves are."""
    full: str = "stable"
    """What full lines mean, and dashed ones, where there are any."""
    dashed: str = "unstable"
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
    """None: nothing is compared."""
    fields: dict[str, list[list[float]]] = field(default_factory=dict)
    """What else is known over the surface, for those who open it in another program."""


@dataclass
class Convergence:
    """Refinement history of one quantity: what the uncertainties rest on."""

    quantity: str
    degree: int
    cells: list[int]
    errors: list[float]
    """Against the reference value or the finest mesh, relative; one a mesh."""
    observed_order: float | None
    expected_order: float | None
    against: str
    """What the errors are measured against."""


@dataclass
class CaseOutcome:
    """All that one case leaves: verdicts, pictures, ledger entries, convergence."""

    id: str
    """Such as ``paper2.fig03``."""
    title: str
    source: str
    description: str
    """The case file's docstring, and what a reader should know."""
    status: str
    """passed, failed, or error (a solve did not converge, or the input was bad)."""
    verdicts: list[Verdict] = field(default_factory=list)
    panels: list[PanelOutcome] = field(default_factory=list)
    printed: list[Printed] = field(default_factory=list)
    convergence: list[Convergence] = field(default_factory=list)
    errors: list[str] = field(default_factory=list)
    seconds: float = 0.0
    solutions: list[dict[str, Any]] = field(default_factory=list)
    """Per solve: problem, parameters, numerics, provenance, file of the stored result."""
    surfaces: list[SurfaceOutcome] = field(default_factory=list)


@dataclass
class RunOutcome:
    """A whole run of ``verify``."""

    profile: str
    selection: str
    started: str
    """ISO 8601, UTC."""
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
    """A :class:`CaseOutcome` from its JSON object (stored one a case, so that a run can resume)."""
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
