r"""The free tube as a surface whose pattern repeats around the axis: one half wave of one half of its length.

The position has the components ``(X, Y, Z)`` in the frame :math:`(e_r, e_\theta, e_z)` of the material angle
``Theta``, over ``[0, lf/2] x [0, pi/n]``. Both meridians and the mid-plane are mirrors: ``Y = 0`` on
``Theta = 0`` and ``pi/n``, the height is zero at mid-length, and the disk holds the last ring. Energy and
volume are those of the half tube over :math:`2\pi`, as of :mod:`weakforms.problems.tube.model`:

.. math:: \frac\Pi{2\pi} = \frac n\pi \int_0^{l_f/2}\!\!\int_0^{\pi/n} \Big[ \frac{w(C)}{\sqrt{\delta_1}}
          - \frac p2\, (X N_r + Y N_\theta) \Big] \mathrm d\Theta\, \mathrm dZ, \quad
          N = x_{,\Theta} \times x_{,Z}

The gas acts on the actual surface. The integral of :math:`(X N_r + Y N_\theta)/2` is its volume, because the
mirrors contain the axis or are normal to it. An axisymmetric state is the same in both models.

With the relaxed energy ``w`` is that of a tension field, by the principal stretches of ``C``: the tube
wrinkles in any direction. Fronts lie inside of elements.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np
import ufl
from dolfinx import fem
from dolfinx import mesh as dmesh
from mpi4py import MPI
from ufl.core.expr import Expr

from weakforms.forms import revolution
from weakforms.forms.fluid import Surface
from weakforms.forms.materials import stress_resultants
from weakforms.forms.wrinkling import (
    Law,
    modified_gradient,
    natural_width,
    principal_stretches,
    surface_tension_field,
)
from weakforms.problems.material_choice import Chosen
from weakforms.problems.meridian.blocks import one_end
from weakforms.problems.meridian.kinks import INDICATED
from weakforms.problems.meridian.sector import Sector, SectorMesh
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.system import System
from weakforms.solvers.stability.modes import SecondVariation

AMPLITUDE = "u_wave"
"""Column of the amplitude, ``c.x``: the part of ``cos(n Theta)`` in the mid-plane's radial displacement."""

MIDDLE = 1
"""Tag of the edge at mid-length."""

EVEN, ODD = "even", "odd"
"""Parity about a mirror: it maps a displacement to itself, or to the reverse."""

TURNING, TURN = "turning", "turn"
"""Functionals of a class: the product of a displacement with the rotation of the pattern, and the latter's
square."""


@dataclass(frozen=True)
class Parities:
    """A class of displacements by its parities about the meridians ``Theta = 0``, ``pi/n`` and mid-length."""

    first: str
    last: str
    middle: str

    @property
    def vanishing(self) -> list[tuple[tuple[int, ...], str]]:
        """Components that are zero on a mirror, with its name: across it if even, along it if odd."""
        given = {"first": (self.first, 1), "last": (self.last, 1), "middle": (self.middle, 2)}
        return [
            ((across,) if parity == EVEN else tuple({0, 1, 2} - {across}), mirror)
            for mirror, (parity, across) in given.items()
        ]


OWN = Parities(EVEN, EVEN, EVEN)
"""The class of the states."""


