"""Paper 5, figure 6: lowest mode of n = 100 at zw/Ao = 3.

The meridional displacement nearly vanishes; the circumferential and the normal one are alike and localised
where the pressure is large.
"""

import numpy as np

from weakforms.cases import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, decide, wrinkled_tube

TUBE = wrinkled_tube(M=1.5, delta=3, Af=0.4362, n=(100,), load_end=4.0).on(cells=24)
SHOWN = At("zw", 3.0, profile=(), field="mode_n100")
ASKED = {"meridional": 1e-5, "circumferential": 1e-6, "normal": 5e-7}
"""Accuracy relative to the largest value of each part; the meridional part is 200 times smaller than the
others."""
PARTS = tuple(ASKED)


SHARE = 1e-3
"""Fraction of its largest value above which the product of the two parts has a definite sign."""
NEARLY = decide.Stated(0.01, "nearly vanishes", "no number is printed; a line of figure 6 is as wide")
OPPOSITE = decide.Stated(
    1e-6, "the same sign", "where one of them crosses zero the product is of second order"
)
LOCALISED = decide.Stated(0.8, "localised", "no number is printed; a tenth of the length 8")


def alike(solutions: Solutions) -> Finding:
    """Largest meridional part over the largest normal one; product of the other two where either is large."""
    meridional, around, normal = (solutions.column(TUBE, SHOWN, name) for name in PARTS)
    product = around * normal
    large = product.value > SHARE * product.value.max()
    return decide.all_of(
        decide.at_most("meridional over normal", abs(meridional).largest() / abs(normal).largest(), NEARLY),
        decide.positive("product where it is large", product[large]),
        decide.at_most(
            "its most negative value over its largest", -product.smallest() / product.largest(), OPPOSITE
        ),
    )


def localised(solutions: Solutions) -> Finding:
    """Mean position and standard deviation of the squared normal part, as a density along Z."""
    z, normal = solutions.profile(TUBE, SHOWN).columns["Z"], solutions.column(TUBE, SHOWN, "normal")
    square = normal.value**2
    weight = square / square.sum()
    mean = float((z * weight).sum())
    spread = float(np.sqrt(((z - mean) ** 2 * weight).sum()))
    # A change of the mode by its uncertainty moves both by at most this fraction of the length 8.
    known = decide.Number(0.0, 2 * 8 * np.max(normal.uncertainty) / normal.value.max())
    wet = solutions.profile(TUBE, At("zw", 3.0, profile=())).columns
    surface = wet["Z"][wet["z"] <= 3.0].max()
    return decide.all_of(
        decide.less("mean position and the surface", mean + known, surface),
        decide.at_most("standard deviation", spread + known, LOCALISED),
    )


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
