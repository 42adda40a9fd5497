"""Paper 2, free inflation: observed orders of convergence with elements of degree 1, 2 and 3.

Theory for degree k: displacement k + 1, stretch k, limit pressure and eigenvalue 2k.
"""

from weakforms.cases import At, Case, Claim, Finding, Order, Solutions, decide, tube

TUBE = tube(alpha=0.1, delta1=1)
CELLS = (16, 32, 64)
STATE = At("p", 1.5)
EIGENVALUE = {k: TUBE.on(degree=k, cells=n) for k, n in ((1, 128), (2, 64))}


def eigenvalue_order(solutions: Solutions) -> Finding:
    """Order of the lowest eigenvalue at u_max = 3 from three meshes, compared with its uncertainty."""
    found = []
    for k, spec in EIGENVALUE.items():
        q = solutions.quantity(spec, At("u_max", 3.0), "eigenvalue_1")
        found.append(
            decide.positive(
                f"P{k}, observed order minus {2 * k} and its slack",
                decide.number(q.order or float("nan")) - 2 * k + decide.ORDER_SLACK,
            )
        )
        found.append(decide.positive(f"P{k}, eigenvalue beside its uncertainty", abs(decide.number(q))))
    return decide.all_of(found)


CASE = Case(
    title="Orders of convergence",
    source="the problem of Patil, Nordmark & Eriksson (2014), figure 2",
    checks=(
        Order(
            "limit pressure",
            of=TUBE,
            expected={1: 2, 2: 4, 3: 6},
            cells=CELLS,
            kind="limit_point",
            reference="limit_points_alpha_0.1",
            column="p",
        ),
        Order(
            "radius along the tube",
            of=TUBE,
            expected={1: 2, 2: 3, 3: 4},
            cells=CELLS,
            at=STATE,
            reference="fig04_p_1.5",
            column="rho",
        ),
        Order(
            "meridional stretch along the tube",
            of=TUBE,
            expected={1: 1, 2: 2, 3: 3},
            cells=CELLS,
            at=STATE,
            reference="fig04_p_1.5",
            column="lam1",
        ),
        Claim(
            "eigenvalue_order",
            "the lowest eigenvalue of the second variation converges at order 2k",
            tuple((spec, At("u_max", 3.0)) for spec in EIGENVALUE.values()),
            eigenvalue_order,
        ),
    ),
    asked={},
    slow=True,
)
