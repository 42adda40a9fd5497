"""Paper 1 at other parameters than in the paper: other alpha, beta, k and l, all phases."""

from weakforms.cases import Axis, Case, Curve, Panel, Points, circular

SETS = (
    {"alpha": 0.05, "beta": 1.2, "k": 80, "l": 0.6},
    {"alpha": 0.05, "beta": 1.25, "k": 200, "l": 0.3},
    {"alpha": 0.15, "beta": 1, "k": 60, "l": 0.35},
    {"alpha": 0.2, "beta": 1.5, "k": 30, "l": 0.4},
    {"alpha": 0, "beta": 1.6, "k": 120, "l": 0.45},
)
KINDS = {
    "free": {},
    "frictionless": {"contact": "frictionless"},
    "adhesive": {"contact": "adhesive"},
    "deflation": {"contact": "adhesive", "phase": "deflation"},
}
NAMES = {"free": ("alpha", "beta")}
"""Parameters in the names of the tables; the others name all four."""


def curve(kind: str, data: dict[str, float], p_end: float) -> Curve:
    """A curve and its table."""
    kept = NAMES.get(kind, tuple(data))
    how = KINDS[kind] | ({"t_end": p_end} if kind == "free" else {"p_end": p_end})
    return Curve(
        circular(**{name: data[name] for name in kept}, **how),
        ", ".join(f"{name} = {data[name]:g}" for name in kept),
        reference=f"off_{kind}_" + "_".join(f"{name}_{data[name]:g}" for name in kept),
    )


ENDS = {
    "free": (4.1, 4.1, 4.1, 4.1, 3.1),
    "frictionless": (8.0,) * 5,
    "adhesive": (5.6, 3.6, 2.95, 6.9, 5.5),
    "deflation": (5.0, 2.5, 2.0, 6.0, 4.5),
}
"""End of each curve, in the order of the sets: t0 for free inflation, else p."""

PEELING = (
    (SETS[0], 2.4, 5.6),
    (SETS[2], 0.6, 2.8),
    (SETS[3], 2.4, 6.7),
    (SETS[4], 2.0, 5.6),
)
"""Data, pressure, and end of inflation."""


def peeling(data: dict[str, float], p: float, p_end: float) -> Curve:
    """A peeling curve and its table."""
    name = "_".join(f"{key}_{value:g}" for key, value in data.items())
    return Curve(
        circular(**data, contact="adhesive", phase="peeling", p=p, p_end=p_end),
        ", ".join(f"{key} = {value:g}" for key, value in data.items()) + f", p = {p:g}",
        reference=f"off_peeling_{name}_p_{p:g}",
    )


CASE = Case(
    title="All phases off the paper's parameters",
    source="the problem of Patil, DasGupta & Eriksson (2015) at other data",
    panels=(
        *(
            Panel(
                kind,
                x=Axis("p", 0, 8),
                y=Axis("t0", 0, 4 if kind == "free" else 0.8),
                title=kind,
                note="Not a figure of the paper.",
                curves=tuple(curve(kind, d, end) for d, end in zip(SETS, ends, strict=True)),
            )
            for kind, ends in ENDS.items()
        ),
        Panel(
            "peeling",
            x=Axis("rho_contact", 0, 0.6),
            y=Axis("G", 0, 1),
            title="peeling",
            markers="pull_off",
            note="Not a figure of the paper.",
            curves=tuple(peeling(*item) for item in PEELING),
        ),
    ),
    checks=tuple(
        Points(
            "pull_off",
            reference="pull_off",
            base=peeling(data, p, end).of,
            parameters=("p",),
            asked={"rho_contact": 1e-6, "G": 1e-5},
            where={**{key: data[key] for key in ("alpha", "beta", "k", "l")}, "p": p},
        )
        for data, p, end in PEELING
    ),
    asked={
        "p": 1e-6,
        "t0": 1e-6,
        "lam_pole": 1e-8,
        "rho_contact": 1e-6,
        "X_contact": 1e-6,
        "lam1_contact": 1e-5,
        "lam1_contact_outer": 1e-5,
        "sigma_pole": 1e-5,
        "sigma_contact": 1e-7,
        "V": 1e-6,
        "G": 1e-5,
    },
    slow=True,
)