class BentTube(Sector):
    """Weak form of the surface; load ``p``.

    Args:
        comm: Ranks.
        material: The law.
        delta1: Axial pre-stretch.
        half: Half the length.
        n: Number of waves around the axis, at least 1.
        at: The mesh.
        energy: ``standard`` (no wrinkling) or ``relaxed``.
    """

    def __init__(
        self,
        comm: MPI.Intracomm,
        material: Chosen,
        delta1: float,
        half: float,
        n: int,
        at: SectorMesh,
        energy: str = "standard",
    ) -> None:
        super().__init__(comm, half, n, at, one_end(at.grading))
        self.delta1, self.energy = delta1, energy
        self.unknown.interpolate(lambda x: np.vstack([np.ones_like(x[0]), 0 * x[0], x[0]]))
        self._law = material.surface_law(self.mesh)
        pressure = fem.Constant(self.mesh, 0.0)
        self.loads = {"p": (pressure, ufl.variable(pressure))}
        facets = dmesh.locate_entities_boundary(self.mesh, 1, lambda x: np.isclose(x[0], 0.0))
        tags = dmesh.meshtags(self.mesh, 1, np.sort(facets), np.full(len(facets), MIDDLE, dtype=np.int32))
        rule = {"quadrature_degree": 2 * at.degree + 2}
        self.dx = ufl.Measure("dx", self.mesh, metadata=rule)
        self.middle = ufl.Measure("ds", self.mesh, subdomain_data=tags, metadata=rule)(MIDDLE)
        self.system = System(self.formulation())

    def metric(self, at: Surface) -> Expr:
        """Right Cauchy-Green tensor of the stress-free tube."""
        return revolution.gradient_tensor(at, 1.0, (self.delta1, self.delta1**-0.5))

    def potential(self, at: Surface) -> Expr:
        """The potential per ``dTheta dZ``."""
        strain = self.strain(self.metric(at)) / self.delta1**0.5
        return strain + revolution.gas_energy(at, self.loads["p"][1])

    def strain(self, c: Expr) -> Expr:
        """Strain energy per reference volume."""
        if self.energy == "relaxed":
            return surface_tension_field(c, self._law)
        return self._law.invariants(ufl.tr(c), ufl.det(c))

    def along_principal(self) -> Law:
        """The same of given principal stretches."""
        if self.energy == "relaxed":
            return modified_gradient(self._law.stretches, self._law.width or natural_width)
        return self._law.stretches

    def formulation(self) -> Formulation:
        """The weak form with its columns; ``u_max`` is the mean around the axis."""
        at, share = self.surface(self.unknown), self.n / np.pi
        trial, test = ufl.TrialFunction(self.space), ufl.TestFunction(self.space)
        energy = share * self.potential(at) * self.dx
        wave = ufl.cos(self.n * ufl.SpatialCoordinate(self.mesh)[1])
        return Formulation(
            unknown=self.unknown,
            residual=ufl.derivative(energy, self.unknown, test),
            loads=self.loads,
            bcs=self.conditions(OWN, np.array([1.0, self.length])),
            mass=share * ufl.inner(trial, test) * self.dx,
            monitors={
                "u_max": share * (at.x[0] - 1) * self.middle,
                "V": share * revolution.gas_energy(at, -1.0) * self.dx,
                "Pi": energy,
                AMPLITUDE: 2 * share * at.x[0] * wave * self.middle,
            },
            profile=self.profile(at),
        )

    def profile(self, at: Surface) -> dict[str, Expr]:
        """Position and, on the mirrors, stretches along meridian and circumference with their resultants."""
        c = self.metric(at)
        lam1, lam2 = ufl.sqrt(c[0, 0]), ufl.sqrt(c[1, 1])
        t1, t2 = stress_resultants(self.along_principal(), lam1, lam2)
        return {"rho": at.x[0], "eta": at.x[2], "lam1": lam1, "lam2": lam2, "t1": t1, "t2": t2}

    def principal_resultants(self, relaxed: bool = False) -> dict[str, Expr]:
        """Principal Cauchy resultants, that of the larger stretch first.

        Args:
            relaxed: Those of the energy of the model, none of which is negative if that is the relaxed one,
                in place of those of a tube that bears compression.
        """
        law = self.along_principal() if relaxed else self._law.stretches
        resultants = stress_resultants(law, *principal_stretches(self.metric(self.surface(self.unknown))))
        return dict(zip(("first", "second"), resultants, strict=True))

    def wrinkled_part(self) -> ufl.Form:
        """Part of the stress-free surface on which a resultant of the law is negative."""
        first, second = self.principal_resultants().values()
        taut = ufl.And(ufl.gt(first, 0), ufl.gt(second, 0))
        share = self.n / np.pi / self.length
        degree = INDICATED * self.space.ufl_element().embedded_superdegree
        return ufl.conditional(taut, 0.0, share) * self.dx(metadata={"quadrature_degree": degree})

    def variation(self, parities: Parities) -> SecondVariation:
        r"""The second variation in a class of displacements ``q``.

        The pattern of a state is turned about the axis by :math:`-x_{,\Theta}` in its components.
        """
        q, share = fem.Function(self.space, name="displacement"), self.n / np.pi
        trial, test = ufl.TrialFunction(self.space), ufl.TestFunction(self.space)
        energy = share * self.potential(self.surface(self.unknown + q)) * self.dx
        turn = -self.unknown.dx(1)
        return SecondVariation(
            Formulation(
                unknown=q,
                residual=ufl.derivative(energy, q, test),
                loads=self.loads,
                bcs=self.conditions(parities, np.zeros(2)),
                mass=share * ufl.inner(trial, test) * self.dx,
                monitors={
                    TURNING: share * ufl.inner(turn, q) * self.dx,
                    TURN: share * ufl.inner(turn, turn) * self.dx,
                },
            ),
            self.system,
        )

    def conditions(self, parities: Parities, ring: np.ndarray) -> list[fem.DirichletBC]:
        """The ring at the disk, of a radius and a height, and the mirrors' conditions on a class."""
        edges = {"middle": (0, 0.0), "first": (1, 0.0), "last": (1, self.width)}
        places = {name: partial(_on, axis=axis, value=value) for name, (axis, value) in edges.items()}
        disk = self.held(
            partial(_on, axis=0, value=self.length),
            lambda s, _: np.vstack([0 * s + ring[0], 0 * s, 0 * s + ring[1]]),
        )
        zero = [(part, places[mirror]) for parts, mirror in parities.vanishing for part in parts]
        return [disk, *self.vanishing(zero)]


def _on(x: np.ndarray, axis: int, value: float) -> np.ndarray:
    return np.isclose(x[axis], value)
