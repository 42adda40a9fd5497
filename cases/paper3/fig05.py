"""Paper 3, figure 5: principal stress resultants along the tube on the primary branch.

The text does not give the levels and the pre-stretch of the figure; here delta = 2, with levels before the
limit point and past it. The axial coordinate is the material one; a second panel uses the current height.
"""

import numpy as np

from weakforms.cases import (
    At,
    Axis,
    Case,
    Claim,
    Constant,
    Curve,
    Finding,
    Panel,
    Solutions,
    decide,
    fluid_tube,
)

LENGTHS, STRETCHES = (8, 24), (1.5, 2, 3)
TUBES = {length: fluid_tube(L=length, delta=2, gamma=0.116) for length in LENGTHS}
EVERY = {(length, d): fluid_tube(L=length, delta=d, gamma=0.116) for length in LENGTHS for d in STRETCHES}
LEVELS = {8: (2, 4, 6, 7, 8, 8.2), 24: (2, 4, 6, 7, 8)}
PAST = {8: (8.2, 8), 24: (8.3, 8)}
TENSE = tuple(At(name, value, profile=()) for name, value in (("zw", 2.0), ("zw", 6.0), ("limit_point", 1.0)))
MIDDLE = tuple(At("zw", float(zw)) for zw in LEVELS[24])
HEIGHT = {8: 4, 24: 10}
"""The material point at ``l/4`` or ``l/10`` is at a height of about 2."""
RISING = tuple(At("zw", zw) for zw in (3.5, 4.5, 5.5, 6.5, 7.5))


def states(length: int) -> list[tuple[str, At, str]]:
    """Name, state and legend of the profiles of a tube."""
    before = [(f"zw_{zw}", At("zw", float(zw)), rf"$z_w = {zw}$") for zw in LEVELS[length]]
    return before + [
        (f"zw_{zw}_post", At("zw", float(zw), crossing=2), rf"$z_w = {zw}$, past") for zw in PAST[length]
    ]


def at_height(length: int, delta: float, at: At) -> At:
    """The state sampled at the material point of the statement."""
    return At(at.name, at.value, at.crossing, (length / delta / HEIGHT[length],))


LOW = decide.Stated(3e-3, "low", "no number is printed; a line of figure 5b, 1 high, is wider")


def resultants(solutions: Solutions, length: int, delta: float, name: str) -> decide.Number:
    """A resultant at the material point over rising levels up to the limit point."""
    ats = (at_height(length, delta, at) for at in (*RISING, At("limit_point", 1.0)))
    return decide.stack(solutions.samples(EVERY[length, delta], at, name)[0] for at in ats)


def grows_and_falls(solutions: Solutions) -> Finding:
    """T2 rises and T1 falls with the level at the material point."""
    return decide.all_of(
        way(f"{name}, L = {length}, delta = {delta}", resultants(solutions, length, delta, name))
        for length, delta in EVERY
        for name, way in (("T1", decide.falls), ("T2", decide.rises))
    )


def stretches(solutions: Solutions) -> Finding:
    """Stretches at the material point: lam2 rises all the way, lam1 falls at first, then rises."""
    found = []
    for length in LENGTHS:
        lam1, lam2 = (resultants(solutions, length, 2, name) for name in ("lam1", "lam2"))
        found += [decide.rises(f"lam2, L = {length}", lam2), decide.rises("lam1 at last", lam1[-2:])]
    return decide.all_of(*found, decide.falls("lam1 at first, L = 24", lam1[:2]))


def constant_above(solutions: Solutions) -> Finding:
    """T2 of the long tube in its dry part over the levels, and at its upper ring."""
    ats = [At("zw", float(zw), profile=ABOVE) for zw in LEVELS[24]]
    t2 = decide.stack(solutions.samples(TUBES[24], at, "T2") for at in ats)
    spread = decide.Number(np.ptp(t2.value[:, :-1], axis=0), np.max(t2.uncertainty))
    return decide.all_of(
        decide.at_most("spread of T2 over the levels", spread, STEADY),
        decide.at_most("T2 below the ring", t2[:, :-1], SMALL),
        decide.at_least("T2 at the ring", t2[:, -1], NOT_LOW),
    )


ABOVE = (8.0, 9.0, 10.0, 12.0)
STEADY = decide.Stated(1e-3, "constant", "no number is printed; a line of figure 5b, 1 high, is wider")
SMALL = decide.Stated(0.02, "low", "no number is printed; a fiftieth of the axis of figure 5b")
NOT_LOW = decide.Stated(0.3, "not low", "no number is printed; a third of the axis of figure 5b")


