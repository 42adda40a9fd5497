r"""Weak form of a rectangular membrane on triangles, and its second variation in each symmetry class.

.. math:: \Pi = \int W(C)\,\mathrm dA - \int \varphi(z)\, N_z\,\mathrm dA, \qquad
          \varphi = p\,z + \tfrac12 \gamma \big[(z_w - z)_+^2 - (z_w)_+^2\big]

over the reference rectangle ``[-1, 1] x [-c, c]``: gas pushes from below, a liquid stands on top. The edges
are held at ``x = (delta X, delta_y Y, 0)``. Lengths are divided by half the short side ``a``, energies by
``C1 h a^2``. The unknown is the displacement from the flat sheet with these stretches.

A state with both mirrors is solved for on the quarter ``[0, 1] x [0, c]``. The second variation of such a
state decouples into four classes, by the parity of ``z`` in ``X`` and in ``Y``; each is the same form on the
quarter with other conditions on the mirrors. Together they are all displacements of the whole sheet.

A state of a square also has the mirrors in its diagonals. Its class with both mirrors then decouples into A1
and B1, that odd in both into B2 and A2, and the two others are a pair, class E of the group C4v: see
:mod:`weakforms.problems.rectangle.octant`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import ufl
from dolfinx import fem
from dolfinx import mesh as dmesh
from mpi4py import MPI
from ufl.core.expr import Expr

from weakforms.forms.relaxed_surface import SLACK, WRINKLED, depth, least_stress, state
from weakforms.forms.wrinkling import principal_stretches
from weakforms.problems.material_choice import Chosen
from weakforms.problems.rectangle.octant import DIAGONAL, Octant
from weakforms.problems.triangles.readings import corner_weight
from weakforms.problems.triangles.weak_form import RULE, Membrane, scalars
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.system import System
from weakforms.solvers.stability.modes import SecondVariation

CLASSES = {0: "even_even", 1: "odd_even", 2: "even_odd", 3: "odd_odd"}
"""Parity of ``z`` in ``X`` and ``Y``, by the number of the class."""

VANISH = {"even": ("normal",), "odd": ("along", "height")}
"""Components that vanish on a mirror, by the parity of ``z``."""


@dataclass(frozen=True)
class Sheet:
    """The membrane, its load and its mesh.

    Attributes:
        law: The law.
        load: ``gas`` from below, or ``liquid`` on top.
        c: Long side over short side.
        delta: Stretch of the frame in ``X``.
        delta_y: Stretch of the frame in ``Y``.
        gamma: Weight of the liquid.
        relaxed: Whether the sheet bears no compression.
        strip: Whether the short edges are free in the plane ``y = delta_y Y`` that all points then keep.
        whole: Whether the mesh is the whole sheet; else the quarter of it.
        cells: Squares along half the short side; each has four triangles.
        degree: Degree of the elements, 1 or 2.
    """

    law: Chosen
    load: str = "liquid"
    c: float = 1.0
    delta: float = 1.1
    delta_y: float = 1.1
    gamma: float = 1.0
    relaxed: bool = True
    strip: bool = False
    whole: bool = False
    cells: int = 8
    degree: int = 2

    @property
    def control(self) -> str:
        """Name of the load: ``p`` or ``zw``."""
        return "p" if self.load == "gas" else "zw"

    @property
    def sign(self) -> float:
        """Direction of the deflection: 1 up, -1 down."""
        return 1.0 if self.load == "gas" else -1.0

    @property
    def is_square(self) -> bool:
        """Whether an exchange of ``X`` and ``Y`` is a symmetry too."""
        return self.c == 1 and self.delta == self.delta_y and not self.strip

    @property
    def has_diagonals(self) -> bool:
        """Whether displacements of the quarter decouple by the mirrors in the diagonals."""
        return self.is_square and not self.whole

    @property
    def copies(self) -> int:
        """Number of meshes that make the whole sheet."""
        return 1 if self.whole else 4

    def mesh(self, comm: MPI.Intracomm) -> dmesh.Mesh:
        """Squares cut by both diagonals: the mesh has all symmetries of the sheet."""
        low = (-1.0, -self.c) if self.whole else (0.0, 0.0)
        parts = 2 if self.whole else 1
        along = [parts * self.cells, parts * max(1, round(self.c * self.cells))]
        ends = [np.array(low), np.array([1.0, self.c])]
        return dmesh.create_rectangle(
            comm, ends, along, dmesh.CellType.triangle, diagonal=dmesh.DiagonalType.crossed
        )


class RectangleModel:
    """The discrete equations on one mesh. Loads: ``p``, ``zw``, and the stretches of the frame.

    Attributes:
        system: Residual, tangent and columns in the space of the states.
        classes: Numbers of the classes of displacements; on a whole sheet 0 stands for all of them.
        diagonals: On the quarter of a square, names of the classes of the diagonals.
    """

    def __init__(self, comm: MPI.Intracomm, sheet: Sheet) -> None:
        self.sheet = sheet
        self.mesh = sheet.mesh(comm)
        self.space = fem.functionspace(self.mesh, ("Lagrange", sheet.degree, (3,)))
        self.unknown = fem.Function(self.space, name="displacement")
        self.law = sheet.law.surface_law(self.mesh)
        self.scalars = scalars(self.mesh, ("p", "zw", "delta", "delta_y"))
        for name in ("delta", "delta_y"):
            self.scalars[name][0].value = getattr(sheet, name)
        self.weight = fem.Constant(self.mesh, -sheet.gamma if sheet.load == "liquid" else 0.0)
        self.dx = ufl.Measure("dx", self.mesh, metadata={"quadrature_degree": RULE[sheet.degree]})
        self.membrane = self._at(self.unknown)
        self.least_stress = least_stress(self.membrane.cauchy_green, self.law)
        self.system = System(self._formulation())
        self.classes = (0,) if sheet.whole else tuple(CLASSES)
        self.diagonals = tuple(DIAGONAL) if sheet.has_diagonals else ()
        self._variations: dict[int | str, SecondVariation] = {}

    def cosine(self, height: float) -> np.ndarray:
        """Owned degrees of freedom of a deflection by half a wave in either direction."""
        out, sheet = fem.Function(self.space), self.sheet

        def shape(x: np.ndarray) -> np.ndarray:
            across = 1.0 if sheet.strip else np.cos(np.pi * x[1] / (2 * sheet.c))
            z = sheet.sign * height * np.cos(np.pi * x[0] / 2) * across
            return np.vstack([0 * z, 0 * z, z])

        out.interpolate(shape)
        return out.x.array[: self.system.size].copy()

    # -- form ----------------------------------------------------------------------------------

    def _at(self, displacement: Expr) -> Membrane:
        place = ufl.SpatialCoordinate(self.mesh)
        flat = [self.scalars["delta"][1] * place[0], self.scalars["delta_y"][1] * place[1], 0]
        position = ufl.as_vector(flat) + displacement
        return Membrane.at(
            position,
            self.mesh,
            self.law,
            self.scalars,
            self.weight,
            relaxed=self.sheet.relaxed,
            edge=0.0,
        )

    def _formulation(self) -> Formulation:
        at, copies = self.membrane, self.sheet.copies
        test, trial = ufl.TestFunction(self.space), ufl.TrialFunction(self.space)
        energy = copies * (at.strain + at.load) * self.dx
        l1, l2 = principal_stretches(at.cauchy_green)
        return Formulation(
            unknown=self.unknown,
            residual=ufl.derivative(energy, self.unknown, test),
            loads=self.scalars,
            bcs=self._conditions("even_even"),
            mass=copies * ufl.inner(trial, test) * self.dx,
            monitors=self._monitors(energy),
            profile={
                **dict(zip("xyz", at.position, strict=True)),
                "lam1": l1,
                "lam2": l2,
                "S_least": self.least_stress,
            },
            abscissa="X",
            locate=lambda x, _loads: np.column_stack([x, self.sheet.c * np.asarray(x)]),
        )

    def _monitors(self, energy: ufl.Form) -> dict[str, ufl.Form]:
        """The columns that are functionals of the state."""
        at, copies = self.membrane, self.sheet.copies
        z, mode = at.position[2], state(at.cauchy_green)
        area = 4 * self.sheet.c
        gas = self.sheet.load == "gas"
        amount = {"V" if gas else "V_f": (z if gas else depth(z, self.scalars["zw"][1])) * at.normal[2]}

        def share(value: float) -> ufl.Form:
            return copies / area * ufl.conditional(ufl.eq(mode, value), 1.0, 0.0) * self.dx

        return {
            "w_c": self.sheet.sign * z * self._centre() * ufl.Measure("dx", self.mesh),
            **{name: copies * density * self.dx for name, density in amount.items()},
            "Pi": energy,
            "U": copies * at.strain * self.dx,
            "f_w": share(WRINKLED),
            "f_s": share(SLACK),
        }

    def _centre(self) -> fem.Function:
        r"""The weight ``g`` on one triangle with :math:`\int g\, v\,\mathrm dA = v(0, 0)` on any element."""
        mesh = self.mesh
        corners = mesh.geometry.x[mesh.geometry.dofmap]
        count = mesh.topology.index_map(2).size_local
        return corner_weight(mesh, self.sheet.degree, np.linalg.norm(corners[:count], axis=2) < 1e-9)

    # -- conditions and classes ----------------------------------------------------------------

    def variation(self, n: int | str) -> SecondVariation:
        """The second variation in a class, by its number or name; each has a matrix, made when first used."""
        if n not in self._variations:
            self._variations[n] = self._on_octant(n) if isinstance(n, str) else self._on_mirrors(CLASSES[n])
        return self._variations[n]

    def _on_mirrors(self, name: str) -> SecondVariation:
        return self._second(name, lambda q: q, self.sheet.copies, self._conditions(name))

    def _on_octant(self, name: str) -> SecondVariation:
        """In a class of the diagonals, on the octant ``0 <= Y <= X``."""
        octant = Octant(self.mesh, self.space, *DIAGONAL[name])
        return self._second(name, octant.displacement, octant.copies, octant.conditions())

    def _second(
        self,
        name: str,
        displacement: Callable[[Expr], Expr],
        copies: Expr | int,
        conditions: list[fem.DirichletBC],
    ) -> SecondVariation:
        """The form at a displacement that depends linearly on the unknown of a class."""
        q = fem.Function(self.space, name=name)
        at = self._at(self.unknown + displacement(q))
        test, trial = ufl.TestFunction(self.space), ufl.TrialFunction(self.space)
        return SecondVariation(
            Formulation(
                unknown=q,
                residual=ufl.derivative(copies * (at.strain + at.load) * self.dx, q, test),
                loads=self.scalars,
                bcs=conditions,
                mass=copies * ufl.inner(displacement(trial), displacement(test)) * self.dx,
                monitors={},
            ),
            self.system,
        )

    def _conditions(self, name: str) -> list[fem.DirichletBC]:
        """No displacement of the edges; on the mirrors that of a class."""
        sheet = self.sheet
        ends = [(0, 1.0)] if sheet.strip else [(0, 1.0), (1, sheet.c)]
        held = [self._zero(i, self._on(axis, end)) for axis, end in ends for i in range(3)]
        if sheet.strip:
            held.append(self._zero(1, None))
        if sheet.whole:
            return held
        for axis, parity in enumerate(name.split("_")):
            component = {"normal": axis, "along": 1 - axis, "height": 2}
            held += [self._zero(component[what], self._on(axis, 0.0)) for what in VANISH[parity]]
        return held

    @staticmethod
    def _on(axis: int, value: float) -> Callable[[np.ndarray], np.ndarray]:
        """Marks a line of the frame, on both sides of a whole sheet, or a mirror."""
        return lambda x: np.isclose(np.abs(x[axis]), value)

    def _zero(self, component: int, where: Callable[[np.ndarray], np.ndarray] | None) -> fem.DirichletBC:
        part = self.space.sub(component)
        if where is None:
            count = self.mesh.topology.index_map(2)
            cells = np.arange(count.size_local + count.num_ghosts, dtype=np.int32)
            self.mesh.topology.create_connectivity(2, 2)
            return fem.dirichletbc(np.array(0.0), fem.locate_dofs_topological(part, 2, cells), part)
        edges = dmesh.locate_entities_boundary(self.mesh, 1, where)
        return fem.dirichletbc(np.array(0.0), fem.locate_dofs_topological(part, 1, edges), part)
