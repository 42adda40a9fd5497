"""Paper 4, figure 8: profiles under fluid for disks of different radius, M = 0.5, delta = 2.

Af = 0.4 and 0.5, and the critical radius (printed as 0.5568). At zw = 4.5 the membranes on the smaller disks
are wrinkled everywhere; at higher levels they are taut in the middle and wrinkled at both ends.
"""

from weakforms.cases import (
    At,
    Axis,
    Case,
    Claim,
    Curve,
    Dashed,
    Finding,
    Panel,
    Solutions,
    decide,
    wrinkled_tube,
)

RADII = (0.4, 0.5, "critical")
TUBES = {Af: wrinkled_tube(M=0.5, delta=2, Af=Af) for Af in RADII[:2]}
TUBES["critical"] = wrinkled_tube(M=0.5, delta=2)
GAS = wrinkled_tube(M=0.5, delta=2, load="gas", Af=0.4)
LOW, HIGH = (At("zw", v, profile=()) for v in (4.5, 12.0))
INFLATED = At("p", 0.2, profile=())


def all_wrinkled(solutions: Solutions) -> Finding:
    """Wrinkled fraction at zw = 4.5."""
    shares = {Af: solutions.number(TUBES[Af], LOW, "wrinkled_fraction") for Af in RADII}
    return decide.all_of(
        *(decide.exact(f"share for Af = {Af}", shares[Af].value, 1.0) for Af in RADII[:2]),
        decide.less("critical disks: share", shares["critical"], 1),
        decide.positive("gw - 1 at their lower end", solutions.column(TUBES["critical"], LOW, "gw")[0] - 1),
    )


def taut_middle(solutions: Solutions) -> Finding:
    """Af = 0.4 and 0.5 at zw = 12, and Af = 0.4 at p = 0.2: two fronts, both ends wrinkled."""
    found = []
    for spec, at in ((TUBES[0.4], HIGH), (TUBES[0.5], HIGH), (GAS, INFLATED)):
        count = sum(name.startswith("Z_front") for name in solutions.state(spec, at).quantities)
        found.append(decide.same(f"fronts, {at}", count, 2))
        found.append(decide.negative("gw - 1 at the ends", solutions.column(spec, at, "gw")[[0, -1]] - 1))
    return decide.all_of(found)


def panel(name: str, at: At, radii: tuple, note: str = "") -> Panel:
    """Profiles at one level."""
    return Panel(
        name,
        x=Axis("r", 0, 1),
        y=Axis("z", 0, 16),
        title=rf"$M = 0.5$, $\delta = 2$, $z_w = {at.value:g}$",
        dashed=Dashed("gw", 1.0, "taut", "wrinkled"),
        curves=tuple(
            Curve(
                TUBES[Af],
                rf"$A_f = {Af}$" if Af != "critical" else "$(A_f)_c$",
                reference=f"fig08_Af_{Af}_zw_{at.value:g}"
                if Af != "critical"
                else f"fig02_M_0.5_zw_{at.value:g}",
                at=at,
            )
            for Af in radii
        ),
        note=note,
    )


CASE = Case(
    title="Disks of different radius",
    source="Patil, Nordmark & Eriksson (2015), figure 8",
    panels=(panel("8", LOW, RADII), panel("8, zw = 12", HIGH, RADII, "Not a figure of the paper.")),
    checks=(
        Claim(
            "all_wrinkled",
            "on disks of 0.4 and 0.5 the membrane is wrinkled everywhere at zw = 4.5; on the critical ones "
            "its lower end is taut",
            tuple((TUBES[Af], LOW) for Af in RADII),
            all_wrinkled,
        ),
        Claim(
            "taut_middle",
            "at higher loads a taut zone is in the middle and both ends stay wrinkled",
            ((TUBES[0.4], HIGH), (TUBES[0.5], HIGH), (GAS, INFLATED)),
            taut_middle,
        ),
    ),
    asked={"r": 5e-9, "z": 5e-9, "lam1": 5e-9, "lam2": 5e-9, "gw": 5e-9, "tension": 5e-9},
)
