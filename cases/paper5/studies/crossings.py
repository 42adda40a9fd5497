"""Paper 5: loads at which waves appear and disappear, for each wave number, under liquid and gas.

With more waves, the level at which they appear is lower, and the level at which they disappear (because the
taut part grows from above) is higher. At a fixed level such a membrane is unstable to all short waves.
"""

import math
from itertools import pairwise

from weakforms.cases import (
    Axis,
    Case,
    Claim,
    Curve,
    Finding,
    Panel,
    Points,
    Solutions,
    Spec,
    decide,
    reference,
    wrinkled_linear,
    wrinkled_tube,
)

DATA = {"M": 1.5, "delta": 3, "Af": 0.4362}
TABLES = {"zw": "stability_changes_fluid", "p": "stability_changes_gas"}
WAVES = {
    control: (0, 1, *sorted({int(n) for n in reference(5, name).columns["n"]}))
    for control, name in TABLES.items()
}
LIQUID = wrinkled_tube(**DATA, n=WAVES["zw"], load_end=20.0)
GAS = wrinkled_tube(**DATA, load="gas", n=WAVES["p"])
LOADS = {LIQUID: "zw", GAS: "p"}
RANGES = {48: (5.14, 6.81), 96: (4.03, 9.81)}
"""Ranges of levels at which the paper's finite element models are unstable, by elements around the axis."""
DEEP = 1.0
"""A level of one radius: below it the liquid changes the eigenvalues by less than their uncertainty."""
FULLY = 4.9
"""Level below which the whole membrane is wrinkled."""


ONE = decide.Stated(0.05, "one n", "no number is printed; n is known by two levels of three digits")
SOMEWHAT = decide.Stated(0.25, "somewhat below", "no number is printed; much more than half of N/(2 pi)")


def changes(solutions: Solutions, spec: Spec, direction: float) -> dict[int, decide.Number]:
    """First change of a direction by wave number."""
    found: dict[int, decide.Number] = {}
    for point in solutions.points(spec, "stability_change"):
        if point.values["direction"] == direction and point.values["n"] > 0:
            found.setdefault(int(point.values["n"]), decide.of_point(point, LOADS[spec]))
    return dict(sorted(found.items()))


def monotonic(solutions: Solutions) -> Finding:
    """Loads at which waves appear, which decrease with n, and disappear, which increase with n."""
    found = []
    for spec in LOADS:
        found.append(decide.falls("set in", list(changes(solutions, spec, 1.0).values())))
        found.append(decide.rises("vanish", list(changes(solutions, spec, -1.0).values())))
    return decide.all_of(found)


def few_waves(solutions: Solutions) -> Finding:
    """Eigenvalues for n = 0 and 1 on the branches, as far as the loads rise."""
    found = []
    for spec, control in LOADS.items():
        before = solutions.branch(spec).columns["n_negative"] == 0
        found += [
            decide.positive(f"over {control}, n = {n}", solutions.along(spec, f"Lambda_n{n}_1")[before])
            for n in (0, 1)
        ]
    return decide.all_of(found)


def falls_with_n(solutions: Solutions) -> Finding:
    """Steps of the lowest eigenvalue from one n to the next, at levels with no taut zone."""
    levels = solutions.branch(LIQUID).columns["zw"]
    rows = (levels >= DEEP) & (levels <= FULLY)
    lowest = {n: solutions.along(LIQUID, f"Lambda_n{n}_1")[rows] for n in WAVES["zw"][1:]}
    return decide.all_of(
        decide.negative(f"from n = {a} to {b}", lowest[b] - lowest[a]) for a, b in pairwise(WAVES["zw"][1:])
    )


def same_at_no_load(solutions: Solutions) -> Finding:
    """The lowest eigenvalue without load, n by n."""
    values = decide.stack(solutions.along(LIQUID, f"Lambda_n{n}_1")[0] for n in WAVES["zw"])
    return decide.all_of(
        decide.same("level", solutions.branch(LIQUID).columns["zw"][0], 0.0),
        decide.constant("lowest eigenvalue", values, 5e-7),
        decide.positive("lowest eigenvalue", values),
    )


