"""Paper 4 at other parameters than in the paper: M, delta, c2, L and disks."""

from weakforms.cases import At, Axis, Case, Curve, Panel, Spec, wrinkled_tube

SETS = (
    ("gas", 0.1, 2, 0.01, 8, "critical", (0.05, 0.2)),
    ("gas", 0.7, 4, 0.1, 5, "critical", (0.3, 1)),
    ("gas", 0.8, 2.5, 0.02, 6, 0.5, (0.1, 0.6)),
    ("fluid", 0.3, 2.5, 0.03, 8, "critical", (4.5, 9)),
    ("fluid", 1.3, 1.5, 0.05, 10, 0.6, (4, 9)),
    ("fluid", 1.7, 3, 0, 8, 1, (4, 12)),
    ("fluid", 1.9, 1.25, 0, 12, "critical", (5, 10)),
)
CONTROL = {"gas": "p", "fluid": "zw"}


def name(load: str, M: float, delta: float, c2: float, length: float, radius: object, _: object) -> str:
    """Name of the table of a set."""
    return f"off_{load}_M_{M}_delta_{delta}_c2_{c2}_L_{length}_Af_{radius}"


def spec(load: str, M: float, delta: float, c2: float, length: float, radius: object, _: object) -> Spec:
    """The membrane of a set, without default values, so that solutions are shared with other cases."""
    given = {"M": M, "delta": delta} | ({} if load == "fluid" else {"load": load})
    given |= {} if c2 == 0.01 else {"c2": float(c2)}
    given |= {} if length == 8 else {"L": float(length)}
    tube = wrinkled_tube(**given | ({} if radius == "critical" else {"Af": float(radius)}))
    # Its thick lower end has layers at fronts and disk that are thin relative to the length.
    return tube.on(cells=48) if M == 1.9 else tube


CASE = Case(
    title="Off the paper's parameters",
    source="the problem of Patil, Nordmark & Eriksson (2015) at other data",
    panels=(
        *(
            Panel(
                f"{name(*data)}, branch",
                x=Axis(CONTROL[data[0]], 0, 1.2 if data[0] == "gas" else 16),
                y=Axis("r_max", 0, 1.5),
                note="Not a figure of the paper.",
                curves=(Curve(spec(*data), str(spec(*data)), reference=name(*data)),),
            )
            for data in SETS
        ),
        *(
            Panel(
                name(*data),
                x=Axis("Z", 0, data[4]),
                y=Axis("gw", 0, 2),
                note="Not a figure of the paper.",
                curves=tuple(
                    Curve(
                        spec(*data),
                        f"{CONTROL[data[0]]} = {v}",
                        reference=f"{name(*data)}_{CONTROL[data[0]]}_{v}",
                        at=At(CONTROL[data[0]], float(v), profile=()),
                    )
                    for v in data[6]
                ),
            )
            for data in SETS
        ),
    ),
    asked={
        **dict.fromkeys(("r", "z", "lam1", "lam2", "gw", "tension"), 1e-8),
        **dict.fromkeys(("V", "r_max", "gw_min"), 1e-8),
        "N": 2e-7,
        "gw_max": 2e-6,
        "wrinkled_fraction": 1e-7,
    },
    slow=True,
)
