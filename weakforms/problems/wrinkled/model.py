"""Wrinkled membranes of revolution: the model whose blocks are fitted to its zones.

A block can be marked taut or wrinkled, and wet or dry. Then the solution is smooth on every block, and a
front or the surface of the liquid is a break point, a scalar unknown with its own equation. In unmarked
blocks a ``conditional`` chooses the state at each point. Both use the same compiled form.

The unknown is the difference between ``(r/R, z)`` and a given shape. Dirichlet values are then zero, and
every parameter is a constant of the form.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cached_property, lru_cache, partial, wraps
from typing import Any

import numpy as np
import ufl
from mpi4py import MPI
from ufl.core.expr import Expr

from weakforms.forms.materials import SurfaceLaw, mooney_rivlin_surface
from weakforms.forms.wrinkling import wrinkling_function
from weakforms.problems.material_choice import Chosen
from weakforms.problems.meridian.blocks import BREAK, LOWER, UPPER, Blocks
from weakforms.problems.meridian.body import Body
from weakforms.problems.meridian.model import MeridianModel
from weakforms.problems.wrinkled.body import SHARED
from weakforms.solvers.equilibrium.formulation import Formulation

KEPT = 8
"""Number of things of one kind that are kept with a model."""


class WrinkledModel(MeridianModel):
    r"""Weak form on ``blocks`` blocks of ``cells`` cells each, with parameters that can be changed.

    The energy is the full one where ``gw = lam2 sqrt(lam1) > 1`` and the relaxed one elsewhere, under
    :math:`P = p + \gamma \max(z_w - z, 0)`; lengths over the reference radius, energies over ``C1 h`` (Patil,
    Nordmark & Eriksson 2015, equations 10 to 13).

    Loads: the body's parameters, :data:`SHARED`, and ``b1``, ``b2`` and so on for the inner break points.

    Args:
        comm: Ranks.
        body: The membrane.
        values: First values of the parameters.
        blocks: Number of blocks of the meridian.
        cells: Number of cells of each block.
        degree: Degree of the elements.
        energy: ``relaxed``, ``modified_gradient`` (the same in another form) or ``standard`` (no wrinkling).
        material: An incompressible law that replaces the Mooney-Rivlin law with ``c2``.
    """

    def __init__(
        self,
        comm: MPI.Intracomm,
        body: Body,
        values: Mapping[str, float],
        blocks: int,
        cells: int,
        degree: int,
        energy: str = "relaxed",
        material: Chosen | None = None,
    ) -> None:
        self.kept: dict[Callable, Callable] = {}
        super().__init__(
            comm,
            body,
            {name: values.get(name, 0.0) for name in (*body.parameters, *SHARED)},
            Blocks(
                np.linspace(0.0, body.length(values), blocks + 1),
                cells,
                degree,
                # Products of the unknown and the load are integrated exactly, without spurious asymmetry.
                quadrature=4 * degree,
                fronts={f"b{k}": k for k in range(1, blocks)},
            ),
            energy,
            material,
        )

    def look_at(self, node: int, after: bool = False) -> None:
        """Choose the break point or end, and the side, at which :meth:`point` evaluates functionals.

        Args:
            node: Index of the break point, 0 and ``blocks`` for the ends.
            after: Whether the block after it is used instead of the one before.
        """
        after = after or node == 0
        side = node + (0.5 if after else -0.5) / self.cells
        self._by_cell["here"].x.array[:] = np.abs(self._middles - side) < 1e-9

    def point(self, value: Expr) -> ufl.Form:
        """Value at the point chosen by :meth:`look_at`, as a form, so that every rank gets it."""
        seen = self._by_cell["here"] * value
        breaks = tuple(range(BREAK, BREAK + self.blocks - 1))
        return (seen("+") + seen("-")) * self.inner(breaks) + seen * ufl.Measure("ds", self.mesh)

    @cached_property
    def expressions(self) -> dict[str, Expr]:
        """Also the wrinkling function, the pressure, and the volume of the liquid."""
        e, q = super().expressions, self.q
        depth = q["zw"] - e["z"]
        wet = self.marked("wet", depth)
        pressure = q["p"] + ufl.conditional(wet, q["gamma"] * depth, 0.0)
        gw = wrinkling_function(e["lam1"], e["lam2"])
        return {**e, "gw": gw, "pressure": pressure, "filled": ufl.conditional(wet, e["volume"], 0.0)}

    @cached_property
    def full(self) -> SurfaceLaw:
        """The law without wrinkling, divided by ``C1`` or the stress of its constants."""
        return super().full if self.material_law is not None else mooney_rivlin_surface(self.q["c2"])

    def tension(self) -> Expr:
        r"""Meridional tension per reference arc of hoop angle, :math:`N = H R\, W_{,1}` over ``C1 h``."""
        e = self.expressions
        lam1, lam2 = ufl.variable(e["lam1"]), e["lam2"]
        return e["weight"] * ufl.diff(self.law(lam1, lam2), lam1)

    def formulation(self) -> Formulation:
        """The weak form with columns, the functionals of fronts, and fields."""
        e, ends, pole = self.expressions, self.ends, self.body.pole
        tension, given = self.tension(), super().formulation()
        at_pole = {"z_pole": e["z"] * ends(LOWER), "lam_pole": e["lam2"] * ends(LOWER)} if pole else {}
        slope = {} if pole else {"slope": e["r_s"] / e["z_s"]}  # horizontal at a pole
        return replace(
            given,
            monitors={
                **given.monitors,
                "Pi": (self.strain - e["pressure"] * e["volume"]) * e["width"] * self.dx,
                "V_f": e["filled"] * e["width"] * self.dx,
                "N": tension * ends(UPPER if pole else LOWER),
                **at_pole,
                "gw": self.point(e["gw"]),
                "gw_slope": self.point(e["gw"].dx(0) / e["width"]),
                "z": self.point(e["z"]),
            },
            internal=("V_f", "gw", "gw_slope", "z"),
            mark=self.mark,
            profile={
                **{name: e[name] for name in ("r", "z", "lam1", "lam2", "gw")},
                "tension": tension,
                "axial": tension * e["z_s"] / e["lam1"] - e["pressure"] * e["r"] ** 2 / 2,
                **slope,
            },
        )


def kept_with_model(make: Callable) -> Callable:
    """Wrap a function of a model and other arguments: what it makes is kept, at most as long as the model."""

    @wraps(make)
    def kept(model: WrinkledModel, *others: Any) -> Any:
        if make not in model.kept:
            model.kept[make] = lru_cache(KEPT)(partial(make, model))
        return model.kept[make](*others)

    return kept
