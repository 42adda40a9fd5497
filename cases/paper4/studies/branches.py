"""Paper 4: volume, radius, tension, extremes of gw and wrinkled fraction over the load, and limit loads.

There is no limit load up to p = 0.55 or zw = 16; for M = 0.5, delta = 3 one lies just above p = 0.55.
"""

from weakforms.cases import (
    Axis,
    Case,
    Claim,
    Curve,
    Finding,
    Panel,
    Points,
    Solutions,
    decide,
    reference,
    wrinkled_tube,
)

BRANCHES = {
    "gas_M_0.5_delta_2": wrinkled_tube(M=0.5, delta=2, load="gas"),
    "gas_M_0.5_delta_3": wrinkled_tube(M=0.5, delta=3, load="gas"),
    "gas_M_1_delta_2": wrinkled_tube(M=1, delta=2, load="gas"),
    "gas_M_1_delta_2_Af_0.6": wrinkled_tube(M=1, delta=2, load="gas", Af=0.6),
    "standard_gas_M_0.5_delta_2": wrinkled_tube(M=0.5, delta=2, load="gas", energy="standard"),
    "standard_gas_M_0.5_delta_3": wrinkled_tube(M=0.5, delta=3, load="gas", energy="standard"),
    "case2_gas_M_0.5_delta_2": wrinkled_tube(M=0.5, delta=2, load="gas", Af=1),
    "case2_gas_M_0.3_delta_3": wrinkled_tube(M=0.3, delta=3, load="gas", Af=1),
    "case2_gas_M_0.9_delta_2": wrinkled_tube(M=0.9, delta=2, load="gas", Af=1),
    "fluid_M_0.5_delta_2": wrinkled_tube(M=0.5, delta=2),
    "fluid_M_0.5_delta_3": wrinkled_tube(M=0.5, delta=3),
    "fluid_M_1.5_delta_2": wrinkled_tube(M=1.5, delta=2),
    "fluid_M_1.5_delta_3": wrinkled_tube(M=1.5, delta=3),
    "fluid_M_0.99_delta_2": wrinkled_tube(M=0.99, delta=2),
    "fluid_M_1_delta_2": wrinkled_tube(M=1, delta=2),
    "fluid_Af_0.4": wrinkled_tube(M=0.5, delta=2, Af=0.4),
    "fluid_Af_0.5": wrinkled_tube(M=0.5, delta=2, Af=0.5),
    "case2_fluid_M_0.5_delta_2": wrinkled_tube(M=0.5, delta=2, Af=1),
    "case2_fluid_M_0.3_delta_3": wrinkled_tube(M=0.3, delta=3, Af=1),
}
LIMITS = {load: wrinkled_tube(load=load, load_end=end) for load, end in (("gas", 1.2), ("fluid", 40.0))}
TABLES = {load: reference(4, f"limit_loads_{load}") for load in LIMITS}
PARAMETERS = ("M", "delta", "c2", "L", "Af")
PAPER = {"gas": ("p", 0.55), "fluid": ("zw", 16.0)}


def members(load: str) -> list:
    """The membranes of a table of limit loads, as the checks name them."""
    columns = TABLES[load].columns
    return [
        LIMITS[load].at(**{name: float(columns[name][row]) for name in PARAMETERS})
        for row in range(len(TABLES[load]))
        if columns["delta"][row] in (2, 3) and columns["M"][row] in (0.5, 1.5) and columns["L"][row] == 8
    ]


def no_limit_in_range(solutions: Solutions) -> Finding:
    """Lowest limit loads of the paper's sets."""
    found = []
    for load, (control, end) in PAPER.items():
        loads = decide.stack(solutions.point(spec, "limit_point", control) for spec in members(load))
        found.append(decide.positive(f"{control} at limit points minus {end:g}", loads - end))
    return decide.all_of(found)


def stable_below(solutions: Solutions) -> Finding:
    """Negative eigenvalues of the second variation at fixed load, in the axisymmetric space."""
    found = []
    for load in PAPER:
        for spec in members(load):
            counts = solutions.branch(spec).columns["n_negative"]
            below, above = decide.sides(solutions.along(spec, "V"), solutions.point(spec, "limit_point", "V"))
            found.append(decide.every("none before the limit load", counts[below] == 0))
            found.append(decide.every("one or more after it", counts[above] >= 1))
    return decide.all_of(found)


CASE = Case(
    title="Branches over the load",
    source="Patil, Nordmark & Eriksson (2015), sections on case 1 and case 2",
    panels=tuple(
        Panel(
            name,
            x=Axis(control, 0, end),
            y=Axis("r_max", 0, 1.5),
            title=name.replace("_", " "),
            note="Not a figure of the paper.",
            curves=(Curve(spec, name.replace("_", " "), reference=name),),
        )
        for name, spec in BRANCHES.items()
        for control, end in [PAPER["gas" if "gas" in name else "fluid"]]
    ),
    checks=(
        *(
            Points(
                "limit_point",
                reference=f"limit_loads_{load}",
                base=LIMITS[load],
                parameters=PARAMETERS,
                asked={PAPER[load][0]: 1e-8, "V": 1e-7, "r_max": 5e-8},
            )
            for load in LIMITS
        ),
        Claim(
            "no_limit_in_range",
            "no limit load up to p = 0.55 and zw = 16",
            tuple((spec, None) for load in LIMITS for spec in members(load)),
            no_limit_in_range,
        ),
        Claim(
            "stable_below",
            "at fixed load the branch is stable to axisymmetric changes up to the limit load, not after it",
            tuple((spec, None) for load in LIMITS for spec in members(load)),
            stable_below,
        ),
    ),
    asked={
        "V": 5e-9,
        "r_max": 5e-9,
        "N": 5e-9,
        "gw_max": 1e-6,
        "gw_min": 5e-9,
        "wrinkled_fraction": 1e-6,
    },
    slow=True,
)
