"""Paper 5, figure 6: lowest mode of n = 100 at zw/Ao = 3.

The meridional displacement nearly vanishes; the circumferential and the normal one are alike and localised
where the pressure is large.
"""

import numpy as np

from weakforms import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, wrinkled_tube

TUBE = wrinkled_tube(M=1.5, delta=3, Af=0.4362, n=(100,), load_end=4.0).on(cells=24)
SHOWN = At("zw", 3.0, profile=(), field="mode_n100")
ASKED = {"meridional": 1e-3, "circumferential": 1e-5, "normal": 1e-5}
"""Relative to the largest value of each; the meridional part is 200 times smaller than the others."""
PARTS = tuple(ASKED)


def alike(solutions: Solutions) -> Finding:
    """Largest meridional part over the largest normal one; least product of the other two."""
    columns = solutions.profile(TUBE, SHOWN).columns
    meridional, around, normal = (columns[name] for name in PARTS)
    share = np.abs(meridional).max() / normal.max()
    product = around * normal
    return bool(share < 0.01 and product.min() > -1e-6 * product.max()), (
        f"meridional {share:.1e} of the normal one; product at least {product.min() / product.max():.0e}"
    )


def localised(solutions: Solutions) -> Finding:
    """Mean place and standard deviation of the squared normal part, as a density along Z."""
    columns = solutions.profile(TUBE, SHOWN).columns
    z, square = columns["Z"], columns["normal"] ** 2
    mean = float((z * square).sum() / square.sum())
    spread = float(np.sqrt(((z - mean) ** 2 * square).sum() / square.sum()))
    wet = solutions.profile(TUBE, At("zw", 3.0, profile=())).columns
    surface = wet["Z"][wet["z"] <= 3.0].max()
    return mean < surface and spread < 8 / 10, f"{mean:.3f} +- {spread:.3f}; the surface is at {surface:.2f}"


CASE = Case(
    title="A mode of the liquid-filled cylinder",
    source="Patil, Nordmark & Eriksson (2016), figure 6",
    panels=tuple(
        Panel(
            name,
            x=Axis("Z", 0, 8),
            y=Axis(name, *((-0.01, 0.01) if name == "meridional" else (-0.1, 0.8)), label=f"{name} part"),
            title="$n = 100$, $z_w = 3$",
            curves=(Curve(TUBE, name, reference="mode_n_100_zw_3", at=SHOWN, asked={name: ASKED[name]}),),
        )
        for name in PARTS
    ),
    checks=(
        Claim(
            "alike",
            "the meridional displacement nearly vanishes, the other two have the same sign",
            ((TUBE, SHOWN),),
            alike,
        ),
        Claim(
            "localised",
            "the mode is localised near the lower end, where the pressure is large",
            ((TUBE, SHOWN),),
            localised,
        ),
    ),
    quick=True,
)
