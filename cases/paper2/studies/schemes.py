"""Paper 2's schemes for contact on a fixed mesh, and their limit.

The schemes are frictionless contact by a conditional in the weak form (semi-smooth Newton), the printed
adhesive rule by pressure steps, and the front that moves from node to node. With linear elements, refined in
mesh and step, they are compared with the front-fitted solution at p = 3. The two adhesive schemes are of
first order in the contact length.
"""

import numpy as np

from weakforms.cases import At, Case, Claim, Finding, Solutions, decide, reference, tube, tube_scheme

CELLS = (50, 100, 200, 400)
END = At("p", 3.0)
DATA = {"alpha": 0.1, "delta1": 1}
LIMIT = {
    "semismooth": tube(contact="frictionless", **DATA),
    "pressure_steps": tube(contact="adhesive", **DATA),
    "front_nodes": tube(contact="adhesive", **DATA),
}
RUNS = {
    scheme: [tube_scheme(scheme=scheme, **DATA).on(cells=n, steps=2 * (n // 4)) for n in CELLS]
    for scheme in LIMIT
}
ORDERS = {
    "semismooth": {"u_max": 2, "contact_length": 1},
    "pressure_steps": {"u_max": 1, "contact_length": 1},
    "front_nodes": {"u_max": 1, "contact_length": 1},
}
"""First order; second order for the displacement in frictionless contact."""
COARSE = 0.1
"""Accuracy asked of the schemes, which are of first order, with the front within a cell of a coarse mesh."""


def tends_to_limit(scheme: str, solutions: Solutions) -> Finding:
    """Errors against the fitted solution: their mean rate, and their bounds on the two finest meshes."""
    found = []
    for name, expected in ORDERS[scheme].items():
        limit = solutions.number(LIMIT[scheme], END, name)
        runs = decide.stack(solutions.whole(spec, name) for spec in RUNS[scheme])
        errors = decide.Number(runs.value - limit.value, limit.uncertainty)
        found.append(decide.mean_order(name, CELLS, errors, expected))
        found.append(
            decide.agree(f"{name} on the finest meshes", runs[-2:], limit.value * np.ones(2), COARSE)
        )
    return decide.all_of(found)


def fictitious_time(solutions: Solutions) -> Finding:
    """The published integration after 5000 steps, and two changes of it, against Newton's method."""
    found = []
    for name in ("ftim_state", "ftim_contact_state"):
        table = reference(2, name)
        off = abs(table.number("u_max") - table.number("u_max_newton"))
        found += [
            decide.same(f"{name}: converged", table.columns["converged"].tolist(), [0, 1, 1]),
            decide.at_least("u_max as published off by", off[0], FAR),
            decide.zero("with a constant gain, and with a frozen tangent", off[1:], 1e-8),
        ]
    return decide.all_of(found)


FAR = decide.Stated(
    5e-3, "does not converge", "one percent of the displacement; a line of figure 2 is thinner"
)


def claim(scheme: str, statement: str) -> Claim:
    """The claim for one scheme."""
    wants = (*((spec, None) for spec in RUNS[scheme]), (LIMIT[scheme], END))
    return Claim(scheme, statement, wants, lambda solutions: tends_to_limit(scheme, solutions))


CASE = Case(
    title="Contact schemes on a fixed mesh",
    source="the algorithm of Patil, Nordmark & Eriksson (2014), section 3",
    checks=(
        claim("semismooth", "frictionless contact as a conditional tends to the front-fitted solution"),
        claim("pressure_steps", "the printed pressure stepping tends to the continuous adhesive history"),
        Claim(
            "fictitious_time",
            "the fictitious time integration as published does not converge in 5000 steps",
            (),
            fictitious_time,
            differs="the paper solves its difference equations by this method, with nu = 0.02 and a step of "
            "0.001; the factor nu/(1 + t) lets the slowest part of the error decay too slowly. With a "
            "constant gain, or with the tangent of the first guess, it converges",
        ),
        claim("front_nodes", "following the front from node to node tends to the same history"),
    ),
)
