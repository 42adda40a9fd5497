"""Paper 5, figure 9: wrinkling function of the liquid-filled hemisphere along its meridian.

At low levels the hemisphere is wrinkled below and above the level; at high levels it is not wrinkled. Next to
the equator (where lam2 = 1 and lam1 > 1) and at the pole it is always taut. The levels are chosen here.
"High" means about -0.55 and above: the branch has its highest level at -0.478.
"""

import math

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
    decide,
    hemisphere,
)

BOWL = hemisphere(low_end=-1.16, past=0.2)
LEVELS = (-1.1, -0.9, -0.7, -0.6, -0.52)
LOW = LEVELS[:4]
DIGITS = decide.Stated(5e-4, "-0.478", "half a unit of the last digit of the docstring's level")
HIGH = At("zw", -0.5, profile=())


def at(level: float) -> At:
    """The state at a level with its profile."""
    return At("zw", float(level), profile=())


def fronts(solutions: Solutions, state: At) -> list[decide.Number]:
    """Fronts from the pole."""
    found = solutions.state(BOWL, state).quantities
    return [decide.number(q) for name, q in found.items() if name.startswith("t_front")]


def around_the_level(solutions: Solutions) -> Finding:
    """Fronts and level at each level: one wrinkled zone around it."""
    found = []
    for level in LOW:
        places = fronts(solutions, at(level))
        found.append(decide.same(f"zw = {level}: fronts", len(places), 2))
        found.append(
            decide.less("level between", places[0], solutions.number(BOWL, at(level), "t_level"), places[-1])
        )
    return decide.all_of(found)


def taut_at_high_levels(solutions: Solutions) -> Finding:
    """Smallest gw at zw = -0.5, and the closing of the wrinkled zone."""
    (closing,) = solutions.points(BOWL, "zone_closing")
    return decide.all_of(
        decide.positive("gw_min - 1", solutions.number(BOWL, HIGH, "gw_min") - 1),
        decide.same("state", closing.values["state"], -1),
        decide.less("closes at zw", decide.of_point(closing, "zw"), HIGH.value),
    )


def taut_ends(solutions: Solutions) -> Finding:
    """Gw at the pole and at the equator."""
    ends = decide.join(solutions.column(BOWL, at(v), "gw")[[0, -1]] for v in LEVELS)
    return decide.positive("gw - 1 at pole and equator", ends - 1)


def cone(solutions: Solutions) -> Finding:
    """Distance of the dry wrinkled part of the meridian from its chord at each low level."""
    found = []
    for level in LOW:
        gw, r, z = (solutions.column(BOWL, at(level), name) for name in ("gw", "r", "z"))
        dry, _ = decide.sides(-z, -level)
        wrinkled, _ = decide.sides(gw, 1)
        (rows,) = (dry & wrinkled).nonzero()
        first, last = rows[0], rows[-1]
        chord = r[first] + (z[rows] - z[first]) * ((r[last] - r[first]) / (z[last] - z[first]))
        found += [
            decide.every(f"zw = {level}: more than three rows", [len(rows) > 3]),
            decide.zero("distance from the chord", r[rows] - chord, 1e-6),
        ]
    return decide.all_of(found)


def limit(solutions: Solutions) -> Finding:
    """Highest level, and the depth of an empty sheet that hangs as a cone, which is below all levels."""
    counts = solutions.branch(BOWL).columns["n_negative"]
    before, past = decide.sides(solutions.along(BOWL, "V"), solutions.point(BOWL, "limit_point", "V"))
    return decide.all_of(
        decide.less(
            "cone and first pole", -math.sqrt(math.pi**2 / 4 - 1), solutions.along(BOWL, "z_pole")[0]
        ),
        decide.at_most(
            "highest level off -0.478", abs(solutions.point(BOWL, "limit_point", "zw") + 0.478), DIGITS
        ),
        decide.every("none negative before", counts[before] == 0),
        decide.every("one past it", counts[past] == 1),
    )


CASE = Case(
    title="Wrinkling function of the hemisphere",
    source="Patil, Nordmark & Eriksson (2016), figure 9",
    panels=(
        Panel(
            "gw",
            x=Axis("t", 0, 1.6),
            y=Axis("gw", 0.6, 1.6),
            curves=tuple(
                Curve(BOWL, rf"$z_w = {v}$", reference=f"gw_hemisphere_zw_{v}", at=at(v)) for v in LEVELS
            ),
        ),
        *(
            Panel(
                name,
                x=Axis("zw" if upward else "z_pole", *x),
                y=Axis(y, *limits, label=label),
                note="Not a figure of the paper. The table of fronts is compared at its levels."
                if name == "fronts"
                else "Not a figure of the paper.",
                curves=(Curve(BOWL, label, reference=table),),
            )
            for name, upward, x, y, limits, label, table in (
                (
                    "branch",
                    True,
                    (-1.2, -0.4),
                    "z_pole",
                    (-1.6, -1.1),
                    "height of the pole",
                    "hemisphere_branch",
                ),
                (
                    "fronts",
                    True,
                    (-1.2, -0.5),
                    "t_level",
                    (0, 1.6),
                    "level on the meridian",
                    "hemisphere_fronts",
                ),
                ("past", False, (-2.2, -1.4), "zw", (-0.8, -0.4), "level", "hemisphere_past_limit"),
            )
        ),
    ),
    checks=(
        Claim(
            "around_the_level",
            "at low levels the hemisphere is wrinkled below and above the level",
            tuple((BOWL, at(v)) for v in LEVELS),
            around_the_level,
        ),
        Claim(
            "cone",
            "where it is wrinkled above the liquid the hemisphere is a cone",
            tuple((BOWL, at(v)) for v in LOW),
            cone,
        ),
        Claim(
            "taut_at_high_levels",
            "at high levels the hemisphere is not wrinkled",
            ((BOWL, HIGH), (BOWL, None)),
            taut_at_high_levels,
        ),
        Claim(
            "taut_ends",
            "the pole and the equator are taut at every level",
            tuple((BOWL, at(v)) for v in LEVELS),
            taut_ends,
        ),
        Claim(
            "limit",
            "the branch has a highest level, beyond which an axisymmetric eigenvalue is negative",
            ((BOWL, None),),
            limit,
        ),
        Points(
            "limit_point",
            reference="hemisphere_limit",
            base=BOWL,
            parameters=(),
            asked={"zw": 5e-9, "z_pole": 1e-6, "V": 1e-6},
        ),
    ),
    asked={
        "gw": 5e-8,
        "z_pole": 5e-7,
        "V": 1e-7,
        "lam_pole": 1e-7,
        "t_level": 2e-8,
        "zw": 5e-9,
        "t_front_1": 2e-7,
        "t_front_2": 5e-9,
    },
)