def no_waves_is_the_limit(solutions: Solutions) -> Finding:
    """Pressure at which n = 0 becomes unstable, and the limit pressure."""
    change = next(p for p in solutions.points(GAS, "stability_change") if p.values["n"] == 0)
    return decide.agree("p", decide.of_point(change, "p"), solutions.point(GAS, "limit_point", "p"), 1e-8)


def resolved_waves(solutions: Solutions) -> Finding:
    """Real n at the stability limit at the ends of the printed ranges, over N/(2 pi)."""
    found = []
    for mesh, levels in RANGES.items():
        n = decide.stack(solutions.whole(wrinkled_linear(zw=zw), "n_critical") for zw in levels)
        missing = 1 - n * (2 * math.pi / mesh)
        found += [
            decide.at_most(f"N = {mesh}: n apart", abs(n[0] / n[1] - 1), ONE),
            decide.positive("missing from N/(2 pi)", missing),
            decide.at_most("missing", missing, SOMEWHAT),
        ]
    return decide.all_of(found)


ASKED = {"zw": 1e-7, "p": 1e-6}
"""By control; pressures are small beside the largest, by which tables and solutions are uncertain."""


def held_against(base: Spec, control: str) -> tuple[Points, ...]:
    """One check for each row."""
    columns = reference(5, TABLES[control]).columns
    return tuple(
        Points(
            "stability_change",
            reference=TABLES[control],
            base=base,
            parameters=(),
            where={"n": float(n), "direction": float(direction)},
            asked={control: ASKED[control]},
        )
        for n, direction in zip(columns["n"], columns["direction"], strict=True)
    )


CASE = Case(
    title="Levels and pressures at which waves appear and disappear",
    source="Patil, Nordmark & Eriksson (2016), section 4.1; wave numbers beyond the figures chosen here",
    panels=tuple(
        Panel(
            name,
            x=Axis(control, 0, end),
            y=Axis("Lambda", -6, 1, label=r"$\Lambda_1$"),
            title=title,
            curves=tuple(Curve(spec, f"$n = {n}$", y=f"Lambda_n{n}_1") for n in shown),
            note="Not a figure of the paper.",
        )
        for name, title, spec, control, end, shown in (
            ("liquid", "liquid", LIQUID, "zw", 20, WAVES["zw"][1:]),
            ("gas", "gas", GAS, "p", 0.6, WAVES["p"][1:]),
        )
    ),
    checks=(
        *(row for spec, control in LOADS.items() for row in held_against(spec, control)),
        Claim(
            "monotonic",
            "with n the load at which waves appear decreases and that at which they disappear increases",
            tuple((spec, None) for spec in LOADS),
            monotonic,
        ),
        Claim(
            "few_waves",
            "the cylinder is stable for n = 0 (below the largest pressure) and n = 1",
            tuple((spec, None) for spec in LOADS),
            few_waves,
        ),
        Claim(
            "falls_with_n",
            "from a level of one radius on, and while the whole membrane is wrinkled, the lowest eigenvalue "
            "decreases with n",
            ((LIQUID, None),),
            falls_with_n,
        ),
        Claim(
            "same_at_no_load",
            "without pressure the lowest eigenvalue is positive and the same for all n",
            ((LIQUID, None),),
            same_at_no_load,
        ),
        Claim(
            "no_waves_is_the_limit",
            "for n = 0 stability is lost at the largest pressure",
            ((GAS, None),),
            no_waves_is_the_limit,
        ),
        Claim(
            "resolved_waves",
            "both ends of a range printed for finite elements belong to one n, somewhat below N/(2 pi) of the"
            " N elements around the axis",
            tuple((wrinkled_linear(zw=zw), None) for levels in RANGES.values() for zw in levels),
            resolved_waves,
        ),
    ),
    slow=True,
)
