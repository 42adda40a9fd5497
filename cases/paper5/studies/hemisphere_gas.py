"""Paper 5: the hemisphere under gas instead of liquid, which is taut at every pressure.

Its middle is a part of a sphere. The equator cannot grow, so that at small pressures there is a layer of
width sqrt(p/12): with the resultant p/2 along the meridian, the modulus 6 C1 h and the growth
w = p/24 of the sphere, p/2 w'' = 6 (w - p/24). The meridian turns by sqrt(p/48) at the equator.
"""

from weakforms.cases import (
    At,
    Axis,
    Case,
    Claim,
    Count,
    Curve,
    Finding,
    Panel,
    Points,
    Solutions,
    decide,
    hemisphere,
)

WAVES = (0, 1, 2, 10, 50)
GAS = hemisphere(load="gas", past=0.2, n=WAVES)
ENERGIES = tuple(
    hemisphere(load="gas", energy=energy) for energy in ("relaxed", "modified_gradient", "standard")
)
SHOWN = (0.05, 1.0, 3.0)
SMALL = (0.04, 0.02, 0.01)
"""Pressures at which the layer at the equator is narrow; each is half of the one before."""

MIDDLE = At("p", 1.0)


def at(p: float) -> At:
    """The state at a pressure with its profile."""
    return At("p", p, profile=())


def taut(solutions: Solutions) -> Finding:
    """Smallest gw on the branch, fraction that is wrinkled, and its events."""
    events = [p for kind in ("zone_opening", "zone_closing") for p in solutions.points(GAS, kind)]
    return decide.all_of(
        decide.positive("gw_min - 1", solutions.along(GAS, "gw_min") - 1),
        decide.every("nothing wrinkled", solutions.branch(GAS).columns["wrinkled_fraction"] == 0),
        decide.same("openings and closings of zones", len(events), 0),
    )


def one_energy(solutions: Solutions) -> Finding:
    """Numbers of a state with each energy, and of the limit points."""
    found = []
    first = ENERGIES[0]
    for other in ENERGIES[1:]:
        for name in ("V", "Pi", "z_pole", "gw_min", "eigenvalue_1"):
            ours, theirs = (solutions.number(e, MIDDLE, name) for e in (other, first))
            found.append(decide.agree(f"{name}, {other}", ours, theirs, 2e-8))
        limits = [solutions.point(e, "limit_point", "p") for e in (other, first)]
        found.append(decide.agree(f"limit pressure, {other}", *limits, 1e-8))
    return decide.all_of(found)


def sphere_in_the_middle(solutions: Solutions) -> Finding:
    """Pressure of a sphere with the stretch of the pole, p = 4 (1/lam - 1/lam^7), less the pressure."""
    found = []
    for p in SMALL:
        lam = solutions.number(GAS, at(p), "lam_pole")
        found.append(decide.zero(f"p = {p}", 4 * (1 / lam - 1 / lam**7) - p, 1e-8))
    return decide.all_of(found)


def turn_at_the_equator(solutions: Solutions) -> Finding:
    """Squared sine of the angle at the equator over p/48, by cos = p/(2 N): 1 up to the order of p."""
    rest = []
    for p in SMALL:
        cosine = p / 2 / solutions.number(GAS, at(p), "N")
        rest.append((1 - cosine) * (1 + cosine) * (48 / p) - 1)
    return decide.order("sin^2 over p/48, less 1", [1 / p for p in SMALL], decide.stack(rest), 1)


def no_axial_force(solutions: Solutions) -> Finding:
    """Tension along the axis less the pressure on the section, at each pressure."""
    return decide.all_of(
        decide.zero(f"p = {p}", solutions.column(GAS, at(p), "axial"), 1e-7, scale=p) for p in SHOWN
    )


