"""Paper 4: loads at which taut and wrinkled zones appear and disappear, and the fronts in between.

M = 1.5, delta = 2 under fluid: a narrow taut zone at the thin top exists from the start, a second one appears
near one third of the length, and both merge when the wrinkled zone between them disappears.
"""

from weakforms.cases import (
    Axis,
    Case,
    Claim,
    Count,
    Curve,
    Finding,
    Panel,
    Points,
    Solutions,
    Spec,
    decide,
    reference,
    wrinkled_tube,
)

EVENTS = reference(4, "zone_events")
KINDS = {1: "zone_opening", 2: "zone_closing", 3: "zone_closing"}
FLUID = wrinkled_tube(M=1.5, delta=2)
FRONTS = {
    "fluid_M_0.5_delta_2": (wrinkled_tube(M=0.5, delta=2), "zw", 16),
    "fluid_M_0.5_delta_3": (wrinkled_tube(M=0.5, delta=3), "zw", 16),
    "fluid_M_0.99_delta_2": (wrinkled_tube(M=0.99, delta=2), "zw", 16),
    "fluid_M_1.5_delta_2_low": (FLUID, "zw", 16),
    "fluid_M_1.5_delta_2_middle": (FLUID, "zw", 16),
    "fluid_M_1.5_delta_2_high": (FLUID, "zw", 16),
    "fluid_M_1.5_delta_3": (wrinkled_tube(M=1.5, delta=3), "zw", 16),
    "fluid_Af_0.4": (wrinkled_tube(M=0.5, delta=2, Af=0.4), "zw", 16),
    "fluid_Af_0.5": (wrinkled_tube(M=0.5, delta=2, Af=0.5), "zw", 16),
    "gas_M_0.5_delta_2": (wrinkled_tube(M=0.5, delta=2, load="gas"), "p", 0.6),
    "gas_M_0.5_delta_3": (wrinkled_tube(M=0.5, delta=3, load="gas"), "p", 0.6),
    "gas_M_1_delta_2_Af_0.6": (wrinkled_tube(M=1, delta=2, load="gas", Af=0.6), "p", 0.6),
    "case2_gas_M_0.3_delta_3": (wrinkled_tube(M=0.3, delta=3, load="gas", Af=1), "p", 0.01),
    "case2_gas_M_0.5_delta_2": (wrinkled_tube(M=0.5, delta=2, load="gas", Af=1), "p", 0.01),
    "case2_fluid_M_0.5_delta_2": (wrinkled_tube(M=0.5, delta=2, Af=1), "zw", 12),
    "case2_fluid_M_0.3_delta_3": (wrinkled_tube(M=0.3, delta=3, Af=1), "zw", 12),
}
CRITICAL = {(1.5, 2, 0.01, 8), (0.99, 2, 0.01, 8), (1.9, 1.25, 0, 12)}
"""(M, delta, c2, L) of the sets on disks of the critical radius."""


def set_of(row: int) -> tuple[float, ...]:
    """Parameters of a row."""
    return tuple(float(EVENTS.columns[name][row]) for name in ("M", "delta", "c2", "L", "Af", "fluid"))


def spec_of(row: int) -> Spec:
    """The membrane of a row of the table of events."""
    M, delta, c2, length, radius, fluid = set_of(row)
    given = {"M": M, "delta": delta} | ({} if fluid else {"load": "gas"})
    given |= {} if c2 == 0.01 else {"c2": c2}
    given |= {} if length == 8 else {"L": length}
    return wrinkled_tube(**given | ({} if (M, delta, c2, length) in CRITICAL else {"Af": radius}))


NEAR = decide.Stated(
    0.05, "near one third", "no number is printed; less than half of the distance to a fourth"
)


def order(solutions: Solutions) -> Finding:
    """M = 1.5, delta = 2: the second taut zone appears near a third of the length, the gap closes later."""
    (opens,), (closes,) = (solutions.points(FLUID, kind) for kind in ("zone_opening", "zone_closing"))
    return decide.all_of(
        decide.same("states", [opens.values["state"], closes.values["state"]], [1, -1]),
        decide.at_most("Z/L off a third", abs(decide.of_point(opens, "Z") / 8 - 1 / 3), NEAR),
        decide.less(
            "zw, around the printed 7.44", decide.of_point(opens, "zw"), 7.44, decide.of_point(closes, "zw")
        ),
    )


ROWS = range(len(EVENTS))

CASE = Case(
    title="Zones that appear, merge and disappear",
    source="Patil, Nordmark & Eriksson (2015), sections on case 1 and case 2",
    panels=tuple(
        Panel(
            name,
            x=Axis(control, 0, end),
            y=Axis("r_max", 0, 1.5),
            title=str(spec),
            note="Not a figure of the paper. The fronts are compared, the largest radius is drawn.",
            curves=(Curve(spec, name, reference=f"fronts_{name}"),),
        )
        for name, (spec, control, end) in FRONTS.items()
    ),
    checks=(
        Claim(
            "order",
            "M = 1.5, delta = 2: a second taut zone appears near one third of the length, later both merge",
            ((FLUID, None),),
            order,
        ),
        *(
            Points(
                KINDS[int(EVENTS.columns["event"][row])],
                reference="zone_events",
                base=spec_of(row),
                parameters=(),
                where={n: float(EVENTS.columns[n][row]) for n in ("set", "event")},
                asked={"load": 1e-5, "Z": 1e-5},
            )
            for row in ROWS
        ),
        *(
            Count(
                kind,
                {
                    spec_of(row): sum(
                        KINDS[int(EVENTS.columns["event"][other])] == kind and set_of(other) == set_of(row)
                        for other in ROWS
                    )
                    for row in ROWS
                },
                f"as many events of the kind {kind} as the reference has",
            )
            for kind in ("zone_opening", "zone_closing")
        ),
    ),
    asked={"Z_front_1": 1e-8, "Z_front_2": 1e-8, "Z_front_3": 5e-9},
)
