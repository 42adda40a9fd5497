"""Paper 5, figure 5: three lowest eigenvalues of the liquid-filled cylinder over the level, n = 1, 20, 50.

Mass unit: density C1/(Ao g), weight H R. Up to zw = 5.73 the membrane is wrinkled all over (but for a layer
at the upper disk), so the relaxed energy rules everywhere. For n = 1 all are positive; the first of n = 20
and of n = 50 turns negative at the printed levels.
"""

from weakforms import Axis, Case, Claim, Curve, Finding, Panel, Printed, Solutions, wrinkled_tube

WAVES = (1, 20, 50)
TUBE = wrinkled_tube(M=1.5, delta=3, Af=0.4362, n=WAVES)
RANGES = {1: (0, 1.2), 20: (-3, 1.2), 50: (-10, 1.2)}
LAST = 5.73


def shown(solutions: Solutions, n: int) -> tuple[list[float], list[float]]:
    """Levels of the figure and the lowest eigenvalue there."""
    columns = solutions.branch(TUBE).columns
    rows = zip(columns["zw"], columns[f"Lambda_n{n}_1"], strict=True)
    kept = [(float(zw), float(value)) for zw, value in rows if zw <= LAST + 0.1]
    levels, values = zip(*kept, strict=True)
    return list(levels), list(values)


def one_wave(solutions: Solutions) -> Finding:
    """Least eigenvalue for n = 1 on the branch, to zw = 16."""
    least = float(solutions.branch(TUBE).columns["Lambda_n1_1"].min())
    crossed = [p for p in solutions.points(TUBE, "stability_change") if p.values["n"] == 1]
    return least > 0 and not crossed, f"{least:.6f}"


def one_negative(solutions: Solutions) -> Finding:
    """Changes up to zw = 5.73: one for n = 20, one for n = 50, and the eigenvalue stays negative."""
    good, rows = True, []
    for n in WAVES[1:]:
        found = [p for p in solutions.points(TUBE, "stability_change") if p.values["n"] == n]
        inside = [p.values["zw"] for p in found if p.values["zw"] <= LAST]
        levels, values = shown(solutions, n)
        good &= len(inside) == 1
        good &= all((v < 0) == (zw > inside[0]) for zw, v in zip(levels, values, strict=True))
        rows.append(f"n = {n}: zw = {', '.join(f'{z:.8f}' for z in inside)}")
    return good, "; ".join(rows)


def crossing(n: int, digits: str, index: int) -> Printed:
    """A printed level."""
    return Printed(
        f"level at which n = {n} sets in, over Ao",
        digits,
        of=TUBE,
        kind="stability_change",
        column="zw",
        source="section 4.1, figure 5",
        index=index,
    )


CASE = Case(
    title="Eigenvalues of the liquid-filled cylinder",
    source="Patil, Nordmark & Eriksson (2016), figure 5",
    panels=tuple(
        Panel(
            f"{letter}, n = {n}",
            x=Axis("zw", 0, 6),
            y=Axis("Lambda", *RANGES[n], label=r"$\Lambda$"),
            title=f"$n = {n}$",
            curves=tuple(
                Curve(
                    TUBE,
                    rf"$\Lambda_{k}$",
                    reference=f"modes_fluid_n_{n}",
                    y=f"Lambda_{k}",
                    asked={f"Lambda_{k}": 1e-6},
                    columns={f"Lambda_{k}": f"Lambda_n{n}_{k}"},
                )
                for k in (1, 2, 3)
            ),
        )
        for letter, n in zip("abc", WAVES, strict=True)
    ),
    checks=(
        Claim("one_wave", "for n = 1 all eigenvalues are positive", ((TUBE, None),), one_wave),
        Claim(
            "one_negative",
            "for n = 20 and n = 50 the first eigenvalue turns negative, once",
            ((TUBE, None),),
            one_negative,
        ),
        crossing(50, "2.6", 0),
        crossing(20, "3.6", 1),
    ),
)
