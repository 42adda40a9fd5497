"""The hemisphere of flat triangles with Ogden's and Gent's rubbers, against the axisymmetric tables."""

import numpy as np

from weakforms.cases import At, Case, Claim, Finding, Solutions, decide, reference, surface

LAWS = {"ogden": {"model": "ogden", "gamma": 2.3}, "gent": {"model": "gent"}}
SIZES = (0.2, 0.1, 0.05)
TAUT = At("zw", -0.55)
"""A level at which the hemisphere is taut, so that errors decrease with the square of the size."""
BOWLS = {
    m: [surface(**given, geometry="hemisphere", size=size, load_start=-0.55, load_end=-0.6) for size in SIZES]
    for m, given in LAWS.items()
}
ASKED = 1e-3
"""Relative accuracy asked of the limit of the volume; the finest mesh alone is off by more."""


def known(model: str) -> decide.Number:
    """Volume of the axisymmetric hemisphere at that level."""
    table = reference("materials", f"hemisphere_{model}")
    return 2 * np.pi * table.number("V")[int(np.argmin(np.abs(table.columns["zw"] - TAUT.value)))]


def volume(solutions: Solutions) -> Finding:
    """Order of the volume's error, and the limit that the two finest meshes give, against the reference.

    The uncertainty of the limit is its distance from the limit of the two coarsest meshes.
    """
    found = []
    for model, specs in BOWLS.items():
        exact = known(model)
        values = np.array([solutions.value(spec, TAUT, "V") for spec in specs])
        found.append(
            decide.order(f"{model}: volume", [1 / size for size in SIZES], abs(values / exact.value - 1), 2)
        )
        before, limit = values[1:] + np.diff(values) / 3
        number = decide.Number(limit, abs(limit - before))
        found.append(decide.agree("limit of the volume", number, exact, ASKED))
    return decide.all_of(found)


def stable(solutions: Solutions) -> Finding:
    """No state has a negative eigenvalue."""
    counts = [solutions.branch(s).columns["n_negative"] for specs in BOWLS.values() for s in specs]
    return decide.every("states without a negative eigenvalue", np.concatenate(counts) == 0)


ALL = tuple(spec for specs in BOWLS.values() for spec in specs)

CASE = Case(
    title="The hemisphere on a surface mesh with other laws",
    source="the problem of Patil, Nordmark & Eriksson (2016), section 5, with laws of chapter 3",
    checks=(
        Claim(
            "volume",
            "with these laws too the volume on flat triangles converges with the square of their size to the "
            "axisymmetric one",
            tuple((spec, TAUT) for spec in ALL),
            volume,
        ),
        Claim("stable", "the equilibria are stable at these levels", tuple((s, None) for s in ALL), stable),
    ),
    slow=True,
)
