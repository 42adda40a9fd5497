"""The wrinkled cylinder of paper 4 with other rubbers: Ogden's, Gent's, Arruda and Boyce's.

Critical radius, threshold of wrinkling, levels at which zones open and close, and limit pressure, are
compared with the paper's reference codes, which implement the laws separately. The relaxed energy follows
from each law.
"""

from weakforms.cases import (
    At,
    Case,
    Claim,
    Count,
    Finding,
    Points,
    Solutions,
    decide,
    wrinkled_tube,
    wrinkled_tube_threshold,
)

MODELS = ("ogden", "gent", "arruda_boyce")
EMPTY = {m: wrinkled_tube(model=m, load="gas", load_end=0.02) for m in MODELS}
THRESHOLDS = {m: wrinkled_tube_threshold(model=m) for m in MODELS}
FILLED = {m: wrinkled_tube(model=m, M=1.5, delta=2, load_end=10.0) for m in MODELS}
INFLATED = {m: wrinkled_tube(model=m, M=0.5, delta=2, load="gas", load_end=1.2) for m in MODELS}
DEEP = At("p", 0.25, profile=())


def axial(solutions: Solutions) -> Finding:
    """Axial force along the meridian at p = 0.25: taut, wrinkled and taut again."""
    found = []
    for model, spec in INFLATED.items():
        found.append(decide.constant(f"{model}, axial", solutions.column(spec, DEEP, "axial"), 5e-9))
        found.append(decide.between("wrinkled", solutions.number(spec, DEEP, "wrinkled_fraction"), 0, 1))
    return decide.all_of(found)


def stable(solutions: Solutions) -> Finding:
    """Negative axisymmetric eigenvalues before and after the first limit pressure."""
    found = []
    for model, spec in INFLATED.items():
        counts, volume = solutions.branch(spec).columns["n_negative"], solutions.along(spec, "V")
        (below, above), (before, _) = (
            decide.sides(volume, solutions.point(spec, "limit_point", "V", index)) for index in (0, 1)
        )
        found.append(decide.every(f"{model}: none below the first limit", counts[below] == 0))
        found.append(decide.every("one up to the second", counts[above & before] == 1))
    return decide.all_of(found)


CASE = Case(
    title="The wrinkled cylinder of paper 4 with other laws",
    source="the problem of Patil, Nordmark & Eriksson (2015) with laws of the thesis's chapter 3",
    checks=(
        *(
            Points(
                "quantity",
                reference=f"wrinkled_radii_{m}",
                base=EMPTY[m],
                parameters=("M", "delta"),
                where={"M": 0.5},
                asked={"Af_critical": 5e-10},
            )
            for m in MODELS
        ),
        *(
            Points(
                "quantity",
                reference=f"wrinkled_threshold_{m}",
                base=THRESHOLDS[m],
                parameters=("delta",),
                asked={"M": 1e-7, "Z": 1e-6},
            )
            for m in MODELS
        ),
        *(
            Points(
                kind,
                reference=f"wrinkled_events_{m}",
                base=FILLED[m],
                parameters=(),
                where={"state": state},
                asked={"zw": 5e-9, "Z": 1e-6},
            )
            for m in MODELS
            for kind, state in (("zone_opening", 1.0), ("zone_closing", -1.0))
        ),
        *(
            Points(
                "limit_point",
                reference=f"wrinkled_limits_{m}",
                base=INFLATED[m],
                parameters=(),
                asked={"p": 1e-8, "V": 5e-9, "r_max": 5e-9},
            )
            for m in MODELS
        ),
        Count("limit_point", dict.fromkeys(INFLATED.values(), 2), "a maximum and a minimum of the pressure"),
        Claim(
            "axial",
            "the axial force of the inflated tube is constant through taut and wrinkled zones",
            tuple((spec, DEEP) for spec in INFLATED.values()),
            axial,
        ),
        Claim(
            "stable",
            "no negative axisymmetric eigenvalue below the first limit pressure, one between the two limits",
            tuple((spec, None) for spec in INFLATED.values()),
            stable,
        ),
    ),
    slow=True,
)
