"""Paper 5, figure 4: wrinkling function along the cylinder, M = 1.5, delta = 3, under liquid (a) and gas (b).

The levels and pressures are chosen here; the paper names none. At low and moderate levels the whole membrane
is wrinkled, and its upper part becomes taut as the level rises; under gas the thick lower part is wrinkled
and the thin upper part taut.
"""

from weakforms import At, Axis, Case, Claim, Curve, Finding, Panel, Printed, Solutions, wrinkled_tube

DATA = {"M": 1.5, "delta": 3, "Af": 0.4362}
FLUID, GAS = wrinkled_tube(**DATA), wrinkled_tube(**DATA, load="gas")
LEVELS, PRESSURES = (1.5, 3, 4.5, 6, 6.6), (0.02, 0.05, 0.1, 0.2, 0.38)
LAST = At("zw", 5.73)
"""Level up to which the paper calls the whole membrane wrinkled."""


def at(control: str, load: float) -> At:
    """A state with its profile."""
    return At(control, float(load), profile=())


def share(solutions: Solutions, state: At, spec: object = FLUID) -> float:
    """Part of the length that is wrinkled."""
    return solutions.value(spec, state, "wrinkled_fraction")


def all_wrinkled(solutions: Solutions) -> Finding:
    """Wrinkled part of the length up to zw = 5.73: all but a layer at the upper disk."""
    levels = [*(at("zw", v) for v in LEVELS if v < LAST.value), LAST]
    found = [share(solutions, level) for level in levels]
    most = solutions.value(FLUID, LAST, "gw_max")
    return min(found) > 0.999 and most < 1 + 1e-4, (
        f"at least {min(found):.6f} of the length; at zw = {LAST.value} gw is at most 1 + {most - 1:.1e}"
    )


def upper_part_taut(solutions: Solutions) -> Finding:
    """Wrinkled part of the length at zw = 6 and 6.6."""
    found = [share(solutions, at("zw", v)) for v in LEVELS[-2:]]
    gw = solutions.profile(FLUID, at("zw", LEVELS[-1])).columns["gw"]
    return found[1] < 0.95 < found[0] and gw[0] < 1 < gw[-1], ", ".join(f"{v:.5f}" for v in found)


def gas_pattern(solutions: Solutions) -> Finding:
    """One front at every pressure from 0.02 on: wrinkled below it, taut above."""
    good, rows = True, []
    for p in PRESSURES:
        state = solutions.state(GAS, at("p", p))
        gw = state.fields[0].columns["gw"]
        fronts = [q.value for name, q in state.quantities.items() if name.startswith("Z_front")]
        good &= bool(len(fronts) == 1 and gw[0] < 1 < gw[-1])
        rows.append(", ".join(f"{z:.4f}" for z in fronts))
    return good, f"fronts at Z = {'; '.join(rows)} for p = {', '.join(map(str, PRESSURES))}"


def straight_when_dry(solutions: Solutions) -> Finding:
    """Level 3: spread of dr/dz above the level; relative spread of the tension all along."""
    field = solutions.profile(FLUID, at("zw", 3))
    columns, u = field.columns, field.uncertainty
    dry = columns["z"] > 3
    slopes, tension = columns["slope"][dry], columns["tension"]
    bend = slopes.max() - slopes.min()
    spread = (tension.max() - tension.min()) / tension.mean()
    good = bend <= 2 * u["slope"] + 1e-9 and spread <= 2 * u["tension"] / tension.mean() + 1e-9
    return bool(
        good
    ), f"slope {slopes.mean():.9f}, spread {bend:.0e}; tension {tension.mean():.9f}, {spread:.0e}"


CASE = Case(
    title="Wrinkling function of the cylinder",
    source="Patil, Nordmark & Eriksson (2016), figure 4",
    panels=(
        Panel(
            "a",
            x=Axis("Z", 0, 8),
            y=Axis("gw", 0.6, 1.05),
            title="liquid",
            curves=tuple(
                Curve(FLUID, rf"$z_w = {v}$", reference=f"gw_fluid_zw_{v}", at=at("zw", v)) for v in LEVELS
            ),
        ),
        Panel(
            "b",
            x=Axis("Z", 0, 8),
            y=Axis("gw", 0.6, 1.8),
            title="gas",
            curves=tuple(
                Curve(GAS, f"$p = {v}$", reference=f"gw_gas_p_{v}", at=at("p", v)) for v in PRESSURES
            ),
        ),
    ),
    checks=(
        Claim(
            "all_wrinkled",
            "up to zw = 5.73 the whole membrane is wrinkled (but for a layer thinner than 0.001 L)",
            (*((FLUID, at("zw", v)) for v in LEVELS), (FLUID, LAST)),
            all_wrinkled,
        ),
        Claim(
            "upper_part_taut",
            "the upper part becomes taut as the level rises",
            tuple((FLUID, at("zw", v)) for v in LEVELS[-2:]),
            upper_part_taut,
        ),
        Claim(
            "gas_pattern",
            "under gas the thick lower part is wrinkled and the thin upper part taut (p >= 0.02)",
            tuple((GAS, at("p", p)) for p in PRESSURES),
            gas_pattern,
        ),
        Claim(
            "straight_when_dry",
            "in a wrinkled zone the tension is constant, and where it is dry the meridian is straight",
            ((FLUID, at("zw", 3)),),
            straight_when_dry,
        ),
        Printed(
            "(Af)_c for M = 1.5, delta = 3",
            "0.4362",
            of=FLUID,
            kind="quantity",
            column="Af_critical",
            source="section 3.1",
        ),
    ),
    asked={"gw": 1e-6},
    quick=True,
)