def stable_up_to_the_limit(solutions: Solutions) -> Finding:
    """Lowest eigenvalue of each wave number before and past the limit point."""
    volume, counts = solutions.along(GAS, "V"), solutions.branch(GAS).columns["n_negative"]
    before, past = decide.sides(volume, solutions.point(GAS, "limit_point", "V"))
    (change,) = solutions.points(GAS, "stability_change")
    limit = solutions.point(GAS, "limit_point", "p")
    return decide.all_of(
        decide.every("none negative before", counts[before] == 0),
        decide.every("one past it", counts[past] == 1),
        decide.same("wave number of the change", change.values["n"], 0.0),
        decide.agree("its pressure", decide.of_point(change, "p"), limit, 1e-8),
        *(decide.positive(f"n = {n}", solutions.along(GAS, f"Lambda_n{n}_1")) for n in WAVES[1:]),
    )


CASE = Case(
    title="The hemisphere under gas",
    source="Patil, Nordmark & Eriksson (2016), section 3.3; gas is not in the paper",
    panels=(
        Panel(
            "gw",
            x=Axis("t", 0, 1.6),
            y=Axis("gw", 0.9, 2.2),
            note="Not a figure of the paper.",
            curves=tuple(
                Curve(GAS, rf"$p = {p:g}$", reference=f"gw_hemisphere_p_{p:g}", at=at(p)) for p in SHOWN
            ),
        ),
        Panel(
            "branch",
            x=Axis("p", 0, 3.2),
            y=Axis("z_pole", -1.6, -1.0, label="height of the pole"),
            note="Not a figure of the paper.",
            curves=(Curve(GAS, "height of the pole", reference="hemisphere_gas_branch"),),
        ),
        Panel(
            "past",
            x=Axis("z_pole", -1.9, -1.5),
            y=Axis("p", 3.0, 3.2),
            note="Not a figure of the paper.",
            curves=(Curve(GAS, "pressure", reference="hemisphere_gas_past_limit"),),
        ),
        *(
            Panel(
                f"n = {n}",
                x=Axis("p", 0, 3.2),
                y=Axis("Lambda", 0, top, label=r"$\Lambda$"),
                title=f"$n = {n}$",
                note="Not a figure of the paper.",
                curves=tuple(
                    Curve(
                        GAS,
                        rf"$\Lambda_{k}$",
                        reference=f"modes_hemisphere_gas_n_{n}",
                        y=f"Lambda_{k}",
                        asked={f"Lambda_{k}": 4e-7},
                        columns={f"Lambda_{k}": f"Lambda_n{n}_{k}"},
                    )
                    for k in (1, 2, 3)
                ),
            )
            for n, top in ((10, 300), (50, 4000))
        ),
    ),
    checks=(
        Claim("taut", "under gas the hemisphere is taut at every pressure", ((GAS, None),), taut),
        Claim(
            "one_energy",
            "where nothing is wrinkled the relaxed energy, its other form and the full energy agree",
            tuple((e, wanted) for e in ENERGIES for wanted in (MIDDLE, None)),
            one_energy,
        ),
        Claim(
            "sphere_in_the_middle",
            "far from the equator the membrane is a part of a sphere",
            tuple((GAS, at(p)) for p in SMALL),
            sphere_in_the_middle,
        ),
        Claim(
            "turn_at_the_equator",
            "the layer at the equator turns the meridian by sqrt(p/48) at small pressures",
            tuple((GAS, at(p)) for p in SMALL),
            turn_at_the_equator,
        ),
        Claim(
            "stable_up_to_the_limit",
            "up to the highest pressure the hemisphere is stable; there it loses stability without waves",
            ((GAS, None),),
            stable_up_to_the_limit,
        ),
        Count("limit_point", {GAS: 1}, "one maximum of the pressure"),
        Claim(
            "no_axial_force",
            "the tension carries the pressure on each section, N cos(phi) = p r^2/2",
            tuple((GAS, at(p)) for p in SHOWN),
            no_axial_force,
        ),
        Points(
            "limit_point",
            reference="hemisphere_gas_limit",
            base=GAS,
            parameters=(),
            asked={"p": 5e-9, "z_pole": 1e-6, "V": 1e-6},
        ),
    ),
    asked={"gw": 5e-8, "z_pole": 5e-8, "V": 5e-8, "lam_pole": 5e-8, "p": 5e-9},
    slow=True,
)
