"""Paper 5, figure 5: three lowest eigenvalues of the liquid-filled cylinder over the level, n = 1, 20, 50.

Mass unit: density C1/(Ao g), weight H R. Up to zw = 5.73 the whole membrane is wrinkled (except for a layer
at the upper disk), so that its energy is the relaxed one. For n = 1 all eigenvalues are positive; the first
one for n = 20 and for n = 50 becomes negative at the printed levels.
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
    Printed,
    Solutions,
    decide,
    wrinkled_tube,
)

WAVES = (1, 20, 50)
TUBE = wrinkled_tube(M=1.5, delta=3, Af=0.4362, n=WAVES)
RANGES = {1: (0, 1.2), 20: (-3, 1.2), 50: (-10, 1.2)}
LAST = 5.73
AXIS_END = 5.83
"""Last level, a little beyond the figure's last level."""


def shown(solutions: Solutions, n: int) -> tuple[decide.Number, decide.Number]:
    """Levels of the figure and the lowest eigenvalue there."""
    kept = solutions.branch(TUBE).columns["zw"] <= AXIS_END
    return solutions.along(TUBE, "zw")[kept], solutions.along(TUBE, f"Lambda_n{n}_1")[kept]


def one_wave(solutions: Solutions) -> Finding:
    """Smallest eigenvalue for n = 1 on the branch, up to zw = 16."""
    crossed = [p for p in solutions.points(TUBE, "stability_change") if p.values["n"] == 1]
    return decide.all_of(
        decide.positive("least eigenvalue", solutions.along(TUBE, "Lambda_n1_1")),
        decide.same("changes", len(crossed), 0),
    )


def one_negative(solutions: Solutions) -> Finding:
    """Changes up to zw = 5.73: one for n = 20, one for n = 50, and the eigenvalue stays negative."""
    found = []
    for n in WAVES[1:]:
        points = [p for p in solutions.points(TUBE, "stability_change") if p.values["n"] == n]
        inside = [p for p in points if p.values["zw"] <= LAST]
        found.append(decide.same(f"n = {n}: changes", len(inside), 1))
        levels, values = shown(solutions, n)
        below, above = decide.sides(levels, decide.of_point(inside[0], "zw"))
        found += [decide.positive("before", values[below]), decide.negative("after", values[above])]
    return decide.all_of(found)


def same_by_modified_gradient(solutions: Solutions) -> Finding:
    """Lowest eigenvalues at zw = 3 by the relaxed energy and by the modified deformation gradient."""
    return decide.all_of(
        decide.agree(
            f"Lambda_1, n = {n}", *(solutions.number(s, AT, f"Lambda_n{n}_1") for s in (MODIFIED, TUBE)), 1e-7
        )
        for n in WAVES
    )


def full_energy(solutions: Solutions) -> Finding:
    """Lowest eigenvalues without load by the full energy, and the exponents of their growth with n."""
    values = decide.stack(-solutions.number(FULL, EMPTY, f"Lambda_n{n}_1") for n in TRIED)
    growth = values.log().diff() / np.diff(np.log(TRIED))
    return decide.all_of(
        decide.positive("minus the lowest eigenvalues", values),
        decide.falls("exponents", growth),
        decide.less("the last one and 2", 2, growth[-1]),
    )


AT, EMPTY, TRIED = At("zw", 3.0), At("p", 0.0), (10, 20, 40)
MODIFIED = TUBE.at(energy="modified_gradient", load_end=4.0)
FULL = TUBE.at(energy="standard", load="gas", load_end=0.05, n=TRIED)


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
                    asked={f"Lambda_{k}": 5e-8},
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
            "for n = 20 and n = 50 the first eigenvalue becomes negative once",
            ((TUBE, None),),
            one_negative,
        ),
        Claim(
            "same_by_modified_gradient",
            "the eigenvalues with the modified deformation gradient are the same",
            ((TUBE, AT), (MODIFIED, AT)),
            same_by_modified_gradient,
        ),
        Claim(
            "full_energy",
            "with the full energy the membrane is unstable without load too, the more the larger n: the "
            "eigenvalues fall like the square of n",
            ((FULL, EMPTY),),
            full_energy,
        ),
        crossing(50, "2.6", 0),
        crossing(20, "3.6", 1),
    ),
)
