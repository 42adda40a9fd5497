"""Waves around the filled, wrinkled cylinder of paper 5 with other rubbers.

The levels at which waves appear and, when a taut zone grows from above, disappear again, for Ogden's, Gent's,
and Arruda and Boyce's rubber. They are compared with the paper's reference codes, which implement the laws
separately.
"""

from weakforms.cases import Case, Claim, Finding, Points, Solutions, decide, wrinkled_tube

ENDS = {"ogden": 12.0, "gent": 14.0, "arruda_boyce": 14.0}
"""Levels at which branches end, beyond the last change."""
WAVES = (10, 20)
TUBES = {
    m: wrinkled_tube(model=m, M=1.5, delta=3, Af=0.4362, n=WAVES, load_end=end) for m, end in ENDS.items()
}


def more_waves_earlier(solutions: Solutions) -> Finding:
    """Levels at which 20 and 10 waves appear, and at which 10 and 20 disappear."""
    found = []
    for model, spec in TUBES.items():
        changes = sorted(solutions.points(spec, "stability_change"), key=lambda point: point.values["V"])
        order = [(int(p.values["n"]), int(p.values["direction"])) for p in changes]
        found.append(decide.same(model, order, [(20, 1), (10, 1), (10, -1), (20, -1)]))
        found.append(decide.rises("V", [decide.of_point(p, "V") for p in changes]))
    return decide.all_of(found)


CASE = Case(
    title="Waves around the wrinkled cylinder of paper 5 with other laws",
    source="the problem of Patil, Nordmark & Eriksson (2016) with laws of the thesis's chapter 3",
    checks=(
        *(
            Points(
                "stability_change",
                reference=f"wrinkled_waves_{m}",
                base=spec,
                parameters=(),
                where={"n": float(n), "direction": direction},
                asked={"zw": 5e-8},
            )
            for m, spec in TUBES.items()
            for n in WAVES
            for direction in (1.0, -1.0)
        ),
        Claim(
            "more_waves_earlier",
            "with more waves, the level at which they appear is lower, and the level at which they disappear "
            "is higher",
            tuple((spec, None) for spec in TUBES.values()),
            more_waves_earlier,
        ),
    ),
    slow=True,
)
