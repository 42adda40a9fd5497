"""Paper 4, figure 4: profiles of the fluid-filled membrane, Case 1, Af = (Af)_c; taut full, wrinkled dashed.

(a) M = 0.5, (b) M = 1.5. The text does not give the pre-stretch; both are drawn. Figures 2 and 3 show the
same states.
"""

from weakforms.cases import At, Axis, Case, Curve, Dashed, Panel, wrinkled_tube

LEVELS = (3, 4.5, 6, 7.44, 10, 12, 16)
TABLES = {2: "fig02", 3: "fig03"}

CASE = Case(
    title="Profiles under fluid",
    source="Patil, Nordmark & Eriksson (2015), figure 4",
    panels=tuple(
        Panel(
            f"{name}, delta = {delta}",
            x=Axis("r", 0, 1.2),
            y=Axis("z", 0, 8 * delta),
            title=rf"$M = {M}$, $\delta = {delta}$",
            dashed=Dashed("gw", 1.0, "taut", "wrinkled"),
            curves=tuple(
                Curve(
                    wrinkled_tube(M=M, delta=delta),
                    rf"$z_w = {v}$",
                    reference=f"{TABLES[delta]}_M_{M}_zw_{v}",
                    at=At("zw", float(v), profile=()),
                )
                for v in LEVELS
            ),
        )
        for name, M in (("a", 0.5), ("b", 1.5))
        for delta in TABLES
    ),
    asked={"r": 5e-9, "z": 5e-9},
)