def no_wrinkling(solutions: Solutions) -> Finding:
    """Resultants along the tube: T1 is positive, T2, which is zero where dry and straight, not negative."""
    found = []
    for (length, delta), tube in EVERY.items():
        for at in TENSE:
            t1, t2 = (solutions.column(tube, at, name) for name in ("T1", "T2"))
            found.append(decide.positive(f"T1, L = {length}, delta = {delta}", t1))
            found.append(decide.not_negative("T2", t2, 1e-5, t1.largest().value))
    return decide.all_of(found)


def low_and_constant(solutions: Solutions) -> Finding:
    """In the dry middle of the long tube the circumferential resultant is nearly zero."""
    values = solutions.numbers(TUBES[24], MIDDLE, "T2_mid")
    return decide.all_of(
        decide.positive("T2 at mid height", values), decide.at_most("T2 at mid height", values, LOW)
    )


def panels() -> tuple[Panel, ...]:
    """Both resultants over both axial coordinates for both tubes."""
    out = []
    for name, length in (("a", 8), ("b", 24)):
        for column, high in (("T1", 4), ("T2", 1)):
            for axis, end in (("Z", length / 2), ("z", length)):
                out.append(
                    Panel(
                        f"{name}_{column}_{axis}",
                        x=Axis(axis, 0, end),
                        y=Axis(column, 0, high),
                        title=rf"$L/A = {length}$, $\delta = 2$",
                        note="The text does not give the axes of this figure. Past: after the limit point.",
                        curves=tuple(
                            Curve(TUBES[length], label, reference=f"fig05{name}_{key}", at=at, y=column)
                            for key, at, label in states(length)
                        ),
                    )
                )
    return tuple(out)


CASE = Case(
    title="Principal stress resultants on the primary branch",
    source="Patil, Nordmark & Eriksson (2015), figure 5",
    panels=panels(),
    checks=(
        *(
            Constant(
                "H", TUBES[length], at, asked, "w - lam1 w_,1 is constant along the membrane, wet or dry"
            )
            for length, at, asked in (
                (8, At("zw", 6.0, profile=()), 1e-9),
                (8, At("limit_point", 1.0, profile=()), 1e-8),
                (24, At("zw", 6.0, profile=()), 5e-9),
                (24, At("limit_point", 1.0, profile=()), 5e-7),
            )
        ),
        Claim(
            "grows_and_falls",
            "with rising level the circumferential resultant increases and the meridional one decreases, at "
            "a material point of height about 2 from zw = 3.5 to the limit point (not at every point of the "
            "tube, as "
            "the "
            "paper says)",
            tuple(
                (tube, at_height(length, d, at))
                for (length, d), tube in EVERY.items()
                for at in (*RISING, At("limit_point", 1.0))
            ),
            grows_and_falls,
            differs="the text says that with rising level the circumferential resultant increases and the "
            "meridional one decreases; this is true at the material points considered here, not everywhere",
        ),
        Claim(
            "no_wrinkling",
            "no resultant is negative on the primary branch: the membrane does not wrinkle",
            tuple((tube, at) for tube in EVERY.values() for at in TENSE),
            no_wrinkling,
        ),
        Claim(
            "stretches",
            "at that point the circumferential stretch increases with the level; the meridional one of the "
            "long tube decreases at first",
            tuple(
                (TUBES[length], at_height(length, 2, at))
                for length in LENGTHS
                for at in (*RISING, At("limit_point", 1.0))
            ),
            stretches,
            differs="the text says that both stretches increase with added liquid; the meridional one of the "
            "long tube decreases up to a level of about 5 before it increases",
        ),
        Claim(
            "constant_above",
            "L/A = 24: near the upper end T2 does not change with the level, and it is low below the ring",
            tuple((TUBES[24], At("zw", float(zw), profile=ABOVE)) for zw in LEVELS[24]),
            constant_above,
            differs="the text says that T2 is low near the upper end; at the ring itself it is 0.38",
        ),
        Claim(
            "low_and_constant",
            "L/A = 24: the circumferential resultant near the centre stays low, but not negative",
            tuple((TUBES[24], at) for at in MIDDLE),
            low_and_constant,
        ),
    ),
    asked={"r": 5e-9, "z": 1e-9, "lam1": 5e-7, "lam2": 5e-9, "T1": 2e-7, "T2": 5e-7},
)
