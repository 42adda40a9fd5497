"""Paper 5: where waves set in and where they vanish, wave number by wave number, under liquid and gas.

The more waves, the lower the level at which they set in and the higher that at which they vanish (the taut
part grows from above): at fixed level a membrane of this kind is unstable to all short waves.
"""

import math
from itertools import pairwise

from weakforms import (
    Axis,
    Case,
    Claim,
    Curve,
    Finding,
    Panel,
    Points,
    Solutions,
    Spec,
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
"""Levels between which the paper's finite elements are unstable, by elements around the axis."""
FULLY = 4.9
"""Level below which all of the membrane is wrinkled."""


def changes(solutions: Solutions, spec: Spec, direction: float) -> dict[int, float]:
    """First change of a direction by wave number."""
    control = LOADS[spec]
    found: dict[int, float] = {}
    for point in solutions.points(spec, "stability_change"):
        if point.values["direction"] == direction and point.values["n"] > 0:
            found.setdefault(int(point.values["n"]), point.values[control])
    return dict(sorted(found.items()))


def monotonic(solutions: Solutions) -> Finding:
    """Loads at which waves set in, falling with n, and vanish, rising with n."""
    good, rows = True, []
    for spec in LOADS:
        for direction, sign in ((1.0, -1), (-1.0, 1)):
            found = list(changes(solutions, spec, direction).values())
            good &= all(sign * (b - a) > 0 for a, b in pairwise(found))
            rows.append(", ".join(f"{v:.5f}" for v in found))
    return good, "; ".join(rows)


def few_waves(solutions: Solutions) -> Finding:
    """Least eigenvalues for n = 0 and 1 on the branches, as far as the loads rise."""
    found = {}
    for spec in LOADS:
        columns = solutions.branch(spec).columns
        before = columns["n_negative"] == 0
        for n in (0, 1):
            found[spec.problem, n, spec is GAS] = float(columns[f"Lambda_n{n}_1"][before].min())
    return min(found.values()) > 0, ", ".join(f"{v:.6f}" for v in found.values())


def falls_with_n(solutions: Solutions) -> Finding:
    """Largest rise of the lowest eigenvalue from one n to the next, at levels with no taut zone."""
    columns = solutions.branch(LIQUID).columns
    rows = columns["zw"] <= FULLY
    lowest = [columns[f"Lambda_n{n}_1"][rows] for n in WAVES["zw"][1:]]
    rise = max(float((b - a).max()) for a, b in pairwise(lowest))
    return rise < 1e-8, f"{rise:.1e} on {int(rows.sum())} states"


def same_at_no_load(solutions: Solutions) -> Finding:
    """Spread of the lowest eigenvalues over n without load, and the eigenvalue."""
    columns = solutions.branch(LIQUID).columns
    values = [float(columns[f"Lambda_n{n}_1"][0]) for n in WAVES["zw"]]
    spread = max(values) - min(values)
    return spread < 1e-8 and columns["zw"][0] == 0.0 and values[
        0
    ] > 0, f"{values[0]:.9f}, spread {spread:.0e}"


def no_waves_is_the_limit(solutions: Solutions) -> Finding:
    """Pressure at which n = 0 turns unstable and the limit pressure."""
    (limit,) = solutions.points(GAS, "limit_point")
    change = next(p for p in solutions.points(GAS, "stability_change") if p.values["n"] == 0)
    found, bound = change.values["p"], 2 * limit.uncertainty["p"]
    return abs(found - limit.values["p"]) <= bound, f"{found:.10f}, {limit.values['p']:.10f}"


def resolved_waves(solutions: Solutions) -> Finding:
    """Real n that is just unstable at the ends of the printed ranges, over N/(2 pi) of the hoop mesh N."""
    good, rows = True, []
    for mesh, levels in RANGES.items():
        found = [solutions.result(wrinkled_linear(zw=zw)).quantities["n_critical"].value for zw in levels]
        share = [n * 2 * math.pi / mesh for n in found]
        good &= abs(found[0] - found[1]) < 0.05 * found[0] and all(0.75 < v < 1 for v in share)
        rows.append(f"N = {mesh}: n = {found[0]:.3f} and {found[1]:.3f}, {share[0]:.3f} and {share[1]:.3f}")
    return good, "; ".join(rows)


def held_against(base: Spec, control: str) -> tuple[Points, ...]:
    """One check a row."""
    columns = reference(5, TABLES[control]).columns
    return tuple(
        Points(
            "stability_change",
            reference=TABLES[control],
            base=base,
            parameters=(),
            where={"n": float(n), "direction": float(direction)},
            asked={control: 1e-6},
        )
        for n, direction in zip(columns["n"], columns["direction"], strict=True)
    )


CASE = Case(
    title="Levels and pressures at which waves set in and vanish",
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
            "with n the load at which waves set in falls and that at which they vanish rises",
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
            "as long as all of it is wrinkled, the lowest eigenvalue falls with n",
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
)
