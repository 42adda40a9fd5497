"""Paper 1: free inflation before any contact, its limit points and its limits of small pressure.

A neo-Hookean disk has a limit point of the pressure. For large pre-stretch it tends to the limit point of a
film of constant tension, p = 4 at t0 = 1. A Mooney-Rivlin disk (alpha = 0.1, beta = 1) has none.
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
    circular,
    decide,
    reference,
)

SETS = ((0, 1), (0, 2), (0.1, 1), (0.1, 2))
ENDS = {(0, 1): 3.1, (0, 2): 3.1, (0.1, 1): 4.1, (0.1, 2): 4.1}
# Twice the usual cells: at t0 = 4 the stretches reach 20 and fall steeply at the clamp.
FREE = {s: circular(alpha=s[0], beta=s[1], t_end=ENDS[s]).on(cells=192) for s in SETS}
FILM = {beta: circular(alpha=0, beta=beta, t_end=2.0) for beta in (1.2, 1.5, 2, 3, 5, 10)}
BEFORE, AFTER = ([At("p", p, crossing=k) for p in (2.8, 3.2, 3.6)] for k in (1, 2))
SMALL = (0.48, 0.24, 0.12, 0.06)


TENDS = decide.Stated(
    1e-3, "tends to p = 4", "difference at pre-stretch 10, of the sixth inverse power and higher"
)


def isotropic_rest(solutions: Solutions) -> Finding:
    """lam1 and lam2 of the pre-stretched disk without pressure."""
    lam1, lam2 = (solutions.column(FREE[0.1, 2], At("p", 0.0, profile=()), name) for name in ("lam1", "lam2"))
    return decide.agree("lam1 and lam2", lam1, lam2, 5e-10)


def film(solutions: Solutions) -> Finding:
    """Limit pressure and pole height over the pre-stretch, as differences from the film's values."""
    p, t0 = (
        decide.stack(solutions.point(spec, "limit_point", name) for spec in FILM.values())
        for name in ("p", "t0")
    )
    return decide.all_of(
        decide.falls("|p - 4|", abs(p - 4)),
        decide.falls("|t0 - 1|", abs(t0 - 1)),
        decide.at_most("|p - 4| at beta = 10", abs(p[-1] - 4), TENDS),
    )


def at_rest(values: decide.Number) -> decide.Number:
    """Limit of numbers at decreasing heights, each half the one before, whose expansion has even powers only.

    Each further height gives one more extrapolation (Romberg); the last change is the uncertainty.
    """
    power = 4
    while len(values) > 1:
        change = values.diff() / (power - 1)
        values, power = values[1:] + change, 4 * power
    return values[0] + decide.Number(0.0, abs(change.value[0]))


def stretched_start(solutions: Solutions) -> Finding:
    """dp/dt0 at rest against 8 (1 - beta^-6)(1 + alpha beta^2), from small heights."""
    found = []
    for s in ((0, 2), (0.1, 2)):
        exact = 8 * (1 - s[1] ** -6) * (1 + s[0] * s[1] ** 2)
        slopes = decide.stack(solutions.number(FREE[s], At("t0", t), "p") / t for t in SMALL)
        found.append(decide.agree(f"dp/dt0 and {exact:.6g}", at_rest(slopes), exact, 5e-5))
    return decide.all_of(found)


def cubic_start(solutions: Solutions) -> Finding:
    """p/t0^3 of the unstretched disk for both laws, from small heights, and the table over 1 + alpha."""
    table = reference(1, "small_t0")
    known, alpha = table.number("p_per_t0_cubed"), table.columns["alpha"]
    found = [decide.constant("C of all laws", known / (1 + alpha), 1e-9)]
    for a in (0, 0.1):
        here = decide.stack(solutions.number(FREE[a, 1], At("t0", t), "p") / t**3 for t in SMALL)
        found.append(decide.agree(f"alpha = {a}: p/t0^3", at_rest(here), known[alpha == a][0], 1e-4))
    return decide.all_of(found)


def stiffens_then_softens(solutions: Solutions) -> Finding:
    """Height of neo-Hookean disks at equal pressure without and with pre-stretch, around the limit points."""
    return decide.all_of(
        way(
            f"t0 at p = {at.value}, crossing {at.crossing}",
            [solutions.number(FREE[0, b], at, "t0") for b in (1, 2)],
        )
        for at, way in (*((at, decide.falls) for at in BEFORE), *((at, decide.rises) for at in AFTER))
    )


CASE = Case(
    title="Free inflation and its limit points",
    source="Patil, DasGupta & Eriksson (2015), sections 2 and 5",
    panels=(
        Panel(
            "p",
            x=Axis("p", 0, 12),
            y=Axis("t0", 0, 4),
            markers="limit_point",
            curves=tuple(
                Curve(
                    FREE[s],
                    rf"$\alpha = {s[0]}$, $\beta = {s[1]}$",
                    reference=f"free_alpha_{s[0]}_beta_{s[1]}",
                )
                for s in SETS
            ),
        ),
    ),
    checks=(
        Count(
            "limit_point",
            {FREE[0, 1]: 1, FREE[0, 2]: 1, FREE[0.1, 1]: 0},
            "neo-Hookean disks have a limit point, the Mooney-Rivlin one has none up to t0 = 4",
        ),
        Points(
            "limit_point",
            reference="free_limit_points",
            base=circular(t_end=3.1),
            parameters=("alpha", "beta"),
            asked={"p": 5e-10, "t0": 5e-10, "lam_pole": 1e-9},
        ),
        Claim(
            "isotropic_rest",
            "without pressure both stretches are equal",
            ((FREE[0.1, 2], At("p", 0.0, profile=())),),
            isotropic_rest,
        ),
        Claim(
            "film",
            "with pre-stretch the limit point tends to p = 4, t0 = 1",
            tuple((s, None) for s in FILM.values()),
            film,
        ),
        Claim(
            "stiffens_then_softens",
            "at equal pressure the pre-stretched disk is lower before its limit point and higher after it: "
            "pre-stretch stiffens, then softens (chapter 6.1)",
            tuple((FREE[0, b], at) for b in (1, 2) for at in (*BEFORE, *AFTER)),
            stiffens_then_softens,
        ),
        Claim(
            "stretched_start",
            "at rest dp/dt0 = 8 (1 - beta^-6)(1 + alpha beta^2)",
            tuple((FREE[s], At("t0", t)) for s in ((0, 2), (0.1, 2)) for t in SMALL),
            stretched_start,
        ),
        Claim(
            "cubic_start",
            "without pre-stretch p = C (1 + alpha) t0^3 at small heights, C independent of alpha",
            tuple((FREE[a, 1], At("t0", t)) for a in (0, 0.1) for t in SMALL),
            cubic_start,
        ),
    ),
    asked={"p": 5e-10, "lam_pole": 1e-9, "V": 1e-9, "lam1_rim": 1e-6},
)
