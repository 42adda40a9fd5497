"""Paper 4: membranes whose thickness is given as an expression of the coordinate along the meridian.

A cylinder between disks a little wider than the critical ones, which is thin in the middle, wrinkles at
both thick ends. A flat disk does not wrinkle with any of these thicknesses (section 5.1(a), which the paper
reports without a figure).
"""

import numpy as np

from weakforms.cases import (
    At,
    Axis,
    Case,
    Claim,
    Curve,
    Finding,
    Panel,
    Points,
    Solutions,
    circular,
    decide,
    wrinkled_tube,
)

COSINE = "1 + 0.4*cos(2*pi*Z/L)"
FLUID = wrinkled_tube(thickness=COSINE, Af=0.65, load_end=12.0)
GAS = wrinkled_tube(thickness=COSINE, Af=0.65, load="gas", load_end=0.3)
DISK = circular(thickness="1 + 0.2*cos(pi*X)", t_end=2.0)

SMALL = {"load": "gas", "load_end": 0.2, "Af": 0.4}
SAME = (
    (wrinkled_tube(M=0.5, **SMALL), wrinkled_tube(thickness="0.5 + Z/L", **SMALL), At("p", 0.15)),
    (wrinkled_tube(M=1.0, **SMALL), wrinkled_tube(thickness="1", **SMALL), At("p", 0.15)),
    (circular(M=0.5, t_end=1.0), circular(thickness="0.5 + X", t_end=1.0), At("t0", 0.5)),
    (circular(t_end=1.0), circular(thickness="1", t_end=1.0), At("t0", 0.5)),
)
"""A built-in thickness, the same as an expression, and a state."""

ROUNDING = decide.Stated(1e-11, "the same", "the last step of Newton's method, which stops at 1e-10")

DISKS = tuple(
    circular(alpha=0.01, thickness=text, t_end=1.0)
    for text in ("1 + 0.5*cos(2*pi*X)", "0.6 + 0.8*X**2", "exp(-X**2)", "1 - 0.5*tanh(4*X - 2)")
)


def same(solutions: Solutions) -> Finding:
    """Numbers of a state with a built-in thickness and with its expression."""
    found = []
    for built_in, text, at in SAME:
        kept = [n for n, q in solutions.state(built_in, at).quantities.items() if np.isfinite(q.value)]
        one, other = (np.array([solutions.value(s, at, name) for name in kept]) for s in (built_in, text))
        most = np.max(np.abs(other - one) / np.maximum(1.0, np.abs(one)))
        found.append(decide.at_most(f"{text}, {len(kept)} numbers: largest difference", most, ROUNDING))
    return decide.all_of(found)


def taut(solutions: Solutions) -> Finding:
    """Smallest principal resultant along the branches, except for the first point."""
    return decide.all_of(
        decide.positive(str(spec), solutions.along(spec, "t_min")[1:]) for spec in (*DISKS, DISK)
    )


def wrinkled_at_the_ends(solutions: Solutions) -> Finding:
    """Fronts of the cylinder under gas, and gw at both disks and in the middle."""
    state = At("p", 0.2, profile=())
    fronts = [name for name in solutions.state(GAS, state).quantities if name.startswith("Z_front")]
    gw = solutions.column(GAS, state, "gw")
    middle = len(gw) // 2
    return decide.all_of(
        decide.same("fronts", len(fronts), 2),
        decide.positive("1 - gw at both disks", 1 - gw[[0, -1]]),
        decide.positive("gw - 1 in the middle", gw[[middle]] - 1),
    )


WIDEST = Axis("r_max", 0.5, 0.9)

CASE = Case(
    title="Membranes of a thickness given as an expression",
    source="Patil, Nordmark & Eriksson (2015), section 5.1; other thicknesses",
    panels=tuple(
        Panel(
            name,
            x=x,
            y=y,
            note="Not a figure of the paper.",
            curves=(Curve(spec, label, reference=table),),
        )
        for name, spec, label, table, x, y in (
            ("fluid", FLUID, "cylinder, fluid", "uneven_tube_fluid", Axis("zw", 0, 12), WIDEST),
            ("gas", GAS, "cylinder, gas", "uneven_tube_gas", Axis("p", 0, 0.3), WIDEST),
            ("disk", DISK, "flat disk", "uneven_disk", Axis("p", 0, 6), Axis("t0", 0, 2)),
        )
    ),
    checks=(
        Claim(
            "same",
            "an expression of a built-in thickness gives the same numbers",
            tuple((spec, at) for *both, at in SAME for spec in both),
            same,
        ),
        Claim(
            "taut",
            "a flat circular membrane of non-uniform thickness does not wrinkle",
            tuple((spec, None) for spec in (*DISKS, DISK)),
            taut,
        ),
        Claim(
            "wrinkled_at_the_ends",
            "a cylinder that is thin in the middle wrinkles at its thick ends",
            ((GAS, At("p", 0.2, profile=())),),
            wrinkled_at_the_ends,
        ),
        Points(
            "quantity",
            reference="uneven_tube_radii",
            base=wrinkled_tube(thickness=COSINE, Af=0.4, load="gas", load_end=0.2),
            parameters=("delta",),
            asked={"Af_critical": 1e-8},
        ),
    ),
    asked={
        "V": 1e-7,
        "r_max": 1e-7,
        "N": 1e-7,
        "gw_max": 1e-6,
        "gw_min": 1e-6,
        "wrinkled_fraction": 1e-6,
        "p": 1e-7,
        "lam_pole": 1e-6,
        "lam1_rim": 1e-6,
    },
    slow=True,
)
